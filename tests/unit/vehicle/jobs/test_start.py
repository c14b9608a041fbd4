"""Start: what is on board is read back and verified anew, and only then the gate is asked."""

from __future__ import annotations

import msgspec
import pytest

from gcs import ipc
from gcs.gate.refusal import Code
from gcs.gate.requests import StartMission
from gcs.gate.states import State
from gcs.session.inputs import FileRead
from gcs.session.work import AskGate, GiveVerdict
from gcs.vehicle.missions.jobs.start import Start
from gcs.vehicle.talk.telemetry import Telemetry
from gcs.wire.ids import MissionResult
from gcs.wire.messages import MissionRequestInt, MissionRequestList
from tests.unit.plan import samples
from tests.unit.station import told
from tests.unit.station.vehicles import SECOND_NS
from tests.unit.vehicle.jobs.script import Board, JobScript, asked, brought, placed
from tests.unit.vehicle.plans import BOX, LAT, LON, plan

OTHER = plan(samples.waypoint(1, LAT, LON, 10, command=22), samples.waypoint(2, LAT, LON, 12))


def board() -> Board:
    return Board(brought(BOX, placed()))


def start(board: Board, telemetry: Telemetry | None = None) -> JobScript:
    job = Start(asked("mission_start"), brought(BOX, placed()))
    return JobScript(job, board, telemetry, State.HOVERING)


def test_the_mission_that_was_verified_and_still_clears_is_the_gate_s_to_start() -> None:
    script = start(board())
    assert script.of(AskGate) == [AskGate(7, StartMission())]
    assert script.job.over
    assert script.of(GiveVerdict) == []  # the verdict is the gate's
    assert script.loaded == []


def test_how_the_vehicle_flies_its_legs_is_asked_for_and_nonsense_is_not_believed() -> None:
    quick = board()
    quick.parameters |= {"MPC_XY_CRUISE": 8.0, "MPC_ACC_HOR": -1.0}
    job = start(quick).job
    assert isinstance(job, Start)
    assert job.facts is not None
    settings = job.facts.settings
    assert (settings.speed_m_s, settings.accel_m_s2) == (8.0, 3.0)


@pytest.mark.parametrize("change", [{"z": 40.0}, {"y": 85465940}, {"command": 17}])
def test_a_mission_that_another_station_put_in_its_place_is_not_flown(
    change: dict[str, int],
) -> None:
    changed = board()
    changed.items[2] = msgspec.structs.replace(changed.items[2], **change)
    script = start(changed)
    assert script.refused is Code.BAD_MISSION
    assert "another mission is on board than was verified" in script.sentence
    assert script.loaded == [("", 0)]
    assert script.kept == [None]


@pytest.mark.parametrize("other", [Board(), Board(brought(OTHER, placed()))])
def test_a_mission_of_another_length_is_not_flown(other: Board) -> None:
    script = start(other)
    assert script.refused is Code.BAD_MISSION
    assert script.kept == [None]


def test_what_is_on_board_and_cannot_be_read_is_not_flown() -> None:
    silent = board()
    silent.deaf_to = [MissionRequestList]
    script = start(silent).run(60.0)
    assert script.refused is Code.NO_ANSWER
    assert "could not be read" in script.sentence


def test_a_read_back_that_stops_half_way_is_not_flown() -> None:
    silent = board()
    silent.deaf_to = [MissionRequestInt]
    assert start(silent).run(60.0).refused is Code.NO_ANSWER


def test_a_vehicle_that_will_not_say_what_is_on_board_is_not_started() -> None:
    refusing = board()
    refusing.refuses = MissionResult.DENIED
    assert start(refusing).refused is Code.VEHICLE_REFUSED


def test_the_path_begins_where_the_vehicle_is_now() -> None:
    """Carried 400 m away since the upload, the first leg is another one."""
    telemetry = placed()
    telemetry.pos_ned = (400.0, 0.0, -5.0)
    script = start(board(), telemetry)
    assert script.refused is not Code.BAD_MISSION
    assert script.sentence.startswith("item 1: ")
    assert script.loaded == []  # it is still the mission that is on board


def test_from_a_position_that_is_too_old_nothing_is_started() -> None:
    telemetry = placed()
    telemetry.position_ns -= 2 * SECOND_NS
    assert start(board(), telemetry).refused is Code.STALE


def test_a_station_that_leaves_meanwhile_starts_nothing() -> None:
    silent = board()
    silent.deaf_to = [MissionRequestInt]
    assert start(silent).leave().refused is Code.OPERATOR_LOST


def test_a_file_is_none_of_its_business() -> None:
    silent = board()
    silent.deaf_to = [MissionRequestInt]
    script = start(silent)
    before = len(script.work)
    assert script.job.file(FileRead(7, "a.plan", BOX), script.view, script.now_ns) == []
    assert len(script.work) == before
    assert not script.job.over


def test_it_is_shown_as_reading_back() -> None:
    progress = told.events(start(board()).work, ipc.ProgressEvent)
    assert [(step.what, step.done) for step in progress] == [
        ("reading back", n) for n in (1, 2, 3, 4)
    ]
