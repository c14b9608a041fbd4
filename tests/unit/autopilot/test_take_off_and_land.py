"""Boot, arm, take off, land, disarm: the happy path and its refusals, both personalities."""

from __future__ import annotations

from math import pi

import pytest

from tests.unit.autopilot.flight import HOMES, Flight
from vehicle_sim.autopilot.autopilot import create
from vehicle_sim.autopilot.interface import HomeChanged, Landed, Result
from vehicle_sim.autopilot.modes import Personality

BOTH: tuple[Personality, ...] = ("px4", "ardupilot")
either = pytest.mark.parametrize("personality", BOTH)


def test_the_vehicle_keeps_the_contract() -> None:
    vehicle = create("px4", HOMES["px4"], 1)
    vehicle.step()
    assert vehicle.time_ns == vehicle.dt_ns


@either
def test_it_is_armable_within_a_second_and_says_why_not_before(personality: Personality) -> None:
    flight = Flight(personality)
    assert not flight.armable()
    ardupilot = personality == "ardupilot"
    early = flight.vehicle.arm(False)
    assert early is (Result.FAILED if ardupilot else Result.TEMPORARILY_REJECTED)
    flight.fly(1.05)
    assert flight.armable()
    assert any("osition" in text for text in flight.texts())


@either
def test_origin_and_home_come_with_the_first_fix(personality: Personality) -> None:
    flight = Flight(personality)
    assert (flight.vehicle.origin, flight.vehicle.home) == (None, None)
    flight.fly(0.6)
    assert flight.vehicle.origin == HOMES[personality]
    assert flight.vehicle.home_pos_ned == (0.0, 0.0, 0.0)
    assert HomeChanged() in flight.seen


@either
def test_arming_twice_and_disarming_twice_is_accepted(personality: Personality) -> None:
    flight = Flight(personality).boot()
    assert flight.vehicle.arm(False) is Result.ACCEPTED
    assert flight.vehicle.arm(False) is Result.ACCEPTED
    assert flight.vehicle.base_mode & 128
    assert flight.vehicle.disarm(False) is Result.ACCEPTED
    assert flight.vehicle.disarm(False) is Result.ACCEPTED
    assert not flight.vehicle.base_mode & 128


@either
def test_armed_on_the_ground_it_stays_there_and_disarms_after_ten_seconds(
    personality: Personality,
) -> None:
    flight = Flight(personality).boot()
    flight.vehicle.arm(False)
    flight.fly(9.0)
    assert flight.vehicle.armed
    assert flight.up_m < 0.01
    flight.fly(1.5)
    assert not flight.vehicle.armed


def test_px4_takes_off_in_a_mode_of_its_own_then_loiters_up_to_nav_mc_alt_rad_lower() -> None:
    """behaviour.json, "end of AUTO.TAKEOFF": it ends within 0.8 m, and hovers 0.3 to 0.7 m low."""
    flight = Flight("px4").boot()
    flight.vehicle.arm(False)
    assert flight.vehicle.take_off(None) is Result.ACCEPTED
    assert flight.vehicle.mode_name == "AUTO.TAKEOFF"
    flight.fly(0.5)
    assert flight.landed() is Landed.ON_GROUND  # the motors spool up: COM_SPOOLUP_TIME
    flight.fly(1.0)
    assert flight.landed() is Landed.TAKEOFF
    flight.fly(5.0, lambda: flight.vehicle.mode_name == "AUTO.LOITER")
    assert flight.landed() is Landed.IN_AIR
    flight.fly(5.0)  # it comes near at 0.5 /s only, by MPC_JERK_AUTO
    assert 0.3 < 2.5 - flight.up_m < 0.8
    hovers_m = flight.up_m
    flight.fly(5.0)
    assert flight.up_m == pytest.approx(hovers_m, abs=0.1)


def test_px4_asked_to_take_off_before_arming_leaves_with_the_arming() -> None:
    flight = Flight("px4").boot()
    assert flight.vehicle.take_off(3.0) is Result.ACCEPTED
    flight.fly(1.0)
    assert flight.up_m < 0.01
    flight.vehicle.arm(False)
    flight.fly(8.0, lambda: flight.up_m > 2.2)  # NAV_MC_ALT_RAD below the height


def test_ardupilot_takes_off_armed_and_in_guided_only() -> None:
    flight = Flight("ardupilot").boot()
    assert flight.vehicle.take_off(3.0) is Result.FAILED
    flight.vehicle.set_mode_kind("guided")
    assert flight.vehicle.take_off(3.0) is Result.FAILED
    flight.vehicle.arm(False)
    assert flight.vehicle.take_off(3.0) is Result.ACCEPTED
    flight.fly(8.0, lambda: flight.landed() is Landed.IN_AIR)
    assert flight.vehicle.mode_name == "GUIDED"
    flight.fly(3.0)
    assert flight.up_m == pytest.approx(3.0, abs=0.25)


@either
def test_a_repeated_take_off_has_no_second_effect(personality: Personality) -> None:
    """PX4 accepts it, ArduCopter fails it (commands_*.json: "takeoff in air")."""
    flight = Flight.hovering(personality, 3.0)
    mode, up_m = flight.vehicle.mode_name, flight.up_m
    answers = {"px4": Result.ACCEPTED, "ardupilot": Result.FAILED}
    assert flight.vehicle.take_off(20.0) is answers[personality]
    flight.fly(3.0)
    assert flight.vehicle.mode_name == mode
    assert flight.up_m == pytest.approx(up_m, abs=0.25)


