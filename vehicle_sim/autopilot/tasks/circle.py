"""Flying circles: to the nearest point of the circle, then round it."""

from __future__ import annotations

from math import atan2, cos, hypot, pi, sin, sqrt

from vehicle_sim.autopilot.control.demands import Demand, FlyCircle, FlyTo, Situation, Turner
from vehicle_sim.autopilot.interface import Landed, Target
from vehicle_sim.autopilot.tasks.tasks import distance, face
from vehicle_sim.numerics.vectors import Vec3

_ON_CIRCLE_M = 1.0


class CircleTask:
    """`turns` round `centre_ned`, clockwise seen from above where `clockwise`.

    The speed is that of the vehicle's own flights, or what half its acceleration can bend
    into the circle, the nose to the centre.  What has been turned is measured, not counted on.
    """

    landed_word = Landed.IN_AIR

    __slots__ = ("_all_rad", "_angle", "_centre", "_left_rad", "_radius", "_started", "_way")

    def __init__(self, centre_ned: Vec3, radius_m: float, turns: float, clockwise: bool) -> None:
        self._centre = centre_ned
        self._radius = radius_m
        self._way = 1.0 if clockwise else -1.0
        self._all_rad = self._left_rad = turns * 2.0 * pi
        self._angle = 0.0
        self._started = False

    @property
    def done(self) -> bool:
        return self._left_rad <= 0.0

    @property
    def completed(self) -> int | None:
        """Whole circles flown so far; None = it is not on the circle yet."""
        return int((self._all_rad - self._left_rad) / (2.0 * pi)) if self._started else None

    @property
    def target(self) -> Target:
        return Target(self._point(), None, None)

    def lifts_off(self, s: Situation) -> bool:
        return True

    def begin(self, s: Situation, turner: Turner) -> None:
        self._angle = self._bearing(s)

    def update(self, s: Situation, turner: Turner) -> Demand:
        if not self._started:
            entry = self._point()
            self._started = distance(s.pos_ned, entry) < _ON_CIRCLE_M
            if not self._started:
                return FlyTo(entry, s.limits)
        face(self._centre, s, turner)
        angle = self._bearing(s)
        turned = angle - self._angle
        turned -= 2.0 * pi * round(turned / (2.0 * pi))
        self._angle = angle
        self._left_rad -= self._way * turned
        speed = min(s.limits.speed_m_s, sqrt(0.5 * s.limits.accel_m_s2 * self._radius))
        return FlyCircle(self._centre, self._radius, self._way * speed / self._radius, s.limits)

    def _bearing(self, s: Situation) -> float:
        """Of the vehicle from the centre; where it stands right there, as it was."""
        north, east = s.pos_ned[0] - self._centre[0], s.pos_ned[1] - self._centre[1]
        return atan2(east, north) if hypot(north, east) > 0.0 else self._angle

    def _point(self) -> Vec3:
        c = self._centre
        return (
            c[0] + self._radius * cos(self._angle),
            c[1] + self._radius * sin(self._angle),
            c[2],
        )
