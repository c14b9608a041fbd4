"""Manual modes, flown: take-off, climb, motion, turning, braking and landing by stick."""

from __future__ import annotations

from math import hypot, pi

import pytest

from tests.unit.autopilot.hand_flight import HandFlight
from vehicle_sim.autopilot.interface import Landed, Result, Setpoint
from vehicle_sim.autopilot.modes import Personality

POSITION = [("px4", "POSCTL"), ("ardupilot", "LOITER"), ("ardupilot", "POSHOLD")]
ALTITUDE = [("px4", "ALTCTL"), ("ardupilot", "ALT_HOLD")]
THRUST = [("px4", "STABILIZED"), ("px4", "MANUAL"), ("ardupilot", "STABILIZE")]


@pytest.mark.parametrize(("personality", "mode"), POSITION)
def test_position_modes_take_off_move_brake_stay_and_land(
    personality: Personality, mode: str
) -> None:
    flight = HandFlight.by_hand(personality, mode)
    assert flight.landed() is Landed.IN_AIR
    height_m = flight.up_m
    assert height_m > 2.0
    flight.hold(3.0, forward=600)
    assert flight.vehicle.truth.v_ned[0] > 2.0
    assert abs(flight.vehicle.truth.v_ned[1]) < 0.5
    flight.hold(5.0)
    assert flight.flat_m_s < 0.4
    north, east, _ = flight.pos
    flight.hold(5.0)
    assert hypot(flight.pos[0] - north, flight.pos[1] - east) < 0.8
    assert flight.up_m == pytest.approx(height_m, abs=1.0)
    flight.hold(25.0, up=0)
    assert flight.landed() is Landed.ON_GROUND
    assert ("Landing detected" in flight.texts()) is (personality == "px4")


@pytest.mark.parametrize(("personality", "mode"), ALTITUDE)
def test_altitude_modes_hold_the_height_and_drift_on(personality: Personality, mode: str) -> None:
    flight = HandFlight.by_hand(personality, mode)
    height_m = flight.up_m
    assert height_m > 2.0
    flight.hold(3.0, right=500)
    fast_m_s = flight.vehicle.truth.v_ned[1]
    assert fast_m_s > 2.5
    assert flight.up_m == pytest.approx(height_m, abs=1.0)
    flight.hold(1.0)
    # Nothing brakes but the air.
    assert 0.5 * fast_m_s < flight.vehicle.truth.v_ned[1] < fast_m_s
    flight.hold(25.0, up=0)
    assert flight.landed() is Landed.ON_GROUND


@pytest.mark.parametrize(("personality", "mode"), THRUST)
def test_thrust_modes_climb_and_sink_with_the_throttle(personality: Personality, mode: str) -> None:
    flight = HandFlight(personality)
    flight.fly(20.0)
    assert flight.mode(mode) is Result.ACCEPTED
    flight.hold(0.5, up=0)
    assert flight.vehicle.arm(False) is Result.ACCEPTED
    flight.hold(3.0, up=200)  # ArduCopter's motors only idle for so long after the arming
    assert flight.landed() is Landed.ON_GROUND
    flight.hold(2.0, up=750)
    assert flight.vehicle.truth.v_ned[2] < -1.0
    flight.hold(1.0, up=0)
    falling_m_s = flight.vehicle.truth.v_ned[2]
    flight.hold(0.3, up=0)
    assert flight.vehicle.truth.v_ned[2] > falling_m_s + 1.0, "nothing holds it"


@pytest.mark.parametrize(("personality", "mode"), [*POSITION, *ALTITUDE, *THRUST])
def test_the_yaw_stick_turns_clockwise_and_the_heading_stays_afterwards(
    personality: Personality, mode: str
) -> None:
    flight = HandFlight.by_hand(personality, mode)
    before = flight.vehicle.estimate.heading_rad
    flight.hold(1.0, clockwise=500)
    flight.hold(1.0)
    turned = (flight.vehicle.estimate.heading_rad - before) % (2.0 * pi)
    assert 0.4 < turned < pi
    after = flight.vehicle.estimate.heading_rad
    flight.hold(2.0)
    still = (flight.vehicle.estimate.heading_rad - after + pi) % (2.0 * pi) - pi
    assert abs(still) < 0.1


@pytest.mark.parametrize(("personality", "mode"), POSITION[:2])
def test_the_sticks_are_in_the_frame_of_the_heading(personality: Personality, mode: str) -> None:
    flight = HandFlight.by_hand(personality, mode)
    flight.vehicle.condition_yaw(0.5 * pi, False, 1.0, 1)
    flight.hold(6.0)
    flight.hold(2.5, forward=700)
    north, east, _ = flight.vehicle.truth.v_ned
    assert east > 1.5
    assert abs(north) < 0.25 * east


