"""What one vehicle's estimator believes."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(slots=True)
class Estimated:
    """A block (see `kernel.py`); only the estimator writes it, everything else flies by it.

    `pos` [m], `vel` [m/s], `acc` [m/s^2, without gravity] in local NED; `q` rotates FRD to NED;
    `rate` [rad/s, FRD] is the gyroscope less its estimated bias.  `gps_used` says that fixes come
    and are believed; `dead_s` is how long the horizontal position has lived without one, and
    `accuracy_m` how far off it may be by now.  `resets` counts jumps of the position.
    """

    pos_n: float = 0.0
    pos_e: float = 0.0
    pos_d: float = 0.0
    vel_n: float = 0.0
    vel_e: float = 0.0
    vel_d: float = 0.0
    acc_n: float = 0.0
    acc_e: float = 0.0
    acc_d: float = 0.0
    qw: float = 1.0
    qx: float = 0.0
    qy: float = 0.0
    qz: float = 0.0
    rate_x: float = 0.0
    rate_y: float = 0.0
    rate_z: float = 0.0
    gyro_bias_x: float = 0.0
    gyro_bias_y: float = 0.0
    gyro_bias_z: float = 0.0
    gps_used: bool = False
    dead_s: float = 0.0
    accuracy_m: float = 0.0
    no_aid_s: float = 5.0  # so long without a fix, and the position is no longer called good
    resets: int = 0
    # The estimator's own.
    age_s: float = 0.0  # since it began to align
    placed: bool = False  # has had a position since then
    acc_off_d: float = 0.0  # learnt error of the vertical acceleration, m/s^2
    baro_shift_m: float = 0.0  # what GPS says the barometer is off by, down
    baro_s: float = 0.0  # since the last sample that was believed
    mag_s: float = 0.0
    then_n: float = 0.0  # the estimate of when the fix that is on its way was taken
    then_e: float = 0.0
    then_d: float = 0.0
    then_vel_n: float = 0.0
    then_vel_e: float = 0.0
    then_vel_d: float = 0.0
    # Innovations over their gates: above 1 a measurement is refused.
    pos_ratio: float = 0.0
    vel_ratio: float = 0.0
    height_ratio: float = 0.0
    mag_ratio: float = 0.0
