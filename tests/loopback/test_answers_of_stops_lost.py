"""The vehicle's COMMAND_ACKs are lost: what its heartbeat shows is a client's answer then."""

from __future__ import annotations

import math

import pytest
from pymavlink.dialects.v20 import all as dialect

from gcs.gate.states import State
from gcs.wire.frame import Frame, split
from tests.loopback.bridged import Client, joined, take_off
from tests.loopback.flight import Personality
from tests.loopback.lossy_link import CLEAR, Air
from tests.loopback.plan_clients import Mavsdk, PlanFlight, mission

ACCEPTED, IN_PROGRESS = 0, 5
RETURN, LAND, TAKE_OFF, MISSION_START, ARM = 20, 21, 22, 300, 400
NAN = math.nan
SOON_S = 2.5
"""Two heartbeats, and the time that a command takes."""


class WayDown(Air):
    """COMMAND_ACKs are lost, and heartbeats where it says so; all else arrives."""

    lost: frozenset[str] = frozenset({"COMMAND_ACK"})

    def send(self, data: bytes, now_ns: int) -> None:
        frames = [item for item in split(data) if isinstance(item, Frame)]
        kept = [frame.raw for frame in frames if frame.name not in self.lost]
        if kept:
            super().send(b"".join(kept), now_ns)


def hovering(personality: Personality) -> tuple[PlanFlight, Client, WayDown]:
    """A client's vehicle with a mission on board; from now on answers are lost."""
    flight = PlanFlight(personality)
    take_off(flight)
    (client,) = flight.clients.values()
    plan = mission(personality, (20.0, 0.0, 10.0), (20.0, 20.0, 10.0))
    assert Mavsdk(flight, client, plan).ended() == "complete"
    flight.down = WayDown(CLEAR, 1)
    return flight, client, flight.down


@pytest.mark.parametrize("command", [RETURN, LAND, MISSION_START])
def test_what_the_heartbeat_shows_is_answered(command: int, personality: Personality) -> None:
    flight, client, _ = hovering(personality)
    assert client.ask(command, within_s=SOON_S) == ACCEPTED
    flying = (State.RETURNING, State.LANDING, State.FLYING_MISSION)
    assert any(map(flight.is_in, flying)), "it is under way still"
    flight.beating(10.0)
    final = [ack for ack in client.acks(command) if ack.result != IN_PROGRESS]
    assert len(final) == 1


def test_a_take_off_of_a_px4_is_answered_while_it_climbs() -> None:
    flight, client = joined(PlanFlight("px4"))
    assert client.ask(ARM, 1, within_s=10) == ACCEPTED
    flight.down = WayDown(CLEAR, 1)
    assert client.ask(TAKE_OFF, 0, 0, 0, NAN, NAN, NAN, NAN, within_s=SOON_S) == ACCEPTED
    assert flight.is_in(State.TAKING_OFF)


@pytest.mark.parametrize("command", [RETURN, LAND])
def test_a_mode_that_no_heartbeat_shows_is_not_answered(
    command: int, personality: Personality
) -> None:
    flight, client, down = hovering(personality)
    down.lost = frozenset({"COMMAND_ACK", "HEARTBEAT"})
    client.command(command)
    flight.beating(2.0)
    assert not [ack for ack in client.acks(command) if ack.result != IN_PROGRESS]
    down.lost = frozenset({"COMMAND_ACK"})
    flight.beating(SOON_S)
    assert [ack.result for ack in client.acks(command)] == [dialect.MAV_RESULT_ACCEPTED]
