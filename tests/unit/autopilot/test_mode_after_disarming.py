"""PX4 goes back, when it disarms, to the last mode that was asked for and that may be armed in.

Rows: `behaviour.json` "mode after a landing that was flown from OFFBOARD"; the scenarios named.
"""

from __future__ import annotations

from tests.unit.autopilot.flight import Flight, item
from vehicle_sim.autopilot.interface import Result, Setpoint
from vehicle_sim.autopilot.modes import MODES

HOVER = Setpoint(pos_ned=(0.0, 0.0, -5.0))


def mode(flight: Flight, name: str) -> Result:
    return flight.vehicle.set_mode(1, MODES["px4"][name].custom_mode)


def landed(flight: Flight) -> Flight:
    flight.fly(60.0, lambda: not flight.vehicle.armed)
    return flight


def offboard() -> Flight:
    """In the air, flown by setpoints."""
    flight = Flight.hovering("px4")
    flight.stream(HOVER, 1.5)
    assert mode(flight, "OFFBOARD") is Result.ACCEPTED
    flight.stream(HOVER, 1.0)
    assert flight.vehicle.mode_name == "OFFBOARD"
    return flight


def test_landed_from_offboard_it_is_in_offboard_and_does_not_arm() -> None:
    """F4_velocity_against_circle and F5d_gf_action_none."""
    flight = offboard()
    assert flight.vehicle.land() is Result.ACCEPTED
    landed(flight)
    assert flight.vehicle.mode_name == "OFFBOARD"
    assert flight.vehicle.base_mode == 17
    assert flight.vehicle.arm(False) is Result.TEMPORARILY_REJECTED
    assert not flight.armable()


def test_another_mode_lets_it_arm_again() -> None:
    flight = offboard()
    assert flight.vehicle.land() is Result.ACCEPTED
    landed(flight)
    assert mode(flight, "AUTO.LOITER") is Result.ACCEPTED
    assert flight.vehicle.arm(False) is Result.ACCEPTED


def test_landed_from_hold_it_holds() -> None:
    """A5_takeoff_hold_only, and a dozen more."""
    flight = Flight.hovering("px4")
    assert flight.vehicle.land() is Result.ACCEPTED
    assert landed(flight).vehicle.mode_name == "AUTO.LOITER"


def test_returned_after_a_hold_it_holds() -> None:
    """I2_takeoff_and_goto_profiles: RTL may not be armed in."""
    flight = Flight.hovering("px4")
    assert flight.vehicle.return_home() is Result.ACCEPTED
    assert landed(flight).vehicle.mode_name == "AUTO.LOITER"


def test_what_a_failsafe_flew_does_not_count() -> None:
    """B1_posctl_takeoff_stream_stops_0.6s: POSCTL, a failsafe's LOITER and RTL, then POSCTL."""
    flight = Flight.hovering("px4")
    for _ in range(40):
        flight.vehicle.joystick(0, 0, 500, 0, flight.vehicle.time_ns)
        flight.fly(0.05)
    assert mode(flight, "POSCTL") is Result.ACCEPTED
    flight.fly(30.0, lambda: flight.vehicle.mode_name == "AUTO.RTL")
    assert landed(flight).vehicle.mode_name == "POSCTL"


def test_a_mission_that_landed_stays_the_mode() -> None:
    """C12_plan_without_takeoff_modes."""
    flight = Flight("px4").boot()
    flight.vehicle.load_plan((item(0, 22, up_m=3.0), item(1, 21)))
    assert mode(flight, "AUTO.MISSION") is Result.ACCEPTED
    assert flight.vehicle.arm(False) is Result.ACCEPTED
    assert landed(flight).vehicle.mode_name == "AUTO.MISSION"


def test_landed_by_command_out_of_a_mission_it_is_in_the_mission_again() -> None:
    """F7_mission_through_fence."""
    flight = Flight("px4").boot()
    flight.vehicle.load_plan((item(0, 22, up_m=3.0), item(1, 16, 20.0, 0.0, 3.0)))
    assert mode(flight, "AUTO.MISSION") is Result.ACCEPTED
    assert flight.vehicle.arm(False) is Result.ACCEPTED
    flight.fly(5.0)
    assert flight.vehicle.land() is Result.ACCEPTED
    assert landed(flight).vehicle.mode_name == "AUTO.MISSION"
