"""The sensors of a vehicle: what a MEMS board and a receiver on it would say of the truth.

Gyroscope and accelerometer answer in every step, magnetometer and barometer at 25 Hz, the power
module and the ESCs at 10 Hz, GPS at 5 Hz and 120 ms late.  Noise is drawn from the step's number,
so nothing depends on who asks, or how often.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import cos, radians, sin, sqrt
from typing import Final

from vehicle_sim.numerics.noise import key_of
from vehicle_sim.plant.battery import BATTERY_EVERY
from vehicle_sim.plant.body import Body
from vehicle_sim.plant.sensed import Sensed

SLOW_EVERY: Final = 5
"""Steps: all that does not answer in every step answers in one that this divides."""

MAG_EVERY: Final = 10
BARO_EVERY: Final = 10
BARO_AT: Final = 5
"""Steps; the barometer answers between two answers of the magnetometer."""

GPS_EVERY: Final = 50
GPS_TAKEN_AT: Final = 20
"""Steps: a fix is taken at 20, 70, ... and comes out of the receiver at 50, 100, ...: 120 ms."""

GPS_S: Final = 0.2
SLOW_S: Final = 0.04
"""Seconds between two fixes, and between two samples of magnetometer and barometer."""

_WALK_EVERY: Final = 250

_GYRO_MAX_RAD_S: Final = 34.9  # 2000 deg/s
_ACCEL_MAX_M_S2: Final = 156.9  # 16 g
_MAG_MAX_GAUSS: Final = 16.0
_FAR_M: Final = 1e8
_FAST_M_S: Final = 1e5

_BARO_LAG_S: Final = 0.05
_BARO_GAIN: Final = SLOW_S / (_BARO_LAG_S + SLOW_S)
_BARO_DRIFT_S: Final = 120.0
_BARO_KEEP: Final = 1.0 - SLOW_S / _BARO_DRIFT_S
_BARO_STIR: Final = sqrt(1.0 - _BARO_KEEP * _BARO_KEEP)
_WANDER_S: Final = 60.0
_WANDER_KEEP: Final = 1.0 - GPS_S / _WANDER_S
_WANDER_STIR: Final = sqrt(1.0 - _WANDER_KEEP * _WANDER_KEEP)

_DIPOLE_GAUSS: Final = 0.31
_HORIZONTAL_LEAST_GAUSS: Final = 0.02

_SWING: Final = sqrt(0.5)  # the difference of two such is as large as one

_MASK: Final = 0xFFFFFFFFFFFFFFFF
_GOLDEN: Final = 0x9E3779B97F4A7C15
_PAIRS: Final = 0x3FF | 0x3FF << 20 | 0x3FF << 40
# A sum of two uniforms of 0..1023 has mean 1023 and variance (1024^2 - 1) / 6.
_UNIT: Final = 1.0 / sqrt((1024.0 * 1024.0 - 1.0) / 6.0)
_MEAN: Final = 1023.0 * _UNIT


@dataclass(frozen=True, slots=True)
class SensorGrade:
    """How good the sensors are: standard deviations, the same for all vehicles of a world.

    White noise a sample, `*_bias` of a power-up, `*_walk` a square root of a second, `*_wander`
    and `*_drift` of slow errors.  The defaults are what data sheets and logs of consumer parts
    show (ICM-42688 class IMU: gyroscope 0.005 deg/s/sqrt(Hz) over 125 Hz; IST8310; MS5611; u-blox
    M8 in the open, whose wander is kept small so that a flight stays where its plan says; a power
    module of 90 A with a 10-bit converter of its current and a 12-bit one of its voltage).
    `*_scale` are errors of a factor that last for a power-up: 0.1 % of the voltage and 0.2 % of the
    current are what the best calibration leaves, so that a failsafe of the battery strikes where
    its parameter says; see `REAL` for a usual one.  `baro_gain` is a filter's part of a new sample.
    `vibration_m_s2` is what the accelerometer feels of all four rotors at full speed.
    """

    gyro_rad_s: float = 0.001
    gyro_bias_rad_s: float = 0.005
    gyro_walk_rad_s: float = 0.00002
    accel_m_s2: float = 0.03
    accel_bias_m_s2: float = 0.025
    accel_walk_m_s2: float = 0.0003
    mag_gauss: float = 0.003
    mag_iron_gauss: float = 0.002
    baro_m: float = 0.15
    baro_drift_m: float = 0.1
    baro_gain: float = _BARO_GAIN
    gps_m: float = 0.1
    gps_up_m: float = 0.2
    gps_wander_m: float = 0.15
    gps_wander_up_m: float = 0.15
    gps_m_s: float = 0.05
    volt_v: float = 0.01
    volt_scale: float = 0.001
    amp_a: float = 0.1
    amp_scale: float = 0.002
    esc: float = 0.005
    vibration_m_s2: float = 0.0


MEMS: Final = SensorGrade()

REAL: Final = SensorGrade(
    baro_drift_m=1.3,
    gps_wander_m=0.7,
    gps_wander_up_m=1.2,
    volt_scale=0.005,
    amp_scale=0.02,
    vibration_m_s2=10.0,
)
"""As measured in life: GPS wanders by 0.5 to 1.5 m, the barometer drifts by 1 to 2 m in two
minutes, and VIBRATION reads 3 to 15 m/s^2 in a hover."""

GRADES: Final = {"good": MEMS, "real": REAL}
"""By the name on the command line."""

IDEAL: Final = SensorGrade(
    *(0.0,) * 10,
    baro_gain=1.0,
    gps_m=0.0,
    gps_up_m=0.0,
    gps_wander_m=0.0,
    gps_wander_up_m=0.0,
    gps_m_s=0.0,
    volt_v=0.0,
    volt_scale=0.0,
    amp_a=0.0,
    amp_scale=0.0,
    esc=0.0,
)
"""Only rates and latencies are left."""


def switch_on(sensed: Sensed, seed: int, vehicle: int, lat_deg: float, grade: SensorGrade) -> None:
    """Power-up: noise keys, biases, and the Earth's field at the start.

    The field is an axial dipole's (Blakely, Potential Theory, 8.2), with no declination.
    """
    (
        sensed.gyro_key,
        sensed.accel_key,
        sensed.gyro_walk_key,
        sensed.accel_walk_key,
        sensed.mag_key,
        sensed.baro_key,
        sensed.gps_pos_key,
        sensed.gps_vel_key,
        sensed.gps_wander_key,
        sensed.power_key,
        sensed.esc_key,
        sensed.shake_key,
    ) = (key_of(seed, vehicle, source) for source in range(_FIRST_SOURCE, _FIRST_SOURCE + 12))
    x, y, z = three(sensed.gyro_walk_key, 0)
    sensed.gyro_bias_x = x * grade.gyro_bias_rad_s
    sensed.gyro_bias_y = y * grade.gyro_bias_rad_s
    sensed.gyro_bias_z = z * grade.gyro_bias_rad_s
    x, y, z = three(sensed.accel_walk_key, 0)
    sensed.accel_bias_x = x * grade.accel_bias_m_s2
    sensed.accel_bias_y = y * grade.accel_bias_m_s2
    sensed.accel_bias_z = z * grade.accel_bias_m_s2
    x, y, z = three(sensed.mag_key, 0)
    sensed.mag_iron_x = x * grade.mag_iron_gauss
    sensed.mag_iron_y = y * grade.mag_iron_gauss
    sensed.mag_iron_z = z * grade.mag_iron_gauss
    x, y, z = three(sensed.gps_wander_key, 0)
    sensed.gps_wander_n = x * grade.gps_wander_m
    sensed.gps_wander_e = y * grade.gps_wander_m
    sensed.gps_wander_d = z * grade.gps_wander_up_m
    x, y, _ = three(sensed.power_key, 0)
    sensed.volt_scale = 1.0 + x * grade.volt_scale
    sensed.amp_scale = 1.0 + y * grade.amp_scale
    latitude = radians(lat_deg)
    horizontal = _DIPOLE_GAUSS * cos(latitude)
    sensed.field_n = max(horizontal, _HORIZONTAL_LEAST_GAUSS)
    sensed.field_d = 2.0 * _DIPOLE_GAUSS * sin(latitude)


_FIRST_SOURCE: Final = 16  # noise sources below are the physics' and the faults'


def three(key: int, counter: int) -> tuple[float, float, float]:
    """Three numbers of mean 0 and variance 1, each the sum of two uniforms, from one mixing:
    `mix64`, written out, as every step asks twice."""
    x = (key + counter) & _MASK
    x = ((x ^ (x >> 30)) * 0xBF58476D1CE4E5B9) & _MASK
    x = ((x ^ (x >> 27)) * 0x94D049BB133111EB) & _MASK
    x ^= x >> 31
    pairs = (x & _PAIRS) + ((x >> 10) & _PAIRS)
    return (
        (pairs & 0x7FF) * _UNIT - _MEAN,
        ((pairs >> 20) & 0x7FF) * _UNIT - _MEAN,
        (pairs >> 40) * _UNIT - _MEAN,
    )


def to_body(
    qw: float, qx: float, qy: float, qz: float, n: float, e: float, d: float
) -> tuple[float, float, float]:
    """A vector in NED, seen in FRD; `q` rotates FRD to NED."""
    x = 2.0 * (e * qz - d * qy)
    y = 2.0 * (d * qx - n * qz)
    z = 2.0 * (n * qy - e * qx)
    return (
        n + qw * x + (y * qz - z * qy),
        e + qw * y + (z * qx - x * qz),
        d + qw * z + (x * qy - y * qx),
    )


def _within(value: float, top: float) -> float:
    """Clipped; what is not a number is the top."""
    low = value if value < top else top
    return low if low > -top else -top


def sense(sensed: Sensed, body: Body, grade: SensorGrade, k: int) -> None:
    """What the sensors say of `body` after step `k`."""
    counter = k * _GOLDEN & _MASK
    # `_within`, written out: calls are dear where every step makes six of them.
    x, y, z = three(sensed.gyro_key, counter)
    white = grade.gyro_rad_s
    top = _GYRO_MAX_RAD_S
    x = body.rate_x + sensed.gyro_bias_x + sensed.gyro_off_x + x * white
    x = x if x < top else top
    sensed.gyro_x = x if x > -top else -top
    y = body.rate_y + sensed.gyro_bias_y + sensed.gyro_off_y + y * white
    y = y if y < top else top
    sensed.gyro_y = y if y > -top else -top
    z = body.rate_z + sensed.gyro_bias_z + sensed.gyro_off_z + z * white
    z = z if z < top else top
    sensed.gyro_z = z if z > -top else -top
    f_x, f_y, f_z = to_body(body.qw, body.qx, body.qy, body.qz, body.sf_n, body.sf_e, body.sf_d)
    x, y, z = three(sensed.accel_key, counter)
    white = grade.accel_m_s2
    top = _ACCEL_MAX_M_S2
    x = f_x + sensed.accel_bias_x + sensed.accel_off_x + x * white
    x = x if x < top else top
    sensed.accel_x = x if x > -top else -top
    y = f_y + sensed.accel_bias_y + sensed.accel_off_y + y * white
    y = y if y < top else top
    sensed.accel_y = y if y > -top else -top
    z = f_z + sensed.accel_bias_z + sensed.accel_off_z + z * white
    z = z if z < top else top
    sensed.accel_z = z if z > -top else -top
    if grade.vibration_m_s2 > 0.0:
        _shake(sensed, body, grade, counter)
    sensed.mag_fresh = sensed.baro_fresh = sensed.gps_fresh = False
    if k % SLOW_EVERY == 0:
        _sense_slowly(sensed, body, grade, k, counter)


def _sense_slowly(sensed: Sensed, body: Body, grade: SensorGrade, k: int, counter: int) -> None:
    """Those that do not answer in every step."""
    if k % MAG_EVERY == 0:
        _feel_field(sensed, body, grade, counter)
    if k % BARO_EVERY == BARO_AT:
        _feel_pressure(sensed, body, grade, counter)
    if k % GPS_EVERY == GPS_TAKEN_AT:
        _take_fix(sensed, body, grade, counter)
    if k % GPS_EVERY == 0:
        _give_fix(sensed)
    if k % BATTERY_EVERY == 0:
        measure_power(sensed, body, grade, counter)
    if k % _WALK_EVERY == 0:
        _walk(sensed, grade, counter)


def _shake(sensed: Sensed, body: Body, grade: SensorGrade, counter: int) -> None:
    """Rotors out of balance shake the frame: with the square of their speed, and without a mean.

    What shakes it now swings back in the next step, so the speed that it adds up to stays small.
    """
    x, y, z = three(sensed.shake_key, counter)
    s1, s2, s3, s4 = body.s1, body.s2, body.s3, body.s4
    size = 0.25 * _SWING * grade.vibration_m_s2 * ((s1 * s1 + s2 * s2) + (s3 * s3 + s4 * s4))
    x, y, z = size * x, size * y, size * z
    sensed.accel_x = _within(sensed.accel_x + x - sensed.shaken_x, _ACCEL_MAX_M_S2)
    sensed.accel_y = _within(sensed.accel_y + y - sensed.shaken_y, _ACCEL_MAX_M_S2)
    sensed.accel_z = _within(sensed.accel_z + z - sensed.shaken_z, _ACCEL_MAX_M_S2)
    sensed.shaken_x = x
    sensed.shaken_y = y
    sensed.shaken_z = z


def _feel_field(sensed: Sensed, body: Body, grade: SensorGrade, counter: int) -> None:
    """The Earth's field in FRD, with what is left of hard iron after a calibration."""
    m_x, m_y, m_z = to_body(body.qw, body.qx, body.qy, body.qz, sensed.field_n, 0.0, sensed.field_d)
    x, y, z = three(sensed.mag_key, counter)
    white = grade.mag_gauss
    here = not sensed.mag_lost
    x = _within(m_x + sensed.mag_iron_x + sensed.mag_off_x + x * white, _MAG_MAX_GAUSS)
    y = _within(m_y + sensed.mag_iron_y + sensed.mag_off_y + y * white, _MAG_MAX_GAUSS)
    z = _within(m_z + sensed.mag_iron_z + sensed.mag_off_z + z * white, _MAG_MAX_GAUSS)
    sensed.mag_x = x if here else sensed.mag_x
    sensed.mag_y = y if here else sensed.mag_y
    sensed.mag_z = z if here else sensed.mag_z
    sensed.mag_fresh = here


