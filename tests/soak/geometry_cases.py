"""One random question to the gate's geometry, with the exact answer beside the gate's.

The gate says a clearance, and counts as certain what is more than `TOLERANCE_M` from the limit.
An answer is *unsafe* where the gate is certain that a margin is kept, and it is not; *unjust* where
it is certain that something is on the wrong side, and it is not; *timid* where it is not certain
though there are three tolerances to spare.  None of these may happen.  "Too close to say" is what
is kept exactly, or is within the tolerance of the boundary, and is not said; it is counted.
"""

from __future__ import annotations

import math
import random
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from typing import Final, Literal

import shapely

from gcs.gate.airspace.hulls import (
    ground_track,
    hull_inside,
    hull_outside,
    ring_inside,
    ring_outside,
)
from gcs.gate.geometry import TOLERANCE_M, Circle, Point, Polygon, Shape, along, polygon_fault
from tests.soak import exact, shapes
from tests.soak.exact import Grid

SPARE_M: Final = 3.0 * TOLERANCE_M
SHAPELY_ERROR_M: Final = 1e-7
"""Shapely's distances among coordinates of 1000 km."""

Found = Literal[
    "certain", "within the margin", "too close to say", "no", "unsafe", "unjust", "timid"
]
BAD: Final = frozenset({"unsafe", "unjust", "timid"})


Exactly = Callable[[Grid, float], bool]
"""Does it keep a margin?  Answered on a grid that has all numbers of the case."""


@dataclass(frozen=True, slots=True)
class Question:
    """`clear_m` is the gate's answer, `exactly` the exact one.

    `agrees` is shapely's: does what the gate is certain of hold there as well?  `numbers` are all
    that the question is made of.
    """

    what: str
    shape: Shape
    about: tuple[object, ...]
    numbers: tuple[float, ...]
    clear_m: float
    exactly: Exactly
    agrees: Callable[[float], bool]

    def found(self, margin_m: float) -> Found:
        grid = Grid.of((*self.numbers, margin_m, margin_m + SPARE_M))
        if self.clear_m >= margin_m + TOLERANCE_M:
            kept = self.exactly(grid, margin_m) and self.agrees(margin_m)
            return "certain" if kept else "unsafe"
        if self.clear_m < -TOLERANCE_M:
            return "unjust" if self.exactly(grid, 0.0) else "no"
        if self.exactly(grid, margin_m + SPARE_M):
            return "timid"
        close = self.clear_m <= TOLERANCE_M or self.exactly(grid, margin_m)
        return "too close to say" if close else "within the margin"

    def margin(self, dice: random.Random) -> float:
        """A margin to ask for; at times the largest that the gate is certain of."""
        most_m = self.clear_m - TOLERANCE_M
        if most_m > 0.0 and dice.random() < 0.5:
            return most_m
        return shapes.margin_of(dice, abs(self.clear_m))


@dataclass(slots=True)
class Tally:
    """What was found, by question; and the first answers that may not be."""

    found: Counter[tuple[str, Found]] = field(default_factory=Counter)
    faults: Counter[str] = field(default_factory=Counter)
    bad: list[str] = field(default_factory=list)

    @property
    def cases(self) -> int:
        return sum(self.found.values()) + sum(self.faults.values())

    def share(self, found: Found) -> float:
        asked = sum(self.found.values())
        return sum(n for (_, kind), n in self.found.items() if kind == found) / max(1, asked)

    def told(self) -> str:
        questions = sorted({what for what, _ in self.found})
        lines = [f"{self.cases} cases; {self.share('too close to say'):.1%} too close to say"]
        for what in questions:
            counts = {kind: n for (asked, kind), n in sorted(self.found.items()) if asked == what}
            lines.append(f"  {what}: " + ", ".join(f"{kind} {n}" for kind, n in counts.items()))
        lines.append("  polygons: " + ", ".join(f"{k} {n}" for k, n in self.faults.items()))
        return "\n".join([*lines, *self.bad[:5]])


