"""A reference that moves the way the vehicle can: limited in speed and acceleration.

The controller follows `Reference`; goals only pull at it.  So a step of the goal is a smooth
flight, without a wound-up position error, and a brake is a goal at the stopping point.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import sqrt

from vehicle_sim.autopilot.interface import Vec3

_APPROACH_P = 1.5  # 1/s: near the goal the speed is proportional to the distance
_SHARPNESS = 5.0  # 1/s: how fast the reference takes up a wanted velocity
_JERK_M_S3 = 30.0
_LEAD_FREE_M = 0.7
_LEAD_MAX_M = 4.0
_BRAKE_SHARE = 0.6  # of the acceleration is planned for braking, the rest is for the lag


@dataclass(frozen=True, slots=True)
class Limits:
    """Speeds [m/s] and horizontal and vertical acceleration [m/s^2], all positive."""

    speed_m_s: float
    climb_m_s: float
    descend_m_s: float
    accel_m_s2: float
    accel_vertical_m_s2: float


def approach_speed(distance_m: float, accel_m_s2: float) -> float:
    """The speed at `distance_m` from a goal from which one can still stop there.

    sqrt(2 a d) far away, proportional to the distance near by, and smooth where they meet.
    """
    near = accel_m_s2 / (_APPROACH_P * _APPROACH_P)
    if distance_m <= near:
        return _APPROACH_P * distance_m
    return sqrt(2.0 * accel_m_s2 * (distance_m - 0.5 * near))


class Reference:
    """Position [m], velocity [m/s] and acceleration [m/s^2] in NED that are flown now."""

    __slots__ = ("acc", "pos", "vel")

    def __init__(self) -> None:
        self.pos: Vec3 = (0.0, 0.0, 0.0)
        self.vel: Vec3 = (0.0, 0.0, 0.0)
        self.acc: Vec3 = (0.0, 0.0, 0.0)

    def reset(self, pos_ned: Vec3, v_ned: Vec3) -> None:
        self.pos = pos_ned
        self.vel = v_ned
        self.acc = (0.0, 0.0, 0.0)

    def stopping_point(self, limits: Limits) -> Vec3:
        """Where the reference stands still if it brakes from now on."""
        n, e, d = self.pos
        vn, ve, vd = self.vel
        flat = sqrt(vn * vn + ve * ve)
        lead = flat / (2.0 * _BRAKE_SHARE * limits.accel_m_s2) + 0.5 / _APPROACH_P
        lead_d = abs(vd) / (2.0 * _BRAKE_SHARE * limits.accel_vertical_m_s2) + 0.5 / _APPROACH_P
        return (n + vn * lead, e + ve * lead, d + vd * lead_d)

    def toward(
        self,
        goal_ned: Vec3,
        v_goal_ned: Vec3,
        pos_ned: Vec3,
        limits: Limits,
        straight: bool,
        dt_s: float,
    ) -> None:
        """Move on to a goal that itself moves at `v_goal_ned`; `pos_ned` is the estimate.

        `straight` lets the faster of the horizontal and the vertical motion wait for the slower,
        so that the path is a line.
        """
        dn = goal_ned[0] - self.pos[0]
        de = goal_ned[1] - self.pos[1]
        dd = goal_ned[2] - self.pos[2]
        flat = sqrt(dn * dn + de * de)
        drop = dd if dd >= 0.0 else -dd
        speed = approach_speed(flat, _BRAKE_SHARE * limits.accel_m_s2)
        if speed > limits.speed_m_s:
            speed = limits.speed_m_s
        rise = approach_speed(drop, _BRAKE_SHARE * limits.accel_vertical_m_s2)
        cap = limits.descend_m_s if dd > 0.0 else limits.climb_m_s
        if rise > cap:
            rise = cap
        if straight and flat > 0.0 and drop > 0.0:
            if flat * rise < drop * speed:
                speed = flat * rise / drop
            else:
                rise = drop * speed / flat
        scale = speed / flat if flat > 0.0 else 0.0
        want_d = rise if dd > 0.0 else -rise
        self._pull(
            (v_goal_ned[0] + dn * scale, v_goal_ned[1] + de * scale, v_goal_ned[2] + want_d),
            limits,
            self._patience(pos_ned) * dt_s,
            dt_s,
        )

    def at_velocity(self, v_goal_ned: Vec3, pos_ned: Vec3, limits: Limits, dt_s: float) -> None:
        """Take up a velocity, within the limits."""
        vn, ve, vd = v_goal_ned
        flat = sqrt(vn * vn + ve * ve)
        scale = limits.speed_m_s / flat if flat > limits.speed_m_s else 1.0
        if vd > limits.descend_m_s:
            vd = limits.descend_m_s
        elif vd < -limits.climb_m_s:
            vd = -limits.climb_m_s
        self._pull((vn * scale, ve * scale, vd), limits, self._patience(pos_ned) * dt_s, dt_s)

    def _patience(self, pos_ned: Vec3) -> float:
        """1 when the vehicle follows, towards 0 when it is left behind: time waits for it."""
        a = self.pos[0] - pos_ned[0]
        b = self.pos[1] - pos_ned[1]
        c = self.pos[2] - pos_ned[2]
        lead = sqrt(a * a + b * b + c * c)
        if lead <= _LEAD_FREE_M:
            return 1.0
        rest = (_LEAD_MAX_M - lead) / (_LEAD_MAX_M - _LEAD_FREE_M)
        return max(0.0, rest)

    def _pull(self, want: Vec3, limits: Limits, step_s: float, dt_s: float) -> None:
        vn, ve, vd = self.vel
        an, ae = _SHARPNESS * (want[0] - vn), _SHARPNESS * (want[1] - ve)
        ad = _SHARPNESS * (want[2] - vd)
        flat = sqrt(an * an + ae * ae)
        if flat > limits.accel_m_s2:
            an *= limits.accel_m_s2 / flat
            ae *= limits.accel_m_s2 / flat
        most = limits.accel_vertical_m_s2
        ad = most if ad > most else max(ad, -most)
        jn, je, jd = an - self.acc[0], ae - self.acc[1], ad - self.acc[2]
        jerk = sqrt(jn * jn + je * je + jd * jd)
        if jerk > _JERK_M_S3 * dt_s:
            scale = _JERK_M_S3 * dt_s / jerk
            an = self.acc[0] + jn * scale
            ae = self.acc[1] + je * scale
            ad = self.acc[2] + jd * scale
        self.acc = (an, ae, ad)
        new = (vn + an * dt_s, ve + ae * dt_s, vd + ad * dt_s)
        self.vel = new
        self.pos = (
            self.pos[0] + 0.5 * (vn + new[0]) * step_s,
            self.pos[1] + 0.5 * (ve + new[1]) * step_s,
            self.pos[2] + 0.5 * (vd + new[2]) * step_s,
        )
