"""Crossings, convexity and legs that begin on a boundary; shapes a few centimetres in size.

Expected values are distances that can be drawn; shapely says which polygon is its own hull.
"""

from __future__ import annotations

import math
from itertools import product

import pytest
import shapely
from hypothesis import given

from gcs.gate.geometry import (
    REACH_M,
    TOLERANCE_M,
    Point,
    Polygon,
    Side,
    crossing,
    polygon_fault,
    segment_distance,
    side,
)
from tests.unit.gate.test_geometry import NOTCHED, SQUARE, stars

HORSESHOE = Polygon(
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
"""Open to the north between 20 and 40 m east."""

PENTAGON = tuple((math.cos(math.tau * k / 5), math.sin(math.tau * k / 5)) for k in range(5))


def scaled(corners: tuple[Point, ...], scale: float) -> tuple[Point, ...]:
    return tuple((scale * east, scale * north) for east, north in corners)


class TestSide:
    def test_inside_by_more_than_the_tolerance_is_inside(self) -> None:
        assert side(0.5) is Side.INSIDE
        assert side(2.0 * TOLERANCE_M) is Side.INSIDE
        assert side(0.5 * TOLERANCE_M) is Side.TOO_CLOSE

    def test_outside_by_more_than_the_tolerance_is_outside(self) -> None:
        assert side(-2.0 * TOLERANCE_M) is Side.OUTSIDE
        assert side(-0.5 * TOLERANCE_M) is Side.TOO_CLOSE

    def test_less_than_the_margin_is_too_close(self) -> None:
        assert side(0.75, 0.5) is Side.INSIDE
        assert side(0.25, 0.5) is Side.TOO_CLOSE
        assert side(-0.25, 0.5) is Side.OUTSIDE


class TestCrossing:
    @pytest.mark.parametrize("size_m", [0.02, 0.2, 20.0, 2000.0])
    @pytest.mark.parametrize(("back", "down"), list(product([False, True], repeat=2)))
    def test_a_cross_of_any_size_whichever_way_its_legs_go(
        self, size_m: float, back: bool, down: bool
    ) -> None:
        """The second leg crosses the first a quarter of the way from its western end."""
        a, b = (0.0, 0.0), (size_m, 0.0)
        c, d = (size_m / 4, -size_m / 2), (size_m / 4, size_m / 2)
        a, b = (b, a) if back else (a, b)
        c, d = (d, c) if down else (c, d)
        assert crossing(a, b, c, d) == pytest.approx(0.75 if back else 0.25)
        assert crossing(c, d, a, b) == pytest.approx(0.5)
        assert segment_distance(a, b, c, d) == 0.0

    @pytest.mark.parametrize("beyond_m", [-5.0, 5.0])
    @pytest.mark.parametrize("back", [False, True])
    def test_an_end_that_touches_the_other_leg_is_no_crossing(
        self, beyond_m: float, back: bool
    ) -> None:
        bar, touching = ((0.0, 0.0), (10.0, 0.0)), ((5.0, 0.0), (5.0, beyond_m))
        if back:
            touching = (touching[1], touching[0])
        assert crossing(*bar, *touching) is None
        assert crossing(*touching, *bar) is None
        assert segment_distance(*bar, *touching) == 0.0

    def test_legs_that_pass_each_other_do_not_cross(self) -> None:
        assert crossing((0.0, 0.0), (10.0, 0.0), (12.0, -5.0), (12.0, 5.0)) is None
        assert crossing((0.0, 0.0), (10.0, 0.0), (5.0, 1.0), (5.0, 5.0)) is None


class TestConvex:
    @pytest.mark.parametrize(
        ("corners", "convex"),
        [
            (((0.0, 0.0), (8.0, 0.0), (3.0, 6.0)), True),
            (SQUARE.corners_en, True),
            (PENTAGON, True),
            (((0.0, 0.0), (5.0, 0.0), (10.0, 0.0), (10.0, 10.0), (0.0, 10.0)), True),
            (((0.0, 0.0), (10.0, 0.0), (2.0, 2.0), (0.0, 10.0)), False),
            (((0.0, 0.0), (10.0, 0.0), (10.0, 10.0), (5.0, 9.0), (0.0, 10.0)), False),
            (NOTCHED.corners_en, False),
            (HORSESHOE.corners_en, False),
            (((0.0, 0.0), (9.0, 0.0), (9.0, 4.0), (4.0, 4.0), (4.0, 9.0), (0.0, 9.0)), False),
        ],
        ids=["triangle", "square", "pentagon", "flat", "dart", "dent", "notch", "shoe", "ell"],
    )
    @pytest.mark.parametrize("scale", [1.0, 0.01])
    @pytest.mark.parametrize("way", [1, -1], ids=["left", "right"])
    def test_no_corner_points_inwards(
        self, corners: tuple[Point, ...], convex: bool, scale: float, way: int
    ) -> None:
        for first in range(len(corners)):
            turned = corners[first:] + corners[:first]
            assert Polygon(scaled(turned, scale)[::way]).convex is convex

    @given(stars())
    def test_what_does_not_fill_its_own_hull_is_not_convex(self, polygon: Polygon) -> None:
        theirs = shapely.Polygon(polygon.corners_en)
        if theirs.area < theirs.convex_hull.area * (1.0 - 1e-6):
            assert not polygon.convex

    def test_a_dent_of_centimetres_is_outside(self) -> None:
        """In the notch of a polygon of 0.1 m, drawn clockwise and not."""
        for way in (1, -1):
            small = Polygon(scaled(NOTCHED.corners_en, 0.01)[::way])
            assert small.inner_clearance((0.02, 0.08), (0.08, 0.08)) < 0.0


class TestLegsFromTheBoundary:
    """The leg begins or ends on a wall of the notch: its middle is 10 m from either wall."""

    WALL, INSIDE = (20.0, 40.0), (50.0, 40.0)

    def test_across_the_notch_it_is_outside(self) -> None:
        assert HORSESHOE.inner_clearance(self.WALL, self.INSIDE) == -10.0
        assert HORSESHOE.inner_clearance(self.INSIDE, self.WALL) == -10.0

    def test_as_an_exclusion_it_is_entered(self) -> None:
        """From the wall of one arm, 20 m wide, through the notch and half the other arm."""
        assert HORSESHOE.outer_clearance(self.WALL, self.INSIDE) == -10.0
        assert HORSESHOE.outer_clearance(self.INSIDE, self.WALL) == -10.0

    def test_out_of_one_arm_it_is_inside_though_it_ends_on_the_wall(self) -> None:
        """From the wall to the west, through 20 m of the arm, and out: 10 m deep half-way."""
        west = (-30.0, 40.0)
        assert HORSESHOE.outer_clearance(self.WALL, west) == -10.0
        assert HORSESHOE.outer_clearance(west, self.WALL) == -10.0

    def test_a_leg_of_no_length_is_its_point(self) -> None:
        corner = (20.0, 20.0)
        assert HORSESHOE.inner_clearance(corner, corner) == 0.0
        assert HORSESHOE.outer_clearance(corner, corner) == 0.0


class TestReach:
    @pytest.mark.parametrize("sign", [1.0, -1.0])
    @pytest.mark.parametrize("axis", [0, 1])
    def test_a_corner_is_within_a_thousand_kilometres(self, axis: int, sign: float) -> None:
        def triangle(far_m: float) -> tuple[Point, ...]:
            far, wide = (sign * far_m, 0.0), (0.0, 5.0)
            corners = ((0.0, 0.0), far, wide)
            return tuple((n, e) for e, n in corners) if axis else corners

        assert REACH_M == 1.0e6
        assert polygon_fault(triangle(REACH_M)) is None
        assert polygon_fault(triangle(1.2e6)) == "corner 2 is not a place within 1000 km"
        assert polygon_fault(triangle(math.inf)) == "corner 2 is not a place within 1000 km"
