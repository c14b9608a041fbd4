"""The floor of a fence and the ground at home's height: when each counts, and for what.

Home lies off the origin on all three axes, so that none is taken for another.
"""

from __future__ import annotations

import pytest
from msgspec.structs import replace

from gcs.frames import Vec3
from gcs.gate.airspace.bounds import Cleared
from gcs.gate.airspace.projection import Origin
from gcs.gate.airspace.verifier import Verifier, verifier_for
from gcs.gate.airspace.zones import Zone
from gcs.gate.geometry import Circle
from gcs.gate.policy.parse import DEFAULT
from gcs.gate.refusal import Code, Refusal
from tests.unit.gate.airspace import STILL, around, at, flying, go

HOME = at(60.0, -30.0, 100.0)
"""60 m east, 30 m south and 100 m above the origin."""

WIDE = Zone("wide", True, Circle((0.0, 0.0), 500.0))
LOW = -1000.0
"""A least height that no test reaches: the fence's floors alone are looked at."""


def over_home(up_m: float) -> Vec3:
    return at(60.0, -30.0, 100.0 + up_m)


def shed(floor_m: float, ceiling_m: float) -> Zone:
    """An exclusion zone of 10 m about home, from and to so many metres above it."""
    return Zone("shed", False, Circle((60.0, -30.0), 10.0), 100.0 + floor_m, 100.0 + ceiling_m)


def at_home(*zones: Zone) -> Verifier:
    policy = replace(DEFAULT, min_up_m=LOW)
    return Verifier(policy, (WIDE, *zones), "px4", HOME, origin_known=False)


class TestGoal:
    def test_no_leg_starts_below_the_floor(self) -> None:
        """The leg is judged before the stop, and has its own code."""
        assert go(flying(), at(0, 0, 2), at(0, 0, -0.5)) is Code.LEG_LEAVES_FENCE

    def test_no_goal_is_flown_to_by_who_falls_through_the_floor(self) -> None:
        """5 m/s down: 7 m of reaction, 25 / 19.6 m of braking: 8.28 m; 0.2 m is asked."""
        falling = (0.0, 0.0, 5.0)
        assert go(flying(), at(0, 0, 3), at(0, 0, 8.4), falling) is Code.CANNOT_STOP
        assert go(flying(), at(0, 0, 3), at(0, 0, 8.5), falling) is None


def test_the_circle_of_a_mission_is_above_the_floor() -> None:
    loft = Zone("loft", True, Circle((0.0, 0.0), 150.0), 5.0, 50.0)
    verifier = around(loft)
    assert verifier.mission_circle(at(0, 0, 5.5), 20.0) is None
    low = verifier.mission_circle(at(0, 0, 4.5), 20.0)
    assert low is not None
    assert low.code is Code.OUTSIDE_FENCE


class TestTheGroundEndsALanding:
    """Falling at 6 m/s the vehicle would go 8.4 + 1.84 = 10.24 m; the ground is 4 m below it."""

    FALLING: Vec3 = (0.0, 0.0, 6.0)

    def test_what_stands_on_the_ground_is_fallen_on(self) -> None:
        verifier = at_home(shed(-1.0, 2.0))
        breach = verifier.predicted_stop(over_home(4.0), self.FALLING, floor_applies=False)
        assert breach is not None
        assert breach.zone == "shed"

    def test_what_is_below_the_ground_is_not(self) -> None:
        verifier = at_home(shed(-6.0, -1.0))
        above = over_home(4.0)
        assert verifier.predicted_stop(above, self.FALLING, floor_applies=False) is None
        assert verifier.predicted_stop(above, self.FALLING, floor_applies=True) is not None

    def test_who_flies_below_home_stays_below_it(self) -> None:
        """In a valley, 3 m below home, under a bridge from 1 m below home to 2 m above."""
        verifier = at_home(shed(-1.0, 2.0))
        below = at(45.0, -30.0, 97.0)
        dash = at(10, 0, -1)
        assert verifier.predicted_stop(below, dash, floor_applies=False) is None


class TestBrake:
    """10 m/s: 14 m of reaction and 14.9 m of braking."""

    DASH = at(10, 0, 0)

    def brake(self, verifier: Verifier, pos_ned: Vec3, *, floor: bool) -> Vec3 | None:
        breach = verifier.predicted_stop(pos_ned, self.DASH, floor_applies=floor)
        assert breach is not None
        return breach.brake_pos_ned

    @pytest.mark.parametrize("floor", [True, False])
    def test_until_home_is_known_there_is_no_ground(self, floor: bool) -> None:
        policy = replace(DEFAULT, min_up_m=LOW)
        yard = Zone("yard", True, Circle((0.0, 0.0), 150.0), -50.0, 50.0)
        verifier = Verifier(policy, (yard,), "px4", None, origin_known=False)
        found = self.brake(verifier, at(140, 0, -10), floor=floor)
        assert found is not None
        assert found[2] == 10.0

    def test_in_a_valley_it_is_lifted_to_home_only_where_the_floor_is(self) -> None:
        """The floor of the fence is 50 m below home: where it applies, a brake is level."""
        policy = replace(DEFAULT, min_up_m=LOW)
        valley = Zone("valley", True, Circle((60.0, -30.0), 150.0), 50.0, 150.0)
        verifier = Verifier(policy, (valley,), "px4", HOME, origin_known=False)
        here = at(200.0, -30.0, 90.0)
        level, lifted = (self.brake(verifier, here, floor=floor) for floor in (True, False))
        assert level is not None
        assert lifted is not None
        assert (level[2], lifted[2]) == (-90.0, -100.0)


def test_no_brake_points_below_the_ground() -> None:
    verifier = verifier_for(DEFAULT, "px4", (0.0, 0.0, 0.0), Origin(47.0, 8.0, 400.0))
    breach = verifier.predicted_stop((0.0, 130.0, 1.0), (0.0, 20.0, 0.0), floor_applies=False)
    assert breach is not None
    assert breach.brake_pos_ned is not None
    assert breach.brake_pos_ned[2] <= 0.0


def test_a_return_climbs_to_its_height_above_home() -> None:
    """30 m above home, under a ceiling of 50 m: 20 m are left."""
    verifier = verifier_for(DEFAULT, "px4", HOME, None)
    answer = verifier.return_path(at(90.0, -30.0, 105.0), HOME, 30.0)
    assert isinstance(answer, Cleared)
    assert dict(answer.evidence) == pytest.approx(
        {"leg_clear_h_m": 120.0, "leg_clear_v_m": 20.0, "leg_m": 30.0}
    )


def test_a_hold_below_the_floor_is_refused_where_it_applies() -> None:
    loft = Zone("loft", True, Circle((0.0, 0.0), 150.0), 5.0, 50.0)
    low = around(loft).hold_point(at(0, 0, 4.5), STILL, floor_applies=True)
    assert isinstance(low, Refusal)
    assert low.code is Code.OUTSIDE_FENCE
