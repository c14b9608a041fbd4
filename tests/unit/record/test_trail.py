"""The trail: few points, and the shape of the way."""

from __future__ import annotations

import math
import random
from itertools import pairwise

from gcs.frames import Vec3
from gcs.record.derived.trail import MOST_CORNERS, TOLERANCE_M, Trail


def to_line(point: Vec3, line: list[Vec3]) -> float:
    """The distance of a point to a line through points."""
    least = math.inf
    for a, b in pairwise(line):
        sides = (math.dist(a, b), math.dist(point, a), math.dist(point, b))
        half = sum(sides) / 2
        square = half * math.prod(half - side for side in sides)  # Heron's formula
        inner = abs(sides[1] ** 2 - sides[2] ** 2) < sides[0] ** 2
        off_m = 2 * math.sqrt(max(0.0, square)) / sides[0] if inner else min(sides[1:])
        least = min(least, off_m)
    return least


def flown(way: list[Vec3]) -> Trail:
    trail = Trail()
    for at in way:
        trail.add(at)
    return trail


def test_a_straight_stretch_is_two_points_however_long() -> None:
    trail = flown([(number * 0.25, 0.0, 1.0) for number in range(10_000)])
    assert len(trail.points_enu) <= 10_000 / 60
    assert trail.points_enu[0] == (0.0, 0.0, 1.0)
    assert trail.points_enu[-1] == (9_999 * 0.25, 0.0, 1.0)


def test_corners_stay_where_they_were_flown() -> None:
    side = [number * 0.25 for number in range(100)]
    way = [(x, 0.0, 5.0) for x in side] + [(25.0, y, 5.0) for y in side]
    points = flown(way).points_enu
    assert min(math.dist(point, (25.0, 0.0, 5.0)) for point in points) < 0.3
    assert len(points) < 10


def test_an_hour_in_circles_keeps_its_shape() -> None:
    """The complaint: 25 m between points after 36 min."""
    way = [
        (20 * math.cos(t * 0.01), 20 * math.sin(t * 0.01), 5 + 0.0002 * t) for t in range(36_000)
    ]
    points = flown(way).points_enu
    assert len(points) <= MOST_CORNERS + 1
    far_m = max(to_line(at, points) for at in random.Random(1).sample(way, 40))
    assert far_m <= 2.0  # 800 corners in 57 rounds: 14 a round, whose sides pass 0.5 m inside it


def test_no_sample_of_a_random_way_lies_far_from_the_line() -> None:
    rng = random.Random(7)
    at, heading = (0.0, 0.0, 10.0), 0.0
    way = [at]
    for _ in range(600):
        heading += rng.uniform(-0.4, 0.4)
        at = (at[0] + math.cos(heading), at[1] + math.sin(heading), at[2] + rng.uniform(-0.2, 0.2))
        way.append(at)
    trail = flown(way)
    assert max(to_line(at, trail.points_enu) for at in way[::7]) <= TOLERANCE_M + 1e-2


def test_a_vehicle_that_stands_has_a_trail_of_one_point() -> None:
    assert len(flown([(1.0, 2.0, 0.01 * (number % 3)) for number in range(100)]).points_enu) == 1
