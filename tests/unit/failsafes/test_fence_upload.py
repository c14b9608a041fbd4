"""A fence on its way from the wire into the air, by the services and the vehicle together."""

from __future__ import annotations

import pytest

from tests.unit.autopilot.flight import Flight
from tests.unit.failsafes.ground import box, point, said
from vehicle_sim.autopilot.interface import PlanItem
from vehicle_sim.autopilot.modes import Personality
from vehicle_sim.effects import Client, Send
from vehicle_sim.services.missions.mission import MissionServer
from vehicle_sim.services.missions.plan_items import to_int
from vehicle_sim.services.profile import PROFILES
from vehicle_sim.wire import messages as m
from vehicle_sim.wire.ids import MissionResult, MissionType

GROUND = Client(0, 255, 190)
BOTH: tuple[Personality, ...] = ("px4", "ardupilot")
either = pytest.mark.parametrize("personality", BOTH)


def upload(server: MissionServer, items: tuple[PlanItem, ...], kind: MissionType) -> int:
    """The result of the final ack."""
    effects = server.count(GROUND, m.MissionCount(len(items), 1, 1, kind), 0)
    for item in items:
        effects = server.item(GROUND, to_int(item, GROUND, kind), 0)
    (ack,) = [
        each.message
        for each in effects
        if isinstance(each, Send) and isinstance(each.message, m.MissionAck)
    ]
    return ack.type


def outside(flight: Flight) -> bool:
    return flight.vehicle.fence_state.breached


@either
def test_an_uploaded_fence_acts_and_a_refused_one_leaves_it_in_force(
    personality: Personality,
) -> None:
    flight = Flight.hovering(personality, 5.0)
    if personality == "ardupilot":
        flight.vehicle.parameters.set("FENCE_ENABLE", 1)
    server = MissionServer(flight.vehicle, PROFILES[personality])
    assert upload(server, box(personality, 30.0), MissionType.FENCE) == MissionResult.ACCEPTED
    flight.fly(0.3)
    assert not outside(flight)
    torn = box(personality, 2.0)[:3]
    assert upload(server, torn, MissionType.FENCE) == MissionResult.ERROR
    assert len(server.plan(MissionType.FENCE)) == 4
    flight.vehicle.reposition((25.0, 0.0, -5.0), None, None)
    flight.fly(12.0)
    assert not outside(flight)
    small = (point(personality, 0, 5003, (0.0, 0.0), 10.0),)
    assert upload(server, small, MissionType.FENCE) == MissionResult.ACCEPTED
    flight.fly(0.3)
    assert outside(flight)
    assert said(flight, "Geofence violation" if personality == "px4" else "Polygon fence breached")
    server.clear(GROUND, m.MissionClearAll(1, 1, MissionType.FENCE))
    flight.fly(0.3)
    assert not outside(flight)


@either
def test_fence_and_rally_points_outlive_a_reboot(personality: Personality) -> None:
    flight = Flight(personality).boot()
    server = MissionServer(flight.vehicle, PROFILES[personality])
    far = (point(personality, 0, 5004, (0.0, 0.0), 10.0),)
    assert upload(server, far, MissionType.FENCE) == MissionResult.ACCEPTED
    if personality == "ardupilot":
        flight.vehicle.parameters.set("FENCE_ENABLE", 1)
    flight.vehicle.reboot()
    flight.fly(1.5)
    assert not flight.vehicle.armable
