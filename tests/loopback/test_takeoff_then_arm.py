"""QGroundControl's take-off button on a PX4: NAV_TAKEOFF, its acknowledgement, then the arming.

That a PX4 accepts NAV_TAKEOFF while it is disarmed is recorded (of 1.14.3, row D2); the order in
which QGroundControl sends the two is from memory of its source.
"""

from __future__ import annotations

import math
from collections.abc import Callable

import pytest

from gcs.gate.states import State
from tests.loopback.bridged import BridgedFlight, Client, joined, north_of_home
from tests.loopback.flight import Personality

ACCEPTED, TEMPORARILY_REJECTED = 0, 1
ARM, TAKE_OFF = 400, 22
SET_MODE = 176
NAN = math.nan


def standing(personality: Personality = "px4") -> tuple[BridgedFlight, Client]:
    return joined(BridgedFlight(personality))


def choose(flight: BridgedFlight, client: Client, up_m: float = 6.0) -> int:
    return client.ask(TAKE_OFF, -1, 0, 0, NAN, NAN, NAN, north_of_home(flight, 0, up_m)[2])


def stays_down(flight: BridgedFlight) -> None:
    flight.beating(8.0)
    assert flight.truth_enu()[2] < 0.2
    assert not commands_sent(flight, TAKE_OFF)


def commands_sent(flight: BridgedFlight, command: int) -> int:
    return sum(
        int.from_bytes(frame.payload.ljust(33, b"\0")[28:30], "little") == command
        for frame in flight.to_vehicle("COMMAND_LONG")
    )


def test_it_climbs_when_the_client_arms() -> None:
    flight, client = standing()
    assert choose(flight, client) == ACCEPTED
    assert "takeoff: to 6.0 m when you arm, within 10 s" in client.texts()
    flight.beating(1.0)
    assert commands_sent(flight, TAKE_OFF) == 0
    assert client.ask(ARM, 1, within_s=10) == ACCEPTED
    assert flight.truth_enu()[2] < 0.2  # the arming is answered before the climb
    flight.until(lambda: flight.is_in(State.HOVERING), 30)
    assert flight.truth_enu()[2] == pytest.approx(6.0, abs=1.0)
    assert commands_sent(flight, TAKE_OFF) == 1
    flight.until(lambda: "takeoff: complete" in client.texts(), 5)
    assert [ack.result for ack in client.acks(ARM)] == [ACCEPTED]
    assert [ack.result for ack in client.acks(TAKE_OFF)] == [ACCEPTED]


def test_a_second_take_off_replaces_the_first() -> None:
    flight, client = standing()
    assert choose(flight, client, 9.0) == ACCEPTED
    assert choose(flight, client, 5.0) == ACCEPTED
    assert client.ask(ARM, 1, within_s=10) == ACCEPTED
    flight.until(lambda: flight.is_in(State.HOVERING), 30)
    assert flight.truth_enu()[2] == pytest.approx(5.0, abs=1.0)


def test_a_height_that_the_gate_would_refuse_is_refused_at_once() -> None:
    flight, client = standing()
    assert choose(flight, client, 5000.0) != ACCEPTED
    assert client.ask(ARM, 1, within_s=10) == ACCEPTED
    stays_down(flight)


def another_arms(flight: BridgedFlight, client: Client, other: Client) -> None:
    assert other.ask(ARM, 1, within_s=10) == ACCEPTED


def disarms(flight: BridgedFlight, client: Client, other: Client) -> None:
    client.command(ARM, 0)
    flight.beating(1.0)
    assert client.ask(ARM, 1, within_s=10) == ACCEPTED


@pytest.mark.parametrize("ends", [another_arms, disarms])
def test_something_else_ends_the_choice(
    ends: Callable[[BridgedFlight, Client, Client], None],
) -> None:
    """What else does, and when, `test_mission_mode_then_arm.py` has: a choice is a choice."""
    flight, client = standing()
    other = flight.join(246)
    assert choose(flight, client) == ACCEPTED
    ends(flight, client, other)
    stays_down(flight)
    assert client.texts().count("takeoff: forgotten") == 1


def test_an_ardupilot_is_armed_first_as_ever() -> None:
    flight, client = standing("ardupilot")
    assert client.ask(TAKE_OFF, 0, 0, 0, NAN, NAN, NAN, 6.0) == TEMPORARILY_REJECTED
    assert client.ask(ARM, 1, within_s=10) == ACCEPTED
    stays_down(flight)


def test_the_take_off_mode_before_the_arming_is_no_choice() -> None:
    """A heartbeat would have to show that mode, and nothing is sent to the vehicle."""
    flight, client = standing()
    assert client.ask(SET_MODE, 1, 4, 2) != ACCEPTED
    assert client.ask(ARM, 1) == ACCEPTED
    stays_down(flight)
