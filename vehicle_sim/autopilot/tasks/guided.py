"""Flown from outside: px4's OFFBOARD and ardupilot's GUIDED.

They differ in what silence means.  PX4 leaves OFFBOARD when the stream is lost (the autopilot
asks `stream_lost`).  ArduCopter keeps a position goal for ever and brakes when velocity,
acceleration or attitude setpoints stop for GUID_TIMEOUT.  Both measure the other side, so both
run on wall time.
"""

from __future__ import annotations

from dataclasses import replace
from math import isfinite
from typing import TypeAlias

from vehicle_sim.autopilot.control.axes import every_axis_is_given, fly_by_axes, is_partial
from vehicle_sim.autopilot.control.demands import (
    STILL,
    Demand,
    FlyAcceleration,
    FlyAttitude,
    FlyTo,
    FlyVelocity,
    Situation,
    Turner,
)
from vehicle_sim.autopilot.interface import AttitudeSetpoint, Landed, Setpoint, Target
from vehicle_sim.autopilot.parameters.parameters import Parameters, Quantity
from vehicle_sim.autopilot.tasks.tasks import TakeOff
from vehicle_sim.control_loops.trajectory import MotionLimits, slowed
from vehicle_sim.numerics.vectors import Vec3

AnySetpoint: TypeAlias = Setpoint | AttitudeSetpoint

_ENTRY_GAP_NS = 500_000_000  # OFFBOARD wants more than 2 Hz
_ENTRY_STREAM_NS = 1_000_000_000
_LIFT_M = 0.15
_LIFT_M_S = 0.1
_THRUST_AS_THRUST = 8  # GUID_OPTIONS


def is_sound(setpoint: AnySetpoint) -> bool:
    """Every number in it is one, and an attitude is a unit quaternion (to 1 %)."""
    match setpoint:
        case Setpoint(pos_ned, v_ned, a_ned, yaw_rad, yaw_rate_rad_s):
            vectors = (pos_ned, v_ned, a_ned)
            scalars = (yaw_rad, yaw_rate_rad_s)
            if is_partial(setpoint):
                if not every_axis_is_given(setpoint):
                    return False
                vectors = (None, None, None)
        case AttitudeSetpoint(q_ned_from_frd, rates_frd, thrust):
            if q_ned_from_frd is not None:
                w, x, y, z = q_ned_from_frd
                if not abs(w * w + x * x + y * y + z * z - 1.0) < 0.02:
                    return False
            vectors = (rates_frd, None, None)
            scalars = (thrust, None)
    return all(isfinite(x) for v in vectors if v is not None for x in v) and all(
        isfinite(x) for x in scalars if x is not None
    )


class SetpointStream:
    """The last setpoint and how long it has been coming, on wall time."""

    __slots__ = ("_last_ns", "_since_ns", "setpoint", "taken_ns")

    def __init__(self) -> None:
        self.setpoint: AnySetpoint | None = None
        self.taken_ns = 0  # when the last one came, in simulated time
        self._last_ns = 0
        self._since_ns = 0

    def heard(self, setpoint: AnySetpoint, wall_ns: int, time_ns: int) -> None:
        self.taken_ns = time_ns
        if self.setpoint is None or wall_ns - self._last_ns >= _ENTRY_GAP_NS:
            self._since_ns = wall_ns
        self.setpoint = setpoint
        self._last_ns = wall_ns

    def forget(self) -> None:
        self.setpoint = None

    def alive(self, wall_ns: int) -> bool:
        """Comes at more than 2 Hz."""
        return self.setpoint is not None and wall_ns - self._last_ns < _ENTRY_GAP_NS

    def proven(self, wall_ns: int) -> bool:
        """Has come at more than 2 Hz for a second."""
        return self.alive(wall_ns) and wall_ns - self._since_ns >= _ENTRY_STREAM_NS

    def age_ns(self, wall_ns: int) -> int:
        return wall_ns - self._last_ns


