"""What clients are told: MAV_RESULT of refusals, the reason's number, texts in pieces."""

from __future__ import annotations

import pytest

from gcs.bridge.conversation.answers import acknowledgement, item_acknowledgement, result_of, texts
from gcs.gate.effects import Level
from gcs.gate.refusal import Code
from gcs.protocol.effects import Address
from gcs.wire.ids import MissionResult, Result


@pytest.mark.parametrize("code", [Code.IN_AIR, Code.NOT_ARMED, Code.NOT_FLYING, Code.BUSY])
def test_what_another_command_or_waiting_helps_is_rejected_for_now(code: Code) -> None:
    """PX4 1.14, recorded ("disarm in air", commands_px4.json): TEMPORARILY_REJECTED."""
    assert result_of(code) is Result.TEMPORARILY_REJECTED


@pytest.mark.parametrize("code", [Code.OUTSIDE_FENCE, Code.POLICY, Code.ALREADY_FLYING])
def test_what_is_refused_for_good_is_denied(code: Code) -> None:
    assert result_of(code) is Result.DENIED


@pytest.mark.parametrize(
    ("level", "severity"),
    [
        (Level.DEBUG, 7),
        (Level.INFO, 6),
        (Level.WARNING, 4),
        (Level.ERROR, 3),
        (Level.FATAL, 2),
    ],
)
def test_severities_are_those_of_syslog(level: Level, severity: int) -> None:
    """MAV_SEVERITY: EMERGENCY 0 to DEBUG 7."""
    (told,) = texts(level, "a text", 7)
    assert (told.severity, told.text, told.id) == (severity, "a text", 0)


@pytest.mark.parametrize("letters", [50, 51, 99, 100, 101, 150])
def test_a_long_text_is_joined_by_a_receiver_as_mavlink_says(letters: int) -> None:
    """Pieces of one id in order; one that is not full ends it.  None is empty: QGroundControl would
    show " ... " in its place."""
    text = "".join(chr(97 + i % 26) for i in range(letters))
    told = texts(Level.INFO, text, 7)
    assert "".join(each.text for each in told).rstrip() == text
    assert all(each.text for each in told)
    if letters <= 50:
        assert [each.id for each in told] == [0]
        return
    assert [(each.id, each.chunk_seq) for each in told] == [(7, n) for n in range(len(told))]
    assert all(len(each.text) == 50 for each in told[:-1])
    assert len(told[-1].text) < 50


def test_an_acknowledgement_has_a_reasons_number_where_there_is_one() -> None:
    """The numbers of docs/bridge.md."""
    to = Address(245, 190)
    refused = acknowledgement(400, Result.DENIED, to, Code.OUTSIDE_FENCE)
    assert (refused.result_param2, refused.target_system, refused.target_component) == (
        12,
        245,
        190,
    )
    assert acknowledgement(400, Result.ACCEPTED, to).result_param2 == 0
    assert acknowledgement(400, Result.TEMPORARILY_REJECTED, to, Code.BUSY).result_param2 == 1


def test_an_items_acknowledgement_is_accepted_or_denied() -> None:
    to = Address(245, 190)
    assert item_acknowledgement(Result.ACCEPTED, to).type == MissionResult.ACCEPTED
    assert item_acknowledgement(Result.FAILED, to).type == MissionResult.DENIED
