"""Each face of a zone at its very limit: points, legs and stops, by sides, ceiling, floor and body.

Expected values are distances that can be drawn.  The yard is 100 m x 80 m, 0 to 40 m up; the tower
stands at 20 to 30 m east, 10 m long, 10 to 20 m up.
"""

from __future__ import annotations

import math

import pytest
from msgspec.structs import replace

from gcs.frames import Vec3
from gcs.gate.airspace.clearance import (
    NO_MARGINS,
    Face,
    Margins,
    Measure,
    Motion,
    StopLimit,
    body_clearance,
    inclusion_measures,
    swept_body_measure,
)
from gcs.gate.airspace.fence_check import FenceCheck
from gcs.gate.airspace.zones import Zone
from gcs.gate.geometry import TOLERANCE_M, Circle, Polygon
from gcs.gate.policy.parse import DEFAULT
from gcs.gate.policy.policy import Braking
from gcs.gate.refusal import Code, Refusal
from tests.unit.gate.airspace import at

YARD = Zone(
    "yard", True, Polygon(((0.0, 0.0), (100.0, 0.0), (100.0, 80.0), (0.0, 80.0))), 0.0, 40.0
)
TOWER = Zone(
    "tower", False, Polygon(((20.0, -5.0), (30.0, -5.0), (30.0, 5.0), (20.0, 5.0))), 10.0, 20.0
)
MARGINS = Margins(2.0, 0.5)
POLICY = replace(DEFAULT, margin_h_m=2.0, margin_v_m=0.5, brake_slack_h_m=1.5, brake_slack_v_m=0.25)
LAB = replace(POLICY, bounds_inclusive=True)
BRAKING = Braking(0.5, 4.0, 2.0, position_error_h_m=0.5, position_error_v_m=0.25)


def judge(*zones: Zone, inclusive: bool = False) -> FenceCheck:
    return FenceCheck(zones, LAB if inclusive else POLICY, BRAKING)


def motion(a: Vec3, b: Vec3) -> Motion:
    return Motion.between(at(*a), at(*b))


def code(refusal: Refusal | None) -> Code | None:
    return None if refusal is None else refusal.code


def slab(clear_m: float) -> Zone:
    """No sides to speak of, and a ceiling so far above a vehicle at height zero."""
    return Zone("slab", True, Circle((0.0, 0.0), 1.0e5), ceiling_up_m=clear_m)


class TestFaces:
    def test_sides_ceiling_and_floor_of_a_climb(self) -> None:
        """From 10 m within the western side, 5 m up, to 30 m within it, 25 m up."""
        measures = inclusion_measures(YARD, motion((10, 40, 5), (30, 40, 25)), floor_applies=True)
        assert measures == [
            Measure(YARD, Face.SIDES, 10.0, 10.0),
            Measure(YARD, Face.CEILING, 35.0, 15.0),
            Measure(YARD, Face.FLOOR, 5.0, 5.0),
        ]

    def test_and_of_a_descent_where_the_floor_is_not_at_zero(self) -> None:
        loft = Zone("loft", True, YARD.shape, 3.0, 40.0)
        measures = inclusion_measures(loft, motion((30, 40, 25), (10, 40, 5)), floor_applies=True)
        assert [(m.start_m, m.least_m) for m in measures] == [
            (30.0, 10.0),
            (15.0, 15.0),
            (22.0, 2.0),
        ]

    def test_without_the_floor_two_are_left(self) -> None:
        measures = inclusion_measures(YARD, motion((10, 40, 5), (30, 40, 25)), floor_applies=False)
        assert [m.face for m in measures] == [Face.SIDES, Face.CEILING]

    def test_a_body_is_clear_on_the_side_that_is_clear_most(self) -> None:
        assert body_clearance(TOWER, (34.0, 0.0), 13.0) == 4.0
        assert body_clearance(TOWER, (25.0, 0.0), 4.0) == 6.0
        assert body_clearance(TOWER, (25.0, 0.0), 27.0) == 7.0
        assert body_clearance(TOWER, (28.0, 1.0), 14.0) == -2.0

    def test_margins_are_vertical_for_ceiling_and_floor(self) -> None:
        assert [MARGINS.of(face) for face in (Face.SIDES, Face.CEILING, Face.FLOOR, Face.BODY)] == [
            2.0,
            0.5,
            0.5,
            2.0,
        ]
        assert Margins(0.0, 0.0) == NO_MARGINS


