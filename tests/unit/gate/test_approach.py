"""Whose stop is predicted how: on the way to a goal, pushed off it, too fast for it, held.

The figures of the flown stops are recorded, in the tracks of the scenarios that are named: the
speed at the first time and how far it is from there to the place at the second.
"""

from __future__ import annotations

import math
from typing import Final

import pytest

from gcs.frames import Vec3
from gcs.gate.airspace.stopping import Leg, OwnPath, Path, Stops, predicted_stop, stops_of, travel_m
from gcs.gate.policy.parse import DEFAULT
from gcs.gate.policy.policy import Approach, Braking, Overshoot
from tests.unit.gate.airspace import LAB, at

STOPS = Stops(
    Braking(1.0, 1.0, 1.0, 0.5, 0.2),
    Approach(0.0, 2.0, 2.0, cross_track_m=1.0, cross_track_m_s=1.0, a_gain_h_m_s2=9.81),
    Overshoot(0.1, 0.5, 0.1, 0.5),
)
"""A hold from v takes v + v^2 / 2; the approach at v takes v^2 / 4, half of it behind 2 m/s."""

LEG = Leg(at(0, 0, 10), at(20, 0, 10))
CLIMB = Leg(at(0, 0, 10), at(0, 0, 30))


def stop(pos: Vec3, v: Vec3, path: Path = LEG) -> Vec3:
    north, east, down = predicted_stop(pos, v, path, STOPS)
    return (east, north, -down)


@pytest.mark.parametrize(
    ("autopilot", "speed_m_s", "flown_m"),
    [
        pytest.param("ardupilot", 3.0, 25.1 - 20.1, id="F9b_action_4_brake: 19.6 s to the end"),
        pytest.param("px4", 2.4, math.hypot(2.5, 0.5), id="F5b_gf_action_return: 20.0 to 23.1 s"),
        pytest.param("px4", 2.52, math.hypot(2.8, 0.1), id="F5c_gf_action_land: 19.9 to 22.9 s"),
        pytest.param("px4", 2.76, 23.7 - 21.1, id="F3_px4_circle_fresh: 21.4 to 22.9 s"),
        pytest.param("px4", 2.69, 62.8 - 60.1, id="F4_velocity_against_circle: 21.7 to 23.2 s"),
    ],
)
def test_a_hold_takes_what_was_recorded(autopilot: str, speed_m_s: float, flown_m: float) -> None:
    b = DEFAULT.braking_of(autopilot)
    predicted_m = travel_m(speed_m_s, b.react_s, b.a_brake_h_m_s2)
    assert flown_m <= predicted_m + b.position_error_h_m
    assert predicted_m <= 2.5 * flown_m


@pytest.mark.parametrize(
    ("autopilot", "speed_m_s", "to_go_m"),
    [
        pytest.param("ardupilot", 4.65, math.hypot(67.6 - 65.25, 40.4 - 37.56), id="I2 at 8.01 s"),
        pytest.param("ardupilot", 3.69, 10.0 + 0.04 - 7.84, id="I1_step_response (again) at 3.02"),
        pytest.param("px4", 0.36, 10.0 + 0.03 - 10.53, id="I1_step_response at 6.51 s"),
    ],
)
def test_a_recorded_vehicle_is_on_its_approach(
    autopilot: str, speed_m_s: float, to_go_m: float
) -> None:
    """The samples of the recorded steps whose approach ends farthest behind the goal."""
    figures = stops_of(DEFAULT, autopilot)
    goal = at(100.0, 0.0, 10.0)
    pos, v = at(100.0 - to_go_m, 0.0, 10.0), at(speed_m_s, 0.0, 0.0)
    own_m = travel_m(speed_m_s, figures.approach.react_s, figures.approach.a_brake_h_m_s2)
    found = predicted_stop(pos, v, Leg(at(90.0, 0.0, 10.0), goal), figures)
    assert found[1] == pytest.approx(100.0 - to_go_m + own_m)


def test_on_the_leg_it_stops_by_itself() -> None:
    assert stop(at(8, 0, 10), at(6, 0, 0)) == pytest.approx((17.0, 0.0, 10.0))
    assert stop(at(8, 0, 10), at(6, 0, 0), None) == pytest.approx((32.0, 0.0, 10.0))


@pytest.mark.parametrize(("east_m", "stop_m"), [(12.4, 21.4), (12.6, 12.6 + 24.0)])
def test_too_fast_for_its_goal_it_is_held(east_m: float, stop_m: float) -> None:
    """At 6 m/s 9 m: 20 m and the overshoot of 0.5 m and 1 m are the farthest."""
    assert stop(at(east_m, 0, 10), at(6, 0, 0)) == pytest.approx((stop_m, 0.0, 10.0))


@pytest.mark.parametrize(("beside_m", "own"), [(0.9, True), (-0.9, True), (1.1, False)])
def test_beside_its_leg_it_is_held(beside_m: float, own: bool) -> None:
    expected_m = 8.0 + (4.0 if own else 12.0)
    found = stop(at(8, beside_m, 10), at(4, 0, 0))
    assert found == pytest.approx((expected_m, beside_m, 10.0))


@pytest.mark.parametrize("across_m_s", [0.9, -0.9, 1.1, -1.1])
def test_pushed_across_its_leg_it_is_held(across_m_s: float) -> None:
    v = math.hypot(2.0, across_m_s)
    travel = v * v / 4.0 if abs(across_m_s) < 1.0 else v + v * v / 2.0
    found = stop(at(8, 0, 10), at(2, across_m_s, 0))
    assert found == pytest.approx((8 + 2 * travel / v, across_m_s * travel / v, 10.0))


