"""Builders of what a program on board looks at: odometry, motors and their controllers, UTM."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Final, TypeAlias

from vehicle_sim.autopilot.interface import Landed, Vehicle
from vehicle_sim.numerics.vectors import Quat, Vec3
from vehicle_sim.services.profile import Profile
from vehicle_sim.services.units import (
    INT16_MAX,
    clip_int16,
    clip_uint16,
    degrees_e7,
    millimetres,
    usec,
)
from vehicle_sim.wire import messages as m
from vehicle_sim.wire.ids import MavFrame

Builder: TypeAlias = Callable[[Vehicle, Profile], m.Message | None]

ESTIMATOR_AUTOPILOT: Final = 8  # MAV_ESTIMATOR_TYPE
DIAGONAL: Final = (0, 6, 11, 15, 18, 20)
"""Of a 6 x 6 matrix whose upper right triangle is told row by row."""
COVARIANCE_VALUES: Final = 21
VELOCITY_STD_M_S: Final = 0.1
ATTITUDE_STD_RAD: Final = 0.01
VERTICAL_STD_M: Final = 0.3

DISARMED_US: Final = 900
"""What PX4's outputs have while it is disarmed, as recorded."""
OUTPUTS: Final = 16
OUTPUTS_MAX: Final = 32

ESCS: Final = 4
FULL_RPM: Final = 9_500.0
"""Of the default airframe's motors (`s500.toml`).  No controller measures its motor here: speed and
current are reckoned from the output and from what the battery gives."""
DSHOT: Final = 5  # ESC_CONNECTION_TYPE
ALL_ONLINE: Final = 0b1111

UTM_FLAGS: Final = 1 | 4 | 8 | 32 | 64
"""UTM_DATA_AVAIL_FLAGS: time, position, altitude and both velocities, as PX4 1.14 sets them."""
UTM_RELATIVE_ALTITUDE: Final = 16
UTM_UNKNOWN: Final = 1  # UTM_FLIGHT_STATE: PX4 says so on the ground
UTM_AIRBORNE: Final = 3


def rotated_back(q: Quat, v: Vec3) -> Vec3:
    """A vector in NED, along the body's axes."""
    w, x, y, z = q
    n, e, d = v
    return (
        (1 - 2 * (y * y + z * z)) * n + 2 * (x * y + w * z) * e + 2 * (x * z - w * y) * d,
        2 * (x * y - w * z) * n + (1 - 2 * (x * x + z * z)) * e + 2 * (y * z + w * x) * d,
        2 * (x * z + w * y) * n + 2 * (y * z - w * x) * e + (1 - 2 * (x * x + y * y)) * d,
    )


def _covariance(first_m: Vec3, then: Vec3) -> tuple[float, ...]:
    """Variances of six numbers; PX4 tells no covariance between them: NaN."""
    covariance = [math.nan] * COVARIANCE_VALUES
    for place, deviation in zip(DIAGONAL, (*first_m, *then), strict=True):
        covariance[place] = deviation * deviation
    return tuple(covariance)


def odometry(vehicle: Vehicle, profile: Profile) -> m.Odometry | None:
    """Position in NED from the origin; velocity and rates along the body's axes."""
    if vehicle.origin is None:
        return None
    estimate = vehicle.estimate
    accuracy_m = vehicle.health.accuracy_m
    attitude_std = (ATTITUDE_STD_RAD,) * 3
    return m.Odometry(
        usec(vehicle),
        *estimate.pos_ned,
        estimate.q_ned_from_frd,
        *rotated_back(estimate.q_ned_from_frd, estimate.v_ned),
        *estimate.rates_frd,
        pose_covariance=_covariance((accuracy_m, accuracy_m, VERTICAL_STD_M), attitude_std),
        velocity_covariance=_covariance((VELOCITY_STD_M_S,) * 3, attitude_std),
        frame_id=MavFrame.LOCAL_NED,
        child_frame_id=MavFrame.BODY_FRD,
        reset_counter=0,
        estimator_type=ESTIMATOR_AUTOPILOT,
        quality=0,
    )