class TestLegsPastATower:
    """2 m above and below count as beside it: from 8 m to 22 m up."""

    def clearance(self, a: Vec3, b: Vec3) -> float | None:
        measure = swept_body_measure(TOWER, motion(a, b), 2.0)
        return None if measure is None else measure.least_m

    @pytest.mark.parametrize(
        ("up", "clear"), [(8.0, None), (8.25, 3.0), (15.0, 3.0), (21.75, 3.0), (22.0, None)]
    )
    def test_a_level_leg_counts_between_the_heights(self, up: float, clear: float | None) -> None:
        assert self.clearance((0, 8, up), (50, 8, up)) == clear

    @pytest.mark.parametrize(
        ("a", "b"),
        [
            # the straight line is at 22 m up at 36 m east only, beyond the tower's corner
            ((0, 8, 40), (80, 8, 0)),
            ((80, 8, 40), (0, 8, 0)),
            # it leaves 22 m up at 7 m east, before the tower
            ((0, 8, 15), (40, 8, 55)),
            ((0, 8, 15), (40, 8, -25)),
        ],
    )
    def test_a_climbing_leg_counts_as_a_whole_either_way(self, a: Vec3, b: Vec3) -> None:
        """A vehicle climbs at a speed of its own: it may be at any of its heights anywhere."""
        assert self.clearance(a, b) == self.clearance(b, a) == 3.0

    @pytest.mark.parametrize(
        ("a_up", "b_up"), [(22.0, 30.0), (30.0, 22.0), (8.0, 1.0), (1.0, 8.0), (25.0, 40.0)]
    )
    def test_one_that_keeps_above_or_below_does_not_count(self, a_up: float, b_up: float) -> None:
        assert self.clearance((0, 8, a_up), (50, 8, b_up)) is None

    @pytest.mark.parametrize("b_up", [22.0, 30.0, 60.0])
    def test_who_would_fly_over_it_climbs_first(self, b_up: float) -> None:
        """The straight line to 60 m up passes 40 m over it."""
        judged = judge(TOWER)
        start, over, behind = at(-20, 0, 12), at(-20, 0, b_up), at(80, 0, b_up)
        refusal = judged.leg("leg", start, behind, MARGINS, floor_applies=True)
        assert code(refusal) is Code.LEG_LEAVES_FENCE
        assert judged.leg("leg", start, over, MARGINS, floor_applies=True) is None
        assert judged.leg("leg", over, behind, MARGINS, floor_applies=True) is None

    @pytest.mark.parametrize(("low", "high"), [(12.0, 60.0), (-20.0, 30.0)])
    def test_so_does_a_region_of_a_mission(self, low: float, high: float) -> None:
        """Its straight sides are above or below the tower where they pass it."""
        judged = judge(TOWER)
        starts, ends = [at(-20, 0, low)], [at(80, 1, high), at(80, -1, high)]
        assert code(judged.hull("hull", starts, ends, floor_applies=True)) is Code.LEG_LEAVES_FENCE
        level = [at(80, 1, 30), at(80, -1, 30)]
        assert judged.hull("hull", [at(-20, 0, 40)], level, floor_applies=True) is None


class TestStopsPastATower:
    def measure(self, a: Vec3, b: Vec3) -> Measure | None:
        return swept_body_measure(TOWER, motion(a, b), 2.0)

    @pytest.mark.parametrize(("a_up", "b_up"), [(22.0, 22.0), (30.0, 22.0), (22.0, 30.0)])
    def test_above_it_all_along_nothing_is_near(self, a_up: float, b_up: float) -> None:
        assert self.measure((10, 0, a_up), (40, 0, b_up)) is None

    @pytest.mark.parametrize(("a_up", "b_up"), [(8.0, 8.0), (1.0, 8.0), (8.0, 1.0)])
    def test_nor_below_it(self, a_up: float, b_up: float) -> None:
        assert self.measure((10, 0, a_up), (40, 0, b_up)) is None

    @pytest.mark.parametrize(
        ("a_up", "b_up", "start"), [(21.75, 30.0, 10.0), (30.0, 21.75, 10.0), (8.25, 1.0, 10.0)]
    )
    def test_any_height_that_is_near_makes_the_whole_track_count(
        self, a_up: float, b_up: float, start: float
    ) -> None:
        measure = self.measure((10, 0, a_up), (14, 0, b_up))
        assert measure == Measure(TOWER, Face.BODY, start, 6.0)


