"""Plane geometry in the local tangent plane, with three answers.

Points are (east, north) in metres.  The measure of everything is a *clearance*: the distance to
a boundary, positive on the allowed side and negative by how far a point is on the wrong one.

How far to trust it.  Every quantity starts from a difference of two coordinates, which floating
point gives to a relative error u = 2^-53; a product or a sum of two such adds a few u.  A
clearance among coordinates up to REACH_M is therefore wrong by less than 16 u REACH_M < 2e-9 m.
The side of an edge that a point lies on is the sign of a difference of two products whose
wrong sign needs them equal to a few u, that is, the point within a few u of the edge, where the
clearance is next to nothing.  TOLERANCE_M stands five hundred times above both: INSIDE is never
said of a point that exact arithmetic puts outside.  (The tests ask `fractions.Fraction`.)
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from enum import Enum
from itertools import pairwise
from typing import TypeAlias

Point = tuple[float, float]

REACH_M = 1.0e6
"""No coordinate may exceed this; whoever takes numbers from outside sees to it."""

TOLERANCE_M = 1.0e-6
"""Closer to a boundary than this is too close to say."""


class Side(Enum):
    INSIDE = "inside"
    OUTSIDE = "outside"
    TOO_CLOSE = "too close to say"


def side(clearance_m: float, margin_m: float = 0.0) -> Side:
    """Inside by the margin for certain, outside for certain, or neither."""
    if clearance_m >= margin_m + TOLERANCE_M:
        return Side.INSIDE
    if clearance_m < -TOLERANCE_M:
        return Side.OUTSIDE
    return Side.TOO_CLOSE  # NaN ends here as well


@dataclass(frozen=True, slots=True)
class Circle:
    centre_en: Point
    radius_m: float

    def clearance(self, p: Point) -> float:
        """Metres inside the circle, negative outside."""
        return self.radius_m - _distance(p, self.centre_en)

    def inner_clearance(self, a: Point, b: Point) -> float:
        """The least clearance along a-b; a disc is convex, so an end has it."""
        return min(self.clearance(a), self.clearance(b))

    def outer_clearance(self, a: Point, b: Point) -> float:
        """Metres that a-b keeps outside the circle, negative by how deep it goes."""
        return point_segment_distance(self.centre_en, a, b) - self.radius_m


@dataclass(frozen=True, slots=True)
class Polygon:
    """A simple polygon, either way round, the last corner joined to the first.

    Make sure of it with `polygon_fault` first; nothing here looks again.
    """

    corners_en: tuple[Point, ...]
    edges: tuple[tuple[Point, Point], ...] = field(init=False, repr=False, compare=False)
    convex: bool = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "edges", _edges(self.corners_en))
        object.__setattr__(self, "convex", _is_convex(self.corners_en))

    def contains(self, p: Point) -> bool:
        """Crossings of the ray to the east; meaningful only off the boundary."""
        inside = False
        for a, b in self.edges:
            if (a[1] > p[1]) != (b[1] > p[1]) and (_turn(a, b, p) > 0.0) == (b[1] > a[1]):
                inside = not inside
        return inside

    def clearance(self, p: Point) -> float:
        """Metres inside the polygon, negative outside."""
        gap = min(point_segment_distance(p, a, b) for a, b in self.edges)
        return gap if self.contains(p) else 0.0 - gap

    def inner_clearance(self, a: Point, b: Point) -> float:
        """The least clearance along a-b, negative if any of it is outside.

        Inside a convex polygon the clearance is concave and outside it the distance is convex,
        so an end has the least.  Otherwise the boundary may cut a leg whose ends are inside:
        then the pieces between the places where it meets the boundary are asked for themselves.
        """
        ends = min(self.clearance(a), self.clearance(b))
        if self.convex:
            return ends
        gap = self._gap(a, b)
        return min(ends, gap, *(self.clearance(m) for m in self._middles(a, b, gap)))

    def outer_clearance(self, a: Point, b: Point) -> float:
        """Metres that a-b keeps outside the polygon, negative if any of it is inside."""
        gap = self._gap(a, b)
        return min(gap, *(-self.clearance(p) for p in (a, b, *self._middles(a, b, gap))))

    def _gap(self, a: Point, b: Point) -> float:
        return min(segment_distance(a, b, c, d) for c, d in self.edges)

    def _middles(self, a: Point, b: Point, gap: float) -> list[Point]:
        """One point of every piece that the boundary cuts a-b into, if it does."""
        if gap > TOLERANCE_M:
            return []
        cuts = sorted({0.0, 1.0, *self._meetings(a, b)})
        return [along(a, b, 0.5 * (s + t)) for s, t in pairwise(cuts)]

    def _meetings(self, a: Point, b: Point) -> list[float]:
        """Parameters along a-b at which it meets the boundary: crossings, corners on it."""
        found = []
        for c, d in self.edges:
            t = crossing(a, b, c, d)
            if t is not None:
                found.append(t)
            if point_segment_distance(c, a, b) <= TOLERANCE_M:
                found.append(_projection(c, a, b))
        return found


Shape: TypeAlias = Circle | Polygon


def along(a: Point, b: Point, t: float) -> Point:
    return (a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1]))


def point_segment_distance(p: Point, a: Point, b: Point) -> float:
    return _distance(p, along(a, b, _projection(p, a, b)))


def segment_distance(a: Point, b: Point, c: Point, d: Point) -> float:
    """Between segments a-b and c-d: zero where they cross, otherwise an end is nearest."""
    if crossing(a, b, c, d) is not None:
        return 0.0
    return min(
        point_segment_distance(a, c, d),
        point_segment_distance(b, c, d),
        point_segment_distance(c, a, b),
        point_segment_distance(d, a, b),
    )


def crossing(a: Point, b: Point, c: Point, d: Point) -> float | None:
    """The parameter along a-b at which c-d properly crosses it; None if it does not.

    Touching in an end is not crossing: the distance says that.
    """
    a_side, b_side = _turn(c, d, a), _turn(c, d, b)
    c_side, d_side = _turn(a, b, c), _turn(a, b, d)
    if (a_side > 0.0) == (b_side > 0.0) or (c_side > 0.0) == (d_side > 0.0):
        return None
    if 0.0 in (a_side, b_side, c_side, d_side):
        return None
    return a_side / (a_side - b_side)


def polygon_fault(corners: tuple[Point, ...]) -> str | None:
    """Why these corners are no simple polygon, in words; None if they are one.

    Raises nothing.  Edges nearer than TOLERANCE_M to one that is not their neighbour count as
    touching, and a spike (an edge that runs back over its neighbour) as self-intersection.
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
        for j in range(i + 2, n - (i == 0)):
            if segment_distance(a, b, *edges[j]) <= TOLERANCE_M:
                return f"edge {i + 1} and edge {j + 1} meet: the polygon intersects itself"
    return None


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
    """All turns the one way; of a simple polygon that is enough."""
    n = len(corners)
    turns = [_turn(corners[i], corners[(i + 1) % n], corners[(i + 2) % n]) for i in range(n)]
    return all(t >= 0.0 for t in turns) or all(t <= 0.0 for t in turns)
