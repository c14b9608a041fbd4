"""Where a go-to leads that is not asked for in the vehicle's local frame: settled as it arrives."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Final

import msgspec

from gcs import ipc
from gcs.bridge.translate.meaning import Seen
from gcs.bridge.translate.places import Datum, place_of, rotated
from gcs.frames import Vec3, enu_from_ned, ned_from_enu
from gcs.gate.machine.sentences import REFUSED
from gcs.gate.refusal import Code, Refusal
from gcs.gate.states import State
from gcs.request_words import goals_of
from gcs.station.seen import seen_of
from gcs.vehicle.vehicle import Vehicle

FOLLOWS: Final = frozenset({State.HOVERING, State.MOVING})
"""Where it flies to a goal with a heading that it may have been asked for, or hovers there."""
_NOWHERE = Refusal(Code.NO_POSITION, "where the vehicle is now is not known")


def settled(ask: ipc.Ask, vehicle: Vehicle) -> ipc.Ask | Refusal:
    """The same with its goal as `goal_enu`, by what the vehicle has reported last, and at the speed
    that was asked for its legs; any other request as it is."""
    goals, telemetry = goals_of(ask), vehicle.telemetry
    heading = ask.word == "heading"
    if ask.word == "goto" and ask.speed_m_s is None and vehicle.leg_speed_m_s is not None:
        ask = msgspec.structs.replace(ask, speed_m_s=vehicle.leg_speed_m_s)
    if not heading and (ask.word != "goto" or len(goals) != 1 or "goal_enu" in goals):
        return ask
    if telemetry is None:
        return Refusal(Code.NO_VEHICLE, REFUSED[Code.NO_VEHICLE])
    seen = seen_of(telemetry, vehicle.gate, {}, 0.0)
    if heading:
        place_ned = _kept(seen) or _NOWHERE
    else:
        ((field, goal),) = goals.items()
        turns_to_rad = seen.goal_yaw_rad if seen.state in FOLLOWS else None
        if field == "move_body" and turns_to_rad is not None:
            # It may still turn to the heading that it was asked for: that is meant, and kept.
            seen = replace(seen, yaw_rad=turns_to_rad)
            ask = msgspec.structs.replace(ask, yaw_deg=math.degrees(turns_to_rad))
        place_ned = _place(field, goal, ask.amsl, seen)
    if isinstance(place_ned, Refusal):
        return place_ned
    return msgspec.structs.replace(
        ask,
        goal_enu=enu_from_ned(place_ned),
        move_enu=None,
        move_body=None,
        goal_global=None,
        amsl=False,
    )


def _kept(seen: Seen) -> Vec3 | None:
    """What it hovers at or flies to, so that nothing but its heading changes; else where it is."""
    flies_to = seen.goal_ned if seen.state in FOLLOWS else None
    return flies_to or seen.pos_ned


def _place(field: str, goal: ipc.Maybe3, amsl: bool, seen: Seen) -> Vec3 | Refusal:
    first, second, third = (math.nan if each is None else each for each in goal)
    if not all(map(math.isfinite, (first, second, third))):
        return Refusal(Code.NON_FINITE, f"{field} has a number that is not finite")
    if field == "goal_global":
        return place_of(seen, first, second, third, Datum.SEA if amsl else Datum.HOME)
    here = seen.pos_ned
    if here is None:
        return _NOWHERE
    if field == "move_enu":
        moved = ned_from_enu((first, second, third))
    elif seen.yaw_rad is None:
        return Refusal(Code.NO_POSITION, "where the vehicle's nose points is not known")
    else:
        moved = rotated((first, second, -third), seen.yaw_rad)
    return (here[0] + moved[0], here[1] + moved[1], here[2] + moved[2])
