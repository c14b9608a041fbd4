"""Builders of what sensors, battery, motors and estimator report."""

from __future__ import annotations

import math
from typing import Final

from vehicle_sim.autopilot.interface import GPS_HDOP, Readings, Vehicle
from vehicle_sim.services.profile import Profile
from vehicle_sim.services.units import (
    INT16_MAX,
    UINT16_MAX,
    boot_ms,
    clip_int16,
    clip_uint16,
    degrees_e7,
    millimetres,
    usec,
)
from vehicle_sim.wire import messages as m
from vehicle_sim.wire.ids import EkfFlag, EstimatorFlag

FIX_3D: Final = 3
GPS_VDOP: Final = 1.1
GPS_VEL_ACC_MM_S: Final = 100
HEIGHT_ACCURACY_M: Final = 0.3
SEA_LEVEL_HPA: Final = 1013.25
GRAVITY_M_S2: Final = 9.80665
BOARD_DEG_C: Final = 25.0  # of everything that has a temperature


def _pressure_hpa(alt_amsl_m: float) -> float:
    """ISA troposphere: p = p0 (1 - h / 44330.77 m)^5.25588."""
    return SEA_LEVEL_HPA * math.pow(max(0.0, 1.0 - alt_amsl_m / 44330.77), 5.25588)


def gps_raw_int(vehicle: Vehicle, profile: Profile) -> m.GpsRawInt:
    """What the receiver says, not the estimate; without a fix the last position stays."""
    gps = vehicle.readings.gps
    north, east, _ = gps.v_ned
    fixed = gps.fix_type >= FIX_3D
    speed = math.sqrt(north * north + east * east)
    return m.GpsRawInt(
        time_usec=usec(vehicle),
        lat=degrees_e7(gps.lat_deg),
        lon=degrees_e7(gps.lon_deg),
        alt=millimetres(gps.alt_amsl_m),
        eph=round(GPS_HDOP * 100.0) if fixed else UINT16_MAX,
        epv=round(GPS_VDOP * 100.0) if fixed else UINT16_MAX,
        vel=clip_uint16(speed * 100.0) if fixed else UINT16_MAX,
        cog=round(math.degrees(math.atan2(east, north)) * 100.0) % 36000 if fixed else UINT16_MAX,
        fix_type=gps.fix_type,
        satellites_visible=gps.satellites,
        alt_ellipsoid=millimetres(gps.alt_amsl_m),
        h_acc=millimetres(gps.eph_m) if fixed else 0,
        v_acc=millimetres(gps.epv_m) if fixed else 0,
        vel_acc=GPS_VEL_ACC_MM_S if fixed else 0,
    )


def battery_status(vehicle: Vehicle, profile: Profile) -> m.BatteryStatus | None:
    """ArduPilot sends none without a battery monitor."""
    power = vehicle.power
    if power.remaining_pct < 0:
        return None
    return m.BatteryStatus(
        current_consumed=round(power.consumed_mah),
        energy_consumed=-1,
        temperature=INT16_MAX,
        # One reading for the whole pack; the rest of the cells is "not present".
        voltages=(clip_uint16(power.voltage_v * 1000.0), *(UINT16_MAX,) * 9),
        current_battery=clip_int16(power.current_a * 100.0),
        id=0,
        battery_function=1,
        type=1,
        battery_remaining=power.remaining_pct,
    )


_HORIZONTAL: Final = (
    EstimatorFlag.POS_HORIZ_REL
    | EstimatorFlag.POS_HORIZ_ABS
    | EstimatorFlag.PRED_POS_HORIZ_REL
    | EstimatorFlag.PRED_POS_HORIZ_ABS
)


def estimator_flags(vehicle: Vehicle) -> EstimatorFlag:
    """The bits that both autopilots have; without a range finder none is above ground."""
    health = vehicle.health
    flags = EstimatorFlag(0)
    if health.attitude_ok:
        flags |= EstimatorFlag.ATTITUDE
    if health.height_ok:
        flags |= EstimatorFlag.VELOCITY_VERT | EstimatorFlag.POS_VERT_ABS
    if health.velocity_ok:
        flags |= EstimatorFlag.VELOCITY_HORIZ
    return flags | (_HORIZONTAL if health.position_ok else EstimatorFlag.CONST_POS_MODE)


