"""Random motions beside zones with floors and ceilings: what the fence's judge clears is clear.

The judge puts the plane geometry together with heights and with the policy's margins.  Here each
point of what it cleared is held against the definition, in fractions: of an inclusion zone it is
inside, below the ceiling and above the floor, of an exclusion zone beside, above *or* below.
A motion that starts nearer than the margin comes no nearer than it starts.
"""

from __future__ import annotations

import math
import random
from collections import Counter
from collections.abc import Sequence
from fractions import Fraction

from msgspec.structs import replace

from gcs.frames import Vec3, ned_from_enu
from gcs.gate.airspace.fence_check import FenceCheck
from gcs.gate.airspace.zones import Zone
from gcs.gate.geometry import TOLERANCE_M, Circle, Point, Polygon, polygon_fault
from gcs.gate.policy.parse import DEFAULT
from tests.soak import exact, shapes
from tests.soak.exact import Spot

Place = tuple[Fraction, Fraction, Fraction]
"""East, north, up."""

Counts = Counter[tuple[str, str]]


def run(seed: int, cases: int) -> Counts:
    """So many random cases: how many of each question were cleared and refused.

    Raises AssertionError for what is cleared and not clear.
    """
    dice, counts = random.Random(seed), Counts()
    while sum(counts.values()) < cases:
        corners = shapes.corners_of(dice)
        if len(corners) > 12 or polygon_fault(corners) is not None:
            continue
        for _ in range(4):
            what, cleared = _case(dice, corners, f"seed {seed}")
            counts[what, "cleared" if cleared else "refused"] += 1
    return counts


def _case(dice: random.Random, corners: tuple[Point, ...], seed: str) -> tuple[str, bool]:
    zone = _zone(dice, corners)
    margin_h_m, margin_v_m = (
        shapes.margin_of(dice, shapes.size_of(corners)),
        dice.choice((0.0, 0.3)),
    )
    judge = FenceCheck(
        (zone,),
        replace(
            DEFAULT,
            margin_h_m=margin_h_m,
            margin_v_m=margin_v_m,
            brake_slack_h_m=min(1.5, margin_h_m),
            brake_slack_v_m=min(0.3, margin_v_m),
        ),
        DEFAULT.braking["px4"],
    )
    what = dice.choice(("point", "leg", "leg", "hull", "stop"))
    count = {"point": 1, "leg": 2, "stop": 2, "hull": dice.randint(2, 4)}[what]
    first = _place(dice, corners, zone)
    places = [first, *(_place(dice, corners, zone) for _ in range(count - 1))]
    if dice.random() < 0.5:
        reach = dice.choice((0.01, 0.1, 0.5))
        places = [first, *(_part(first, place, reach) for place in places[1:])]
    ned = [ned_from_enu(place) for place in places]
    match what:
        case "point":
            cleared = judge.point("it", ned[0], floor_applies=True) is None
        case "leg":
            cleared = judge.leg("it", ned[0], ned[1], judge.margins, floor_applies=True) is None
        case "hull":
            cleared = judge.hull("it", ned[:1], ned[1:], floor_applies=True) is None
        case _:
            cleared = judge.broken_stop(ned[0], ned[1], floor_applies=True) is None
    if cleared:
        told = f"{seed}: {what} of {places} beside {zone}, margins {margin_h_m}, {margin_v_m}"
        _check(zone, places, margin_h_m, margin_v_m, what, told)
    return what, cleared


def _check(
    zone: Zone, places: list[Vec3], margin_h_m: float, margin_v_m: float, what: str, told: str
) -> None:
    """A point keeps the margins, a stop stays in; a leg or hull keeps what its start keeps of the
    margins."""
    exactly = [(Fraction(east), Fraction(north), Fraction(up)) for east, north, up in places]
    near_h_m, near_v_m = _clearances(zone, places[0])
    least_m = min(near_h_m, near_v_m) - 2.0 * TOLERANCE_M
    if what == "stop":
        if least_m > 0.0:
            assert keeps(zone, exactly, Fraction(0), Fraction(0)), told
        return
    if what != "point":
        margin_h_m = max(0.0, min(margin_h_m, near_h_m - 2.0 * TOLERANCE_M))
        margin_v_m = max(0.0, min(margin_v_m, near_v_m - 2.0 * TOLERANCE_M))
    assert keeps(zone, exactly, Fraction(margin_h_m), Fraction(margin_v_m)), told