class Guided:
    """Follows the stream; before the first setpoint, and after a time-out, it stays."""

    done = True

    __slots__ = ("_braking", "_hold", "_limits", "_parameters", "_rules", "_stream", "_takeoff")

    def __init__(self, parameters: Parameters, stream: SetpointStream) -> None:
        self._parameters = parameters
        self._rules = parameters.rules
        self._stream = stream
        self._hold: Vec3 | None = None
        self._braking = False
        self._takeoff: TakeOff | None = None
        self._limits: tuple[MotionLimits, MotionLimits] | None = None  # made of which, and for it

    @property
    def landed_word(self) -> Landed:
        return Landed.IN_AIR if self._takeoff is None else self._takeoff.landed_word

    @property
    def target(self) -> Target:
        setpoint = self._stream.setpoint
        if self._takeoff is not None:
            return self._takeoff.target
        if isinstance(setpoint, Setpoint) and not self._braking and not is_partial(setpoint):
            return Target(setpoint.pos_ned, setpoint.v_ned, setpoint.yaw_rad)
        return Target(self._hold, None, None)

    @property
    def taking_off(self) -> bool:
        return self._takeoff is not None

    def take_off(self, goal_d: float, s: Situation, turner: Turner) -> None:
        """ArduCopter's take-off within GUIDED; the height is then held."""
        self._takeoff = TakeOff(goal_d, self._parameters)
        self._takeoff.begin(s, turner)
        self._stream.forget()

    def lifts_off(self, s: Situation) -> bool:
        if self._takeoff is not None:
            return self._takeoff.lifts_off(s)
        if not self._rules.setpoints_lift_off:
            return False
        setpoint = self._stream.setpoint
        match setpoint:
            case Setpoint(pos_ned=pos_ned) if pos_ned is not None and isfinite(pos_ned[2]):
                return pos_ned[2] < s.pos_ned[2] - _LIFT_M
            case Setpoint(v_ned=v_ned) if v_ned is not None and isfinite(v_ned[2]):
                return v_ned[2] < -_LIFT_M_S
            case Setpoint(a_ned=a_ned) if a_ned is not None:
                return a_ned[2] < -_LIFT_M_S
            case AttitudeSetpoint(thrust=thrust):
                return thrust > 0.3
            case _:
                return False

    def begin(self, s: Situation, turner: Turner) -> None:
        self._hold = s.stop_ned

    def update(self, s: Situation, turner: Turner) -> Demand:
        takeoff = self._takeoff
        if takeoff is not None:
            demand = takeoff.update(s, turner)
            if takeoff.done:
                self._hold = takeoff.target.pos_ned
                self._takeoff = None
            return demand
        setpoint = self._stream.setpoint
        if setpoint is None:
            return FlyTo(self._hold or s.stop_ned, s.limits)
        if self._timed_out(setpoint, s.wall_ns):
            if not self._braking:
                self._braking = True
                self._hold = s.stop_ned
                turner.turn_by_rate(0.0)
            return FlyVelocity(STILL, s.limits)
        self._braking = False
        if isinstance(setpoint, AttitudeSetpoint):
            return FlyAttitude(setpoint, self._thrust_is_climb, s.limits)
        if setpoint.yaw_rad is not None:
            turner.point(setpoint.yaw_rad)
        else:
            turner.turn_by_rate(setpoint.yaw_rate_rad_s or 0.0)
        top, direct = self._limits_of_setpoints(s), self._rules.setpoints_fly_direct
        if is_partial(setpoint):
            return fly_by_axes(setpoint, s, top, direct)
        if setpoint.pos_ned is not None:
            self._hold = setpoint.pos_ned
            fastest_m_s = self._parameters.si(Quantity.FASTEST_M_S)
            v_ned = slowed(setpoint.v_ned or STILL, top, fastest_m_s)
            # A goal with a velocity moves on by itself until the next setpoint comes.
            since_ns = self._stream.taken_ns if v_ned != STILL else 0
            return FlyTo(setpoint.pos_ned, top, v_ned, since_ns=since_ns, direct=direct)
        if setpoint.v_ned is not None:
            return FlyVelocity(setpoint.v_ned, top, direct)
        if setpoint.a_ned is not None:
            return FlyAcceleration(setpoint.a_ned)
        return FlyTo(self._hold or s.stop_ned, s.limits)

    @property
    def _thrust_is_climb(self) -> bool:
        if not self._rules.thrust_may_be_climb_rate:
            return False
        return not int(self._parameters.get("GUID_OPTIONS")) & _THRUST_AS_THRUST

    def _limits_of_setpoints(self, s: Situation) -> MotionLimits:
        """PX4 flies what it is told, as far as it ever flies; not at its cruise speed."""
        if not self._rules.setpoints_pass_cruise_speed:
            return s.limits
        # The situation's are made anew with every change of a parameter.
        if self._limits is None or self._limits[0] is not s.limits:
            limits = replace(
                s.limits,
                speed_m_s=self._parameters.get("MPC_XY_VEL_MAX"),
                climb_m_s=self._parameters.get("MPC_Z_VEL_MAX_UP"),
                descend_m_s=self._parameters.get("MPC_Z_VEL_MAX_DN"),
            )
            self._limits = s.limits, limits
        return self._limits[1]

    def _timed_out(self, setpoint: AnySetpoint, wall_ns: int) -> bool:
        if not self._rules.brakes_after_last_setpoint:
            return False
        still = (None, STILL)
        if isinstance(setpoint, Setpoint) and setpoint.pos_ned and setpoint.v_ned in still:
            return False
        loss_ns = int(self._parameters.si(Quantity.SETPOINT_LOSS_S) * 1e9)
        return self._stream.age_ns(wall_ns) >= loss_ns
