"""The keyboard manager: a pending goal and the keys that change it."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from gcs.tui.keyboard import DIRECTIONS, STEPS_M, PendingGoal

OPPOSITE = {
    "east": "west", "west": "east", "north": "south", "south": "north", "up": "down", "down": "up",
}  # fmt: skip


def test_it_starts_half_a_metre_up_like_the_lab() -> None:
    assert PendingGoal().goal_enu == (0.0, 0.0, 0.5)
    assert PendingGoal().yaw_deg is None


@pytest.mark.parametrize(
    ("direction", "goal_enu"),
    [
        ("east", (1.0, 0.0, 0.5)), ("west", (-1.0, 0.0, 0.5)), ("north", (0.0, 1.0, 0.5)),
        ("south", (0.0, -1.0, 0.5)), ("up", (0.0, 0.0, 1.5)), ("down", (0.0, 0.0, -0.5)),
    ],
)  # fmt: skip
def test_each_key_moves_one_axis_one_way(
    direction: str, goal_enu: tuple[float, float, float]
) -> None:
    assert PendingGoal().moved(direction).goal_enu == goal_enu


@given(st.lists(st.sampled_from(sorted(DIRECTIONS)), max_size=40), st.sampled_from(STEPS_M))
def test_going_back_the_same_way_ends_exactly_where_it_began(ways: list[str], step: float) -> None:
    pending = PendingGoal(step_m=step)
    for way in ways:
        pending = pending.moved(way)
    for way in reversed(ways):
        pending = pending.moved(OPPOSITE[way])
    assert pending.goal_enu == (0.0, 0.0, 0.5)
    assert "-0.0" not in str(pending.goal_enu)


def test_steps_go_round() -> None:
    pending = PendingGoal()
    seen = []
    for _ in STEPS_M:
        pending = pending.with_next_step()
        seen.append(pending.step_m)
    assert sorted(seen) == sorted(STEPS_M)
    assert pending == PendingGoal()


def test_yaw_starts_from_the_vehicles_heading_and_goes_round() -> None:
    assert PendingGoal().turned(15, 29.0).yaw_deg == 45.0
    assert PendingGoal().turned(-15, None).yaw_deg == 345.0
    assert PendingGoal(yaw_deg=350.0).turned(15, 90.0).yaw_deg == 5.0
    assert PendingGoal(yaw_deg=350.0).with_free_yaw().yaw_deg is None


@pytest.mark.parametrize(("up_m", "asked_m"), [(0.5, 1.5), (-3.0, 1.5), (4.0, 4.0)])
def test_a_take_off_goes_to_the_pending_height_but_not_too_low(up_m: float, asked_m: float) -> None:
    assert PendingGoal((0.0, 0.0, up_m)).take_off_up_m == asked_m
