"""A take-off that a client asks for before it arms, as QGroundControl does to a PX4.

A PX4 accepts NAV_TAKEOFF while it is disarmed, and flies as soon as somebody arms it (recorded of
1.14.3, row D2).  Here nothing goes to the vehicle: the take-off is answered as accepted and kept
for a short time, and the next arming of the same client becomes two requests, `arm` and `takeoff`,
which the gate judges when they are asked.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

from gcs import ipc
from gcs.bridge.meaning.meaning import Meaning, Reject, Sample, Seen, Words
from gcs.gate.states import State
from gcs.protocol.autopilot import PX4

KEPT_NS: Final = 10_000_000_000
"""As long as a PX4 itself waits for a take-off after it was armed (COM_DISARM_PRFLT, 10 s)."""


@dataclass(frozen=True, slots=True)
class Chosen:
    """It is to be flown when the client arms until `until_ns`."""

    ask: ipc.Ask
    least_up_m: float
    """The vehicle's own default height when it was chosen: it climbs to that at the least."""
    until_ns: int


def may_be_chosen(meaning: Meaning, seen: Seen) -> bool:
    """A take-off of a disarmed PX4 in sight that would be cleared now, but for the arming."""
    if not isinstance(meaning, Words) or [ask.word for ask in meaning.asks] != ["takeoff"]:
        return False
    standing = seen.state is State.GROUNDED and seen.on_ground and not seen.armed
    up_m = meaning.asks[0].up_m
    return (
        seen.autopilot is PX4
        and standing
        and seen.in_control
        and up_m is not None
        and seen.clears_takeoff(up_m)
    )


def with_takeoff(chosen: Chosen, meaning: Meaning, seen: Seen, now_ns: int) -> Words | None:
    """The arming with the take-off after it; None: this is no arming, or the take-off that was
    chosen is not good any more."""
    if not isinstance(meaning, Words) or [ask.word for ask in meaning.asks] != ["arm"]:
        return None
    if now_ns >= chosen.until_ns or seen.armed or not seen.on_ground or not seen.in_control:
        return None
    if seen.takeoff_up_m != chosen.least_up_m:
        return None
    return Words((*meaning.asks, chosen.ask), meaning.note, first_answers=True)


def ends_choice(meaning: Meaning) -> bool:
    """Whether the client wants something else now; sticks in the middle ask for nothing."""
    match meaning:
        case Words(asks):
            return bool(asks)
        case Sample() | Reject():
            return True
        case _:
            return False
