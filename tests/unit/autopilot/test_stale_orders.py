"""Orders that come late, twice, or in the wrong state: none of them may lose the vehicle."""

from __future__ import annotations

import math

import pytest

from tests.unit.autopilot.hand_flight import HandFlight
from vehicle_sim.autopilot.interface import Geodetic, Result
from vehicle_sim.autopilot.modes import Personality
from vehicle_sim.control_loops import flight as flight_block
from vehicle_sim.control_loops.flight import TO
from vehicle_sim.control_loops.trajectory import move_reference
from vehicle_sim.estimation.estimated import Estimated

BOTH: tuple[Personality, ...] = ("px4", "ardupilot")


@pytest.mark.parametrize(("personality", "mode"), [("px4", "MANUAL"), ("ardupilot", "STABILIZE")])
def test_a_manual_mode_does_not_begin_with_sticks_that_fell_silent_long_ago(
    personality: Personality, mode: str
) -> None:
    flight = HandFlight.hovering(personality, 20.0)
    flight.hold(0.3, right=1000, up=0)
    flight.fly(10.0)  # a failsafe has taken the vehicle
    flight.vehicle.set_mode_kind("hold")
    flight.fly(10.0)
    height_m = flight.up_m
    # PX4 does not even enter it: what is silent is no input (B4).
    entered = Result.ACCEPTED if personality == "ardupilot" else Result.TEMPORARILY_REJECTED
    assert flight.mode(mode) is entered
    flight.fly(3.0)
    assert flight.up_m == pytest.approx(height_m, abs=1.0)
    assert flight.flat_m_s < 2.0


def test_the_reference_goes_on_for_a_vehicle_that_is_ahead_of_it() -> None:
    """Else both would stand still for good: ahead by more than the reference waits for."""
    flight = flight_block.Flight(horizontal=TO, vertical=TO, goal_n=100.0, speed_m_s=5.0)
    flight.accel_m_s2 = flight.accel_vertical_m_s2 = flight.accel_up_m_s2 = 3.0
    flight.jerk_m_s3 = 10.0
    estimated = Estimated()
    estimated.pos_n = 2.0 * flight.lead_max_m
    for _ in range(250):
        move_reference(flight, estimated, 0.02)
    assert flight.ref_n > flight.lead_max_m


@pytest.mark.parametrize("personality", BOTH)
def test_a_leader_of_absurd_speed_does_not_take_the_follower_along(
    personality: Personality,
) -> None:
    flight = HandFlight(personality)
    if personality == "ardupilot":
        flight.vehicle.parameters.set("FOLL_ENABLE", 1.0)
    flight.airborne(20.0)
    assert flight.vehicle.set_mode_kind("follow") is Result.ACCEPTED
    home = flight.vehicle.home
    assert home is not None
    for _ in range(100):
        wall_ns = flight.vehicle.time_ns
        where = Geodetic(home.lat_deg, home.lon_deg, home.alt_amsl_m + 20.0)
        flight.vehicle.hear_leader(9, where, (900.0, -900.0, 0.0), None, wall_ns)
        flight.fly(0.1)
    flight.fly(20.0)
    stopped = flight.pos
    flight.fly(5.0)
    assert math.dist(stopped, flight.pos) < 1.0
    assert flight.up_m > 5.0
    assert flight.vehicle.set_mode_kind("return") is Result.ACCEPTED
    flight.fly(150.0, lambda: not flight.vehicle.armed)
    assert math.hypot(*flight.pos[:2]) < 2.0


def test_an_empty_battery_carries_nobody() -> None:
    """PX4 only warns of a low battery by default (COM_LOW_BAT_ACT 0): it flies on till it falls."""
    flight = HandFlight.hovering("px4", 5.0)
    body = flight.vehicle.blocks.body
    body.consumed_mah = 5000.0
    flight.fly(300.0, lambda: flight.up_m < 0.1)
    assert flight.up_m < 0.1
    assert flight.vehicle.truth.battery == 0.0


@pytest.mark.parametrize("personality", BOTH)
def test_a_heading_of_many_turns_is_that_heading(personality: Personality) -> None:
    """Within a step's time: such numbers come from clients that mix up units."""
    flight = HandFlight.hovering(personality, 5.0)
    wanted_rad = math.remainder(1e300, 2.0 * math.pi)
    assert flight.vehicle.reposition(flight.pos, 1e300, None) is Result.ACCEPTED
    flight.fly(8.0)
    off_rad = math.remainder(flight.vehicle.estimate.heading_rad - wanted_rad, 2.0 * math.pi)
    assert abs(off_rad) < 0.1
