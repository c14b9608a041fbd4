"""What is on board and was not brought by us: read and verified before it may start."""

from __future__ import annotations

import pytest

from gcs.gate.refusal import Code
from gcs.gate.requests import StartMission
from gcs.protocol.autopilot import ARDUPILOT, PX4, Autopilot
from gcs.session.work import AskGate, GiveVerdict
from gcs.vehicle.missions.jobs.job import OnBoardRefused
from gcs.vehicle.missions.jobs.verify_on_board import Adopt
from gcs.vehicle.talk.telemetry import Telemetry
from gcs.wire.messages import MissionRequestList
from tests.unit.vehicle.jobs.script import Board, JobScript, asked, brought, placed
from tests.unit.vehicle.plans import BOX, FAR


def adopt(board: Board, telemetry: Telemetry | None = None) -> JobScript:
    return JobScript(Adopt(asked("mission_start")), board, telemetry)


@pytest.mark.parametrize("autopilot", [PX4, ARDUPILOT])
def test_a_mission_that_clears_is_known_as_ours_and_the_gate_decides(autopilot: Autopilot) -> None:
    telemetry = placed(autopilot)
    script = adopt(Board(brought(BOX, telemetry)), telemetry)
    assert script.loaded == [("the mission on board", 4)]
    (kept,) = script.kept
    assert kept is not None
    assert len(kept.sent) == len(script.board.items)
    assert script.of(AskGate) == [AskGate(7, StartMission())]
    assert script.of(GiveVerdict) == []
    assert script.job.over


@pytest.mark.parametrize("autopilot", [PX4, ARDUPILOT])
def test_a_mission_that_leaves_the_fence_never_starts(autopilot: Autopilot) -> None:
    telemetry = placed(autopilot)
    script = adopt(Board(brought(FAR, telemetry)), telemetry)
    assert script.refused in (Code.LEG_LEAVES_FENCE, Code.OUTSIDE_FENCE, Code.TOO_FAR)
    assert "item 2" in script.sentence
    assert script.loaded == []
    assert script.kept == []
    home_items = autopilot is ARDUPILOT
    counted = len(script.board.items) - home_items
    assert script.of(OnBoardRefused) == [OnBoardRefused(counted, script.sentence)]


def test_where_none_is_on_board_the_gate_says_so() -> None:
    script = adopt(Board())
    assert script.work[-1] == AskGate(7, StartMission())
    assert script.loaded == []


def test_a_mission_that_cannot_be_read_never_starts() -> None:
    board = Board(brought(BOX, placed()))
    board.deaf_to = [MissionRequestList]
    script = adopt(board).run(30.0)
    assert script.refused is Code.NO_ANSWER
    assert "could not be read" in script.sentence


def test_a_stop_before_the_start_refuses_it() -> None:
    board = Board(brought(BOX, placed()))
    board.deaf_to = [MissionRequestList]
    assert adopt(board).stop().refused is Code.OPERATOR


def test_a_station_that_leaves_refuses_it() -> None:
    board = Board(brought(BOX, placed()))
    board.deaf_to = [MissionRequestList]
    assert adopt(board).leave().refused is Code.OPERATOR_LOST
