"""A plan that a client has sent: verified as one from a file is, and every finding is told."""

from __future__ import annotations

import math

import pytest

from gcs import ipc
from gcs.bridge.client_plan import ClientPlan
from gcs.gate.effects import OutcomeKind
from gcs.gate.policy.parse import DEFAULT, parse_policy
from gcs.gate.policy.policy import Policy
from gcs.gate.refusal import Code
from gcs.plan.formats.wpl import read_wpl
from gcs.plan.item_messages import message_of
from gcs.plan.wire import WireItem
from gcs.protocol.autopilot import ARDUPILOT, PX4, Autopilot
from gcs.steps import drained
from gcs.vehicle.missions.jobs.clear import Clear
from gcs.vehicle.missions.jobs.forward_fence import RelayPlan
from gcs.vehicle.missions.jobs.upload import ClientUpload
from gcs.vehicle.talk.telemetry import Telemetry
from gcs.wire.ids import Cmd, MavFrame, MissionResult, MissionType
from gcs.wire.messages import (
    MissionClearAll,
    MissionCount,
    MissionItemInt,
    ParamRequestRead,
    SysStatus,
)
from tests.unit.station import told
from tests.unit.vehicle.jobs.script import START_NS, Board, JobScript, asked, placed
from tests.unit.vehicle.plans import LAT, LON

COMPLETE = (OutcomeKind.COMPLETE, None)
SOURCE = "the mission of 245/190"
RELATIVE = MavFrame.GLOBAL_RELATIVE_ALT_INT
NORTH_M = 1.0 / 111_000.0
TOO_FAR_M = 1_000.0


def item(
    seq: int,
    command: int = Cmd.NAV_WAYPOINT,
    north_m: float = 0.0,
    z: float = 10.0,
    frame: int = RELATIVE,
    p1: float = 0.0,
    kind: MissionType = MissionType.MISSION,
    current: int = 0,
) -> WireItem:
    x, y = round((LAT + north_m * NORTH_M) * 1e7), round(LON * 1e7)
    return WireItem(seq, frame, command, current, 1, p1, 0.0, 0.0, 0.0, x, y, z, kind)


GOOD = (item(0, Cmd.NAV_TAKEOFF), item(1, north_m=20.0), item(2, north_m=10.0))


def upload(
    *items: WireItem,
    board: Board | None = None,
    telemetry: Telemetry | None = None,
    kind: MissionType = MissionType.MISSION,
    policy: Policy = DEFAULT,
) -> JobScript:
    plan = ClientPlan(kind, items, SOURCE)
    job = ClientUpload if kind is MissionType.MISSION else RelayPlan
    return JobScript(job(asked("mission_upload"), plan), board or Board(), telemetry, policy=policy)


def aborted(code: Code) -> tuple[OutcomeKind, Code]:
    return OutcomeKind.ABORTED, code


# ------------------------------------------------------------------------------------ missions


def test_a_client_s_mission_is_on_board_once_it_was_read_back_equal() -> None:
    script = upload(*GOOD)
    assert script.outcome == COMPLETE
    assert [item.command for item in script.board.items] == [22, 16, 16]
    assert [(item.x, item.y, item.z) for item in script.board.items] == [
        (each.x, each.y, each.z) for each in GOOD
    ]
    assert script.loaded == [("", 0), (SOURCE, 3)]


def test_it_is_in_the_record_as_a_file() -> None:
    (file,) = told.recorded(upload(*GOOD).work, "AttachmentItem")
    assert file.name == "client_mission_7.waypoints"
    plan = drained(read_wpl(file.name, file.data, "a", "px4"))
    assert [each.command for each in plan.items] == [22, 16, 16]


def test_the_mission_begins_with_its_first_item_whatever_the_client_marks_as_current() -> None:
    marked = (GOOD[0], GOOD[1], item(2, north_m=10.0, current=1))
    script = upload(*marked)
    assert [each.current for each in script.sent(MissionItemInt)] == [1, 0, 0]


