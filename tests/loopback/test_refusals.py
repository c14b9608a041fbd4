"""The table of refusals (tests/unit/bridge/refusals.py) before a whole station and a vehicle."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import pytest
from pymavlink.dialects.v20 import all as dialect

from gcs.gate.states import State
from gcs.session import inputs
from tests.loopback.bridged import ACCEPTED, VEHICLE, BridgedFlight, Client, flying
from tests.loopback.flight import HOMES, PERSONALITIES, Personality
from tests.unit.bridge.refusals import CAMERA, IN_AIR, NAK, ON_GROUND, Home, Refused

RESULT = {"COMMAND_ACK": "result", "MISSION_ACK": "type", "PARAM_ERROR": "error"}
REQUEST_CONTROL = 32100

pytestmark = pytest.mark.parametrize("personality", PERSONALITIES)


def answers(client: Client, since: int) -> list[Any]:
    kinds = (*RESULT, "FILE_TRANSFER_PROTOCOL")
    heard = [one.message for one in client.heard[since:]]
    return [message for message in heard if message.get_type() in kinds]


def play(rows: Sequence[Refused], flight: BridgedFlight, client: Client, other: Client) -> None:
    """Nothing of any row is different afterwards."""
    camera = dialect.MAVLink(None, srcSystem=VEHICLE[0], srcComponent=CAMERA)
    beat = dialect.MAVLink_heartbeat_message(30, 8, 0, 0, 4, 3)
    flight.feed(inputs.Datagram(0, beat.pack(camera)))
    place = HOMES[flight.personality]
    home = Home(flight.personality, place.lat_deg, place.lon_deg, place.alt_amsl_m)
    told: set[str] = set()
    state, armed, plan = flight.state, flight.vehicle.armed, flight.vehicle.plan
    for row in rows:
        if flight.personality in row.who:
            # The same is told again after five seconds.
            flight.beating(5.0 if row.says in told else 0.1)
            told.add(row.says)
            try:
                refused(row, flight, other if row.by_another else client, home)
            except Exception as failed:
                failed.add_note(row.name)
                raise
            assert (flight.state, flight.vehicle.armed, flight.vehicle.plan) == (state, armed, plan)


def refused(row: Refused, flight: BridgedFlight, sender: Client, home: Home) -> None:
    message = row.sends(home)
    heard, decided = len(sender.heard), len(flight.decisions("refused"))
    said = sender.texts()

    def reached() -> int:
        frames = flight.to_vehicle(message.get_type())
        return sum(frame.sysid == sender.mav.srcSystem for frame in frames)

    before = reached()
    sender.send(message)
    flight.beating(0.4)
    assert reached() == before
    assert not any(message.get_msgbuf() in sent.data for sent in flight.sent[-50:])
    assert [one.code for one in flight.decisions("refused")[decided:]] == [row.code]
    told = answers(sender, heard)
    if row.answer is None:
        assert told == []
    else:
        (answer,) = told
        kind, result = row.answer
        assert answer.get_type() == kind
        assert (answer.target_system, answer.target_component) == (sender.mav.srcSystem, 190)
        assert answer.get_srcComponent() == getattr(message, "target_component", 1)
        if row.answer == NAK:
            assert answer.payload[3] == result
        else:
            assert getattr(answer, RESULT[kind]) == result
    text = sender.texts().removeprefix(said).replace("\n", "")
    assert row.says in text, text


def test_on_the_ground(personality: Personality) -> None:
    flight = BridgedFlight(personality)
    client, other = flight.join(), flight.join(246)
    flight.connected()
    assert client.ask(REQUEST_CONTROL, 1, 1) == ACCEPTED
    fence = {"px4": "GF_ACTION", "ardupilot": "FENCE_ENABLE"}[personality]
    before = flight.vehicle.parameters.get(fence)
    play(ON_GROUND, flight, client, other)
    assert flight.vehicle.parameters.get(fence) == before
    told = [one.param_id for one in client.messages("PARAM_VALUE")]
    assert fence in told, "the old value, from the vehicle itself"


def test_in_the_air(personality: Personality) -> None:
    flight, client = flying(personality)
    play(IN_AIR, flight, client, flight.join(246))
    assert flight.is_in(State.HOVERING)
