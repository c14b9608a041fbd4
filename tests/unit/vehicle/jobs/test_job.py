"""What all jobs share: told once, in the client's own number, with a line in the log."""

from __future__ import annotations

import pytest

from gcs import ipc
from gcs.gate.effects import Level, OutcomeKind
from gcs.gate.refusal import Code, Refusal
from gcs.protocol.effects import Send
from gcs.session.work import GiveVerdict, Log
from gcs.vehicle.missions.jobs.download import Download
from gcs.vehicle.missions.jobs.job import Job, code_of, refused
from gcs.vehicle.missions.jobs.start import Start
from gcs.vehicle.missions.jobs.upload import Upload
from gcs.wire.ids import MissionResult
from gcs.wire.messages import MissionRequestList
from tests.unit.station import told
from tests.unit.vehicle.jobs.script import Board, JobScript, asked, brought, placed
from tests.unit.vehicle.plans import BOX

CLIENT_S_NUMBER = 70


def silent() -> Board:
    board = Board(brought(BOX, placed()))
    board.deaf_to = [MissionRequestList]
    return board


def logged(script: JobScript) -> list[tuple[Level, str]]:
    return [(line.level, line.text) for line in script.of(Log)]


def test_a_refusal_is_a_verdict_and_a_warning() -> None:
    refusal = Refusal(Code.BUSY, "another is under way", (("items", 4.0),))
    verdict, line = refused(7, "mission_clear", refusal)
    assert isinstance(verdict, GiveVerdict)
    assert verdict.refusal == refusal
    assert isinstance(line, Log)
    assert (line.level, line.text) == (
        Level.WARNING,
        "mission_clear: refused BUSY: another is under way",
    )


def test_a_good_end_is_a_line_and_a_bad_one_a_warning() -> None:
    good = JobScript(Download(asked("mission_download"), ""), Board())
    assert logged(good) == [
        (Level.INFO, "mission_download: complete: no mission, fence or rally is on board")
    ]
    bad = JobScript(Download(asked("mission_download"), ""), silent()).leave()
    ((level, text),) = logged(bad)
    assert level is Level.WARNING
    assert text.startswith("mission_download: aborted: ")


def test_progress_is_told_under_the_client_s_own_number() -> None:
    script = JobScript(Download(asked("mission_download"), ""), Board(brought(BOX, placed())))
    progress = told.events(script.work, ipc.ProgressEvent)
    assert [(p.id, p.done, p.total, p.unit) for p in progress] == [
        (CLIENT_S_NUMBER, n, 4, "items") for n in (1, 2, 3, 4)
    ]


@pytest.mark.parametrize(
    "job", [Upload(asked("mission_upload"), "a.plan"), Download(asked("mission_download"), "")]
)
def test_it_waits_for_nothing_before_its_transfer_begins(job: Job) -> None:
    assert job.deadline_ns is None


def test_its_deadline_is_the_transfer_s_and_a_wake_before_it_does_nothing() -> None:
    script = JobScript(Download(asked("mission_download"), ""), silent())
    assert script.job.deadline_ns == script.now_ns + 1_500_000_000  # the specification's
    before = len(script.of(Send))
    script.run(1.45)
    assert len(script.of(Send)) == before
    script.run(0.1)
    assert len(script.of(Send)) == before + 1


def test_what_comes_after_the_end_changes_nothing() -> None:
    board = silent()
    script = JobScript(Start(asked("mission_start"), brought(BOX, placed())), board).run(60.0)
    assert script.job.over
    before = len(script.work)
    for reply in Board(brought(BOX, placed())).hear(
        MissionRequestList(target_system=1, target_component=1)
    ):
        script.hear(reply)
    assert script.work[before:] == []


@pytest.mark.parametrize("result", list(MissionResult))
def test_silence_is_no_answer_and_every_result_is_the_vehicle_s(result: MissionResult) -> None:
    assert code_of(None) is Code.NO_ANSWER
    assert code_of(result) is Code.VEHICLE_REFUSED


def test_an_outcome_kind_is_told_in_its_own_words() -> None:
    script = JobScript(Download(asked("mission_download"), ""), silent()).run(60.0)
    assert script.outcome == (OutcomeKind.ABORTED, Code.NO_ANSWER)
    assert script.sentence == "the vehicle did not answer"
