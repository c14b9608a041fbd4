"""A vehicle that is switched off and on again, or another one in its place, whatever the pause.

Its station keeps nothing of what it knew of the one before.
"""

from __future__ import annotations

import pytest

from gcs.gate.states import State
from tests.loopback.flight import MISSIONS, PERSONALITIES, Flight, Personality
from tests.loopback.lossy_link import Weather

RETURNS_AT_70_M: dict[Personality, dict[str, float]] = {
    "px4": {"RTL_RETURN_ALT": 70.0},
    "ardupilot": {"RTL_ALT": 7000.0},
}


def off_and_on(
    flight: Flight,
    pause_s: float,
    params: dict[str, float] | None = None,
    personality: Personality | None = None,
) -> None:
    flight.vehicle_silent = True
    flight.run(pause_s)
    flight.restart(params, personality)
    flight.vehicle_silent = False


def restarts(flight: Flight) -> list[str]:
    return [line for line in flight.lines("link") if "has restarted" in line]


@pytest.mark.parametrize("pause_s", [0.0, 0.4, 0.9, 3.0])
def test_a_restart_with_another_return_height_is_noticed_whatever_the_pause(
    personality: Personality, pause_s: float
) -> None:
    flight = Flight(personality).connected()
    off_and_on(flight, pause_s, RETURNS_AT_70_M[personality])
    flight.run(8.0)
    assert len(restarts(flight)) == 1, flight.lines("link")
    flight.until(lambda: flight.vehicle.armable)
    flight.hovering(5.0)
    assert flight.done(flight.goto(0.0, 30.0, 5.0)) == "complete"
    assert flight.done(flight.say("rtl")) == "refused RTL_BLOCKED"
    flight.run(2.0)
    assert "RETURNING" not in flight.states()
    assert flight.truth_enu()[2] < 6.0


@pytest.mark.parametrize("pause_s", [0.0, 2.0])
def test_after_a_restart_the_streams_are_asked_for_again(
    personality: Personality, pause_s: float
) -> None:
    flight = Flight(personality).connected()
    off_and_on(flight, pause_s)
    flight.run(10.0)
    assert flight.is_in(State.GROUNDED)
    assert flight.home_ned is not None
    flight.hovering(3.0)


@pytest.mark.parametrize("pause_s", [0.0, 2.0, 6.0])
def test_another_autopilot_with_the_same_number_is_another_vehicle(
    personality: Personality, pause_s: float
) -> None:
    flight = Flight(personality).connected()
    (other,) = set(PERSONALITIES) - {personality}
    off_and_on(flight, pause_s, personality=other)
    flight.run(10.0)
    told = [line for line in flight.lines("link") if "another vehicle has the number" in line]
    assert len(told) == 1
    assert other in told[0]
    assert not [line for line in flight.lines("link") if "is back" in line]
    flight.hovering(3.0)
    assert flight.done(flight.goto(10.0, 0.0, 3.0)) == "complete"
    flight.do("hold")
    assert flight.is_in(State.HOLDING)


@pytest.mark.parametrize("latest_s", [0.5, 1.5])
def test_a_link_that_loses_and_reorders_restarts_nothing(
    personality: Personality, latest_s: float
) -> None:
    weather = Weather(loss=0.2, duplicate=0.2, corrupt=0.02, delay_s=(0.01, latest_s))
    flight = Flight(personality, up=weather, down=weather)
    flight.run(60.0)
    assert flight.received
    assert restarts(flight) == []


def test_a_start_of_a_mission_does_not_outlive_a_restart(personality: Personality) -> None:
    flight = Flight(personality).connected()
    flight.do("mission_upload", path=str(MISSIONS / "square.toml"))
    flight.do("arm")
    flight.do("takeoff", up_m=5.0)
    start = flight.say("mission_start")
    assert flight.outcome(start) is None
    off_and_on(flight, 0.3)
    flight.run(10.0)
    assert flight.outcome(start) not in (None, "complete")
    assert "FLYING_MISSION" not in flight.states()
    assert flight.is_in(State.GROUNDED)
