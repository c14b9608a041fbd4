"""Upload: one verdict and one outcome, whatever goes wrong and at whichever step."""

from __future__ import annotations

import json

import msgspec
import pytest
from msgspec import structs

from gcs import ipc
from gcs.gate.effects import OutcomeKind
from gcs.gate.inputs import MissionLoaded
from gcs.gate.refusal import Code
from gcs.gate.states import State
from gcs.protocol.autopilot import ARDUPILOT
from gcs.protocol.effects import Send
from gcs.session.effects import ReadFile
from gcs.session.work import GateInput, GiveVerdict, Log
from gcs.vehicle.missions.jobs.job import OnBoardChanged
from gcs.vehicle.missions.jobs.upload import Upload
from gcs.vehicle.missions.jobs.verified import PAUSE_NS
from gcs.vehicle.talk.telemetry import Telemetry
from gcs.wire.ids import MissionResult, MissionType
from gcs.wire.messages import (
    Message,
    MissionAck,
    MissionCount,
    MissionItemInt,
    MissionRequestInt,
    MissionRequestList,
    ParamRequestRead,
)
from tests.unit.plan import samples
from tests.unit.station import told
from tests.unit.station.vehicles import SECOND_NS
from tests.unit.vehicle.jobs.script import (
    START_NS,
    Board,
    JobScript,
    asked,
    brought,
    placed,
)
from tests.unit.vehicle.plans import BOX, FAR, GUARDED, LAT, LON, plan

COMPLETE = (OutcomeKind.COMPLETE, None)
BAD_FILE = 4


def upload(board: Board | None = None, telemetry: Telemetry | None = None) -> JobScript:
    """Asked for; the file is still to be read."""
    return JobScript(Upload(asked("mission_upload"), "a.plan"), board or Board(), telemetry)


def aborted(code: Code) -> tuple[OutcomeKind, Code]:
    return OutcomeKind.ABORTED, code


# ------------------------------------------------------------------------------ all goes well


def test_a_mission_is_on_board_once_it_was_read_back_equal() -> None:
    script = upload()
    assert script.of(ReadFile) == [ReadFile(7, "a.plan")]
    assert script.of(GiveVerdict) == []
    script.read(BOX)
    assert script.outcome == COMPLETE
    assert len(script.board.items) == 4
    assert script.sentence == "4 items are on board, read back equal"
    assert script.loaded == [("", 0), ("a", 4)]
    (forgotten, kept) = script.kept
    assert forgotten is None
    assert kept is not None
    assert [item.command for item in kept.sent] == [22, 16, 16, 21]


def test_the_gate_forgets_the_old_mission_before_a_message_of_the_new_one_leaves() -> None:
    script = upload().read(BOX)
    first_send = next(
        i
        for i, item in enumerate(script.work)
        if isinstance(item, Send) and isinstance(item.message, MissionCount)
    )
    assert script.work.index(GateInput(MissionLoaded("", 0))) < first_send
    assert script.work.index(script.of(GiveVerdict)[0]) < first_send


def test_the_file_is_in_the_record_and_the_path_is_kept() -> None:
    script = upload().read(BOX)
    (file,) = told.recorded(script.work, "AttachmentItem")
    assert (file.name, file.data) == ("a.plan", BOX)
    path_ned = script.of(OnBoardChanged)[-1].path_ned
    assert (0.0, 0.0, 0.0) in path_ned
    assert len(path_ned) > 4


def test_ardupilot_is_sent_its_home_as_item_nought() -> None:
    script = upload(telemetry=placed(ARDUPILOT)).read(BOX)
    assert script.outcome == COMPLETE
    assert script.sent(MissionCount)[0].count == 5
    first = script.sent(MissionItemInt)[0]
    assert (first.x, first.y, first.z) == (473977420, 85455940, 488.0)
    assert script.loaded[-1] == ("a", 4)


def test_progress_is_shown_item_by_item() -> None:
    script = upload().read(BOX)
    progress = told.events(script.work, ipc.ProgressEvent)
    assert [(step.what, step.done, step.total) for step in progress] == [
        *(("mission_upload", n, 4) for n in (1, 2, 3, 4)),
        *(("reading back", n, 4) for n in (1, 2, 3, 4)),
    ]


# ----------------------------------------------------------------------------- refused: the file


