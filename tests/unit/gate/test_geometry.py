"""Three answers, held against exact rational arithmetic and against shapely."""

from __future__ import annotations

import math
from fractions import Fraction

import pytest
import shapely
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from gcs.gate.geometry import (
    TOLERANCE_M,
    Circle,
    Point,
    Polygon,
    Side,
    crossing,
    polygon_fault,
    segment_distance,
    side,
)
from tests.shares import examples

SQUARE = Polygon(((0.0, 0.0), (10.0, 0.0), (10.0, 10.0), (0.0, 10.0)))
NOTCHED = Polygon(
    ((0.0, 0.0), (10.0, 0.0), (10.0, 10.0), (6.0, 10.0), (5.0, 2.0), (4.0, 10.0), (0.0, 10.0))
)

metres = st.floats(-1000.0, 1000.0, allow_nan=False)
points = st.tuples(metres, metres)

millimetres = st.integers(-1_000_000, 1_000_000).map(lambda mm: mm / 1000)
spots = st.tuples(millimetres, millimetres)  # shapely divides by zero below 1e-150


@st.composite
def stars(draw: st.DrawFn, scale: float = 1.0) -> Polygon:
    """Star-shaped polygons, mostly far from convex, within `scale` kilometres."""
    n = draw(st.integers(3, 9))
    east, north = (scale * x for x in draw(points))
    radii = draw(st.lists(st.floats(1.0, 500.0 * scale), min_size=n, max_size=n))
    turn = draw(st.floats(0.0, math.tau))
    corners = tuple(
        (
            east + r * math.cos(turn + math.tau * k / n),
            north + r * math.sin(turn + math.tau * k / n),
        )
        for k, r in enumerate(radii)
    )
    assume(polygon_fault(corners) is None)
    return Polygon(corners)


def exactly_inside(polygon: Polygon, p: Point) -> bool:
    """Strictly inside, in rational arithmetic: crossings of a ray, and nothing on an edge."""
    x, y = Fraction(p[0]), Fraction(p[1])
    inside = False
    for (ax, ay), (bx, by) in (
        ((Fraction(a[0]), Fraction(a[1])), (Fraction(b[0]), Fraction(b[1])))
        for a, b in polygon.edges
    ):
        cross = (bx - ax) * (y - ay) - (by - ay) * (x - ax)
        between = min(ax, bx) <= x <= max(ax, bx) and min(ay, by) <= y <= max(ay, by)
        if cross == 0 and between:
            return False
        if (ay > y) != (by > y) and x < ax + (y - ay) * (bx - ax) / (by - ay):
            inside = not inside
    return inside


@given(stars(), points)
def test_inside_is_never_said_of_a_point_that_is_exactly_outside(
    polygon: Polygon, p: Point
) -> None:
    answer = side(polygon.clearance(p))
    if answer is Side.INSIDE:
        assert exactly_inside(polygon, p)
    if answer is Side.OUTSIDE:
        assert not exactly_inside(polygon, p)


@given(stars() | stars(scale=600.0), st.integers(0, 8), st.floats(0.0, 1.0), st.floats(-1.0, 1.0))
def test_next_to_an_edge_the_answer_is_right_or_too_close(
    polygon: Polygon, edge: int, t: float, nudge: float
) -> None:
    (ax, ay), (bx, by) = polygon.edges[edge % len(polygon.edges)]
    length = math.hypot(bx - ax, by - ay)
    off = nudge * 3.0 * TOLERANCE_M / length
    p = (ax + t * (bx - ax) - off * (by - ay), ay + t * (by - ay) + off * (bx - ax))
    answer = side(polygon.clearance(p))
    if answer is Side.INSIDE:
        assert exactly_inside(polygon, p)
    elif answer is Side.OUTSIDE:
        assert not exactly_inside(polygon, p)


@given(points, st.floats(0.5, 500.0), st.floats(0.0, math.tau), st.floats(-1.0, 1.0))
def test_next_to_a_circle_the_answer_is_right_or_too_close(
    centre: Point, radius_m: float, bearing: float, nudge: float
) -> None:
    r = radius_m + 3.0 * TOLERANCE_M * nudge
    p = (centre[0] + r * math.cos(bearing), centre[1] + r * math.sin(bearing))
    dx, dy = (Fraction(x) - Fraction(c) for x, c in zip(p, centre, strict=True))
    exactly = dx * dx + dy * dy < Fraction(radius_m) ** 2
    answer = side(Circle(centre, radius_m).clearance(p))
    assert answer is Side.TOO_CLOSE or (answer is Side.INSIDE) == exactly


@given(stars(), st.integers(0, 8))
def test_a_corner_is_too_close_to_say(polygon: Polygon, k: int) -> None:
    corner = polygon.corners_en[k % len(polygon.corners_en)]
    assert side(polygon.clearance(corner)) is Side.TOO_CLOSE


@given(stars(), points)
def test_clearance_of_a_point_agrees_with_shapely(polygon: Polygon, p: Point) -> None:
    theirs = shapely.Polygon(polygon.corners_en)
    distance = theirs.exterior.distance(shapely.Point(p))
    assert abs(polygon.clearance(p)) == pytest.approx(distance, abs=1e-9)
    if distance > TOLERANCE_M:
        assert (polygon.clearance(p) > 0.0) == theirs.contains(shapely.Point(p))


@given(spots, spots, spots, spots)
def test_distance_of_two_segments_agrees_with_shapely(
    a: Point, b: Point, c: Point, d: Point
) -> None:
    theirs = shapely.LineString([a, b]).distance(shapely.LineString([c, d]))
    assert segment_distance(a, b, c, d) == pytest.approx(theirs, abs=1e-8)


