"""Random shapes and places, drawn to be hard: thin, tiny, huge, collinear, on the edge or almost.

Everything follows from the generator that is passed in.
"""

from __future__ import annotations

import math
import random
from collections.abc import Sequence

from gcs.gate.geometry import REACH_M, TOLERANCE_M, Point

SIZES_M = (0.05, 1.0, 10.0, 150.0, 2_000.0, 10_000.0)
SHIFTS_M = (0.0, 0.0, 3.0, 1_000.0, 100_000.0, 0.9 * REACH_M)
NUDGES_M = (0.0, 1e-12, 1e-9, 1e-7, TOLERANCE_M, 2.0 * TOLERANCE_M, 1e-5, 1e-3, 0.1)


def corners_of(dice: random.Random) -> tuple[Point, ...]:
    """Corners that mostly make a simple polygon."""
    size_m = dice.choice(SIZES_M)
    draw = dice.choice((_star, _star, _round, _lattice, _comb, _sliver, _doubled, _any))
    shift = [dice.choice((-1.0, 1.0)) * dice.choice(SHIFTS_M) for _ in range(2)]
    shift = [s if abs(s) + 2.0 * size_m <= REACH_M else 0.0 for s in shift]
    found = [(shift[0] + east, shift[1] + north) for east, north in draw(dice, size_m)]
    first = dice.randrange(len(found))
    found = found[first:] + found[:first]
    return tuple(found if dice.random() < 0.5 else found[::-1])


def _star(dice: random.Random, size_m: float) -> list[Point]:
    n, turn = dice.randint(3, 9), dice.uniform(0.0, math.tau)
    return [_polar(dice.uniform(0.02, 1.0) * size_m, turn + math.tau * k / n) for k in range(n)]


def _round(dice: random.Random, size_m: float) -> list[Point]:
    """Convex; now and then with very many corners."""
    n = dice.randint(40, 120) if dice.random() < 0.02 else dice.randint(3, 8)
    turns = sorted(dice.uniform(0.0, math.tau) for _ in range(n))
    return [_polar(size_m, turn) for turn in turns]


def _lattice(dice: random.Random, size_m: float) -> list[Point]:
    """Corners at whole steps: edges along the axes, corners at the same north, collinear runs."""
    step_m = size_m / 4.0
    return [
        (step_m * round(4.0 * east / size_m), step_m * round(4.0 * north / size_m))
        for east, north in _star(dice, size_m)
    ]


def _comb(dice: random.Random, size_m: float) -> list[Point]:
    """Teeth that come close to each other, or to the other side."""
    teeth, gap_m = dice.randint(1, 3), max(5e-6, size_m * 10.0 ** dice.uniform(-7.0, -1.0))
    width_m = size_m / teeth
    found = [(teeth * width_m, 0.0), (teeth * width_m, -size_m), (0.0, -size_m), (0.0, 0.0)]
    for k in range(teeth):
        found.append(((k + 0.3) * width_m, 0.0))
        found.append(((k + 0.5) * width_m, -size_m + gap_m))
        found.append(((k + 0.3) * width_m + gap_m + 0.2 * width_m, 0.0))
    return found


def _sliver(dice: random.Random, size_m: float) -> list[Point]:
    thick_m = dice.choice((3e-6, 1e-5, 1e-3, 0.1)) * dice.uniform(1.0, 3.0)
    turn, shift = dice.uniform(0.0, math.tau), dice.uniform(0.0, 1.0)
    c, s = math.cos(turn), math.sin(turn)
    flat = [(0.0, 0.0), (shift * size_m, -thick_m), (size_m, 0.0), (0.5 * size_m, thick_m)]
    return [(c * x - s * y, s * x + c * y) for x, y in flat]