@pytest.mark.parametrize(
    ("data", "why"),
    [
        (None, "a.plan: no such file"),
        (b"", "a.plan"),
        (b"{}", "a.plan"),
        (BOX[:100], "a.plan"),
        (plan(), "has no items, no fence and no rally points"),
        (plan(samples.waypoint(1, 99.0, 8.5, 10)), "a.plan"),
    ],
)
def test_a_file_that_is_no_mission_is_refused_by_name_and_never_sent(
    data: bytes | None, why: str
) -> None:
    script = upload().read(data, "no such file" if data is None else "")
    assert script.refused is Code.BAD_MISSION
    assert why in script.sentence
    (trouble,) = told.troubles(script.work)
    assert trouble.exit_code == BAD_FILE
    assert script.board.heard == []
    assert script.loaded == []


def test_more_items_than_can_be_verified_in_a_tick_are_refused() -> None:
    many = [samples.waypoint(n, LAT, LON, 10) for n in range(1, 2002)]
    assert upload().read(plan(*many)).run(5.0).refused is Code.BAD_MISSION


# ---------------------------------------------------------------------------- refused: the path


def test_a_leg_that_leaves_the_fence_is_refused_with_its_item_and_never_sent() -> None:
    script = upload().read(FAR)
    assert script.refused in (Code.LEG_LEAVES_FENCE, Code.OUTSIDE_FENCE, Code.TOO_FAR)
    assert script.sentence.startswith("item 2: ")
    assert script.sent(MissionCount) == []


def test_the_fence_of_the_plan_itself_counts_too() -> None:
    document = samples.box()
    document["geoFence"]["circles"] = [
        {"circle": {"center": [LAT + 0.00005, LON], "radius": 3}, "inclusion": False, "version": 1}
    ]
    script = upload().read(json.dumps(document).encode())
    assert script.refused in (Code.INSIDE_EXCLUSION, Code.LEG_LEAVES_FENCE)


def test_heights_above_the_terrain_are_not_known_and_refused() -> None:
    terrain = samples.simple(2, 16, 10, [0, 0, 0, None, LAT, LON, 10])
    data = plan(samples.waypoint(1, LAT, LON, 10, command=22), terrain)
    assert upload().read(data).refused is Code.BAD_MISSION


def test_a_return_whose_height_is_not_known_is_refused() -> None:
    board = Board()
    height = board.parameters.pop("RTL_RETURN_ALT")
    back = samples.simple(2, 20, 2, [0, 0, 0, 0, 0, 0, 0])
    data = plan(samples.waypoint(1, LAT, LON, 10, command=22), back)
    assert upload(board).read(data).refused is Code.RTL_BLOCKED
    board.parameters["RTL_RETURN_ALT"] = height
    assert upload(board).read(data).outcome == COMPLETE


def test_a_return_height_that_is_lost_on_the_way_is_waited_for() -> None:
    board = Board()
    board.deaf_to = [ParamRequestRead]
    back = samples.simple(2, 20, 2, [0, 0, 0, 0, 0, 0, 0])
    script = upload(board).read(plan(samples.waypoint(1, LAT, LON, 10, command=22), back))
    script.run(10.0)
    assert script.of(GiveVerdict) == []
    board.deaf_to = []
    assert script.run(1.0).outcome == COMPLETE


def test_without_the_acceptance_radius_nothing_is_verified() -> None:
    board = Board()
    del board.parameters["NAV_ACC_RAD"]
    script = upload(board).read(BOX).run(31.0)
    assert script.refused is Code.NO_ANSWER
    assert "NAV_ACC_RAD" in script.sentence


RALLY_IN_A_ZONE = LAT + 0.0003, LON


def with_rally(*points: tuple[float, float]) -> bytes:
    """A box with an exclusion circle of 10 m about 33 m north, and rally points 5 m up."""
    document = samples.box()
    circle = {"circle": {"center": [LAT + 0.0003, LON], "radius": 10}, "inclusion": False}
    document["geoFence"]["circles"] = [{**circle, "version": 1}]
    document["rallyPoints"] = {"points": [[*at, 5.0] for at in points], "version": 2}
    return json.dumps(document).encode()


def test_a_plan_s_fence_and_rally_points_are_brought_on_board_before_its_mission() -> None:
    script = upload().read(with_rally((LAT, LON + 0.0003)))
    assert script.outcome == COMPLETE
    assert [count.mission_type for count in script.sent(MissionCount)] == [1, 2, 0]
    fence, rally = script.board.lists[1], script.board.lists[2]
    assert [(item.command, item.param1) for item in fence] == [(5004, 10.0)]
    assert [(item.command, item.frame, item.z) for item in rally] == [(5100, 0, 493.0)]


