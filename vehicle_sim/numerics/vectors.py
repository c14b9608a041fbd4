"""Vectors and quaternions in plain floats: w, x, y, z, from the body's axes to NED."""

from __future__ import annotations

import math
from typing import TypeAlias

Vec3: TypeAlias = tuple[float, float, float]
Quat: TypeAlias = tuple[float, float, float, float]


def euler_rad(q: Quat) -> Vec3:
    """Roll, pitch, yaw of a w, x, y, z quaternion (body to NED, z-y-x order)."""
    w, x, y, z = q
    roll = math.atan2(2.0 * (w * x + y * z), 1.0 - 2.0 * (x * x + y * y))
    pitch = math.asin(max(-1.0, min(1.0, 2.0 * (w * y - z * x))))
    yaw = math.atan2(2.0 * (w * z + x * y), 1.0 - 2.0 * (y * y + z * z))
    return (roll, pitch, yaw)