@pytest.mark.slow
@settings(max_examples=examples(200))
@given(stars(), spots, spots)
def test_a_leg_is_inside_only_if_shapely_says_so(polygon: Polygon, a: Point, b: Point) -> None:
    theirs = shapely.Polygon(polygon.corners_en)
    leg = shapely.LineString([a, b])
    least = polygon.inner_clearance(a, b)
    gap = theirs.exterior.distance(leg)
    if gap > TOLERANCE_M:
        assert least == pytest.approx(gap if theirs.contains(leg) else least, abs=1e-8)
        assert (least > 0.0) == theirs.contains(leg)
    else:
        assert least <= TOLERANCE_M
    if leg.difference(theirs).length > 0.01:
        assert least < 0.0


@pytest.mark.slow
@settings(max_examples=examples(200))
@given(stars(), spots, spots)
def test_a_leg_is_outside_only_if_shapely_says_so(polygon: Polygon, a: Point, b: Point) -> None:
    theirs = shapely.Polygon(polygon.corners_en)
    leg = shapely.LineString([a, b])
    least = polygon.outer_clearance(a, b)
    if leg.intersection(theirs).length > 0.01:
        assert least < 0.0
    elif theirs.distance(leg) > TOLERANCE_M:
        assert least == pytest.approx(theirs.distance(leg), abs=1e-8)


@given(spots, st.floats(0.5, 500.0), spots, spots)
def test_circle_and_leg_agree_with_distances_along_the_leg(
    centre: Point, radius_m: float, a: Point, b: Point
) -> None:
    circle = Circle(centre, radius_m)
    leg, spot = shapely.LineString([a, b]), shapely.Point(centre)
    assert circle.outer_clearance(a, b) == pytest.approx(spot.distance(leg) - radius_m, abs=1e-8)
    farthest = max(spot.distance(shapely.Point(end)) for end in (a, b))
    assert circle.inner_clearance(a, b) == pytest.approx(radius_m - farthest, abs=1e-8)


def test_a_leg_across_a_notch_is_outside_though_both_ends_are_inside() -> None:
    assert NOTCHED.clearance((2.0, 8.0)) > 0.0
    assert NOTCHED.clearance((8.0, 8.0)) > 0.0
    assert NOTCHED.inner_clearance((2.0, 8.0), (8.0, 8.0)) < -0.5


def test_a_leg_through_two_corners_and_the_outside_between_them_is_outside() -> None:
    assert NOTCHED.inner_clearance((4.0, 10.0), (6.0, 10.0)) < -0.5


def test_a_leg_along_an_edge_is_not_outside() -> None:
    assert NOTCHED.inner_clearance((0.0, 0.0), (10.0, 0.0)) == 0.0
    assert SQUARE.inner_clearance((0.0, 10.0), (10.0, 10.0)) == 0.0


def test_a_leg_through_a_thin_exclusion_is_inside_it_though_both_ends_are_outside() -> None:
    wall = Polygon(((5.0, -50.0), (5.1, -50.0), (5.1, 50.0), (5.0, 50.0)))
    assert wall.outer_clearance((0.0, 0.0), (10.0, 0.0)) < 0.0


def test_clearance_on_the_boundary_is_never_minus_zero() -> None:
    assert math.copysign(1.0, SQUARE.clearance((10.0, 10.0))) == 1.0


def test_not_a_number_is_never_inside() -> None:
    for shape in (SQUARE, Circle((0.0, 0.0), 1.0)):
        assert side(shape.clearance((math.nan, 0.0))) is not Side.INSIDE


def test_touching_ends_are_no_crossing_but_no_distance_either() -> None:
    a, b, c, d = (0.0, 0.0), (10.0, 0.0), (5.0, 0.0), (5.0, 5.0)
    assert crossing(a, b, c, d) is None
    assert segment_distance(a, b, c, d) == 0.0
    assert crossing(a, b, (5.0, -5.0), d) == 0.5


@pytest.mark.parametrize(
    ("corners", "fault"),
    [
        ((), "at least 3"),
        (((0.0, 0.0), (1.0, 0.0)), "at least 3"),
        (((0.0, 0.0), (1.0, 0.0), (math.nan, 1.0)), "corner 3 is not a place"),
        (((0.0, 0.0), (1.0, 0.0), (1.0, 0.0), (0.0, 1.0)), "corners 2 and 3 are the same"),
        (((0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (0.0, 0.0)), "corners 4 and 1 are the same"),
        (((0.0, 0.0), (2.0, 0.0), (1.0, 0.0)), "lie on each other"),
        (((0.0, 0.0), (5.0, 0.0), (5.0, 5.0), (5.0, 1.0)), "lie on each other"),
        (((0.0, 0.0), (5.0, 5.0), (5.0, 0.0), (0.0, 5.0)), "intersects itself"),
        (((0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (2.0, 0.0), (0.0, 4.0)), "intersects itself"),
    ],
)
def test_what_is_no_polygon_is_named(corners: tuple[Point, ...], fault: str) -> None:
    found = polygon_fault(corners)
    assert found is not None
    assert fault in found


@given(st.lists(points, min_size=3, max_size=7).map(tuple))
def test_a_polygon_without_fault_is_valid_to_shapely(corners: tuple[Point, ...]) -> None:
    if polygon_fault(corners) is None:
        assert shapely.Polygon(corners).is_valid


@given(stars(), points)
def test_the_way_round_does_not_matter(polygon: Polygon, p: Point) -> None:
    other = Polygon(polygon.corners_en[::-1])
    assert other.clearance(p) == pytest.approx(polygon.clearance(p), abs=1e-9)
    assert other.convex == polygon.convex
