"""d = v t_react + v^2 / (2 a_brake) + position error + margin."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from gcs.gate.airspace.stopping import distance_h_m, distance_v_m, stop_point, travel_m
from gcs.gate.policy.policy import Braking

BRAKING = Braking(0.5, 4.0, 2.0, position_error_h_m=0.3, position_error_v_m=0.2)

speeds = st.floats(-100.0, 100.0)
velocities = st.tuples(speeds, speeds, speeds)


def test_the_equation_horizontal_and_vertical_apart() -> None:
    # 5 m/s: 2.5 m of reaction and 25 / 8 of braking; 2 m/s down: 1 m and 4 / 4
    v_ned = (3.0, 4.0, 2.0)
    assert distance_h_m(v_ned, BRAKING, 1.0) == pytest.approx(2.5 + 3.125 + 0.3 + 1.0)
    assert distance_v_m(v_ned, BRAKING, 0.5) == pytest.approx(1.0 + 1.0 + 0.2 + 0.5)


def test_standing_still_leaves_error_and_margin() -> None:
    assert distance_h_m((0.0, 0.0, 0.0), BRAKING, 1.0) == pytest.approx(1.3)
    assert stop_point((1.0, 2.0, 3.0), (0.0, 0.0, 0.0), BRAKING) == (1.0, 2.0, 3.0)


def test_the_stop_lies_along_the_velocity() -> None:
    stop_ned = stop_point((0.0, 0.0, -10.0), (3.0, 4.0, 2.0), BRAKING)
    assert stop_ned == pytest.approx((5.625 * 0.6, 5.625 * 0.8, -8.0))
    assert stop_point((0.0, 0.0, 0.0), (0.0, 0.0, -2.0), BRAKING) == pytest.approx((0, 0, -2.0))


@given(speeds, speeds)
def test_faster_is_never_shorter(v1: float, v2: float) -> None:
    slow, fast = sorted((abs(v1), abs(v2)))
    assert travel_m(slow, 0.5, 4.0) <= travel_m(fast, 0.5, 4.0)


@given(velocities, st.floats(1.0, 3.0), st.floats(0.0, 5.0))
def test_every_term_only_lengthens(
    v_ned: tuple[float, float, float], k: float, margin_m: float
) -> None:
    faster = (v_ned[0] * k, v_ned[1] * k, v_ned[2] * k)
    weaker = Braking(0.5 * k, 4.0 / k, 2.0 / k, 0.3 * k, 0.2 * k)
    for distance in (distance_h_m, distance_v_m):
        d = distance(v_ned, BRAKING, margin_m)
        assert distance(faster, BRAKING, margin_m) >= d - 1e-9
        assert distance(v_ned, weaker, margin_m) >= d
        assert distance(v_ned, BRAKING, margin_m * k) >= d


@given(velocities)
def test_the_stop_is_as_far_as_the_distance_says(v_ned: tuple[float, float, float]) -> None:
    north, east, down = stop_point((0.0, 0.0, 0.0), v_ned, BRAKING)
    assert math.hypot(north, east) == pytest.approx(distance_h_m(v_ned, BRAKING, 0.0) - 0.3)
    assert abs(down) == pytest.approx(distance_v_m(v_ned, BRAKING, 0.0) - 0.2)