def _glitching(vehicle: Vehicle) -> bool:
    """There are fixes, and they are not believed."""
    health = vehicle.health
    return health.attitude_ok and health.gps_fix >= FIX_3D and not health.gps_ok


def estimator_status(vehicle: Vehicle, profile: Profile) -> m.EstimatorStatus:
    health = vehicle.health
    glitch = EstimatorFlag.GPS_GLITCH if _glitching(vehicle) else EstimatorFlag(0)
    return m.EstimatorStatus(
        time_usec=usec(vehicle),
        vel_ratio=health.vel_ratio,
        pos_horiz_ratio=health.pos_ratio,
        pos_vert_ratio=health.height_ratio,
        mag_ratio=health.mag_ratio,
        hagl_ratio=0.0,
        tas_ratio=0.0,
        pos_horiz_accuracy=health.accuracy_m,
        pos_vert_accuracy=HEIGHT_ACCURACY_M,
        flags=estimator_flags(vehicle) | glitch,
    )


def ekf_status_report(vehicle: Vehicle, profile: Profile) -> m.EkfStatusReport:
    health = vehicle.health
    flags = int(estimator_flags(vehicle))
    if not health.attitude_ok:
        flags |= EkfFlag.UNINITIALIZED
    if _glitching(vehicle):
        flags |= EkfFlag.GPS_GLITCHING
    return m.EkfStatusReport(
        velocity_variance=health.vel_ratio,
        pos_horiz_variance=health.pos_ratio,
        pos_vert_variance=health.height_ratio,
        compass_variance=health.mag_ratio,
        terrain_alt_variance=0.0,
        flags=flags,
    )


def servo_output_raw(vehicle: Vehicle, profile: Profile) -> m.ServoOutputRaw:
    first, second, third, fourth = (
        round(1000.0 + 1000.0 * output) for output in vehicle.motor_outputs
    )
    others = vehicle.servos_us
    time_us = usec(vehicle) & 0xFFFFFFFF
    return m.ServoOutputRaw._make(
        (time_us, first, second, third, fourth, *others[4:8], 0, *others[8:])
    )


def highres_imu(vehicle: Vehicle, profile: Profile) -> m.HighresImu:
    """SI units and gauss."""
    readings = vehicle.readings
    return m.HighresImu(
        usec(vehicle),
        *readings.accel_frd,
        *readings.gyro_frd,
        *readings.mag_frd,
        abs_pressure=_pressure_hpa(readings.pressure_alt_amsl_m),
        diff_pressure=0.0,
        pressure_alt=readings.pressure_alt_amsl_m,
        temperature=BOARD_DEG_C,
        fields_updated=0xBFF,  # all but the differential pressure and the temperature
    )


_Nine = tuple[int, int, int, int, int, int, int, int, int]


def _milli(readings: Readings) -> _Nine:
    """Specific force in 1/1000 of gravity, rates in mrad/s, field in milligauss."""
    ax, ay, az = readings.accel_frd
    gx, gy, gz = readings.gyro_frd
    mx, my, mz = readings.mag_frd
    milli_g = 1000.0 / GRAVITY_M_S2
    return (
        *(clip_int16(ax * milli_g), clip_int16(ay * milli_g), clip_int16(az * milli_g)),
        *(clip_int16(gx * 1000.0), clip_int16(gy * 1000.0), clip_int16(gz * 1000.0)),
        *(clip_int16(mx * 1000.0), clip_int16(my * 1000.0), clip_int16(mz * 1000.0)),
    )


def scaled_imu(vehicle: Vehicle, profile: Profile) -> m.ScaledImu:
    return m.ScaledImu(
        boot_ms(vehicle), *_milli(vehicle.readings), temperature=round(BOARD_DEG_C * 100.0)
    )


def raw_imu(vehicle: Vehicle, profile: Profile) -> m.RawImu:
    """As ArduPilot fills it, which scales it like SCALED_IMU."""
    return m.RawImu(
        usec(vehicle), *_milli(vehicle.readings), temperature=round(BOARD_DEG_C * 100.0)
    )


def scaled_pressure(vehicle: Vehicle, profile: Profile) -> m.ScaledPressure:
    pressure_hpa = _pressure_hpa(vehicle.readings.pressure_alt_amsl_m)
    return m.ScaledPressure(
        boot_ms(vehicle), pressure_hpa, 0.0, temperature=round(BOARD_DEG_C * 100.0)
    )