def _feel_pressure(sensed: Sensed, body: Body, grade: SensorGrade, counter: int) -> None:
    """Height by pressure: it lags (first order), drifts with the weather, and is noisy."""
    white, stir, _ = three(sensed.baro_key, counter)
    up_m = _within(-body.pos_d, _FAR_M)
    sensed.baro_lag_m += grade.baro_gain * (up_m - sensed.baro_lag_m)
    sensed.baro_drift_m = _BARO_KEEP * sensed.baro_drift_m + _BARO_STIR * grade.baro_drift_m * stir
    here = not sensed.baro_lost
    up_m = sensed.baro_lag_m + sensed.baro_drift_m + sensed.baro_off_m + grade.baro_m * white
    sensed.baro_up_m = up_m if here else sensed.baro_up_m
    sensed.baro_fresh = here


def _take_fix(sensed: Sensed, body: Body, grade: SensorGrade, counter: int) -> None:
    """Position and velocity of now, which the receiver is going to work out."""
    x, y, z = three(sensed.gps_wander_key, counter)
    stir = _WANDER_STIR * grade.gps_wander_m
    stir_up = _WANDER_STIR * grade.gps_wander_up_m
    sensed.gps_wander_n = _WANDER_KEEP * sensed.gps_wander_n + stir * x
    sensed.gps_wander_e = _WANDER_KEEP * sensed.gps_wander_e + stir * y
    sensed.gps_wander_d = _WANDER_KEEP * sensed.gps_wander_d + stir_up * z
    x, y, z = three(sensed.gps_pos_key, counter)
    white = grade.gps_m
    sensed.taken_n = (
        _within(body.pos_n, _FAR_M) + sensed.gps_wander_n + sensed.gps_off_n + x * white
    )
    sensed.taken_e = (
        _within(body.pos_e, _FAR_M) + sensed.gps_wander_e + sensed.gps_off_e + y * white
    )
    sensed.taken_d = (
        _within(body.pos_d, _FAR_M) + sensed.gps_wander_d + sensed.gps_off_d + z * grade.gps_up_m
    )
    x, y, z = three(sensed.gps_vel_key, counter)
    white = grade.gps_m_s
    sensed.taken_vel_n = _within(body.vel_n, _FAST_M_S) + x * white
    sensed.taken_vel_e = _within(body.vel_e, _FAST_M_S) + y * white
    sensed.taken_vel_d = _within(body.vel_d, _FAST_M_S) + z * white


