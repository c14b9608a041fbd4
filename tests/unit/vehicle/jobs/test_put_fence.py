"""PutFence: the policy's zones and parameters are on board, read back, or it says what is not."""

from __future__ import annotations

import pytest

from gcs.gate.effects import OutcomeKind
from gcs.gate.policy.parse import DEFAULT
from gcs.gate.policy.policy import Policy
from gcs.gate.refusal import Code
from gcs.gate.states import State
from gcs.protocol.autopilot import ARDUPILOT, PX4, Autopilot
from gcs.vehicle.missions.jobs.put_fence import PutFence
from gcs.vehicle.missions.jobs.upload import Upload
from gcs.wire.messages import MissionClearAll, MissionCount, ParamSet
from tests.unit.vehicle.jobs.script import Board, JobScript, asked, placed
from tests.unit.vehicle.plans import GUARDED
from tests.unit.vehicle.test_policy_fence import CIRCLE, MAST, policy

COMPLETE = (OutcomeKind.COMPLETE, None)
PX4_DELIVERED = {
    "GF_MAX_HOR_DIST": 0.0,
    "GF_MAX_VER_DIST": 0.0,
    "COM_OF_LOSS_T": 1.0,
    "COM_OBL_RC_ACT": 0.0,
    "GF_ACTION": 2.0,
}
COPTER_DELIVERED = {
    "FENCE_RADIUS": 300.0,
    "FENCE_ALT_MAX": 100.0,
    "FENCE_TYPE": 3.0,
    "FENCE_OPTIONS": 0.0,
    "GUID_TIMEOUT": 3.0,
    "FENCE_ACTION": 1.0,
    "FENCE_ENABLE": 0.0,
}
"""As recorded of the autopilots, but for FENCE_TYPE, which lacks its bit for zones here."""


def board(autopilot: Autopilot) -> Board:
    there = Board()
    there.parameters |= PX4_DELIVERED if autopilot is PX4 else COPTER_DELIVERED
    return there


def put(
    there: Board, autopilot: Autopilot = PX4, rules: Policy = DEFAULT, state: State = State.GROUNDED
) -> JobScript:
    telemetry = placed(autopilot)
    telemetry.armed = state is not State.GROUNDED
    return JobScript(PutFence(asked("fence_put")), there, telemetry, state, rules)


def test_px4_holds_at_the_policy_s_circle_and_ceiling() -> None:
    script = put(board(PX4))
    assert script.outcome == COMPLETE
    held = {name: script.board.parameters[name] for name in PX4_DELIVERED}
    assert held == {
        "GF_MAX_HOR_DIST": 150.0,
        "GF_MAX_VER_DIST": 50.0,
        "COM_OF_LOSS_T": 0.5,
        "COM_OBL_RC_ACT": 5.0,  # hold: position mode holds no place without sticks
        "GF_ACTION": 2.0,
    }
    assert "150 m from home, 50 m above it; a breach leads to hold" in script.sentence


def test_arducopter_brakes_and_its_switch_is_the_last() -> None:
    script = put(board(ARDUPILOT), ARDUPILOT, policy(CIRCLE, MAST))
    assert script.outcome == COMPLETE
    held = {name: script.board.parameters[name] for name in COPTER_DELIVERED}
    assert held == {
        "FENCE_RADIUS": 80.0,
        "FENCE_ALT_MAX": 40.0,
        "FENCE_TYPE": 7.0,
        "FENCE_OPTIONS": 0.0,
        "GUID_TIMEOUT": 0.5,
        "FENCE_ACTION": 4.0,
        "FENCE_ENABLE": 1.0,
    }
    assert script.sent(ParamSet)[-1].param_id == "FENCE_ENABLE"
    assert [item.command for item in script.board.lists[1]] == [5004]
    assert "a fence of 1 zone" in script.sentence


def test_what_is_stricter_already_stays() -> None:
    there = board(PX4)
    there.parameters |= {"COM_OF_LOSS_T": 0.3, "COM_OBL_RC_ACT": 4.0}
    script = put(there)
    assert script.outcome == COMPLETE
    assert there.parameters["COM_OF_LOSS_T"] == 0.3
    assert there.parameters["COM_OBL_RC_ACT"] == 4.0
    assert {each.param_id for each in script.sent(ParamSet)} == {
        "GF_MAX_HOR_DIST",
        "GF_MAX_VER_DIST",
    }


def test_a_policy_without_zones_takes_off_those_of_another_plan() -> None:
    there = board(PX4)
    JobScript(Upload(asked("mission_upload"), "a.plan"), there).read(GUARDED)
    script = put(there)
    assert [each.mission_type for each in script.sent(MissionClearAll)] == [1]
    assert script.outcome == COMPLETE
    assert there.lists[1] == []
    assert "; the fence that was on board, " in script.sentence


def test_zones_come_before_what_they_are_switched_on_by() -> None:
    script = put(board(PX4), rules=policy(CIRCLE, MAST))
    sent = [type(each) for each in script.sent(object)]
    assert sent.index(MissionCount) < sent.index(ParamSet)


@pytest.mark.parametrize("state", [State.HOVERING, State.FLYING_MISSION, State.EXTERNAL])
def test_in_the_air_it_is_refused_and_nothing_is_sent(state: State) -> None:
    script = put(board(PX4), state=state)
    assert script.refused is Code.IN_AIR
    assert script.board.heard == []


def test_armed_on_the_ground_it_is_refused_as_every_guarded_parameter_is() -> None:
    telemetry = placed(PX4)
    telemetry.armed = True
    script = JobScript(PutFence(asked("fence_put")), board(PX4), telemetry, State.GROUNDED)
    assert script.refused is Code.IN_AIR
    assert script.board.heard == []


def test_a_parameter_that_stays_as_it_is_is_told_by_name() -> None:
    there = board(PX4)
    there.stubborn = {"GF_MAX_VER_DIST"}
    script = put(there).run(20.0)
    assert script.outcome == (OutcomeKind.ABORTED, Code.VEHICLE_REFUSED)
    assert script.sentence == "not all is set: GF_MAX_VER_DIST: stays 0"


def test_a_vehicle_without_such_a_parameter_is_told_of() -> None:
    there = board(PX4)
    del there.parameters["GF_ACTION"]
    script = put(there)
    assert script.outcome == (OutcomeKind.ABORTED, Code.VEHICLE_REFUSED)
    assert "GF_ACTION: the vehicle has no such parameter" in script.sentence


def test_home_is_waited_for() -> None:
    telemetry = placed()
    home, telemetry.home_ned = telemetry.home_ned, None
    script = JobScript(PutFence(asked("fence_put")), board(PX4), telemetry)
    assert not script.job.over
    telemetry.home_ned = home
    assert script.run(1.0).outcome == COMPLETE


@pytest.mark.parametrize("ends", ["stop", "leave"])
def test_it_can_be_stopped_before_its_verdict_and_after_it(ends: str) -> None:
    telemetry = placed()
    telemetry.home_ned = None
    early = JobScript(PutFence(asked("fence_put")), board(PX4), telemetry)
    getattr(early, ends)()
    assert early.refused in (Code.OPERATOR, Code.OPERATOR_LOST)
    there = board(PX4)
    there.stubborn = {"GF_MAX_VER_DIST"}
    late = put(there).run(1.0)
    getattr(late, ends)()
    assert late.outcome[0] is OutcomeKind.ABORTED
