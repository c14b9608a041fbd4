"""How high a vehicle flies home: the return height, less from near by."""

from __future__ import annotations

from collections.abc import Callable
from math import hypot, radians, tan

from vehicle_sim.autopilot.modes import Personality
from vehicle_sim.autopilot.parameters.parameters import Parameters, Quantity
from vehicle_sim.numerics.vectors import Vec3

_CONE_DEG = (1.0, 89.0)
_FLATTEST = 0.5  # ArduCopter's least slope
_CLIMB_LEAST_M = 2.5  # ArduCopter climbs so much before it heeds its cone


def return_up_m(parameters: Parameters, ground_ned: Vec3, from_ned: Vec3) -> float:
    """Metres above the ground that the return leads to; it never descends to get there."""
    away_m = hypot(from_ned[0] - ground_ned[0], from_ned[1] - ground_ned[1])
    up_m = ground_ned[2] - from_ned[2]
    return max(up_m, _RETURN_UP_M[parameters.personality](parameters, away_m, up_m))


def _px4(parameters: Parameters, away_m: float, up_m: float) -> float:
    """RTL::calculate_return_alt_from_cone_half_angle."""
    top_m = parameters.si(Quantity.RETURN_UP_M)
    near_m = parameters.si(Quantity.ACCEPT_M)
    cone_deg = parameters.get("RTL_CONE_ANG")
    if cone_deg == 0.0:
        return top_m
    if away_m <= near_m:
        return 2.0 * away_m
    if away_m <= parameters.get("RTL_MIN_DIST"):
        half_angle = radians(min(max(cone_deg, _CONE_DEG[0]), _CONE_DEG[1]))
        top_m = min(top_m, away_m / tan(half_angle))
    return max(top_m, 2.0 * near_m)


def _copter(parameters: Parameters, away_m: float, up_m: float) -> float:
    """ModeRTL::compute_return_target."""
    climb_m = 0.01 * parameters.get("RTL_CLIMB_MIN")
    top_m = max(parameters.si(Quantity.RETURN_UP_M), up_m + climb_m)
    slope = parameters.get("RTL_CONE_SLOPE")
    if slope < _FLATTEST:
        return top_m
    return min(top_m, max(away_m * slope, up_m + _CLIMB_LEAST_M))


_RETURN_UP_M: dict[Personality, Callable[[Parameters, float, float], float]] = {
    "px4": _px4,
    "ardupilot": _copter,
}
"""The return height by the distance from where it leads to, and by the height now [m]."""
