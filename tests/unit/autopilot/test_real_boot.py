"""`--boot real`: how long each autopilot takes until it arms, and what it says and refuses.

Times are seconds since power-up.  Rows: "Real beside ours" 2 and `behaviour.json` "armable" (rank
2); the scenarios `boot_to_ready` and `H7_force_arm_not_ready` of either autopilot, whose process
starts 0.0 to 0.2 s before its clock; `px4_1_14_flight.tlog` (its clock began 0.80 s before its
first message) and `arducopter_4_7_flight.tlog` (2.02 s before).
"""

from __future__ import annotations

import pytest

from tests.unit.autopilot.flight import Flight
from vehicle_sim.autopilot.interface import HomeChanged, Landed, Result
from vehicle_sim.autopilot.modes import Personality

STEP_S = 0.1
"""The vehicle decides ten times a second: nothing can be timed more finely."""


def booting(personality: Personality, seconds: float) -> Flight:
    """So long after power-up."""
    flight = Flight(personality, boot="real")
    flight.fly(seconds)
    return flight


def refusal(flight: Flight, force: bool = False) -> tuple[Result, list[str]]:
    """What `arm` answers, and what is said for it."""
    flight.seen.clear()
    result = flight.vehicle.arm(force)
    flight.fly(STEP_S)
    return result, flight.texts()


def first_time(flight: Flight, text: str, limit_s: float = 60.0) -> float:
    """When it is said, in seconds since power-up."""
    flight.fly(limit_s, lambda: text in [getattr(e, "text", "") for e in peek(flight)])
    return flight.vehicle.time_ns / 1e9


def has_places(flight: Flight) -> tuple[bool, bool]:
    """Whether there are an origin and a home."""
    return flight.vehicle.origin is not None, flight.vehicle.home is not None


def knows(flight: Flight) -> tuple[bool, bool]:
    """Whether it has an attitude and a position."""
    return flight.vehicle.health.attitude_ok, flight.vehicle.health.position_ok


def peek(flight: Flight) -> list[object]:
    """What was said since power-up."""
    flight.seen += flight.vehicle.events()
    return [*flight.seen]


# ------------------------------------------------------------------------------- ArduCopter


@pytest.mark.parametrize(
    ("at_s", "text"),
    [
        (2.0, "Barometer 1 calibration complete"),
        (2.5, "ArduPilot Ready"),
        (4.4, "AHRS: EKF3 active"),
        (5.9, "EKF3 IMU1 MAG0 initial yaw alignment complete"),
        (9.8, "GPS 1: detected u-blox"),
        (20.0, "EKF3 IMU0 origin set"),
        (20.2, "EKF3 IMU1 origin set"),
        (41.4, "EKF3 IMU0 is using GPS"),
    ],
)
def test_arducopter_says_how_far_it_is(at_s: float, text: str) -> None:
    """`boot_to_ready`, whose times are those of ten times the speed."""
    assert first_time(Flight("ardupilot", boot="real"), text) == pytest.approx(at_s, abs=0.15)


def test_arducopters_texts_come_in_the_recorded_order() -> None:
    """`boot_to_ready`, all of it."""
    assert booting("ardupilot", 45.0).texts() == [
        "Barometer 1 calibration complete",
        "Barometer 2 calibration complete",
        "ArduPilot Ready",
        "AHRS: DCM active",
        "RC7: SaveWaypoint LOW",
        "EKF3 IMU0 initialised",
        "EKF3 IMU1 initialised",
        "AHRS: EKF3 active",
        "EKF3 IMU0 tilt alignment complete",
        "EKF3 IMU1 tilt alignment complete",
        "EKF3 IMU0 MAG0 initial yaw alignment complete",
        "EKF3 IMU1 MAG0 initial yaw alignment complete",
        "GPS 1: probing for u-blox at 230400 baud",
        "GPS 1: detected u-blox",
        "EKF3 IMU0 origin set",
        "Field Elevation Set: 584m",
        "EKF3 IMU1 origin set",
        "EKF3 IMU0 is using GPS",
        "EKF3 IMU1 is using GPS",
    ]


