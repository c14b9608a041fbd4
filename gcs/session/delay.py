"""How late a position came: the time that it spent in queues on its way.

A position has the vehicle's time stamp.  What its arrival is later than that, compared with the
quickest sample, is delay; a vehicle whose clock runs at another rate than ours, as a simulator that
is slower than real time, looks as if that grew and grew.  So the vehicle is asked for its time once
a second (TIMESYNC, https://mavlink.io/en/services/timesync.html): a position that comes together
with an answer was no longer on its way than question and answer together were.  Both autopilots
answer (recorded).
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Final

from gcs.session.times import Times

TOGETHER_NS: Final = 250_000_000
"""A position so little older than an answer has come with it."""
ASK_NS: Final = 1_000_000_000
ASK_REAL_NS: Final = 100_000_000
"""Between two questions: a second, but of a vehicle in a hurry no more than ten a real second."""
ASKED_KEPT: Final = 5
"""An answer that comes later than so many questions tells nothing of now."""


@dataclass(slots=True)
class Delay:
    """Of the positions of one vehicle; nanoseconds on our clock."""

    times: Times = field(default_factory=Times)
    _quickest_ns: int | None = None
    _quickest_at_ns: int = 0
    _latest_ns: int = 0
    _latest_at_ns: int | None = None
    _asked_ns: list[int] = field(default_factory=list)
    _last_asked_ns: int = 0

    def of(self, time_boot_ms: int, now_ns: int) -> int:
        """How much later than the quickest sample one with that stamp comes.

        The quickest is forgotten at 1 ms a second, more than any two clocks drift apart.
        """
        offset_ns = now_ns - time_boot_ms * 1_000_000
        if self._quickest_ns is None:
            self._quickest_ns, self._quickest_at_ns = offset_ns, now_ns
        allowed_ns = self._quickest_ns + (now_ns - self._quickest_at_ns) // 1000
        self._quickest_ns, self._quickest_at_ns = min(offset_ns, allowed_ns), now_ns
        self._latest_ns, self._latest_at_ns = offset_ns, now_ns
        return offset_ns - self._quickest_ns

    @property
    def ask_at_ns(self) -> int:
        """When the next question is due."""
        pause_ns = max(ASK_NS, self.times.real_ns(ASK_REAL_NS))
        return self._last_asked_ns + pause_ns

    def ask(self, now_ns: int) -> int:
        """The question's time (TIMESYNC.ts1), which comes back in the answer."""
        self._last_asked_ns = now_ns
        self._asked_ns = [*self._asked_ns[1 - ASKED_KEPT :], now_ns]
        return now_ns

    def answered(self, asked_ns: int, now_ns: int) -> None:
        """An answer to the question of `asked_ns`: its way bounds that of the latest position."""
        if asked_ns not in self._asked_ns:
            return
        self._asked_ns.remove(asked_ns)
        latest_at_ns = self._latest_at_ns
        if latest_at_ns is None or now_ns - latest_at_ns > self.times.real_ns(TOGETHER_NS):
            return
        assert self._quickest_ns is not None
        bound_ns = self._latest_ns - (now_ns - asked_ns)
        self._quickest_ns = max(self._quickest_ns, bound_ns)
