"""Kinds of items that other programs write: brought on board, read back equal and flown."""

from __future__ import annotations

import json
import math
from itertools import pairwise
from pathlib import Path
from typing import Any

from tests.loopback.flight import HOMES, Flight, Personality
from tests.loopback.plan_clients import NORTH_DEG
from tests.unit.plan.samples import plan_document, simple, waypoint

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
