"""Whether a vehicle has restarted, as what it sends shows it, however short its silence was.

Three signs, each of which needs two messages, so that one that is late or forged is none:

- its clock ran back: the stamps of its positions and attitudes are a second and more older than the
  newest of them, and for half a second and two of them none is newer.  (The gate is told of it with
  the second position, by `message_to_telemetry.py`: a clock that ran back moves the local frame.)
  After 49.7 days a stamp begins anew at 0, which looks the same and is taken for a restart, too: a
  restart after weeks must be noticed;
- while it is disarmed, its answers to TIMESYNC: the vehicle read its clock between the question and
  the answer, so each bounds when that clock began, on ours, whatever the delay.  Two in a row that
  agree with each other, and not with the one before them, are of another boot.  That shows a
  vehicle that was up for seconds only, and sends nothing else before it is asked.  A simulator that
  stood still looks the same, which costs that all is read once more;
- two heartbeats in a row of a disarmed vehicle say that it is starting (MAV_STATE UNINIT or BOOT),
  after one that did not.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

from gcs.wire import messages as m
from gcs.wire.ids import MavState, ModeFlag

BACK_MS: Final = 1_000
"""No frame is overtaken by that much on its way."""
FOLLOWS_MS: Final = 10_000
"""Two stamps of the new time are no farther apart than that."""
STEP_NS: Final = 1_000_000_000
"""A clock that is said to have begun so much later or earlier is another one."""
STARTING: Final = frozenset({MavState.UNINIT, MavState.BOOT})


@dataclass(slots=True)
class Clock:
    """The stamps of the positions."""

    newest_ms: int = 0
    first_ms: int | None = None
    """One that is far back, which no newer one has followed yet."""

    def take(self, stamp_ms: int) -> None:
        """A position with this stamp was taken."""
        self.newest_ms, self.first_ms = stamp_ms, None

    def ran_back(self, stamp_ms: int) -> bool:
        """Whether this stamp is the second one in a row of another time."""
        if self.newest_ms - stamp_ms < BACK_MS:
            if stamp_ms > self.newest_ms:
                self.newest_ms, self.first_ms = stamp_ms, None
            return False
        first_ms, self.first_ms = self.first_ms, stamp_ms
        return first_ms is not None and 0 < stamp_ms - first_ms < FOLLOWS_MS


@dataclass(frozen=True, slots=True)
class Began:
    """Between which times, on our clock, the vehicle's began."""

    from_ns: int
    to_ns: int

    def apart(self, other: Began, by_ns: int) -> bool:
        """No time is within both, or nearly so."""
        return max(self.from_ns, other.from_ns) - min(self.to_ns, other.to_ns) > by_ns


STAMPED: Final = (m.LocalPositionNed, m.Attitude, m.GlobalPositionInt)
"""Messages that tell the time since the start, and come all the time."""


@dataclass(slots=True)
class Restarts:
    """Of one vehicle; only messages of its autopilot are given to it."""

    step_ns: int = STEP_NS
    """`STEP_NS` on the session's clock, where that runs faster."""
    _began: Began | None = None
    _began_anew: Began | None = None
    """What an answer says that does not agree with those before it."""
    _answered_ns: int = 0
    """When the last answer came that agreed."""
    _newest_ms: int = 0
    _back: tuple[int, int] | None = None
    """The first stamp of another time, and when it came; no newer one has come since."""
    _was_up: bool = False
    _starting: int = 0

    def sign(self, message: m.Message, now_ns: int) -> str:
        """What shows that it has restarted, in words; told once.  Empty where nothing does."""
        if isinstance(message, m.Heartbeat):
            return self._beat(message)
        if not isinstance(message, STAMPED):
            return ""
        if not self._stays_back(message.time_boot_ms, now_ns):
            return ""
        self.begin()
        return "its clock ran back"

    def answered(self, asked_ns: int, clock_ns: int, now_ns: int, *, armed: bool) -> str:
        """The same of an answer to TIMESYNC: what was asked at `asked_ns`, came now."""
        began = Began(asked_ns - clock_ns, now_ns - clock_ns)
        # A clock that goes on, at no less than half of the rate, is slow (a starved simulation).
        drifts_ns = max(self.step_ns, (now_ns - self._answered_ns) // 2)
        if armed or self._began is None or not began.apart(self._began, drifts_ns):
            self._began, self._began_anew, self._answered_ns = began, None, now_ns
            return ""
        first, self._began_anew = self._began_anew, began
        if first is None or began.apart(first, self.step_ns // 2):
            return ""
        self.begin()
        return "its clock is another one"

    def begin(self) -> None:
        """A vehicle that has only just started: nothing that it sent before counts."""
        self._newest_ms, self._back = 0, None
        self._began = self._began_anew = None
        self._was_up, self._starting = False, 0

    def _stays_back(self, stamp_ms: int, now_ns: int) -> bool:
        if self._newest_ms - stamp_ms < BACK_MS:
            self._newest_ms, self._back = max(stamp_ms, self._newest_ms), None
            return False
        if self._back is None or abs(stamp_ms - self._back[0]) > FOLLOWS_MS:
            self._back = stamp_ms, now_ns
        first_ms, since_ns = self._back
        return stamp_ms != first_ms and now_ns - since_ns >= self.step_ns // 2

    def _beat(self, beat: m.Heartbeat) -> str:
        if beat.base_mode & ModeFlag.SAFETY_ARMED or beat.system_status not in STARTING:
            self._was_up, self._starting = True, 0
            return ""
        self._starting += 1
        if not self._was_up or self._starting < 2:
            return ""
        self.begin()
        return f"it says {MavState(beat.system_status).name}"