def run(seed: int, cases: int) -> Tally:
    """So many random cases; everything follows from the seed."""
    tally = Tally()
    dice = random.Random(seed)
    while tally.cases < cases:
        corners = shapes.corners_of(dice)
        polygon = _polygon(corners, tally)
        for question in () if polygon is None else _questions(dice, polygon):
            margin_m = question.margin(dice)
            found = question.found(margin_m)
            tally.found[question.what, found] += 1
            if found in BAD:
                tally.bad.append(f"seed {seed}: {found} by {margin_m}: {question}")
    return tally


def _polygon(corners: tuple[Point, ...], tally: Tally) -> Polygon | None:
    """The polygon, if the gate takes it; what it takes must be one."""
    fault = polygon_fault(corners)
    ring = Grid.of(x for corner in corners for x in corner).ring(corners)
    simple = exact.is_simple(ring)
    if fault is not None:
        tally.faults["refused" if not simple else "refused, as too close to say"] += 1
        return None
    if not simple or not shapely.Polygon(corners).is_valid:
        tally.faults["unsafe"] += 1
        tally.bad.append(f"taken, and it is none: {corners}")
        return None
    tally.faults["taken"] += 1
    return Polygon(corners)


def _questions(dice: random.Random, polygon: Polygon) -> Iterator[Question]:
    yield _leg(dice, polygon, dice.random() < 0.3)
    yield _leg(dice, polygon, False)
    yield _hull(dice, polygon)
    yield _loiter(dice, polygon)
    yield _about_a_disc(dice, polygon.corners_en)


def _leg(dice: random.Random, polygon: Polygon, point: bool) -> Question:
    corners = polygon.corners_en
    a, b = shapes.leg_by(dice, corners)
    b = a if point else b
    theirs = shapely.Polygon(corners)
    line = shapely.LineString([a, b]) if a != b else shapely.Point(a)
    inside = _mostly(dice, polygon, a)
    what = "point" if point else "leg"
    if inside:
        clear_m = polygon.clearance(a) if point else polygon.inner_clearance(a, b)
        keeps, what = exact.leg_in_polygon, f"{what} in polygon"
    else:
        clear_m = -polygon.clearance(a) if point else polygon.outer_clearance(a, b)
        keeps, what = exact.leg_outside_polygon, f"{what} outside polygon"
    return Question(
        what,
        polygon,
        (a, b),
        _numbers(*corners, a, b),
        clear_m,
        lambda g, m: keeps(g.ring(corners), g.spot(a), g.spot(b), g.whole(m)),
        lambda m: _shapely_agrees(theirs, line, inside, m),
    )


def _hull(dice: random.Random, polygon: Polygon) -> Question:
    corners = polygon.corners_en
    places = _places(dice, corners)
    theirs, region = shapely.Polygon(corners), shapely.MultiPoint(places).convex_hull
    track = ground_track(places)
    inside = _mostly(dice, polygon, places[0])
    keeps = exact.hull_in_polygon if inside else exact.hull_outside_polygon
    return Question(
        "hull in polygon" if inside else "hull outside polygon",
        polygon,
        tuple(places),
        _numbers(*corners, *places),
        (hull_inside if inside else hull_outside)(polygon, track),
        lambda g, m: keeps(g.ring(corners), exact.hull(g.ring(places)), g.whole(m)),
        lambda m: _shapely_agrees(theirs, region, inside, m),
    )


def _places(dice: random.Random, corners: Sequence[Point]) -> list[Point]:
    """Of a hull: anywhere, or close together."""
    first = shapes.place_by(dice, corners)
    count = dice.randint(0, 4)
    if dice.random() < 0.4:
        return [first, *(shapes.place_by(dice, corners) for _ in range(count))]
    reach = dice.choice((0.01, 0.1, 0.5))
    others = (shapes.place_by(dice, corners) for _ in range(count))
    return [first, *(along(first, other, reach * dice.random()) for other in others)]