def outputs_us(vehicle: Vehicle) -> tuple[int, int, int, int]:
    """The four motors' pulses, 1000 to 2000 us."""
    first, second, third, fourth = vehicle.motor_outputs
    return (
        round(1000.0 + 1000.0 * first),
        round(1000.0 + 1000.0 * second),
        round(1000.0 + 1000.0 * third),
        round(1000.0 + 1000.0 * fourth),
    )


def actuator_output_status(vehicle: Vehicle, profile: Profile) -> m.ActuatorOutputStatus | None:
    """PX4's alone: pulses [us], and the number of the outputs where the dialect has their bits."""
    if m.ActuatorOutputStatus in profile.unsent_messages:
        return None
    pulses = [float(DISARMED_US)] * OUTPUTS
    if vehicle.armed:
        pulses[:ESCS] = outputs_us(vehicle)
    return m.ActuatorOutputStatus(
        usec(vehicle), OUTPUTS, (*pulses, *(0.0,) * (OUTPUTS_MAX - OUTPUTS))
    )


def esc_status(vehicle: Vehicle, profile: Profile) -> m.EscStatus | None:
    """The four motor controllers; PX4 sends it on request."""
    if m.EscStatus in profile.unsent_messages:
        return None
    outputs, power = vehicle.motor_outputs, vehicle.power
    together = sum(outputs)
    shares = [output / together if together > 0.0 else 0.0 for output in outputs]
    return m.EscStatus(
        usec(vehicle),
        rpm=tuple(round(FULL_RPM * output) for output in outputs),
        voltage=(power.voltage_v,) * ESCS,
        current=tuple(power.current_a * share for share in shares),
        index_=0,
    )


def esc_info(vehicle: Vehicle, profile: Profile) -> m.EscInfo | None:
    if m.EscInfo in profile.unsent_messages:
        return None
    return m.EscInfo(
        usec(vehicle),
        error_count=(0,) * ESCS,
        counter=usec(vehicle) // 1_000_000 & 0xFFFF,
        failure_flags=(0,) * ESCS,
        temperature=(INT16_MAX,) * ESCS,
        index_=0,
        count_=ESCS,
        connection_type=DSHOT,
        info=ALL_ONLINE,
    )


def utm_global_position(vehicle: Vehicle, unix_start_ns: int) -> m.UtmGlobalPosition | None:
    """As PX4 fills it: no identity, no next waypoint, a height above home in the air only."""
    if vehicle.origin is None:
        return None
    estimate, gps = vehicle.estimate, vehicle.readings.gps
    north, east, down = estimate.v_ned
    flying = vehicle.landed is not Landed.ON_GROUND
    return m.UtmGlobalPosition(
        time=unix_start_ns // 1000 + usec(vehicle),
        lat=degrees_e7(estimate.lat_deg),
        lon=degrees_e7(estimate.lon_deg),
        alt=millimetres(estimate.alt_amsl_m),
        relative_alt=millimetres(estimate.alt_rel_m) if flying else 0,
        next_lat=0,
        next_lon=0,
        next_alt=0,
        vx=clip_int16(north * 100.0),
        vy=clip_int16(east * 100.0),
        vz=clip_int16(down * 100.0),
        h_acc=clip_uint16(gps.eph_m * 1000.0),
        v_acc=clip_uint16(gps.epv_m * 1000.0),
        vel_acc=round(VELOCITY_STD_M_S * 100.0),
        update_rate=0,
        uas_id=b"",
        flight_state=UTM_AIRBORNE if flying else UTM_UNKNOWN,
        flags=UTM_FLAGS | UTM_RELATIVE_ALTITUDE if flying else UTM_FLAGS,
    )


MOTION: Final[dict[int, Builder]] = {
    m.IDS[kind]: builder
    for kind, builder in (
        (m.Odometry, odometry),
        (m.ActuatorOutputStatus, actuator_output_status),
        (m.EscStatus, esc_status),
        (m.EscInfo, esc_info),
    )
}
