"""The clearance of regions that are no straight line: convex hulls of points, and rings.

A *hull* is every place of the convex hull of a few points' ground tracks, at any height between
the lowest and the highest of them.  A *ring* is the line of a circle, without its inside.
Clearances are as in `clearance.py`: metres, negative on the forbidden side.

The distance between a hull and a shape is taken edge by edge with the leg's own functions, whose
error is below `TOLERANCE_M`; a corner of the shape inside the hull is on the forbidden side.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

from gcs.gate.geometry import TOLERANCE_M, Circle, Point, Shape, point_segment_distance


def ground_track(points: Sequence[Point]) -> tuple[Point, ...]:
    """The corners of the hull of places, anticlockwise and without points on its edges (A. M.
    Andrew's monotone chain, 1979); one or two where it has no area."""
    ordered = sorted(set(points))
    if len(ordered) <= 2:
        return tuple(ordered)
    lower, upper = _chain(ordered), _chain(ordered[::-1])
    return tuple(lower[:-1] + upper[:-1])


def hull_inside(shape: Shape, corners: Sequence[Point]) -> float:
    """The least clearance of a hull from the boundary of an inclusion zone."""
    if isinstance(shape, Circle) or shape.convex:
        return min(shape.clearance(corner) for corner in corners)
    least_m = min(shape.inner_clearance(a, b) for a, b in _edges(corners))
    return min(least_m, -_deepest(shape.corners_en, corners))


def hull_outside(shape: Shape, corners: Sequence[Point]) -> float:
    """Metres from an exclusion zone to a hull, negative if any of the hull is inside the zone."""
    if isinstance(shape, Circle):
        depth_m = _depth(shape.centre_en, corners)
        if depth_m is not None:
            return -shape.radius_m - depth_m
    least_m = min(shape.outer_clearance(a, b) for a, b in _edges(corners))
    if isinstance(shape, Circle):
        return least_m
    deepest_m = _deepest(shape.corners_en, corners)
    return min(least_m, -deepest_m) if deepest_m > 0.0 else least_m


def ring_inside(shape: Shape, centre: Point, radius_m: float) -> float:
    """The least clearance of a ring from the boundary of an inclusion zone."""
    if isinstance(shape, Circle) or shape.convex:
        return shape.clearance(centre) - radius_m
    inside = shape.contains((centre[0] + radius_m, centre[1]))
    gap_m = min(_ring_gap(centre, radius_m, a, b) for a, b in shape.edges)
    return gap_m if inside else min(gap_m, -abs(gap_m))


def ring_outside(shape: Shape, centre: Point, radius_m: float) -> float:
    """Metres from an exclusion zone to a ring, outside it or round it; negative on the zone."""
    if isinstance(shape, Circle):
        return abs(math.dist(centre, shape.centre_en) - radius_m) - shape.radius_m
    gap_m = min(_ring_gap(centre, radius_m, a, b) for a, b in shape.edges)
    return -abs(gap_m) if shape.contains((centre[0] + radius_m, centre[1])) else gap_m


def _ring_gap(centre: Point, radius_m: float, a: Point, b: Point) -> float:
    """Metres between a ring and a segment; where they cross, less than zero by the lesser way."""
    near_m = point_segment_distance(centre, a, b)
    far_m = max(math.dist(centre, a), math.dist(centre, b))
    return max(near_m - radius_m, radius_m - far_m)


def _chain(ordered: Sequence[Point]) -> list[Point]:
    chain: list[Point] = []
    for point in ordered:
        while len(chain) >= 2 and _turn(chain[-2], chain[-1], point) <= 0.0:
            chain.pop()
        chain.append(point)
    return chain


def _edges(corners: Sequence[Point]) -> list[tuple[Point, Point]]:
    if len(corners) <= 2:
        return [(corners[0], corners[-1])]
    return list(zip(corners, [*corners[1:], corners[0]], strict=True))


def _depth(point: Point, corners: Sequence[Point]) -> float | None:
    """Metres from a point inside the hull to its edge; None where it is not inside for certain.

    Measured from the lines through the edges.  Of a hull that is almost a straight line, a point
    far off on that line seems to be on the inner side of every edge, by rounding; but none of the
    lines is far from it.  A point that is inside by less than the tolerance is as near to an edge,
    and the edges are looked at by themselves.
    """
    if len(corners) < 3:
        return None
    depth_m = min(_turn(a, b, point) / math.dist(a, b) for a, b in _edges(corners))
    return depth_m if depth_m > TOLERANCE_M else None


def _deepest(points: Sequence[Point], corners: Sequence[Point]) -> float:
    """How deep the deepest of `points` is inside the hull; less than zero where none is."""
    depths = (_depth(point, corners) for point in points)
    return max((depth for depth in depths if depth is not None), default=-math.inf)


def _turn(a: Point, b: Point, p: Point) -> float:
    return (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0])