def test_an_ardupilot_s_item_nought_stands_for_home() -> None:
    home = item(0, z=488.0, frame=MavFrame.GLOBAL_INT)
    items = (home, item(1, Cmd.NAV_TAKEOFF), item(2, north_m=20.0))
    script = upload(*items, telemetry=placed(ARDUPILOT))
    assert script.outcome == COMPLETE
    assert script.sent(MissionCount)[0].count == 3
    assert script.loaded[-1] == (SOURCE, 2)


def test_every_leg_that_does_not_clear_is_told_with_its_item_and_its_metres() -> None:
    far = [item(n, north_m=TOO_FAR_M + n) for n in (1, 2)]
    script = upload(item(0, Cmd.NAV_TAKEOFF), *far)
    assert script.refused in (Code.LEG_LEAVES_FENCE, Code.OUTSIDE_FENCE, Code.TOO_FAR)
    findings = [trouble.text for trouble in told.events(script.work, ipc.Trouble)]
    assert "item 2" in script.sentence
    assert any("item 3" in text for text in findings)
    assert all(" m" in text for text in findings)
    assert script.sent(MissionCount) == []


def test_what_is_doubtful_about_a_mission_that_clears_is_told_to_its_client() -> None:
    again = item(3, Cmd.DO_JUMP, p1=1.0, frame=MavFrame.MISSION)._replace(param2=-1.0)
    script = upload(*GOOD, again).run(5.0)
    assert script.outcome == COMPLETE
    (warning,) = told.events(script.work, ipc.Trouble)
    assert warning.text == "warning: item 4 (DO_JUMP): repeats for ever"
    assert told.events(upload(*GOOD).work, ipc.Trouble) == []


def test_a_px4_is_brought_no_mission_that_it_would_never_start() -> None:
    land = item(2, Cmd.NAV_LAND)
    script = upload(*GOOD[:2], land, item(3, Cmd.NAV_TAKEOFF), item(4, north_m=10.0))
    assert script.refused is Code.BAD_MISSION
    assert "item 4 (NAV_TAKEOFF)" in script.sentence
    assert "a take-off must be the first item that is flown" in script.sentence
    assert script.sent(MissionCount) == []


def test_that_an_ardupilot_ends_its_flight_with_the_first_landing_is_told_to_its_client() -> None:
    home = item(0, z=488.0, frame=MavFrame.GLOBAL_INT)
    again = (item(4, Cmd.NAV_TAKEOFF), item(5, north_m=10.0), item(6, Cmd.NAV_LAND))
    items = (home, item(1, Cmd.NAV_TAKEOFF), item(2, north_m=20.0), item(3, Cmd.NAV_LAND), *again)
    script = upload(*items, telemetry=placed(ARDUPILOT)).run(5.0)
    assert script.outcome == COMPLETE
    (warning,) = told.events(script.work, ipc.Trouble)
    assert warning.text.startswith("warning: item 3 (NAV_LAND): lands and stops its motors")


def test_a_return_that_is_blocked_where_the_policy_only_warns_of_it_is_told_to_its_client() -> None:
    board = Board()
    board.parameters["RTL_RETURN_ALT"] = 130.0  # above max_up_m
    policy = parse_policy('[mission]\nblocked_return = "warn"', "my.toml")
    script = upload(*GOOD, board=board, policy=policy)
    assert script.outcome == COMPLETE
    (warning,) = told.events(script.work, ipc.Trouble)
    assert warning.text.startswith("warning: the vehicle's own failsafe return cannot be gated")


ENDURING = parse_policy("battery.endurance_s = 200", "my.toml")
"""Good for 170 s, as 15 % are kept; GOOD takes about a minute, its return included."""


def with_charge(telemetry: Telemetry, left_pct: int) -> None:
    """SYS_STATUS has told it."""
    status = SysStatus(0, 0, 0, 0, 12_000, -1, 0, 0, 0, 0, 0, 0, left_pct)
    telemetry.charge.system_status(status, START_NS)


