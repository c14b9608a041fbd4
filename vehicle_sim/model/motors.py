"""Four motors with propellers: command -> speed (first-order lag) -> thrust and torque."""

from __future__ import annotations

from vehicle_sim.model.airframe import MotorSet


class Motors:
    """Speeds `s1 .. s4` as fractions of full speed, and what they do to the body.

    Thrust is `thrust_max * s^2` upwards; its reaction torque about the yaw axis is
    `torque_per_thrust` times the thrust, to the right (clockwise from above) for the propellers
    that turn to the left.  Positions in FRD: 1 (+,+) ccw, 2 (-,-) ccw, 3 (+,-) cw, 4 (-,+) cw.
    """

    __slots__ = (
        "_arm_x",
        "_arm_y",
        "_gain",
        "_kappa",
        "_keep",
        "_thrust_max",
        "s1",
        "s2",
        "s3",
        "s4",
        "thrust",
        "torque_x",
        "torque_y",
        "torque_z",
    )

    def __init__(self, motors: MotorSet, dt_s: float) -> None:
        self._arm_x = motors.arm_forward_m
        self._arm_y = motors.arm_right_m
        self._thrust_max = motors.thrust_max_n
        self._kappa = motors.torque_per_thrust_m
        tau = motors.time_constant_s
        # The bilinear form of exp(-dt/tau): arithmetic only, the same on every machine.
        self._keep = (2.0 * tau - dt_s) / (2.0 * tau + dt_s)
        self._gain = 1.0 - self._keep
        self.s1 = self.s2 = self.s3 = self.s4 = 0.0
        self.thrust = self.torque_x = self.torque_y = self.torque_z = 0.0

    def advance(self, u1: float, u2: float, u3: float, u4: float) -> None:
        """One step towards the speeds `u` (0..1); leaves thrust [N] and torque [N m, FRD]."""
        keep = self._keep
        gain = self._gain
        s1 = keep * self.s1 + gain * u1
        s2 = keep * self.s2 + gain * u2
        s3 = keep * self.s3 + gain * u3
        s4 = keep * self.s4 + gain * u4
        self.s1 = s1
        self.s2 = s2
        self.s3 = s3
        self.s4 = s4
        top = self._thrust_max
        t1 = top * s1 * s1
        t2 = top * s2 * s2
        t3 = top * s3 * s3
        t4 = top * s4 * s4
        # Each pair is symmetric, so a mirrored command gives an exactly mirrored torque.
        right = t1 + t4
        left = t2 + t3
        front = t1 + t3
        rear = t2 + t4
        self.thrust = left + right
        self.torque_x = (left - right) * self._arm_y
        self.torque_y = (front - rear) * self._arm_x
        self.torque_z = ((t1 + t2) - (t3 + t4)) * self._kappa