def _clearances(zone: Zone, place: Vec3) -> tuple[float, float]:
    """Of a start, beside and in height.  Of an exclusion zone the best of its sides is both."""
    east, north, up = place
    beside_m = zone.shape.clearance((east, north))
    if zone.inclusion:
        return beside_m, min(up - zone.floor_up_m, zone.ceiling_up_m - up)
    best_m = max(-beside_m, zone.floor_up_m - up, up - zone.ceiling_up_m)
    return best_m, best_m


def keeps(zone: Zone, places: Sequence[Place], h: Fraction, v: Fraction) -> bool:
    """Does all that is above or below the convex hull of the places on the ground, from the lowest
    of them to the highest, keep the margins, exactly?"""
    low = -math.inf if math.isinf(zone.floor_up_m) else Fraction(zone.floor_up_m)
    high = math.inf if math.isinf(zone.ceiling_up_m) else Fraction(zone.ceiling_up_m)
    ups = [up for *_, up in places]
    track = [(east, north) for east, north, _ in places]
    if zone.inclusion:
        stacked = min(ups) >= low + v and max(ups) <= high - v
        return stacked and _beside(zone, track, h)
    return max(ups) <= low - v or min(ups) >= high + v or _beside(zone, track, h)


def _beside(zone: Zone, places: Sequence[tuple[Fraction, Fraction]], m: Fraction) -> bool:
    shape = zone.shape
    is_disc = isinstance(shape, Circle)
    own = [shape.centre_en] if isinstance(shape, Circle) else list(shape.corners_en)
    radius = Fraction(shape.radius_m) if isinstance(shape, Circle) else Fraction(0)
    theirs = [(Fraction(east), Fraction(north)) for east, north in own]
    scale = math.lcm(*(x.denominator for p in (*places, *theirs, (radius, m)) for x in p))

    def spot(p: tuple[Fraction, Fraction]) -> Spot:
        return (int(p[0] * scale), int(p[1] * scale))

    corners = exact.hull(spot(place) for place in places)
    ring, whole_m = [spot(corner) for corner in theirs], int(m * scale)
    if is_disc:
        whole_radius = int(radius * scale)
        if zone.inclusion:
            return exact.points_in_disc(ring[0], whole_radius, corners, whole_m)
        return exact.hull_outside_disc(ring[0], whole_radius, corners, whole_m)
    if zone.inclusion:
        return exact.hull_in_polygon(ring, corners, whole_m)
    return exact.hull_outside_polygon(ring, corners, whole_m)


# ------------------------------------------------------------------------------- drawing


def _zone(dice: random.Random, corners: tuple[Point, ...]) -> Zone:
    floor_m = dice.choice((-math.inf, 0.0, 10.0))
    ceiling_m = dice.choice((math.inf, 20.0, 50.0))
    shape: Polygon | Circle = Polygon(corners)
    if dice.random() < 0.3:
        size_m = shapes.size_of(corners)
        shape = Circle(shapes.place_by(dice, corners), shapes.radius_of(dice, size_m))
    return Zone("zone", dice.random() < 0.5, shape, floor_m, ceiling_m)


def _place(dice: random.Random, corners: tuple[Point, ...], zone: Zone) -> Vec3:
    draw = shapes.place_by if dice.random() < 0.5 else shapes.place_among
    east, north = draw(dice, corners)
    levels = [x for x in (zone.floor_up_m, zone.ceiling_up_m, 15.0, 5.0) if math.isfinite(x)]
    up = dice.choice(levels) + dice.choice((-1.0, 1.0)) * dice.choice(shapes.NUDGES_M)
    return (east, north, dice.choice((up, dice.uniform(-5.0, 60.0))))


def _part(a: Vec3, b: Vec3, reach: float) -> Vec3:
    east, north, up = (p + reach * (q - p) for p, q in zip(a, b, strict=True))
    return (east, north, up)
