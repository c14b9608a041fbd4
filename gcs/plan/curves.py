"""A bound on ArduCopter's spline waypoints: the convex hull of the curve's control points.

A spline leg is a cubic Hermite curve from P to Q with tangents m and n, which is the Bezier curve
with the control points P, P + m / 3, Q - n / 3 and Q, and lies in their hull.  The tangents, by
AC_WPNav::set_spline_destination and SplineCurve::set_origin_and_destination:

m   at rest none; after a straight leg the direction of that leg; after a spline that spline's n;
n   where a spline follows, from P to the place after Q; where a straight leg follows, from Q to
    the place after it; else none;

and both may be scaled down, when they are longer together than four times the way from P to Q.  A
tangent that is shorter gives a control point between P and P + m / 3, so the hull over all of
these choices holds the curve, whichever of them the vehicle takes.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from gcs.frames import Vec3

_LAG_M = 4.0
"""Where the target has left the curve, the vehicle may be so far behind it (vehicle-sim's; an
ArduCopter's error of position in WP_NAV is limited to a few metres as well, by memory)."""


_BRAKE_SHARE = 0.6
"""Of the acceleration that a vehicle plans to brake with (vehicle-sim; an ArduCopter's corner too
leaves some of it)."""

_CARRY_UP_M = 4.0
"""2.5 m/s of climb and 1 m/s^2, as delivered, are 3.1 m."""


@dataclass(frozen=True, slots=True)
class Neighbours:
    """Where the leg before began, if the vehicle does not begin at rest, and where it may go on."""

    before_ned: Vec3 | None
    after_ned: tuple[Vec3, ...]


def curve_hull(
    starts: tuple[Vec3, ...], to_ned: Vec3, neighbours: Neighbours, accept_m: float
) -> tuple[tuple[Vec3, ...], tuple[Vec3, ...]]:
    """The points whose hull, with `starts`, holds the curve; and where the vehicle may be when the
    curve ends, beside `to_ned`."""
    controls: dict[Vec3, None] = {to_ned: None}
    arrivals: dict[Vec3, None] = {}
    for start in starts:
        tangents = [_from(start, to_ned)]
        if neighbours.before_ned is not None:
            tangents += [_from(neighbours.before_ned, start), _from(neighbours.before_ned, to_ned)]
        for tangent in tangents:
            controls[_moved(start, tangent, 1.0 / 3.0)] = None
        leaving = [_from(start, to_ned)]
        for after in neighbours.after_ned:
            leaving += [_from(start, after), _from(to_ned, after)]
        for tangent in leaving:
            controls[_moved(to_ned, tangent, -1.0 / 3.0)] = None
            size = math.hypot(*tangent)
            if size > 0.0:
                arrivals[_moved(to_ned, tangent, -max(accept_m, _LAG_M) / size)] = None
    return tuple(controls), tuple(arrivals)


def _from(a: Vec3, b: Vec3) -> Vec3:
    return (b[0] - a[0], b[1] - a[1], b[2] - a[2])


def _moved(at: Vec3, by: Vec3, share: float) -> Vec3:
    return (at[0] + share * by[0], at[1] + share * by[1], at[2] + share * by[2])


def carried(
    starts: tuple[Vec3, ...],
    to_ned: Vec3,
    straight_after: tuple[Vec3, ...],
    speed_m_s: float,
    accel_m_s2: float,
) -> tuple[Vec3, ...]:
    """How far its speed may carry a vehicle past `to_ned` before it is on the straight leg that
    follows: along the tangent of a curve that looks ahead to that leg's end.

    To whole metres, so that a loop comes back to what it was before; one metre more for that.
    """
    reach_m = 1.0 + speed_m_s * speed_m_s / (2.0 * _BRAKE_SHARE * accel_m_s2)
    found: dict[Vec3, None] = {}
    for start in starts:
        for after in straight_after:
            tangent = _from(start, after)
            size = math.hypot(*tangent)
            if size > 0.0:
                n, e, d = _moved(to_ned, tangent, reach_m / size)
                height_m = max(-_CARRY_UP_M, min(_CARRY_UP_M, float(round(d - to_ned[2]))))
                found[(float(round(n)), float(round(e)), to_ned[2] + height_m)] = None
    return tuple(found)