def test_a_plan_s_rally_point_in_an_exclusion_zone_is_refused_by_its_number() -> None:
    script = upload().read(with_rally((LAT, LON + 0.0003), RALLY_IN_A_ZONE))
    assert script.refused in (Code.INSIDE_EXCLUSION, Code.LEG_LEAVES_FENCE)
    assert script.sentence.startswith("rally point 2: ")
    assert script.sent(MissionCount) == []


def test_a_rally_point_that_another_station_set_counts_too() -> None:
    board = Board()
    here = upload(board).read(with_rally((LAT, LON + 0.0003)))
    assert here.outcome == COMPLETE
    (point,) = board.lists[2]
    board.lists[2] = [structs.replace(point, x=round(RALLY_IN_A_ZONE[0] * 1e7), y=round(LON * 1e7))]
    script = upload(board).read(with_rally())
    assert script.refused in (Code.INSIDE_EXCLUSION, Code.LEG_LEAVES_FENCE)
    assert script.sentence.startswith("rally point on board 1: ")


def test_a_fence_with_heights_is_said_not_to_be_sent() -> None:
    data = b"""schema = 1
frame = "home"
[[waypoint]]
north_m = 5
east_m = 0
up_m = 5
[fence]
north_m = [-50, 50]
east_m = [-50, 50]
up_m = [0, 40]
"""
    script = JobScript(Upload(asked("mission_upload"), "a.toml"), Board()).read(data)
    assert script.outcome == COMPLETE
    assert [count.mission_type for count in script.sent(MissionCount)] == [0]
    assert any("fence: is kept by the gate and not sent" in log.text for log in script.of(Log))


# ------------------------------------------------------------------------- parts of a plan alone


def upload_part(word: str, kind: MissionType, board: Board, state: State) -> JobScript:
    return JobScript(Upload(asked(word), "a.plan", kind), board, state=state)


def without_mission() -> bytes:
    document = json.loads(GUARDED)
    document["mission"]["items"] = []
    return json.dumps(document).encode()


def test_a_plan_without_a_mission_leaves_the_one_on_board_as_it_is() -> None:
    board = Board(brought(BOX, placed()))
    script = upload(board).read(without_mission())
    assert script.outcome == COMPLETE
    assert [count.mission_type for count in script.sent(MissionCount)] == [1, 2]
    assert script.sentence == "a fence of 2 zones, 2 rally points are on board, read back equal"
    assert (script.kept, script.loaded, len(board.items)) == ([], [], 4)


@pytest.mark.parametrize(
    ("word", "kind", "told"),
    [
        (
            "fence_upload",
            MissionType.FENCE,
            "a fence of 2 zones is on board, read back equal; "
            "not sent of the file: 4 items, 2 rally points",
        ),
        (
            "rally_upload",
            MissionType.RALLY,
            "2 rally points are on board, read back equal; "
            "not sent of the file: 4 items, a fence of 2 zones",
        ),
    ],
)
def test_one_part_of_a_file_is_sent_and_the_others_are_named(
    word: str, kind: MissionType, told: str
) -> None:
    script = upload_part(word, kind, Board(), State.GROUNDED).read(GUARDED)
    assert script.outcome == COMPLETE
    assert [count.mission_type for count in script.sent(MissionCount)] == [kind]
    assert script.sentence == told


def test_a_file_without_that_part_is_refused_and_says_what_it_has() -> None:
    script = upload_part("fence_upload", MissionType.FENCE, Board(), State.GROUNDED).read(BOX)
    assert script.refused is Code.BAD_MISSION
    (trouble,) = told.troubles(script.work)
    assert (trouble.exit_code, trouble.hint) == (BAD_FILE, "it has 4 items")


def test_rally_points_alone_are_judged_by_the_policy() -> None:
    document = json.loads(without_mission())
    document["rallyPoints"]["points"].append([LAT + 0.01, LON, 5.0])
    data = json.dumps(document).encode()
    script = upload_part("rally_upload", MissionType.RALLY, Board(), State.GROUNDED).read(data)
    assert script.refused in (Code.TOO_FAR, Code.OUTSIDE_FENCE, Code.LEG_LEAVES_FENCE)
    assert script.sentence.startswith("rally point 3: ")
    assert script.board.heard == []


FLIES = State.HOVERING


