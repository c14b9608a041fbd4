"""What the slow sensors correct of an estimate: parts of their innovations, gated.

Without GPS, gravity has to level the attitude (Mahony, Hamel, Pflimlin, "Nonlinear complementary
filters on the special orthogonal group", IEEE TAC 2008), where the specific force is about as
strong as gravity.
"""

from __future__ import annotations

from math import sqrt
from typing import Final

from vehicle_sim.estimation.estimated import Estimated
from vehicle_sim.numerics.gravity import GRAVITY_M_S2
from vehicle_sim.numerics.kernel import anywhere
from vehicle_sim.plant.sensed import Sensed
from vehicle_sim.plant.sensors import GPS_S, SLOW_S, to_body

ALIGNED_S: Final = 0.4
"""Standing still for so long gives attitude, gyroscope biases and height."""

NO_AID_S: Final = 5.0
"""A height that has been refused for so long is set anew."""

GPS_ACCURACY_M: Final = 0.4
ACCURACY_MAX_M: Final = 1000.0

HEIGHT_LOST_S: Final = 1.0
"""So long without the barometer, and GPS holds the height."""

SLACK_S: Final = 0.5 * SLOW_S
"""Half a sample: ages are sums of samples."""

# Standing still is turning no faster than this, under a specific force of about gravity.
_STILL_RAD_S: Final = 0.1
_AT_REST_BAND: Final = 0.2  # of gravity squared
_BIAS_MAX_RAD_S: Final = 0.1

# Part of an angle that is corrected in a sample, and part of that which the bias learns.
_LEVEL_GAIN: Final = 0.05 * SLOW_S
_LEVEL_LEARN: Final = 0.02
_YAW_GAIN: Final = 0.5 * SLOW_S
_YAW_LEARN: Final = 0.1
_LEVEL_BAND: Final = 0.05  # of gravity squared
_MAG_GATE: Final = 0.5  # sine of the angle off

# Horizontally: poles at about 0.5 rad/s in velocity, tilt and gyroscope bias.
_VEL_GAIN: Final = 1.5 * GPS_S
_TILT_GAIN: Final = 0.75 * GPS_S / GRAVITY_M_S2
_TILT_LEARN: Final = 0.12
_POS_GAIN: Final = 0.6 * GPS_S
_POS_GATE_M: Final = 3.5
_VEL_GATE_M_S: Final = 2.0

# Vertically by the barometer: poles at about 0.7 rad/s; GPS holds it to the truth slowly.
_HEIGHT_GAIN: Final = 2.1 * SLOW_S
_CLIMB_GAIN: Final = 1.47 * SLOW_S
_LIFT_GAIN: Final = 0.34 * SLOW_S
_HEIGHT_GATE_M: Final = 5.0
_LIFT_MAX_M_S2: Final = 1.0
_GPS_CLIMB_GAIN: Final = 0.5 * GPS_S
_GPS_HEIGHT_GAIN: Final = 0.5 * GPS_S
_GPS_SHIFT_GAIN: Final = GPS_S / 60.0
_CLIMB_GATE_M_S: Final = 5.0

_SMOOTH: Final = 0.2


def _within(value: float, top: float) -> float:
    low = value if value < top else top
    return low if low > -top else -top


def _turn(est: Estimated, n: float, e: float, d: float, learn: float) -> None:
    """Turn the attitude by the small angle `n, e, d` [rad, NED].

    The gyroscope's biases learn `learn` of it: what has to be turned back again and again is
    what the gyroscope says too much.
    """
    x, y, z = to_body(est.qw, est.qx, est.qy, est.qz, n, e, d)
    est.gyro_bias_x = _within(est.gyro_bias_x - learn * x, _BIAS_MAX_RAD_S)
    est.gyro_bias_y = _within(est.gyro_bias_y - learn * y, _BIAS_MAX_RAD_S)
    est.gyro_bias_z = _within(est.gyro_bias_z - learn * z, _BIAS_MAX_RAD_S)
    n *= 0.5
    e *= 0.5
    d *= 0.5
    w1, x1, y1, z1 = est.qw, est.qx, est.qy, est.qz
    qw = w1 - n * x1 - e * y1 - d * z1
    qx = x1 + n * w1 + e * z1 - d * y1
    qy = y1 + e * w1 + d * x1 - n * z1
    qz = z1 + d * w1 + n * y1 - e * x1
    scale = 1.0 / sqrt(qw * qw + qx * qx + qy * qy + qz * qz)
    est.qw = qw * scale
    est.qx = qx * scale
    est.qy = qy * scale
    est.qz = qz * scale