class TestLimitOfAStop:
    """Error 0.5 m and margin 2 m less 1.5 m of slack: 1 m; 0.1 m of creep."""

    LIMIT = StopLimit(0.5, 2.0, 1.5, 0.125)

    def broken(self, start_m: float, least_m: float, limit: StopLimit = LIMIT) -> bool:
        return limit.broken_by(Measure(YARD, Face.SIDES, start_m, least_m))

    def test_the_limit(self) -> None:
        assert (self.LIMIT.limit_m, self.LIMIT.outermost_m) == (1.0, 0.0)
        assert StopLimit(0.0, 0.0, 0.5, 0.1).outermost_m == -0.5

    def test_at_the_limit_it_is_kept(self) -> None:
        assert not self.broken(5.0, 1.0)
        assert self.broken(5.0, 0.9375)

    def test_who_is_nearer_may_creep(self) -> None:
        assert not self.broken(0.875, 0.75)
        assert self.broken(0.875, 0.6875)

    def test_but_not_nearer_than_the_error(self) -> None:
        assert not self.broken(0.5625, 0.5)
        assert self.broken(0.5625, 0.46875)

    def test_who_is_within_the_error_may_stand_and_move_away(self) -> None:
        assert not self.broken(0.25, 0.25)
        assert not self.broken(0.25, 0.25 - TOLERANCE_M / 2)
        assert self.broken(0.25, 0.25 - 2 * TOLERANCE_M)

    def test_who_is_outside_is_in_breach_however_it_moves(self) -> None:
        assert not self.broken(0.0, 0.0)
        assert self.broken(-0.0625, -0.0625)
        slack = StopLimit(0.0, 0.0, 0.5, 0.125)
        assert not self.broken(-0.5, -0.5, slack)
        assert self.broken(-0.5625, -0.5625, slack)

    @pytest.mark.parametrize(("start_m", "least_m"), [(math.nan, 5.0), (5.0, math.nan)])
    def test_what_is_no_number_breaks_it(self, start_m: float, least_m: float) -> None:
        assert self.broken(start_m, least_m)

    @pytest.mark.parametrize(
        ("face", "limit"),
        [
            (Face.SIDES, StopLimit(0.5, 2.0, 3.0, 0.1)),
            (Face.CEILING, StopLimit(0.25, 0.5, 0.75, 0.1)),
            (Face.FLOOR, StopLimit(0.25, 0.5, 0.75, 0.1)),
            (Face.BODY, StopLimit(0.5, 2.0, 2.5, 0.1)),
        ],
    )
    def test_slack_may_lead_out_of_an_inclusion_zone_and_never_into_a_body(
        self, face: Face, limit: StopLimit
    ) -> None:
        policy = replace(POLICY, brake_slack_h_m=3.0, brake_slack_v_m=0.75, creep_m=0.1)
        assert FenceCheck((), policy, BRAKING).stop_limit(face) == limit

    def test_a_smaller_slack_is_that_of_a_body_too(self) -> None:
        assert judge().stop_limit(Face.BODY).slack_m == 1.5


