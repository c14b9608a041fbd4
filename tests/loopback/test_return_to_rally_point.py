"""A return that is asked for, of a vehicle with a rally point on board.

It flies to the rally point where that is nearer than home; the gate judges the way home alone.
"""

from __future__ import annotations

import math

import pytest
from pymavlink.dialects.v20 import all as dialect

from gcs.gate.policy.parse import parse_policy
from gcs.gate.states import State
from tests.loopback.bridged import VEHICLE
from tests.loopback.flight import HOMES, PERSONALITIES, Personality
from tests.loopback.plan_clients import (
    ACCEPTED,
    NORTH_DEG,
    RALLY,
    RALLY_POINT,
    Mavsdk,
    PlanFlight,
    PlanItem,
    mission,
)
from tests.loopback.test_set_current import ARM, hovering, wait

RETURN = 20
RALLY_NORTH_M = 50.0
MAST, MAST_RADIUS_M = (10.0, 45.0), 3.0
"""East and north; on the way to the rally point, and beside the way home."""
BEHIND_THE_MAST = (20.0, 40.0)
POLICY = parse_policy(
    f"""
[bridge]
rally = "forward"
[[fence]]
name = "field"
kind = "circle"
radius_m = 140.0
centre = [0.0, 0.0]
[[fence]]
name = "mast"
kind = "circle"
inclusion = false
radius_m = {MAST_RADIUS_M}
centre = [{MAST[0]}, {MAST[1]}]
""",
    "rally.toml",
)


@pytest.mark.xfail(
    strict=True,
    reason="the gate judges a return by its way home, and the vehicle flies to the rally point",
)
@pytest.mark.parametrize("personality", PERSONALITIES)
def test_a_return_to_a_rally_point_does_not_cross_a_zone(personality: Personality) -> None:
    flight = PlanFlight(personality, policy=POLICY)
    client = flight.join()
    flight.connected()
    home = HOMES[personality]
    north_deg = home.lat_deg + RALLY_NORTH_M * NORTH_DEG
    points = [PlanItem(RALLY_POINT, north_deg, home.lon_deg, 15.0, kind=RALLY)]
    assert Mavsdk(flight, client, points).ended() == "complete", client.texts()
    assert client.ask(ARM, 1) == ACCEPTED
    hovering(flight)
    east_m, north_m = BEHIND_THE_MAST
    shorter = math.cos(math.radians(home.lat_deg))
    place = mission(personality, (north_m, east_m / shorter, 20.0))[-2]
    lat, lon = round(place.lat_deg * 1e7), round(place.lon_deg * 1e7)
    client.send(
        dialect.MAVLink_command_int_message(
            *VEHICLE, 6, dialect.MAV_CMD_DO_REPOSITION, 0, 0, -1, 1, 0, math.nan, lat, lon, 20.0
        )
    )
    wait(flight, lambda: flight.is_in(State.MOVING), 2.0)
    wait(flight, lambda: flight.is_in(State.HOVERING), 60.0)
    client.command(RETURN)
    nearest_m = math.inf
    for _ in range(300):
        client.beat()
        flight.run(0.1)
        nearest_m = min(nearest_m, math.dist(flight.truth_enu()[:2], MAST))
    assert nearest_m > MAST_RADIUS_M
