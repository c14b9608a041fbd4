"""MAVLink's units of the vehicle's SI values."""

from __future__ import annotations

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