class TestPoints:
    """A margin is kept for certain from a millionth of a metre more on."""

    def test_at_the_margin_and_the_tolerance_it_is_kept(self) -> None:
        here = at(0, 0, 0)
        sure = 0.5 + TOLERANCE_M
        assert judge(slab(sure)).point("it", here, floor_applies=True) is None
        nearly = slab(math.nextafter(sure, 0.0))
        assert code(judge(nearly).point("it", here, floor_applies=True)) is Code.TOO_CLOSE

    def test_with_inclusive_bounds_from_a_millionth_less(self) -> None:
        here = at(0, 0, 0)
        sure = 0.5 - TOLERANCE_M
        assert judge(slab(sure), inclusive=True).point("it", here, floor_applies=True) is None
        nearly = judge(slab(math.nextafter(sure, 0.0)), inclusive=True)
        assert code(nearly.point("it", here, floor_applies=True)) is Code.TOO_CLOSE

    def test_a_body_is_never_inclusive(self) -> None:
        for inclusive in (False, True):
            towers = judge(TOWER, inclusive=inclusive)
            assert code(towers.point("it", at(32, 0, 15), floor_applies=True)) is Code.TOO_CLOSE
            assert towers.point("it", at(32.25, 0, 15), floor_applies=True) is None
            assert code(towers.point("it", at(25, 0, 20.5), floor_applies=True)) is not None
            assert towers.point("it", at(25, 0, 20.75), floor_applies=True) is None
            assert towers.point("it", at(25, 0, 9.25), floor_applies=True) is None
            assert code(towers.point("it", at(25, 0, 9.5), floor_applies=True)) is not None

    def test_above_a_body_at_the_margin_and_the_tolerance(self) -> None:
        lid = Zone("lid", False, Circle((0.0, 0.0), 5.0), -9.0, 0.0)
        sure = 0.5 + TOLERANCE_M
        assert judge(lid).point("it", (0.0, 0.0, -sure), floor_applies=True) is None
        less = math.nextafter(sure, 0.0)
        assert judge(lid).point("it", (0.0, 0.0, -less), floor_applies=True) is not None

    def test_a_ring_counts_beside_sides_and_body_and_not_in_height(self) -> None:
        def ring(place: Vec3, radius_m: float) -> Code | None:
            return code(judge(YARD, TOWER).ring("it", at(*place), radius_m))

        assert ring((50, 40, 15), 37.75) is None
        assert ring((50, 40, 15), 38.25) is Code.TOO_CLOSE
        assert ring((50, 40, 15), 40.25) is Code.OUTSIDE_FENCE
        assert ring((50, 20, 15), 12.0) is None
        fence = judge(TOWER)
        near = fence.ring("it", at(42, 0, 15), 10.25)
        assert near == Refusal(
            Code.TOO_CLOSE,
            "it is only 1.8 m from exclusion polygon 'tower', margin 2.0 m",
            (("clear_m", 1.75), ("margin_m", 2.0)),
            "tower",
        )
        assert fence.ring("it", at(42, 0, 15), 9.75) is None

    def test_a_ring_may_go_round_a_body(self) -> None:
        """The tower's corners are 7.07 m from its middle."""
        fence = judge(TOWER)
        assert fence.ring("it", at(25, 0, 15), 9.25) is None
        assert code(fence.ring("it", at(25, 0, 15), 8.75)) is Code.TOO_CLOSE
        assert code(fence.ring("it", at(25, 0, 15), 6.0)) is Code.INSIDE_EXCLUSION
        assert code(fence.ring("it", at(25, 0, 15), 2.0)) is Code.INSIDE_EXCLUSION

    def test_inside_at_all_is_asked_for_from_the_tolerance_on(self) -> None:
        here = at(0, 0, 0)
        assert judge(slab(TOLERANCE_M)).outside("it", here, floor_applies=True) is None
        nearly = slab(math.nextafter(TOLERANCE_M, 0.0))
        refusal = judge(nearly).outside("it", here, floor_applies=True)
        assert refusal is not None
        assert refusal.code is Code.TOO_CLOSE
        assert refusal.numbers[1] == ("margin_m", 0.0)

    def test_of_a_body_no_margin_is_asked_for_either(self) -> None:
        fence = judge(TOWER)
        assert fence.outside("it", at(30.25, 0, 15), floor_applies=True) is None
        assert fence.outside("it", at(25, 0, 20.25), floor_applies=True) is None
        assert code(fence.outside("it", at(29.75, 0, 15), floor_applies=True)) is (
            Code.INSIDE_EXCLUSION
        )

    def test_outside_is_told_with_the_distance(self) -> None:
        refusal = judge(YARD).outside("it", at(103, 40, 15), floor_applies=True)
        assert refusal == Refusal(
            Code.OUTSIDE_FENCE,
            "it (103.00 E, 40.00 N, 15.00 U) is 3.0 m outside inclusion polygon 'yard'",
            (("outside_m", 3.0), ("margin_m", 0.0)),
            "yard",
        )


