"""Can it still stop?  Predicted breaches, brakes, hovering near a boundary, landing."""

from __future__ import annotations

import pytest

from gcs.frames import enu_from_ned
from gcs.gate.airspace.bounds import Cleared
from gcs.gate.airspace.questions.braking import Breach
from gcs.gate.airspace.stopping import Setpoints
from gcs.gate.airspace.zones import Zone
from gcs.gate.geometry import Circle, Polygon
from gcs.gate.policy.parse import DEFAULT
from gcs.gate.refusal import Code
from tests.unit.gate.airspace import LAB, OUTER, STILL, TOWER, around, at, flying, go


def test_a_goal_is_refused_to_a_vehicle_that_cannot_stop_inside() -> None:
    verifier = flying()
    # 10 m/s: 14 m of reaction, 100 / 6.7 = 14.93 m of braking; 1 m is asked: 120.07 m
    assert go(verifier, at(0, 0, 2), at(120.0, 0, 2), at(10, 0, 0)) is None
    assert go(verifier, at(0, 0, 2), at(120.2, 0, 2), at(10, 0, 0)) is Code.CANNOT_STOP
    assert go(verifier, at(0, 0, 2), at(0, 0, 45), at(0, 0, 6)) is Code.CANNOT_STOP


def test_a_predicted_breach_names_the_zone_and_brakes_where_a_goal_may_be() -> None:
    verifier = flying()
    breach = verifier.predicted_stop(at(140, 0, 2), at(10, 0, 0), floor_applies=True)
    assert isinstance(breach, Breach)
    assert breach.zone == "home"
    assert breach.sentence == (
        "at 10.0 m/s it would come to rest 18.9 m past the edge of inclusion circle 'home', "
        "1.0 m asked"
    )
    assert dict(breach.numbers)["stop_clear_m"] == pytest.approx(10.0 - 28.92537)
    assert breach.brake_pos_ned is not None
    assert go(verifier, breach.brake_pos_ned, at(140, 0, 2)) is None
    # a sixteenth of 28.925 m is 1.8078 m; four lead to 147.23 m, five past the margin's edge
    assert enu_from_ned(breach.brake_pos_ned) == pytest.approx((147.231343, 0.0, 2.0))


def test_within_the_margin_the_brake_is_where_the_vehicle_is() -> None:
    here = at(149.2, 0, 2)
    breach = flying().predicted_stop(here, at(2, 0, 0), floor_applies=True)
    assert breach is not None
    assert breach.brake_pos_ned == here


def test_outside_there_is_nowhere_to_brake_to() -> None:
    breach = flying().predicted_stop(at(151, 0, 2), at(-3, 0, 0), floor_applies=True)
    assert breach is not None
    assert breach.brake_pos_ned is None


def test_hovering_at_a_goal_at_the_margin_is_no_breach() -> None:
    verifier = flying()
    for goal, start in (
        (at(147.9, 0, 2), at(0, 0, 2)),
        (at(0, 0, 0.31), at(0, 0, 2)),
        (at(0, 0, 49.69), at(0, 0, 49)),
    ):
        assert go(verifier, goal, start) is None
        for noise in (at(0.15, 0.1, 0.2), at(-0.15, 0.1, -0.2)):
            hovers = Setpoints()
            assert verifier.predicted_stop(goal, noise, hovers, floor_applies=True) is None


def test_after_a_brake_near_the_fence_hovering_goes_on_and_creeping_out_does_not() -> None:
    verifier = flying()
    edge = at(149.2, 0, 2)  # less than the metre that is asked of a stop
    hovers = Setpoints()
    assert verifier.predicted_stop(edge, at(0.2, 0, 0), hovers, floor_applies=True) is None
    assert verifier.predicted_stop(edge, at(-5, 0, 0), hovers, floor_applies=True) is None
    # 0.3 s and 5 m/s2: 0.22 m on it still is inside by the error of the position; 0.5 m on not
    assert verifier.predicted_stop(edge, at(0.6, 0, 0), hovers, floor_applies=True) is None
    assert verifier.predicted_stop(edge, at(1.2, 0, 0), hovers, floor_applies=True) is not None
    assert verifier.predicted_stop(edge, at(0.6, 0, 0), floor_applies=True) is not None
    assert isinstance(verifier.hold_point(edge, STILL, floor_applies=True), Cleared)
    last = at(149.6, 0, 2)  # within the position error of the boundary
    assert verifier.predicted_stop(last, at(0.01, 0, 0), floor_applies=True) is not None
    assert verifier.predicted_stop(last, at(-1, 0, 0), floor_applies=True) is None


def test_towards_an_exclusion_zone_it_brakes_and_beside_and_above_it_does_not() -> None:
    verifier = around(OUTER, TOWER)
    east = at(10, 0, 0)
    breach = verifier.predicted_stop(at(8, 0, 2), east, floor_applies=True)
    assert breach is not None
    assert breach.zone == "tower"
    assert breach.brake_pos_ned is not None
    assert go(verifier, breach.brake_pos_ned, at(8, 0, 2)) is None
    assert verifier.predicted_stop(at(-10.0, 0, 2), east, floor_applies=True) is None
    assert verifier.predicted_stop(at(-9.9, 0, 2), east, floor_applies=True) is not None
    assert verifier.predicted_stop(at(8, 8, 2), east, floor_applies=True) is None
    assert verifier.predicted_stop(at(8, 0, 22), east, floor_applies=True) is None
    assert verifier.predicted_stop(at(25, 0, 22), at(0, 0, -3), floor_applies=True) is not None


def test_an_exclusion_zone_that_a_stop_would_leap_over_is_a_breach() -> None:
    wall = Zone("wall", False, Polygon(((10.0, -9.0), (10.2, -9.0), (10.2, 9.0), (10.0, 9.0))))
    for policy in (DEFAULT, LAB):
        verifier = around(OUTER, wall, policy=policy)
        breach = verifier.predicted_stop(at(5, 0, 2), at(12, 0, 0), floor_applies=True)
        assert breach is not None
        assert breach.zone == "wall"


def test_a_landing_is_stopped_by_the_ground_not_by_the_floor() -> None:
    verifier = flying()
    sinking = at(0, 0, -2)
    assert verifier.predicted_stop(at(0, 0, 0.4), sinking, floor_applies=True) is not None
    assert verifier.predicted_stop(at(0, 0, 0.4), sinking, floor_applies=False) is None
    assert verifier.predicted_stop(at(0, 0, -0.05), STILL, floor_applies=False) is None
    cellar = Zone("cellar", False, Circle((0.0, 0.0), 5.0), -10.0, -0.5)
    over = around(OUTER, cellar)
    assert over.predicted_stop(at(0, 0, 0.4), sinking, floor_applies=False) is None
    sides = verifier.predicted_stop(at(149, 0, 0.4), at(3, 0, -2), floor_applies=False)
    assert sides is not None
