"""What a message of a client asks for after those before it: positions, and sticks.

Does a client send its targets once, or does it stream them?  One message alone does not tell.
ArduPilot flies on to a position that came once (DroneKit, MAVProxy, scripts); MAVSDK and
MAVROS send the same message 20 times a second.  The rule, for positions that are sent to an
ArduPilot:

- a position that is flown to or held already asks for nothing, however often it is sent;
- another one is a sample of a stream if it follows a target of the same client within
  the time that one sample counts (`[stream] deadman_s`), and a go-to otherwise.

So a position that does not change is a go-to, which is flown to its end; one that moves is a
stream, which counts only as long as it goes on.

Do a client's sticks fly the vehicle now?  A joystick sends all the time, and most of the time its
sticks are in the middle.  So:

- sticks in the middle begin nothing, and take control from nobody;
- sticks that move begin a stream, or go on with it, while the gate flies the vehicle;
- sticks that are back in the middle ask for standstill, and end the stream when they have stayed
  there, so that the vehicle holds its place and a go-to can be asked for again;
- sticks that were never in the middle since the gate flies the vehicle, such as a throttle at its
  bottom after a take-off, fly nothing until they have been there once.
"""

from __future__ import annotations

from typing import Final

from gcs.bridge.translate.meaning import Sample, Seen, Settled, Sticks, Words
from gcs.bridge.translate.says import DONE, ask, refuse
from gcs.gate.refusal import Code
from gcs.gate.states import State

UNDECIDED_NS: Final = 150_000_000
"""A go-to waits for the gate's next tick: until then `Seen` does not tell what became of it."""

RELEASED_NS: Final = 1_000_000_000
"""In the middle for so long, the sticks are let go of."""
FORGOTTEN_NS: Final = 2_000_000_000
"""Not heard for so long, they are another pilot's."""

FLOWN_BY_US: Final = frozenset({State.HOVERING, State.VERIFYING, State.MOVING, State.STREAMING})
"""States in which sticks can fly; a position too old interrupts them."""


class Pace:
    """One client's positions."""

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


class StickStream:
    """One client's sticks."""

    __slots__ = ("_centred_ns", "_flying", "_heard_ns", "_noted", "_ready")

    def __init__(self) -> None:
        self._heard_ns: int | None = None
        self._ready = False
        """They have been in the middle since the gate flies the vehicle."""
        self._flying = False
        """The last that was asked for with them is not over."""
        self._centred_ns: int | None = None
        self._noted = ""

    def heard(self, now_ns: int) -> bool:
        """This client has sticks."""
        return self._heard_ns is not None and now_ns - self._heard_ns <= FORGOTTEN_NS

    def news(self, sticks: Sticks) -> str:
        """What of them is ignored, once."""
        note = "" if sticks.note == self._noted else sticks.note
        self._noted = sticks.note or self._noted
        return note

    def settle(self, sticks: Sticks, seen: Seen, now_ns: int) -> Settled:
        """What is to be asked for."""
        if not self.heard(now_ns):
            self._ready = self._flying = False
        self._heard_ns = now_ns
        if seen.state not in FLOWN_BY_US and seen.state is not State.STALE:
            self._ready = self._flying = False
            at_rest = sticks.resting if seen.on_ground else sticks.centred
            return DONE if at_rest else sticks.sample
        if sticks.centred:
            return self._centred(sticks, seen, now_ns)
        self._centred_ns = None
        if not self._ready:
            return refuse(
                Code.POLICY,
                "the sticks were not in the middle yet since the vehicle hovers: let go of them "
                "once, the throttle too",
            )
        self._flying = True
        return sticks.sample

    def _centred(self, sticks: Sticks, seen: Seen, now_ns: int) -> Settled:
        self._ready = True
        self._flying = self._flying and seen.state in (State.STREAMING, State.STALE)
        if not self._flying:
            return DONE
        if self._centred_ns is None:
            self._centred_ns = now_ns
        if now_ns - self._centred_ns < RELEASED_NS or seen.state is State.STALE:
            return sticks.sample
        self._flying, self._centred_ns = False, None
        return ask("stream_end") if seen.in_control else DONE
