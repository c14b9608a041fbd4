"""The control cascade: position -> velocity -> attitude -> rate -> motors.

The outer half runs at 50 Hz on the estimate, the inner half with every step of the physics.
Gains are a factor of two to three apart from loop to loop, so that each sees the next as
immediate: rate 22 /s, attitude 9 /s, velocity 2.5 /s, position 1 /s.
"""

from __future__ import annotations

from math import cos, sin, sqrt

from vehicle_sim.model.airframe import Airframe
from vehicle_sim.model.rigid_body import GRAVITY_M_S2, RigidBody

_POS_P = 1.0
_VEL_P = 2.5
_VEL_I = 0.3
_INTEGRAL_MAX_M_S2 = 3.0
_ATTITUDE_P = 9.0
_YAW_SHARE = 0.22  # of the attitude gain: propellers turn a quadrotor weakly
_RATE_P = 22.0
_YAW_RATE_P = 6.0
_RATE_MAX_RAD_S = 3.8
_YAW_RATE_MAX_RAD_S = 1.6
_THRUST_MIN = 0.10  # of the full collective: below it the motors lose their authority


def _clamp(x: float, top: float) -> float:
    return top if x > top else -top if x < -top else x


class Control:
    """The state of the cascade: attitude setpoint `sp_*`, collective [N], integrators."""

    __slots__ = (
        "_arm_x4",
        "_arm_y4",
        "_int_d",
        "_int_e",
        "_int_n",
        "_ixx",
        "_iyy",
        "_izz",
        "_kappa4",
        "_mass",
        "_motor_max",
        "_tilt_max",
        "_yaw_torque_max",
        "collective",
        "hover_n",
        "rate_x",
        "rate_y",
        "rate_z",
        "rates_only",
        "sp_w",
        "sp_x",
        "sp_y",
        "sp_z",
        "strength_inv",
        "u1",
        "u2",
        "u3",
        "u4",
        "yaw_rate",
    )

    def __init__(self, airframe: Airframe) -> None:
        body, motors = airframe.body, airframe.motors
        self._mass = body.mass_kg
        self._ixx = body.inertia_xx_kg_m2
        self._iyy = body.inertia_yy_kg_m2
        self._izz = body.inertia_zz_kg_m2
        self._arm_x4 = 4.0 * motors.arm_forward_m
        self._arm_y4 = 4.0 * motors.arm_right_m
        self._kappa4 = 4.0 * motors.torque_per_thrust_m
        self._motor_max = motors.thrust_max_n
        self.hover_n = body.mass_kg * GRAVITY_M_S2
        self._yaw_torque_max = 0.6 * self.hover_n * motors.torque_per_thrust_m
        self._tilt_max = 0.7  # tangent of 35 degrees
        self.strength_inv = 1.0
        self.collective = 0.0
        self.rates_only = False
        self.rate_x = self.rate_y = self.rate_z = 0.0
        self.sp_w, self.sp_x, self.sp_y, self.sp_z = 1.0, 0.0, 0.0, 0.0
        self._int_n = self._int_e = self._int_d = 0.0
        self.yaw_rate = 0.0  # of the heading that is flown, fed forward [rad/s]
        self.u1 = self.u2 = self.u3 = self.u4 = 0.0

    @property
    def full_n(self) -> float:
        """Collective thrust at full throttle and full battery [N]."""
        return 4.0 * self._motor_max

    def reset(self) -> None:
        """Forget what the integrators learnt; on the ground they learn nonsense."""
        self._int_n = self._int_e = self._int_d = 0.0
        self.collective = 0.0
        self.rates_only = False

    def idle(self, speed: float) -> None:
        """All motors at the same speed, without control."""
        self.u1 = self.u2 = self.u3 = self.u4 = speed

    def outer(
        self,
        lag_ned: tuple[float, float, float],
        v_ref_ned: tuple[float, float, float],
        a_ref_ned: tuple[float, float, float],
        v_ned: tuple[float, float, float],
        yaw_rad: float,
        dt_s: float,
    ) -> None:
        """Position lag (reference minus estimate, 0 where position is not controlled),
        reference velocity and acceleration, estimated velocity -> attitude and collective."""
        err_n = v_ref_ned[0] + _POS_P * lag_ned[0] - v_ned[0]
        err_e = v_ref_ned[1] + _POS_P * lag_ned[1] - v_ned[1]
        err_d = v_ref_ned[2] + _POS_P * lag_ned[2] - v_ned[2]
        gain = _VEL_I * dt_s
        self._int_n = _clamp(self._int_n + gain * err_n, _INTEGRAL_MAX_M_S2)
        self._int_e = _clamp(self._int_e + gain * err_e, _INTEGRAL_MAX_M_S2)
        self._int_d = _clamp(self._int_d + gain * err_d, _INTEGRAL_MAX_M_S2)
        self.accelerate(
            a_ref_ned[0] + _VEL_P * err_n + self._int_n,
            a_ref_ned[1] + _VEL_P * err_e + self._int_e,
            a_ref_ned[2] + _VEL_P * err_d + self._int_d,
            yaw_rad,
        )

    def climb(self, v_ref_d: float, v_d: float, dt_s: float) -> None:
        """Collective alone, for modes that command the attitude themselves."""
        err_d = v_ref_d - v_d
        self._int_d = _clamp(self._int_d + _VEL_I * dt_s * err_d, _INTEGRAL_MAX_M_S2)
        lift = GRAVITY_M_S2 - (_VEL_P * err_d + self._int_d)
        self._set_collective(self._mass * (lift if lift > 0.0 else 0.0))

    def accelerate(self, a_n: float, a_e: float, a_d: float, yaw_rad: float) -> None:
        """Attitude and collective that give this acceleration [m/s^2, NED] and heading."""
        lift = GRAVITY_M_S2 - a_d
        if lift < 0.3 * GRAVITY_M_S2:
            lift = 0.3 * GRAVITY_M_S2
        flat = sqrt(a_n * a_n + a_e * a_e)
        most = self._tilt_max * lift
        if flat > most:
            a_n *= most / flat
            a_e *= most / flat
        size = sqrt(a_n * a_n + a_e * a_e + lift * lift)
        self._set_collective(self._mass * size)
        # Shortest turn from (0, 0, -1) to the thrust direction, after the turn by the heading.
        w = 1.0 + lift / size
        x = a_e / size
        y = -a_n / size
        scale = 1.0 / sqrt(w * w + x * x + y * y)
        w *= scale
        x *= scale
        y *= scale
        c = cos(0.5 * yaw_rad)
        s = sin(0.5 * yaw_rad)
        self.sp_w = w * c
        self.sp_x = x * c + y * s
        self.sp_y = y * c - x * s
        self.sp_z = w * s
        self.rates_only = False

    def thrust(self, part: float) -> None:
        """Collective as a part of full throttle."""
        self._set_collective(part * self.full_n)

    def _set_collective(self, thrust_n: float) -> None:
        low = _THRUST_MIN * self.full_n
        high = 0.95 * self.full_n
        self.collective = low if thrust_n < low else high if thrust_n > high else thrust_n

    def inner(self, body: RigidBody) -> None:
        """Attitude and rate loops and the mixer: leaves motor commands `u1 .. u4`, 0..1."""
        if not self.rates_only:
            # q_error = conj(q) q_setpoint; its vector part is half the turn that is missing.
            w, x, y, z = body.qw, -body.qx, -body.qy, -body.qz
            a, b, c, d = self.sp_w, self.sp_x, self.sp_y, self.sp_z
            turn = 2.0 * _ATTITUDE_P
            if w * a - x * b - y * c - z * d < 0.0:
                turn = -turn
            self.rate_x = _clamp(turn * (w * b + x * a + y * d - z * c), _RATE_MAX_RAD_S)
            self.rate_y = _clamp(turn * (w * c + y * a + z * b - x * d), _RATE_MAX_RAD_S)
            yaw_rate = self.yaw_rate + _YAW_SHARE * turn * (w * d + z * a + x * c - y * b)
            self.rate_z = _clamp(yaw_rate, _YAW_RATE_MAX_RAD_S)
        roll = self._ixx * _RATE_P * (self.rate_x - body.rate_x) / self._arm_y4
        pitch = self._iyy * _RATE_P * (self.rate_y - body.rate_y) / self._arm_x4
        most = self._yaw_torque_max
        yaw = self._izz * _YAW_RATE_P * (self.rate_z - body.rate_z)
        yaw = (most if yaw > most else -most if yaw < -most else yaw) / self._kappa4

        each = 0.25 * self.collective
        t1 = pitch - roll + yaw
        t2 = roll - pitch + yaw
        t3 = pitch + roll - yaw
        t4 = -pitch - roll - yaw
        # Tilt has priority over height: where a motor would saturate, the collective gives way.
        top = t1 if t1 > t2 else t2
        top = t3 if t3 > top else top
        top = t4 if t4 > top else top
        if each + top > self._motor_max:
            each = self._motor_max - top
        low = t1 if t1 < t2 else t2
        low = t3 if t3 < low else low
        low = t4 if t4 < low else low
        if each + low < 0.0:
            each = -low
        scale = self.strength_inv
        full = self._motor_max
        self.u1 = _speed((each + t1) / full, scale)
        self.u2 = _speed((each + t2) / full, scale)
        self.u3 = _speed((each + t3) / full, scale)
        self.u4 = _speed((each + t4) / full, scale)


def _speed(thrust: float, strength_inv: float) -> float:
    """Speed command for a thrust (0..1), made up for the battery's sag."""
    if thrust <= 0.0:
        return 0.0
    u = sqrt(thrust) * strength_inv
    return 1.0 if u > 1.0 else u
