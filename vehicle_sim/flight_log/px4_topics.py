"""What PX4 logs of a flight: topics, fields and units as its 1.14 has them.

Fields that this vehicle has no true value for are left out; ULog describes itself, so readers
see that they are not there.  Frames: local NED with its origin at the EKF origin, body FRD.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Final, NamedTuple

from vehicle_sim.autopilot.interface import Landed
from vehicle_sim.flight_log.snapshot import Snapshot, Values
from vehicle_sim.flight_log.ulog import Topic, UlogField
from vehicle_sim.numerics.vectors import Vec3

NAN: Final = math.nan
UNSET: Final[Vec3] = (NAN, NAN, NAN)
NOTHING: Final[Values] = ()

ARMED, DISARMED = 2, 1  # vehicle_status.arming_state
ROTARY_WING: Final = 1
QUADROTOR: Final = 2  # MAV_TYPE
CRITICAL: Final = 5  # MAV_STATE: and what is worse
NAV_STATES: Final = {
    (1, 0): 0,  # MANUAL
    (2, 0): 1,  # ALTCTL
    (3, 0): 2,  # POSCTL
    (3, 1): 21,  # ORBIT
    (4, 2): 17,  # AUTO_TAKEOFF
    (4, 3): 4,  # AUTO_LOITER
    (4, 4): 3,  # AUTO_MISSION
    (4, 5): 5,  # AUTO_RTL
    (4, 6): 18,  # AUTO_LAND
    (4, 8): 19,  # AUTO_FOLLOW_TARGET
    (4, 9): 20,  # AUTO_PRECLAND
    (5, 0): 10,  # ACRO
    (6, 0): 14,  # OFFBOARD
    (7, 0): 15,  # STAB
}
"""vehicle_status.nav_state by main and sub mode of HEARTBEAT.custom_mode."""
NAV_TERMINATION: Final = 13
NAV_UNKNOWN: Final = 255

MOTORS_MAX: Final = 12
OUTPUTS_MAX: Final = 16


def _vehicle_status(now: Snapshot, system: int) -> Values:
    status = now.status
    mode = (status.custom_mode >> 16 & 0xFF, status.custom_mode >> 24 & 0xFF)
    return (
        now.time_us,
        now.armed_us if status.armed else 0,
        ARMED if status.armed else DISARMED,
        NAV_STATES.get(mode, NAV_UNKNOWN),
        ROTARY_WING,
        status.system_status >= CRITICAL,
        QUADROTOR,
        system,
        1,
    )


def _land_detected(now: Snapshot, system: int) -> Values:
    landed = now.status.landed is Landed.ON_GROUND
    return (now.time_us, landed, landed, landed)


def _home_position(now: Snapshot, system: int) -> Values:
    home, home_ned = now.status.home, now.home_pos_ned
    if home is None or home_ned is None:
        return NOTHING
    return (now.time_us, home.lat_deg, home.lon_deg, home.alt_amsl_m, *home_ned, True, True, True)


def _attitude(now: Snapshot, system: int) -> Values:
    return (now.time_us, now.time_us, *now.estimate.q_ned_from_frd)


def _angular_velocity(now: Snapshot, system: int) -> Values:
    return (now.time_us, now.time_us, *now.estimate.rates_frd)


def _sensor_combined(now: Snapshot, system: int) -> Values:
    readings = now.readings
    return (now.time_us, *readings.gyro_frd, 0, *readings.accel_frd)


def _magnetometer(now: Snapshot, system: int) -> Values:
    return (now.time_us, now.time_us, *now.readings.mag_frd)


def _air_data(now: Snapshot, system: int) -> Values:
    return (now.time_us, now.time_us, now.readings.pressure_alt_amsl_m)


def _attitude_setpoint(now: Snapshot, system: int) -> Values:
    goal = now.attitude_goal
    if goal is None:
        return NOTHING
    return (now.time_us, *goal.q_ned_from_frd, 0.0, 0.0, -goal.thrust)


def _rates_setpoint(now: Snapshot, system: int) -> Values:
    goal = now.attitude_goal
    if goal is None:
        return NOTHING
    return (now.time_us, *goal.rates_frd, 0.0, 0.0, -goal.thrust)


def _local_position(now: Snapshot, system: int) -> Values:
    estimate, health, origin = now.estimate, now.health, now.status.origin
    known = origin is not None
    reference = (origin.lat_deg, origin.lon_deg, origin.alt_amsl_m) if origin else UNSET
    return (
        now.time_us,
        now.time_us,
        *reference[:2],
        *estimate.pos_ned,
        *estimate.v_ned,
        estimate.v_ned[2],
        _half_turn(estimate.heading_rad),
        reference[2],
        health.accuracy_m,
        health.epv_m,
        *(health.position_ok, health.height_ok, health.velocity_ok, health.height_ok),
        *(known, known, health.dead_s > 0.0),
    )


def _global_position(now: Snapshot, system: int) -> Values:
    if now.status.origin is None:
        return NOTHING
    estimate = now.estimate
    where = (estimate.lat_deg, estimate.lon_deg, estimate.alt_amsl_m)
    accuracy = (now.health.accuracy_m, now.health.epv_m, now.health.dead_s > 0.0)
    return (now.time_us, now.time_us, *where, *accuracy)


def _gps_position(now: Snapshot, system: int) -> Values:
    """As the receiver says it, in the units of GPS_RAW_INT."""
    gps = now.readings.gps
    north, east, _ = gps.v_ned
    height_mm = round(gps.alt_amsl_m * 1000.0)
    return (
        now.time_us,
        now.unix_us,
        round(gps.lat_deg * 1e7),
        round(gps.lon_deg * 1e7),
        height_mm,
        height_mm,
        gps.eph_m,
        gps.epv_m,
        math.sqrt(north * north + east * east),
        *gps.v_ned,
        math.atan2(east, north),
        gps.fix_type,
        gps.satellites,
        True,
    )


def _trajectory_setpoint(now: Snapshot, system: int) -> Values:
    target = now.target
    yaw = NAN if target.yaw_rad is None else target.yaw_rad
    pos_ned, v_ned = target.pos_ned or UNSET, target.v_ned or UNSET
    return (now.time_us, *pos_ned, *v_ned, *UNSET, *UNSET, yaw, NAN)


def _local_position_setpoint(now: Snapshot, system: int) -> Values:
    target = now.target
    yaw = NAN if target.yaw_rad is None else target.yaw_rad
    return (now.time_us, *(target.pos_ned or UNSET), yaw, NAN, *(target.v_ned or UNSET))


def _motors(now: Snapshot, system: int) -> Values:
    outputs = now.motor_outputs if now.status.armed else ()  # NaN means stopped
    return (now.time_us, now.time_us, *outputs, *(NAN,) * (MOTORS_MAX - len(outputs)))


def _outputs(now: Snapshot, system: int) -> Values:
    """Pulses in microseconds, as in SERVO_OUTPUT_RAW."""
    pulses = tuple(1000.0 + 1000.0 * output for output in now.motor_outputs)
    return (now.time_us, len(pulses), *pulses, *(0.0,) * (OUTPUTS_MAX - len(pulses)))


def _battery(now: Snapshot, system: int) -> Values:
    power = now.power
    used = (power.voltage_v, power.current_a, power.consumed_mah, power.remaining_pct / 100.0)
    return (now.time_us, *used, True, 1)


def _half_turn(angle_rad: float) -> float:
    """-pi .. pi of an angle in 0 .. 2 pi."""
    return angle_rad - 2.0 * math.pi if angle_rad > math.pi else angle_rad


class Row(NamedTuple):
    topic: Topic
    every: int  # samples; the seldom ones are also written when the status changes
    values: Callable[[Snapshot, int], Values]


_TIME: Final = UlogField("uint64_t", "timestamp")
_SAMPLED: Final = UlogField("uint64_t", "timestamp_sample")


def _fields(kind: str, *names: str) -> tuple[UlogField, ...]:
    return tuple(UlogField(kind, name) for name in names)


# fmt: off
_TABLE: Final = (
    ("vehicle_status", 5, _vehicle_status, (
        _TIME, UlogField("uint64_t", "armed_time"),
        *_fields("uint8_t", "arming_state", "nav_state", "vehicle_type"),
        UlogField("bool", "failsafe"),
        *_fields("uint8_t", "system_type", "system_id", "component_id"))),
    ("vehicle_land_detected", 5, _land_detected, (
        _TIME, *_fields("bool", "ground_contact", "maybe_landed", "landed"))),
    ("home_position", 50, _home_position, (
        _TIME, *_fields("double", "lat", "lon"), *_fields("float", "alt", "x", "y", "z"),
        *_fields("bool", "valid_alt", "valid_hpos", "valid_lpos"))),
    ("vehicle_attitude", 1, _attitude, (_TIME, _SAMPLED, UlogField("float", "q", 4))),
    ("vehicle_angular_velocity", 1, _angular_velocity, (
        _TIME, _SAMPLED, UlogField("float", "xyz", 3))),
    ("sensor_combined", 1, _sensor_combined, (
        _TIME, UlogField("float", "gyro_rad", 3),
        UlogField("int32_t", "accelerometer_timestamp_relative"),
        UlogField("float", "accelerometer_m_s2", 3))),
    ("vehicle_magnetometer", 1, _magnetometer, (
        _TIME, _SAMPLED, UlogField("float", "magnetometer_ga", 3))),
    ("vehicle_air_data", 1, _air_data, (_TIME, _SAMPLED, UlogField("float", "baro_alt_meter"))),
    ("vehicle_attitude_setpoint", 1, _attitude_setpoint, (
        _TIME, UlogField("float", "q_d", 4), UlogField("float", "thrust_body", 3))),
    ("vehicle_rates_setpoint", 1, _rates_setpoint, (
        _TIME, *_fields("float", "roll", "pitch", "yaw"), UlogField("float", "thrust_body", 3))),
    ("vehicle_local_position", 1, _local_position, (
        _TIME, _SAMPLED, *_fields("double", "ref_lat", "ref_lon"),
        *_fields("float", "x", "y", "z", "vx", "vy", "vz", "z_deriv", "heading", "ref_alt", "eph",
                 "epv"),
        *_fields("bool", "xy_valid", "z_valid", "v_xy_valid", "v_z_valid", "xy_global",
                 "z_global", "dead_reckoning"))),
    ("vehicle_global_position", 1, _global_position, (
        _TIME, _SAMPLED, *_fields("double", "lat", "lon"), *_fields("float", "alt", "eph", "epv"),
        UlogField("bool", "dead_reckoning"))),
    ("vehicle_gps_position", 5, _gps_position, (
        _TIME, UlogField("uint64_t", "time_utc_usec"),
        *_fields("int32_t", "lat", "lon", "alt", "alt_ellipsoid"),
        *_fields("float", "eph", "epv", "vel_m_s", "vel_n_m_s", "vel_e_m_s", "vel_d_m_s",
                 "cog_rad"),
        *_fields("uint8_t", "fix_type", "satellites_used"), UlogField("bool", "vel_ned_valid"))),
    ("trajectory_setpoint", 1, _trajectory_setpoint, (
        _TIME, *(UlogField("float", name, 3) for name in ("position", "velocity", "acceleration",
                                                      "jerk")),
        *_fields("float", "yaw", "yawspeed"))),
    ("vehicle_local_position_setpoint", 1, _local_position_setpoint, (
        _TIME, *_fields("float", "x", "y", "z", "yaw", "yawspeed", "vx", "vy", "vz"))),
    ("actuator_motors", 1, _motors, (_TIME, _SAMPLED, UlogField("float", "control", MOTORS_MAX))),
    ("actuator_outputs", 1, _outputs, (
        _TIME, UlogField("uint32_t", "noutputs"), UlogField("float", "output", OUTPUTS_MAX))),
    ("battery_status", 5, _battery, (
        _TIME, *_fields("float", "voltage_v", "current_a", "discharged_mah", "remaining"),
        UlogField("bool", "connected"), UlogField("uint8_t", "id"))),
)
# fmt: on

ROWS: Final = tuple(
    Row(Topic(number, name, fields), every, values)
    for number, (name, every, values, fields) in enumerate(_TABLE)
)