class TestLegs:
    def leg(self, a: Vec3, b: Vec3, *zones: Zone, inclusive: bool = False) -> Code | None:
        fence = judge(*zones, inclusive=inclusive)
        return code(fence.leg("it", at(*a), at(*b), MARGINS, floor_applies=True))

    def test_it_keeps_the_margin_all_along(self) -> None:
        assert self.leg((50, 40, 10), (50, 40, 39.25), YARD) is None
        assert self.leg((50, 40, 10), (50, 40, 39.75), YARD) is Code.TOO_CLOSE
        assert self.leg((50, 40, 10), (50, 40, 41), YARD) is Code.LEG_LEAVES_FENCE

    def test_one_that_begins_nearer_comes_no_nearer(self) -> None:
        assert self.leg((50, 40, 39.75), (60, 40, 39.75), YARD) is None
        assert self.leg((50, 40, 39.75), (60, 40, 39.7), YARD) is None
        assert self.leg((50, 40, 39.75), (60, 40, 39.8), YARD) is Code.TOO_CLOSE

    def test_one_that_begins_outside_is_refused_wherever_it_leads(self) -> None:
        assert self.leg((50, 40, 41), (50, 40, 10), YARD) is Code.LEG_LEAVES_FENCE

    def test_at_the_margin_and_the_tolerance(self) -> None:
        sure = 0.5 + TOLERANCE_M
        down = (0.0, 0.0, 9.0)
        for clear_m, kept in ((sure, True), (math.nextafter(sure, 0.0), False)):
            refusal = judge(slab(clear_m)).leg("it", down, at(0, 0, 0), MARGINS, floor_applies=True)
            assert (refusal is None) is kept

    def test_it_begins_inside_from_the_tolerance_on(self) -> None:
        for clear_m, kept in ((TOLERANCE_M, True), (math.nextafter(TOLERANCE_M, 0.0), False)):
            away = (0.0, 0.0, 9.0)
            refusal = judge(slab(clear_m)).leg("it", at(0, 0, 0), away, MARGINS, floor_applies=True)
            assert (refusal is None) is kept

    def test_past_a_tower(self) -> None:
        assert self.leg((0, 8, 15), (50, 8, 15), TOWER) is None
        assert self.leg((0, 7, 15), (50, 7, 15), TOWER) is Code.TOO_CLOSE
        assert self.leg((0, 0, 15), (50, 0, 15), TOWER) is Code.LEG_LEAVES_FENCE
        assert self.leg((0, 0, 20.25), (50, 0, 20.25), TOWER) is Code.LEG_LEAVES_FENCE
        assert self.leg((0, 0, 20.75), (50, 0, 20.75), TOWER) is None

    def test_one_that_begins_near_a_tower_comes_no_nearer(self) -> None:
        assert self.leg((25, 6, 15), (40, 6, 15), TOWER) is None
        assert self.leg((25, 6, 15), (40, 40, 15), TOWER) is None
        assert self.leg((25, 6, 15), (26, 5.9, 15), TOWER) is Code.TOO_CLOSE
        assert self.leg((25, 0, 20.25), (40, 0, 20.25), TOWER) is None
        assert self.leg((25, 0, 20.25), (26, 0, 20.0), TOWER) is Code.LEG_LEAVES_FENCE

    def test_one_that_begins_in_a_tower_is_refused_with_how_deep(self) -> None:
        refusal = judge(TOWER).leg("it", at(28, 0, 15), at(50, 0, 15), MARGINS, floor_applies=True)
        assert refusal == Refusal(
            Code.LEG_LEAVES_FENCE,
            "it goes inside exclusion polygon 'tower'",
            (("outside_m", 2.0), ("margin_m", 2.0)),
            "tower",
        )

    def test_one_that_leads_through_a_tower_says_so(self) -> None:
        through = judge(TOWER).leg("it", at(0, 0, 15), at(50, 0, 15), MARGINS, floor_applies=True)
        touches = judge(TOWER).leg("it", at(0, 5, 15), at(50, 5, 15), MARGINS, floor_applies=True)
        assert through is not None
        assert touches is not None
        assert through.sentence == "it goes inside exclusion polygon 'tower'"
        assert touches.sentence == "it goes through exclusion polygon 'tower'"
        assert touches.code is Code.LEG_LEAVES_FENCE

    def test_beside_a_tower_at_the_margin_and_the_tolerance(self) -> None:
        wall = Zone("wall", False, Polygon(((-9.0, -9.0), (9.0, -9.0), (9.0, 0.0), (-9.0, 0.0))))
        sure = 2.0 + TOLERANCE_M
        for beside_m, kept in ((sure, True), (math.nextafter(sure, 0.0), False)):
            a, b = (9.0, 0.0, 0.0), (beside_m, 0.0, 0.0)
            refusal = judge(wall).leg("it", a, b, MARGINS, floor_applies=True)
            assert (refusal is None) is kept