@pytest.mark.parametrize(
    ("at_s", "mode", "texts"),
    [
        # `H7_force_arm_not_ready`, STABILIZE
        (1.0, "stabilize", ["Arm: System not initialised"]),
        (1.8, "stabilize", ["Arm: System not initialised"]),
        (
            2.6,
            "stabilize",
            [
                "Arm: Accels inconsistent",
                "Arm: EKF attitude is bad",
                "Arm: AHRS: not using configured AHRS type",
            ],
        ),
        # the flight, 12.02 s
        (14.0, "stabilize", ["Arm: Gyros inconsistent"]),
        # the flight, 12.50 s, after the change to GUIDED
        (14.5, "guided", ["Arm: Gyros inconsistent", "Arm: AHRS: waiting for home"]),
        # `behaviour.json`, "armable"
        (25.0, "guided", ["Arm: Need Position Estimate"]),
        (41.0, "guided", ["Arm: Need Position Estimate"]),
    ],
)
def test_arducopter_refuses_to_arm(at_s: float, mode: str, texts: list[str]) -> None:
    flight = booting("ardupilot", at_s)
    if mode == "guided":
        assert flight.vehicle.set_mode_kind("guided") is Result.ACCEPTED
    result, said = refusal(flight)
    assert result is Result.FAILED
    assert [text for text in said if "Arm:" in text] == texts


def test_arducopter_cannot_be_forced_before_its_estimator_runs() -> None:
    """`H7_force_arm_not_ready`, at 4.15 s: "AHRS type is never skipped"."""
    result, said = refusal(booting("ardupilot", 4.1), force=True)
    assert result is Result.FAILED
    assert said == [
        "Arm: AHRS: not using configured AHRS type",
        "Arm: Accels inconsistent",
        "Arm: EKF attitude is bad",
        "Arm: AHRS: not using configured AHRS type",
    ]


def test_arducopter_says_prearm_for_the_command_that_only_checks() -> None:
    """The flight, RUN_PREARM_CHECKS at 12.50 s."""
    flight = booting("ardupilot", 14.4)
    assert flight.vehicle.set_mode_kind("guided") is Result.ACCEPTED
    flight.seen.clear()
    assert flight.vehicle.check_arming() is Result.ACCEPTED
    flight.fly(STEP_S)
    assert flight.texts() == ["PreArm: Gyros inconsistent", "PreArm: AHRS: waiting for home"]


def test_arducopter_says_unasked_what_is_missing_after_30_s() -> None:
    """The flight: GUIDED at 28.42 s, told at 30.4 s; it looks once a second."""
    flight = booting("ardupilot", 28.4)
    assert flight.vehicle.set_mode_kind("guided") is Result.ACCEPTED
    at_s = first_time(flight, "PreArm: Need Position Estimate")
    assert at_s == pytest.approx(30.4, abs=0.5)


def test_arducopter_is_healthy_at_23_s_for_who_does_not_ask_in_guided() -> None:
    """vehicle.md, "Fidelity": 41 s with a false "healthy" at 23 s."""
    flight = Flight("ardupilot", boot="real")
    assert flight.fly(60.0, flight.armable) == pytest.approx(23.0, abs=0.15)
    assert flight.vehicle.set_mode_kind("guided") is Result.ACCEPTED
    assert not flight.armable()
    assert 23.0 + flight.fly(60.0, flight.armable) == pytest.approx(41.4, abs=0.15)


def test_arducopter_has_home_20_s_after_power_up_and_a_position_after_41() -> None:
    """The flight: HOME_POSITION with 20.01 s in it, "is using GPS" at 41.42 s."""
    flight = booting("ardupilot", 19.8)
    assert has_places(flight) == (False, False)
    flight.fly(0.4)
    assert has_places(flight) == (True, True)
    assert any(isinstance(event, HomeChanged) for event in flight.seen)
    assert knows(flight) == (True, False)
    flight.fly(21.4)
    assert knows(flight) == (True, True)


def test_arducopters_heartbeat_until_it_is_initialised() -> None:
    """Both: base_mode 89 and BOOT, then 81 and STANDBY."""
    flight = booting("ardupilot", 1.0)
    assert (flight.vehicle.base_mode, flight.vehicle.system_status) == (89, 1)
    flight.fly(2.0)
    assert (flight.vehicle.base_mode, flight.vehicle.system_status) == (81, 3)


