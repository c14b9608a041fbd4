"""A mission carries no command that its client could not send by itself."""

from __future__ import annotations

import math

import pytest

from gcs import ipc
from gcs.bridge.catalog import Kind, command_row
from gcs.bridge.catalog.tables import command_rows
from gcs.bridge.client_plan import ClientPlan
from gcs.gate.effects import OutcomeKind
from gcs.gate.policy.parse import parse_policy
from gcs.gate.policy.policy import Policy
from gcs.gate.refusal import Code
from gcs.plan.commands import KINDS
from gcs.plan.commands import Kind as ItemKind
from gcs.plan.item_messages import message_of
from gcs.plan.wire import WireItem
from gcs.protocol.autopilot import ARDUPILOT, PX4, Autopilot
from gcs.session.work import GiveVerdict
from gcs.vehicle.missions.jobs.check import CheckUnknown
from gcs.vehicle.missions.jobs.upload import ClientUpload
from gcs.vehicle.missions.jobs.verify_on_board import Adopt
from gcs.wire.ids import Cmd, MavFrame, MissionType
from gcs.wire.messages import MissionCount
from tests.unit.station import told
from tests.unit.vehicle.jobs.script import Board, JobScript, asked, placed
from tests.unit.vehicle.plans import LAT, LON

COMPLETE = (OutcomeKind.COMPLETE, None)
SOURCE = "the mission of 245/190"
NORTH_DEG_E7 = 1e7 / 111_000.0
BOTH = pytest.mark.parametrize("autopilot", [PX4, ARDUPILOT], ids=["px4", "ardupilot"])


def place(command: int, north_m: float, p1: float = 0.0) -> WireItem:
    x, y = round(LAT * 1e7 + north_m * NORTH_DEG_E7), round(LON * 1e7)
    frame = MavFrame.GLOBAL_RELATIVE_ALT_INT
    return WireItem(0, frame, command, 0, 1, p1, 0.0, 0.0, 0.0, x, y, 10.0)


def does(command: int, p1: float = 0.0) -> WireItem:
    """A command without a place."""
    return WireItem(0, MavFrame.MISSION, command, 0, 1, p1, 0.0, 0.0, 0.0, 0, 0, 0.0)


def mission(*carried: WireItem, autopilot: Autopilot) -> tuple[WireItem, ...]:
    """Take off, fly 20 m north, do what is carried as item 3 and on, and come half back."""
    home = (place(Cmd.NAV_WAYPOINT, 0.0),) if autopilot is ARDUPILOT else ()
    takes_off, there = place(Cmd.NAV_TAKEOFF, 0.0), place(Cmd.NAV_WAYPOINT, 20.0)
    items = (*home, takes_off, there, *carried, place(Cmd.NAV_WAYPOINT, 10.0))
    return tuple(item._replace(seq=seq) for seq, item in enumerate(items))


def upload(*carried: WireItem, autopilot: Autopilot, bridge: str = "") -> JobScript:
    plan = ClientPlan(MissionType.MISSION, mission(*carried, autopilot=autopilot), SOURCE)
    job = ClientUpload(asked("mission_upload"), plan)
    return JobScript(job, Board(), placed(autopilot), policy=with_bridge(bridge))


def on_board(*carried: WireItem, autopilot: Autopilot) -> Board:
    """Put there by somebody else."""
    board = Board()
    board.items = [message_of(item) for item in mission(*carried, autopilot=autopilot)]
    return board


def with_bridge(rules: str) -> Policy:
    return parse_policy(f"[bridge]\n{rules}\n", "my.toml")


def findings(script: JobScript) -> list[str]:
    """What the client reads before the verdict."""
    return [trouble.text for trouble in told.events(script.work, ipc.Trouble)]


# ------------------------------------------------------------------------------ one by one


@BOTH
@pytest.mark.parametrize("switched", [0.0, 1.0, 2.0])
def test_the_fence_is_switched_by_no_mission_unless_a_client_may_switch_it(
    autopilot: Autopilot, switched: float
) -> None:
    script = upload(does(Cmd.DO_FENCE_ENABLE, switched), autopilot=autopilot)
    assert script.refused is Code.POLICY
    what = "switching the vehicle's own fence is not allowed (policy: bridge.fence)"
    assert script.sentence == f"item 3 (DO_FENCE_ENABLE): {what}"
    assert script.sent(MissionCount) == []
    assert script.loaded == []


