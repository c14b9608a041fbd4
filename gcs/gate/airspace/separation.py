"""How near two vehicles will come to each other, and whether that is too close.

Both are taken to fly on as they do, for as long as is looked ahead; how wrong their positions and
velocities may be makes the distance smaller.  Or, of what they are to fly, the legs are compared,
whenever each is flown.  In one horizontal frame, metres and seconds.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TypeAlias

from gcs.frames import Vec3
from gcs.gate.policy.policy import SeparationLimits

Leg: TypeAlias = tuple[Vec3, Vec3]
Legs: TypeAlias = list[Leg]


@dataclass(frozen=True, slots=True)
class Track:
    """A vehicle at `pos_ned`, moving at `v_ned`, when `age_s` have passed since it was there.

    `error_m` is how wrong its position may be, `v_error_m_s` its velocity, for each second.
    """

    pos_ned: Vec3
    v_ned: Vec3
    age_s: float = 0.0
    error_m: float = 0.0
    v_error_m_s: float = 0.0


@dataclass(frozen=True, slots=True)
class Approach:
    """The nearest that two vehicles come to: in how many seconds, and how near at the least.

    `beside_m` and `above_m` are the parts of the distance then, as they are flown; `least_m` is
    the distance less what the positions may be wrong by, and never below 0.
    """

    in_s: float
    beside_m: float
    above_m: float
    least_m: float


def closest_approach(a: Track, b: Track, within_s: float) -> Approach:
    """Of two vehicles that fly straight on for `within_s` seconds.

    What is not finite is taken for the worst: they are in one place, now.
    """
    numbers = (*a.pos_ned, *a.v_ned, *b.pos_ned, *b.v_ned, a.age_s, b.age_s, within_s)
    errors = (a.error_m, b.error_m, a.v_error_m_s, b.v_error_m_s)
    if not all(map(math.isfinite, (*numbers, *errors))):
        return Approach(0.0, 0.0, 0.0, 0.0)
    apart = _difference(_now(a), _now(b))
    relative = _difference(a.v_ned, b.v_ned)
    end_s = max(0.0, within_s)
    wrong_m = a.error_m + b.error_m + a.v_error_m_s * a.age_s + b.v_error_m_s * b.age_s
    widens_m_s = a.v_error_m_s + b.v_error_m_s
    at_s = min(
        _candidates(apart, relative, widens_m_s, end_s),
        key=lambda t: math.hypot(*_along(apart, relative, t)) - widens_m_s * t,
    )
    north_m, east_m, down_m = _along(apart, relative, at_s)
    distance_m = math.hypot(north_m, east_m, down_m)
    least_m = max(0.0, distance_m - wrong_m - widens_m_s * at_s)
    return Approach(at_s, math.hypot(north_m, east_m), abs(down_m), least_m)


def is_too_close(approach: Approach, limits: SeparationLimits, *, was: bool) -> bool:
    """Whether two vehicles come too close to each other, `was` said whether they did so far."""
    return not approach.least_m >= limits.least_m + (limits.hysteresis_m if was else 0.0)


def between_legs_m(a: Vec3, b: Vec3, c: Vec3, d: Vec3) -> float:
    """Metres between the legs a-b and c-d, each from its start to its end.

    The nearest points of the two lines, where both lie within their legs; else one of them is an
    end of a leg.  What is not finite is taken for the worst: they meet.
    """
    if not all(map(math.isfinite, (*a, *b, *c, *d))):
        return 0.0
    u, v, w = _difference(b, a), _difference(d, c), _difference(a, c)
    uu, uv, vv, uw, vw = _dot(u, u), _dot(u, v), _dot(v, v), _dot(u, w), _dot(v, w)
    across = uu * vv - uv * uv
    found = [_to_leg_m(a, c, d), _to_leg_m(b, c, d), _to_leg_m(c, a, b), _to_leg_m(d, a, b)]
    if across > 0.0:
        s, t = (uv * vw - vv * uw) / across, (uu * vw - uv * uw) / across
        if 0.0 <= s <= 1.0 and 0.0 <= t <= 1.0:
            found.append(math.dist(_along(a, u, s), _along(c, v, t)))
    return min(found)


def legs_near(ways: Sequence[Leg], others: Sequence[Leg], within_m: float) -> tuple[Legs, Legs]:
    """Of each those legs that may come nearer than that to one of the other: most of two long ways
    need not be compared leg by leg."""
    near = _in_box(ways, _box(others), within_m)
    others = _in_box(others, _box(near), within_m)
    return _in_box(near, _box(others), within_m), others


def _box(legs: Sequence[Leg]) -> tuple[Vec3, Vec3]:
    """The least and the greatest of each number; of what is not finite all there is."""
    points = [point for leg in legs for point in leg]
    if not all(math.isfinite(number) for point in points for number in point):
        return (-math.inf,) * 3, (math.inf,) * 3
    if not points:
        return (math.inf,) * 3, (-math.inf,) * 3
    norths, easts, downs = zip(*points, strict=True)
    return (min(norths), min(easts), min(downs)), (max(norths), max(easts), max(downs))


def _in_box(legs: Sequence[Leg], box: tuple[Vec3, Vec3], within_m: float) -> Legs:
    """Those that reach into the box, or nearer to it than that."""
    low, high = box
    return [
        (a, b)
        for a, b in legs
        if not any(
            max(a[n], b[n]) < low[n] - within_m or min(a[n], b[n]) > high[n] + within_m
            for n in range(3)
        )
    ]


def _to_leg_m(p: Vec3, a: Vec3, b: Vec3) -> float:
    step = _difference(b, a)
    length2 = _dot(step, step)
    t = 0.0 if length2 == 0.0 else _dot(_difference(p, a), step) / length2
    return math.dist(p, _along(a, step, min(max(t, 0.0), 1.0)))


def _candidates(apart: Vec3, relative: Vec3, widens_m_s: float, end_s: float) -> tuple[float, ...]:
    """Times at which the distance less the growing error may be least: both ends, and where its
    derivative is zero.

    With s the closing of the lines, c their least distance and v the relative speed, the distance
    at t is hypot(c, v (t - s)); its slope is the error's growth w where
    v (t - s) = c w / sqrt(v^2 - w^2).
    """
    speed_m_s = math.hypot(*relative)
    if speed_m_s <= widens_m_s or speed_m_s == 0.0:
        return 0.0, end_s
    closest_s = -_dot(apart, relative) / speed_m_s / speed_m_s
    missed_m = math.hypot(*_along(apart, relative, closest_s))
    slack = math.sqrt(speed_m_s - widens_m_s) * math.sqrt(speed_m_s + widens_m_s)
    at_s = closest_s + missed_m * widens_m_s / slack / speed_m_s
    return 0.0, min(max(at_s, 0.0), end_s), end_s


def _now(track: Track) -> Vec3:
    """Where it is by now, if it flew straight on."""
    return _along(track.pos_ned, track.v_ned, track.age_s)


def _along(start: Vec3, step: Vec3, t: float) -> Vec3:
    return (start[0] + step[0] * t, start[1] + step[1] * t, start[2] + step[2] * t)


def _difference(a: Vec3, b: Vec3) -> Vec3:
    return (a[0] - b[0], a[1] - b[1], a[2] - b[2])


def _dot(a: Vec3, b: Vec3) -> float:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
