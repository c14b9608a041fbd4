"""Do a client's sticks fly the vehicle now?

A joystick sends all the time, and most of the time its sticks are in the middle.  So:

- sticks in the middle begin nothing, and take control from nobody;
- sticks that move begin a stream, or go on with it, while the gate flies the vehicle;
- sticks that are back in the middle ask for standstill, and end the stream when they have stayed
  there, so that the vehicle holds its place and a go-to can be asked for again;
- sticks that were never in the middle since the gate flies the vehicle, such as a throttle at its
  bottom after a take-off, fly nothing until they have been there once.
"""

from __future__ import annotations

from typing import Final

from gcs.bridge.translate.meaning import Seen, Settled, Sticks
from gcs.bridge.translate.says import DONE, ask, refuse
from gcs.gate.refusal import Code
from gcs.gate.states import State

RELEASED_NS: Final = 1_000_000_000
"""In the middle for so long, the sticks are let go of."""
FORGOTTEN_NS: Final = 2_000_000_000
"""Not heard for so long, they are another pilot's."""

FLOWN_BY_US: Final = frozenset({State.HOVERING, State.VERIFYING, State.MOVING, State.STREAMING})
"""States in which sticks can fly; a position too old interrupts them."""


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
