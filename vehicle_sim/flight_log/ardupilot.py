"""What ArduCopter logs of a flight: records, fields and units as its 4.6 has them.

A record's fields are fixed, so those that this vehicle has no true value for are NaN, or 0 where
the field is an integer.  Frames: NED with its origin at the EKF origin, body FRD, degrees.
"""

from __future__ import annotations

import math
from typing import Final

from vehicle_sim.autopilot.interface import GPS_HDOP, Geodetic, Landed
from vehicle_sim.flight_log.ardupilot_records import (
    ATT,
    BAT,
    CTUN,
    EV,
    GPS,
    IMU,
    MAG,
    MODE,
    MSG,
    ORGN,
    PARM,
    POS,
    PSC,
    RATE,
    RCOU,
    RECORDS,
    VER,
    XKF1,
)
from vehicle_sim.flight_log.dataflash import definitions
from vehicle_sim.flight_log.snapshot import Head, Parameter, Snapshot, VehicleStatus
from vehicle_sim.numerics.vectors import Quat, Vec3, euler_rad

NAN: Final = math.nan
UNSET: Final[Vec3] = (NAN, NAN, NAN)
SELDOM: Final = 5  # samples between two records of what changes slowly
GPS_EPOCH_S: Final = 315_964_800  # Unix time of the GPS time's zero
LEAP_S: Final = 18
WEEK_MS: Final = 7 * 86_400_000
SITL_BOARD: Final = 3
COPTER: Final = 2
QUALITY_OFFICIAL: Final = 255  # FIRMWARE_VERSION_TYPE
EKF3: Final = 3
FIX_3D: Final = 3  # GPS_FIX_TYPE
NO_HDOP: Final = 9999
EV_ARMED, EV_DISARMED, EV_LANDED, EV_NOT_LANDED = 10, 11, 18, 28
ORIGIN, HOME = 0, 1  # ORGN.Type


class ArdupilotFormat:
    """A `Format`: DataFlash."""

    def __init__(self) -> None:
        self._rate_hz = 0

    def head(self, head: Head, now: Snapshot) -> bytes:
        self._rate_hz = 1_000_000 // head.dt_us
        time_us = now.time_us
        major, minor, patch = (head.flight_sw_version >> shift & 0xFF for shift in (24, 16, 8))
        version = f"ArduCopter V{major}.{minor}.{patch}"
        release = (major, minor, patch, QUALITY_OFFICIAL, 0, version.encode("ascii"), 0, COPTER)
        return b"".join(
            (
                definitions(time_us, RECORDS),
                *(self.parameter(time_us, parameter) for parameter in head.parameters),
                VER.data(time_us, SITL_BOARD, 0, *release, 0, 0, 0),
                self.text(time_us, 6, version),
                self.text(time_us, 6, "Frame: QUAD/X"),
                _mode(now),
                *_places(now, None),
                EV.data(time_us, EV_ARMED),
            )
        )

    def sample(self, now: Snapshot, turn: int) -> bytes:
        frequent = (
            _attitude(now),
            _position(now),
            _ekf(now),
            _tuning(now),
            _imu(now, self._rate_hz),
            _magnetometer(now),
            _rates(now),
            _outputs(now),
            *_control(now),
        )
        seldom = (_gps(now), _battery(now)) if turn % SELDOM == 0 else ()
        return b"".join((*frequent, *seldom))

    def change(self, now: Snapshot, before: VehicleStatus) -> bytes:
        status = now.status
        changed = b"".join(_places(now, before))
        if status.custom_mode != before.custom_mode:
            changed += _mode(now)
        if _on_ground(status) != _on_ground(before):
            event = EV_LANDED if _on_ground(status) else EV_NOT_LANDED
            changed += EV.data(now.time_us, event)
        if status.armed != before.armed:
            changed += EV.data(now.time_us, EV_ARMED if status.armed else EV_DISARMED)
        return changed

    def text(self, time_us: int, severity: int, text: str) -> bytes:
        return MSG.data(time_us, text.encode("ascii", "replace"))

    def parameter(self, time_us: int, parameter: Parameter) -> bytes:
        name = parameter.name.encode("ascii")
        return PARM.data(time_us, name, parameter.value, parameter.default)


def _on_ground(status: VehicleStatus) -> bool:
    return status.landed is Landed.ON_GROUND


def _mode(now: Snapshot) -> bytes:
    number = now.status.custom_mode & 0xFF
    return MODE.data(now.time_us, number, number, 0)  # the reason is not known here


def _places(now: Snapshot, before: VehicleStatus | None) -> list[bytes]:
    """Origin and home, those that are new."""
    known = (
        (ORIGIN, now.status.origin, before and before.origin),
        (HOME, now.status.home, before and before.home),
    )
    return [
        ORGN.data(now.time_us, kind, *_e7(where), round(where.alt_amsl_m * 100.0))
        for kind, where, old in known
        if where is not None and where != old
    ]


def _e7(where: Geodetic) -> tuple[int, int]:
    return (round(where.lat_deg * 1e7), round(where.lon_deg * 1e7))


def _euler_deg(q_ned_from_frd: Quat) -> Vec3:
    """Roll, pitch in -180 .. 180, yaw in 0 .. 360."""
    roll, pitch, yaw = map(math.degrees, euler_rad(q_ned_from_frd))
    return (roll, pitch, yaw % 360.0)


def _attitude(now: Snapshot) -> bytes:
    roll, pitch, yaw = _euler_deg(now.estimate.q_ned_from_frd)
    goal = now.attitude_goal
    wanted = UNSET if goal is None else _euler_deg(goal.q_ned_from_frd)
    return ATT.data(now.time_us, wanted[0], roll, wanted[1], pitch, wanted[2], yaw, EKF3)


