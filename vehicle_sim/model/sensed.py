"""What one vehicle's sensors last said."""

from __future__ import annotations

from dataclasses import dataclass

from vehicle_sim.model.rigid_body import GRAVITY_M_S2


@dataclass(slots=True)
class Sensed:
    """A block (see `kernel.py`); only the sensors write it.

    `gyro` [rad/s] and `accel` [m/s^2, specific force] in FRD, new with every step.  `mag` is the
    magnetic field in FRD, in gauss; `baro_up_m` the height over the start by air pressure.  `gps_*`
    is the last fix that has come out of the receiver, late by its latency; `gps_fix` is 0 or 3.  `*_fresh` are true in the one step in which a sample comes.

    Biases and faults are fields too: what is wrong with a sensor is a part of its state.
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
    # What is wrong with them: constant errors in the units of the sensor, and silence.
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
