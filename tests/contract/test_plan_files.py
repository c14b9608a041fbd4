"""Plan files, our own and those of real ground stations, as stations upload them."""

from __future__ import annotations

import json
import math
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from tests.contract.client import BOTH
from tests.sample_files import SAMPLES, elsewhere
from vehicle_sim.autopilot.interface import PlanItem
from vehicle_sim.autopilot.mission.plan import check
from vehicle_sim.autopilot.modes import Personality

OURS = (
    "plans/around_a_zone.plan",
    "plans/box.plan",
    "plans/corridor.plan",
    "plans/photos_and_a_jump.plan",
    "plans/survey.plan",
    "plans/without_a_mission.plan",
    "tables/above_sea_level.txt",
    "tables/jump.waypoints",
    "tables/without_home.txt",
)
THEIRS = (
    "plans/MC_mission_box.plan",
    "plans/ce_geofence_outfield.plan",
    "plans/example-mission.plan",
    "plans/multicopter_mission_geofence_avoid.plan",
    "plans/qgroundcontrol_sample.plan",
    "plans/qgroundcontrol_sample_with_digicam_control.plan",
    "plans/qgroundcontrol_sample_with_structured_scan.plan",
    "plans/qgroundcontrol_sample_with_survey.plan",
    "plans/qgroundcontrol_sample_with_survey_missing_items.plan",
    "plans/qgroundcontrol_sample_with_survey_wrong_version.plan",
    "plans/qgroundcontrol_sample_without_mission.plan",
    "plans/qgroundcontrol_sample_wrong_mission_version.plan",
    "plans/qgroundcontrol_sample_wrong_overall_version.plan",
    "wpl/cmac-foamy-mission-cw.txt",
    "wpl/mission_planner_sample.txt",
    "wpl/mpmission.txt",
)
HOME = PlanItem(0, 0, 16, 0.0, 0.0, 0.0, 0.0, 0, 0, 0.0, 1)
NAV_WAYPOINT = 16
MISSION_FRAME = 2


def qgc_items(nodes: list[dict[str, Any]]) -> list[PlanItem]:
    """Simple items, and those that a survey was made into; null is NaN."""
    items: list[PlanItem] = []
    for node in nodes:
        if node.get("type") == "ComplexItem":
            items += qgc_items(node.get("TransectStyleComplexItem", {}).get("Items", []))
            continue
        p = [math.nan if value is None else float(value) for value in node["params"]]
        scale = 1.0 if node["frame"] == MISSION_FRAME else 1e7
        x, y = (0 if math.isnan(value) else round(value * scale) for value in p[4:6])
        frame, command = int(node["frame"]), int(node["command"])
        items.append(PlanItem(0, frame, command, p[0], p[1], p[2], p[3], x, y, p[6], 1))
    return items


def items_of(path: Path) -> list[PlanItem]:
    text = path.read_text(encoding="utf-8")
    if path.suffix == ".plan":
        return qgc_items(json.loads(text).get("mission", {}).get("items", []))
    items = []
    for line in text.splitlines()[1:]:
        f = line.split()
        p = [float(value) for value in f[4:11]]
        x, y = round(p[4] * 1e7), round(p[5] * 1e7)
        frame, command = int(f[2]), int(f[3])
        items.append(PlanItem(0, frame, command, p[0], p[1], p[2], p[3], x, y, p[6], 1))
    return items


@pytest.mark.parametrize("personality", BOTH)
@pytest.mark.parametrize("name", OURS)
def test_our_plan_files_are_taken(personality: Personality, name: str) -> None:
    taken(personality, SAMPLES / name)


@pytest.mark.parametrize("personality", BOTH)
@pytest.mark.parametrize("name", THEIRS)
def test_plan_files_of_real_ground_stations_are_taken(personality: Personality, name: str) -> None:
    taken(personality, elsewhere(name))


def taken(personality: Personality, path: Path) -> None:
    rows = items_of(path)
    if personality == "ardupilot" and (not rows or rows[0].command != NAV_WAYPOINT):
        rows = [HOME, *rows]
    numbered = tuple(replace(row, seq=seq) for seq, row in enumerate(rows))
    if personality == "px4":
        # WPL files carry items without a place in frames that have one, which PX4 refuses: ground
        # stations send frame 2.
        refused = "is not supported for an item without a place"
        while (wrong := check(numbered, personality)) is not None and refused in wrong[1]:
            seq = wrong[0]
            assert numbered[seq].frame != MISSION_FRAME
            mended = replace(numbered[seq], frame=MISSION_FRAME)
            numbered = (*numbered[:seq], mended, *numbered[seq + 1 :])
    assert check(numbered, personality) is None
