"""One command of a client that stands for several requests: the last of them answers it."""

from __future__ import annotations

import pytest

from gcs import ipc
from gcs.bridge.conversation.dialogue import Dialogue
from gcs.bridge.conversation.pending_requests import From
from gcs.bridge.effects import BridgeEffect, ClientRequest, Reply
from gcs.protocol.effects import Address
from gcs.wire.ids import Cmd, Result
from gcs.wire.messages import CommandAck, CommandLong, Statustext

CLIENT = From(1, Address(245, 190), Address(1, 1))
START = CommandLong(0, 0, 0, 0, 0, 0, 0, Cmd.MISSION_START, 1, 1, 0)


class Start:
    """MISSION_START: `first`, then `mission_start`."""

    def __init__(self, first: str) -> None:
        self.first, self.dialogue = first, Dialogue(1000)
        asks = (ipc.Ask(0, first), ipc.Ask(0, "mission_start"))
        self.asked = self.number_of(self.dialogue.ask(CLIENT, START, asks, 0))

    @staticmethod
    def number_of(effects: list[BridgeEffect]) -> int:
        (said,) = effects
        assert isinstance(said, ClientRequest)
        assert isinstance(said.command, ipc.Ask)
        return said.command.id

    def first_done(self) -> list[BridgeEffect]:
        """The gate accepts, the vehicle acknowledges, and the heartbeat shows it."""
        verdict = ipc.VerdictEvent(self.asked, self.first, "accepted", operation=1)
        answered = self.dialogue.told(verdict, 0) + self.dialogue.command_answered(
            1, Result.ACCEPTED, 0
        )
        ended = self.dialogue.told(ipc.EndingEvent(self.asked, self.first, "complete"), 0)
        self.asked = self.number_of(ended)
        return answered


def results(effects: list[BridgeEffect]) -> list[int]:
    acks = [each.message for each in effects if isinstance(each, Reply)]
    return [ack.result for ack in acks if isinstance(ack, CommandAck)]


def texts(effects: list[BridgeEffect]) -> str:
    said = [each.message for each in effects if isinstance(each, Reply)]
    return "".join(text.text for text in said if isinstance(text, Statustext))


@pytest.mark.parametrize("first", ["arm", "hold"])
def test_the_vehicles_answer_to_the_first_is_not_yet_the_answer(first: str) -> None:
    """On the ground it arms first, out of a go-to it holds first."""
    start = Start(first)
    assert results(start.first_done()) == []
    verdict = ipc.VerdictEvent(start.asked, "mission_start", "accepted", operation=2)
    assert results(start.dialogue.told(verdict, 0)) == []
    assert results(start.dialogue.command_answered(2, Result.ACCEPTED, 0)) == [Result.ACCEPTED]


@pytest.mark.parametrize("first", ["arm", "hold"])
def test_a_refusal_of_the_last_is_what_the_client_hears_by_its_name(first: str) -> None:
    start = Start(first)
    start.first_done()
    verdict = ipc.VerdictEvent(start.asked, "mission_start", "refused", "NO_MISSION", "none")
    effects = start.dialogue.told(verdict, 0)
    assert results(effects) == [Result.DENIED]
    assert texts(effects).startswith("mission_start: refused NO_MISSION")


ARM = CommandLong(1, 0, 0, 0, 0, 0, 0, Cmd.COMPONENT_ARM_DISARM, 1, 1, 0)
CHECKED = (ipc.Ask(0, "mission_check"), ipc.Ask(0, "arm"), ipc.Ask(0, "mission_start"))


def asked_for(effects: list[BridgeEffect]) -> list[str]:
    said = [each.command for each in effects if isinstance(each, ClientRequest)]
    return [ask.word for ask in said if isinstance(ask, ipc.Ask)]


def armed_before() -> tuple[Dialogue, int, list[BridgeEffect]]:
    """A client has asked to arm, and asks for a mission start before that has ended."""
    dialogue = Dialogue(1000)
    asked = Start.number_of(dialogue.ask(CLIENT, ARM, (ipc.Ask(0, "arm"),), 0))
    return dialogue, asked, dialogue.ask(CLIENT, START, CHECKED, 0)


def test_an_arming_that_comes_while_the_mission_is_checked_is_waited_for() -> None:
    dialogue = Dialogue(1000)
    check = Start.number_of(dialogue.ask(CLIENT, START, CHECKED, 0))
    arming = Start.number_of(dialogue.ask(CLIENT, ARM, (ipc.Ask(0, "arm"),), 0))
    assert dialogue.told(ipc.EndingEvent(check, "mission_check", "complete"), 0) == []
    dialogue.told(ipc.VerdictEvent(arming, "arm", "accepted", operation=1), 0)
    armed = dialogue.told(ipc.EndingEvent(arming, "arm", "complete"), 0)
    assert asked_for(armed) == ["mission_start"]


def test_a_mission_that_does_not_clear_is_not_armed_for() -> None:
    dialogue = Dialogue(1000)
    check = Start.number_of(dialogue.ask(CLIENT, START, CHECKED, 0))
    refused = ipc.VerdictEvent(check, "mission_check", "refused", "NO_MISSION", "none")
    effects = dialogue.told(refused, 0)
    assert results(effects) == [Result.DENIED]
    assert asked_for(effects) == []


def test_a_start_waits_for_the_arming_that_is_under_way() -> None:
    """To arm once more would be refused BUSY."""
    dialogue, arming, effects = armed_before()
    assert effects == []
    dialogue.told(ipc.VerdictEvent(arming, "arm", "accepted", operation=1), 0)
    ended = dialogue.told(ipc.EndingEvent(arming, "arm", "complete"), 0)
    assert results(ended) == [Result.ACCEPTED], "the arming"
    assert asked_for(ended) == ["mission_start"]


def test_a_start_fails_with_the_arming_that_it_waits_for() -> None:
    dialogue, arming, _ = armed_before()
    refused = ipc.VerdictEvent(arming, "arm", "refused", "SEVERITY", "low battery")
    assert results(dialogue.told(refused, 0)) == [Result.TEMPORARILY_REJECTED] * 2
    dialogue, arming, _ = armed_before()
    dialogue.told(ipc.VerdictEvent(arming, "arm", "accepted", operation=1), 0)
    aborted = ipc.EndingEvent(arming, "arm", "aborted", "OPERATOR", "stopped")
    effects = dialogue.told(aborted, 0)
    assert results(effects) == [Result.DENIED] * 2
    assert not [each for each in effects if isinstance(each, ClientRequest)], "never asked for"
