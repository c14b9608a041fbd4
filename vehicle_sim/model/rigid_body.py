"""A rigid body: six degrees of freedom, quaternion attitude, one step of Newton and Euler.

Only + - * / and sqrt in one written order, so that every IEEE-754 machine computes the same
bits.  Frames: local NED (north, east, down; metres) and body FRD (forward, right, down).
"""

from __future__ import annotations

from math import sqrt

GRAVITY_M_S2 = 9.80665


class RigidBody:
    """State and inertia of one body.

    `pos_n pos_e pos_d` [m] and `vel_n vel_e vel_d` [m/s] in NED; `qw qx qy qz` rotates FRD to
    NED; `rate_x rate_y rate_z` [rad/s] in FRD; `sf_n sf_e sf_d` [m/s^2] is the specific force
    of the last step in NED, what an ideal accelerometer feels.
    """

    __slots__ = (
        "_ixx",
        "_iyy",
        "_izz",
        "_mass",
        "pos_d",
        "pos_e",
        "pos_n",
        "qw",
        "qx",
        "qy",
        "qz",
        "rate_x",
        "rate_y",
        "rate_z",
        "sf_d",
        "sf_e",
        "sf_n",
        "vel_d",
        "vel_e",
        "vel_n",
    )

    def __init__(self, mass_kg: float, inertia_kg_m2: tuple[float, float, float]) -> None:
        self._mass = mass_kg
        self._ixx, self._iyy, self._izz = inertia_kg_m2
        self.pos_n = self.pos_e = self.pos_d = 0.0
        self.vel_n = self.vel_e = self.vel_d = 0.0
        self.qw, self.qx, self.qy, self.qz = 1.0, 0.0, 0.0, 0.0
        self.rate_x = self.rate_y = self.rate_z = 0.0
        self.sf_n = self.sf_e = 0.0
        self.sf_d = -GRAVITY_M_S2

    def advance(
        self,
        force_n: float,
        force_e: float,
        force_d: float,
        torque_x: float,
        torque_y: float,
        torque_z: float,
        dt_s: float,
    ) -> None:
        """One step under `force` [N, NED, without gravity] and `torque` [N m, FRD].

        Velocities by Euler; position and attitude with the mean of the old and the new
        velocity, which is exact for constant acceleration and of second order otherwise.
        Euler's equations for a body with a diagonal inertia tensor: J w' = t - w x (J w)
        (Goldstein, Classical Mechanics, 5.39).
        """
        mass = self._mass
        acc_n = force_n / mass
        acc_e = force_e / mass
        acc_d = force_d / mass
        self.sf_n = acc_n
        self.sf_e = acc_e
        self.sf_d = acc_d
        half = 0.5 * dt_s

        v_n = self.vel_n
        v_e = self.vel_e
        v_d = self.vel_d
        new_n = v_n + acc_n * dt_s
        new_e = v_e + acc_e * dt_s
        new_d = v_d + (acc_d + GRAVITY_M_S2) * dt_s
        self.pos_n += (v_n + new_n) * half
        self.pos_e += (v_e + new_e) * half
        self.pos_d += (v_d + new_d) * half
        self.vel_n = new_n
        self.vel_e = new_e
        self.vel_d = new_d

        x = self.rate_x
        y = self.rate_y
        z = self.rate_z
        ixx = self._ixx
        iyy = self._iyy
        izz = self._izz
        new_x = x + (torque_x + (iyy - izz) * y * z) / ixx * dt_s
        new_y = y + (torque_y + (izz - ixx) * z * x) / iyy * dt_s
        new_z = z + (torque_z + (ixx - iyy) * x * y) / izz * dt_s
        self.rate_x = new_x
        self.rate_y = new_y
        self.rate_z = new_z

        # q' = q (1, theta / 2), normalised: the turn of a Cayley map, wrong by theta^3 / 12.
        quarter = 0.5 * half
        x = (x + new_x) * quarter
        y = (y + new_y) * quarter
        z = (z + new_z) * quarter
        qw = self.qw
        qx = self.qx
        qy = self.qy
        qz = self.qz
        w1 = qw - qx * x - qy * y - qz * z
        x1 = qx + qw * x + qy * z - qz * y
        y1 = qy + qw * y + qz * x - qx * z
        z1 = qz + qw * z + qx * y - qy * x
        scale = 1.0 / sqrt(w1 * w1 + x1 * x1 + y1 * y1 + z1 * z1)
        self.qw = w1 * scale
        self.qx = x1 * scale
        self.qy = y1 * scale
        self.qz = z1 * scale
