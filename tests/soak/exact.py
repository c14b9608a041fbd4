"""The questions of the gate's geometry answered exactly: whole numbers, no rounding, no tolerance.

Every float is a whole number over a power of two.  `Grid` multiplies all floats of a case by one
such power, so that they become integers; Python's integers have any size.  The functions below
answer for integers, from the definitions, and share no code with `gcs.gate.geometry`.

"Keeps m" means: nothing of it is as near as m, or nearer, to the boundary, and it is on the right
side of it.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass

Spot = tuple[int, int]
Ring = Sequence[Spot]
"""Corners in order; the last is joined to the first."""


@dataclass(frozen=True, slots=True)
class Grid:
    """The common denominator of a case."""

    scale: int

    @staticmethod
    def of(numbers: Iterable[float]) -> Grid:
        return Grid(max(number.as_integer_ratio()[1] for number in numbers))

    def whole(self, number: float) -> int:
        above, below = number.as_integer_ratio()
        return above * (self.scale // below)

    def spot(self, point: tuple[float, float]) -> Spot:
        return (self.whole(point[0]), self.whole(point[1]))

    def ring(self, points: Iterable[tuple[float, float]]) -> list[Spot]:
        return [self.spot(point) for point in points]


def turn(a: Spot, b: Spot, p: Spot) -> int:
    """Positive where p is left of a-b, zero where it is on that line."""
    return (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0])


def distance2(p: Spot, q: Spot) -> int:
    return (p[0] - q[0]) ** 2 + (p[1] - q[1]) ** 2


def near(p: Spot, a: Spot, b: Spot, m: int) -> bool:
    """Is p as near as m to the segment a-b, or nearer?"""
    de, dn = b[0] - a[0], b[1] - a[1]
    length2 = de * de + dn * dn
    t = (p[0] - a[0]) * de + (p[1] - a[1]) * dn
    if t <= 0:
        return distance2(p, a) <= m * m
    if t >= length2:
        return distance2(p, b) <= m * m
    return turn(a, b, p) ** 2 <= m * m * length2


def cross(a: Spot, b: Spot, c: Spot, d: Spot) -> bool:
    """Do the segments cross, each with its ends on either side of the other?"""
    one, other = turn(c, d, a), turn(c, d, b)
    if (one > 0) == (other > 0) or one == 0 or other == 0:
        return False
    one, other = turn(a, b, c), turn(a, b, d)
    return (one > 0) != (other > 0) and one != 0 and other != 0


def segments_near(a: Spot, b: Spot, c: Spot, d: Spot, m: int) -> bool:
    """Do two segments meet, or come as near as m?"""
    return (
        cross(a, b, c, d)
        or near(a, c, d, m)
        or near(b, c, d, m)
        or near(c, a, b, m)
        or near(d, a, b, m)
    )


def edges(ring: Ring) -> Iterator[tuple[Spot, Spot]]:
    return zip(ring, [*ring[1:], ring[0]], strict=True)


def inside(ring: Ring, p: Spot) -> bool:
    """Is a point that is not on the boundary inside?  Crossings of its ray to the east."""
    within = False
    for a, b in edges(ring):
        if (a[1] > p[1]) != (b[1] > p[1]) and (turn(a, b, p) > 0) == (b[1] > a[1]):
            within = not within
    return within


def is_simple(ring: Ring) -> bool:
    """Do no two edges meet but neighbours, and these only at the corner that they share?"""
    pairs = list(edges(ring))
    n = len(pairs)
    if n < 3 or any(a == b for a, b in pairs):
        return False
    for i, (a, b) in enumerate(pairs):
        c = pairs[(i + 1) % n][1]
        if near(c, a, b, 0) or near(a, b, c, 0):
            return False
        if any(segments_near(a, b, *pairs[j], 0) for j in range(i + 2, n - (i == 0))):
            return False
    return True


# --------------------------------------------------------------------------- polygons


def leg_in_polygon(ring: Ring, a: Spot, b: Spot, m: int) -> bool:
    """Does the leg a-b keep m inside the polygon?  A point is a leg without length."""
    return inside(ring, a) and not any(segments_near(a, b, *edge, m) for edge in edges(ring))


def leg_outside_polygon(ring: Ring, a: Spot, b: Spot, m: int) -> bool:
    return not inside(ring, a) and not any(segments_near(a, b, *edge, m) for edge in edges(ring))


def hull(points: Iterable[Spot]) -> list[Spot]:
    """The corners of the convex hull, anticlockwise; one or two where it has no area."""
    ordered = sorted(set(points))
    if len(ordered) <= 2:
        return ordered
    chains = []
    for way in (ordered, ordered[::-1]):
        chain: list[Spot] = []
        for point in way:
            while len(chain) >= 2 and turn(chain[-2], chain[-1], point) <= 0:
                chain.pop()
            chain.append(point)
        chains.append(chain[:-1])
    return chains[0] + chains[1]


def in_hull(corners: Ring, p: Spot) -> bool:
    return len(corners) > 2 and all(turn(a, b, p) >= 0 for a, b in edges(corners))


def _hull_near(corners: Ring, a: Spot, b: Spot, m: int) -> bool:
    return in_hull(corners, a) or any(segments_near(a, b, *e, m) for e in edges(corners))


def hull_in_polygon(ring: Ring, corners: Ring, m: int) -> bool:
    """Does all of the hull with these corners keep m inside the polygon?"""
    return inside(ring, corners[0]) and not any(_hull_near(corners, *e, m) for e in edges(ring))


def hull_outside_polygon(ring: Ring, corners: Ring, m: int) -> bool:
    near_any = any(_hull_near(corners, *edge, m) for edge in edges(ring))
    return not near_any and not inside(ring, corners[0])


def _line_clear(ring: Ring, centre: Spot, radius: int, m: int) -> bool:
    """Is the line of a circle farther than m from every edge?  Each is within it or beyond it."""
    for a, b in edges(ring):
        beyond = not near(centre, a, b, radius + m)
        farthest2 = max(distance2(centre, a), distance2(centre, b))
        within = radius > m and farthest2 < (radius - m) ** 2
        if not (beyond or within):
            return False
    return True


def circle_line_in_polygon(ring: Ring, centre: Spot, radius: int, m: int) -> bool:
    east_end = (centre[0] + radius, centre[1])
    return _line_clear(ring, centre, radius, m) and inside(ring, east_end)


def circle_line_outside_polygon(ring: Ring, centre: Spot, radius: int, m: int) -> bool:
    east_end = (centre[0] + radius, centre[1])
    return _line_clear(ring, centre, radius, m) and not inside(ring, east_end)


# ---------------------------------------------------------------------------- circles


def points_in_disc(centre: Spot, radius: int, points: Iterable[Spot], m: int) -> bool:
    """Do all points, and so their hull, keep m inside the disc?"""
    least = radius - m
    return least > 0 and all(distance2(p, centre) < least * least for p in points)


def leg_outside_disc(centre: Spot, radius: int, a: Spot, b: Spot, m: int) -> bool:
    return not near(centre, a, b, radius + m)


def hull_outside_disc(centre: Spot, radius: int, corners: Ring, m: int) -> bool:
    if in_hull(corners, centre):
        return False
    return not any(near(centre, *edge, radius + m) for edge in edges(corners))


def circle_line_in_disc(centre: Spot, radius: int, at: Spot, line_radius: int, m: int) -> bool:
    room = radius - m - line_radius
    return room > 0 and distance2(centre, at) < room * room


def circle_line_outside_disc(centre: Spot, radius: int, at: Spot, line_radius: int, m: int) -> bool:
    apart2 = distance2(centre, at)
    round_it = line_radius - radius - m
    beside2 = (line_radius + radius + m) ** 2
    return apart2 > beside2 or (round_it > 0 and apart2 < round_it * round_it)
