"""The gate's law before a model of a PX4 that stops as the real one was recorded to stop: a hold
fits at every moment of a leg to the fence, what its integrator carries on included."""

from __future__ import annotations

import itertools
import json
from pathlib import Path
from statistics import mean
from typing import Any

import pytest

from tests.unit.gate.airspace import at
from tests.unit.gate.px4_loops import STEP_S, Craft
from tests.unit.gate.test_pace import RADIUS_M, field

FACTS = Path(__file__).parents[2] / "real" / "facts" / "px4.jsonl"
TICK = round(0.05 / STEP_S)
LATE_S = 0.15
"""How old a position is when the gate has it."""
SLOW_BY_M_S = 0.25
"""So much slower than the truth a PX4's own velocity was at the end of a leg (recorded)."""
BEFORE_M = 2.2
"""The goal's distance to the fence: the margin is 2 m."""


def recorded_stop_m(kind: str, asked_m_s: float) -> float:
    facts: list[dict[str, Any]] = [json.loads(line) for line in FACTS.read_text().splitlines()]
    stops_m: list[float] = [
        fact["stop_m"]
        for fact in facts
        if fact["kind"] == kind
        and fact["asked_m_s"] == asked_m_s
        and fact["direction"] not in ("up", "down")
    ]
    return mean(stops_m)


@pytest.mark.parametrize("asked_m_s", [4.0, 6.0, 8.0, 10.0])
def test_it_stops_from_a_steady_speed_as_recorded(asked_m_s: float) -> None:
    craft = Craft()
    for _ in range(round(10.0 / STEP_S)):
        craft.fly_at(asked_m_s)
    stop_m = craft.farthest_of_a_hold() - craft.x
    assert stop_m == pytest.approx(recorded_stop_m("steady", asked_m_s), rel=0.15)


@pytest.mark.parametrize("asked_m_s", [0.5, 1.0, 1.5, 2.0, 3.0, 5.0])
def test_it_stops_after_slowing_down_as_recorded(asked_m_s: float) -> None:
    craft = Craft()
    for _ in range(round(10.0 / STEP_S)):
        craft.fly_at(10.0)
    place_m = craft.x
    while craft.v > asked_m_s:
        craft.fly_to(place_m)
    stop_m = craft.farthest_of_a_hold() - craft.x
    assert stop_m == pytest.approx(recorded_stop_m("slowing", asked_m_s), rel=0.15)


@pytest.mark.slow
@pytest.mark.parametrize("leg_m", [20.0, 57.0, 147.8, 280.0])
def test_a_hold_fits_at_every_moment_of_a_leg_to_the_fence(leg_m: float) -> None:
    law, goal_m = field("px4"), RADIUS_M - BEFORE_M
    craft = Craft(goal_m - leg_m)
    sent_m = craft.x
    nearest_m = RADIUS_M
    for step in itertools.count():
        if step % TICK == 0:
            told_m, told_m_s = craft.told_s_ago(LATE_S)
            slow_m_s = max(0.0, told_m_s - SLOW_BY_M_S)
            here, v_ned = at(told_m, 0, 20), at(slow_m_s, 0, 0)
            sent_m = law.paced(at(goal_m, 0, 20), here, v_ned, LATE_S).target_ned[1]
            if craft.x > goal_m - 30.0:
                nearest_m = min(nearest_m, RADIUS_M - craft.farthest_of_a_hold())
        craft.fly_to(sent_m)
        if craft.x > goal_m - 1.0 and craft.v <= 0.0:
            break
    assert nearest_m > 0.5
