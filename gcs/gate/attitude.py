"""An attitude with a thrust, as a client asks for it, and what its thrust means to the vehicle.

A thrust alone says nothing about a motion.  To PX4 it is a share of full collective thrust, of
which the share that carries the weight is a parameter of the vehicle; to ArduCopter in GUIDED it is
a climb rate.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TypeAlias

from gcs.frames import Vec3

Quat: TypeAlias = tuple[float, float, float, float]
"""w, x, y, z; turns vectors of the body (forward, right, down) into north, east, down."""


@dataclass(frozen=True, slots=True)
class HoverThrust:
    """Thrust is a share of full collective thrust; `share` is that at which the vehicle says that
    it hovers."""

    share: float


@dataclass(frozen=True, slots=True)
class ClimbRate:
    """Thrust is a climb rate, and the vehicle makes up for the tilt itself: 0.5 keeps the height,
    1 climbs at `up_m_s`, 0 descends at `down_m_s`."""

    up_m_s: float
    down_m_s: float


@dataclass(frozen=True, slots=True)
class UnknownThrust:
    """What thrust means is not known, and why."""

    why: str


ThrustMeaning: TypeAlias = HoverThrust | ClimbRate | UnknownThrust

NOT_TOLD = UnknownThrust("the vehicle has not told what a thrust means to it")


@dataclass(frozen=True, slots=True)
class Attitude:
    """Where the body is to point, and how much it is to thrust, 0 to 1."""

    q_ned_from_frd: Quat
    thrust: float
    means: ThrustMeaning = NOT_TOLD

    @property
    def up_ned(self) -> Vec3:
        """The direction of the thrust: the body's up, a unit vector of a unit quaternion."""
        w, x, y, z = self.q_ned_from_frd
        return (
            -2.0 * (x * z + w * y),
            -2.0 * (y * z - w * x),
            -(w * w - x * x - y * y + z * z),
        )

    @property
    def tilt_deg(self) -> float:
        """Between the thrust and straight up."""
        north, east, down = self.up_ned
        return math.degrees(math.atan2(math.hypot(north, east), -down))

    @property
    def down_m_s(self) -> float | None:
        """The vertical speed that the thrust asks for, positive down; None where it asks for
        none."""
        if not isinstance(self.means, ClimbRate):
            return None
        part = 2.0 * self.thrust - 1.0
        return -part * (self.means.up_m_s if part > 0.0 else self.means.down_m_s)

    @property
    def numbers(self) -> Sequence[float]:
        """All of them, for the check that they are finite."""
        match self.means:
            case HoverThrust(share):
                meant: tuple[float, ...] = (share,)
            case ClimbRate(up_m_s, down_m_s):
                meant = (up_m_s, down_m_s)
            case UnknownThrust():
                meant = ()
        return (*self.q_ned_from_frd, self.thrust, *meant)


def attitude_of(roll_rad: float, pitch_rad: float, yaw_rad: float) -> Quat:
    """The quaternion of a heading, then a pitch (nose up), then a roll (to the right)."""
    cr, sr = math.cos(0.5 * roll_rad), math.sin(0.5 * roll_rad)
    cp, sp = math.cos(0.5 * pitch_rad), math.sin(0.5 * pitch_rad)
    cy, sy = math.cos(0.5 * yaw_rad), math.sin(0.5 * yaw_rad)
    return (
        cr * cp * cy + sr * sp * sy,
        sr * cp * cy - cr * sp * sy,
        cr * sp * cy + sr * cp * sy,
        cr * cp * sy - sr * sp * cy,
    )


def roll_pitch_yaw(q_ned_from_frd: Quat) -> Vec3:
    """The same back, of a unit quaternion: radians."""
    w, x, y, z = q_ned_from_frd
    return (
        math.atan2(2.0 * (w * x + y * z), 1.0 - 2.0 * (x * x + y * y)),
        math.asin(max(-1.0, min(1.0, 2.0 * (w * y - x * z)))),
        math.atan2(2.0 * (w * z + x * y), 1.0 - 2.0 * (y * y + z * z)),
    )
