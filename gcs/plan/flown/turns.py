"""Where a vehicle is when it turns from a waypoint to the next.

It does not fly to the waypoint: it turns as soon as it is near enough, or a little past it
(`overshoot.py`).  So from a set of places where it may begin, every place on its way lies in the
hull of that set and the waypoint; the set where it turns next is the waypoint itself, the places
where it enters the sphere of acceptance, and what is past the waypoint.

PX4: mission_block.cpp, is_mission_item_reached_or_completed: horizontally within NAV_WAYPOINT's
param 2 or NAV_ACC_RAD, vertically within NAV_MC_ALT_RAD; vehicle-sim takes the distance in space.
Whichever lets the vehicle turn earlier counts here.

ArduCopter: SCurve::advance_target_along_track lets the end of a leg and the beginning of the next
overlap, such that the apex of the turn is within WPNAV_RADIUS of the waypoint.  The blended path
lies in the triangle of the waypoint and the places on both legs where the overlap begins and ends.
Half the turn's time is at least a sixth of its way (a speed that rises and falls with limited
jerk), so a turn by the angle t with its apex r away begins no earlier than 3 r / sin(t / 2).
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from functools import lru_cache

from gcs.frames import Vec3

WIDEST_RAD = math.radians(120.0)
"""From places that are seen from the waypoint under a wider angle it may turn all round it."""
_OVERLAP = 3.0
_MOST_PLACES = 8
_DIGITS = 2
_EIGHT = tuple((math.cos(0.25 * math.pi * n), math.sin(0.25 * math.pi * n)) for n in range(8))


def turning_places(
    starts: tuple[Vec3, ...], to_ned: Vec3, accept_m: float, accept_up_m: float | None
) -> tuple[Vec3, ...]:
    """Where a vehicle that flies from `starts` to `to_ned` may be when it turns, beside `to_ned`.

    Rounded to centimetres, so that a loop comes back to what it was before.
    """
    if accept_m <= 0.0 and not accept_up_m:
        return ()
    reaches = [_turn_m(start, to_ned, accept_m, accept_up_m) for start in starts]
    angle_rad = _widest_angle(starts, to_ned)
    if angle_rad > WIDEST_RAD:
        return _box_about(starts, to_ned, max(reaches))
    wider = 1.0 / math.cos(0.5 * angle_rad)
    found = [
        _towards(start, to_ned, wider * reach_m)
        for start, reach_m in zip(starts, reaches, strict=True)
    ]
    return fewer(tuple(found), without=to_ned)


def _box_about(starts: tuple[Vec3, ...], to_ned: Vec3, reach_m: float) -> tuple[Vec3, ...]:
    """A square round the circle where it may turn, at the heights that it may have there."""
    heights = [_towards(start, to_ned, reach_m)[2] for start in starts]
    north, east, down = to_ned
    return fewer(
        tuple(
            (north + dn * reach_m, east + de * reach_m, height)
            for dn in (-1.0, 1.0)
            for de in (-1.0, 1.0)
            for height in (min(*heights, down), max(*heights, down))
        )
    )


def fewer(places: tuple[Vec3, ...], without: Vec3 | None = None) -> tuple[Vec3, ...]:
    """Places to the centimetre, each once; where there are many, an octagon around them, at the
    lowest and at the highest of them."""
    rounded = dict.fromkeys(_rounded(place) for place in places)
    if without is not None:
        rounded.pop(_rounded(without), None)
    if len(rounded) <= _MOST_PLACES:
        return tuple(sorted(rounded))
    downs = [down for _, _, down in rounded]
    found = (
        _rounded((north, east, down))
        for north, east in _octagon([(north, east) for north, east, _ in rounded])
        for down in (min(downs), max(downs))
    )
    return tuple(sorted(dict.fromkeys(found)))


def _octagon(points: list[tuple[float, float]]) -> Iterator[tuple[float, float]]:
    """The corners of the smallest octagon, of eight given directions, about the points."""
    reaches = [max(x * c + y * s for x, y in points) for c, s in _EIGHT]
    for number, (c, s) in enumerate(_EIGHT):
        d, t = _EIGHT[(number + 1) % 8]
        reach, next_reach = reaches[number], reaches[(number + 1) % 8]
        cross = c * t - s * d
        yield (reach * t - next_reach * s) / cross, (next_reach * c - reach * d) / cross


def blend(before_ned: Vec3, at_ned: Vec3, to_ned: Vec3, accept_m: float) -> tuple[Vec3, Vec3]:
    """Where ArduCopter's turn at `at_ned` begins and ends, at the earliest and the latest."""
    back_m, on_m = math.dist(before_ned, at_ned), math.dist(at_ned, to_ned)
    turn_rad = math.pi - _angle(before_ned, to_ned, at_ned)
    half_sine = math.sin(0.5 * turn_rad)
    most_m = min(back_m, on_m)
    reach_m = (
        most_m if half_sine * most_m <= _OVERLAP * accept_m else _OVERLAP * accept_m / half_sine
    )
    return _towards(before_ned, at_ned, reach_m), _towards(to_ned, at_ned, reach_m)


def _turn_m(start: Vec3, to_ned: Vec3, accept_m: float, accept_up_m: float | None) -> float:
    """How far from `to_ned` the turn may begin, on the straight line to it."""
    if accept_up_m is None:
        return accept_m
    whole_m = math.dist(start, to_ned)
    flat_m, high_m = math.dist(start[:2], to_ned[:2]), abs(start[2] - to_ned[2])
    by_flat_m = whole_m if flat_m <= accept_m else accept_m * whole_m / flat_m
    by_height_m = whole_m if high_m <= accept_up_m else accept_up_m * whole_m / high_m
    return max(min(accept_m, whole_m), min(by_flat_m, by_height_m))


def _towards(start: Vec3, to_ned: Vec3, left_m: float) -> Vec3:
    """On the way from `start` to `to_ned`, where `left_m` are left; `start` if that is nearer."""
    whole_m = math.dist(start, to_ned)
    if whole_m <= left_m:
        return start
    share = left_m / whole_m
    n, e, d = (b + share * (a - b) for a, b in zip(start, to_ned, strict=True))
    return (n, e, d)


@lru_cache(maxsize=4)
def _widest_angle(places: tuple[Vec3, ...], seen_from: Vec3) -> float:
    return max(
        (
            _angle(a, b, seen_from)
            for number, a in enumerate(places)
            for b in places[number + 1 :]
            if a != seen_from and b != seen_from
        ),
        default=0.0,
    )


def _angle(a: Vec3, b: Vec3, seen_from: Vec3) -> float:
    u = [x - y for x, y in zip(a, seen_from, strict=True)]
    v = [x - y for x, y in zip(b, seen_from, strict=True)]
    size = math.hypot(*u) * math.hypot(*v)
    if size == 0.0:
        return 0.0
    cosine = sum(x * y for x, y in zip(u, v, strict=True)) / size
    return math.acos(max(-1.0, min(1.0, cosine)))


def _rounded(place: Vec3) -> Vec3:
    n, e, d = (round(x, _DIGITS) for x in place)
    return (n, e, d)
