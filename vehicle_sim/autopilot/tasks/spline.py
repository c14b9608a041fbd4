"""Smooth curves through waypoints: ArduCopter's spline waypoints.

A leg is a cubic Hermite curve; its goal runs along it at the flight's own speed, and waits for
a vehicle that falls behind.  The tangents have the directions of ArduCopter's, by memory of its
sources: where two splines meet, from the point before to the point after; where a straight leg
follows, along that leg (AC_WPNav::set_spline_destination); and both are shortened alike where they
are longer together than four times the way between the ends
(SplineCurve::set_origin_and_destination).  They are half as long as ArduCopter's (Catmull and Rom).
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from math import atan2, sqrt

from vehicle_sim.autopilot.control.demands import Demand, FlyTo, Situation, Turner
from vehicle_sim.autopilot.interface import Landed, Target
from vehicle_sim.autopilot.tasks.tasks import distance
from vehicle_sim.control_loops.trajectory import MotionLimits, approach_speed
from vehicle_sim.numerics.vectors import Vec3

_APPROACH_P = 1.5  # 1/s: near its end the speed is proportional to the way left
_BRAKE_SHARE = 0.5  # of the acceleration, along the curve; as much is left to bend the path
_SLOWEST_M_S = 0.3
_BEHIND_M = 2.0  # the goal slows down from here on, and stands still at twice as much
_CHORDS = 32  # in which the length is measured
_REST: Vec3 = (0.0, 0.0, 0.0)
_HALF = 0.5  # of ArduCopter's tangents
_TANGENTS_MAX = 4.0  # both together, in lengths of the straight way


@dataclass(frozen=True, slots=True)
class Curve:
    """A cubic from `start` to `end` [m, NED] with its tangents there, per unit of u = 0..1."""

    start: Vec3
    end: Vec3
    start_tangent: Vec3
    end_tangent: Vec3

    def at(self, u: float) -> Vec3:
        a = (1.0 + 2.0 * u) * (1.0 - u) * (1.0 - u)
        b = u * (1.0 - u) * (1.0 - u)
        return self._mixed(a, b, 1.0 - a, u * u * (u - 1.0))

    def tangent(self, u: float) -> Vec3:
        """d at / du."""
        a = 6.0 * u * (u - 1.0)
        return self._mixed(a, (3.0 * u - 1.0) * (u - 1.0), -a, u * (3.0 * u - 2.0))

    def bend(self, u: float) -> Vec3:
        """d tangent / du."""
        a = 12.0 * u - 6.0
        return self._mixed(a, 6.0 * u - 4.0, -a, 6.0 * u - 2.0)

    def _mixed(self, a: float, b: float, c: float, d: float) -> Vec3:
        p, m, q, n = self.start, self.start_tangent, self.end, self.end_tangent
        return (
            a * p[0] + b * m[0] + c * q[0] + d * n[0],
            a * p[1] + b * m[1] + c * q[1] + d * n[1],
            a * p[2] + b * m[2] + c * q[2] + d * n[2],
        )

    def length_from(self, u: float) -> float:
        """Metres that are left from `u` on."""
        points = [self.at(u + (1.0 - u) * n / _CHORDS) for n in range(_CHORDS + 1)]
        return sum(distance(a, b) for a, b in pairwise(points))


def curve(
    start: Vec3, end: Vec3, before: Vec3 | None, after: Vec3 | None, *, after_is_spline: bool = True
) -> Curve:
    """Through `start` and `end`; None = the flight begins, or ends, at rest there."""
    straight = _between(start, end, 1.0)
    onward = start if after_is_spline else end
    leaving = _REST if before is None else _between(before, end, 1.0)
    arriving = _REST if after is None else _between(onward, after, 1.0)
    size, most = _size(leaving) + _size(arriving), _TANGENTS_MAX * _size(straight)
    share = _HALF * (most / size if size > most else 1.0)
    return Curve(
        start,
        end,
        straight if before is None else _between(_REST, leaving, share),
        straight if after is None else _between(_REST, arriving, share),
    )


def _between(a: Vec3, b: Vec3, share: float) -> Vec3:
    return (share * (b[0] - a[0]), share * (b[1] - a[1]), share * (b[2] - a[2]))


def _size(v: Vec3) -> float:
    return distance(v, _REST)


class Spline:
    """One leg; `stops` at its end, or hands its speed over to the next."""

    landed_word = Landed.IN_AIR

    __slots__ = (
        "_accept_m",
        "_caps",
        "_curve",
        "_limits",
        "_stay_s",
        "_time_ns",
        "_u",
        "_until_ns",
        "speed",
        "stops",
    )

    def __init__(
        self, along: Curve, entry_m_s: float, stops: bool, accept_m: float, stay_s: float
    ) -> None:
        self._curve = along
        self.stops = stops
        self._accept_m = accept_m
        self._stay_s = stay_s
        self._u = 0.0
        self._time_ns: int | None = None
        self._until_ns: int | None = None
        self._limits: MotionLimits | None = None
        self._caps: list[float] = []
        self.speed = entry_m_s

    def done(self, s: Situation) -> bool:
        """At the end of the curve, and long enough."""
        if self._u < 1.0:
            return False
        if not self.stops:
            return True
        if self._until_ns is None:
            if distance(s.pos_ned, self._curve.end) >= self._accept_m:
                return False
            self._until_ns = s.time_ns + int(self._stay_s * 1e9)
        return s.time_ns >= self._until_ns

    @property
    def target(self) -> Target:
        return Target(self._curve.end, None, None)

    def update(self, s: Situation, turner: Turner) -> Demand:
        since_s = 0.0 if self._time_ns is None else (s.time_ns - self._time_ns) * 1e-9
        self._time_ns = s.time_ns
        self._advance(since_s, s)
        if self._u >= 1.0 and self.stops:
            return FlyTo(self._curve.end, s.limits)
        tangent = self._curve.tangent(self._u)
        size = _size(tangent)
        scale = self.speed / size if size > 0.0 else 0.0
        v_ned = (scale * tangent[0], scale * tangent[1], scale * tangent[2])
        if tangent[0] != 0.0 or tangent[1] != 0.0:
            turner.turn_to(atan2(tangent[1], tangent[0]))
        where = self._curve.at(self._u)
        return FlyTo(where, s.limits, v_ned, straight=False, since_ns=s.time_ns)

    def _advance(self, since_s: float, s: Situation) -> None:
        """The goal goes on by what it has flown since, at the speed that the curve allows."""
        size = _size(self._curve.tangent(self._u))
        if size > 0.0:
            self._u = min(1.0, self._u + self.speed * since_s / size)
        self.speed = max(
            _SLOWEST_M_S,
            min(self._fastest(s), self.speed + _BRAKE_SHARE * s.limits.accel_m_s2 * since_s),
        )
        behind_m = distance(s.pos_ned, self._curve.at(self._u))
        self.speed *= max(0.0, min(1.0, 2.0 - behind_m / _BEHIND_M))

    def _fastest(self, s: Situation) -> float:
        """What this place allows, and what the bends allow that come after it."""
        if s.limits is not self._limits:
            self._limits = s.limits
            self._caps = self._plan(s.limits)
        top = self._allowed(self._u, s.limits)
        ahead = min(_CHORDS, int(self._u * _CHORDS) + 1)
        way_m = distance(self._curve.at(self._u), self._curve.at(ahead / _CHORDS))
        brake = _BRAKE_SHARE * s.limits.accel_m_s2
        top = min(top, sqrt(self._caps[ahead] * self._caps[ahead] + 2.0 * brake * way_m))
        if self.stops:
            top = min(top, approach_speed(self._curve.length_from(self._u), brake, _APPROACH_P))
        return top

    def _plan(self, limits: MotionLimits) -> list[float]:
        """The greatest speed at the end of each chord from which it can brake for all bends."""
        brake = _BRAKE_SHARE * limits.accel_m_s2
        caps = [self._allowed(1.0, limits)]
        places = [self._curve.at(n / _CHORDS) for n in range(_CHORDS + 1)]
        for n in range(_CHORDS - 1, -1, -1):
            way_m = distance(places[n], places[n + 1])
            braked = sqrt(caps[-1] * caps[-1] + 2.0 * brake * way_m)
            caps.append(min(self._allowed(n / _CHORDS, limits), braked))
        return caps[::-1]

    def _allowed(self, u: float, limits: MotionLimits) -> float:
        brake = _BRAKE_SHARE * limits.accel_m_s2
        top = limits.speed_m_s
        tangent, bend = self._curve.tangent(u), self._curve.bend(u)
        flat = sqrt(tangent[0] * tangent[0] + tangent[1] * tangent[1])
        size = _size(tangent)
        cross = abs(tangent[0] * bend[1] - tangent[1] * bend[0])
        if cross > 0.0 and flat > 0.0:
            # v^2 / r is what bends the path; r = |c'|^3 / |c' x c''|.
            top = min(top, sqrt(brake * flat * flat * flat / cross) * size / flat)
        if tangent[2] != 0.0:
            rise = limits.descend_m_s if tangent[2] > 0.0 else limits.climb_m_s
            top = min(top, rise * size / abs(tangent[2]))
        return top
