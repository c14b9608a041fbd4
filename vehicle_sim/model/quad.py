"""The whole body of a quadrotor: motors, drag, ground and battery around a rigid body."""

from __future__ import annotations

import struct
from math import sqrt

from vehicle_sim.model.airframe import Airframe
from vehicle_sim.model.battery import Battery
from vehicle_sim.model.ground import Ground
from vehicle_sim.model.motors import Motors
from vehicle_sim.model.rigid_body import RigidBody

BATTERY_EVERY = 25
"""Steps between two updates of the battery, whose voltage moves slowly."""


class Quad:
    """Advances by `dt_s` a step; the ground is the plane down = 0, where the feet stand.

    `wind_n wind_e wind_d` [m/s, NED] is the velocity of the air.
    """

    __slots__ = (
        "_battery_dt_s",
        "_drag",
        "_ground",
        "_near_ground_d",
        "_strength",
        "airframe",
        "battery",
        "body",
        "dt_s",
        "motors",
        "step_count",
        "wind_d",
        "wind_e",
        "wind_n",
    )

    def __init__(self, airframe: Airframe, dt_s: float) -> None:
        body = airframe.body
        self.airframe = airframe
        self.dt_s = dt_s
        self.step_count = 0
        self._ground = Ground(airframe.gear, body.mass_kg)
        self._near_ground_d = -self._ground.reach_m
        self.body = RigidBody(
            body.mass_kg,
            (body.inertia_xx_kg_m2, body.inertia_yy_kg_m2, body.inertia_zz_kg_m2),
        )
        self.motors = Motors(airframe.motors, dt_s)
        self.battery = Battery(airframe.battery)
        self._strength = self.battery.strength
        self._battery_dt_s = dt_s * BATTERY_EVERY
        self._drag = body.drag_n_per_m2_s2
        self.wind_n = self.wind_e = self.wind_d = 0.0

    def step(self, u1: float, u2: float, u3: float, u4: float) -> None:
        """One step with the motors commanded to `u` (0..1 of what the battery can turn)."""
        body = self.body
        motors = self.motors
        strength = self._strength
        motors.advance(u1 * strength, u2 * strength, u3 * strength, u4 * strength)

        thrust = motors.thrust
        qw = body.qw
        qx = body.qx
        qy = body.qy
        qz = body.qz
        air_n = body.vel_n - self.wind_n
        air_e = body.vel_e - self.wind_e
        air_d = body.vel_d - self.wind_d
        drag = self._drag * sqrt(air_n * air_n + air_e * air_e + air_d * air_d)
        # Thrust acts along -z of the body, whose image in NED is the third column of R(q).
        force_n = -2.0 * (qx * qz + qw * qy) * thrust - drag * air_n
        force_e = -2.0 * (qy * qz - qw * qx) * thrust - drag * air_e
        force_d = -(1.0 - 2.0 * (qx * qx + qy * qy)) * thrust - drag * air_d

        if body.pos_d > self._near_ground_d:
            push = self._ground.push(body)
            body.advance(
                force_n + push[0],
                force_e + push[1],
                force_d + push[2],
                motors.torque_x + push[3],
                motors.torque_y + push[4],
                motors.torque_z + push[5],
                self.dt_s,
            )
        else:
            body.advance(
                force_n,
                force_e,
                force_d,
                motors.torque_x,
                motors.torque_y,
                motors.torque_z,
                self.dt_s,
            )

        self.step_count += 1
        if self.step_count % BATTERY_EVERY == 0:
            self.battery.draw(motors.s1, motors.s2, motors.s3, motors.s4, self._battery_dt_s)
            self._strength = self.battery.strength

    def state_bytes(self) -> bytes:
        """The whole state, little-endian doubles: equal bytes are an equal flight."""
        b, m, e = self.body, self.motors, self.battery
        return struct.pack(
            "<20d",
            *(b.pos_n, b.pos_e, b.pos_d, b.vel_n, b.vel_e, b.vel_d),
            *(b.qw, b.qx, b.qy, b.qz, b.rate_x, b.rate_y, b.rate_z),
            *(m.s1, m.s2, m.s3, m.s4),
            *(e.consumed_mah, e.current_a, e.voltage_v),
        )
