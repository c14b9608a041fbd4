"""A return that is asked for, of a vehicle with a rally point on board.

It flies to the rally point where that is nearer than home, so the gate judges that way as well as
the way home.  A mast stands on the way to the one and beside the way to the other.
"""

from __future__ import annotations

import math
from collections.abc import Callable

import pytest
from pymavlink.dialects.v20 import all as dialect

from gcs.gate.policy.parse import parse_policy
from gcs.gate.policy.policy import Policy
from gcs.gate.states import State
from tests.loopback.bridged import VEHICLE, Client
from tests.loopback.flight import HOMES, Personality
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
from tests.loopback.test_set_current import ARM, DENIED, hovering, wait

RETURN = 20
RTL_BLOCKED, MISSION_DENIED = 21, 14
"""The reason's number in COMMAND_ACK.result_param2; MAV_MISSION_RESULT."""
RALLY_NORTH_M = 50.0
ON_THE_WAY, BESIDE_IT, MAST_RADIUS_M = (10.0, 45.0), (40.0, 20.0), 3.0
"""East and north of a mast: on the way to the rally point, or beside that and the way home."""
BEHIND_THE_MAST = (20.0, 40.0)
STATION = 77
"""System id of another ground station, past the bridge."""


def with_mast(mast: tuple[float, float]) -> Policy:
    return parse_policy(
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
centre = [{mast[0]}, {mast[1]}]
""",
        "rally.toml",
    )


def points(personality: Personality) -> list[PlanItem]:
    home = HOMES[personality]
    north_deg = home.lat_deg + RALLY_NORTH_M * NORTH_DEG
    return [PlanItem(RALLY_POINT, north_deg, home.lon_deg, _up_m(personality), kind=RALLY)]


def _up_m(personality: Personality) -> float:
    """PX4: the ground there; ArduCopter: how high the way there is at least."""
    return 0.0 if personality == "px4" else 15.0


def bring(flight: PlanFlight, personality: Personality) -> None:
    client = flight.clients[1]
    assert Mavsdk(flight, client, points(personality)).ended() == "complete", client.texts()


def behind_the_mast(flight: PlanFlight, personality: Personality) -> Client:
    client = flight.clients[1]
    assert client.ask(ARM, 1) == ACCEPTED
    hovering(flight)
    east_m, north_m = BEHIND_THE_MAST
    shorter = math.cos(math.radians(HOMES[personality].lat_deg))
    place = mission(personality, (north_m, east_m / shorter, 20.0))[-2]
    lat, lon = round(place.lat_deg * 1e7), round(place.lon_deg * 1e7)
    client.send(
        dialect.MAVLink_command_int_message(
            *VEHICLE, 6, dialect.MAV_CMD_DO_REPOSITION, 0, 0, -1, 1, 0, math.nan, lat, lon, 20.0
        )
    )
    wait(flight, lambda: flight.is_in(State.MOVING), 2.0)
    wait(flight, lambda: flight.is_in(State.HOVERING), 60.0)
    return client


def clears_the_mast(flight: PlanFlight, mast: tuple[float, float], seconds: float) -> None:
    for _ in range(round(10 * seconds)):
        flight.clients[1].beat()
        flight.run(0.1)
        assert math.dist(flight.truth_enu()[:2], mast) > MAST_RADIUS_M


def joined(personality: Personality, mast: tuple[float, float] = ON_THE_WAY) -> PlanFlight:
    flight = PlanFlight(personality, policy=with_mast(mast))
    flight.join()
    flight.connected()
    return flight


def refused(flight: PlanFlight, client: Client) -> None:
    """For the way to the rally point, which is named with the zone; the vehicle is held."""
    assert client.ask(RETURN) == DENIED
    assert client.acks(RETURN)[-1].result_param2 == RTL_BLOCKED
    flight.run(0.2)
    assert "the way to rally point 1" in client.texts(), client.texts()
    assert "mast" in client.texts()
    assert flight.is_in(State.HOLDING)
    clears_the_mast(flight, ON_THE_WAY, 20.0)


def test_a_zone_on_the_way_to_the_rally_point_refuses_it(personality: Personality) -> None:
    flight = joined(personality)
    bring(flight, personality)
    refused(flight, behind_the_mast(flight, personality))


def points_north(personality: Personality, *norths_m: float) -> list[PlanItem]:
    home = HOMES[personality]
    return [
        PlanItem(
            RALLY_POINT, home.lat_deg + m * NORTH_DEG, home.lon_deg, _up_m(personality), kind=2
        )
        for m in norths_m
    ]


MAST_AT_50_M = (0.0, 50.0)
NEAR_THE_MAST_M = 54.0
"""Outside the mast by a metre, and within the margin."""


@pytest.mark.parametrize(
    ("north_m", "says"),
    [(50.0, "is inside"), (NEAR_THE_MAST_M, "margin"), (300.0, "m outside")],
    ids=["in a zone", "within its margin", "outside the fence"],
)
def test_rally_points_where_nobody_may_land_never_reach_the_vehicle(
    north_m: float, says: str, personality: Personality
) -> None:
    """Its own failsafe may return there, which no gate can refuse."""
    flight = joined(personality, MAST_AT_50_M)
    client = flight.clients[1]
    asked = len(flight.to_vehicle("MISSION_COUNT"))
    upload = Mavsdk(flight, client, points_north(personality, 20.0, north_m))
    assert upload.ended() == f"refused {MISSION_DENIED}", client.texts()
    assert len(flight.to_vehicle("MISSION_COUNT")) == asked
    flight.run(0.5)
    (line,) = [text for text in client.texts().splitlines() if "rally point 2: " in text]
    assert says in line
    assert ("mast" in line) is (north_m != 300.0)


def test_points_on_board_where_nobody_may_land_are_told_once_when_they_are_read(
    personality: Personality,
) -> None:
    flight = joined(personality, MAST_AT_50_M)
    past_the_bridge(flight, points_north(personality, 20.0, 50.0))
    flight.beating(5.0)
    told = [line for line in flight.told() if "may land there" in line]
    assert len(told) == 1, told
    assert "rally point on board 2" in told[0]
    assert "mast" in told[0]


def test_where_all_ways_are_clear_it_returns_to_the_rally_point(personality: Personality) -> None:
    flight = joined(personality, BESIDE_IT)
    bring(flight, personality)
    client = behind_the_mast(flight, personality)
    assert client.ask(RETURN) == ACCEPTED
    clears_the_mast(flight, BESIDE_IT, 40.0)
    assert math.dist(flight.truth_enu()[:2], (0.0, RALLY_NORTH_M)) < 3.0


def test_points_that_were_on_board_before_are_read(personality: Personality) -> None:
    """Put there by another station, before this one had heard the vehicle."""
    flight = PlanFlight(personality, policy=with_mast(ON_THE_WAY))
    past_the_bridge(flight, points(personality))
    flight.join()
    flight.connected()
    refused(flight, behind_the_mast(flight, personality))


def test_points_that_another_station_brings_in_flight_are_read_again(
    personality: Personality,
) -> None:
    flight = joined(personality)
    client = behind_the_mast(flight, personality)
    past_the_bridge(flight, points(personality))
    flight.beating(2.0)
    refused(flight, client)


def test_points_brought_and_cleared_in_flight_count_at_once(personality: Personality) -> None:
    flight = joined(personality)
    client = behind_the_mast(flight, personality)
    bring(flight, personality)
    refused(flight, client)
    client.send(dialect.MAVLink_mission_clear_all_message(*VEHICLE, RALLY))
    flight.run(1.0)
    assert client.ask(RETURN) == ACCEPTED
    clears_the_mast(flight, ON_THE_WAY, 30.0)
    assert math.dist(flight.truth_enu()[:2], (0.0, 0.0)) < 3.0


def test_while_points_are_on_their_way_no_return_is_cleared(personality: Personality) -> None:
    """From the first message that may change them, until they are read back."""
    flight = joined(personality)
    client = behind_the_mast(flight, personality)
    upload = Mavsdk(flight, client, points(personality))
    wait_fast(flight, lambda: bool(flight.to_vehicle("MISSION_COUNT")))
    client.command(RETURN)
    flight.run(0.05)
    assert client.acks(RETURN)[-1].result_param2 == RTL_BLOCKED
    assert "still being read" in client.texts(), client.texts()
    assert upload.ended() == "complete"
    flight.beating(3.0)
    refused(flight, client)


def test_a_return_along_the_mission_is_refused_with_its_type() -> None:
    """RTL_TYPE 1 may lead to the landing of the mission on board."""
    flight = joined("px4", BESIDE_IT)
    client = behind_the_mast(flight, "px4")
    flight.vehicle.parameters.set("RTL_TYPE", 1)
    client.send(dialect.MAVLink_param_request_read_message(*VEHICLE, b"RTL_TYPE", -1))
    flight.run(0.5)
    assert client.ask(RETURN) == DENIED
    flight.run(0.2)
    assert "RTL_TYPE 1" in client.texts(), client.texts()
    assert "land instead" in client.texts()


def test_a_rally_point_as_a_single_message_makes_them_be_read_again(
    personality: Personality,
) -> None:
    """RALLY_POINT, which old clients of an ArduPilot send, has no answer."""
    flight = joined(personality)
    client = flight.clients[1]
    asked = len(flight.to_vehicle("MISSION_REQUEST_LIST"))
    home = HOMES[personality]
    lat, lon = round(home.lat_deg * 1e7), round(home.lon_deg * 1e7)
    client.send(dialect.MAVLink_rally_point_message(*VEHICLE, 0, 1, lat, lon, 20, 0, 0, 0))
    flight.run(0.5)
    assert flight.to_vehicle("RALLY_POINT")
    assert len(flight.to_vehicle("MISSION_REQUEST_LIST")) == asked + 1


def test_a_rally_point_as_a_single_message_is_refused_where_nobody_may_land() -> None:
    flight = joined("ardupilot", MAST_AT_50_M)
    client, (point,) = flight.clients[1], points_north("ardupilot", 50.0)
    lat, lon = round(point.lat_deg * 1e7), round(point.lon_deg * 1e7)
    client.send(dialect.MAVLink_rally_point_message(*VEHICLE, 1, 2, lat, lon, 20, 0, 0, 0))
    flight.run(0.5)
    assert not flight.to_vehicle("RALLY_POINT")
    assert "rally point 2: " in client.texts()
    assert "mast" in client.texts()


def past_the_bridge(flight: PlanFlight, items: list[PlanItem]) -> None:
    """Another station on the vehicle's own link brings rally points on board."""
    mav = dialect.MAVLink(None, srcSystem=STATION, srcComponent=190)
    count = dialect.MAVLink_mission_count_message(*VEHICLE, len(items), RALLY)
    flight.up.send(count.pack(mav), flight.now_ns)
    for seq, item in enumerate(items):
        flight.run(0.1)
        message = dialect.MAVLink_mission_item_int_message(
            *VEHICLE,
            seq,
            item.frame,
            item.command,
            0,
            1,
            *item.params,
            round(item.lat_deg * 1e7),
            round(item.lon_deg * 1e7),
            item.alt_m,
            RALLY,
        )
        flight.up.send(message.pack(mav), flight.now_ns)
    flight.run(0.1)


def wait_fast(flight: PlanFlight, true: Callable[[], bool]) -> None:
    for _ in range(100):
        if true():
            return
        flight.run(0.005)
    raise AssertionError("not within half a second")