def test_arducopter_finds_its_receiver_after_ten_seconds() -> None:
    """`boot_to_ready`: "GPS 1: detected u-blox"."""
    flight = booting("ardupilot", 9.5)
    assert (flight.vehicle.health.gps_fix, flight.vehicle.health.satellites) == (0, 0)
    flight.fly(0.5)
    assert flight.vehicle.health.gps_fix == 3


def test_arducopter_flies_when_it_has_a_position() -> None:
    flight = booting("ardupilot", 42.0)
    assert flight.vehicle.set_mode_kind("guided") is Result.ACCEPTED
    assert flight.vehicle.arm(False) is Result.ACCEPTED
    assert flight.vehicle.take_off(3.0) is Result.ACCEPTED
    flight.fly(20.0, lambda: flight.vehicle.landed is Landed.IN_AIR)


def test_arducopter_flies_in_no_mode_that_needs_a_position_before_it_has_one() -> None:
    """A vehicle that is armed changes no longer to any mode."""
    flight = booting("ardupilot", 25.0)
    assert flight.vehicle.arm(False) is Result.ACCEPTED
    assert flight.vehicle.set_mode_kind("guided") is Result.FAILED


# -------------------------------------------------------------------------------------- PX4


@pytest.mark.parametrize("at_s", [0.5, 1.1, 1.9, 2.7, 3.4, 8.5])
def test_px4_refuses_without_a_word(at_s: float) -> None:
    """`H7_force_arm_not_ready`: it tells the reason by EVENT alone."""
    assert refusal(booting("px4", at_s)) == (Result.TEMPORARILY_REJECTED, [])


def test_px4_cannot_be_forced_either() -> None:
    """`H7_force_arm_not_ready`, 3.2 s after the first heartbeat."""
    assert refusal(booting("px4", 4.4), force=True) == (Result.TEMPORARILY_REJECTED, [])


def test_px4_is_ready_after_9_s() -> None:
    """`boot_to_ready`: four reports, "ready at 8.7 s"; SYS_STATUS says so at 9.3."""
    flight = Flight("px4", boot="real")
    assert flight.fly(60.0, flight.armable) == pytest.approx(8.7, abs=0.15)
    assert flight.vehicle.arm(False) is Result.ACCEPTED


def test_px4_stands_by_from_its_first_heartbeat() -> None:
    """Both: base_mode 29, STANDBY."""
    flight = booting("px4", 0.1)
    assert (flight.vehicle.base_mode, flight.vehicle.system_status) == (29, 3)


def test_px4_has_origin_then_home_then_attitude_then_position() -> None:
    """The flight: GPS_GLOBAL_ORIGIN at 1.13 s, HOME_POSITION with 2.116 s in it, ATTITUDE at 6.44,
    ESTIMATOR_STATUS 831 at 8.15; the receiver has a fix from the first message."""
    flight = booting("px4", 1.0)
    vehicle = flight.vehicle
    assert has_places(flight) == (False, False)
    assert vehicle.health.gps_fix == 3
    flight.fly(0.3)
    assert has_places(flight) == (True, False)
    flight.fly(1.0)
    assert has_places(flight) == (True, True)
    assert knows(flight) == (False, False)
    flight.fly(4.2)
    assert knows(flight) == (True, False)
    flight.fly(1.8)
    assert knows(flight) == (True, True)
    assert "GPS fix" not in flight.texts()


# ------------------------------------------------------------------------------------- both


@pytest.mark.parametrize(("personality", "ready_s"), [("px4", 8.7), ("ardupilot", 23.0)])
def test_a_reboot_takes_as_long_again(personality: Personality, ready_s: float) -> None:
    flight = booting(personality, 45.0)
    assert flight.vehicle.reboot() is Result.ACCEPTED
    flight.fly(STEP_S)
    assert not flight.armable()
    waited_s = STEP_S + flight.fly(60.0, flight.armable)
    assert waited_s == pytest.approx(ready_s, abs=0.15)


@pytest.mark.parametrize("personality", ["px4", "ardupilot"])
def test_modes_are_taken_on_the_ground_before_there_is_a_position(personality: Personality) -> None:
    """The flight of ArduCopter: GUIDED at 14.35 s; PX4's row "DO_SET_MODE disarmed"."""
    flight = booting(personality, 5.0)
    assert flight.vehicle.set_mode_kind("hold") is Result.ACCEPTED
