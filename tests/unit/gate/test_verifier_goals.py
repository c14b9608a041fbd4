"""May it go there?  Goals, limits, zones, legs; the laboratory's bounds."""

from __future__ import annotations

import dataclasses
import math

import pytest

from gcs.frames import Vec3
from gcs.gate.airspace.bounds import Cleared
from gcs.gate.airspace.zones import Zone
from gcs.gate.geometry import Circle, Polygon
from gcs.gate.refusal import Code, Refusal
from tests.unit.gate.airspace import HOME, LAB, OUTER, STILL, TOWER, around, at, flying, go

NAN, INF = math.nan, math.inf


def test_a_goal_inside_is_cleared_with_its_numbers() -> None:
    answer = flying().goal(at(3, 4, 2), 0.5, at(0, 0, 2), STILL)
    assert isinstance(answer, Cleared)
    assert dict(answer.evidence) == pytest.approx(
        {
            "goal_clear_h_m": 145.0,
            "goal_clear_v_m": 2.0,
            "leg_clear_h_m": 145.0,
            "leg_clear_v_m": 2.0,
            "leg_m": 5.0,
            "stopping_h_m": 2.5,
            "stopping_v_m": 0.5,
        }
    )


def test_a_goal_far_outside_names_fence_and_distance() -> None:
    refusal = flying().goal(at(500, 0, 2), None, at(3, 0, 2), STILL)
    assert refusal == Refusal(
        Code.OUTSIDE_FENCE,
        "goal (500.00 E, 0.00 N, 2.00 U) is 350.0 m outside inclusion circle 'home'",
        (("outside_m", 350.0), ("margin_m", 2.0)),
        "home",
    )


def test_the_order_is_finite_altitude_distance_zones_leg_stopping() -> None:
    verifier = around(OUTER, TOWER)
    fast = (0.0, 300.0, 0.0)
    here = at(0, 0, 2)
    assert go(verifier, at(NAN, 5000, 500), here, fast) is Code.NON_FINITE
    assert go(verifier, at(5000, 0, 500), here, fast) is Code.TOO_HIGH
    assert go(verifier, at(5000, 0, -1), here, fast) is Code.TOO_LOW
    assert go(verifier, at(5000, 0, 2), here, fast) is Code.TOO_FAR
    assert go(verifier, at(500, 0, 2), here, fast) is Code.OUTSIDE_FENCE
    assert go(verifier, at(25, 0, 2), here, fast) is Code.INSIDE_EXCLUSION
    assert go(verifier, at(40, 0, 2), here, fast) is Code.LEG_LEAVES_FENCE
    assert go(verifier, at(0, 40, 2), here, fast) is Code.CANNOT_STOP
    assert go(verifier, at(0, 40, 2), here) is None


@pytest.mark.parametrize(
    ("goal", "code"),
    [
        (at(147.9, 0, 2), None),
        (at(148.0, 0, 2), Code.TOO_CLOSE),  # exactly at the margin: too close to say
        (at(149.9, 0, 2), Code.TOO_CLOSE),
        (at(150.0, 0, 2), Code.TOO_CLOSE),  # exactly on the boundary
        (at(150.1, 0, 2), Code.OUTSIDE_FENCE),
        (at(0, 0, 49.5), None),
        (at(0, 0, 49.6), Code.TOO_CLOSE),  # a px4 that climbs 5 m and more flies 0.25 m past it
        (at(0, 0, 49.8), Code.TOO_CLOSE),
        (at(0, 0, 50.1), Code.OUTSIDE_FENCE),
        (at(0, 0, 0.5), None),
        (at(0, 0, 0.2), Code.TOO_CLOSE),
        (at(0, 0, -0.2), Code.TOO_LOW),
    ],
)
def test_the_default_keeps_its_margin_on_every_side(goal: Vec3, code: Code | None) -> None:
    assert go(flying(), goal, at(0, 0, 2)) is code


def test_too_close_says_how_close_and_what_is_asked() -> None:
    refusal = flying().goal(at(149, 0, 2), None, at(0, 0, 2), STILL)
    assert isinstance(refusal, Refusal)
    assert refusal.sentence == (
        "goal (149.00 E, 0.00 N, 2.00 U) is only 1.0 m from inclusion circle 'home', margin 2.0 m"
    )
    assert refusal.numbers == (("clear_m", 1.0), ("margin_m", 2.0))


