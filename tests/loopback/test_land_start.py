"""DO_LAND_START as a command: the landing of the mission on board, from wherever the vehicle is."""

from __future__ import annotations

from gcs.gate.states import State
from tests.loopback.bridged import Client, joined
from tests.loopback.flight import HOMES, Personality
from tests.loopback.plan_clients import (
    ACCEPTED,
    NO_PLACE,
    NORTH_DEG,
    Mavsdk,
    PlanFlight,
    PlanItem,
    mission,
)
from tests.loopback.test_set_current import least_m, seq, shown, wait

ARM, MISSION_START, LAND_START, LAND, WAYPOINT = 400, 300, 189, 21, 16
DENIED = 2
FAR = (40.0, 0.0, 10.0)
"""North, east, up of home; the landing's own waypoint is 15 m north."""
LANDING_NORTH_M = 15.0


def with_landing(personality: Personality) -> list[PlanItem]:
    """A take-off, one waypoint, the marker, a waypoint and the landing."""
    home = HOMES[personality]
    north_deg = home.lat_deg + LANDING_NORTH_M * NORTH_DEG
    way = mission(personality, FAR)[:-1]
    return [
        *way,
        PlanItem(LAND_START, frame=NO_PLACE),
        PlanItem(WAYPOINT, north_deg, home.lon_deg, 8.0),
        PlanItem(LAND, north_deg, home.lon_deg, 0.0),
    ]


def on_its_way(personality: Personality, items: list[PlanItem]) -> tuple[PlanFlight, Client]:
    """On the way to its first waypoint."""
    flight, client = joined(PlanFlight(personality))
    assert Mavsdk(flight, client, items).ended() == "complete", client.texts()
    assert client.ask(ARM, 1) == ACCEPTED
    client.command(MISSION_START)
    wait(flight, lambda: flight.is_in(State.FLYING_MISSION), 10.0)
    first = seq(personality, 1)
    wait(flight, lambda: shown(flight) == first, 60.0)
    return flight, client


def test_the_mission_lands_by_its_own_landing(personality: Personality) -> None:
    flight, client = on_its_way(personality, with_landing(personality))
    assert client.ask(LAND_START, within_s=20.0) == ACCEPTED
    asked = [one.word for one in flight.decisions("accepted")][-4:]
    assert asked == ["hold", "resume", "mission_set_current", "mission_start"]
    assert flight.is_in(State.FLYING_MISSION)
    assert least_m(flight, (0.0, FAR[0]), 10.0) > 15.0
    wait(flight, lambda: not flight.vehicle.armed, 60.0)
    east_m, north_m, _ = flight.truth_enu()
    assert abs(north_m - LANDING_NORTH_M) < 2.0
    assert abs(east_m) < 2.0


def test_a_mission_without_the_marker_flies_on(personality: Personality) -> None:
    flight, client = on_its_way(personality, mission(personality, FAR))
    assert client.ask(LAND_START) == DENIED
    assert "has no DO_LAND_START item" in client.texts()
    assert flight.is_in(State.FLYING_MISSION)