@pytest.mark.parametrize(("back_m_s", "travel_m"), [(0.9, 0.2025), (1.2, 1.2 + 0.72)])
def test_pushed_back_it_is_held(back_m_s: float, travel_m: float) -> None:
    found = stop(at(8, 0, 10), at(-back_m_s, 0, 0))
    assert found == pytest.approx((8 - travel_m, 0.0, 10.0))


def test_behind_the_start_of_its_leg_it_is_held() -> None:
    assert stop(at(-0.9, 0, 10), at(0.4, 0, 0))[0] == pytest.approx(-0.9 + 0.04)
    assert stop(at(-1.5, 0, 10), at(0.4, 0, 0))[0] == pytest.approx(-1.5 + 0.4 + 0.08)


def test_heights_are_decided_apart() -> None:
    """4 m/s up: 4 m by itself, 12 m held; the farthest stop is 30 + 0.5 + 1 m up."""
    assert stop(at(0, 0, 20), at(0, 0, 4), CLIMB) == pytest.approx((0.0, 0.0, 24.0))
    assert stop(at(0, 0, 27), at(0, 0, 4), CLIMB) == pytest.approx((0.0, 0.0, 31.0))
    assert stop(at(0, 0, 28), at(0, 0, 4), CLIMB) == pytest.approx((0.0, 0.0, 40.0))
    assert stop(at(0, 0, 20), at(0, 0, -4), CLIMB) == pytest.approx((0.0, 0.0, 8.0))
    assert stop(at(0, 0, 9.5), at(0, 0, -0.4), CLIMB)[2] == pytest.approx(9.46)
    assert stop(at(0, 0, 8.5), at(0, 0, -0.4), CLIMB)[2] == pytest.approx(8.5 - 0.48)
    aside = stop(at(3, 0, 20), at(2, 0, 4), CLIMB)
    assert aside == pytest.approx((3.0 + 4.0, 0.0, 24.0))


@pytest.mark.parametrize(("v", "travel"), [(0.9, 0.2025), (1.1, 1.1 + 0.605)])
def test_on_a_level_leg_neither_up_nor_down_is_towards_the_goal(v: float, travel: float) -> None:
    for up in (1.0, -1.0):
        found = stop(at(8, 0, 10), at(0, 0, up * v))
        assert found == pytest.approx((8.0, 0.0, 10.0 + up * travel))


def test_a_hover_is_a_leg_without_length() -> None:
    hover = Leg(LEG.goal_ned, LEG.goal_ned)
    assert stop(LEG.goal_ned, at(0.4, 0.3, 0), hover) == pytest.approx((20.05, 0.0375, 10.0))
    assert stop(LEG.goal_ned, at(0, 1.2, 0), hover) == pytest.approx((20.0, 1.92, 10.0))


def test_on_a_path_of_its_own_it_stops_by_itself() -> None:
    assert stop(at(50, 50, 10), at(4, 0, 4), OwnPath()) == pytest.approx((54.0, 50.0, 14.0))


@pytest.mark.parametrize("autopilot", ["px4", "ardupilot"])
def test_the_lab_trusts_a_hold_as_an_approach(autopilot: str) -> None:
    braking, approach = LAB.braking_of(autopilot), LAB.approach_of(autopilot)
    for key in ("react_s", "a_brake_h_m_s2", "a_brake_v_m_s2"):
        assert getattr(braking, key) == getattr(approach, key)


OVER: Final = Leg(at(0, 0, 2), at(40, 0, 22))
"""It climbs by one metre on two."""


@pytest.mark.parametrize(
    ("east_m", "up_m", "stop_m"),
    [
        pytest.param(10, 11.5, 19.0, id="on the straight line"),
        pytest.param(10, 2.0, 19.0, id="it has not climbed at all"),
        pytest.param(10, 22.0, 19.0, id="it has climbed first"),
        pytest.param(10, 1.8, 19.0, id="as far below as its height may be wrong"),
        pytest.param(10, 1.6, 34.0, id="below: as far as a hold takes"),
        pytest.param(10, 22.4, 34.0, id="above"),
        pytest.param(24, 1.0, 40.0, id="but no farther than to its goal"),
        pytest.param(31.5, 22.0, 40.5, id="of which it may rest a little behind by itself"),
    ],
)
def test_above_and_below_its_leg_it_is_braked_for_what_is_before_the_goal(
    east_m: float, up_m: float, stop_m: float
) -> None:
    """At 6 m/s: 9 m by itself, 24 m held.  The leg is clear at all heights between its ends, and
    nothing is known of what stands under it or over it."""
    assert stop(at(east_m, 0, up_m), at(6, 0, 0), OVER) == pytest.approx((stop_m, 0.0, up_m))


def test_below_its_leg_it_flies_on_along_that_and_not_where_wind_pushes_it() -> None:
    """Its own stop is 0.36 m farther aside; from there on it is taken to keep beside the leg."""
    v = math.hypot(6.0, 0.24)
    own_m, held_m = v * v / 4.0, v + v * v / 2.0
    found = stop(at(10, 0.1, 1), at(6, 0.24, 0), OVER)
    own = (10 + 6.0 / v * own_m, 0.1 + 0.24 / v * own_m)
    assert found == pytest.approx((own[0] + held_m - own_m, own[1], 1.0))
