"""Download: what is on board, counted or in a file, or the reason why not."""

from __future__ import annotations

import pytest

from gcs.gate.effects import OutcomeKind
from gcs.gate.refusal import Code
from gcs.plan.formats.reader import read
from gcs.session.effects import WriteFile
from gcs.session.inputs import FileRead
from gcs.vehicle.missions.jobs.download import Download
from gcs.wire.ids import MissionResult
from gcs.wire.messages import MissionRequestInt, MissionRequestList
from tests.unit.station import told
from tests.unit.vehicle.jobs.script import Board, JobScript, asked, brought, placed
from tests.unit.vehicle.plans import BOX

COMPLETE = (OutcomeKind.COMPLETE, None)
ABORTED = OutcomeKind.ABORTED


def download(board: Board, path: str = "") -> JobScript:
    return JobScript(Download(asked("mission_download"), path), board)


def board() -> Board:
    return Board(brought(BOX, placed()))


def test_without_a_file_the_items_are_counted() -> None:
    script = download(board())
    assert script.outcome == COMPLETE
    assert script.sentence == "4 items are on board"
    assert script.of(WriteFile) == []


def test_a_vehicle_without_a_mission_has_none() -> None:
    script = download(Board())
    assert script.outcome == COMPLETE
    assert script.sentence == "0 items are on board"


def test_a_vehicle_without_a_mission_gives_no_file_and_that_is_said() -> None:
    script = download(Board(), "out.plan")
    assert script.outcome == (ABORTED, Code.NO_MISSION)
    assert script.sentence == "no mission is on board: out.plan was not written"
    assert script.of(WriteFile) == []


@pytest.mark.parametrize("path", ["out.plan", "out.waypoints"])
def test_the_file_is_the_mission_that_is_on_board(path: str) -> None:
    script = download(board(), path)
    (write,) = script.of(WriteFile)
    assert (write.token, write.path) == (7, path)
    read_again = read(path, write.data, "px4")
    here = [tuple(round(x, 6) for x in item.place) for item in read_again.items]
    there = [tuple(round(x, 6) for x in item.place) for item in read("a.plan", BOX, "px4").items]
    assert here == there
    assert not script.job.over
    assert script.written().outcome == COMPLETE
    assert script.sentence == f"written to {path}"


def test_while_the_file_is_written_no_time_runs_out() -> None:
    script = download(board(), "out.plan")
    assert script.job.deadline_ns is None
    assert not script.run(300.0).job.over


def test_a_file_that_cannot_be_written_is_told_with_its_reason() -> None:
    script = download(board(), "/out.plan").written("Permission denied")
    assert script.outcome == (ABORTED, Code.BAD_MISSION)
    assert script.sentence == "/out.plan: Permission denied"
    (trouble,) = told.troubles(script.work)
    assert trouble.exit_code == 4


def test_a_kind_of_file_that_holds_no_mission_is_told_before_anything_is_written() -> None:
    script = download(board(), "out.jpeg")
    assert script.outcome == (ABORTED, Code.BAD_MISSION)
    assert script.of(WriteFile) == []


def test_only_the_answer_to_its_own_writing_ends_it() -> None:
    script = download(board(), "out.plan")
    assert script.job.file(FileRead(7, "out.plan", b""), script.view, script.now_ns) == []
    assert not script.job.over


@pytest.mark.parametrize("deaf_to", [MissionRequestList, MissionRequestInt])
def test_a_vehicle_that_falls_silent_is_no_answer(
    deaf_to: type[MissionRequestList | MissionRequestInt],
) -> None:
    silent = board()
    silent.deaf_to = [deaf_to]
    script = download(silent, "out.plan").run(60.0)
    assert script.outcome == (ABORTED, Code.NO_ANSWER)
    assert script.of(WriteFile) == []


def test_what_the_vehicle_refuses_ends_as_refused() -> None:
    refusing = board()
    refusing.refuses = MissionResult.DENIED
    assert download(refusing).outcome == (ABORTED, Code.VEHICLE_REFUSED)


def test_a_station_that_leaves_while_the_file_is_written_has_not_finished() -> None:
    assert download(board(), "out.plan").leave().outcome == (ABORTED, Code.OPERATOR_LOST)


def test_what_is_on_board_stays_as_it_is_known() -> None:
    script = download(board())
    assert script.loaded == []
    assert script.kept == []