@pytest.mark.parametrize(("personality", "mode"), [("px4", "ACRO"), ("ardupilot", "ACRO")])
def test_acro_turns_at_a_rate_and_does_not_level_itself(
    personality: Personality, mode: str
) -> None:
    flight = HandFlight.by_hand(personality, mode)
    right = 150 if personality == "ardupilot" else 500
    flight.hold(0.5, right=right, up=600)
    leaning = flight.vehicle.truth.q_ned_from_frd[1]
    flight.hold(0.5, up=600)
    assert leaning > 0.1
    assert flight.vehicle.truth.q_ned_from_frd[1] > 0.5 * leaning


def test_without_any_stick_a_manual_mode_holds_its_height() -> None:
    """ArduCopter's; PX4 does not enter it."""
    flight = HandFlight.hovering("ardupilot", 5.0)
    assert flight.vehicle.set_mode_kind("manual") is Result.ACCEPTED
    flight.fly(5.0)
    assert flight.up_m == pytest.approx(5.0, abs=1.0)


@pytest.mark.parametrize(("personality", "mode"), POSITION[:2])
def test_sticks_that_fall_silent_count_as_centred(personality: Personality, mode: str) -> None:
    flight = HandFlight.by_hand(personality, mode)
    failsafe = {"px4": ("NAV_RCL_ACT", 1), "ardupilot": ("FS_THR_ENABLE", 0)}
    flight.vehicle.parameters.set(*failsafe[personality])
    flight.hold(2.0, forward=1000)
    assert flight.flat_m_s > 1.5
    flight.fly(14.0)
    assert flight.flat_m_s < 0.6


def test_px4_gives_an_automatic_flight_to_a_pilot_who_moves_a_stick() -> None:
    flight = HandFlight.hovering("px4", 5.0)
    flight.hold(0.5)
    assert flight.vehicle.mode_name == "AUTO.LOITER"
    flight.hold(0.3, forward=400)
    assert flight.vehicle.mode_name == "POSCTL"
    assert "Pilot took over using sticks" in flight.texts()


def test_px4_keeps_an_automatic_flight_where_sticks_may_not_take_over() -> None:
    flight = HandFlight.hovering("px4", 5.0)
    flight.vehicle.parameters.set("COM_RC_OVERRIDE", 0)
    flight.hold(0.5, forward=1000)
    assert flight.vehicle.mode_name == "AUTO.LOITER"


@pytest.mark.parametrize(("personality", "mode"), [("px4", "POSCTL"), ("ardupilot", "STABILIZE")])
def test_arming_and_disarming_with_the_stick_in_the_corner(
    personality: Personality, mode: str
) -> None:
    flight = HandFlight(personality)
    flight.fly(20.0)
    assert flight.mode(mode) is Result.ACCEPTED
    flight.hold(3.0, up=0, clockwise=1000)
    assert flight.vehicle.armed
    flight.hold(0.5, up=0)
    flight.hold(3.0, up=0, clockwise=-1000)
    assert not flight.vehicle.armed


def test_ardupilots_mode_channel_changes_the_mode() -> None:
    flight = HandFlight.hovering("ardupilot", 5.0)
    ignore = 65535
    for _ in range(6):
        flight.vehicle.override_channels(
            (ignore, ignore, ignore, ignore, 1425, *(ignore for _ in range(13))),
            flight.vehicle.time_ns,
        )
        flight.fly(0.1)
    assert flight.vehicle.mode_name == "RTL"


@pytest.mark.parametrize("height_m", [3.0, 7.0])
def test_px4_flies_a_velocity_over_ground_at_a_height(height_m: float) -> None:
    """Position of one axis and velocity of the others, in one setpoint."""
    nan = float("nan")
    flight = HandFlight.hovering("px4", 5.0)
    setpoint = Setpoint(pos_ned=(nan, nan, -height_m), v_ned=(1.0, 0.5, nan))
    flight.stream(setpoint, 1.5)
    assert flight.vehicle.set_mode_kind("guided") is Result.ACCEPTED
    flight.stream(setpoint, 6.0)
    assert flight.vehicle.truth.v_ned[:2] == pytest.approx((1.0, 0.5), abs=0.3)
    assert flight.up_m == pytest.approx(height_m, abs=0.8)
