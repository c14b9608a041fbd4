"""Plane geometry in the local tangent plane, with three answers: inside, outside, too close to say.

Points are (east, north) in metres.  The *clearance* of a point is its distance to the boundary of
a shape: positive inside, negative outside.

Rounding errors.  Every quantity starts from a difference of two coordinates, which floating point
gives with a relative error u = 2^-53; a product or a sum of two such quantities adds a few u.  A
clearance among coordinates up to REACH_M is therefore wrong by less than 16 u REACH_M < 2e-9 m.
On which side of an edge a point lies is the sign of a difference of two products.  The sign can
be wrong only where the products are equal to within a few u, so only where the point is within a
few u of the edge and the clearance is almost zero.  TOLERANCE_M is five hundred times larger than
both errors, so INSIDE is never answered for a point that exact arithmetic puts outside.  The
tests compare with exact rational arithmetic (`fractions.Fraction`).
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from enum import Enum
from functools import lru_cache
from itertools import pairwise
from typing import TypeAlias

Point = tuple[float, float]

REACH_M = 1.0e6
"""No coordinate may exceed this; the callers that take numbers from outside check it."""

TOLERANCE_M = 1.0e-6
"""A point that is closer to a boundary than this is too close to say on which side it is."""


class Side(Enum):
    INSIDE = "inside"
    OUTSIDE = "outside"
    TOO_CLOSE = "too close to say"


def side(clearance_m: float, margin_m: float = 0.0) -> Side:
    """INSIDE: for certain, and by the margin.  OUTSIDE: for certain.  TOO_CLOSE: neither."""
    if clearance_m >= margin_m + TOLERANCE_M:
        return Side.INSIDE
    if clearance_m < -TOLERANCE_M:
        return Side.OUTSIDE
    return Side.TOO_CLOSE  # NaN too


@dataclass(frozen=True, slots=True)
class Circle:
    centre_en: Point
    radius_m: float

    def clearance(self, p: Point) -> float:
        """Metres inside the circle, negative outside."""
        east, north = self.centre_en
        return self.radius_m - math.hypot(p[0] - east, p[1] - north)

    def nearest_edge(self, p: Point) -> Point:
        """The point of the circle nearest to p; to the east of its centre, where p is that."""
        away_m = _distance(p, self.centre_en)
        if away_m == 0.0:
            return (self.centre_en[0] + self.radius_m, self.centre_en[1])
        return along(self.centre_en, p, self.radius_m / away_m)

    def inner_clearance(self, a: Point, b: Point) -> float:
        """The least clearance along a-b.  A disc is convex, so it is at one of the ends."""
        return min(self.clearance(a), self.clearance(b))

    def outer_clearance(self, a: Point, b: Point) -> float:
        """Metres from the circle to a-b, outside it; negative by how deep a-b goes inside."""
        return point_segment_distance(self.centre_en, a, b) - self.radius_m


@dataclass(frozen=True, slots=True)
class Polygon:
    """A simple polygon, clockwise or not; an edge joins the last corner to the first.

    Check the corners with `polygon_fault` first: no method checks them again.
    """

    corners_en: tuple[Point, ...]
    edges: tuple[tuple[Point, Point], ...] = field(init=False, repr=False, compare=False)
    convex: bool = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "edges", _edges(self.corners_en))
        object.__setattr__(self, "convex", _is_convex(self.corners_en))

    def contains(self, p: Point) -> bool:
        """Counts crossings of the ray to the east.  The answer means nothing on the boundary."""
        inside = False
        for a, b in self.edges:
            if (a[1] > p[1]) != (b[1] > p[1]) and (_turn(a, b, p) > 0.0) == (b[1] > a[1]):
                inside = not inside
        return inside

    def clearance(self, p: Point) -> float:
        """Metres inside the polygon, negative outside."""
        return _polygon_clearance(self, p)

    def inner_clearance(self, a: Point, b: Point) -> float:
        """The least clearance along a-b, negative if any of it is outside.

        Inside a convex polygon the clearance is concave, and outside it the distance is convex, so
        the least is at one of the ends.  In any other polygon the boundary may cut a leg whose ends
        are inside: then each piece between two cuts is examined by itself.
        """
        ends = min(self.clearance(a), self.clearance(b))
        if self.convex:
            return ends
        gap = self._gap(a, b)
        return min(ends, gap, *(self.clearance(m) for m in self._middles(a, b, gap)))

    def nearest_edge(self, p: Point) -> Point:
        """The point of the boundary nearest to p."""
        return min((_foot(p, a, b) for a, b in self.edges), key=lambda foot: _distance(p, foot))

    def outer_clearance(self, a: Point, b: Point) -> float:
        """Metres from the polygon to a-b, outside it; negative if any part of a-b is inside."""
        gap = self._gap(a, b)
        return min(gap, *(-self.clearance(p) for p in (a, b, *self._middles(a, b, gap))))

    def _gap(self, a: Point, b: Point) -> float:
        return min(segment_distance(a, b, c, d) for c, d in self.edges)

    def _middles(self, a: Point, b: Point, gap: float) -> list[Point]:
        """The middle of each piece that the boundary cuts a-b into; none where it does not."""
        if gap > TOLERANCE_M:
            return []
        cuts = sorted({0.0, 1.0, *self._meetings(a, b)})
        return [along(a, b, 0.5 * (s + t)) for s, t in pairwise(cuts)]

    def _meetings(self, a: Point, b: Point) -> list[float]:
        """Parameters along a-b of its crossings with edges, and of the corners that lie on it."""
        found = []
        for c, d in self.edges:
            t = crossing(a, b, c, d)
            if t is not None:
                found.append(t)
            if point_segment_distance(c, a, b) <= TOLERANCE_M:
                found.append(_projection(c, a, b))
        return found


Shape: TypeAlias = Circle | Polygon


@lru_cache(maxsize=64)
def _polygon_clearance(polygon: Polygon, p: Point) -> float:
    """Remembered: a leg asks for each of its ends up to six times, and every edge is looked at."""
    gap = min(point_segment_distance(p, a, b) for a, b in polygon.edges)
    return gap if polygon.contains(p) else 0.0 - gap


def along(a: Point, b: Point, t: float) -> Point:
    """The point of the line a-b at parameter t: a at 0, b at 1."""
    return (a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1]))


def _foot(p: Point, a: Point, b: Point) -> Point:
    """The point of the segment a-b nearest to p."""
    return along(a, b, _projection(p, a, b))


def point_segment_distance(p: Point, a: Point, b: Point) -> float:
    """Metres from p to the nearest point of the segment a-b.

    Written out, because the gate asks it of every edge at every position.
    """
    e, n = a
    de, dn = b[0] - e, b[1] - n
    length2 = de * de + dn * dn
    if length2 == 0.0:
        return math.hypot(p[0] - e, p[1] - n)
    t = ((p[0] - e) * de + (p[1] - n) * dn) / length2
    t = 1.0 if t >= 1.0 else 0.0 if t <= 0.0 else t
    return math.hypot(p[0] - (e + t * de), p[1] - (n + t * dn))


def segment_distance(a: Point, b: Point, c: Point, d: Point) -> float:
    """Metres between the segments a-b and c-d: 0 where they cross, else measured from an end."""
    if crossing(a, b, c, d) is not None:
        return 0.0
    return min(
        point_segment_distance(a, c, d),
        point_segment_distance(b, c, d),
        point_segment_distance(c, a, b),
        point_segment_distance(d, a, b),
    )


def crossing(a: Point, b: Point, c: Point, d: Point) -> float | None:
    """The parameter along a-b at which c-d crosses it; None if it does not.

    Touching at an end is not a crossing; `segment_distance` is zero there all the same.
    """
    a_side, b_side = _turn(c, d, a), _turn(c, d, b)
    c_side, d_side = _turn(a, b, c), _turn(a, b, d)
    if (a_side > 0.0) == (b_side > 0.0) or (c_side > 0.0) == (d_side > 0.0):
        return None
    if 0.0 in (a_side, b_side, c_side, d_side):
        return None
    return a_side / (a_side - b_side)


def polygon_fault(corners: tuple[Point, ...]) -> str | None:
    """A sentence that says why these corners make no simple polygon; None if they make one.

    Raises nothing.  Two edges that are not neighbours and are closer than TOLERANCE_M count as
    meeting; an edge that runs back over its neighbour counts as lying on it.
    """
    n = len(corners)
    if n < 3:
        return f"a polygon needs at least 3 corners, this one has {n}"
    for i, p in enumerate(corners):
        if not all(math.isfinite(x) and abs(x) <= REACH_M for x in p):
            return f"corner {i + 1} is not a place within {REACH_M / 1000:.0f} km"
    edges = _edges(corners)
    for i, (a, b) in enumerate(edges):
        if _distance(a, b) <= TOLERANCE_M:
            return f"corners {i + 1} and {(i + 1) % n + 1} are the same point"
    for i, (a, b) in enumerate(edges):
        c = edges[(i + 1) % n][1]
        if min(point_segment_distance(c, a, b), point_segment_distance(a, b, c)) <= TOLERANCE_M:
            return f"the edges at corner {(i + 1) % n + 1} lie on each other"
    for i, j in _edges_side_by_side(edges):
        if segment_distance(*edges[i], *edges[j]) <= TOLERANCE_M:
            return f"edge {i + 1} and edge {j + 1} meet: the polygon intersects itself"
    return None


def _edges_side_by_side(edges: tuple[tuple[Point, Point], ...]) -> list[tuple[int, int]]:
    """The pairs of edges, not neighbours, whose boxes meet or almost do, in order.

    Sorted by their west ends, so that a polygon of a thousand corners is not looked at a million
    times.
    """
    boxes = [(min(e[0], f[0]), max(e[0], f[0]), min(e[1], f[1]), max(e[1], f[1])) for e, f in edges]
    last = len(edges) - 1
    order = sorted(range(len(edges)), key=boxes.__getitem__)
    found = []
    for place, i in enumerate(order):
        _, east, south, north = boxes[i]
        for j in order[place + 1 :]:
            other = boxes[j]
            if other[0] > east + TOLERANCE_M:
                break
            if other[2] > north + TOLERANCE_M or other[3] < south - TOLERANCE_M:
                continue
            if 1 < abs(i - j) < last:
                found.append((min(i, j), max(i, j)))
    return sorted(found)


def _edges(corners: tuple[Point, ...]) -> tuple[tuple[Point, Point], ...]:
    return tuple(zip(corners, corners[1:] + corners[:1], strict=True))


def _distance(p: Point, q: Point) -> float:
    return math.hypot(p[0] - q[0], p[1] - q[1])


def _turn(a: Point, b: Point, p: Point) -> float:
    """Twice the signed area of a, b, p: positive where p is left of a-b."""
    return (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0])


def _projection(p: Point, a: Point, b: Point) -> float:
    """The parameter in [0, 1] of the point of a-b nearest to p."""
    de, dn = b[0] - a[0], b[1] - a[1]
    length2 = de * de + dn * dn
    if length2 == 0.0:
        return 0.0
    t = ((p[0] - a[0]) * de + (p[1] - a[1]) * dn) / length2
    return min(1.0, max(0.0, t))


def _is_convex(corners: tuple[Point, ...]) -> bool:
    """All corners turn the same way, which is enough for a simple polygon."""
    n = len(corners)
    turns = [_turn(corners[i], corners[(i + 1) % n], corners[(i + 2) % n]) for i in range(n)]
    return all(t >= 0.0 for t in turns) or all(t <= 0.0 for t in turns)
