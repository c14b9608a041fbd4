"""Plan files of real ground stations, as those upload them."""

from __future__ import annotations

import json
import math
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from tests.contract.client import BOTH
from vehicle_sim.autopilot.interface import PlanItem
from vehicle_sim.autopilot.modes import Personality
from vehicle_sim.autopilot.plan import check

SHARED = Path(__file__).parents[3] / "shared" / "data"
FILES = sorted([*SHARED.glob("plans/*.plan"), *SHARED.glob("wpl/*.txt")])
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


@pytest.mark.skipif(not FILES, reason="the shared plans are not here")
@pytest.mark.parametrize("personality", BOTH)
@pytest.mark.parametrize("path", FILES, ids=lambda path: path.name)
def test_plan_files_of_real_ground_stations_are_taken(personality: Personality, path: Path) -> None:
    rows = items_of(path)
    if personality == "ardupilot" and (not rows or rows[0].command != NAV_WAYPOINT):
        rows = [HOME, *rows]
    numbered = tuple(replace(row, seq=seq) for seq, row in enumerate(rows))
    assert check(numbered, personality) is None
