"""Lawn-mower lines over a polygon, and parallel lines along a corridor.

Points are (east_m, north_m) in a plane.  A *run* is a polyline along which pictures are taken; the
vehicle flies straight from one run to the next.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import pairwise
from typing import TypeAlias

Point: TypeAlias = tuple[float, float]
Run: TypeAlias = list[Point]

_SHORTEST_M = 0.1
_MITRE_MOST = 2.0
"""A corner of an offset line is at most so many times the offset away; a sharper one is cut off."""


def survey_runs(polygon: Sequence[Point], spacing_m: float, angle_deg: float) -> list[Run]:
    """Lines that run `angle_deg` clockwise from north, each cut to the polygon, which may be
    concave, one after the other in alternating directions.

    They are evenly spread and at most `spacing_m` apart, the outer ones half as far from the edge.
    """
    turned = [_turned(point, -angle_deg) for point in polygon]
    left, right = min(x for x, _ in turned), max(x for x, _ in turned)
    count = max(1, math.ceil((right - left) / spacing_m - 1e-9))
    step_m = (right - left) / count
    runs: list[Run] = []
    for number in range(count):
        x = left + (number + 0.5) * step_m
        pieces = [[(x, low), (x, high)] for low, high in _inside(turned, x)]
        if number % 2:
            pieces = [piece[::-1] for piece in reversed(pieces)]
        runs += [[_turned(point, angle_deg) for point in piece] for piece in pieces]
    return runs


def _inside(polygon: Sequence[Point], x: float) -> list[tuple[float, float]]:
    """The parts of the line at `x` that are in the polygon, upwards.

    An edge counts with its left end and without its right one, so a corner is never counted twice.
    """
    crossings = sorted(
        ay + (by - ay) * (x - ax) / (bx - ax)
        for (ax, ay), (bx, by) in zip(polygon, [*polygon[1:], polygon[0]], strict=True)
        if (ax <= x) != (bx <= x)
    )
    spans = zip(crossings[::2], crossings[1::2], strict=True)
    return [(low, high) for low, high in spans if high - low >= _SHORTEST_M]


def easiest_angle_deg(polygon: Sequence[Point]) -> float:
    """The direction of the edge across which the polygon is narrowest, 0 to 180: fewest turns."""
    angles = {
        math.degrees(math.atan2(bx - ax, by - ay)) % 180.0
        for (ax, ay), (bx, by) in zip(polygon, [*polygon[1:], polygon[0]], strict=True)
        if (ax, ay) != (bx, by)
    }

    def width_m(angle_deg: float) -> float:
        across = [_turned(point, -angle_deg)[0] for point in polygon]
        return max(across) - min(across)

    return min(sorted(angles), key=lambda angle_deg: round(width_m(angle_deg), 3))


def corridor_runs(line: Sequence[Point], width_m: float, spacing_m: float) -> list[Run]:
    """Lines beside each other along `line`, evenly over `width_m` and at most `spacing_m` apart, in
    alternating directions."""
    count = max(1, math.ceil(width_m / spacing_m - 1e-9))
    step_m = width_m / count
    offsets = [-width_m / 2.0 + (number + 0.5) * step_m for number in range(count)]
    runs = [_offset(line, offset_m) for offset_m in offsets]
    return [run[::-1] if number % 2 else run for number, run in enumerate(runs)]


def _offset(line: Sequence[Point], offset_m: float) -> Run:
    """The line moved to its right by `offset_m`."""
    normals = [_right_of(a, b) for a, b in pairwise(line)]
    run: Run = []
    for number, (x, y) in enumerate(line):
        before = normals[max(0, number - 1)]
        after = normals[min(number, len(normals) - 1)]
        middle = (before[0] + after[0], before[1] + after[1])
        length = math.hypot(*middle)
        # The mitre is as long as the offset over the cosine of half the turn, which is length / 2.
        if length >= 2.0 / _MITRE_MOST:
            mitre_m = offset_m / (length / 2.0)
            run.append((x + mitre_m * middle[0] / length, y + mitre_m * middle[1] / length))
        else:
            run += [
                (x + offset_m * normal[0], y + offset_m * normal[1]) for normal in (before, after)
            ]
    return run


def _right_of(a: Point, b: Point) -> Point:
    length = math.dist(a, b)
    return (b[1] - a[1]) / length, -(b[0] - a[0]) / length


def nearest_first(runs: list[Run], home: Point) -> list[Run]:
    """The same runs from their other end, or backwards, if that begins nearer to home."""
    back = [run[::-1] for run in reversed(runs)]
    across = [run[::-1] for run in runs]
    across_back = [run[::-1] for run in reversed(across)]
    return min((runs, back, across, across_back), key=lambda order: math.dist(order[0][0], home))


def ring(centre: Point, radius_m: float, points: int, turns: float, begin: Point) -> Run:
    """Clockwise round `centre`, from the point that is nearest to `begin`."""
    start = math.atan2(begin[0] - centre[0], begin[1] - centre[1])
    return [
        (
            centre[0] + radius_m * math.sin(start + math.tau * number / points),
            centre[1] + radius_m * math.cos(start + math.tau * number / points),
        )
        for number in range(round(points * turns) + 1)
    ]


def length_m(run: Run) -> float:
    return sum(math.dist(a, b) for a, b in pairwise(run))


def _turned(point: Point, angle_deg: float) -> Point:
    """Clockwise about the origin."""
    angle = math.radians(angle_deg)
    x, y = point
    return (x * math.cos(angle) + y * math.sin(angle), y * math.cos(angle) - x * math.sin(angle))