def _rates(now: Snapshot) -> bytes:
    """Degrees per second; what the controllers put out is not known axis by axis."""
    goal = now.attitude_goal
    wanted = UNSET if goal is None else goal.rates_frd
    axes = (
        value
        for aim, rate in zip(wanted, now.estimate.rates_frd, strict=True)
        for value in (math.degrees(aim), math.degrees(rate), NAN)
    )
    return RATE.data(now.time_us, *axes, NAN, NAN, NAN if goal is None else goal.thrust, NAN)


def _position(now: Snapshot) -> bytes:
    estimate = now.estimate
    if now.status.origin is None:
        return b""
    where = _e7(Geodetic(estimate.lat_deg, estimate.lon_deg, estimate.alt_amsl_m))
    heights = (estimate.alt_amsl_m, estimate.alt_rel_m, -estimate.pos_ned[2])
    return POS.data(now.time_us, *where, *heights)


def _gps(now: Snapshot) -> bytes:
    """As the receiver says it; it is no compass, so its yaw is 0."""
    gps = now.readings.gps
    north, east, down = gps.v_ned
    gps_ms = now.unix_us // 1000 - (GPS_EPOCH_S - LEAP_S) * 1000
    week, of_week_ms = divmod(gps_ms, WEEK_MS) if gps_ms > 0 else (0, 0)
    return GPS.data(
        now.time_us,
        0,
        gps.fix_type,
        of_week_ms,
        week,
        gps.satellites,
        round(GPS_HDOP * 100.0) if gps.fix_type >= FIX_3D else NO_HDOP,
        *_e7(Geodetic(gps.lat_deg, gps.lon_deg, gps.alt_amsl_m)),
        round(gps.alt_amsl_m * 100.0),
        math.sqrt(north * north + east * east),
        math.degrees(math.atan2(east, north)) % 360.0,
        down,
        0.0,
        1,
    )


def _battery(now: Snapshot) -> bytes:
    power = now.power
    used = (power.voltage_v, NAN, power.current_a, power.consumed_mah, NAN)
    remaining = max(0, min(100, power.remaining_pct))
    return BAT.data(now.time_us, 0, *used, 0, NAN, remaining, 1, 0)


def _ekf(now: Snapshot) -> bytes:
    estimate = now.estimate
    roll, pitch, yaw = _euler_deg(estimate.q_ned_from_frd)
    origin = now.status.origin
    origin_cm = round(origin.alt_amsl_m * 100.0) if origin is not None else 0
    return XKF1.data(
        now.time_us,
        0,
        round(roll * 100.0),
        round(pitch * 100.0),
        round(yaw * 100.0),
        *estimate.v_ned,
        estimate.v_ned[2],
        *estimate.pos_ned,
        *(0, 0, 0),
        origin_cm,
    )


def _tuning(now: Snapshot) -> bytes:
    estimate, target, home_ned = now.estimate, now.target, now.home_pos_ned
    wanted_up = NAN
    if target.pos_ned is not None and home_ned is not None:
        wanted_up = home_ned[2] - target.pos_ned[2]
    home = now.status.home
    ground_m = home.alt_amsl_m if home is not None else 0.0
    pressure_up_m = now.readings.pressure_alt_amsl_m - ground_m
    throttle = sum(now.motor_outputs) / len(now.motor_outputs)
    wanted_climb = -target.v_ned[2] if target.v_ned is not None else 0.0
    return CTUN.data(
        now.time_us,
        *(NAN, NAN, throttle, NAN),
        wanted_up,
        estimate.alt_rel_m,
        round(pressure_up_m * 100.0),
        *(NAN, NAN, NAN),
        _int16(wanted_climb * 100.0),
        _int16(-estimate.v_ned[2] * 100.0),
    )


def _int16(value: float) -> int:
    return max(-32767, min(32767, round(value)))


def _imu(now: Snapshot, rate_hz: int) -> bytes:
    sensed = (*now.readings.gyro_frd, *now.readings.accel_frd)
    return IMU.data(now.time_us, 0, *sensed, 0, 0, NAN, 1, 1, rate_hz, rate_hz)


def _magnetometer(now: Snapshot) -> bytes:
    """Milligauss; offsets are 0, for what is logged is corrected already."""
    field_mgauss = (_int16(gauss * 1000.0) for gauss in now.readings.mag_frd)
    healthy = now.health.mag_ok
    sampled_us = now.time_us & 0xFFFFFFFF
    return MAG.data(now.time_us, 0, *field_mgauss, *(0,) * 6, healthy, sampled_us)


def _outputs(now: Snapshot) -> bytes:
    """Pulses in microseconds, as in SERVO_OUTPUT_RAW."""
    pulses = (round(1000.0 + 1000.0 * output) for output in now.motor_outputs)
    return RCOU.data(now.time_us, *pulses, *(0,) * 10)


def _control(now: Snapshot) -> list[bytes]:
    """The position controller, an axis each: target and estimate of place and speed."""
    estimate, target = now.estimate, now.target
    axes = zip(
        PSC,
        target.pos_ned or UNSET,
        estimate.pos_ned,
        target.v_ned or UNSET,
        estimate.v_ned,
        strict=True,
    )
    return [
        record.data(now.time_us, wanted, place, NAN, wanted_speed, speed, NAN, NAN, NAN)
        for record, wanted, place, wanted_speed, speed in axes
    ]
