"""What sensors, battery, motors and estimator report.

One named tuple a message, fields in wire order, values as MAVLink has them (units and frames are
the dialect's).  `char[n]` and `uint8_t[n]` are `bytes`, shorter ones are padded with zeros.
"""

from __future__ import annotations

from typing import NamedTuple


class GpsRawInt(NamedTuple):
    time_usec: int
    lat: int
    lon: int
    alt: int
    eph: int
    epv: int
    vel: int
    cog: int
    fix_type: int
    satellites_visible: int
    alt_ellipsoid: int = 0
    h_acc: int = 0
    v_acc: int = 0
    vel_acc: int = 0
    hdg_acc: int = 0
    yaw: int = 0


class ScaledPressure(NamedTuple):
    time_boot_ms: int
    press_abs: float
    press_diff: float
    temperature: int
    temperature_press_diff: int = 0


class ScaledImu(NamedTuple):
    time_boot_ms: int
    xacc: int
    yacc: int
    zacc: int
    xgyro: int
    ygyro: int
    zgyro: int
    xmag: int
    ymag: int
    zmag: int
    temperature: int = 0


class RawImu(NamedTuple):
    time_usec: int
    xacc: int
    yacc: int
    zacc: int
    xgyro: int
    ygyro: int
    zgyro: int
    xmag: int
    ymag: int
    zmag: int
    id: int = 0
    temperature: int = 0


class ServoOutputRaw(NamedTuple):
    time_usec: int
    servo1_raw: int
    servo2_raw: int
    servo3_raw: int
    servo4_raw: int
    servo5_raw: int
    servo6_raw: int
    servo7_raw: int
    servo8_raw: int
    port: int
    servo9_raw: int = 0
    servo10_raw: int = 0
    servo11_raw: int = 0
    servo12_raw: int = 0
    servo13_raw: int = 0
    servo14_raw: int = 0
    servo15_raw: int = 0
    servo16_raw: int = 0


class HighresImu(NamedTuple):
    time_usec: int
    xacc: float
    yacc: float
    zacc: float
    xgyro: float
    ygyro: float
    zgyro: float
    xmag: float
    ymag: float
    zmag: float
    abs_pressure: float
    diff_pressure: float
    pressure_alt: float
    temperature: float
    fields_updated: int
    id: int = 0


class BatteryStatus(NamedTuple):
    current_consumed: int
    energy_consumed: int
    temperature: int
    voltages: tuple[int, ...]
    current_battery: int
    id: int
    battery_function: int
    type: int
    battery_remaining: int
    time_remaining: int = 0
    charge_state: int = 0
    voltages_ext: tuple[int, ...] = (0,) * 4
    mode: int = 0
    fault_bitmask: int = 0


class EkfStatusReport(NamedTuple):
    velocity_variance: float
    pos_horiz_variance: float
    pos_vert_variance: float
    compass_variance: float
    terrain_alt_variance: float
    flags: int
    airspeed_variance: float = 0.0


class EstimatorStatus(NamedTuple):
    time_usec: int
    vel_ratio: float
    pos_horiz_ratio: float
    pos_vert_ratio: float
    mag_ratio: float
    hagl_ratio: float
    tas_ratio: float
    pos_horiz_accuracy: float
    pos_vert_accuracy: float
    flags: int
