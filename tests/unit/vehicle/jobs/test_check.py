"""Check: the mission on board is verified as its start verifies it, and nothing is asked for."""

from __future__ import annotations

import pytest

from gcs import ipc
from gcs.gate.effects import OutcomeKind
from gcs.gate.policy.parse import DEFAULT
from gcs.gate.refusal import Code
from gcs.gate.states import State
from gcs.protocol.effects import Address
from gcs.session.speedup_waits import Times
from gcs.session.work import AskGate, GiveVerdict
from gcs.vehicle.missions.jobs.check import Check, CheckUnknown
from gcs.vehicle.missions.jobs.job import VehicleView
from gcs.vehicle.missions.missions import Missions
from gcs.wire.messages import MissionSetCurrent
from tests.unit.plan import samples
from tests.unit.vehicle.jobs.script import START_NS, Board, JobScript, asked, brought, placed
from tests.unit.vehicle.plans import BOX, LAT, LON, plan

OTHER = plan(samples.waypoint(1, LAT, LON, 10, command=22), samples.waypoint(2, LAT, LON, 12))
MODE = "AUTO.MISSION"


def check(board: Board, mode_name: str = "") -> JobScript:
    return JobScript(Check(asked("mission_check"), brought(BOX, placed()), mode_name), board)


def test_the_mission_that_was_verified_and_still_clears_is_all_that_is_told() -> None:
    script = check(Board(brought(BOX, placed())))
    assert script.outcome == (OutcomeKind.COMPLETE, None)
    assert script.of(AskGate) == []
    assert script.sent(MissionSetCurrent) == []


def test_another_mission_is_found() -> None:
    script = check(Board(brought(OTHER, placed())))
    assert script.refused is Code.BAD_MISSION
    assert script.kept == [None]


def test_one_that_is_not_known_is_read_and_kept() -> None:
    job = CheckUnknown(asked("mission_check"))
    script = JobScript(job, Board(brought(BOX, placed()))).run(2.0)
    assert script.outcome == (OutcomeKind.COMPLETE, None)
    assert [kept is not None for kept in script.kept] == [True]
    assert script.of(AskGate) == []


def test_no_mission_at_all_is_refused() -> None:
    script = JobScript(CheckUnknown(asked("mission_check")), Board()).run(2.0)
    assert script.refused is Code.NO_MISSION


def test_it_waits_until_the_mode_is_shown() -> None:
    script = check(Board(brought(BOX, placed())), MODE).run(1.0)
    assert not script.job.over
    script.telemetry.mode_name = MODE
    assert script.run(0.1).outcome == (OutcomeKind.COMPLETE, None)


def test_and_no_longer_than_three_heartbeats() -> None:
    script = check(Board(brought(BOX, placed())), MODE).run(2.9)
    assert not script.job.over
    assert script.run(0.2).refused is Code.NO_ANSWER
    assert "does not show AUTO.MISSION" in script.sentence


def test_a_stop_ends_it() -> None:
    script = check(Board(brought(BOX, placed())), MODE).stop()
    assert script.refused is Code.OPERATOR


@pytest.mark.parametrize(
    ("state", "code"),
    [
        (State.STALE, Code.STALE),
        (State.HOVERING, Code.ALREADY_FLYING),
        (State.FLYING_MISSION, Code.ALREADY_FLYING),
    ],
)
def test_it_is_for_the_ground(state: State, code: Code) -> None:
    missions = Missions(Address(255, 190), Times())
    ask = ipc.Ask(70, "mission_check")
    work = missions.ask(7, ask, VehicleView(placed(), state, DEFAULT), START_NS)
    (refusal,) = [item.refusal for item in work if isinstance(item, GiveVerdict)]
    assert refusal is not None
    assert refusal.code is code
    assert missions.job is None