def hold_attitude(est: Estimated, sensed: Sensed) -> None:
    """Level by gravity, where GPS does not, and yaw by the magnetic field, at 25 Hz."""
    n, e, d = est.acc_n, est.acc_e, est.acc_d - GRAVITY_M_S2
    strength = (n * n + e * e + d * d) / (GRAVITY_M_S2 * GRAVITY_M_S2) - 1.0
    aligning = est.age_s < ALIGNED_S - SLACK_S
    if anywhere(aligning):
        _align(est, sensed, aligning, strength)
    est.age_s += 0.0 if aligning else SLOW_S
    # A running mean while it aligns; its first sample has been taken whole.
    later = est.age_s > SLOW_S + SLACK_S
    mean = SLOW_S / (est.age_s if later else 1.0) if later else 0.0
    steady = strength < _LEVEL_BAND and strength > -_LEVEL_BAND and not est.gps_used
    level = mean if aligning else _LEVEL_GAIN if steady else 0.0
    level = level / GRAVITY_M_S2
    _turn(est, -level * e, level * n, 0.0, 0.0 if aligning else _LEVEL_LEARN)

    x, y, z = sensed.mag_x, sensed.mag_y, sensed.mag_z
    qw, qx, qy, qz = est.qw, est.qx, est.qy, est.qz
    x1 = 2.0 * (qy * z - qz * y)
    y1 = 2.0 * (qz * x - qx * z)
    z1 = 2.0 * (qx * y - qy * x)
    n = x + qw * x1 + (qy * z1 - qz * y1)
    e = y + qw * y1 + (qz * x1 - qx * z1)
    flat = sqrt(n * n + e * e)
    off = e / (flat if flat > 1e-6 else 1.0)
    off = off if n > 0.0 else 1.0 if e > 0.0 else -1.0
    heard = sensed.mag_fresh
    gain = mean if aligning else _YAW_GAIN
    gain = gain if heard else 0.0
    _turn(est, 0.0, 0.0, -gain * off, 0.0 if aligning else _YAW_LEARN)
    ratio = (off if off > 0.0 else -off) / _MAG_GATE
    ratio = est.mag_ratio + _SMOOTH * (ratio - est.mag_ratio)
    est.mag_ratio = ratio if heard else est.mag_ratio
    est.mag_s = 0.0 if heard else est.mag_s + SLOW_S


def _align(est: Estimated, sensed: Sensed, aligning: bool, strength: float) -> None:
    """Standing still: attitude from gravity and the field at once, biases by a running mean.

    What moves meanwhile starts again.
    """
    g_x, g_y, g_z = sensed.gyro_x, sensed.gyro_y, sensed.gyro_z
    still = _STILL_RAD_S
    at_rest = g_x < still and g_x > -still and g_y < still and g_y > -still
    at_rest = at_rest and g_z < still and g_z > -still
    at_rest = at_rest and strength < _AT_REST_BAND and strength > -_AT_REST_BAND
    age_s = est.age_s + SLOW_S if at_rest else 0.0
    est.age_s = age_s if aligning else est.age_s
    # The shortest turn that puts the specific force up ...
    x, y, z = sensed.accel_x, sensed.accel_y, sensed.accel_z
    size = sqrt(x * x + y * y + z * z)
    size = size if size > 1e-6 else 1.0
    x = -x / size
    y = -y / size
    z = -z / size
    w1 = 1.0 + z
    w1 = w1 if w1 > 1e-3 else 1e-3
    scale = 1.0 / sqrt(w1 * w1 + x * x + y * y)
    w1 *= scale
    x1 = y * scale
    y1 = -x * scale
    # ... then the turn about down that puts the field north: half of its angle.
    x, y, z = sensed.mag_x, sensed.mag_y, sensed.mag_z
    along = -2.0 * y1 * x + 2.0 * x1 * y
    n = x + w1 * (2.0 * y1 * z) + y1 * along
    e = y - w1 * (2.0 * x1 * z) - x1 * along
    flat = sqrt(n * n + e * e)
    north = n / (flat if flat > 1e-6 else 1.0)
    north = north if flat > 1e-6 else 1.0
    north = _within(north, 1.0)
    c = sqrt(0.5 * (1.0 + north))
    s = sqrt(0.5 * (1.0 - north))
    s = -s if e > 0.0 else s
    take = aligning and at_rest and age_s < SLOW_S + SLACK_S
    est.qw = w1 * c if take else est.qw
    est.qx = x1 * c - y1 * s if take else est.qx
    est.qy = y1 * c + x1 * s if take else est.qy
    est.qz = w1 * s if take else est.qz

    learn = aligning and at_rest
    mean = SLOW_S / (age_s if learn else 1.0)
    est.gyro_bias_x = est.gyro_bias_x + (g_x - est.gyro_bias_x) * mean if learn else est.gyro_bias_x
    est.gyro_bias_y = est.gyro_bias_y + (g_y - est.gyro_bias_y) * mean if learn else est.gyro_bias_y
    est.gyro_bias_z = est.gyro_bias_z + (g_z - est.gyro_bias_z) * mean if learn else est.gyro_bias_z
    est.vel_n = 0.0 if aligning else est.vel_n
    est.vel_e = 0.0 if aligning else est.vel_e
    est.vel_d = 0.0 if aligning else est.vel_d


