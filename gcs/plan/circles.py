"""The way onto a loiter circle and off it."""

from __future__ import annotations

import math

from gcs.frames import Vec3

_CARRY = 0.3
"""Of the radius.  A vehicle that flies circles with half its acceleration (AC_Circle, and
vehicle-sim) comes to rest within v^2 / 2a = radius / 4 beyond where it leaves the circle."""
_CORNERS = 8


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


def circle_ends(
    begun: tuple[Vec3, ...], centre_ned: Vec3, radius_m: float, turns: float
) -> tuple[Vec3, ...]:
    """Where it leaves the circle from each entry, and where its speed may carry it from there.

    A positive radius is clockwise seen from above.
    """
    part_rad = math.copysign(2.0 * math.pi * math.fmod(turns, 1.0), radius_m)
    reach_m, way = abs(radius_m), math.copysign(1.0, radius_m)
    leaves: list[Vec3] = []
    carried: list[Vec3] = []
    for entry in begun:
        angle = _bearing(entry, centre_ned) + part_rad
        leave = entry if part_rad == 0.0 else _on_circle(centre_ned, reach_m, angle)
        carry_m = _CARRY * reach_m * way
        leaves.append(leave)
        carried.append(
            (
                leave[0] - carry_m * math.sin(angle),
                leave[1] + carry_m * math.cos(angle),
                leave[2],
            )
        )
    return (*leaves, *carried)


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
