"""How late a position came: the time that it spent on its way, in queues and else.

A position has the vehicle's time stamp.  What its arrival is later than that, compared with the
quickest sample, is delay; a vehicle whose clock runs at another rate than ours, as a simulator that
is slower than real time, looks as if that grew and grew.  So the vehicle is asked for its time once
a second (TIMESYNC, https://mavlink.io/en/services/timesync.html): a position that comes together
with an answer was no longer on its way than question and answer together were.  Both autopilots
answer (recorded).

The same answers show a delay that was there from the first byte, with which no sample is compared:
how a way there and back is shared between the two is not known, so all of it is taken for the way
of the positions.  For a stop it is the same: it takes as long to be sent as the rest.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Final

from gcs.session.speedup_waits import Times

TOGETHER_NS: Final = 250_000_000
"""A position so little older than an answer has come with it."""
ASK_NS: Final = 1_000_000_000
ASK_REAL_NS: Final = 100_000_000
"""Between two questions: a second, but of a vehicle in a hurry no more than ten a real second."""
ASKED_KEPT: Final = 5
"""An answer that comes later than so many questions tells nothing of now."""
TELL_EVERY_NS: Final = 10_000_000_000
ANSWERS_KEPT: Final = 5
"""The quickest of the last ones counts: one answer may wait for a busy vehicle."""


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
    _bounds_ns: list[int] = field(default_factory=list)
    """What the two clocks differ by at least, as each of the last answers shows it."""
    _bound_ns: int | None = None
    """The greatest of them."""
    late_ns: int = 0
    """How late the latest position came."""
    _told_ns: int | None = None

    def of(self, time_boot_ms: int, now_ns: int) -> int:
        """How late a position with that stamp comes: at most, by the vehicle's answers, or how much
        later than the quickest one, where that is more.

        The quickest is forgotten at 1 ms a second, more than any two clocks drift apart.
        """
        offset_ns = now_ns - time_boot_ms * 1_000_000
        if self._quickest_ns is None:
            self._quickest_ns, self._quickest_at_ns = offset_ns, now_ns
        allowed_ns = self._quickest_ns + (now_ns - self._quickest_at_ns) // 1000
        self._quickest_ns, self._quickest_at_ns = min(offset_ns, allowed_ns), now_ns
        self._latest_ns, self._latest_at_ns = offset_ns, now_ns
        bound_ns = self._bound_ns
        undelayed_ns = self._quickest_ns if bound_ns is None else min(self._quickest_ns, bound_ns)
        self.late_ns = offset_ns - undelayed_ns
        return self.late_ns

    def trouble(self, allowed_ns: int, now_ns: int) -> str:
        """Once in ten seconds, where positions come later than is allowed: that they do."""
        told_ns = self._told_ns
        if self.late_ns <= allowed_ns or (told_ns is not None and now_ns - told_ns < TELL_EVERY_NS):
            return ""
        self._told_ns = now_ns
        late_s, allowed_s = self.times.real_s(self.late_ns), self.times.real_s(allowed_ns)
        return (
            f"positions come up to {late_s:.1f} s late, by their time stamps and the answers to "
            f"TIMESYNC, and are not used: {allowed_s:g} s are allowed (position_age_s)"
        )

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

    def awaits(self, asked_ns: int) -> bool:
        """Whether such a question was asked, and not answered yet."""
        return asked_ns in self._asked_ns

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
        self._bounds_ns = [*self._bounds_ns[1 - ANSWERS_KEPT :], bound_ns]
        self._bound_ns = max(self._bounds_ns)
