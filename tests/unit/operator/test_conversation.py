"""What is kept of a talk with a station: the latest of each, and what became of each request."""

from __future__ import annotations

import msgspec
import pytest

from gcs import ipc
from gcs.exit_codes import ExitCode
from gcs.operator.client import StationEnded
from gcs.operator.conversation import Conversation

GOTO = ipc.Ask(0, "goto", goal_enu=(3.0, 0.0, 2.0))


@pytest.mark.parametrize(
    ("ruling", "code", "ended", "outcome_code", "exit_code"),
    [
        ("accepted", "", "complete", "", ExitCode.DONE),
        ("accepted", "", "aborted", "VEHICLE_REFUSED", ExitCode.REFUSED_BY_VEHICLE),
        ("accepted", "", "timed out", "DEADLINE", ExitCode.NOT_COMPLETED),
        ("accepted", "", "taken over", "MODE_CHANGED", ExitCode.NOT_COMPLETED),
        ("refused", "BUSY", "", "", ExitCode.REFUSED_BY_GATE),
        ("refused", "NO_VEHICLE", "", "", ExitCode.NO_VEHICLE),
        ("refused", "BAD_MISSION", "", "", ExitCode.BAD_FILE),
        ("refused", "RECORDER_DOWN", "", "", ExitCode.RECORDER),
        ("superseded", "SUPERSEDED", "", "", ExitCode.REFUSED_BY_GATE),
        ("accepted", "", "", "", ExitCode.NOT_COMPLETED),
    ],
)
def test_what_becomes_of_a_request_and_what_a_program_exits_with(
    ruling: str, code: str, ended: str, outcome_code: str, exit_code: ExitCode
) -> None:
    talk = Conversation()
    tracked = talk.ask(GOTO)
    assert not tracked.settled
    assert talk.told(ipc.VerdictEvent(1, "goto", ruling, code)) is tracked
    assert talk.told(ipc.ProgressEvent(1, "goto", 1.0, 2.0)) is (
        tracked if ruling == "accepted" else None
    )
    if ended:
        assert talk.told(ipc.EndingEvent(1, "goto", ended, outcome_code)) is tracked
    assert tracked.settled == (ruling != "accepted" or bool(ended))
    assert tracked.completed == (ended == "complete")
    assert tracked.exit_code == exit_code


def test_requests_are_numbered_and_named_as_they_would_be_typed() -> None:
    talk = Conversation()
    first, second = talk.ask(GOTO), talk.ask(ipc.Ask(7, "land"), "down & out")
    assert (first.sent.id, first.label) == (1, "goto 3 0 2")
    assert (second.sent.id, second.label) == (2, "down & out")
    assert first.exit_code is ExitCode.NOT_COMPLETED


def test_what_answers_nobody_here_or_is_settled_already_is_of_no_request() -> None:
    talk = Conversation()
    tracked = talk.ask(GOTO)
    assert talk.told(ipc.VerdictEvent(2, "land", "accepted")) is None
    assert talk.told(ipc.VerdictEvent(1, "goto", "refused", "BUSY")) is tracked
    assert talk.told(ipc.EndingEvent(1, "goto", "complete")) is None
    assert tracked.outcome is None


HELLO = ipc.Hello("0.1.0", "logs/x.mcap", ["udpin://127.0.0.1:14550"], "default", client=3)
SEEN = ipc.Snapshot(0, "GROUNDED", "NONE", "NOMINAL", [], 0.0, "logs/x.mcap", True, 1.0)
OPERATION = ipc.Operation(4, GOTO, 1, "gcs fly", 0)


@pytest.mark.parametrize(
    ("events", "kept"),
    [
        ([], {"number": 0, "hello": None, "operations": None, "ended": None}),
        ([HELLO, SEEN], {"number": 3, "hello": HELLO, "snapshot": SEEN}),
        ([OPERATION], {"operations": None}),
        ([ipc.OperationList(1, []), OPERATION], {"operations": {4: OPERATION}}),
        ([SEEN], {"position_known": False, "can_be_judged": False}),
        ([ipc.Trouble("one"), ipc.Trouble("two")], {"trouble": ipc.Trouble("two")}),
    ],
)
def test_the_latest_of_what_was_told_is_kept(
    events: list[ipc.Event], kept: dict[str, object]
) -> None:
    talk = Conversation()
    for event in events:
        assert talk.told(event) is None
    assert {name: getattr(talk, name) for name in kept} == kept


@pytest.mark.parametrize(
    ("known", "judged"),
    [
        ({"landed": "IN_AIR", "home_enu": (0.0, 0.0, 0.0)}, True),
        ({"landed": "IN_AIR"}, False),
        ({"landed": "UNDEFINED", "home_enu": (0.0, 0.0, 0.0)}, False),
        ({"landed": "IN_AIR", "home_enu": (0.0, 0.0, 0.0), "state": "STALE"}, False),
    ],
)
def test_a_vehicle_can_be_judged_with_its_home_and_whether_it_has_landed(
    known: dict[str, object], judged: bool
) -> None:
    fields: dict[str, object] = {"vehicle": "1/1 px4", "pos_enu": (0.0, 0.0, 0.0), **known}
    talk = Conversation()
    talk.told(msgspec.structs.replace(SEEN, **fields))
    assert talk.position_known
    assert talk.can_be_judged == judged


@pytest.mark.parametrize(
    ("ended", "trouble", "code", "text"),
    [
        (StationEnded(None, None, ""), None, ExitCode.NOT_COMPLETED, "connection to the station"),
        (StationEnded(None, -9, ""), None, ExitCode.BUG, "died (exit code -9)"),
        (StationEnded(ipc.Bye(0, "", "over"), 0, ""), None, ExitCode.BUG, "over"),
        (StationEnded(ipc.Bye(9, "", "over"), 9, ""), None, ExitCode.ADDRESS_IN_USE, "over"),
        (StationEnded(None, 9, ""), ipc.Trouble("in use", "", 9), ExitCode.ADDRESS_IN_USE, "in"),
    ],
)
def test_why_a_station_ended_unasked(
    ended: StationEnded, trouble: ipc.Trouble | None, code: ExitCode, text: str
) -> None:
    talk = Conversation()
    if trouble is not None:
        talk.told(trouble)
    talk.told(ended)
    error = talk.unexpected_end()
    assert error.exit_code == code
    assert text in str(error)
