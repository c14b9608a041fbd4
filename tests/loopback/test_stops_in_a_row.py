"""A stop that comes after something else is a stop of its own, however fast they come."""

from __future__ import annotations

from collections import Counter

from pymavlink.dialects.v20 import all as dialect

from gcs.gate.states import State
from tests.loopback.bridged import VEHICLE, Client, take_off
from tests.loopback.flight import Personality
from tests.loopback.plan_clients import PlanFlight

ACCEPTED, IN_PROGRESS = 0, 5
SET_MODE, RETURN, LAND, PAUSE_CONTINUE, MISSION_START = 176, 20, 21, 193, 300
GUIDED = {"px4": (1.0, 6.0, 0.0), "ardupilot": (1.0, 4.0, 0.0)}
PAUSE, CONTINUE = (PAUSE_CONTINUE, 0.0), (PAUSE_CONTINUE, 1.0)


def in_one_datagram(client: Client, *commands: tuple[float, ...]) -> None:
    packed = b""
    for command, *params in commands:
        filled = [*params, *[0.0] * (7 - len(params))]
        message = dialect.MAVLink_command_long_message(*VEHICLE, int(command), 0, *filled)
        packed += message.pack(client.mav)
    client.send_raw(packed)


def hovering(personality: Personality) -> tuple[PlanFlight, Client]:
    flight = PlanFlight(personality)
    take_off(flight)
    (client,) = flight.clients.values()
    client.heard.clear()
    return flight, client


def finals(client: Client) -> Counter[int]:
    acks = client.messages("COMMAND_ACK")
    return Counter(ack.command for ack in acks if ack.result != IN_PROGRESS)


def test_nine_commands_in_one_datagram_have_nine_answers(personality: Personality) -> None:
    """Also of a client that is not in control: what it may not do stands between its stops."""
    flight, one = hovering(personality)
    other = flight.join(246)
    mode = (SET_MODE, *GUIDED[personality])
    commands = (
        PAUSE,
        CONTINUE,
        (RETURN,),
        PAUSE,
        mode,
        (MISSION_START,),
        PAUSE,
        (RETURN,),
        (LAND,),
    )
    for client in (other, one):
        in_one_datagram(client, *commands)
        flight.beating(6.0)
        assert finals(client) == Counter(int(command) for command, *_ in commands)


def test_a_stop_that_is_asked_for_twice_is_never_told_to_be_refused(
    personality: Personality,
) -> None:
    flight, _ = hovering(personality)
    client = flight.join(246)
    in_one_datagram(client, PAUSE, (MISSION_START,), PAUSE)
    flight.beating(3.0)
    assert flight.is_in(State.HOLDING)
    assert [ack.result for ack in client.acks(PAUSE_CONTINUE)] == [ACCEPTED, ACCEPTED]
