"""Flies demands: reference, heading and cascade; knows ground from air.

On the ground, armed, the motors idle and nothing is controlled.  A task that lifts off starts
the flight; the land detector ends it.
"""

from __future__ import annotations

from math import atan2, pi
from typing import assert_never

from vehicle_sim.autopilot.control import Control
from vehicle_sim.autopilot.demands import (
    Demand,
    FlyAcceleration,
    FlyAttitude,
    FlyLevel,
    FlyTo,
    FlyVelocity,
    Situation,
)
from vehicle_sim.autopilot.interface import Quat, Vec3
from vehicle_sim.autopilot.trajectory import Reference
from vehicle_sim.model.quad import Quad

_EASE_P = 1.5  # 1/s: a turn slows down before its goal, at last to _EASE_RAD_S
_EASE_RAD_S = 0.1
_LAND_S = 0.6
_LAND_SPEED_M_S = 0.3
_LAND_THRUST = 0.7  # of hover: the reference has gone on below the ground
_LAND_LAG_M = 0.2


def heading_of(q_ned_from_frd: Quat) -> float:
    """Yaw of the body's forward axis, -pi .. pi from north."""
    w, x, y, z = q_ned_from_frd
    return atan2(2.0 * (w * z + x * y), 1.0 - 2.0 * (y * y + z * z))


def wrap_pi(angle_rad: float) -> float:
    """The same direction within -pi .. pi."""
    while angle_rad > pi:
        angle_rad -= 2.0 * pi
    while angle_rad < -pi:
        angle_rad += 2.0 * pi
    return angle_rad


class Heading:
    """The yaw setpoint: slews to a goal the shorter way, or the way that was asked for."""

    __slots__ = ("_goal_rad", "_left_rad", "_rate_rad_s", "_spin_rad_s", "max_rad_s", "yaw_rad")

    def __init__(self) -> None:
        self.yaw_rad = 0.0
        self.max_rad_s = 1.0
        self._goal_rad = 0.0
        self._left_rad = 0.0
        self._rate_rad_s = 1.0
        self._spin_rad_s = 0.0

    @property
    def turning(self) -> bool:
        return self._left_rad != 0.0

    def reset(self, yaw_rad: float) -> None:
        self.yaw_rad = self._goal_rad = yaw_rad
        self._left_rad = self._spin_rad_s = 0.0

    def turn_to(self, yaw_rad: float) -> None:
        """The shorter way, at the vehicle's own turn rate."""
        if yaw_rad == self._goal_rad and self._spin_rad_s == 0.0:
            return
        self.turn(yaw_rad, self.max_rad_s, 0)

    def turn(self, yaw_rad: float, rate_rad_s: float, direction: int) -> None:
        """`direction` 1 clockwise, -1 counter-clockwise, 0 the shorter way."""
        left = wrap_pi(yaw_rad - self.yaw_rad)
        if direction > 0 and left < 0.0:
            left += 2.0 * pi
        elif direction < 0 and left > 0.0:
            left -= 2.0 * pi
        self._goal_rad = yaw_rad
        self._left_rad = left
        self._rate_rad_s = rate_rad_s if 0.0 < rate_rad_s < self.max_rad_s else self.max_rad_s
        self._spin_rad_s = 0.0

    def turn_by_rate(self, rate_rad_s: float) -> None:
        """Go on turning at this rate; 0 ends such a turn, and leaves one to a goal alone."""
        if rate_rad_s == 0.0 and self._spin_rad_s == 0.0:
            return
        top = self.max_rad_s
        self._spin_rad_s = top if rate_rad_s > top else max(rate_rad_s, -top)
        self._left_rad = 0.0
        self._goal_rad = self.yaw_rad

    def advance(self, dt_s: float) -> float:
        """Move on by `dt_s`; returns the rate [rad/s] of the move."""
        rate_rad_s = self._spin_rad_s
        left = self._left_rad
        if rate_rad_s == 0.0 and left != 0.0:
            most = min(self._rate_rad_s, _EASE_P * abs(left) + _EASE_RAD_S)
            rate_rad_s = max(-most, min(most, left / dt_s))
            self._left_rad = 0.0 if abs(left) <= most * dt_s else left - rate_rad_s * dt_s
        if rate_rad_s != 0.0:
            self.yaw_rad = wrap_pi(self.yaw_rad + rate_rad_s * dt_s)
        return rate_rad_s


