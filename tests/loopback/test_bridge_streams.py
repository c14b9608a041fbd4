"""A MAVLink client's velocity stream, straight at the fence: the vehicle's truth stays inside."""

from __future__ import annotations

import math

import pytest
from pymavlink.dialects.v20 import all as dialect

from gcs import ipc
from gcs.gate.states import Control, State
from gcs.report import DecisionItem
from gcs.session import inputs
from tests.loopback.bridged import ACCEPTED, VEHICLE, BridgedFlight, Client, flying, joined
from tests.loopback.flight import PERSONALITIES, Personality

SET_MODE = 176
VELOCITY_ONLY = 0xDC7
FENCE_M = 150.0


@pytest.mark.parametrize("personality", PERSONALITIES)
def test_samples_that_come_while_control_is_being_taken_are_not_told_as_refused(
    personality: Personality,
) -> None:
    """They are not flown yet; the record has that they were not."""
    flight, client = flying(personality)
    hold, guided = ((4, 3), (6, 0)) if personality == "px4" else ((17, 0), (4, 0))
    assert client.ask(SET_MODE, 1, *hold) == ACCEPTED
    flight.run(2.0)
    client.command(SET_MODE, 1, *guided)
    flight.until(lambda: flight.session.gate.control is Control.TAKING, 2.0)
    velocity(client, 1.0, 60)
    assert flight.is_in(State.STREAMING)
    streams = [each for each in flight.decisions() if each.word == "stream"]
    assert [(each.outcome, each.code) for each in streams] == [
        ("refused", "CONTROL_PENDING"),
        ("accepted", ""),
    ]
    assert "refused" not in client.texts()


@pytest.mark.parametrize("personality", PERSONALITIES)
def test_full_speed_at_the_fence_is_held_inside_and_flown_back(personality: Personality) -> None:
    flight, client = flying(personality)

    def stream(v_n: float, seconds: float) -> float:
        farthest = 0.0
        for count in range(round(seconds * 20)):
            if count % 20 == 0:
                client.beat()
            velocity(client, v_n, 1)
            farthest = max(farthest, flight.truth_enu()[1])
        return farthest

    farthest = stream(8.0, 40)
    assert flight.state in (State.STREAMING, State.HOLDING)
    assert 60 < farthest < FENCE_M
    assert "stream: refused" in client.texts()
    back = stream(-3.0, 20)
    assert back <= farthest + 0.5
    assert "stream: flown" in client.texts()
    assert "gate: Stream refused" not in client.texts(), "its own sentence has told it"


def left_hovering(flight: BridgedFlight) -> None:
    """A one-shot command has taken control and gone: it leaves the vehicle as it is."""
    flight.feed(inputs.OperatorJoined(2, "gcs goto", hold_on_leave=False))
    flight.feed(inputs.OperatorLine(2, ipc.Ask(1, "station_take")))
    flight.feed(inputs.OperatorLine(2, ipc.Leave("done")))
    flight.run(0.1)
    assert flight.is_in(State.HOVERING)


def in_control(flight: BridgedFlight) -> int:
    return flight.of(ipc.Operators)[-1].in_control


def velocity(client: Client, v_n: float, times: int) -> None:
    for _ in range(times):
        client.send(
            dialect.MAVLink_set_position_target_local_ned_message(
                0, *VEHICLE, 1, VELOCITY_ONLY, 0, 0, 0, v_n, 0, 0, 0, 0, 0, 0, 0
            )
        )
        client.flight.run(0.05)


@pytest.mark.parametrize("personality", PERSONALITIES)
def test_a_stream_that_is_refused_takes_no_control(personality: Personality) -> None:
    """On the ground, as a PX4's client does before it asks for OFFBOARD, and in the air; nor does
    one without numbers."""
    flight, client = joined(BridgedFlight(personality))
    for _ in range(3):  # each alone
        velocity(client, 1.0, 1)
        flight.beating(2.0)
    velocity(client, math.nan, 20)
    velocity(client, 1.0, 20)
    assert "NOT_FLYING" in client.texts()
    assert in_control(flight) == 0
    flight, client = flying(personality)
    left_hovering(flight)
    assert in_control(flight) == 0
    velocity(client, 100.0, 20)
    assert "stream: refused POLICY" in client.texts()
    assert in_control(flight) == 0
    velocity(client, 1.0, 30)
    assert in_control(flight) == 1000, "its samples are flown"
    assert flight.is_in(State.STREAMING)


def test_a_refused_stream_of_a_client_is_a_decision_on_the_record_and_on_the_page() -> None:
    flight, client = flying("px4")
    velocity(client, 100.0, 20)
    flight.run(7.0)
    kept = [item for item in flight.recorded(DecisionItem) if item.phase == "stream"]
    assert [(item.source, item.outcome, item.code) for item in kept] == [
        ("operator 1000", "refused", "POLICY"),
        ("operator 1000", "ended", "POLICY"),
    ]
    assert kept[0].numbers["asked_v_north_m_s"] == 100.0
    assert kept[1].numbers == {"refused_samples": 20.0}
    shown = [each for each in flight.of(ipc.BridgeDecision) if each.what == "stream"]
    assert [(each.client, each.outcome, each.code) for each in shown] == [
        (1000, "refused", "POLICY")
    ]
