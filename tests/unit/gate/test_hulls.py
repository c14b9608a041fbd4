"""Clearances of hulls and rings, with shapely as the oracle."""

from __future__ import annotations

import math
import random

import pytest
import shapely

from gcs.gate.airspace.hulls import (
    ground_track,
    hull_inside,
    hull_outside,
    ring_inside,
    ring_outside,
)
from gcs.gate.geometry import Circle, Point, Polygon
from tests.each import each

TOWER = Polygon(((20.0, -5.0), (30.0, -5.0), (30.0, 5.0), (20.0, 5.0)))
NOTCHED = Polygon(((0.0, 0.0), (40.0, 0.0), (40.0, 40.0), (25.0, 40.0), (20.0, 10.0), (0.0, 40.0)))
MAST = Circle((25.0, 0.0), 5.0)


def points_of(dice: random.Random, count: int) -> list[Point]:
    return [(dice.uniform(-10, 50), dice.uniform(-20, 50)) for _ in range(count)]


@each("seed", range(200))
def test_the_ground_track_is_the_convex_hull(seed: int) -> None:
    points = points_of(random.Random(seed), 1 + seed % 7)
    corners = ground_track(points)
    hull = shapely.MultiPoint(points).convex_hull
    ours = shapely.MultiPoint(corners).convex_hull
    assert hull.symmetric_difference(ours).area < 1e-9
    assert set(corners) <= set(points)


@each("seed", range(300))
def test_a_hull_beside_a_zone_is_as_far_off_as_shapely_says(seed: int) -> None:
    points = points_of(random.Random(seed), 1 + seed % 6)
    track = ground_track(points)
    hull = shapely.MultiPoint(points).convex_hull
    for shape in (TOWER, NOTCHED):
        zone = shapely.Polygon(shape.corners_en)
        far_m = hull_outside(shape, track)
        assert max(0.0, far_m) == pytest.approx(zone.distance(hull), abs=1e-6)
        assert (far_m < 1e-6) == zone.intersects(hull)
        within_m = hull_inside(shape, track)
        inside = zone.contains(hull)
        assert (within_m > 0.0) == inside
        if inside:
            assert within_m == pytest.approx(zone.exterior.distance(hull), abs=1e-6)
    mast_m = hull.distance(shapely.Point(MAST.centre_en)) - MAST.radius_m
    assert hull_outside(MAST, track) <= mast_m + 1e-9
    assert max(0.0, hull_outside(MAST, track)) == pytest.approx(max(0.0, mast_m), abs=1e-6)
    reach_m = max(math.dist(point, MAST.centre_en) for point in points)
    assert hull_inside(MAST, track) == pytest.approx(MAST.radius_m - reach_m)


def test_a_zone_wholly_inside_a_hull_is_not_clear_of_it() -> None:
    track = ground_track([(0.0, -30.0), (60.0, -30.0), (25.0, 60.0)])
    assert hull_outside(TOWER, track) < 0.0
    assert hull_outside(MAST, track) < -MAST.radius_m
    assert hull_inside(TOWER, track) < 0.0


def test_a_notch_that_reaches_into_a_hull_leaves_the_zone() -> None:
    """All corners are inside the zone, and its notch is among them."""
    track = ground_track([(5.0, 25.0), (35.0, 35.0), (20.0, 3.0)])
    assert hull_inside(NOTCHED, track) < 0.0


@each("seed", range(300))
def test_a_ring_is_as_far_off_as_shapely_says(seed: int) -> None:
    dice = random.Random(seed)
    (centre,) = points_of(dice, 1)
    radius_m = dice.uniform(1.0, 40.0)
    ring = shapely.Point(centre).buffer(radius_m, quad_segs=400).exterior
    for shape in (TOWER, NOTCHED):
        zone = shapely.Polygon(shape.corners_en)
        far_m, within_m = (
            ring_outside(shape, centre, radius_m),
            ring_inside(shape, centre, radius_m),
        )
        if not zone.intersects(ring):
            assert far_m == pytest.approx(zone.distance(ring), abs=0.01)
        else:
            assert far_m < 0.01
        if zone.contains(ring):
            assert within_m == pytest.approx(zone.exterior.distance(ring), abs=0.01)
        else:
            assert within_m < 0.01
    mast = shapely.Point(MAST.centre_en).buffer(MAST.radius_m, quad_segs=400)
    if not mast.intersects(ring):
        expected = pytest.approx(mast.distance(ring), abs=0.01)
        assert ring_outside(MAST, centre, radius_m) == expected
    else:
        assert ring_outside(MAST, centre, radius_m) < 0.01
