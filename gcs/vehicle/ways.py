"""What a vehicle flies, or would fly if a request were accepted: legs in its own local frame, from
where it is."""

from __future__ import annotations

import math
from itertools import pairwise
from typing import Final

from gcs.frames import Vec3
from gcs.gate.airspace.questions.returns import way_home
from gcs.gate.airspace.separation import Leg
from gcs.gate.machine.memory import Memory
from gcs.gate.requests import (
    BeginStream,
    GoTo,
    Request,
    ReturnHome,
    SetMode,
    StartMission,
    TakeOff,
)
from gcs.gate.states import FlightMode, State
from gcs.orbit.circle import Orbit
from gcs.vehicle.gate_port import NOT_FLYING
from gcs.vehicle.parts import VehicleParts

CHORD_OFF_M: Final = 0.1
"""How far a circle may lie beside the legs that stand for it."""


def legs_of(vehicle: VehicleParts, pos_ned: Vec3) -> list[Leg]:
    """To a goal that waits for its tick, to the goal, up a climb, down a landing, round an orbit,
    along all of a mission, to each place where a return may end; else only where it is or hovers.
    """
    memory = vehicle.port.gate.memory
    if memory.state is State.STREAMING and vehicle.orbits.flown is not None:
        return _round(vehicle.orbits.flown.guidance.orbit, pos_ned)
    if memory.state is State.FLYING_MISSION and vehicle.missions.legs_ned:
        return [(pos_ned, pos_ned), *vehicle.missions.legs_ned]
    if memory.state is State.RETURNING and memory.return_up_m is not None:
        return _home(memory, pos_ned, memory.return_up_m) or [(pos_ned, pos_ned)]
    return [(pos_ned, _end_of(memory, pos_ned))]


def legs_asked(
    vehicle: VehicleParts, request_id: int, request: Request, pos_ned: Vec3
) -> list[Leg]:
    """What it would fly by a request for a goal, a climb, an orbit, a mission or a return; none
    where the gate refuses that in any case, and by a stream, whose samples come later."""
    memory = vehicle.port.gate.memory
    match request:
        case GoTo(goal_ned) if memory.state not in NOT_FLYING:
            return [(pos_ned, goal_ned)]
        case TakeOff(up_m) if memory.state is State.GROUNDED:
            north_m, east_m, down_m = pos_ned
            return [(pos_ned, (north_m, east_m, down_m - up_m))]
        case BeginStream() if request_id in vehicle.orbits.asked:
            _, orbit = vehicle.orbits.asked[request_id]
            return _round(orbit, pos_ned)
        case StartMission() if memory.state in (State.GROUNDED, State.HOVERING):
            return [*vehicle.missions.legs_ned]
        case ReturnHome() | SetMode(meaning=FlightMode.RETURN) if memory.return_up_m is not None:
            return _home(memory, pos_ned, memory.return_up_m)
    return []


def _end_of(memory: Memory, pos_ned: Vec3) -> Vec3:
    pending = memory.pending.request if memory.pending else None
    if isinstance(pending, GoTo):
        return pending.goal_ned
    if memory.goal is not None:
        return memory.goal.pos_ned
    if memory.state is State.TAKING_OFF:
        return memory.top_ned
    if memory.state is State.LANDING:
        return (pos_ned[0], pos_ned[1], max(pos_ned[2], memory.ground_down_m or 0.0))
    return pos_ned if memory.hold is None else memory.hold.pos_ned


def _round(orbit: Orbit, pos_ned: Vec3) -> list[Leg]:
    """To the nearest point of the circle, and once round it, with chords that are off by
    CHORD_OFF_M at most."""
    count = math.ceil(math.pi / math.acos(1.0 - CHORD_OFF_M / orbit.radius_m))
    circle = [orbit.point_ned(2.0 * math.pi * n / count) for n in range(count + 1)]
    nearest = min(circle, key=lambda point: math.dist(point, pos_ned))
    return [(pos_ned, nearest), *pairwise(circle)]


def _home(memory: Memory, pos_ned: Vec3, return_up_m: float) -> list[Leg]:
    """To each place where it may end."""
    legs: list[Leg] = []
    for to in memory.returns_to:
        top_ned, over_ned = way_home(pos_ned, to.ground_ned, max(return_up_m, to.over_up_m))
        legs += pairwise((pos_ned, top_ned, over_ned, to.ground_ned))
    return legs