def _loiter(dice: random.Random, polygon: Polygon) -> Question:
    corners = polygon.corners_en
    centre = shapes.place_by(dice, corners)
    radius_m = shapes.radius_of(dice, shapes.size_of(corners))
    inside = _mostly(dice, polygon, (centre[0] + radius_m, centre[1]))
    keeps = exact.circle_line_in_polygon if inside else exact.circle_line_outside_polygon
    return Question(
        "loiter circle in polygon" if inside else "loiter circle outside polygon",
        polygon,
        (centre, radius_m),
        (*_numbers(*corners, centre), radius_m),
        (ring_inside if inside else ring_outside)(polygon, centre, radius_m),
        lambda g, m: keeps(g.ring(corners), g.spot(centre), g.whole(radius_m), g.whole(m)),
        _no_opinion,
    )


def _about_a_disc(dice: random.Random, corners: tuple[Point, ...]) -> Question:
    """A circle as a zone, and any of the above beside it, with places on its line and near it."""
    size_m = shapes.size_of(corners)
    centre, r_m = shapes.place_by(dice, corners), shapes.radius_of(dice, size_m)
    disc = Circle(centre, r_m)
    line_m = dice.choice((r_m, r_m + dice.choice(shapes.NUDGES_M), 0.2 * r_m, 0.5 * size_m))
    most = dice.choice((0.9, 1.0, 3.0))
    places = [_place_by_disc(dice, centre, r_m, most) for _ in range(3)]
    a, b, _ = places
    track = ground_track(places)
    asked: tuple[tuple[str, float, Exactly], ...] = (
        (
            "leg in disc",
            disc.inner_clearance(a, b),
            lambda g, m: exact.points_in_disc(
                g.spot(centre), g.whole(r_m), g.ring((a, b)), g.whole(m)
            ),
        ),
        (
            "leg outside disc",
            disc.outer_clearance(a, b),
            lambda g, m: exact.leg_outside_disc(
                g.spot(centre), g.whole(r_m), g.spot(a), g.spot(b), g.whole(m)
            ),
        ),
        (
            "hull in disc",
            hull_inside(disc, track),
            lambda g, m: exact.points_in_disc(
                g.spot(centre), g.whole(r_m), g.ring(places), g.whole(m)
            ),
        ),
        (
            "hull outside disc",
            hull_outside(disc, track),
            lambda g, m: exact.hull_outside_disc(
                g.spot(centre), g.whole(r_m), exact.hull(g.ring(places)), g.whole(m)
            ),
        ),
        (
            "loiter circle in disc",
            ring_inside(disc, a, line_m),
            lambda g, m: exact.circle_line_in_disc(
                g.spot(centre), g.whole(r_m), g.spot(a), g.whole(line_m), g.whole(m)
            ),
        ),
        (
            "loiter circle outside disc",
            ring_outside(disc, a, line_m),
            lambda g, m: exact.circle_line_outside_disc(
                g.spot(centre), g.whole(r_m), g.spot(a), g.whole(line_m), g.whole(m)
            ),
        ),
    )
    what, clear_m, exactly = dice.choice(asked)
    numbers = (*_numbers(*places, centre), r_m, line_m)
    return Question(what, disc, (*places, line_m), numbers, clear_m, exactly, _no_opinion)


def _place_by_disc(dice: random.Random, centre: Point, r_m: float, most: float) -> Point:
    """On the disc's line, or as far from its centre as `most` of its radius."""
    reach_m = r_m * (min(1.0, most) if dice.random() < 0.3 else most * dice.random())
    bearing = dice.choice((0.0, 0.5 * math.pi, dice.uniform(0.0, math.tau)))
    end = (centre[0] + reach_m * math.cos(bearing), centre[1] + reach_m * math.sin(bearing))
    return shapes.beside(dice, end, centre, 0.0)


def _mostly(dice: random.Random, polygon: Polygon, place: Point) -> bool:
    """Ask whether it is inside?  Mostly of what is, so that the answer is not mostly no."""
    return polygon.contains(place) == (dice.random() < 0.9)


def _shapely_agrees(
    theirs: shapely.Polygon, what: shapely.Geometry, inside: bool, margin_m: float
) -> bool:
    apart = theirs.exterior.distance(what) >= margin_m - SHAPELY_ERROR_M
    return bool(apart and theirs.contains(what) == inside)


def _no_opinion(_: float) -> bool:
    """Shapely's circles are polygons."""
    return True


def _numbers(*places: Point) -> tuple[float, ...]:
    return tuple(x for place in places for x in place)
