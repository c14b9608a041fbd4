"""OFFBOARD that is asked for while the vehicle still climbs."""

from __future__ import annotations

from vehicle_sim.autopilot.autopilot import Autopilot
from vehicle_sim.autopilot.interface import Geodetic, Result, Setpoint

HOME = Geodetic(47.397742, 8.545594, 488.0)
STEPS_A_SECOND = 250
SETPOINT_EVERY = 12
"""Steps: about 20 Hz."""


def fly(vehicle: Autopilot, seconds: float, streaming: bool) -> None:
    for step in range(round(seconds * STEPS_A_SECOND)):
        if streaming and step % SETPOINT_EVERY == 0:
            vehicle.set_setpoint(Setpoint(pos_ned=(0.0, 0.0, -2.0)))
        vehicle.step()


def test_a_stream_that_begins_near_the_end_of_the_climb_is_followed_after_it() -> None:
    vehicle = Autopilot("px4", HOME, seed=1)
    fly(vehicle, 2.0, streaming=False)
    assert vehicle.arm(False) is Result.ACCEPTED
    assert vehicle.take_off(2.0) is Result.ACCEPTED
    while vehicle.truth.pos_ned[2] > -1.0:  # it ends NAV_MC_ALT_RAD below the height
        fly(vehicle, 0.1, streaming=False)
    vehicle.set_setpoint(Setpoint(pos_ned=(0.0, 0.0, -2.0)))
    assert vehicle.mode_name == "AUTO.TAKEOFF"
    assert vehicle.set_mode_kind("guided") is Result.ACCEPTED
    fly(vehicle, 4.0, streaming=True)
    assert vehicle.mode_name == "OFFBOARD"