def flying(data: bytes, board: Board, word: str = "mission_upload") -> JobScript:
    kind = MissionType.FENCE if word == "fence_upload" else MissionType.MISSION
    telemetry = placed()
    telemetry.armed = True
    job = Upload(asked(word), "a.plan", kind)
    return JobScript(job, board, telemetry, FLIES).read(data)


def test_in_the_air_a_fence_is_not_replaced_by_any_word() -> None:
    board = Board()
    upload(board).read(with_rally())
    for word in ("mission_upload", "fence_upload"):
        script = flying(GUARDED, board, word)
        assert script.refused is Code.IN_AIR
        assert script.sent(MissionCount) == []


def test_in_the_air_the_same_fence_stays_and_the_mission_is_sent() -> None:
    board = Board()
    upload(board).read(GUARDED)
    script = flying(GUARDED, board)
    assert script.outcome == COMPLETE
    assert [count.mission_type for count in script.sent(MissionCount)] == [2, 0]
    assert script.sentence.startswith("4 items, a fence of 2 zones, 2 rally points are on board")


def test_in_the_air_a_vehicle_without_a_fence_gets_one() -> None:
    assert flying(GUARDED, Board(), "fence_upload").outcome == COMPLETE


def test_in_the_air_a_fence_that_is_not_known_stays() -> None:
    telemetry = placed()
    telemetry.armed = True
    job = Upload(asked("fence_upload"), "a.plan", MissionType.FENCE)
    script = JobScript(job, Board(), telemetry, FLIES)
    script.on_board = (None, None)
    assert script.read(GUARDED).refused is Code.IN_AIR


@pytest.mark.slow
def test_two_thousand_items_are_verified_in_steps() -> None:
    """Between two steps there is time for positions and ticks; a step before its time is none."""
    way = [samples.waypoint(n, LAT + 1e-7 * n, LON, 10) for n in range(2, 2001)]
    board = Board()
    board.deaf_to = [MissionCount]
    script = upload(board).read(plan(samples.waypoint(1, LAT, LON, 10, command=22), *way))
    steps = 0
    while script.of(GiveVerdict) == []:
        assert script.job.deadline_ns == script.now_ns + PAUSE_NS
        script.wake()
        script.telemetry.position_ns = script.now_ns
        steps += 1
    assert steps > 100
    assert script.now_ns - START_NS == steps * PAUSE_NS
    assert script.accepted


def test_without_origin_and_home_nothing_can_be_verified() -> None:
    telemetry = placed()
    telemetry.origin = None
    script = upload(telemetry=telemetry).read(BOX).run(29.9)
    assert not script.job.over
    assert script.run(0.3).refused is Code.NO_ORIGIN


def test_the_origin_is_waited_for_before_the_plan_is_placed() -> None:
    """Who asks does not matter: a line of `gcs fly --plain` and Python wait here too."""
    telemetry = placed()
    origin, telemetry.origin = telemetry.origin, None
    script = upload(telemetry=telemetry).read(BOX).run(20.0)
    assert not script.job.over
    assert [log.text for log in script.of(Log)] == [
        "a.plan: waiting for the vehicle's origin and home"
    ]
    telemetry.origin = origin
    assert script.run(5.0).outcome == COMPLETE


def test_a_position_that_is_not_there_by_then_is_told_as_that() -> None:
    telemetry = placed()
    telemetry.home = None
    script = JobScript(Upload(asked("mission_upload"), "a.plan"), Board(), telemetry, State.STALE)
    assert script.read(BOX).run(31.0).refused is Code.STALE


def test_a_path_does_not_begin_at_a_position_that_is_too_old() -> None:
    telemetry = placed()
    telemetry.position_ns -= 2 * SECOND_NS
    assert upload(telemetry=telemetry).read(BOX).refused is Code.STALE


# --------------------------------------------------------------------------- on the way: silence


def test_a_vehicle_that_never_answers_is_no_answer_after_all_tries() -> None:
    board = Board()
    board.deaf_to = [MissionCount]
    script = upload(board).read(BOX)
    assert script.accepted
    script.run(60.0)
    assert script.outcome == aborted(Code.NO_ANSWER)
    assert len(script.sent(MissionCount)) == 20  # every 1.5 s, for 30 s
    assert script.loaded == [("", 0)]


