"""The way onto a loiter circle and off it."""

from __future__ import annotations

import math

from gcs.frames import Vec3
from gcs.plan.flown.overshoot import ahead

_CORNERS = 8
_GAINS_RAD = 1.0
"""Of the ring.  The goal goes round it from the first moment at the speed v, v^2 = a r / 2
(`Motion.circling_m_s`); a vehicle at rest is v^2 / 2a behind it when it has that speed, and has
caught up after twice the way that it takes for that: 4 v^2 / 2a, which is r."""
_ARC_STEP_RAD = 0.5
_SHORT_RAD = 0.53
"""It leaves the ring so much before its turns are whole: 1.3 times the worst of 15 recorded circles
of 4 to 20 m (0.41 rad: an ArduCopter counts the goal's turns, and the goal is ahead of it).  That
ArduCopter flew one turn where 1.5 were asked for, and clockwise where the radius was negative."""


def entries(places: tuple[Vec3, ...], centre_ned: Vec3, radius_m: float) -> tuple[Vec3, ...]:
    """The nearest point of the circle to each place, as high as the circle."""
    return tuple(_on_circle(centre_ned, radius_m, _bearing(p, centre_ned)) for p in places)


def way_on(
    places: tuple[Vec3, ...], begun: tuple[Vec3, ...], centre_ned: Vec3, radius_m: float
) -> tuple[Vec3, ...]:
    """Points whose hull, with `places`, holds every way from them onto the circle."""
    first = _bearing(places[0], centre_ned)
    turned = [math.remainder(_bearing(p, centre_ned) - first, 2.0 * math.pi) for p in places]
    low, high = min(turned), max(turned)
    if high - low > 0.5 * math.pi:
        return _around(centre_ned, radius_m)
    # The arc between two entries lies in the triangle of both and the meeting of their tangents.
    top = _on_circle(
        centre_ned, radius_m / math.cos(0.5 * (high - low)), first + 0.5 * (low + high)
    )
    return (*begun, top)


def first_arc(begun: tuple[Vec3, ...], centre_ned: Vec3, radius_m: float) -> tuple[Vec3, ...]:
    """Points whose hull holds the first part of the ring, where a vehicle that gains speed cuts
    inside it (vehicle-sim)."""
    way = math.copysign(1.0, radius_m)
    first = _bearing(begun[0], centre_ned)
    turned = [math.remainder(_bearing(p, centre_ned) - first, 2.0 * math.pi) for p in begun]
    low, high = min(turned), max(turned)
    low, high = (low, high + _GAINS_RAD) if way > 0.0 else (low - _GAINS_RAD, high)
    parts = math.ceil((high - low) / _ARC_STEP_RAD)
    step = (high - low) / parts
    if high - low > 1.5 * math.pi:
        return _around(centre_ned, abs(radius_m))
    outer_m = abs(radius_m) / math.cos(0.5 * step)
    tops = (_on_circle(centre_ned, outer_m, first + low + (n + 0.5) * step) for n in range(parts))
    ends = (_on_circle(centre_ned, abs(radius_m), first + turn) for turn in (low, high))
    return (*ends, *tops)


def circle_ends(
    begun: tuple[Vec3, ...], centre_ned: Vec3, radius_m: float, turns: float, overshoot_m: float
) -> tuple[tuple[Vec3, ...], tuple[Vec3, ...]]:
    """Where it may leave the circle from each entry, the nominal place first, and how far it may go
    on from there.

    A positive radius is clockwise seen from above.
    """
    reach_m, way = abs(radius_m), math.copysign(1.0, radius_m)
    leaves: list[Vec3] = []
    on: list[Vec3] = []
    for entry in begun:
        for part in dict.fromkeys((math.fmod(turns, 1.0), 0.0)):
            angle = _bearing(entry, centre_ned) + way * part * 2.0 * math.pi
            leave = entry if part == 0.0 else _on_circle(centre_ned, reach_m, angle)
            along = (-math.sin(angle), math.cos(angle), 0.0)
            leaves.append(leave)
            for side in (way, -way):
                leaves.append(_on_circle(centre_ned, reach_m, angle - side * _SHORT_RAD))
                on.append(ahead(leave, along, side * overshoot_m))
    return tuple(leaves), tuple(on)


def _around(centre_ned: Vec3, radius_m: float) -> tuple[Vec3, ...]:
    """A polygon round the circle."""
    outer_m = radius_m / math.cos(math.pi / _CORNERS)
    return tuple(
        _on_circle(centre_ned, outer_m, 2.0 * math.pi * n / _CORNERS) for n in range(_CORNERS)
    )


def _bearing(place: Vec3, centre_ned: Vec3) -> float:
    return math.atan2(place[1] - centre_ned[1], place[0] - centre_ned[0])


def _on_circle(centre_ned: Vec3, radius_m: float, angle_rad: float) -> Vec3:
    return (
        centre_ned[0] + radius_m * math.cos(angle_rad),
        centre_ned[1] + radius_m * math.sin(angle_rad),
        centre_ned[2],
    )