@pytest.mark.parametrize("bad", [NAN, INF, -INF])
@pytest.mark.parametrize("fence_on", [True, False])
def test_l11_nothing_that_is_not_finite_passes_fence_on_or_off(bad: float, fence_on: bool) -> None:
    verifier = flying(LAB, fence_on=fence_on)
    here = at(0, 0, 1)
    for axis in range(3):
        broken = (bad if axis == 0 else 0.0, bad if axis == 1 else 0.0, bad if axis == 2 else -1.0)
        assert go(verifier, broken, here) is Code.NON_FINITE
        assert go(verifier, here, broken) is Code.NON_FINITE
        assert go(verifier, here, here, broken) is Code.NON_FINITE
        homeless = dataclasses.replace(verifier, home_ned=broken)
        assert go(homeless, here, here) is Code.NON_FINITE
    answer = verifier.goal(here, bad, here, STILL)
    assert isinstance(answer, Refusal)
    assert answer.code is Code.NON_FINITE
    takeoff = verifier.takeoff(bad, here)
    assert isinstance(takeoff, Refusal)
    assert takeoff.code is Code.NON_FINITE
    hold = verifier.hold_point((bad, 0.0, 0.0), STILL, floor_applies=False)
    assert isinstance(hold, Refusal)
    assert hold.code is Code.NON_FINITE
    way_home = verifier.return_path(here, HOME, bad)
    assert isinstance(way_home, Refusal)
    assert way_home.code is Code.RTL_BLOCKED


@pytest.mark.parametrize("huge", [1e7, 1e200, 1.7e308])
def test_finite_nonsense_is_refused_and_never_computed_with(huge: float) -> None:
    verifier = flying()
    here = at(0, 0, 2)
    assert go(verifier, at(huge, 0, 2), here) is Code.TOO_FAR
    assert go(verifier, here, at(huge, 0, 2)) is Code.TOO_FAR
    assert go(verifier, here, here, (huge, 0.0, 0.0)) is Code.CANNOT_STOP
    breach = verifier.predicted_stop(here, (huge, huge, huge), floor_applies=True)
    assert breach is not None
    assert breach.brake_pos_ned is None
    assert isinstance(verifier.return_path(here, HOME, huge), Refusal)


# -------------------------------------------------------------------------------- lab


def test_l12_the_labs_bounds_are_inclusive() -> None:
    lab = flying(LAB)
    here = at(0, 0, 1)
    assert go(lab, at(5, 5, 2), here) is None
    assert go(lab, at(-5, -5, 0), here) is None
    assert go(lab, at(5.01, 0, 1), here) is Code.OUTSIDE_FENCE
    assert go(lab, at(0, 0, -0.1), here) is Code.OUTSIDE_FENCE
    assert go(lab, at(0, 0, 2.01), here) is Code.OUTSIDE_FENCE


def test_l13_with_the_fence_off_the_same_goals_fly() -> None:
    lab = flying(LAB, fence_on=False)
    for goal in (at(5.01, 0, 1), at(0, 0, -0.1), at(80, 0, 1)):
        assert go(lab, goal, at(0, 0, 1)) is None
    assert go(lab, at(1001, 0, 1), at(0, 0, 1)) is Code.TOO_FAR


def test_inclusive_bounds_never_give_away_the_edge_of_an_exclusion_zone() -> None:
    lab = around(OUTER, TOWER, policy=LAB)
    assert go(lab, at(19.99, 0, 2), at(0, 0, 2)) is None
    assert go(lab, at(20, 0, 2), at(0, 0, 2)) is Code.TOO_CLOSE
    assert go(lab, at(25, 0, 20), at(25, 0, 25)) is Code.INSIDE_EXCLUSION


def test_a_little_outside_the_cage_the_lab_can_still_fly_on() -> None:
    lab = flying(LAB)
    drifted = at(5.02, 4.9, -0.03)
    assert lab.predicted_stop(drifted, at(0.1, 0, 0), floor_applies=True) is None
    assert isinstance(lab.hold_point(drifted, STILL, floor_applies=True), Cleared)
    assert go(lab, at(5, 5, 2), drifted) is None
    assert go(lab, at(0, 0, 1), at(5.6, 0, 1)) is Code.LEG_LEAVES_FENCE


