"""Clear: nothing is on board once the vehicle says so, and not before."""

from __future__ import annotations

import pytest

from gcs.gate.effects import OutcomeKind
from gcs.gate.refusal import Code
from gcs.gate.states import State
from gcs.session.inputs import FileWritten
from gcs.vehicle.missions.jobs.clear import Clear
from gcs.vehicle.missions.jobs.upload import Upload
from gcs.wire.ids import MissionResult, MissionType
from gcs.wire.messages import MissionClearAll
from tests.unit.vehicle.jobs.script import Board, JobScript, asked, brought, placed
from tests.unit.vehicle.plans import BOX, GUARDED

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


def test_what_stays_is_named_with_the_command_that_clears_it() -> None:
    script = JobScript(Upload(asked("mission_upload"), "a.plan"), board()).read(GUARDED)
    cleared = clear(script.board)
    assert cleared.sentence == (
        "no mission is on board; its fence stays (`gcs fence clear`); "
        "its rally points stay (`gcs rally clear`)"
    )
    assert [len(items) for items in script.board.lists.values()] == [5, 2]


def test_what_was_not_read_may_stay() -> None:
    job = Clear(asked("mission_clear"), (MissionType.MISSION,))
    silent = board()
    silent.deaf_to = [MissionClearAll]
    script = JobScript(job, silent)
    script.on_board = (None, ())
    silent.deaf_to = []
    script.run(2.0)
    told = "no mission is on board; its fence stays, if there is any (`gcs fence clear`)"
    assert script.sentence == told


@pytest.mark.parametrize(
    ("word", "kind", "left"),
    [("fence_clear", MissionType.FENCE, [0, 2]), ("rally_clear", MissionType.RALLY, [5, 0])],
)
def test_one_kind_alone(word: str, kind: MissionType, left: list[int]) -> None:
    script = JobScript(Upload(asked("mission_upload"), "a.plan"), Board()).read(GUARDED)
    there = script.board
    cleared = JobScript(Clear(asked(word), (kind,)), there)
    assert cleared.outcome == (OutcomeKind.COMPLETE, None)
    assert [len(items) for items in there.lists.values()] == left
    assert (cleared.kept, len(there.items)) == ([], 4)
    limits = "`gcs param set GF_MAX_HOR_DIST 0`, `gcs param set GF_MAX_VER_DIST 0`"
    assert (limits in cleared.sentence) is (word == "fence_clear")


def test_in_the_air_the_fence_stays_and_rally_points_may_go() -> None:
    there = JobScript(Upload(asked("mission_upload"), "a.plan"), Board()).read(GUARDED).board
    telemetry = placed()
    telemetry.armed = True

    def asked_for(word: str, kind: MissionType) -> JobScript:
        return JobScript(Clear(asked(word), (kind,)), there, telemetry, State.HOVERING)

    refused = asked_for("fence_clear", MissionType.FENCE)
    assert refused.refused is Code.IN_AIR
    assert refused.sent(MissionClearAll) == []
    assert asked_for("rally_clear", MissionType.RALLY).outcome == (OutcomeKind.COMPLETE, None)


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
