"""What the accelerometer tells beside the motion: the air that blows, and how the board shakes.

Across the rotors' axis nothing but drag pushes a multicopter, so the specific force along body x
and y is the drag, and the drag is the airspeed: PX4's multi-rotor drag fusion (EKF2_DRAG_CTRL),
reduced to one equation and a low-pass filter.  The vertical motion of the air is not seen.
"""

from __future__ import annotations

from math import sqrt
from typing import Final

from vehicle_sim.control_loops.believed import Believed
from vehicle_sim.estimation.estimated import Estimated
from vehicle_sim.numerics.vectors import Vec3
from vehicle_sim.plant.sensed import Sensed

_SMOOTH_S: Final = 3.0
_TRUSTED_S: Final = 6.0
"""So long the filter must have run before its wind is told."""
_UPRIGHT_LEAST: Final = 0.5
_QUICK: Final = 0.5  # part of a new sample: what is slower is motion
_SLOW: Final = 0.1  # part of a new sample in the mean square of the rest


class Airflow:
    """`update` ten times a second."""

    __slots__ = ("_flown_s", "_mean", "_power", "_wind_e", "_wind_n")

    def __init__(self) -> None:
        self.forget()

    def forget(self) -> None:
        self._wind_n = self._wind_e = self._flown_s = 0.0
        self._mean: Vec3 | None = None
        self._power: Vec3 = (0.0, 0.0, 0.0)

    @property
    def wind_ned(self) -> Vec3 | None:
        """Where the air goes [m/s]; None = not flown long enough to know."""
        if self._flown_s < _TRUSTED_S:
            return None
        return (self._wind_n, self._wind_e, 0.0)

    @property
    def vibration_m_s2(self) -> Vec3:
        """Root mean square of the specific force less its slow part, FRD."""
        return (sqrt(self._power[0]), sqrt(self._power[1]), sqrt(self._power[2]))

    def shake(self, sensed: Sensed) -> None:
        felt = (sensed.accel_x, sensed.accel_y, sensed.accel_z)
        mean = felt if self._mean is None else self._mean
        rest = (felt[0] - mean[0], felt[1] - mean[1], felt[2] - mean[2])
        self._mean = (
            mean[0] + _QUICK * rest[0],
            mean[1] + _QUICK * rest[1],
            mean[2] + _QUICK * rest[2],
        )
        power = self._power
        self._power = (
            power[0] + _SLOW * (rest[0] * rest[0] - power[0]),
            power[1] + _SLOW * (rest[1] * rest[1] - power[1]),
            power[2] + _SLOW * (rest[2] * rest[2] - power[2]),
        )

    def update(
        self, est: Estimated, sensed: Sensed, spin: float, believed: Believed, dt_s: float
    ) -> None:
        """In flight; `spin` is the sum of the motors' speeds, each 0..1."""
        drag_x, drag_y = believed.mass_kg * sensed.accel_x, believed.mass_kg * sensed.accel_y
        drag = sqrt(drag_x * drag_x + drag_y * drag_y)
        # (rotors + body v) v = drag
        rotors, body = believed.rotor_drag_n_s_per_m * spin, believed.drag_n_per_m2_s2
        speed = (sqrt(rotors * rotors + 4.0 * body * drag) - rotors) / (2.0 * body)
        scale = -speed / drag if drag > 0.0 else 0.0
        x, y = scale * drag_x, scale * drag_y
        w, qx, qy, qz = est.qw, est.qx, est.qy, est.qz
        upright = 1.0 - 2.0 * (qx * qx + qy * qy)
        if upright < _UPRIGHT_LEAST:
            return
        # Along body z, so that the air itself neither rises nor sinks.
        z = (est.vel_d - 2.0 * (qx * qz - w * qy) * x - 2.0 * (qy * qz + w * qx) * y) / upright
        air_n = (
            (1.0 - 2.0 * (qy * qy + qz * qz)) * x
            + 2.0 * (qx * qy - w * qz) * y
            + 2.0 * (qx * qz + w * qy) * z
        )
        air_e = (
            2.0 * (qx * qy + w * qz) * x
            + (1.0 - 2.0 * (qx * qx + qz * qz)) * y
            + 2.0 * (qy * qz - w * qx) * z
        )
        self._flown_s += dt_s
        part = dt_s / (min(_SMOOTH_S, self._flown_s) + dt_s)
        self._wind_n += part * (est.vel_n - air_n - self._wind_n)
        self._wind_e += part * (est.vel_e - air_e - self._wind_e)
