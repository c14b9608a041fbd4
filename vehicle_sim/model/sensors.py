"""What the vehicle believes of itself: the truth and the errors of its sensors.

The estimator is modelled by its errors, not run: position, velocity and attitude err by a
first-order Gauss-Markov process each (slow wander), gyroscope and accelerometer by white noise.
The wander moves with the steps; the white noise is keyed by the step.  So neither depends on
how often anybody asks.
"""

from __future__ import annotations

from math import sqrt

from vehicle_sim.model.noise import key_of, normal
from vehicle_sim.model.rigid_body import RigidBody

EVERY = 10
"""Steps between two moves of the wander."""

_POS_SIGMA_M = 0.05
_VEL_SIGMA_M_S = 0.02
_TILT_SIGMA_RAD = 0.003
_GYRO_SIGMA_RAD_S = 0.003
_ACCEL_SIGMA_M_S2 = 0.05
_WANDER_S = 3.0

_WANDERING = 9  # position, velocity, attitude: three axes each
_WHITE = 6  # gyroscope, accelerometer

Vec3 = tuple[float, float, float]
Quat = tuple[float, float, float, float]


class Sensors:
    """Errors `err_pos_*` [m], `err_vel_*` [m/s] in NED, held between their moves."""

    __slots__ = (
        "_keep",
        "_keys",
        "_stir",
        "_tilt_x",
        "_tilt_y",
        "_tilt_z",
        "err_pos_d",
        "err_pos_e",
        "err_pos_n",
        "err_vel_d",
        "err_vel_e",
        "err_vel_n",
    )

    def __init__(self, seed: int, vehicle: int, dt_s: float) -> None:
        self._keys = tuple(key_of(seed, vehicle, s) for s in range(_WANDERING + _WHITE))
        keep = 1.0 - dt_s * EVERY / _WANDER_S
        self._keep = keep
        self._stir = sqrt(1.0 - keep * keep)
        k = self._keys
        # Key 0 of the wander's own first value is step 0: the process starts stationary.
        self.err_pos_n, self.err_pos_e, self.err_pos_d = (
            _POS_SIGMA_M * normal(key, 0) for key in k[0:3]
        )
        self.err_vel_n, self.err_vel_e, self.err_vel_d = (
            _VEL_SIGMA_M_S * normal(key, 0) for key in k[3:6]
        )
        self._tilt_x, self._tilt_y, self._tilt_z = (
            _TILT_SIGMA_RAD * normal(key, 0) for key in k[6:9]
        )

    def wander(self, step: int) -> None:
        """Move the slow errors; called every `EVERY` steps with a positive step."""
        keep = self._keep
        k = self._keys
        stir = self._stir * _POS_SIGMA_M
        self.err_pos_n = keep * self.err_pos_n + stir * normal(k[0], step)
        self.err_pos_e = keep * self.err_pos_e + stir * normal(k[1], step)
        self.err_pos_d = keep * self.err_pos_d + stir * normal(k[2], step)
        stir = self._stir * _VEL_SIGMA_M_S
        self.err_vel_n = keep * self.err_vel_n + stir * normal(k[3], step)
        self.err_vel_e = keep * self.err_vel_e + stir * normal(k[4], step)
        self.err_vel_d = keep * self.err_vel_d + stir * normal(k[5], step)
        stir = self._stir * _TILT_SIGMA_RAD
        self._tilt_x = keep * self._tilt_x + stir * normal(k[6], step)
        self._tilt_y = keep * self._tilt_y + stir * normal(k[7], step)
        self._tilt_z = keep * self._tilt_z + stir * normal(k[8], step)

    def attitude(self, body: RigidBody) -> Quat:
        """Estimated q_ned_from_frd: the true one, turned by the small attitude error."""
        x, y, z = 0.5 * self._tilt_x, 0.5 * self._tilt_y, 0.5 * self._tilt_z
        w1 = body.qw - body.qx * x - body.qy * y - body.qz * z
        x1 = body.qx + body.qw * x + body.qy * z - body.qz * y
        y1 = body.qy + body.qw * y + body.qz * x - body.qx * z
        z1 = body.qz + body.qw * z + body.qx * y - body.qy * x
        scale = 1.0 / sqrt(w1 * w1 + x1 * x1 + y1 * y1 + z1 * z1)
        return (w1 * scale, x1 * scale, y1 * scale, z1 * scale)

    def gyro(self, body: RigidBody, step: int) -> Vec3:
        """Measured body rates [rad/s, FRD]."""
        k = self._keys
        return (
            body.rate_x + _GYRO_SIGMA_RAD_S * normal(k[9], step),
            body.rate_y + _GYRO_SIGMA_RAD_S * normal(k[10], step),
            body.rate_z + _GYRO_SIGMA_RAD_S * normal(k[11], step),
        )

    def accel(self, body: RigidBody, step: int) -> Vec3:
        """Measured specific force [m/s^2, FRD]; (0, 0, -9.8) when it stands still."""
        qw, qx, qy, qz = body.qw, body.qx, body.qy, body.qz
        n, e, d = body.sf_n, body.sf_e, body.sf_d
        k = self._keys
        x = (
            (1.0 - 2.0 * (qy * qy + qz * qz)) * n
            + 2.0 * (qx * qy + qw * qz) * e
            + 2.0 * (qx * qz - qw * qy) * d
        )
        y = (
            2.0 * (qx * qy - qw * qz) * n
            + (1.0 - 2.0 * (qx * qx + qz * qz)) * e
            + 2.0 * (qy * qz + qw * qx) * d
        )
        z = (
            2.0 * (qx * qz + qw * qy) * n
            + 2.0 * (qy * qz - qw * qx) * e
            + (1.0 - 2.0 * (qx * qx + qy * qy)) * d
        )
        return (
            x + _ACCEL_SIGMA_M_S2 * normal(k[12], step),
            y + _ACCEL_SIGMA_M_S2 * normal(k[13], step),
            z + _ACCEL_SIGMA_M_S2 * normal(k[14], step),
        )
