"""Download: what is on board, counted or in a file, or the reason why not."""

from __future__ import annotations

import pytest

from gcs.gate.effects import OutcomeKind
from gcs.gate.refusal import Code
from gcs.plan.formats.reader import read
from gcs.plan.model import Geodetic
from gcs.protocol.autopilot import ARDUPILOT, PX4, Autopilot
from gcs.session.effects import WriteFile
from gcs.session.inputs import FileRead
from gcs.vehicle.missions.jobs.download import Download
from gcs.vehicle.missions.jobs.upload import Upload
from gcs.wire.ids import MissionResult, MissionType
from gcs.wire.messages import MissionRequestInt, MissionRequestList
from tests.unit.station import told
from tests.unit.station.vehicles import HOME
from tests.unit.vehicle.jobs.script import Board, JobScript, asked, brought, placed
from tests.unit.vehicle.plans import BOX, GUARDED

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
    assert script.sentence == "no mission, fence or rally is on board"


def test_a_vehicle_without_a_mission_gives_no_file_and_that_is_said() -> None:
    script = download(Board(), "out.plan")
    assert script.outcome == (ABORTED, Code.NO_MISSION)
    assert script.sentence == "no mission, fence or rally is on board: out.plan was not written"
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
    assert script.sentence.startswith(f"written to {path}: 4 items")


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


def fenced(board: Board) -> Board:
    """With the fence and the rally points of `GUARDED`."""
    assert JobScript(Upload(asked("mission_upload"), "a.plan"), board).read(GUARDED).outcome
    return board


@pytest.mark.parametrize(("autopilot", "path"), [(PX4, "o.plan"), (ARDUPILOT, "o.waypoints")])
def test_fence_rally_points_and_home_come_with_it(autopilot: Autopilot, path: str) -> None:
    telemetry = placed(autopilot)
    there = JobScript(Upload(asked("mission_upload"), "a.plan"), Board(), telemetry).read(GUARDED)
    assert there.outcome == COMPLETE
    script = JobScript(Download(asked("mission_download"), path), there.board, telemetry)
    (write,) = script.of(WriteFile)
    back, sent = read(path, write.data, "ardupilot"), read("a.plan", GUARDED)
    assert [zone.shape for zone in back.fence.zones] == [zone.shape for zone in sent.fence.zones]
    assert [zone.inclusion for zone in back.fence.zones] == [True, False]
    there_and_here = [
        [(round(p.lat_deg, 7), round(p.lon_deg, 7), p.alt_above_home_m) for p in plan.rally]
        for plan in (sent, back)
    ]
    assert there_and_here[0] == there_and_here[1]
    assert back.home == Geodetic(HOME.lat_deg, HOME.lon_deg, HOME.alt_amsl_m)
    kept = script.written().sentence
    assert kept == f"written to {path}: 4 items, a fence of 2 zones, 2 rally points"


def test_what_the_format_cannot_keep_is_named() -> None:
    script = JobScript(Download(asked("mission_download"), "o.waypoints"), board()).written()
    assert "4 items; home is not kept by this format" in script.sentence


@pytest.mark.parametrize(
    ("word", "kind", "told"),
    [
        ("fence_download", MissionType.FENCE, "a fence of 2 zones"),
        ("rally_download", MissionType.RALLY, "2 rally points"),
    ],
)
def test_one_kind_alone(word: str, kind: MissionType, told: str) -> None:
    board_ = fenced(Board())
    script = JobScript(Download(asked(word), "o.plan", (kind,)), board_)
    assert {each.mission_type for each in script.sent(MissionRequestList)} == {kind}
    assert script.written().sentence == f"written to o.plan: {told}"
    (write,) = script.of(WriteFile)
    assert read("o.plan", write.data).items == ()


def test_a_fence_that_cannot_be_read_is_not_taken_for_none() -> None:
    silent = Board(brought(BOX, placed()))
    silent.silent_lists = {MissionType.FENCE}
    script = download(silent, "out.plan").run(60.0)
    assert script.outcome == (ABORTED, Code.NO_ANSWER)
    assert "its fence could not be read" in script.sentence
    assert script.of(WriteFile) == []


def test_what_is_on_board_stays_as_it_is_known() -> None:
    script = download(board())
    assert script.loaded == []
    assert script.kept == []
