"""Does a client send its targets once, or does it stream them?

One message alone does not tell.  ArduPilot flies on to a position that came once (DroneKit,
MAVProxy, scripts); MAVSDK and MAVROS send the same message 20 times a second.  The rule, for
positions that are sent to an ArduPilot:

- a position that is flown to or held already asks for nothing, however often it is sent;
- another one is a sample of a stream if it follows a target of the same client within
  the time that one sample counts (`[stream] deadman_s`), and a go-to otherwise.

So a position that does not change is a go-to, which is flown to its end; one that moves is a
stream, which counts only as long as it goes on.
"""

from __future__ import annotations

from typing import Final

from gcs.bridge.translate.meaning import Sample, Settled, Words

UNDECIDED_NS: Final = 150_000_000
"""A go-to waits for the gate's next tick: until then `Seen` does not tell what became of it."""


class Pace:
    """One client's."""

    __slots__ = ("_asked", "_asked_ns", "_last_ns", "_within_ns")

    def __init__(self, within_ns: int) -> None:
        """A stream has no longer gaps than `within_ns`."""
        self._within_ns = within_ns
        self._last_ns: int | None = None
        self._asked: Words | None = None
        self._asked_ns = 0

    def settle(self, meaning: Settled, now_ns: int) -> Settled:
        """The meaning with the doubt removed: `Words.if_repeated` is done with."""
        if isinstance(meaning, Sample):
            self._last_ns = now_ns
            return meaning
        if not isinstance(meaning, Words) or meaning.if_repeated is None:
            return meaning
        follows = self._last_ns is not None and now_ns - self._last_ns <= self._within_ns
        self._last_ns = now_ns
        once = Words(meaning.asks, meaning.note)
        if not follows or not once.asks:
            self._asked, self._asked_ns = once, now_ns
            return once
        if once == self._asked and now_ns - self._asked_ns <= UNDECIDED_NS:
            return Words(())
        return meaning.if_repeated
