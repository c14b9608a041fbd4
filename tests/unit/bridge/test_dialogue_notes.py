"""What a client is told beside the answer: with what is accepted, and not with what is refused."""

from __future__ import annotations

from gcs import ipc
from gcs.bridge.conversation.dialogue import Dialogue
from gcs.bridge.conversation.pending_requests import From
from gcs.bridge.effects import BridgeEffect, ClientRequest, Reply
from gcs.protocol.effects import Address
from gcs.wire.ids import Cmd, Result
from gcs.wire.messages import CommandAck, CommandLong, Statustext

CLIENT = From(1, Address(245, 190), Address(1, 1))
CONTINUE = CommandLong(1, 0, 0, 0, 0, 0, 0, Cmd.DO_PAUSE_CONTINUE, 1, 1, 0)
NOTE = "hovers under control"


def asked(dialogue: Dialogue, *words: str) -> list[BridgeEffect]:
    return dialogue.ask(CLIENT, CONTINUE, [ipc.Ask(0, word) for word in words], 0, note=NOTE)


def number(effects: list[BridgeEffect]) -> int:
    (said,) = (each for each in effects if isinstance(each, ClientRequest))
    assert isinstance(said.command, ipc.Ask)
    return said.command.id


def texts(effects: list[BridgeEffect]) -> list[str]:
    said = [each.message for each in effects if isinstance(each, Reply)]
    return [each.text for each in said if isinstance(each, Statustext)]


def test_it_is_told_once_what_was_asked_is_accepted() -> None:
    dialogue = Dialogue(1000)
    effects = asked(dialogue, "resume")
    assert texts(effects) == []
    verdict = ipc.VerdictEvent(number(effects), "resume", "accepted", operation=1)
    assert texts(dialogue.told(verdict, 0)) == [NOTE]


def test_of_what_is_refused_it_is_not_told() -> None:
    dialogue = Dialogue(1000)
    refused = ipc.VerdictEvent(
        number(asked(dialogue, "resume")), "resume", "refused", "NOT_IN_CONTROL", operation=1
    )
    told = texts(dialogue.told(refused, 0))
    assert told
    assert NOTE not in told


def test_of_several_requests_the_first_brings_it_and_the_others_do_not() -> None:
    dialogue = Dialogue(1000)
    first = number(asked(dialogue, "hold", "resume"))
    assert texts(dialogue.told(ipc.VerdictEvent(first, "hold", "accepted", operation=1), 0)) == [
        NOTE
    ]
    second = number(dialogue.told(ipc.EndingEvent(first, "hold", "complete"), 0))
    accepted = ipc.VerdictEvent(second, "resume", "accepted", operation=2)
    assert texts(dialogue.told(accepted, 0)) == []


def test_what_is_so_already_is_told_with_its_answer() -> None:
    effects = asked(Dialogue(1000))
    assert texts(effects) == [NOTE]
    ack = effects[-1].message if isinstance(effects[-1], Reply) else None
    assert isinstance(ack, CommandAck)
    assert ack.result == Result.ACCEPTED
