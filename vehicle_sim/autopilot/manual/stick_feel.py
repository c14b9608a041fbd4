"""What a deflected stick is worth: speeds, angles and curves of each personality.

PX4's curves are those of its flight tasks (dead zone MPC_HOLD_DZ, then a cubic mix by
MPC_*_EXPO); ArduCopter's are `get_pilot_desired_*` (straight, dead zone THR_DZ on the climb, a
cubic throttle through MOT_THST_HOVER).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import sqrt

from vehicle_sim.autopilot.manual.sticks import Sticks
from vehicle_sim.autopilot.modes import Personality
from vehicle_sim.autopilot.parameters.parameters import Parameters, Quantity
from vehicle_sim.numerics.vectors import Vec3

_DEG = 0.017453292519943295


@dataclass(frozen=True, slots=True)
class Feel:
    """Full deflections in SI, with dead zones and curves (0 straight .. 1 cubic) 0..1."""

    tilt_rad: float
    yaw_rad_s: float
    rates_rad_s: Vec3  # acro: roll, pitch, yaw
    speed_m_s: float
    accel_m_s2: float
    accel_down_m_s2: float
    accel_up_m_s2: float
    climb_m_s: float
    descend_m_s: float
    xy_dead: float
    xy_curve: float
    climb_dead: float
    climb_curve: float
    yaw_dead: float
    yaw_curve: float

    def climb(self, sticks: Sticks) -> float:
        """Climb rate [m/s], upwards positive."""
        part = shaped(sticks.climb, self.climb_dead, self.climb_curve)
        return part * (self.climb_m_s if part > 0.0 else self.descend_m_s)

    def turn(self, sticks: Sticks) -> float:
        """Yaw rate [rad/s], clockwise positive."""
        return shaped(sticks.yaw, self.yaw_dead, self.yaw_curve) * self.yaw_rad_s

    def velocity(self, sticks: Sticks) -> tuple[float, float]:
        """Forward and right [m/s]; full sticks in both are as fast as full stick in one."""
        forward = shaped(sticks.pitch, self.xy_dead, self.xy_curve)
        right = shaped(sticks.roll, self.xy_dead, self.xy_curve)
        return _in_circle(forward, right, self.speed_m_s)

    def lean(self, sticks: Sticks) -> tuple[float, float]:
        """Lean forward and right [rad]."""
        return _in_circle(sticks.pitch, sticks.roll, self.tilt_rad)

    def rates(self, sticks: Sticks) -> Vec3:
        """Body rates about forward, right and down [rad/s]."""
        roll, pitch, yaw = self.rates_rad_s
        return (roll * sticks.roll, -pitch * sticks.pitch, yaw * sticks.yaw)


def feel_of(parameters: Parameters) -> Feel:
    """Read anew whenever a parameter changes."""
    return _FEEL[parameters.personality](parameters)


def _px4_feel(parameters: Parameters) -> Feel:
    get = parameters.get
    return Feel(
        tilt_rad=get("MPC_MAN_TILT_MAX") * _DEG,
        yaw_rad_s=get("MPC_MAN_Y_MAX") * _DEG,
        rates_rad_s=(
            get("MC_ACRO_R_MAX") * _DEG,
            get("MC_ACRO_P_MAX") * _DEG,
            get("MC_ACRO_Y_MAX") * _DEG,
        ),
        speed_m_s=min(get("MPC_VEL_MANUAL"), get("MPC_XY_VEL_MAX")),
        accel_m_s2=parameters.si(Quantity.ACCEL_M_S2),
        accel_down_m_s2=parameters.si(Quantity.ACCEL_VERTICAL_M_S2),
        accel_up_m_s2=parameters.si(Quantity.ACCEL_UP_M_S2),
        climb_m_s=get("MPC_Z_VEL_MAX_UP"),
        descend_m_s=get("MPC_Z_VEL_MAX_DN"),
        xy_dead=get("MPC_HOLD_DZ"),
        xy_curve=get("MPC_XY_MAN_EXPO"),
        climb_dead=get("MPC_HOLD_DZ"),
        climb_curve=get("MPC_Z_MAN_EXPO"),
        yaw_dead=get("MPC_HOLD_DZ"),
        yaw_curve=get("MPC_YAW_EXPO"),
    )


def _copter_feel(parameters: Parameters) -> Feel:
    get = parameters.get
    up_cm_s, down_cm_s = get("PILOT_SPEED_UP"), get("PILOT_SPEED_DN")
    rate_rad_s = get("ACRO_RP_RATE") * _DEG
    return Feel(
        tilt_rad=0.01 * get("ANGLE_MAX") * _DEG,
        yaw_rad_s=get("PILOT_Y_RATE") * _DEG,
        rates_rad_s=(rate_rad_s, rate_rad_s, get("ACRO_Y_RATE") * _DEG),
        speed_m_s=0.01 * get("LOIT_SPEED"),
        accel_m_s2=0.01 * get("LOIT_ACC_MAX"),
        accel_down_m_s2=0.01 * get("PILOT_ACCEL_Z"),
        accel_up_m_s2=0.01 * get("PILOT_ACCEL_Z"),
        climb_m_s=0.01 * up_cm_s,
        descend_m_s=0.01 * (down_cm_s or up_cm_s),
        xy_dead=0.0,
        xy_curve=0.0,
        climb_dead=get("THR_DZ") / 500.0,
        climb_curve=0.0,
        yaw_dead=0.0,
        yaw_curve=0.0,
    )


def thrust_of(parameters: Parameters, sticks: Sticks) -> float:
    """The throttle stick as a part of full thrust; its middle hovers."""
    return _THRUST[parameters.personality](parameters, sticks)


def _px4_thrust(parameters: Parameters, sticks: Sticks) -> float:
    get = parameters.get
    middle = get("MPC_THR_HOVER")
    climb = sticks.climb
    if climb < 0.0:
        return middle + climb * (middle - get("MPC_MANTHR_MIN"))
    return middle + climb * (get("MPC_THR_MAX") - middle)


def _copter_thrust(parameters: Parameters, sticks: Sticks) -> float:
    bend = min(1.0, max(-0.5, (0.5 - parameters.get("MOT_THST_HOVER")) / 0.375))
    part = sticks.throttle
    return part * (1.0 - bend) + bend * part * part * part


_FEEL: dict[Personality, Callable[[Parameters], Feel]] = {
    "px4": _px4_feel,
    "ardupilot": _copter_feel,
}
_THRUST: dict[Personality, Callable[[Parameters, Sticks], float]] = {
    "px4": _px4_thrust,
    "ardupilot": _copter_thrust,
}


def hover_of(parameters: Parameters) -> float:
    """The thrust in the middle of the throttle stick."""
    return parameters.get(parameters.rules.hover_thrust)


def shaped(stick: float, dead: float, curve: float) -> float:
    """A stick beyond its dead zone, -1..1, bent towards its cube."""
    size = abs(stick)
    if size <= dead or dead >= 1.0:
        return 0.0
    part = (size - dead) / (1.0 - dead)
    part = (1.0 - curve) * part + curve * part * part * part
    return part if stick > 0.0 else -part


def _in_circle(forward: float, right: float, full: float) -> tuple[float, float]:
    length = sqrt(forward * forward + right * right)
    scale = full / length if length > 1.0 else full
    return (forward * scale, right * scale)
