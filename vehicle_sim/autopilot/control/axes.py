"""Setpoints whose axes are asked for in different ways, as PX4 takes them: NaN = not this axis.

Each axis needs a position or a velocity.  A velocity over the ground with a height is flown as
such; where a position is mixed with velocities it is approached at MPC_XY_P or MPC_Z_P per
second, which is what PX4's own position loop does.
"""

from __future__ import annotations

from math import isfinite, isnan

from vehicle_sim.autopilot.control.demands import Demand, FlyAtHeight, FlyVelocity, Situation
from vehicle_sim.autopilot.interface import Setpoint
from vehicle_sim.control_loops.trajectory import MotionLimits
from vehicle_sim.numerics.vectors import Vec3

_POSITION_P = 0.95  # 1/s


def is_partial(setpoint: Setpoint) -> bool:
    """Some axis of a vector is left out."""
    for vector in (setpoint.pos_ned, setpoint.v_ned, setpoint.a_ned):
        if vector is not None and (isnan(vector[0]) or isnan(vector[1]) or isnan(vector[2])):
            return True
    return False


def every_axis_is_given(setpoint: Setpoint) -> bool:
    """No axis without a position or a velocity, and no number that is none."""
    return all(
        isfinite(place) or isfinite(speed)
        for place, speed in zip(_parts(setpoint.pos_ned), _parts(setpoint.v_ned), strict=True)
    )


def fly_by_axes(setpoint: Setpoint, s: Situation, limits: MotionLimits, direct: bool) -> Demand:
    """What to fly for a partial setpoint with every axis given; `direct` as in `FlyTo`."""
    pos, v = _parts(setpoint.pos_ned), _parts(setpoint.v_ned)
    n, e, d = (_speed(pos[axis], v[axis], s.pos_ned[axis]) for axis in range(3))
    if isfinite(pos[2]) and not isfinite(v[2]):
        return FlyAtHeight(n, e, pos[2], limits, direct)
    return FlyVelocity((n, e, d), limits, direct)


def _parts(vector: Vec3 | None) -> Vec3:
    nan = float("nan")
    return (nan, nan, nan) if vector is None else vector


def _speed(place: float, speed: float, here: float) -> float:
    along = speed if isfinite(speed) else 0.0
    return _POSITION_P * (place - here) + along if isfinite(place) else along