def _doubled(dice: random.Random, size_m: float) -> list[Point]:
    """With corners in the middle of edges, next to it, or almost on another corner."""
    found: list[Point] = []
    star = _star(dice, size_m)
    for a, b in zip(star, [*star[1:], star[0]], strict=True):
        found.append(a)
        if dice.random() < 0.4:
            found.append(beside(dice, a, b, dice.choice((0.5, 0.25, 1e-6, 1.0 - 1e-9))))
    return found


def _any(dice: random.Random, size_m: float) -> list[Point]:
    """Mostly self-crossing."""
    return [
        (dice.uniform(-size_m, size_m), dice.uniform(-size_m, size_m))
        for _ in range(dice.randint(3, 6))
    ]


def _polar(radius_m: float, turn: float) -> Point:
    return (radius_m * math.cos(turn), radius_m * math.sin(turn))


def beside(dice: random.Random, a: Point, b: Point, t: float) -> Point:
    """A place next to the line a-b at `t`, or as near to it as floats go."""
    length_m = math.hypot(b[0] - a[0], b[1] - a[1]) or 1.0
    off = dice.choice((-1.0, 1.0)) * dice.choice(NUDGES_M) * dice.uniform(0.5, 2.0) / length_m
    east = a[0] + t * (b[0] - a[0]) - off * (b[1] - a[1])
    north = a[1] + t * (b[1] - a[1]) + off * (b[0] - a[0])
    if dice.random() < 0.2:
        east = math.nextafter(east, dice.choice((-math.inf, math.inf)))
    return (east, north)


def place_by(dice: random.Random, corners: Sequence[Point]) -> Point:
    """A place that is hard to judge by these corners: on a corner, an edge, a line through it."""
    k = dice.randrange(len(corners))
    a, b = corners[k], corners[(k + 1) % len(corners)]
    match dice.randrange(8):
        case 0:
            return a
        case 1:
            return beside(dice, a, b, dice.random())
        case 2:  # on the line through the edge, or through two corners
            return beside(dice, a, dice.choice(corners), dice.uniform(-1.0, 2.0))
        case 3:  # at a corner's north: the ray to the east goes through the corner
            return (dice.choice(corners)[0] + dice.uniform(-1.0, 1.0), a[1])
        case 4:
            return beside(dice, a, b, dice.choice((0.0, 1.0, 0.5)))
        case _:
            return place_among(dice, corners)


def place_among(dice: random.Random, corners: Sequence[Point]) -> Point:
    """Anywhere in or around."""
    (a, b, c) = (dice.choice(corners) for _ in range(3))
    s, t = dice.uniform(-0.2, 1.0), dice.uniform(-0.2, 1.0)
    return tuple(  # type: ignore[return-value]
        p + s * (q - p) + t * (r - p) for p, q, r in zip(a, b, c, strict=True)
    )


def leg_by(dice: random.Random, corners: Sequence[Point]) -> tuple[Point, Point]:
    """Two places; at times the same, at times far beyond, at times along an edge."""
    a = place_by(dice, corners)
    match dice.randrange(8):
        case 0:
            return a, a
        case 1:
            return a, beside(dice, a, place_by(dice, corners), dice.uniform(1.0, 50.0))
        case 2:
            return a, (a[0] + dice.choice(NUDGES_M), a[1] - dice.choice(NUDGES_M))
        case 3:
            k = dice.randrange(len(corners))
            p, q = corners[k], corners[(k + 1) % len(corners)]
            return beside(dice, p, q, dice.random()), beside(dice, p, q, dice.random())
        case _:
            return a, place_by(dice, corners)


def size_of(corners: Sequence[Point]) -> float:
    """The wider side of their box."""
    return max(max(p[i] for p in corners) - min(p[i] for p in corners) for i in range(2))


def margin_of(dice: random.Random, size_m: float) -> float:
    return dice.choice((0.0, 0.0, 0.3, 2.0, 0.1 * size_m * dice.random()))


def radius_of(dice: random.Random, size_m: float) -> float:
    return dice.choice((0.001, 0.02, 0.1, 0.5, 1.0)) * max(0.01, size_m * dice.random())
