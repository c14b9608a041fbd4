"""A plan of 500 items crosses a link that loses a quarter both ways, and is read back equal."""

from __future__ import annotations

import math
from pathlib import Path

import pytest

from tests.loopback.flight import HOMES, PERSONALITIES, Flight, Personality
from tests.loopback.lossy_link import Weather
from vehicle_sim.autopilot.firmware import Firmware

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


@pytest.mark.parametrize("personality", PERSONALITIES)
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