def test_the_lab_brakes_only_half_a_metre_outside() -> None:
    lab = flying(LAB)
    # 1 m/s: 0.3 m of reaction, 0.1 m of braking
    assert lab.predicted_stop(at(5.05, 0, 1), at(1, 0, 0), floor_applies=True) is None
    breach = lab.predicted_stop(at(5.2, 0, 1), at(1, 0, 0), floor_applies=True)
    assert breach is not None
    assert breach.zone == "cage"
    assert "0.60 m past the edge of inclusion polygon 'cage', 0.50 m past it allowed" in (
        breach.sentence
    )


# ------------------------------------------------------------------------------- legs


def test_a_leg_across_an_exclusion_zone_is_refused_and_over_it_is_not() -> None:
    verifier = around(OUTER, TOWER)
    refusal = verifier.goal(at(40, 0, 2), None, at(0, 0, 2), STILL)
    assert isinstance(refusal, Refusal)
    assert refusal.code is Code.LEG_LEAVES_FENCE
    assert refusal.zone == "tower"
    assert "goes inside exclusion polygon 'tower'" in refusal.sentence
    assert go(verifier, at(40, 0, 25), at(0, 0, 25)) is None
    assert go(verifier, at(40, 0, 20.2), at(0, 0, 20.2)) is not None  # within the margin of the top
    assert go(verifier, at(40, 0, 2), at(0, 0, 30)) is Code.LEG_LEAVES_FENCE  # dives through it
    assert go(verifier, at(25, 0, 25), at(25, 0, 40)) is None
    assert go(verifier, at(40, 8, 2), at(0, 8, 2)) is None
    assert go(verifier, at(40, 6, 2), at(0, 6, 2)) is Code.TOO_CLOSE


def test_a_leg_across_a_notch_of_the_fence_is_refused() -> None:
    horseshoe = Polygon(
        (
            (0.0, 0.0),
            (60.0, 0.0),
            (60.0, 60.0),
            (40.0, 60.0),
            (40.0, 20.0),
            (20.0, 20.0),
            (20.0, 60.0),
            (0.0, 60.0),
        )
    )
    verifier = around(Zone("shoe", True, horseshoe, 0.0, 50.0))
    refusal = verifier.goal(at(50, 50, 5), None, at(10, 50, 5), STILL)
    assert isinstance(refusal, Refusal)
    assert refusal.code is Code.LEG_LEAVES_FENCE
    assert "10.0 m outside inclusion polygon 'shoe'" in refusal.sentence
    assert go(verifier, at(10, 10, 5), at(10, 50, 5)) is None
    assert go(verifier, at(50, 10, 5), at(10, 10, 5)) is None
    beside = at(19, 30, 5)  # a metre from the notch, within the margin
    assert go(verifier, at(10, 10, 5), beside) is None
    assert go(verifier, at(20.5, 10, 5), beside) is Code.TOO_CLOSE  # round its corner, nearer


def test_every_inclusion_zone_counts() -> None:
    west = Zone("west", True, Circle((-50.0, 0.0), 60.0))
    east = Zone("east", True, Circle((50.0, 0.0), 60.0))
    verifier = around(west, east)
    assert go(verifier, at(0, 0, 2), at(0, 1, 2)) is None
    refusal = verifier.goal(at(-20, 0, 2), None, at(0, 0, 2), STILL)
    assert isinstance(refusal, Refusal)
    assert refusal.zone == "east"


def test_from_within_the_margin_the_way_back_in_is_open_and_along_is_not_nearer() -> None:
    verifier = flying()
    edge = at(149.5, 0, 2)
    assert go(verifier, at(100, 0, 2), edge) is None
    assert go(verifier, at(0, 149.5, 2), edge) is Code.TOO_CLOSE
    tower = around(OUTER, TOWER)
    beside = at(19, 0, 2)
    assert go(tower, at(0, 0, 2), beside) is None
    assert go(tower, at(10, 10, 2), beside) is None
    assert go(tower, at(19.5, 12, 2), beside) is Code.TOO_CLOSE


def test_from_outside_no_leg_is_flown() -> None:
    assert go(flying(), at(0, 0, 2), at(151, 0, 2)) is Code.LEG_LEAVES_FENCE
    assert go(around(OUTER, TOWER), at(0, 0, 2), at(25, 0, 2)) is Code.LEG_LEAVES_FENCE
