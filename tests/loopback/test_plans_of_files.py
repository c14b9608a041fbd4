"""Plans of files on their way to the vehicle: long, over links that lose, of all kinds of items."""

from __future__ import annotations

import json
import math
from itertools import pairwise
from pathlib import Path
from typing import Any

import pytest

from tests.loopback.flight import HOMES, Flight, Personality
from tests.loopback.lossy_link import Weather
from tests.loopback.plan_clients import NORTH_DEG, PlanFlight
from tests.loopback.second_station import SecondStation
from tests.shares import one_in
from tests.unit.plan.samples import plan_document, simple, waypoint
from vehicle_sim.autopilot.firmware import Firmware

# ------------------------------------------------------------------------------
# A plan of 500 items crosses a link that loses a quarter both ways, and is read back equal.

ITEMS = 500
MOST_S = 150.0
LOSSY = Weather(loss=0.25, delay_s=(0.001, 0.004))
SEEDS = (1, 2, 3, 4, 5)
USUAL_SEED = 1
"""The others are run with `-m soak`."""


def long_plan(path: Path, personality: Personality, items: int = ITEMS) -> str:
    """A take-off, a spiral of waypoints within 60 m, a return: 500 items as a table."""
    home = HOMES[personality]
    lines = ["QGC WPL 110"]

    def add(frame: int, command: int, lat_deg: float, lon_deg: float, alt_m: float) -> None:
        seq = len(lines) - 1
        place = f"{lat_deg:.7f}\t{lon_deg:.7f}\t{alt_m:g}"
        lines.append(f"{seq}\t0\t{frame}\t{command}\t0\t0\t0\t0\t{place}\t1")

    add(0, 16, home.lat_deg, home.lon_deg, home.alt_amsl_m)
    add(3, 22, home.lat_deg, home.lon_deg, 10.0)
    for number in range(items - 2):
        angle, radius_deg = 0.1 * number, 1e-6 * number
        lat_deg = home.lat_deg + radius_deg * math.cos(angle)
        lon_deg = home.lon_deg + radius_deg * math.sin(angle)
        add(3, 16, lat_deg, lon_deg, 10.0)
    add(2, 20, 0.0, 0.0, 0.0)
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return str(path)


def seeds() -> list[object]:
    rare = pytest.mark.soak
    return [pytest.param(seed, marks=[] if seed == USUAL_SEED else [rare]) for seed in SEEDS]


@pytest.mark.parametrize("seed", seeds())
def test_five_hundred_items_cross_a_link_that_loses_a_quarter(
    personality: Personality, seed: int, tmp_path: Path
) -> None:
    flight = Flight(personality, seed=seed, up=LOSSY, down=LOSSY).connected()
    path = long_plan(tmp_path / "long.waypoints", personality)
    began_s = flight.elapsed_s
    assert flight.done(flight.say("mission_upload", path=path), MOST_S) == "complete"
    print(f"{personality} seed {seed}: {flight.elapsed_s - began_s:.1f} s")
    home_items = 1 if personality == "ardupilot" else 0
    assert len(flight.vehicle.plan) == ITEMS + home_items


@pytest.mark.parametrize("firmware", ["4.5", "4.7"])
def test_the_return_height_is_known_by_either_generation_of_names(
    firmware: Firmware, tmp_path: Path
) -> None:
    """A plan that ends in a return, uploaded at once, while a quarter of all answers is lost."""
    flight = Flight("ardupilot", firmware=firmware, up=LOSSY, down=LOSSY).connected()
    path = long_plan(tmp_path / "short.waypoints", "ardupilot", items=6)
    flight.do("mission_upload", path=path)


# ------------------------------------------------------------------------------
# `gcs mission upload` through `gcs bridge`, on links that lose frames or are slow.

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


# ------------------------------------------------------------------------------
# Kinds of items that other programs write: brought on board, read back equal and flown.

RELATIVE = 3
MISS_M = 1.5


def brought(flight: Flight, folder: Path, *items: dict[str, Any]) -> None:
    """As a file of these items, numbered from 1."""
    numbered = [item | {"doJumpId": n} for n, item in enumerate(items, start=1)]
    file = folder / "mission.plan"
    file.write_text(json.dumps(plan_document(*numbered)))
    flight.do("mission_upload", path=str(file))


def does(command: int, *params: float, frame: int = RELATIVE) -> dict[str, Any]:
    return simple(0, command, frame, [*params, *[0.0] * (7 - len(params))])


def at(personality: Personality, north_m: float, command: int = 16) -> dict[str, Any]:
    home = HOMES[personality]
    return waypoint(0, home.lat_deg + north_m * NORTH_DEG, home.lon_deg, 5.0, command)


def test_px4_takes_a_return_that_a_file_has_in_frame_3(tmp_path: Path) -> None:
    """real_autopilots.md 6, and so it is with all that has no place."""
    flight = Flight("px4").connected()
    speed, gripper = does(178, 1.0, 4.0, -1.0), does(211, 1.0, 1.0)
    ways = (at("px4", 0.0, 22), speed, at("px4", 10.0), gripper, does(20))
    brought(flight, tmp_path, *ways)
    assert [item.frame for item in flight.vehicle.plan] == [6, 2, 6, 2, 2]


def test_an_ardupilot_flies_a_jump_to_a_tag_that_was_verified(tmp_path: Path) -> None:
    """There and back, once more from the tag on, and home; a servo and a relay on the way."""
    flight = Flight("ardupilot").connected()
    tag, again = does(600, 7.0), does(601, 7.0, 1.0)
    ways = (
        at("ardupilot", 0.0, 22),
        tag,
        at("ardupilot", 15.0),
        does(183, 9.0, 1500.0),
        does(181, 0.0, 1.0),
        at("ardupilot", 2.0),
        again,
        does(20),
    )
    brought(flight, tmp_path, *ways)
    flight.do("arm")
    ask = flight.say("mission_start")
    far: list[bool] = []
    while flight.outcome(ask) is None:
        assert flight.elapsed_s < 300.0, flight.told()
        flight.run(0.1)
        east_m, north_m, _ = flight.truth_enu()
        far.append(math.dist((east_m, north_m), (0.0, 15.0)) < MISS_M)
    assert flight.outcome(ask) == "complete"
    came = [now for before, now in pairwise(far) if now and not before]
    assert len(came) == 2
