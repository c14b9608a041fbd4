"""A fixed-gain observer: attitude, velocity and position from what the sensors say.

Gyroscope and accelerometer carry the estimate from step to step; the slow sensors correct it
(`corrections.py`) by constant parts of their innovations, which is a Kalman filter in its steady
state.  Tilt is not levelled by the accelerometer alone, which cannot tell leaning from
accelerating, but by what a wrong tilt does to the velocity that GPS sees.
"""

from __future__ import annotations

from dataclasses import dataclass, fields
from math import inf, sqrt
from typing import Final

from vehicle_sim.estimation.corrections import (
    ALIGNED_S,
    HEIGHT_LOST_S,
    SLACK_S,
    hold_attitude,
    hold_height,
    hold_position,
)
from vehicle_sim.estimation.estimated import Estimated
from vehicle_sim.numerics.gravity import GRAVITY_M_S2
from vehicle_sim.plant.sensed import Sensed
from vehicle_sim.plant.sensors import (
    BARO_AT,
    BARO_EVERY,
    GPS_EVERY,
    GPS_TAKEN_AT,
    MAG_EVERY,
    SLOW_EVERY,
)

READY_S: Final = 0.48
"""A position is called good from this age on."""

_DT_S: Final = 0.004
_HALF_S: Final = 0.5 * _DT_S
_QUARTER_S: Final = 0.25 * _DT_S

_SATELLITES: Final = 12
_GPS_EPH_M: Final = 0.6
_GPS_EPV_M: Final = 0.9
_NO_FIX: Final = 1  # GPS_FIX_TYPE: a receiver is there
_MAG_LOST_S: Final = 1.0


def align(est: Estimated) -> None:
    """Power-up: forget everything; attitude after `ALIGNED_S`, a good position at `READY_S`."""
    fresh = Estimated()
    for field in fields(Estimated):
        setattr(est, field.name, getattr(fresh, field.name))


def estimate(est: Estimated, sensed: Sensed, k: int) -> None:
    """One step, after the sensors'."""
    rate_x = sensed.gyro_x - est.gyro_bias_x
    rate_y = sensed.gyro_y - est.gyro_bias_y
    rate_z = sensed.gyro_z - est.gyro_bias_z
    # q' = q (1, theta / 2) with the mean of the old and the new rate.
    x = (est.rate_x + rate_x) * _QUARTER_S
    y = (est.rate_y + rate_y) * _QUARTER_S
    z = (est.rate_z + rate_z) * _QUARTER_S
    est.rate_x = rate_x
    est.rate_y = rate_y
    est.rate_z = rate_z
    w1, x1, y1, z1 = est.qw, est.qx, est.qy, est.qz
    qw = w1 - x1 * x - y1 * y - z1 * z
    qx = x1 + w1 * x + y1 * z - z1 * y
    qy = y1 + w1 * y + z1 * x - x1 * z
    qz = z1 + w1 * z + x1 * y - y1 * x
    scale = 1.0 / sqrt(qw * qw + qx * qx + qy * qy + qz * qz)
    est.qw = qw = qw * scale
    est.qx = qx = qx * scale
    est.qy = qy = qy * scale
    est.qz = qz = qz * scale
    # The specific force in NED, and what it makes of velocity and position.
    x, y, z = sensed.accel_x, sensed.accel_y, sensed.accel_z
    x1 = 2.0 * (qy * z - qz * y)
    y1 = 2.0 * (qz * x - qx * z)
    z1 = 2.0 * (qx * y - qy * x)
    est.acc_n = acc_n = x + qw * x1 + (qy * z1 - qz * y1)
    est.acc_e = acc_e = y + qw * y1 + (qz * x1 - qx * z1)
    acc_d = z + qw * z1 + (qx * y1 - qy * x1) + (GRAVITY_M_S2 - est.acc_off_d)
    est.acc_d = acc_d
    old = est.vel_n
    est.vel_n = new = old + acc_n * _DT_S
    est.pos_n += (old + new) * _HALF_S
    old = est.vel_e
    est.vel_e = new = old + acc_e * _DT_S
    est.pos_e += (old + new) * _HALF_S
    old = est.vel_d
    est.vel_d = new = old + acc_d * _DT_S
    est.pos_d += (old + new) * _HALF_S
    if k % SLOW_EVERY == 0:
        _correct(est, sensed, k)


def _correct(est: Estimated, sensed: Sensed, k: int) -> None:
    """By the sensors that do not answer in every step."""
    if k % MAG_EVERY == 0:
        hold_attitude(est, sensed)
    if k % BARO_EVERY == BARO_AT:
        hold_height(est, sensed)
    if k % GPS_EVERY == GPS_TAKEN_AT:
        est.then_n, est.then_e, est.then_d = est.pos_n, est.pos_e, est.pos_d
        est.then_vel_n, est.then_vel_e, est.then_vel_d = est.vel_n, est.vel_e, est.vel_d
    if k % GPS_EVERY == 0:
        hold_position(est, sensed)


@dataclass(frozen=True, slots=True)
class Health:
    """What arming checks, failsafes and telemetry ask of the estimate.

    `*_ratio` are smoothed innovations over their gates: below 0.1 in peace, above 1 refused.
    `eph_m`, `epv_m` are the receiver's own idea of its accuracy, `accuracy_m` the estimator's of
    the horizontal position.
    """

    attitude_ok: bool
    velocity_ok: bool  # horizontal
    position_ok: bool  # horizontal and absolute
    height_ok: bool
    gps_ok: bool  # a fix that is believed
    mag_ok: bool
    baro_ok: bool
    gps_fix: int  # GPS_FIX_TYPE
    satellites: int
    eph_m: float
    epv_m: float
    accuracy_m: float
    dead_s: float
    resets: int
    vel_ratio: float
    pos_ratio: float
    height_ratio: float
    mag_ratio: float


def booted(est: Estimated) -> bool:
    """It has had the time to settle, whether a position came or not."""
    return est.age_s > READY_S - SLACK_S


def position_ok(est: Estimated) -> bool:
    """There is an absolute position, and a fix has carried it lately."""
    return booted(est) and est.placed and est.dead_s < est.no_aid_s


def health(est: Estimated, sensed: Sensed) -> Health:
    """The estimate judged, with the sensors it came from."""
    attitude_ok = est.age_s > ALIGNED_S - SLACK_S
    carried = position_ok(est)
    baro_ok = attitude_ok and est.baro_s < HEIGHT_LOST_S
    fix = sensed.gps_fix > 0.0
    return Health(
        attitude_ok=attitude_ok,
        velocity_ok=carried,
        position_ok=carried,
        height_ok=baro_ok or carried,
        gps_ok=est.gps_used,
        mag_ok=attitude_ok and est.mag_s < _MAG_LOST_S and est.mag_ratio < 1.0,
        baro_ok=baro_ok,
        gps_fix=int(sensed.gps_fix) if fix else _NO_FIX,
        satellites=_SATELLITES if fix else 0,
        eph_m=_GPS_EPH_M if fix else inf,
        epv_m=_GPS_EPV_M if fix else inf,
        accuracy_m=est.accuracy_m,
        dead_s=est.dead_s,
        resets=est.resets,
        vel_ratio=est.vel_ratio,
        pos_ratio=est.pos_ratio,
        height_ratio=est.height_ratio,
        mag_ratio=est.mag_ratio,
    )
