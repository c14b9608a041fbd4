"""A client gives up control of a vehicle that flies: nobody has it, and the vehicle is held."""

from __future__ import annotations

import math
from collections.abc import Callable

import pytest
from pymavlink.dialects.v20 import all as dialect

from gcs.gate.states import State
from gcs.report import DecisionItem
from tests.loopback.bridged import VEHICLE, BridgedFlight, Client, flying, joined
from tests.loopback.fleet import Fleet
from tests.loopback.flight import HOMES, Personality
from tests.loopback.plan_clients import NORTH_DEG
from tests.loopback.test_bridge_streams import in_control, velocity
from tests.loopback.test_mission_mode_then_arm import with_mission
from tests.loopback.test_takeoff_then_arm import commands_sent

ACCEPTED = 0
ARM, LAND, SET_MODE, MISSION_START, CONTROL = 400, 21, 176, 300, 32100
RELEASE, REQUEST = 0, 1
HOLD_MODE = {"px4": "AUTO.LOITER", "ardupilot": "BRAKE"}
GUIDED = {"px4": (1, 6, 0), "ardupilot": (1, 4, 0)}
"""DO_SET_MODE: OFFBOARD, GUIDED."""


def sticks(client: Client, times: int) -> None:
    """A joystick: in the middle once, then pushed forward."""
    for count in range(times):
        x = 0 if count < 5 else 400
        client.send(dialect.MAVLink_manual_control_message(VEHICLE[0], x, 0, 500, 0, 0))
        client.flight.run(0.05)


def northward(client: Client, times: int) -> None:
    velocity(client, 2.0, times)


def rests(flight: BridgedFlight) -> None:
    """It has stopped, which takes a vehicle at full speed 6 to 10 s, and stays where it is."""
    flight.beating(12.0)
    before = flight.truth_enu()
    flight.beating(3.0)
    assert math.dist(before, flight.truth_enu()) < 0.3


def told_to_hold(flight: BridgedFlight) -> None:
    """In the autopilot's own mode, with the reason on the record."""
    name = flight.personality
    flight.until(lambda: flight.is_in(State.HOLDING), 1)
    flight.until(lambda: flight.vehicle.mode_name == HOLD_MODE[name], 3)
    assert any("has released control" in line for line in flight.lines("state_and_safety"))
    assert in_control(flight) == 0


@pytest.mark.parametrize("stream", [northward, sticks])
def test_its_stream_is_over_and_goes_on_for_nobody(
    personality: Personality, stream: Callable[[Client, int], None]
) -> None:
    """The client goes on sending, which neither moves the vehicle nor gives it control again."""
    flight, client = flying(personality)
    stream(client, 40)
    assert flight.is_in(State.STREAMING)
    assert client.ask(CONTROL, RELEASE) == ACCEPTED
    told_to_hold(flight)
    flight.run(7.0)  # a real ArduCopter takes 4 to 6 s to rest (tests/real/facts)
    before = flight.truth_enu()
    stream(client, 60)
    assert math.dist(before, flight.truth_enu()) < 0.3
    assert flight.is_in(State.HOLDING)
    assert in_control(flight) == 0


def test_its_goal_is_given_up_and_the_next_one_in_control_flies_on(
    personality: Personality,
) -> None:
    flight, client = flying(personality)
    other = flight.join(246)
    goal = north_of_home(personality, 60.0)
    client.fly_to(*goal)
    flight.until(lambda: flight.is_in(State.MOVING))
    flight.beating(3.0)
    assert client.ask(CONTROL, RELEASE) == ACCEPTED
    told_to_hold(flight)
    (ended,) = [each for each in flight.decisions() if each.code == "OPERATOR_LOST"]
    assert (ended.word, ended.phase, ended.outcome) == ("goto", "ending", "aborted")
    rests(flight)
    assert flight.truth_enu()[1] < 50.0
    assert other.ask(SET_MODE, *GUIDED[personality]) == ACCEPTED
    assert in_control(flight) == 1001
    other.fly_to(*goal)
    flight.until(lambda: flight.is_in(State.MOVING), 3)
    flight.beating(20.0)
    assert flight.is_in(State.HOVERING)
    assert flight.truth_enu()[1] == pytest.approx(60.0, abs=1.5)


def test_its_mission_is_broken_off(personality: Personality) -> None:
    flight, client = with_mission(personality)
    assert client.ask(ARM, 1, within_s=10) == ACCEPTED
    assert client.ask(MISSION_START, within_s=10) == ACCEPTED
    flight.until(lambda: flight.is_in(State.FLYING_MISSION), 10)
    flight.beating(8.0)
    assert client.ask(CONTROL, RELEASE) == ACCEPTED
    told_to_hold(flight)
    rests(flight)


def test_what_comes_down_goes_on(personality: Personality) -> None:
    flight, client = flying(personality)
    assert client.ask(LAND) == ACCEPTED
    assert client.ask(CONTROL, RELEASE) == ACCEPTED
    assert in_control(flight) == 0
    assert flight.is_in(State.LANDING)
    flight.until(lambda: flight.is_in(State.GROUNDED))


def test_every_vehicle_that_it_flew_is_held() -> None:
    flight = Fleet()
    client = flight.all_flying()
    flight.send_to(client, 2, 0, 40, 7)
    flight.reaches(2, State.MOVING, 2)
    assert client.ask(CONTROL, RELEASE) == ACCEPTED
    for number in (1, 2):
        flight.reaches(number, State.HOLDING, 2)


def test_a_stream_ends_in_its_place_when_another_client_takes_over(
    personality: Personality,
) -> None:
    """Somebody is in control, so the vehicle hovers and is flown on by whoever has it now."""
    flight, client = flying(personality)
    other = flight.join(246)
    northward(client, 40)
    assert flight.is_in(State.STREAMING)
    assert other.ask(CONTROL, REQUEST, 1) == ACCEPTED
    assert in_control(flight) == 1001
    assert flight.is_in(State.HOVERING)
    before = flight.truth_enu()
    northward(client, 60)
    assert math.dist(before, flight.truth_enu()) < 2.5, "the way that it takes to stop"
    assert "stream: refused OTHER_OPERATOR" in client.texts()
    velocity(other, -2.0, 60)
    assert flight.is_in(State.STREAMING)
    assert flight.truth_enu()[1] < before[1] - 2.0


def test_a_goal_is_flown_on_when_another_client_takes_over(personality: Personality) -> None:
    flight, client = flying(personality)
    other = flight.join(246)
    client.fly_to(*north_of_home(personality, 30.0))
    flight.until(lambda: flight.is_in(State.MOVING))
    assert other.ask(CONTROL, REQUEST, 1) == ACCEPTED
    flight.until(lambda: flight.is_in(State.HOVERING))
    assert flight.truth_enu()[1] == pytest.approx(30.0, abs=1.5)


def test_on_the_ground_nothing_is_sent_to_the_vehicle() -> None:
    flight, client = joined(BridgedFlight("px4"))
    assert client.ask(CONTROL, REQUEST, 1) == ACCEPTED
    flight.beating(1.0)
    before = commands_sent(flight, SET_MODE)
    assert client.ask(CONTROL, RELEASE) == ACCEPTED
    flight.beating(2.0)
    assert commands_sent(flight, SET_MODE) == before
    assert flight.is_in(State.GROUNDED)
    assert [each.word for each in flight.recorded(DecisionItem)][-1] == "station_release"


def north_of_home(personality: Personality, north_m: float) -> tuple[float, float, float]:
    home = HOMES[personality]
    return home.lat_deg + north_m * NORTH_DEG, home.lon_deg, home.alt_amsl_m + 5.0