def _give_fix(sensed: Sensed) -> None:
    """The fix comes out of the receiver; without satellites the last one stays, unfresh."""
    here = not sensed.gps_lost
    sensed.gps_n = sensed.taken_n if here else sensed.gps_n
    sensed.gps_e = sensed.taken_e if here else sensed.gps_e
    sensed.gps_d = sensed.taken_d if here else sensed.gps_d
    sensed.gps_vel_n = sensed.taken_vel_n if here else sensed.gps_vel_n
    sensed.gps_vel_e = sensed.taken_vel_e if here else sensed.gps_vel_e
    sensed.gps_vel_d = sensed.taken_vel_d if here else sensed.gps_vel_d
    sensed.gps_fix = 3.0 if here else 0.0
    sensed.gps_fresh = here


def measure_power(sensed: Sensed, body: Body, grade: SensorGrade, counter: int) -> None:
    """The power module and the ESCs, as they are read: without a filter, as ArduPilot reads them.

    PX4's filters (1 s of the voltage, 0.5 s of the current, by memory) are left out.  The charge is
    counted from the current as it is measured, so it has the current's scale; its noise has no
    mean.
    """
    x, y, _ = three(sensed.power_key, counter)
    volts = sensed.volt_scale * body.voltage_v + grade.volt_v * x
    sensed.battery_v = volts if volts > 0.0 else 0.0
    amps = sensed.amp_scale * body.current_a + grade.amp_a * y
    sensed.battery_a = amps if amps > 0.0 else 0.0
    sensed.battery_used_mah = sensed.amp_scale * body.consumed_mah
    x, y, z = three(sensed.esc_key, counter)
    white = grade.esc
    sensed.esc_1 = _at_least_0(body.s1 * body.health_1, x * white)
    sensed.esc_2 = _at_least_0(body.s2 * body.health_2, y * white)
    sensed.esc_3 = _at_least_0(body.s3 * body.health_3, z * white)
    sensed.esc_4 = _at_least_0(body.s4 * body.health_4, (x + y) * (0.7 * white))


def _at_least_0(value: float, noise: float) -> float:
    """With noise where something turns; what stands still is 0."""
    noisy = value + noise
    return noisy if value > 0.0 and noisy > 0.0 else 0.0


def _walk(sensed: Sensed, grade: SensorGrade, counter: int) -> None:
    """A second of random walk of the biases."""
    x, y, z = three(sensed.gyro_walk_key, counter)
    sensed.gyro_bias_x += grade.gyro_walk_rad_s * x
    sensed.gyro_bias_y += grade.gyro_walk_rad_s * y
    sensed.gyro_bias_z += grade.gyro_walk_rad_s * z
    x, y, z = three(sensed.accel_walk_key, counter)
    sensed.accel_bias_x += grade.accel_walk_m_s2 * x
    sensed.accel_bias_y += grade.accel_walk_m_s2 * y
    sensed.accel_bias_z += grade.accel_walk_m_s2 * z
