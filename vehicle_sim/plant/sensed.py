"""What one vehicle's sensors last said."""

from __future__ import annotations

from dataclasses import dataclass

from vehicle_sim.numerics.gravity import GRAVITY_M_S2


@dataclass(slots=True)
class Sensed:
    """A block (see `kernel.py`); only the sensors write it, and faults its last part.

    `gyro` [rad/s] and `accel` [m/s^2, specific force] in FRD, new with every step.  `mag` is the
    magnetic field in FRD, in gauss; `baro_up_m` the height over the start by air pressure.
    `gps_*` is the last fix that has come out of the receiver, in local NED, late by its latency;
    `gps_fix` is 0 or 3.  `*_fresh` are true in the one step in which a sample comes.

    `battery_*` is what the power module measures: voltage, current and the charge that it
    has counted since power-up.  `esc_*` is what each ESC tells of its motor,
    0..1 of the load at full speed; 0 where nothing turns or nothing is lifted.
    """

    gyro_x: float = 0.0
    gyro_y: float = 0.0
    gyro_z: float = 0.0
    accel_x: float = 0.0
    accel_y: float = 0.0
    accel_z: float = -GRAVITY_M_S2
    mag_x: float = 0.0
    mag_y: float = 0.0
    mag_z: float = 0.0
    mag_fresh: bool = False
    baro_up_m: float = 0.0
    baro_fresh: bool = False
    gps_n: float = 0.0
    gps_e: float = 0.0
    gps_d: float = 0.0
    gps_vel_n: float = 0.0
    gps_vel_e: float = 0.0
    gps_vel_d: float = 0.0
    gps_fix: float = 0.0
    gps_fresh: bool = False
    battery_v: float = 0.0
    battery_a: float = 0.0
    battery_used_mah: float = 0.0
    esc_1: float = 0.0
    esc_2: float = 0.0
    esc_3: float = 0.0
    esc_4: float = 0.0
    # The sensors' own state: biases of this power-up, slow errors, the fix on its way.
    gyro_bias_x: float = 0.0
    gyro_bias_y: float = 0.0
    gyro_bias_z: float = 0.0
    accel_bias_x: float = 0.0
    accel_bias_y: float = 0.0
    accel_bias_z: float = 0.0
    mag_iron_x: float = 0.0
    mag_iron_y: float = 0.0
    mag_iron_z: float = 0.0
    field_n: float = 0.21  # the Earth's field at the start, gauss, NED
    field_d: float = 0.43
    volt_scale: float = 1.0
    amp_scale: float = 1.0
    shaken_x: float = 0.0  # by the rotors in the last step, m/s^2
    shaken_y: float = 0.0
    shaken_z: float = 0.0
    baro_lag_m: float = 0.0
    baro_drift_m: float = 0.0
    gps_wander_n: float = 0.0
    gps_wander_e: float = 0.0
    gps_wander_d: float = 0.0
    taken_n: float = 0.0
    taken_e: float = 0.0
    taken_d: float = 0.0
    taken_vel_n: float = 0.0
    taken_vel_e: float = 0.0
    taken_vel_d: float = 0.0
    gyro_key: int = 0
    accel_key: int = 0
    gyro_walk_key: int = 0
    accel_walk_key: int = 0
    mag_key: int = 0
    baro_key: int = 0
    gps_pos_key: int = 0
    gps_vel_key: int = 0
    gps_wander_key: int = 0
    power_key: int = 0
    esc_key: int = 0
    shake_key: int = 0
    # What faults do to them: constant errors in the units of the sensor, and silence.
    gyro_off_x: float = 0.0
    gyro_off_y: float = 0.0
    gyro_off_z: float = 0.0
    accel_off_x: float = 0.0
    accel_off_y: float = 0.0
    accel_off_z: float = 0.0
    mag_off_x: float = 0.0
    mag_off_y: float = 0.0
    mag_off_z: float = 0.0
    mag_lost: bool = False
    baro_off_m: float = 0.0
    baro_lost: bool = False
    gps_off_n: float = 0.0
    gps_off_e: float = 0.0
    gps_off_d: float = 0.0
    gps_lost: bool = False