class Pilot:
    """One vehicle's flying hand."""

    __slots__ = ("_idle", "_still_s", "control", "flying", "heading", "reference")

    def __init__(self, quad: Quad) -> None:
        self.control = Control(quad.airframe)
        self.reference = Reference()
        self.heading = Heading()
        self.flying = False
        self._idle = quad.airframe.motors.idle
        self._still_s = 0.0

    def stop(self) -> None:
        """Motors off, at once, wherever the vehicle is."""
        self.flying = False
        self.control.reset()
        self.control.idle(0.0)

    def rest(self) -> None:
        """Armed on the ground: motors idle."""
        self.control.idle(self._idle)

    def lift_off(self, pos_ned: Vec3, heading_rad: float) -> None:
        """Begin to fly from where the vehicle stands."""
        self.flying = True
        self._still_s = 0.0
        self.control.reset()
        self.reference.reset(pos_ned, (0.0, 0.0, 0.0))
        self.heading.reset(heading_rad)

    def fly(self, demand: Demand, s: Situation, dt_s: float) -> None:
        """Turn a demand into attitude and collective for the inner loops."""
        reference = self.reference
        control = self.control
        control.yaw_rate = self.heading.advance(dt_s)
        pos = s.pos_ned
        match demand:
            case FlyTo():
                reference.toward(
                    demand.pos_ned, demand.v_ned, pos, demand.limits, demand.straight, dt_s
                )
                self._follow(s, dt_s)
            case FlyVelocity():
                reference.at_velocity(demand.v_ned, pos, demand.limits, dt_s)
                self._follow(s, dt_s)
            case FlyAcceleration():
                reference.reset(pos, s.v_ned)
                control.accelerate(*demand.a_ned, self.heading.yaw_rad)
            case FlyLevel():
                goal = (reference.pos[0], reference.pos[1], demand.down_m)
                reference.toward(goal, (0.0, 0.0, 0.0), reference.pos, demand.limits, False, dt_s)
                control.climb(reference.vel[2] + reference.pos[2] - pos[2], s.v_ned[2], dt_s)
                self._level()
                self._let_go(s)
            case FlyAttitude():
                self._fly_attitude(demand, s, dt_s)
                self._let_go(s)
            case _:
                assert_never(demand)

    def _follow(self, s: Situation, dt_s: float) -> None:
        reference = self.reference
        r = reference.pos
        p = s.pos_ned
        self.control.outer(
            (r[0] - p[0], r[1] - p[1], r[2] - p[2]),
            reference.vel,
            reference.acc,
            s.v_ned,
            self.heading.yaw_rad,
            dt_s,
        )

    def _level(self) -> None:
        collective = self.control.collective
        self.control.accelerate(0.0, 0.0, 0.0, self.heading.yaw_rad)
        self.control.collective = collective

    def _let_go(self, s: Situation) -> None:
        """Where the position is not controlled the reference goes along, ready to take over."""
        r, v = self.reference.pos, self.reference.vel
        self.reference.pos = (s.pos_ned[0], s.pos_ned[1], r[2])
        self.reference.vel = (s.v_ned[0], s.v_ned[1], v[2])

    def _fly_attitude(self, demand: FlyAttitude, s: Situation, dt_s: float) -> None:
        control = self.control
        setpoint = demand.setpoint
        if demand.thrust_is_climb:
            part = 2.0 * setpoint.thrust - 1.0
            limit = demand.limits.climb_m_s if part > 0.0 else demand.limits.descend_m_s
            control.climb(-part * limit, s.v_ned[2], dt_s)
        else:
            control.thrust(setpoint.thrust)
        self.reference.pos = s.pos_ned
        self.reference.vel = s.v_ned
        if setpoint.q_ned_from_frd is not None:
            control.sp_w, control.sp_x, control.sp_y, control.sp_z = setpoint.q_ned_from_frd
            control.rates_only = False
            self.heading.reset(heading_of(setpoint.q_ned_from_frd))
        elif setpoint.rates_frd is not None:
            control.rate_x, control.rate_y, control.rate_z = setpoint.rates_frd
            control.rates_only = True
            self.heading.reset(s.heading_rad)
        else:
            self._level()

    def touched_down(self, s: Situation, dt_s: float) -> bool:
        """Land detector: wants to descend, does not, and hardly carries itself, for 0.6 s."""
        control = self.control
        sinking = self.reference.pos[2] - s.pos_ned[2] > _LAND_LAG_M
        v = s.v_ned
        still = abs(v[2]) < _LAND_SPEED_M_S and abs(v[0]) < _LAND_SPEED_M_S and abs(v[1]) < 0.3
        if sinking and still and control.collective < _LAND_THRUST * control.hover_n:
            self._still_s += dt_s
        else:
            self._still_s = 0.0
        return self._still_s >= _LAND_S

    def settle(self) -> None:
        """On the ground: stop controlling."""
        self.flying = False
        self._still_s = 0.0
        self.control.reset()
        self.rest()
