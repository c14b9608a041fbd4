"""`gcs mission upload` through `gcs bridge`, while both links lose a quarter of all frames."""

from __future__ import annotations

import json
import math

import pytest

from tests.loopback.flight import HOMES, PERSONALITIES, Personality
from tests.loopback.lossy_link import Weather
from tests.loopback.plan_clients import NORTH_DEG, PlanFlight
from tests.loopback.second_station import SecondStation
from tests.shares import seeds
from tests.unit.plan.samples import plan_document, simple, waypoint

LOSSY = Weather(loss=0.25, delay_s=(0.001, 0.004))
ITEMS = 120
PATH = "spiral.plan"
LONG_S = 420.0


def spiral(personality: Personality) -> bytes:
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
        for n in range(2, ITEMS)
    ]
    first = waypoint(1, home.lat_deg, home.lon_deg, 10, command=22)
    document = plan_document(first, *places, simple(ITEMS, 20, 2, [0] * 7))
    return json.dumps(document).encode()


@pytest.mark.parametrize("personality", PERSONALITIES)
@pytest.mark.parametrize("seed", seeds(8, 4, 16))
def test_it_comes_on_board_while_both_links_lose_a_quarter(
    personality: Personality, seed: int
) -> None:
    flight = PlanFlight(personality, seed=seed, vehicle_weather=LOSSY, client_weather=LOSSY)
    flight.connected()
    station = SecondStation(flight, {PATH: spiral(personality)})
    flight.run(30.0)
    station.say("mission_upload", path=PATH)
    began_ns = flight.now_ns
    flight.until(lambda: bool(station.ending), LONG_S)
    print(f"{personality} {seed}: {(flight.now_ns - began_ns) / 1e9:.0f} s, {station.ending}")
    assert station.ending == "complete"
    assert len(flight.vehicle.plan) == ITEMS + (personality == "ardupilot")