def test_the_fence_is_switched_where_the_policy_forwards_that() -> None:
    switch = does(Cmd.DO_FENCE_ENABLE, 0.0)
    script = upload(switch, autopilot=ARDUPILOT, bridge='fence = "forward"')
    assert script.outcome == COMPLETE
    assert Cmd.DO_FENCE_ENABLE in [item.command for item in script.board.items]


@BOTH
def test_what_is_for_the_ground_alone_is_carried_by_no_mission(autopilot: Autopilot) -> None:
    script = upload(place(Cmd.DO_SET_HOME, 5.0), autopilot=autopilot, bridge='home = "on_ground"')
    assert script.refused is Code.POLICY
    assert "on the ground only (policy: bridge.home)" in script.sentence


@BOTH
@pytest.mark.parametrize("name", ["DO_DIGICAM_CONTROL", "DO_CHANGE_SPEED"])
def test_what_the_policy_denies_by_its_name_is_carried_by_no_mission(
    name: str, autopilot: Autopilot
) -> None:
    carried = does(Cmd[name], 1.0)
    assert upload(carried, autopilot=autopilot).outcome == COMPLETE
    for written in (name, f"MAV_CMD_{name}"):
        script = upload(carried, autopilot=autopilot, bridge=f'extra_denied = ["{written}"]')
        assert script.refused is Code.POLICY
        why = "the policy denies it by its name (policy: bridge.extra_denied)"
        assert script.sentence == f"item 3 ({name}): {why}"
        assert script.sent(MissionCount) == []


@BOTH
@pytest.mark.parametrize(
    "command",
    sorted(command for command, kind in KINDS.items() if kind is not ItemKind.FENCE),
)
def test_every_item_that_is_flown_can_be_denied_by_its_name(
    command: int, autopilot: Autopilot
) -> None:
    name = command_row(command).name
    script = upload(does(command), autopilot=autopilot, bridge=f'extra_denied = ["{name}"]')
    assert script.refused is Code.POLICY
    assert f"({name}): the policy denies it by its name" in script.sentence


def test_an_actuator_is_moved_by_no_mission_and_what_is_let_through_by_name_must_be_flown() -> None:
    servo = does(Cmd.DO_SET_SERVO, 9.0)
    script = upload(servo, autopilot=ARDUPILOT)
    assert script.refused is Code.POLICY
    assert "past the controllers" in script.sentence
    let_through = 'extra_harmless = ["DO_SET_SERVO", "DO_PARACHUTE"]'
    assert upload(servo, autopilot=ARDUPILOT, bridge=let_through).accepted
    script = upload(does(Cmd.DO_PARACHUTE), autopilot=ARDUPILOT, bridge=let_through)
    assert script.refused is Code.BAD_MISSION
    assert "verified here" in script.sentence


def test_each_item_that_is_not_carried_is_told() -> None:
    carried = (does(Cmd.DO_FENCE_ENABLE), does(Cmd.DO_SET_RELAY), does(Cmd.DO_FENCE_ENABLE))
    script = upload(*carried, autopilot=PX4)
    assert script.sentence.startswith("item 3 (DO_FENCE_ENABLE): ")
    assert [
        text.partition(": It ")[0].partition(": switching")[0] for text in findings(script)
    ] == [
        "POLICY: item 4 (DO_SET_RELAY)",
        "POLICY: item 5 (DO_FENCE_ENABLE)",
    ]


def test_the_place_of_an_ardupilot_s_home_is_no_item() -> None:
    """Item 0, whatever its command: the vehicle puts its own there."""
    items = mission(autopilot=ARDUPILOT)
    first = items[0]._replace(command=Cmd.DO_FENCE_ENABLE)
    plan = ClientPlan(MissionType.MISSION, (first, *items[1:]), SOURCE)
    script = JobScript(ClientUpload(asked("mission_upload"), plan), Board(), placed(ARDUPILOT))
    assert script.outcome == COMPLETE
    assert script.board.items[0].command == Cmd.NAV_WAYPOINT


