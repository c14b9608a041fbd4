"""A stream of messages that are refused is one decision in some seconds, not one for each frame."""

from __future__ import annotations

from gcs.bridge.conversation.dialogue import Dialogue
from gcs.bridge.conversation.pending_requests import From
from gcs.bridge.conversation.recent_texts import MOST_TEXTS
from gcs.bridge.effects import ClientRefused
from gcs.gate.refusal import Code, Refusal
from gcs.protocol.effects import Address
from gcs.wire.ids import Cmd
from gcs.wire.messages import CommandLong, Message

MS = 1_000_000
CLIENT = From(1, Address(250, 0), Address(1, 1))
DENIED = Refusal(Code.POLICY, "It feeds the estimator.")


def decisions(messages: list[tuple[Message | None, Refusal]], every_ms: int = 50) -> int:
    """How many of these, sent one after the other, are decisions on the record."""
    dialogue, now_ns, count = Dialogue(1000), 0, 0
    for message, refusal in messages:
        effects = dialogue.refuse(CLIENT, message, "GPS_INPUT", refusal, now_ns)
        count += sum(isinstance(effect, ClientRefused) for effect in effects)
        now_ns += every_ms * MS
    return count


def test_two_seconds_of_a_stream_are_one_decision() -> None:
    assert decisions([(None, DENIED)] * 40) == 1


def test_it_is_told_again_after_five_seconds() -> None:
    assert decisions([(None, DENIED)] * 101) == 2


def test_another_reason_is_another_decision() -> None:
    """As of two parameters that are guarded, one after the other."""
    other = Refusal(Code.POLICY, "GF_ACTION is guarded")
    assert decisions([(None, DENIED), (None, other), (None, DENIED)]) == 2


def test_a_command_is_decided_each_time_that_it_is_new() -> None:
    """It is acknowledged, so its sender waits for an answer."""
    messages: list[tuple[Message | None, Refusal]] = [
        (CommandLong(float(turn), 0, 0, 0, 0, 0, 0, Cmd.DO_MOTOR_TEST, 1, 1, 0), DENIED)
        for turn in range(3)
    ]
    assert decisions(messages) == 3


def test_a_client_that_thinks_of_ever_new_ones_is_not_told_of_all() -> None:
    refusals = [Refusal(Code.POLICY, f"parameter {number}") for number in range(1000)]
    messages: list[tuple[Message | None, Refusal]] = [(None, refusal) for refusal in refusals]
    assert decisions(messages, every_ms=1) == MOST_TEXTS