@pytest.mark.parametrize(("autopilot", "good_pct"), [(PX4, 75), (ARDUPILOT, 75)])
def test_a_mission_for_which_the_battery_does_not_last_is_refused(
    autopilot: Autopilot, good_pct: int
) -> None:
    telemetry = placed(autopilot)
    with_charge(telemetry, good_pct)
    first = () if autopilot is PX4 else (item(0),)
    items = tuple(one._replace(seq=n) for n, one in enumerate((*first, *GOOD)))
    assert upload(*items, telemetry=telemetry, policy=ENDURING).outcome == COMPLETE
    telemetry = placed(autopilot)
    with_charge(telemetry, 30)
    script = upload(*items, telemetry=telemetry, policy=ENDURING)
    assert script.refused is Code.BATTERY_REACH
    assert "30 % are left of 200 s, and 15 % are kept" in script.sentence
    assert script.sent(MissionCount) == []


@pytest.mark.parametrize(
    ("autopilot", "names"),
    [
        (PX4, {"MPC_TKO_SPEED", "MPC_Z_V_AUTO_UP", "MPC_Z_V_AUTO_DN", "MPC_LAND_SPEED"}),
        (ARDUPILOT, {"WP_SPD_UP", "WP_SPD_DN", "LAND_SPD_MS"}),
    ],
)
def test_how_fast_it_climbs_and_lands_is_asked_only_where_it_is_judged(
    autopilot: Autopilot, names: set[str]
) -> None:
    for policy, wanted in ((DEFAULT, set[str]()), (ENDURING, names)):
        script = upload(*GOOD, telemetry=placed(autopilot), policy=policy)
        asked_for = {message.param_id for message in script.sent(ParamRequestRead)}
        assert asked_for & names == wanted


def test_a_vehicle_that_lands_slowly_needs_its_battery_for_longer() -> None:
    telemetry = placed()
    with_charge(telemetry, 75)
    board = Board()
    board.parameters["MPC_LAND_SPEED"] = 0.1
    script = upload(*GOOD, board=board, telemetry=telemetry, policy=ENDURING)
    assert script.refused is Code.BATTERY_REACH


@pytest.mark.parametrize(
    ("autopilot", "name", "waits"),
    [
        (PX4, "RTL_LAND_DELAY", 150.0),
        (PX4, "RTL_LAND_DELAY", -1.0),
        (ARDUPILOT, "RTL_LOIT_TIME", 150_000.0),
    ],
)
def test_one_that_hovers_for_long_before_it_lands_does_too(
    autopilot: Autopilot, name: str, waits: float
) -> None:
    telemetry = placed(autopilot)
    with_charge(telemetry, 75)
    board = Board()
    board.parameters[name] = waits
    first = () if autopilot is PX4 else (item(0),)
    items = tuple(one._replace(seq=n) for n, one in enumerate((*first, *GOOD)))
    script = upload(*items, board=board, telemetry=telemetry, policy=ENDURING)
    assert script.refused is Code.BATTERY_REACH


def test_of_a_mission_that_is_refused_the_reasons_are_told_alone() -> None:
    again = item(2, Cmd.DO_JUMP, p1=1.0, frame=MavFrame.MISSION)._replace(param2=-1.0)
    script = upload(item(0, Cmd.NAV_TAKEOFF), item(1, north_m=TOO_FAR_M), again).run(5.0)
    assert script.job.over
    assert not script.accepted
    assert not any("for ever" in each.text for each in told.events(script.work, ipc.Trouble))


@pytest.mark.parametrize(
    ("bad", "why"),
    [
        (item(1, frame=MavFrame.LOCAL_NED), "frame 1 is none of a mission"),
        (item(1, z=math.nan), "has no altitude"),
        (item(1)._replace(x=910_000_000), "latitude"),
        (item(1, command=31_000), "verified here"),
        (item(1, Cmd.DO_JUMP, p1=9.0, frame=MavFrame.MISSION), "jumps to seq 9"),
        (item(1, Cmd.NAV_FENCE_CIRCLE_INCLUSION, p1=10.0), "belongs to a fence"),
        (item(2), "seq"),
        (item(1, frame=MavFrame.GLOBAL_TERRAIN_ALT_INT), "terrain"),
    ],
)
def test_what_cannot_be_flown_is_refused_by_its_item_and_never_sent(
    bad: WireItem, why: str
) -> None:
    script = upload(GOOD[0], bad)
    assert script.refused is Code.BAD_MISSION
    assert why in script.sentence
    assert script.sent(MissionCount) == []
    assert script.loaded == []