# --------------------------------------------------------------- what is on board already


@BOTH
@pytest.mark.parametrize("job", [Adopt, CheckUnknown])
def test_a_mission_that_came_past_the_bridge_and_switches_the_fence_does_not_start(
    job: type[Adopt], autopilot: Autopilot
) -> None:
    board = on_board(does(Cmd.DO_FENCE_ENABLE), autopilot=autopilot)
    script = JobScript(job(asked("mission_start")), board, placed(autopilot)).run(5.0)
    assert script.refused is Code.POLICY
    assert script.sentence.startswith("item 3 (DO_FENCE_ENABLE): ")
    assert "bridge.fence" in script.sentence
    assert script.kept == []
    assert script.loaded == []


# ------------------------------------------------------------------------- the total table

JUDGED_BY_THE_VERIFIER = {
    "px4": {
        "NAV_WAYPOINT",
        "NAV_LOITER_TIME",
        "NAV_LOITER_TO_ALT",
        "NAV_DELAY",
        "DO_JUMP",
    },
    "ardupilot": {
        "NAV_WAYPOINT",
        "NAV_LOITER_TURNS",
        "NAV_LOITER_TIME",
        "NAV_LOITER_TO_ALT",
        "NAV_SPLINE_WAYPOINT",
        "NAV_DELAY",
        "CONDITION_DELAY",
        "CONDITION_DISTANCE",
        "DO_JUMP",
        "JUMP_TAG",
    },
}
"""Refused as commands, because they mean something in a mission only, or because the gate has
another word for them: where they lead is verified."""


def forms_of(command: int) -> list[WireItem]:
    """With a place and without, on and off and not given."""
    circle_m = 5.0 if command == Cmd.NAV_LOITER_TURNS else 0.0
    placed_items = [place(command, 15.0, p1) for p1 in (1.0, 0.0, math.nan)]
    return [
        *(item._replace(param3=circle_m) for item in placed_items),
        does(command, 1.0),
        does(command, 0.0),
    ]


def is_carried(command: int, autopilot: Autopilot) -> bool:
    """In any form, by the default policy."""
    for item in forms_of(command):
        (verdict,) = upload(item, autopilot=autopilot).run(5.0).of(GiveVerdict)
        if verdict.refusal is None:
            return True
    return False


@BOTH
def test_no_command_that_is_refused_by_default_rides_in_a_mission(autopilot: Autopilot) -> None:
    """Of all commands of the dialect those that a mission brings on board."""
    refused = (Kind.DENIED, Kind.CONFIGURATION, Kind.LOCAL)
    carried = {row.name: row.kind for n, row in command_rows().items() if is_carried(n, autopilot)}
    assert "DO_DIGICAM_CONTROL" in carried
    assert "NAV_LOITER_UNLIM" in carried
    unnoticed = {name for name, kind in carried.items() if kind in refused}
    assert unnoticed == JUDGED_BY_THE_VERIFIER[autopilot.name]


def test_a_client_s_jump_to_a_tag_rides_where_the_tag_is() -> None:
    """As DO_JUMP does; to no tag it does not."""
    tag, jump = does(Cmd.JUMP_TAG, 7.0), does(Cmd.DO_JUMP_TAG, 7.0)
    assert upload(tag, place(Cmd.NAV_WAYPOINT, 15.0), jump, autopilot=ARDUPILOT).accepted
    script = upload(place(Cmd.NAV_WAYPOINT, 15.0), jump, autopilot=ARDUPILOT)
    assert script.refused is Code.BAD_MISSION
    assert "jumps to tag 7, which no JUMP_TAG has" in script.sentence


@BOTH
@pytest.mark.parametrize("command", [0, 999, 65_535])
def test_what_the_dialect_lacks_is_in_no_mission(command: int, autopilot: Autopilot) -> None:
    script = upload(place(command, 15.0), autopilot=autopilot)
    assert script.refused is Code.BAD_MISSION
    assert "verified here" in script.sentence
