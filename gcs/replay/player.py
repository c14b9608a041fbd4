"""When which frame of a record is due: play, pause, seek, speed, loop.  Pure; time is passed in.

A frame that was received t seconds after the one where playing began is due t / speed seconds after
playing began.  Each due time is counted from there and not from the frame before, so that no
lateness adds up.

What is pressed meanwhile comes as the bytes that a terminal sends for a key (`keys_of`).
"""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from enum import Enum, auto

SEEK_NS = 5_000_000_000
FAR_SEEK_NS = 30_000_000_000
SPEEDS = (0.1, 0.25, 0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0)
LATE_NS = 1_000_000_000
"""A frame that is later than this is not made up for: the schedule begins anew there, so that a
computer that slept does not send a burst."""
LOOP_PAUSE_NS = 1_000_000_000
"""Between the last frame and the first one again."""


class Key(Enum):
    """What a person can ask for while it plays."""

    PAUSE = auto()
    BACK = auto()
    ON = auto()
    FAR_BACK = auto()
    FAR_ON = auto()
    FASTER = auto()
    SLOWER = auto()
    BEGIN = auto()


KEYS: dict[bytes, Key | None] = {
    b" ": Key.PAUSE,
    b"\x1b[D": Key.BACK,
    b"\x1bOD": Key.BACK,
    b"\x1b[C": Key.ON,
    b"\x1bOC": Key.ON,
    b"\x1b[B": Key.FAR_BACK,
    b"\x1bOB": Key.FAR_BACK,
    b"\x1b[A": Key.FAR_ON,
    b"\x1bOA": Key.FAR_ON,
    b"+": Key.FASTER,
    b"=": Key.FASTER,
    b"-": Key.SLOWER,
    b"0": Key.BEGIN,
    b"q": None,
    b"\x04": None,
}
"""None ends it."""


@dataclass(frozen=True, slots=True)
class Due:
    """Frames to send now: those numbered `first` to `end` - 1, in order."""

    first: int
    end: int


class Player:
    """`times_ns`: when each frame was received, in order; at least one."""

    def __init__(
        self, times_ns: Sequence[int], now_ns: int, *, speed: float = 1.0, loop: bool = False
    ) -> None:
        self._times_ns = times_ns
        self.speed = speed
        self.paused = False
        self.rounds = 0
        """How often it has begun again."""
        self.slipped = 0
        """How often the schedule was begun anew because this computer was too late."""
        self._loop = loop
        self._next = 0
        self._anchor_log_ns = times_ns[0]
        self._anchor_ns = now_ns

    @property
    def ended(self) -> bool:
        return self._next == len(self._times_ns) and not self._loop

    @property
    def length_s(self) -> float:
        return (self._times_ns[-1] - self._times_ns[0]) / 1e9

    def position_s(self, now_ns: int) -> float:
        """Seconds since the first frame, on the record's clock."""
        return (self._log_ns(now_ns) - self._times_ns[0]) / 1e9

    def deadline_ns(self) -> int | None:
        """When the next frame is due; None while it is paused and after the end."""
        if self.paused or self.ended:
            return None
        if self._next == len(self._times_ns):
            return self._due_ns(self._times_ns[-1]) + LOOP_PAUSE_NS
        return self._due_ns(self._times_ns[self._next])

    def advance(self, now_ns: int) -> Due:
        """What is due; the same frame is given once."""
        deadline_ns = self.deadline_ns()
        if deadline_ns is None or now_ns < deadline_ns:
            return Due(self._next, self._next)
        if self._next == len(self._times_ns):
            self.rounds += 1
            self._begin_at(0, now_ns)
        elif now_ns - deadline_ns > LATE_NS:
            self.slipped += 1
            self._begin_at(self._next, now_ns)
        first = self._next
        while self._next < len(self._times_ns) and now_ns >= self._due_ns(
            self._times_ns[self._next]
        ):
            self._next += 1
        return Due(first, self._next)

    def press(self, key: Key, now_ns: int) -> None:
        log_ns = self._log_ns(now_ns)
        match key:
            case Key.PAUSE:
                self.paused = not self.paused
                self._anchor(log_ns, now_ns)
            case Key.BACK:
                self._seek(log_ns - SEEK_NS, now_ns)
            case Key.ON:
                self._seek(log_ns + SEEK_NS, now_ns)
            case Key.FAR_BACK:
                self._seek(log_ns - FAR_SEEK_NS, now_ns)
            case Key.FAR_ON:
                self._seek(log_ns + FAR_SEEK_NS, now_ns)
            case Key.BEGIN:
                self._seek(self._times_ns[0], now_ns)
            case Key.FASTER:
                self._anchor(log_ns, now_ns)
                self.speed = next((each for each in SPEEDS if each > self.speed), self.speed)
            case Key.SLOWER:
                self._anchor(log_ns, now_ns)
                self.speed = next((each for each in SPEEDS[::-1] if each < self.speed), self.speed)

    def _seek(self, log_ns: int, now_ns: int) -> None:
        log_ns = min(max(log_ns, self._times_ns[0]), self._times_ns[-1])
        self._next = bisect_left(self._times_ns, log_ns)
        self._anchor(log_ns, now_ns)

    def _begin_at(self, number: int, now_ns: int) -> None:
        self._next = number
        self._anchor(self._times_ns[number], now_ns)

    def _anchor(self, log_ns: int, now_ns: int) -> None:
        self._anchor_log_ns, self._anchor_ns = log_ns, now_ns

    def _due_ns(self, log_ns: int) -> int:
        return self._anchor_ns + round((log_ns - self._anchor_log_ns) / self.speed)

    def _log_ns(self, now_ns: int) -> int:
        """Where it is on the record's clock."""
        if self.paused:
            return self._anchor_log_ns
        log_ns = self._anchor_log_ns + round((now_ns - self._anchor_ns) * self.speed)
        return min(log_ns, self._times_ns[-1])


def keys_of(pressed: bytes) -> Iterator[Key | None]:
    """What was asked for, in order; other keys mean nothing."""
    at = 0
    while at < len(pressed):
        size = 3 if pressed[at : at + 1] == b"\x1b" else 1
        name = pressed[at : at + size]
        if name in KEYS:
            yield KEYS[name]
        at += size
