"""Clear: nothing is on board once the vehicle says so, and not before."""

from __future__ import annotations

from gcs.gate.effects import OutcomeKind
from gcs.gate.refusal import Code
from gcs.session.inputs import FileWritten
from gcs.vehicle.missions.jobs.clear import Clear
from gcs.wire.ids import MissionResult, MissionType
from gcs.wire.messages import MissionClearAll
from tests.unit.vehicle.jobs.script import Board, JobScript, asked, brought, placed
from tests.unit.vehicle.plans import BOX

MISSION = 0
"""MAV_MISSION_TYPE_MISSION: fence and rally points stay."""


def clear(board: Board) -> JobScript:
    return JobScript(Clear(asked("mission_clear"), (MissionType.MISSION,)), board)


def board() -> Board:
    return Board(brought(BOX, placed()))


def test_the_mission_is_taken_off_and_nothing_else() -> None:
    script = clear(board())
    assert script.outcome == (OutcomeKind.COMPLETE, None)
    assert script.board.items == []
    assert [message.mission_type for message in script.sent(MissionClearAll)] == [MISSION]
    assert script.loaded == [("", 0)]
    assert script.kept == [None]


def test_a_vehicle_that_never_answers_may_have_it_still() -> None:
    silent = board()
    silent.deaf_to = [MissionClearAll]
    script = clear(silent).run(60.0)
    assert script.outcome == (OutcomeKind.ABORTED, Code.NO_ANSWER)
    assert len(script.sent(MissionClearAll)) == 20  # every 1.5 s, for 30 s
    assert script.kept == []


def test_a_vehicle_that_refuses_has_it_still() -> None:
    refusing = board()
    refusing.refuses = MissionResult.DENIED
    script = clear(refusing)
    assert script.outcome == (OutcomeKind.ABORTED, Code.VEHICLE_REFUSED)
    assert script.kept == []


def test_a_station_that_leaves_meanwhile_does_not_know() -> None:
    silent = board()
    silent.deaf_to = [MissionClearAll]
    script = clear(silent).leave()
    assert script.outcome == (OutcomeKind.ABORTED, Code.OPERATOR_LOST)
    assert script.kept == []


def test_a_file_is_none_of_its_business() -> None:
    silent = board()
    silent.deaf_to = [MissionClearAll]
    script = clear(silent)
    assert script.job.file(FileWritten(7, "x"), script.view, script.now_ns) == []
    assert not script.job.over
