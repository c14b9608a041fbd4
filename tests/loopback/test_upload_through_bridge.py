"""`gcs mission upload` through `gcs bridge`, on links that lose frames or are slow."""

from __future__ import annotations

import json
import math

import pytest

from tests.loopback.flight import HOMES, PERSONALITIES, Personality
from tests.loopback.lossy_link import Weather
from tests.loopback.plan_clients import NORTH_DEG, PlanFlight
from tests.loopback.second_station import SecondStation
from tests.shares import one_in
from tests.unit.plan.samples import plan_document, simple, waypoint

LOSSY = Weather(loss=0.25, delay_s=(0.001, 0.004))
SLOW = Weather(delay_s=(0.25, 0.25))
PATH = "spiral.plan"
LONG_S = 420.0


def spiral(personality: Personality, items: int) -> bytes:
    """A take-off, a spiral within 60 m of home, a return."""
    home = HOMES[personality]
    east_deg = NORTH_DEG / math.cos(math.radians(home.lat_deg))
    places = [
        waypoint(
            n,
            home.lat_deg + 0.5 * n * math.cos(0.3 * n) * NORTH_DEG,
            home.lon_deg + 0.5 * n * math.sin(0.3 * n) * east_deg,
            10,
        )
        for n in range(2, items)
    ]
    first = waypoint(1, home.lat_deg, home.lon_deg, 10, command=22)
    document = plan_document(first, *places, simple(items, 20, 2, [0] * 7))
    return json.dumps(document).encode()


@pytest.mark.parametrize("personality", PERSONALITIES)
@pytest.mark.parametrize("seed", one_in(4, range(1, 5)))
def test_it_comes_on_board_while_both_links_lose_a_quarter(
    personality: Personality, seed: int
) -> None:
    """Asked for after 4 s, as Python and a typed line do: in half of these the origin or home was
    not known by then."""
    flight = PlanFlight(personality, seed=seed, vehicle_weather=LOSSY, client_weather=LOSSY)
    flight.connected()
    station = SecondStation(flight, {PATH: spiral(personality, 120)})
    flight.run(4.0)
    station.say("mission_upload", path=PATH)
    flight.until(lambda: bool(station.ending), LONG_S)
    assert station.ending == "complete"
    assert len(flight.vehicle.plan) == 120 + (personality == "ardupilot")


def test_it_goes_on_while_the_bridge_works_on_it_for_more_than_a_minute() -> None:
    """An item takes half a second to the vehicle, and another one back.  After 60 s without
    progress the upload was ended, and nothing was on board."""
    flight = PlanFlight("px4", vehicle_weather=SLOW)
    flight.run(20.0)
    station = SecondStation(flight, {PATH: spiral("px4", 80)})
    flight.run(10.0)
    station.say("mission_upload", path=PATH)
    began_ns = flight.now_ns
    flight.until(lambda: bool(station.ending), LONG_S)
    assert station.ending == "complete"
    assert flight.now_ns - began_ns > 75_000_000_000
    assert len(flight.vehicle.plan) == 80
