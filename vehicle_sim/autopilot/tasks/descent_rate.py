"""How fast a landing sinks."""

from __future__ import annotations

from math import inf

from vehicle_sim.autopilot.parameters.parameters import Parameters, Quantity


def descent_m_s(parameters: Parameters, up_m: float, usual_m_s: float) -> float:
    """At `up_m` above home; `usual_m_s` is the descent of the vehicle's other flights.

    PX4 slows down from MPC_LAND_ALT1 to MPC_LAND_ALT2 (FlightTaskAuto); ArduCopter at
    LAND_ALT_LOW, and comes down to it at LAND_SPEED_HIGH.
    """
    top_m = parameters.si(Quantity.LAND_SLOW_BELOW_M)
    if up_m >= top_m:
        high = parameters.rules.land_speed_high
        return usual_m_s if high is None else 0.01 * parameters.get(high) or usual_m_s
    slow_m_s = parameters.si(Quantity.LAND_M_S)
    slowest_below = parameters.rules.land_slowest_below
    low_m = inf if slowest_below is None else parameters.get(slowest_below)
    if up_m > low_m:
        return slow_m_s + (usual_m_s - slow_m_s) * (up_m - low_m) / (top_m - low_m)
    return slow_m_s


def without_sticks_m_s(parameters: Parameters) -> float:
    """Of PX4's position mode without sticks, which keeps its place and comes down to the ground.

    Recorded with 0.70 to 0.85 m/s after OFFBOARD was lost (behaviour.json): half of
    MPC_Z_VEL_MAX_DN.
    """
    return 0.5 * parameters.get("MPC_Z_VEL_MAX_DN")
