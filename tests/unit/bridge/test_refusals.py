"""The table of refusals before the bridge alone: what the client gets; the vehicle gets nothing."""

from __future__ import annotations

from typing import Any

import pytest

from gcs import ipc
from gcs.bridge.effects import ClientRefused, ClientRequest, ForwardToLink, ForwardToVehicle, Reply
from gcs.gate.policy.parse import DEFAULT
from gcs.protocol.autopilot import ARDUPILOT, PX4, Autopilot
from gcs.protocol.effects import Address
from gcs.wire.messages import CommandAck, FileTransferProtocol, Message, MissionAck, ParamError
from tests.each import each
from tests.unit.bridge.refusals import CAMERA, IN_AIR, ON_GROUND, Home, Refused
from tests.unit.bridge.test_bridge import VEHICLE, Table, of, texts
from tests.unit.bridge.vehicles import flying, standing

ROWS = [(row, standing) for row in ON_GROUND] + [(row, flying) for row in IN_AIR]


def answer(message: Message) -> tuple[str, int] | None:
    match message:
        case CommandAck(result=result):
            return "COMMAND_ACK", result
        case MissionAck(type=result):
            return "MISSION_ACK", result
        case ParamError(error=error):
            return "PARAM_ERROR", error
        case FileTransferProtocol(payload=payload):
            return "FILE_TRANSFER_PROTOCOL", payload[3]
    return None


def verdict(ask: ipc.Ask, code: str, sentence: str) -> ipc.VerdictEvent:
    return ipc.VerdictEvent(ask.id, ask.word, "refused", code, sentence)


@pytest.mark.parametrize("autopilot", [PX4, ARDUPILOT], ids=lambda a: a.name)
@each("row", ROWS, lambda row: row[0].name)
def test_it_is_refused(autopilot: Autopilot, row: tuple[Refused, Any]) -> None:
    refused, how = row
    if autopilot.name not in refused.who:
        return
    seen = how(autopilot, in_control=not refused.by_another, hears=lambda compid: compid == CAMERA)
    table = Table(seen=seen, rules=DEFAULT.bridge)
    if refused.by_another:
        table.bridge.control_changed(7, "somebody", [VEHICLE], table.now_ns)
    sent = refused.sends(Home(autopilot.name, 47.397742, 8.545594, 500.0))
    judged = table.says(sent)
    assert judged.refused is not bool(refused.asks)
    assert not of(ForwardToVehicle, judged.effects)
    assert not of(ForwardToLink, judged.effects)
    if refused.asks:
        (request,) = of(ClientRequest, judged.effects)
        assert request.command.word == refused.asks
        client, event = request.client, verdict(request.command, refused.code, refused.says)
    else:
        assert not of(ClientRequest, judged.effects)
        (told,) = of(ClientRefused, judged.effects)
        assert told.refusal.code == refused.code
        client = told.client
        event = verdict(told.ask, told.refusal.code.value, told.refusal.sentence)
    effects = [*judged.effects, *table.bridge.told(client, event, VEHICLE.sysid, table.now_ns)]
    replies = [each for each in of(Reply, effects) if answer(each.message) is not None]
    assert [answer(each.message) for each in replies] == [refused.answer] * bool(refused.answer)
    for reply in replies:
        to: Any = reply.message
        assert (to.target_system, to.target_component) == (245, 190)
        compid = getattr(sent, "target_component", 1)
        assert reply.source == Address(1, compid)
    assert refused.says in texts(effects)
    assert refused.code in texts(effects)