def test_what_the_vehicle_itself_refuses_is_told_with_its_own_result() -> None:
    board = Board()
    board.refuses = MissionResult.NO_SPACE
    script = upload(*GOOD, board=board)
    assert script.outcome == aborted(Code.VEHICLE_REFUSED)
    assert script.sentence.endswith("NO_SPACE")


def test_a_client_that_withdraws_before_the_verdict_is_refused() -> None:
    board = Board()
    board.deaf_to = [ParamRequestRead]
    assert upload(*GOOD, board=board).stop().refused is Code.OPERATOR


# -------------------------------------------------------------------- fences and rally points


def fence(*norths_m: float) -> tuple[WireItem, ...]:
    """A polygon of corners to the north, alternately east and west of it."""
    corner = Cmd.NAV_FENCE_POLYGON_VERTEX_INCLUSION
    many = float(len(norths_m))
    corners = (
        item(n, corner, north_m, 0.0, MavFrame.GLOBAL, many, MissionType.FENCE)
        for n, north_m in enumerate(norths_m)
    )
    return tuple(
        each._replace(y=each.y + (1000 if each.seq in (1, 2) else -1000)) for each in corners
    )


def test_a_fence_goes_on_board_whole_and_is_read_back() -> None:
    script = upload(*fence(0.0, 0.0, 50.0, 50.0), kind=MissionType.FENCE)
    assert script.outcome == COMPLETE
    assert [each.command for each in script.board.lists[1]] == [5001] * 4
    assert script.loaded == []


def test_rally_points_go_on_board_as_they_are() -> None:
    point = item(0, Cmd.NAV_RALLY_POINT, 20.0, kind=MissionType.RALLY)
    script = upload(point, kind=MissionType.RALLY)
    assert script.outcome == COMPLETE
    assert [each.x for each in script.board.lists[2]] == [point.x]


def rally_points(*norths_m: float, telemetry: Telemetry | None = None) -> JobScript:
    items = (
        item(n, Cmd.NAV_RALLY_POINT, north_m, kind=MissionType.RALLY)
        for n, north_m in enumerate(norths_m)
    )
    return upload(*items, kind=MissionType.RALLY, telemetry=telemetry)


def test_rally_points_of_which_one_is_outside_the_fence_are_refused_whole() -> None:
    """The vehicle's own failsafe may return there, which no ground station can stop."""
    script = rally_points(20.0, 300.0, 400.0)
    assert script.refused is Code.OUTSIDE_FENCE
    assert script.sentence.startswith("rally point 2: ")
    (other,) = told.events(script.work, ipc.Trouble)
    assert "rally point 3: " in other.text
    assert script.sent(MissionCount) == []


def test_rally_points_are_refused_while_nobody_knows_where_they_lie() -> None:
    telemetry = placed()
    telemetry.home_ned = None
    assert rally_points(20.0, telemetry=telemetry).refused is Code.NO_ORIGIN


@pytest.mark.parametrize(
    "items",
    [
        fence(0.0, 0.0, 50.0, 50.0)[:3],  # a corner is missing
        (item(0, kind=MissionType.FENCE),),  # a waypoint
        (item(0, Cmd.NAV_RALLY_POINT, kind=MissionType.FENCE),),
        (item(0, Cmd.NAV_FENCE_CIRCLE_INCLUSION, p1=0.0, kind=MissionType.FENCE),),
        (item(0, 5005, p1=10.0, kind=MissionType.FENCE),),
    ],
)
def test_what_is_no_fence_is_refused_and_never_sent(items: tuple[WireItem, ...]) -> None:
    script = upload(*items, kind=MissionType.FENCE)
    assert script.refused is Code.BAD_MISSION
    assert script.sent(MissionCount) == []


def test_the_plans_of_all_kinds_are_cleared_one_after_the_other() -> None:
    kinds = (MissionType.MISSION, MissionType.FENCE, MissionType.RALLY)
    board = Board()
    board.lists[2] = [message_of(item(0, Cmd.NAV_RALLY_POINT))]
    script = JobScript(Clear(asked("plans_clear"), kinds), board)
    assert [message.mission_type for message in script.sent(MissionClearAll)] == [*kinds]
    assert script.outcome == COMPLETE
    assert board.lists[2] == []
    assert script.kept == [None]
