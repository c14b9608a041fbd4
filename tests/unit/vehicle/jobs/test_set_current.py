"""Set current: the vehicle is told where its mission is to begin, while it flies none."""

from __future__ import annotations

import pytest

from gcs.gate.effects import OutcomeKind
from gcs.gate.refusal import Code
from gcs.gate.states import State
from gcs.protocol.autopilot import ARDUPILOT
from gcs.vehicle.missions.jobs.job import BeginsAt
from gcs.vehicle.missions.jobs.set_current import SetCurrent
from gcs.wire.messages import Message, MissionCurrent, MissionSetCurrent
from tests.unit.vehicle.jobs.script import Board, JobScript, asked, brought, placed
from tests.unit.vehicle.plans import BOX

MISSION = brought(BOX, placed())


def set_current(
    seq: int, state: State = State.HOVERING, *, known: bool = True, mode: str = "OFFBOARD"
) -> JobScript:
    telemetry = placed()
    telemetry.mode_name, telemetry.armed = mode, state is not State.GROUNDED
    job = SetCurrent(asked("mission_set_current"), seq, MISSION if known else None)
    return JobScript(job, Board(MISSION), telemetry, state)


@pytest.mark.parametrize("state", [State.HOVERING, State.HOLDING, State.EXTERNAL])
def test_in_the_air_the_vehicle_is_told_and_the_next_start_begins_there(state: State) -> None:
    script = set_current(2, state)
    assert [message.seq for message in script.sent(MissionSetCurrent)] == [2]
    assert script.outcome == (OutcomeKind.COMPLETE, None)
    assert BeginsAt(2) in script.work


@pytest.mark.parametrize("state", [State.HOVERING, State.GROUNDED])
@pytest.mark.parametrize("known", [True, False])
def test_the_first_item_is_where_a_mission_begins_anyway(known: bool, state: State) -> None:
    script = set_current(0, state, known=known)
    assert script.outcome == (OutcomeKind.COMPLETE, None)
    assert BeginsAt(None) in script.work


@pytest.mark.parametrize(
    ("seq", "state", "known", "code"),
    [
        (len(MISSION.sent), State.HOVERING, True, Code.BAD_MISSION),
        (-1, State.HOVERING, True, Code.BAD_MISSION),
        (1, State.HOVERING, False, Code.NO_MISSION),
        (1, State.GROUNDED, True, Code.NOT_FLYING),
        (1, State.FLYING_MISSION, True, Code.BUSY),
    ],
)
def test_what_cannot_be_begun_at_is_refused(
    seq: int, state: State, known: bool, code: Code
) -> None:
    script = set_current(seq, state, known=known)
    assert script.refused is code
    assert script.sent(MissionSetCurrent) == []


def test_somebody_else_s_mission_is_not_made_to_jump() -> None:
    script = set_current(1, State.EXTERNAL, mode="AUTO.MISSION")
    assert script.refused is Code.BUSY
    assert script.sent(MissionSetCurrent) == []


class SkipsHome(Board):
    """An ArduCopter in the air goes on to its first item where it is sent to home (from memory of
    AP_Mission::set_current_cmd; vehicle-sim does so)."""

    def hear(self, message: Message) -> list[Message]:
        if isinstance(message, MissionSetCurrent):
            return [MissionCurrent(max(message.seq, 1), 0, 0, 0, 0, 0, 0)]
        return super().hear(message)


@pytest.mark.parametrize("seq", [0, 1])
@pytest.mark.parametrize("known", [True, False])
def test_home_is_no_item_that_an_arducopter_begins_at(seq: int, known: bool) -> None:
    telemetry = placed(ARDUPILOT)
    telemetry.mode_name, telemetry.armed = "GUIDED", True
    mission = brought(BOX, telemetry)
    job = SetCurrent(asked("mission_set_current"), seq, mission if known else None)
    script = JobScript(job, SkipsHome(mission), telemetry, State.HOVERING)
    assert BeginsAt(None) in script.work
    assert script.outcome == (OutcomeKind.COMPLETE, None)