def test_a_vehicle_that_falls_silent_half_way_is_no_answer() -> None:
    board = Board()
    board.deaf_from_seq = 2
    script = upload(board).read(BOX).run(60.0)
    assert script.outcome == aborted(Code.NO_ANSWER)
    assert script.kept == [None]


def test_where_only_the_last_word_is_lost_what_is_on_board_settles_it() -> None:
    board = Board()
    board.mute_ack = True
    script = upload(board).read(BOX).run(60.0)
    assert script.outcome == COMPLETE
    assert script.loaded[-1] == ("a", 4)


def test_where_the_last_word_is_lost_and_another_mission_is_on_board_it_is_not_ours() -> None:
    board = Board()
    board.mute_ack = True
    script = upload(board).read(BOX)
    board.items, board.deaf_to = board.items[:2], [MissionItemInt]
    script.run(60.0)
    assert script.outcome == aborted(Code.VEHICLE_REFUSED)
    assert script.kept == [None]


def test_a_mission_that_cannot_be_read_back_is_not_on_board() -> None:
    board = Board()
    board.deaf_to = [MissionRequestList]
    script = upload(board).read(BOX).run(60.0)
    assert script.outcome == aborted(Code.NO_ANSWER)
    assert script.loaded == [("", 0)]
    assert script.kept == [None]


def test_a_read_back_that_stops_half_way_is_no_answer() -> None:
    board = Board()
    board.deaf_to = [MissionRequestInt]
    script = upload(board).read(BOX).run(60.0)
    assert script.outcome == aborted(Code.NO_ANSWER)


def test_a_vehicle_that_asks_for_one_item_for_ever_is_given_up_and_told_so() -> None:
    board = Board()
    board.deaf_from_seq = 0
    script = upload(board).read(BOX)
    while not script.job.over:
        script.run(0.6).hear(request(0))
    assert 60 * SECOND_NS <= script.now_ns - START_NS <= 66 * SECOND_NS
    assert script.outcome == aborted(Code.NO_ANSWER)
    acks = [ack.type for ack in script.sent(MissionAck) if not ack.mission_type]
    assert acks == [MissionResult.OPERATION_CANCELLED]


def request(seq: int) -> MissionRequestInt:
    return MissionRequestInt(seq=seq, target_system=255, target_component=190)


def test_what_another_vehicle_asks_is_not_answered() -> None:
    board = Board()
    board.deaf_to = [MissionCount]
    script = upload(board).read(BOX).hear(request(0), sysid=2)
    assert script.sent(MissionItemInt) == []


def test_what_the_vehicle_asks_another_station_is_not_answered() -> None:
    board = Board()
    board.deaf_to = [MissionCount]
    elsewhere = msgspec.structs.replace(request(0), target_system=254)
    assert upload(board).read(BOX).hear(elsewhere).sent(MissionItemInt) == []


# --------------------------------------------------------------------------- on the way: refusals


@pytest.mark.parametrize("result", [MissionResult.NO_SPACE, MissionResult.DENIED])
def test_what_the_vehicle_refuses_ends_with_its_reason(result: MissionResult) -> None:
    board = Board()
    board.refuses = result
    script = upload(board).read(BOX)
    assert script.outcome == aborted(Code.VEHICLE_REFUSED)
    assert result.name in script.sentence


@pytest.mark.parametrize(
    "change", [{"z": 11.0}, {"x": 473987420}, {"command": 19}, {"frame": 5}, {"param1": 9.0}]
)
def test_what_is_read_back_otherwise_is_not_believed(change: dict[str, float]) -> None:
    board = Board()
    script = upload(board)
    hear = board.hear

    def altered(message: Message) -> list[Message]:
        if isinstance(message, MissionRequestList) and not message.mission_type:
            board.items[1] = msgspec.structs.replace(board.items[1], **change)
        return hear(message)

    board.hear = altered  # type: ignore[method-assign]
    script.read(BOX)
    assert script.outcome == aborted(Code.VEHICLE_REFUSED)
    assert "read back, it is another mission: item 1" in script.sentence
    assert script.loaded == [("", 0)]
    assert script.kept == [None]


# ------------------------------------------------------------------------------------- leaving


def test_a_station_that_leaves_before_the_verdict_refuses_it() -> None:
    assert upload().leave().refused is Code.OPERATOR_LOST


def test_a_station_that_leaves_on_the_way_aborts_it() -> None:
    board = Board()
    board.deaf_from_seq = 2
    assert upload(board).read(BOX).leave().outcome == aborted(Code.OPERATOR_LOST)
