"""What speaks against arming, in each autopilot's words, and which parameter decides about it."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from tests.unit.autopilot.flight import Flight, item
from tests.unit.failsafes.ground import box, fenced, said
from vehicle_sim.autopilot.interface import Result
from vehicle_sim.autopilot.modes import Personality

BOTH: tuple[Personality, ...] = ("px4", "ardupilot")
either = pytest.mark.parametrize("personality", BOTH)

Trouble = Callable[[Flight], None]


def no_gps(flight: Flight) -> None:
    flight.vehicle.blocks.sensed.gps_lost = True
    flight.fly(6.0)


def no_compass(flight: Flight) -> None:
    flight.vehicle.blocks.sensed.mag_lost = True
    flight.fly(3.0)


def no_barometer(flight: Flight) -> None:
    flight.vehicle.blocks.sensed.baro_lost = True
    flight.fly(3.0)


def bent_accelerometer(flight: Flight) -> None:
    flight.vehicle.blocks.sensed.accel_off_z = 2.0
    flight.fly(0.3)


def empty(flight: Flight) -> None:
    flight.vehicle.blocks.body.consumed_mah = 4800.0
    flight.fly(0.3)


def refused(flight: Flight, words: str) -> None:
    """It does not arm, says why, and the PREARM_CHECK bit agrees."""
    assert not flight.vehicle.armable
    expected = Result.TEMPORARILY_REJECTED if flight.personality == "px4" else Result.FAILED
    assert flight.vehicle.arm(False) is expected
    flight.fly(0.1)
    assert said(flight, words), flight.texts()
    assert not flight.vehicle.armed


@pytest.mark.parametrize(
    ("trouble", "words"),
    [
        (no_gps, "Preflight Fail: no valid position estimate"),
        (no_compass, "Preflight Fail: No valid data from Compass 0"),
        (no_barometer, "Preflight Fail: No valid data from Baro 0"),
        (bent_accelerometer, "Preflight Fail: High Accelerometer Bias"),
        (empty, "Preflight Fail: low battery"),
    ],
)
def test_px4_says_what_is_wrong(trouble: Trouble, words: str) -> None:
    flight = Flight("px4").boot()
    assert flight.vehicle.armable
    trouble(flight)
    refused(flight, words)
    assert flight.vehicle.arm(True) is Result.ACCEPTED, "who forces it arms"


@pytest.mark.parametrize(
    ("trouble", "bit", "words"),
    [
        (no_gps, 8, "Arm: GPS 1: Bad fix"),
        (no_compass, 4, "Arm: Compass not healthy"),
        (no_barometer, 2, "Arm: Baro: not healthy"),
        (bent_accelerometer, 16, "Arm: Accels inconsistent"),
    ],
)
def test_ardupilot_says_what_is_wrong_and_arming_check_chooses_the_checks(
    trouble: Trouble, bit: int, words: str
) -> None:
    flight = Flight("ardupilot").boot()
    flight.vehicle.set_mode_kind("guided")
    trouble(flight)
    refused(flight, words)
    for checks, still in ((bit, True), (510 & ~bit, False), (0, False)):
        flight.vehicle.parameters.set("ARMING_CHECK", checks)
        flight.seen.clear()
        flight.vehicle.check_arming()
        flight.fly(0.1)
        assert said(flight, words) == still


def test_ardupilot_needs_a_position_where_the_mode_does_whatever_arming_check_says() -> None:
    flight = Flight("ardupilot").boot()
    flight.vehicle.set_mode_kind("guided")
    no_gps(flight)
    flight.vehicle.parameters.set("ARMING_CHECK", 0)
    refused(flight, "Arm: Need Position Estimate")
    flight.vehicle.set_mode_kind("manual")
    assert flight.vehicle.arm(False) is Result.ACCEPTED


@pytest.mark.parametrize("allowed", [1, 0])
def test_px4_arms_without_gps_as_com_arm_wo_gps_says(allowed: int) -> None:
    flight = Flight("px4").boot()
    flight.vehicle.parameters.set("COM_ARM_WO_GPS", allowed)
    flight.vehicle.set_mode_kind("manual")
    no_gps(flight)
    flight.vehicle.joystick(0, 0, 500, 0, flight.vehicle.time_ns)
    assert flight.vehicle.armable == bool(allowed)
    if not allowed:
        refused(flight, "Preflight Fail: GPS fix too low")


@pytest.mark.parametrize(
    ("name", "value", "words"),
    [
        ("BATT_LOW_VOLT", 25.0, "Arm: Battery 1 low voltage failsafe"),
        ("BATT_CRT_VOLT", 25.0, "Arm: Battery 1 critical voltage failsafe"),
        ("BATT_LOW_MAH", 4000.0, "Arm: Battery 1 low capacity failsafe"),
        ("BATT_ARM_VOLT", 25.0, "Arm: Battery 1 below minimum arming voltage"),
        ("BATT_ARM_MAH", 4000.0, "Arm: Battery 1 below minimum arming capacity"),
    ],
)
def test_ardupilot_and_its_battery(name: str, value: float, words: str) -> None:
    flight = Flight("ardupilot").boot()
    flight.vehicle.blocks.body.consumed_mah = 1500.0
    flight.fly(0.2)
    assert flight.vehicle.armable
    flight.vehicle.parameters.set(name, value)
    refused(flight, words)


@pytest.mark.parametrize(
    ("name", "value", "words"),
    [
        ("EKF2_ABL_LIM", 0.4, "High Accelerometer Bias"),
        ("EKF2_GYR_B_LIM", 0.005, "High Gyro Bias"),
    ],
)
def test_px4_and_its_biases(name: str, value: float, words: str) -> None:
    flight = Flight("px4").boot()
    assert flight.vehicle.armable
    flight.vehicle.blocks.sensed.accel_off_z = 0.33
    flight.vehicle.parameters.set("EKF2_ABL_LIM", 0.8)
    flight.fly(0.1)
    assert flight.vehicle.armable
    flight.vehicle.parameters.set(name, value)
    refused(flight, words)


def test_ardupilot_takes_an_accelerometer_as_bad_as_arming_accthresh() -> None:
    flight = Flight("ardupilot").boot()
    flight.vehicle.blocks.sensed.accel_off_z = 1.0
    flight.fly(0.1)
    refused(flight, "Arm: Accels inconsistent")
    flight.vehicle.parameters.set("ARMING_ACCTHRESH", 1.5)
    assert flight.vehicle.armable


@pytest.mark.parametrize(
    ("settings", "words"),
    [
        ({"FENCE_TYPE": 0}, "Arm: Fences enabled, but none selected"),
        ({"FENCE_ALT_MAX": 10.0, "FENCE_ALT_MIN": 20.0}, "Arm: FENCE_ALT_MAX < FENCE_ALT_MIN"),
        ({"FENCE_MARGIN": 10.0, "FENCE_ALT_MAX": 10.0}, "Arm: FENCE_MARGIN too big"),
    ],
)
def test_ardupilots_fence_must_make_sense(settings: dict[str, float], words: str) -> None:
    flight = Flight("ardupilot").boot()
    for name, value in settings.items():
        flight.vehicle.parameters.set(name, value)
    assert flight.vehicle.armable
    flight.vehicle.parameters.set("FENCE_ENABLE", 1)
    refused(flight, words)


def test_ardupilot_minds_lost_sticks_and_a_lost_station() -> None:
    flight = Flight("ardupilot").boot()
    flight.vehicle.joystick(0, 0, 500, 0, flight.vehicle.time_ns)
    flight.fly(6.0)
    assert flight.vehicle.armable, "the simulation's receiver is heard again"
    flight.vehicle.parameters.set("SIM_RC_FAIL", 1)
    refused(flight, "Arm: Radio failsafe on")
    flight.vehicle.parameters.set("FS_THR_ENABLE", 0)
    assert flight.vehicle.armable


def test_px4_does_not_arm_for_a_mission_that_it_may_not_fly() -> None:
    flight = fenced(Flight("px4").boot(), box("px4", 20.0))
    plan = (item(0, 16, 5.0, 0.0, 5.0),)
    flight.vehicle.load_plan(plan)
    assert flight.vehicle.set_mode_kind("mission") is Result.ACCEPTED
    assert flight.vehicle.armable
    flight.vehicle.load_plan((item(0, 16, 50.0, 0.0, 5.0),))
    refused(flight, "no valid mission available")


@either
def test_prearm_checks_tell_everything_at_once(personality: Personality) -> None:
    flight = Flight(personality).boot()
    assert flight.vehicle.check_arming() is Result.ACCEPTED
    flight.fly(0.1)
    before = len(flight.texts())
    no_compass(flight)
    no_barometer(flight)
    flight.vehicle.check_arming()
    flight.fly(0.1)
    assert len(set(flight.texts()[before:])) == 2
    flight.vehicle.arm(True)
    armed = {"px4": Result.ACCEPTED, "ardupilot": Result.TEMPORARILY_REJECTED}
    assert flight.vehicle.check_arming() is armed[personality]
