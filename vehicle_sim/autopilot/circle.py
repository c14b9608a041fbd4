"""Flying circles: to the nearest point of the circle, then round it."""

from __future__ import annotations

from math import atan2, cos, pi, sin, sqrt

from vehicle_sim.autopilot.demands import Demand, FlyTo, Situation, Turner
from vehicle_sim.autopilot.interface import Landed, Target, Vec3
from vehicle_sim.autopilot.tasks import distance

_ON_CIRCLE_M = 1.0
_STEP_S = 0.02


class Circle:
    """`turns` round `centre_ned`, clockwise seen from above where `clockwise`.

    The speed is that of the vehicle's own flights, or what half its acceleration can bend
    into the circle.
    """

    landed_word = Landed.IN_AIR

    __slots__ = ("_angle", "_centre", "_left_rad", "_radius", "_started", "_way")

    def __init__(self, centre_ned: Vec3, radius_m: float, turns: float, clockwise: bool) -> None:
        self._centre = centre_ned
        self._radius = radius_m
        self._way = 1.0 if clockwise else -1.0
        self._left_rad = turns * 2.0 * pi
        self._angle = 0.0
        self._started = False

    @property
    def done(self) -> bool:
        return self._left_rad <= 0.0

    @property
    def target(self) -> Target:
        return Target(self._point(), None, None)

    def lifts_off(self, s: Situation) -> bool:
        return True

    def begin(self, s: Situation, turner: Turner) -> None:
        centre = self._centre
        self._angle = atan2(s.pos_ned[1] - centre[1], s.pos_ned[0] - centre[0])

    def update(self, s: Situation, turner: Turner) -> Demand:
        if not self._started:
            entry = self._point()
            self._started = distance(s.pos_ned, entry) < _ON_CIRCLE_M
            return FlyTo(entry, s.limits)
        speed = min(s.limits.speed_m_s, sqrt(0.5 * s.limits.accel_m_s2 * self._radius))
        turn = speed / self._radius * _STEP_S
        self._angle += self._way * turn
        self._left_rad -= turn
        along = self._way * speed
        v_ned = (-along * sin(self._angle), along * cos(self._angle), 0.0)
        return FlyTo(self._point(), s.limits, v_ned, straight=False)

    def _point(self) -> Vec3:
        c = self._centre
        return (
            c[0] + self._radius * cos(self._angle),
            c[1] + self._radius * sin(self._angle),
            c[2],
        )