def hold_height(est: Estimated, sensed: Sensed) -> None:
    """Height and climb by the barometer, at 25 Hz."""
    aligning = est.age_s < ALIGNED_S - SLACK_S
    down_m = est.baro_shift_m - sensed.baro_up_m
    off = down_m - est.pos_d
    size = off if off > 0.0 else -off
    far = size > _HEIGHT_GATE_M and not aligning
    # Refused for long, it is set anew on the height that the rest has kept meanwhile.
    anew = far and est.baro_s > NO_AID_S and sensed.baro_fresh
    est.baro_shift_m = est.pos_d + sensed.baro_up_m if anew else est.baro_shift_m
    off = 0.0 if far else off
    heard = sensed.baro_fresh and (anew or not far)
    gain = SLOW_S / (est.age_s if est.age_s > SLOW_S else SLOW_S) if aligning else _HEIGHT_GAIN
    est.pos_d += gain * off if heard else 0.0
    free = heard and not aligning
    est.vel_d += _CLIMB_GAIN * off if free else 0.0
    est.acc_off_d = _within(est.acc_off_d - (_LIFT_GAIN * off if free else 0.0), _LIFT_MAX_M_S2)
    ratio = est.height_ratio + _SMOOTH * (size / _HEIGHT_GATE_M - est.height_ratio)
    est.height_ratio = ratio if sensed.baro_fresh else est.height_ratio
    est.baro_s = 0.0 if heard else est.baro_s + SLOW_S


def hold_position(est: Estimated, sensed: Sensed) -> None:
    """A fix, if there is one, against the estimate of when it was taken, at 5 Hz."""
    off_n = sensed.gps_n - est.then_n
    off_e = sensed.gps_e - est.then_e
    off_d = sensed.gps_d - est.then_d
    vel_n = sensed.gps_vel_n - est.then_vel_n
    vel_e = sensed.gps_vel_e - est.then_vel_e
    vel_d = sensed.gps_vel_d - est.then_vel_d
    off_d = _within(off_d, _HEIGHT_GATE_M)
    off = sqrt(off_n * off_n + off_e * off_e) / _POS_GATE_M
    vel = sqrt(vel_n * vel_n + vel_e * vel_e) / _VEL_GATE_M_S

    fresh = sensed.gps_fresh and est.age_s > ALIGNED_S - SLACK_S
    near = off <= 1.0 and vel <= 1.0
    jump = fresh and (not est.placed or (not near and est.dead_s > est.no_aid_s - SLACK_S))
    good = fresh and near and not jump
    used = good or jump
    gain = 1.0 if jump else _POS_GAIN if good else 0.0
    est.pos_n += gain * off_n if used else 0.0
    est.pos_e += gain * off_e if used else 0.0
    gain = 1.0 if jump else _VEL_GAIN if good else 0.0
    est.vel_n += gain * vel_n if used else 0.0
    est.vel_e += gain * vel_e if used else 0.0
    gain = _TILT_GAIN if good else 0.0
    _turn(est, gain * vel_e, -gain * vel_n, 0.0, _TILT_LEARN if good else 0.0)

    pressure = est.baro_s < HEIGHT_LOST_S
    gain = 1.0 if jump else _GPS_CLIMB_GAIN if good else 0.0
    est.vel_d += gain * _within(vel_d, _CLIMB_GATE_M_S) if used else 0.0
    est.pos_d += _GPS_HEIGHT_GAIN * off_d if good and not pressure else 0.0
    est.baro_shift_m += _GPS_SHIFT_GAIN * off_d if good and pressure else 0.0

    est.resets += 1 if jump and est.placed else 0
    est.placed = est.placed or used
    est.gps_used = used
    dead_s = 0.0 if used else est.dead_s + GPS_S
    est.dead_s = dead_s
    accuracy_m = GPS_ACCURACY_M + 0.2 * dead_s + 0.02 * dead_s * dead_s
    est.accuracy_m = accuracy_m if accuracy_m < ACCURACY_MAX_M else ACCURACY_MAX_M
    ratio = est.pos_ratio + _SMOOTH * (off - est.pos_ratio)
    est.pos_ratio = ratio if fresh else est.pos_ratio
    ratio = est.vel_ratio + _SMOOTH * (vel - est.vel_ratio)
    est.vel_ratio = ratio if fresh else est.vel_ratio
