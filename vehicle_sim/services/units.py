"""MAVLink's units of the vehicle's SI values."""

from __future__ import annotations

import math
from typing import Final

from vehicle_sim.autopilot.interface import Vehicle

UINT16_MAX: Final = 0xFFFF
INT16_MAX: Final = 0x7FFF


def boot_ms(vehicle: Vehicle) -> int:
    return vehicle.clock_ns // 1_000_000 & 0xFFFFFFFF


def usec(vehicle: Vehicle) -> int:
    """Since boot; MAVLink lets a receiver tell it from a Unix time by its size."""
    return vehicle.clock_ns // 1000


def degrees_e7(degrees: float) -> int:
    return round(degrees * 1e7)


def millimetres(metres: float) -> int:
    return round(metres * 1000.0)


def clip_int16(value: float) -> int:
    return max(-INT16_MAX, min(INT16_MAX, round(value)))


def clip_uint16(value: float) -> int:
    return max(0, min(UINT16_MAX - 1, round(value)))


def euler_rad(q: tuple[float, float, float, float]) -> tuple[float, float, float]:
    """Roll, pitch, yaw of a w, x, y, z quaternion (body to NED, z-y-x order)."""
    w, x, y, z = q
    roll = math.atan2(2.0 * (w * x + y * z), 1.0 - 2.0 * (x * x + y * y))
    pitch = math.asin(max(-1.0, min(1.0, 2.0 * (w * y - z * x))))
    yaw = math.atan2(2.0 * (w * z + x * y), 1.0 - 2.0 * (y * y + z * z))
    return (roll, pitch, yaw)