@either
def test_it_does_not_disarm_in_the_air_unless_forced(personality: Personality) -> None:
    flight = Flight.hovering(personality, 3.0)
    refused = {"px4": Result.TEMPORARILY_REJECTED, "ardupilot": Result.FAILED}
    assert flight.vehicle.disarm(False) is refused[personality]
    assert flight.vehicle.armed
    assert flight.vehicle.disarm(True) is Result.ACCEPTED
    flight.fly(0.5)
    assert flight.landed() is Landed.IN_AIR  # it falls
    assert flight.vehicle.motor_outputs == (0.0, 0.0, 0.0, 0.0)
    assert flight.vehicle.truth.v_ned[2] > 3.0


@either
def test_landing_touches_down_softly_and_disarms(personality: Personality) -> None:
    flight = Flight.hovering(personality, 4.0)
    assert flight.vehicle.land() is Result.ACCEPTED
    flight.fly(1.0)
    assert flight.landed() is Landed.LANDING
    flight.fly(15.0, lambda: flight.up_m < 0.05)
    assert flight.speed_m_s < 1.0
    flight.fly(5.0, lambda: flight.landed() is Landed.ON_GROUND)
    assert flight.vehicle.armed
    flight.fly(3.0, lambda: not flight.vehicle.armed)
    assert abs(flight.up_m) < 0.02
    rest_ned = flight.vehicle.truth.pos_ned
    flight.fly(5.0)
    assert flight.vehicle.truth.pos_ned == pytest.approx((*rest_ned[:2], 0.0), abs=0.02)


@either
def test_px4_is_ready_to_arm_after_a_landing_and_ardupilot_wants_a_mode_first(
    personality: Personality,
) -> None:
    flight = Flight.hovering(personality, 2.0)
    flight.vehicle.land()
    flight.fly(20.0, lambda: not flight.vehicle.armed)
    assert flight.armable() is (personality == "px4")
    flight.vehicle.set_mode_kind("guided" if personality == "ardupilot" else "hold")
    assert flight.vehicle.arm(False) is Result.ACCEPTED


@either
def test_hover_is_steady_and_the_heading_stays(personality: Personality) -> None:
    flight = Flight.hovering(personality, 5.0)
    flight.fly(2.0)
    up_m = flight.up_m
    for _ in range(20):
        flight.fly(0.5)
        assert flight.speed_m_s < 0.25
        assert flight.off((0.0, 0.0, -up_m)) < 0.5
    heading = flight.vehicle.estimate.heading_rad
    assert min(heading, 2.0 * pi - heading) < 0.05


def test_termination_stops_the_motors_for_good() -> None:
    flight = Flight.hovering("px4", 5.0)
    assert flight.vehicle.terminate(True) is Result.ACCEPTED
    flight.fly(5.0)
    # H5: it lies there armed and "in the air" until it is told to land.
    assert flight.vehicle.motor_outputs == (0.0, 0.0, 0.0, 0.0)
    assert flight.vehicle.armed
    assert flight.landed() is Landed.IN_AIR
    assert flight.vehicle.arm(False) is Result.ACCEPTED
    assert flight.vehicle.land() is Result.ACCEPTED
    flight.fly(6.0, lambda: not flight.vehicle.armed)
    landed = flight.landed()
    assert landed is Landed.ON_GROUND
    assert not flight.armable()
    assert flight.vehicle.arm(True) is Result.TEMPORARILY_REJECTED
    assert flight.vehicle.system_status == 8
    assert flight.vehicle.reboot() is Result.ACCEPTED
    flight.fly(1.5)
    assert flight.armable()


def test_it_does_not_reboot_while_armed() -> None:
    flight = Flight("px4").boot()
    flight.vehicle.arm(False)
    assert flight.vehicle.reboot() is Result.DENIED


def test_a_reboot_on_the_ground_starts_anew_at_home() -> None:
    flight = Flight.hovering("px4", 3.0)
    flight.vehicle.reposition((6.0, 0.0, -3.0), None, None)
    flight.fly(8.0)
    flight.vehicle.land()
    flight.fly(30.0, lambda: not flight.vehicle.armed)
    assert flight.vehicle.truth.pos_ned[0] > 5.0
    used_mah = flight.vehicle.power.consumed_mah
    assert flight.vehicle.reboot() is Result.ACCEPTED
    assert flight.vehicle.truth.pos_ned == (0.0, 0.0, 0.0)
    assert not flight.armable()
    assert flight.vehicle.origin is None
    flight.fly(1.5)
    assert flight.armable()
    assert flight.astray_m < 1.0
    assert flight.vehicle.power.consumed_mah >= used_mah


def test_a_reboot_in_the_air_ends_in_a_fall() -> None:
    flight = Flight.hovering("px4", 8.0)
    flight.vehicle.disarm(True)
    assert flight.vehicle.reboot() is Result.ACCEPTED
    flight.fly(0.5)
    assert flight.vehicle.motor_outputs == (0.0, 0.0, 0.0, 0.0)
    assert flight.vehicle.truth.v_ned[2] > 4.0
    flight.fly(3.0)
    assert flight.vehicle.blocks.body.touching
