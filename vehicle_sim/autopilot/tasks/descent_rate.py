"""How fast a landing sinks, by its height."""

from __future__ import annotations

from vehicle_sim.autopilot.parameters.parameters import Parameters, Quantity


def descent_m_s(parameters: Parameters, up_m: float, usual_m_s: float) -> float:
    """At `up_m` above home; `usual_m_s` is the descent of the vehicle's other flights.

    PX4 slows down from MPC_LAND_ALT1 to MPC_LAND_ALT2 (FlightTaskAuto); ArduCopter at
    LAND_ALT_LOW, and comes down to it at LAND_SPEED_HIGH.
    """
    slow_m_s = parameters.si(Quantity.LAND_M_S)
    top_m = parameters.si(Quantity.LAND_SLOW_BELOW_M)
    if parameters.personality == "px4":
        low_m = parameters.get("MPC_LAND_ALT2")
        if up_m < top_m and up_m > low_m:
            return slow_m_s + (usual_m_s - slow_m_s) * (up_m - low_m) / (top_m - low_m)
    elif up_m >= top_m:
        return 0.01 * parameters.get("LAND_SPEED_HIGH") or usual_m_s
    return slow_m_s if up_m < top_m else usual_m_s
