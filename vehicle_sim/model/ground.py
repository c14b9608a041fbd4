"""The ground: a plane that four feet stand on, as springs, dampers and friction."""

from __future__ import annotations

from math import sqrt
from typing import TypeAlias

from vehicle_sim.model.airframe import Gear
from vehicle_sim.model.rigid_body import GRAVITY_M_S2, RigidBody

Push: TypeAlias = tuple[float, float, float, float, float, float]
"""Force north, east, down [N] and torque about body x, y, z [N m]."""

_NOTHING: Push = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0)


class Ground:
    """Contact of the landing gear with the plane down = 0 (the centre of mass at rest is there).

    Local height is measured at the centre of mass, as an estimator does: the feet touch when
    it is at 0, so the plane lies `height_m` below the origin, and a little more for the springs.
    """

    __slots__ = ("_damping", "_feet", "_friction", "_plane_d", "_stiffness", "reach_m")

    def __init__(self, gear: Gear, mass_kg: float) -> None:
        x, y, z = gear.foot_forward_m, gear.foot_right_m, gear.height_m
        self._feet = ((x, y, z), (-x, -y, z), (x, -y, z), (-x, y, z))
        self._stiffness = gear.stiffness_n_per_m
        self._damping = gear.damping_n_s_per_m
        self._friction = gear.friction
        squeeze = mass_kg * GRAVITY_M_S2 / (4.0 * gear.stiffness_n_per_m)
        self._plane_d = z - squeeze
        self.reach_m = sqrt(x * x + y * y + z * z)

    def push(self, body: RigidBody) -> Push:
        """What the ground does to `body` now."""
        qw, qx, qy, qz = body.qw, body.qx, body.qy, body.qz
        r11 = 1.0 - 2.0 * (qy * qy + qz * qz)
        r12 = 2.0 * (qx * qy - qw * qz)
        r13 = 2.0 * (qx * qz + qw * qy)
        r21 = 2.0 * (qx * qy + qw * qz)
        r22 = 1.0 - 2.0 * (qx * qx + qz * qz)
        r23 = 2.0 * (qy * qz - qw * qx)
        r31 = 2.0 * (qx * qz - qw * qy)
        r32 = 2.0 * (qy * qz + qw * qx)
        r33 = 1.0 - 2.0 * (qx * qx + qy * qy)
        p, q, r = body.rate_x, body.rate_y, body.rate_z
        sum_n = sum_e = sum_d = tau_x = tau_y = tau_z = 0.0
        touching = False
        for x, y, z in self._feet:
            depth = body.pos_d + (r31 * x + r32 * y + r33 * z) - self._plane_d
            if depth <= 0.0:
                continue
            touching = True
            # Velocity of the foot: v + R (w x foot).
            wx = q * z - r * y
            wy = r * x - p * z
            wz = p * y - q * x
            foot_n = body.vel_n + (r11 * wx + r12 * wy + r13 * wz)
            foot_e = body.vel_e + (r21 * wx + r22 * wy + r23 * wz)
            foot_d = body.vel_d + (r31 * wx + r32 * wy + r33 * wz)
            load = self._stiffness * depth + self._damping * foot_d
            if load <= 0.0:
                continue
            # Coulomb friction, viscous where it would otherwise stop the foot within a step.
            slip = sqrt(foot_n * foot_n + foot_e * foot_e)
            hold = self._friction * load
            grip = self._damping if hold > self._damping * slip else hold / slip
            f_n = -grip * foot_n
            f_e = -grip * foot_e
            f_d = -load
            # To the body frame (R transposed), then foot x force.
            bx = r11 * f_n + r21 * f_e + r31 * f_d
            by = r12 * f_n + r22 * f_e + r32 * f_d
            bz = r13 * f_n + r23 * f_e + r33 * f_d
            tau_x += y * bz - z * by
            tau_y += z * bx - x * bz
            tau_z += x * by - y * bx
            sum_n += f_n
            sum_e += f_e
            sum_d += f_d
        if not touching:
            return _NOTHING
        return (sum_n, sum_e, sum_d, tau_x, tau_y, tau_z)