class TestStops:
    def broken(self, a: Vec3, b: Vec3, *zones: Zone, floor: bool = True) -> Measure | None:
        return judge(*zones).broken_stop(at(*a), at(*b), floor_applies=floor)

    def test_beside_above_and_below(self) -> None:
        """Beside 0.5 + 2 - 1.5 = 1 m are kept, above and below 0.25 + 0.5 - 0.25 = 0.5 m."""
        assert self.broken((50, 40, 10), (99, 40, 10), YARD) is None
        east = self.broken((50, 40, 10), (99.25, 40, 10), YARD)
        assert east == Measure(YARD, Face.SIDES, 40.0, 0.75)
        assert self.broken((50, 40, 10), (50, 40, 39.5), YARD) is None
        up = self.broken((50, 40, 10), (50, 40, 39.75), YARD)
        assert up == Measure(YARD, Face.CEILING, 30.0, 0.25)
        assert self.broken((50, 40, 10), (50, 40, 0.5), YARD) is None
        down = self.broken((50, 40, 10), (50, 40, 0.25), YARD)
        assert down == Measure(YARD, Face.FLOOR, 10.0, 0.25)
        assert self.broken((50, 40, 10), (50, 40, 0.25), YARD, floor=False) is None

    def test_above_a_tower_half_a_metre_is_kept(self) -> None:
        assert self.broken((0, 0, 20.5), (25, 0, 20.5), TOWER) is None
        assert self.broken((0, 0, 20.25), (25, 0, 20.25), TOWER) is not None
        assert self.broken((0, 0, 20.25), (18.75, 0, 20.25), TOWER) is None

    def test_a_slack_over_the_margin_is_none_over_a_tower(self) -> None:
        policy = replace(POLICY, brake_slack_v_m=5.0)
        fence = FenceCheck((TOWER,), policy, BRAKING)
        assert fence.broken_stop(at(0, 0, 20), at(25, 0, 20), floor_applies=True) is None
        assert fence.broken_stop(at(0, 0, 19.75), at(25, 0, 19.75), floor_applies=True) is not None


class TestNearest:
    def test_beside_and_above_or_below_the_least_of_all_zones(self) -> None:
        near = judge(YARD, TOWER).nearest(at(50, 40, 15), at(60, 30, 15))
        assert near == Margins(30.0, 15.0)
        near = judge(YARD, TOWER).nearest(at(34, 6, 15), at(34, 20, 30))
        assert near.h_m == pytest.approx(math.hypot(4.0, 1.0))
        assert near.v_m == 10.0

    def test_the_floor_counts(self) -> None:
        assert judge(YARD).nearest(at(50, 40, 3), at(60, 40, 8)).v_m == 3.0

    def test_a_tower_that_is_flown_over_does_not(self) -> None:
        assert judge(TOWER).nearest(at(0, 0, 30), at(50, 0, 30)) == Margins(math.inf, math.inf)
