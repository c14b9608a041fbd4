"""A take-off or a mission that a client chooses before it arms, as QGroundControl does to a PX4.

A PX4 accepts NAV_TAKEOFF, and the mode of a mission, while it is disarmed, and flies as soon as
somebody arms it (recorded of 1.14.3, rows D2 and C6).  Here the next arming of the same client
within a short time becomes several requests, which the gate judges when they are asked: `arm` and
`takeoff`, or `mission_check`, `arm` and `mission_start`.

A take-off is answered as accepted and kept; nothing goes to the vehicle.  The mode of a mission is
forwarded, because its client waits for a heartbeat that shows it (QGroundControl's
`PX4FirmwarePlugin::startMission`, from memory); a disarmed vehicle does not move in it, and every
arming of the gate sets hold first.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final, TypeAlias

from gcs import ipc
from gcs.bridge.translate.meaning import Meaning, Reject, Sample, Seen, Words
from gcs.gate.states import FlightMode, State
from gcs.protocol.autopilot import PX4

KEPT_NS: Final = 10_000_000_000
"""As long as a PX4 itself waits for a take-off after it was armed (COM_DISARM_PRFLT, 10 s)."""
MISSION_MODE: Final = PX4.mode_of_meaning[FlightMode.MISSION]


@dataclass(frozen=True, slots=True)
class ChosenTakeoff:
    """It is to be flown when the client arms until `until_ns`."""

    ask: ipc.Ask
    least_up_m: float
    """The vehicle's own default height when it was chosen: it climbs to that at the least."""
    until_ns: int
    name = "takeoff"


@dataclass(frozen=True, slots=True)
class ChosenMission:
    """The mission on board is to be started when the client arms until `until_ns`."""

    until_ns: int
    name = "mission"


Chosen: TypeAlias = ChosenTakeoff | ChosenMission


def _stands_ready(seen: Seen) -> bool:
    """A disarmed PX4 on the ground, and this client may fly it."""
    standing = seen.state is State.GROUNDED and seen.on_ground and not seen.armed
    return seen.autopilot is PX4 and standing and seen.in_control


def _words(meaning: Meaning) -> list[str]:
    return [ask.word for ask in meaning.asks] if isinstance(meaning, Words) else []


def takeoff_may_be_chosen(meaning: Meaning, seen: Seen) -> bool:
    """A take-off of a disarmed PX4 in sight that would be cleared now, but for the arming."""
    if not isinstance(meaning, Words) or _words(meaning) != ["takeoff"]:
        return False
    up_m = meaning.asks[0].up_m
    return _stands_ready(seen) and up_m is not None and seen.clears_takeoff(up_m)


def mission_may_be_chosen(meaning: Meaning, seen: Seen) -> bool:
    """The mode of a mission of a disarmed PX4, with one on board that was verified.

    Not while the gate waits for something of the vehicle: that may be an arming.
    """
    ready = _stands_ready(seen) and not seen.awaited and seen.mission_items > 0
    return ready and _words(meaning) == ["mission_start"]


def with_chosen(chosen: Chosen, meaning: Meaning, seen: Seen, now_ns: int) -> Words | None:
    """The arming with what was chosen; None: this is no arming, or the choice is not good any more.

    Before the mission begins, the vehicle is to show its mode: until then an arming could come
    before that, and would start the mission by itself.
    """
    if not isinstance(meaning, Words) or _words(meaning) != ["arm"]:
        return None
    if now_ns >= chosen.until_ns or seen.armed or not seen.on_ground or not seen.in_control:
        return None
    match chosen:
        case ChosenTakeoff(ask, least_up_m):
            if seen.takeoff_up_m != least_up_m:
                return None
            return Words((*meaning.asks, ask), meaning.note, answered_by="arm")
        case ChosenMission():
            check = ipc.Ask(0, "mission_check", mode=MISSION_MODE)
            start = ipc.Ask(0, "mission_start")
            return Words((check, *meaning.asks, start), meaning.note, answered_by="arm")


def ends_choice(meaning: Meaning) -> bool:
    """Whether the client wants something else now; sticks in the middle ask for nothing."""
    match meaning:
        case Words(asks):
            return bool(asks)
        case Sample() | Reject():
            return True
        case _:
            return False
