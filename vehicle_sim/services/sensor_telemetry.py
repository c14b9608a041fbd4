"""Builders of what sensors, battery, motors and estimator report."""

from __future__ import annotations

import math
from typing import Final

from vehicle_sim.autopilot.interface import Vehicle
from vehicle_sim.wire import messages as m
from vehicle_sim.wire.ids import EstimatorFlag, Sensor

from .profile import Profile
from .units import (
    INT16_MAX,
    UINT16_MAX,
    boot_ms,
    clip_int16,
    clip_uint16,
    degrees_e7,
    millimetres,
    usec,
)

BOOT: Final = 1  # MAV_STATE
FIX_NONE: Final = 1
FIX_3D: Final = 3
SATELLITES: Final = 12
GPS_EPH_M: Final = 0.9
SEA_LEVEL_HPA: Final = 1013.25


def _pressure_hpa(alt_amsl_m: float) -> float:
    """ISA troposphere: p = p0 (1 - h / 44330.77 m)^5.25588."""
    return SEA_LEVEL_HPA * math.pow(max(0.0, 1.0 - alt_amsl_m / 44330.77), 5.25588)


_PRESENT: Final = (
    Sensor.GYRO_3D
    | Sensor.ACCEL_3D
    | Sensor.MAG_3D
    | Sensor.ABSOLUTE_PRESSURE
    | Sensor.GPS
    | Sensor.ANGULAR_RATE_CONTROL
    | Sensor.ATTITUDE_STABILIZATION
    | Sensor.YAW_POSITION
    | Sensor.Z_ALTITUDE_CONTROL
    | Sensor.XY_POSITION_CONTROL
    | Sensor.MOTOR_OUTPUTS
    | Sensor.AHRS
    | Sensor.BATTERY
    | Sensor.PREARM_CHECK
)


def sys_status(vehicle: Vehicle, profile: Profile) -> m.SysStatus:
    power = vehicle.power
    healthy = _PRESENT
    if vehicle.system_status <= BOOT:
        # The estimator has not settled: clients take these bits for "position is good".
        healthy &= ~(Sensor.GPS | Sensor.AHRS | Sensor.XY_POSITION_CONTROL)
    if not vehicle.estimate.gps_ok:
        healthy &= ~(Sensor.GPS | Sensor.XY_POSITION_CONTROL)
    if not (vehicle.armable or vehicle.armed):
        healthy &= ~Sensor.PREARM_CHECK
    return m.SysStatus(
        onboard_control_sensors_present=_PRESENT,
        onboard_control_sensors_enabled=_PRESENT,
        onboard_control_sensors_health=healthy,
        load=200,
        voltage_battery=clip_uint16(power.voltage_v * 1000.0),
        current_battery=clip_int16(power.current_a * 100.0),
        drop_rate_comm=0,
        errors_comm=0,
        errors_count1=0,
        errors_count2=0,
        errors_count3=0,
        errors_count4=0,
        battery_remaining=power.remaining_pct,
    )


def gps_raw_int(vehicle: Vehicle, profile: Profile) -> m.GpsRawInt:
    estimate = vehicle.estimate
    north, east, _ = estimate.v_ned
    return m.GpsRawInt(
        time_usec=usec(vehicle),
        lat=degrees_e7(estimate.lat_deg),
        lon=degrees_e7(estimate.lon_deg),
        alt=millimetres(estimate.alt_amsl_m),
        eph=round(GPS_EPH_M * 100.0),
        epv=round(GPS_EPH_M * 150.0),
        vel=clip_uint16(math.sqrt(north * north + east * east) * 100.0),
        cog=round(math.degrees(math.atan2(east, north)) * 100.0) % 36000,
        fix_type=FIX_3D if estimate.gps_ok else FIX_NONE,
        satellites_visible=SATELLITES if estimate.gps_ok else 0,
        alt_ellipsoid=millimetres(estimate.alt_amsl_m),
        h_acc=millimetres(GPS_EPH_M),
        v_acc=millimetres(GPS_EPH_M * 1.5),
        vel_acc=100,
    )


def battery_status(vehicle: Vehicle, profile: Profile) -> m.BatteryStatus:
    power = vehicle.power
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


def estimator_flags(vehicle: Vehicle) -> EstimatorFlag:
    flags = EstimatorFlag.ATTITUDE | EstimatorFlag.VELOCITY_VERT | EstimatorFlag.POS_VERT_ABS
    if vehicle.origin is None or not vehicle.estimate.gps_ok:
        return flags | EstimatorFlag.CONST_POS_MODE
    return (
        flags
        | EstimatorFlag.VELOCITY_HORIZ
        | EstimatorFlag.POS_HORIZ_REL
        | EstimatorFlag.POS_HORIZ_ABS
        | EstimatorFlag.POS_VERT_AGL
        | EstimatorFlag.PRED_POS_HORIZ_REL
        | EstimatorFlag.PRED_POS_HORIZ_ABS
    )


def estimator_status(vehicle: Vehicle, profile: Profile) -> m.EstimatorStatus:
    return m.EstimatorStatus(
        time_usec=usec(vehicle),
        vel_ratio=0.1,
        pos_horiz_ratio=0.1,
        pos_vert_ratio=0.1,
        mag_ratio=0.1,
        hagl_ratio=0.1,
        tas_ratio=0.0,
        pos_horiz_accuracy=GPS_EPH_M,
        pos_vert_accuracy=GPS_EPH_M * 1.5,
        flags=estimator_flags(vehicle),
    )


def ekf_status_report(vehicle: Vehicle, profile: Profile) -> m.EkfStatusReport:
    return m.EkfStatusReport(
        velocity_variance=0.1,
        pos_horiz_variance=0.1,
        pos_vert_variance=0.1,
        compass_variance=0.1,
        terrain_alt_variance=0.0,
        flags=estimator_flags(vehicle),
    )


def servo_output_raw(vehicle: Vehicle, profile: Profile) -> m.ServoOutputRaw:
    first, second, third, fourth = (
        round(1000.0 + 1000.0 * output) for output in vehicle.motor_outputs
    )
    return m.ServoOutputRaw(
        usec(vehicle) & 0xFFFFFFFF, first, second, third, fourth, 0, 0, 0, 0, port=0
    )


def highres_imu(vehicle: Vehicle, profile: Profile) -> m.HighresImu:
    estimate = vehicle.estimate
    return m.HighresImu(
        usec(vehicle),
        *estimate.accel_frd,
        *estimate.rates_frd,
        xmag=0.21,
        ymag=0.0,
        zmag=0.42,
        abs_pressure=_pressure_hpa(estimate.alt_amsl_m),
        diff_pressure=0.0,
        pressure_alt=estimate.alt_amsl_m,
        temperature=25.0,
        fields_updated=0x3F | 0x200 | 0x800,  # acceleration, rates, pressure and its height
    )


def scaled_pressure(vehicle: Vehicle, profile: Profile) -> m.ScaledPressure:
    return m.ScaledPressure(
        boot_ms(vehicle), _pressure_hpa(vehicle.estimate.alt_amsl_m), 0.0, temperature=2500
    )
