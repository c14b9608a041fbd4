"""A MAVLink client's velocity stream, straight at the fence: the vehicle's truth stays inside."""

from __future__ import annotations

import math

import pytest
from pymavlink.dialects.v20 import all as dialect

from gcs.gate.states import Control, State
from tests.loopback.bridged import VEHICLE, BridgedFlight, Client
from tests.loopback.flight import PERSONALITIES, Personality

ACCEPTED = 0
ARM, TAKE_OFF, SET_MODE = 400, 22, 176
VELOCITY_ONLY = 0xDC7
FENCE_M = 150.0


def flying(personality: Personality) -> tuple[BridgedFlight, Client]:
    flight = BridgedFlight(personality)
    client = flight.join()
    flight.connected()
    assert client.ask(ARM, 1, within_s=10) == ACCEPTED
    up_m = math.nan if personality == "px4" else 5.0
    assert client.ask(TAKE_OFF, 0, 0, 0, math.nan, math.nan, math.nan, up_m) == ACCEPTED
    flight.until(
        lambda: flight.is_in(State.HOVERING) and flight.session.gate.control is Control.OURS
    )
    return flight, client


@pytest.mark.parametrize("personality", PERSONALITIES)
def test_full_speed_at_the_fence_is_held_inside_and_flown_back(personality: Personality) -> None:
    flight, client = flying(personality)

    def stream(v_n: float, seconds: float) -> float:
        farthest = 0.0
        for count in range(round(seconds * 20)):
            client.send(
                dialect.MAVLink_set_position_target_local_ned_message(
                    0, *VEHICLE, 1, VELOCITY_ONLY, 0, 0, 0, v_n, 0, 0, 0, 0, 0, 0, 0
                )
            )
            if count % 20 == 0:
                client.beat()
            flight.run(0.05)
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
