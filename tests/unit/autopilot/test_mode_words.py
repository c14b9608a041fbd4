"""Every mode that a client may ask for is flown or refused in the words of its autopilot."""

from __future__ import annotations

import pytest

from tests.unit.autopilot.flight import Flight
from vehicle_sim.autopilot.interface import Result
from vehicle_sim.autopilot.modes import MODES, REFUSED, Personality, by_number

either = pytest.mark.parametrize("personality", ["px4", "ardupilot"])
REFUSAL = {"px4": Result.TEMPORARILY_REJECTED, "ardupilot": Result.FAILED}


@either
def test_no_mode_is_both_flown_and_refused(personality: Personality) -> None:
    flown = {mode.custom_mode for mode in MODES[personality].values()}
    assert not flown & set(REFUSED[personality])
    for number in REFUSED[personality]:
        assert by_number(personality, number) is None


@either
def test_every_refused_mode_says_so_and_changes_nothing(personality: Personality) -> None:
    flight = Flight.hovering(personality, 3.0)
    before = flight.vehicle.mode_name
    # What is no AUTO mode of PX4's is ACCEPTED without a word (main mode 99, as recorded).
    silent = {8 << 16}
    for number, name in REFUSED[personality].items():
        if personality == "px4" and number in silent:
            assert flight.vehicle.set_mode(1, number) is Result.ACCEPTED
            continue
        flight.seen.clear()
        assert flight.vehicle.set_mode(1, number) is REFUSAL[personality]
        flight.fly(0.1)
        words = {
            "px4": "Unsupported auto mode",
            "ardupilot": f"Mode change to {name} failed: init failed",
        }
        assert words[personality] in flight.texts()
    assert flight.vehicle.mode_name == before


@either
def test_every_mode_that_needs_no_more_than_a_flight_is_entered(personality: Personality) -> None:
    flight = Flight.hovering(personality, 5.0)
    special = {"OFFBOARD", "AUTO.MISSION", "AUTO", "FOLLOW"}
    for mode in MODES[personality].values():
        if mode.name in special:
            continue
        flight.vehicle.joystick(0, 0, 500, 0, flight.vehicle.time_ns)
        assert flight.vehicle.set_mode(1, mode.custom_mode) is Result.ACCEPTED, mode.name
        for _ in range(5):  # PX4's modes by hand need sticks
            flight.vehicle.joystick(0, 0, 500, 0, flight.vehicle.time_ns)
            flight.fly(0.1)
        assert flight.vehicle.custom_mode == mode.custom_mode, mode.name


@pytest.mark.parametrize(
    ("personality", "kind", "text"),
    [
        ("px4", "mission", "Switching to AUTO_MISSION is currently not available"),
        ("ardupilot", "mission", "Mode change to Auto failed: init failed"),
    ],
)
def test_a_mission_mode_without_a_mission_is_refused_in_its_words(
    personality: Personality, kind: str, text: str
) -> None:
    flight = Flight.hovering(personality, 3.0)
    assert flight.vehicle.set_mode_kind(kind) is REFUSAL[personality]
    flight.fly(0.1)
    assert text in flight.texts()


def test_a_number_that_is_no_mode_of_ardupilots() -> None:
    flight = Flight.hovering("ardupilot", 3.0)
    assert flight.vehicle.set_mode(1, 99) is Result.FAILED
    flight.fly(0.1)
    assert "No such mode 99" in flight.texts()


def test_a_position_mode_without_a_position_is_refused() -> None:
    flight = Flight("ardupilot")
    flight.fly(0.2)
    assert flight.vehicle.set_mode_kind("hold") is Result.FAILED
    flight.fly(0.1)
    assert "Mode change to Loiter failed: requires position" in flight.texts()
