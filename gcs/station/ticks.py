"""The 20 Hz grid of ticks: fixed at start, a missed tick is reported and never made up for."""

from __future__ import annotations

from gcs.gate import inputs
from gcs.gate.condition import Condition
from gcs.gate.effects import Level
from gcs.session.speedup_waits import Times
from gcs.session.work import GateInput, Log, SecondDue, SnapshotDue, Work, condition

TICK_NS = 50_000_000
TICKS_A_SECOND = 20
TICKS_A_SNAPSHOT = 2
"""Of real time: ten snapshots a second, however fast the session's clock runs."""
LATE_NS = 20_000_000
"""Of real time; a tick that comes later than this is logged."""
VERY_LATE_NS = 250_000_000
LATE_SHOWN_NS = 10_000_000_000

NODE = "link"


class Ticks:
    """What is due at a tick: the gate's, and every second and every second tick the session's."""

    def __init__(self, start_ns: int, times: Times) -> None:
        self.next_ns = start_ns + TICK_NS
        self._times = times
        self._ticks_a_snapshot = max(1, round(TICKS_A_SNAPSHOT * times.speedup))
        self._number = 0
        self._late_until_ns = 0
        self._told_late = False
        self._late_ns = times.real_ns(LATE_NS)

    def wake(self, now_ns: int) -> list[Work]:
        """Nothing before `next_ns`; then one tick, however many were missed."""
        if now_ns < self.next_ns:
            return []
        lateness_ns = now_ns - self.next_ns
        self.next_ns += TICK_NS * (lateness_ns // TICK_NS + 1)
        work: list[Work] = [GateInput(inputs.Tick(lateness_ns))]
        if lateness_ns > self._late_ns or self._told_late or self._number % TICKS_A_SECOND == 0:
            work += self._judge_lateness(lateness_ns, now_ns)
        if self._number % TICKS_A_SECOND == 0:
            work.append(SecondDue())
        if self._number % self._ticks_a_snapshot == 0:
            work.append(SnapshotDue())
        self._number += 1
        return work

    def _judge_lateness(self, lateness_ns: int, now_ns: int) -> list[Work]:
        """A late tick is logged; one so late that the stream had a gap is a condition for 10 s."""
        text = f"a tick came {self._times.real_s(lateness_ns) * 1e3:.0f} ms late"
        work: list[Work] = []
        if lateness_ns > self._late_ns:
            work.append(Log(Level.DEBUG, NODE, text))
        if lateness_ns > self._times.real_ns(VERY_LATE_NS):
            self._late_until_ns = now_ns + LATE_SHOWN_NS
        self._told_late = now_ns < self._late_until_ns
        return [*work, condition(Condition.TICK_LATE, self._told_late, text)]
