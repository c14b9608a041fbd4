"""The mission protocol towards a client: flight scripts of both sides."""

from __future__ import annotations

from collections.abc import Sequence

import pytest

from gcs import ipc
from gcs.bridge.conversation.pending_requests import From
from gcs.bridge.effects import Reply
from gcs.bridge.plans.effects import (
    Clear,
    Pass,
    PlanEffect,
    Refused,
    SetCurrent,
    Upload,
    Withdraw,
)
from gcs.bridge.plans.server import PlanServer
from gcs.gate.refusal import Code
from gcs.protocol.effects import Address
from gcs.wire.ids import Cmd, MavFrame, MissionResult, MissionType
from gcs.wire.messages import (
    Message,
    MissionAck,
    MissionClearAll,
    MissionCount,
    MissionItem,
    MissionItemInt,
    MissionRequest,
    MissionRequestInt,
    MissionRequestList,
    MissionSetCurrent,
    MissionWritePartialList,
    Statustext,
)

MS = 1_000_000
S = 1_000 * MS
ME = Address(245, 190)
VEHICLE = Address(1, 1)
LINK = 3
BY = From(LINK, ME, VEHICLE)
OTHER = From(LINK, Address(246, 190), VEHICLE)
TO_AUTOPILOT = 1
MISSION_PLANNER = 190


def item(seq: int, kind: MissionType = MissionType.MISSION, z: float = 10.0) -> MissionItemInt:
    return MissionItemInt(
        param1=0.0,
        param2=0.0,
        param3=0.0,
        param4=0.0,
        x=473977000 + seq,
        y=85455000,
        z=z,
        seq=seq,
        command=Cmd.NAV_WAYPOINT,
        target_system=1,
        target_component=1,
        frame=MavFrame.GLOBAL_RELATIVE_ALT_INT,
        current=0,
        autocontinue=1,
        mission_type=kind,
    )


def float_item(seq: int, lat_deg: float = 47.3977) -> MissionItem:
    return MissionItem(
        param1=0.0,
        param2=0.0,
        param3=0.0,
        param4=0.0,
        x=lat_deg,
        y=8.5455,
        z=10.0,
        seq=seq,
        command=Cmd.NAV_WAYPOINT,
        target_system=1,
        target_component=1,
        frame=MavFrame.GLOBAL_RELATIVE_ALT,
        current=0,
        autocontinue=1,
    )


def count(many: int, kind: MissionType = MissionType.MISSION, opaque_id: int = 0) -> MissionCount:
    return MissionCount(
        count=many, target_system=1, target_component=1, mission_type=kind, opaque_id=opaque_id
    )


def ack(result: MissionResult, kind: MissionType = MissionType.MISSION) -> MissionAck:
    return MissionAck(target_system=1, target_component=1, type=result, mission_type=kind)


class Script:
    """A server, and what it has answered since it was looked at last."""

    def __init__(self) -> None:
        self.server = PlanServer()
        self.now_ns = 0
        self.effects: list[PlanEffect] = []

    def say(self, message: Message, by: From = BY) -> list[PlanEffect]:
        effects = self.server.handle(message, by, self.now_ns)
        self.effects += effects
        return effects

    def accepted(self) -> list[PlanEffect]:
        return self.server.decided(ipc.VerdictEvent(1, "mission_upload", "accepted"), self.now_ns)

    def refused(self, code: Code, sentence: str) -> list[PlanEffect]:
        event = ipc.VerdictEvent(1, "mission_upload", "refused", code.value, sentence)
        return self.server.decided(event, self.now_ns)

    def ended(self, how: str = "complete", code: str = "", sentence: str = "") -> list[PlanEffect]:
        event = ipc.EndingEvent(1, "mission_upload", how, code, sentence)
        return self.server.ended(event, self.now_ns)

    def wait(self, span_ns: int) -> list[PlanEffect]:
        """All that happens in that time, with nothing from the client."""
        until_ns, effects = self.now_ns + span_ns, []
        while (due_ns := self.server.deadline_ns) is not None and due_ns <= until_ns:
            self.now_ns = due_ns
            effects += self.server.wake(due_ns)
        self.now_ns = until_ns
        return effects

    def collected(self, many: int, kind: MissionType = MissionType.MISSION) -> list[PlanEffect]:
        """An upload of so many items, up to the last one."""
        self.say(count(many, kind))
        effects: list[PlanEffect] = []
        for seq in range(many):
            self.now_ns += 5 * MS
            effects = self.say(item(seq, kind))
        return effects


def messages(effects: Sequence[PlanEffect]) -> list[Message]:
    return [effect.message for effect in effects if isinstance(effect, Reply)]


def questions(effects: Sequence[PlanEffect]) -> list[int]:
    forms = MissionRequest | MissionRequestInt
    return [each.seq for each in messages(effects) if isinstance(each, forms)]


def results(effects: Sequence[PlanEffect]) -> list[int]:
    return [each.type for each in messages(effects) if isinstance(each, MissionAck)]


def texts(effects: Sequence[PlanEffect]) -> str:
    return "".join(each.text for each in messages(effects) if isinstance(each, Statustext))


# ------------------------------------------------------------------------------- collecting


def test_a_plan_is_asked_for_item_by_item_and_handed_on_whole() -> None:
    script = Script()
    first = script.say(count(3))
    assert [type(each) for each in messages(first)] == [MissionRequestInt]
    assert questions(script.say(item(0))) == [1]
    assert questions(script.say(item(1))) == [2]
    (upload,) = script.say(item(2))
    assert isinstance(upload, Upload)
    assert [each.x for each in upload.plan.items] == [473977000, 473977001, 473977002]
    assert upload.plan.kind is MissionType.MISSION
    assert upload.plan.source == "the mission of 245/190"


def test_answers_come_from_the_autopilot_and_go_to_who_asked() -> None:
    script = Script()
    (answer,) = script.say(count(1))
    assert isinstance(answer, Reply)
    assert (answer.link, answer.source) == (LINK, VEHICLE)
    assert isinstance(answer.message, MissionRequestInt)
    assert (answer.message.target_system, answer.message.target_component) == (245, 190)


def test_a_plan_for_the_mission_planner_component_is_the_autopilots() -> None:
    by = From(LINK, ME, Address(1, MISSION_PLANNER))
    (answer,) = Script().say(count(1), by)
    assert isinstance(answer, Reply)
    assert answer.source == Address(1, TO_AUTOPILOT)


@pytest.mark.parametrize("kind", [MissionType.MISSION, MissionType.FENCE, MissionType.RALLY])
def test_all_three_kinds_are_collected(kind: MissionType) -> None:
    (upload,) = Script().collected(2, kind)
    assert isinstance(upload, Upload)
    assert upload.plan.kind is kind
    assert [each.mission_type for each in upload.plan.items] == [kind, kind]


def test_an_item_twice_or_out_of_order_changes_nothing() -> None:
    script = Script()
    script.say(count(3))
    assert script.say(item(2)) == []
    script.say(item(0))
    assert script.say(item(0, z=99.0)) == []
    script.say(item(1))
    (upload,) = script.say(item(2))
    assert isinstance(upload, Upload)
    assert [each.z for each in upload.plan.items] == [10.0, 10.0, 10.0]


def test_an_item_of_another_kind_is_not_taken() -> None:
    script = Script()
    script.say(count(2))
    assert script.say(item(0, MissionType.FENCE)) == []


def test_an_item_of_somebody_else_on_the_link_is_not_taken() -> None:
    script = Script()
    script.say(count(2))
    assert script.say(item(0), OTHER) == []
    assert questions(script.say(item(0))) == [1]


def test_what_does_not_come_is_asked_for_again() -> None:
    script = Script()
    script.say(count(2))
    script.now_ns += 20 * MS
    script.say(item(0))
    assert questions(script.wait(100 * MS)) == [1]
    assert isinstance(script.say(item(1))[-1], Upload)


def test_until_the_first_item_every_other_question_is_in_the_old_form() -> None:
    """MAVProxy reacts to MISSION_REQUEST alone (mission_item_protocol.py)."""
    script = Script()
    script.say(count(2))
    asked = messages(script.wait(1100 * MS))
    assert [type(each) for each in asked[:3]] == [
        MissionRequest,
        MissionRequestInt,
        MissionRequest,
    ]


def test_a_client_that_answered_the_old_form_is_asked_in_it() -> None:
    script = Script()
    script.say(count(2))
    script.wait(260 * MS)
    (following,) = messages(script.say(float_item(0)))
    assert isinstance(following, MissionRequest)
    (upload,) = script.say(float_item(1))
    assert isinstance(upload, Upload)
    assert upload.plan.items[0].x == 473977000


def test_unsupported_is_about_the_form_of_the_question() -> None:
    """MAVSDK's answer to MISSION_REQUEST of a PX4 (mavlink_mission_transfer_client.cpp)."""
    script = Script()
    script.say(count(2))
    script.wait(260 * MS)
    (again,) = messages(script.say(ack(MissionResult.UNSUPPORTED)))
    assert isinstance(again, MissionRequestInt)


@pytest.mark.parametrize("lat_deg", [float("nan"), float("inf"), 300.0])
def test_a_place_that_fits_in_no_item_ends_the_upload(lat_deg: float) -> None:
    script = Script()
    script.say(count(2))
    effects = script.say(float_item(0, lat_deg))
    assert results(effects) == [MissionResult.INVALID]
    assert "item 0" in texts(effects)
    assert script.server.deadline_ns is None


def test_the_count_again_before_the_first_item_is_the_same_upload() -> None:
    script = Script()
    script.say(count(2))
    assert questions(script.say(count(2))) == [0]
    assert questions(script.say(item(0))) == [1]


def test_another_count_begins_anew() -> None:
    script = Script()
    script.say(count(3))
    script.say(item(0))
    assert questions(script.say(count(2))) == [0]
    script.say(item(0, z=20.0))
    (upload,) = script.say(item(1, z=20.0))
    assert isinstance(upload, Upload)
    assert [each.z for each in upload.plan.items] == [20.0, 20.0]


def test_a_client_that_falls_silent_is_told_that_its_upload_is_over() -> None:
    script = Script()
    script.say(count(3))
    script.say(item(0))
    effects = script.wait(12 * S)
    assert results(effects) == [MissionResult.OPERATION_CANCELLED]
    assert any(isinstance(effect, Refused) for effect in effects)
    assert "item 1 of 3" in texts(effects)
    assert script.server.deadline_ns is None
    assert not script.server.busy


def test_a_cancelled_upload_is_forgotten() -> None:
    script = Script()
    script.say(count(3))
    assert script.say(ack(MissionResult.OPERATION_CANCELLED)) == []
    assert script.say(item(0)) == []
    assert script.server.deadline_ns is None


def test_too_many_items_are_refused_at_the_count() -> None:
    effects = Script().say(count(2_001))
    assert results(effects) == [MissionResult.NO_SPACE]
    assert "at most 2000" in texts(effects)


def test_an_unknown_kind_is_not_supported() -> None:
    message = MissionCount(count=2, target_system=1, target_component=1, mission_type=7)
    effects = Script().say(message)
    assert results(effects) == [MissionResult.UNSUPPORTED]
    assert [each.mission_type for each in messages(effects) if isinstance(each, MissionAck)] == [7]


def test_another_component_takes_no_plans() -> None:
    camera = Address(1, 100)
    effects = Script().say(count(2), From(LINK, ME, camera))
    assert results(effects) == [MissionResult.UNSUPPORTED]
    assert all(each.source == camera for each in effects if isinstance(each, Reply))


def test_a_second_component_on_the_link_waits_its_turn() -> None:
    script = Script()
    script.say(count(2))
    effects = script.say(count(2), OTHER)
    assert results(effects) == [MissionResult.DENIED]
    assert "245/190" in texts(effects)
    assert questions(script.say(item(0))) == [1]


def test_a_part_of_a_plan_is_refused() -> None:
    message = MissionWritePartialList(
        start_index=1, end_index=1, target_system=1, target_component=1
    )
    effects = Script().say(message)
    assert results(effects) == [MissionResult.UNSUPPORTED]
    assert any(isinstance(effect, Refused) for effect in effects)


# ---------------------------------------------------------------------------- the outcome


def test_a_refused_plan_is_answered_at_once_and_told_in_words() -> None:
    script = Script()
    script.collected(3)
    said = script.server.finding("item 2: 3.0 m outside of geofence", script.now_ns)
    assert "geofence" in texts(said)
    effects = script.refused(Code.LEG_LEAVES_FENCE, "item 2: its leg leaves the fence")
    assert results(effects) == [MissionResult.DENIED]
    assert "item 2" in texts(effects)
    assert not script.server.busy


@pytest.mark.parametrize(
    ("code", "sentence", "result"),
    [
        (Code.BAD_MISSION, "item 3: has no altitude", MissionResult.INVALID),
        (Code.BAD_MISSION, "seq 3: NAV_WAYPOINT: frame 1 is none", MissionResult.UNSUPPORTED_FRAME),
        (Code.POLICY, "the policy does not allow it", MissionResult.DENIED),
        (Code.OTHER_OPERATOR, "client 1001 is in control", MissionResult.DENIED),
        (Code.NO_ANSWER, "the vehicle did not answer", MissionResult.ERROR),
    ],
)
def test_the_result_fits_the_reason(code: Code, sentence: str, result: MissionResult) -> None:
    script = Script()
    script.collected(2)
    assert results(script.refused(code, sentence)) == [result]


def test_the_vehicles_own_result_is_passed_on() -> None:
    script = Script()
    script.collected(2)
    script.accepted()
    effects = script.ended("aborted", "VEHICLE_REFUSED", "the vehicle answered NO_SPACE")
    assert results(effects) == [MissionResult.NO_SPACE]


def test_one_acknowledgement_when_the_plan_is_on_board() -> None:
    script = Script()
    script.collected(3)
    assert script.accepted() == []
    assert results(script.ended()) == [MissionResult.ACCEPTED]
    assert script.wait(20 * S) == []


def test_the_opaque_id_comes_back() -> None:
    script = Script()
    script.say(count(1, opaque_id=77))
    script.say(item(0))
    (told,) = messages(script.ended())
    assert isinstance(told, MissionAck)
    assert told.opaque_id == 77


def test_the_last_item_again_is_answered_with_the_result_again() -> None:
    script = Script()
    script.collected(3)
    script.ended()
    script.now_ns += 1 * S
    assert results(script.say(item(2))) == [MissionResult.ACCEPTED]
    assert script.say(item(1)) == []
    script.now_ns += 20 * S
    assert script.say(item(2)) == []


# --------------------------------------------------------------------- keeping it waiting


def answered(script: Script, span_ns: int, most_ns: int) -> list[int]:
    """The client answers every question for so long; no longer silence than `most_ns`."""
    until_ns, asked = script.now_ns + span_ns, []
    last_ns = script.now_ns
    while (due_ns := script.server.deadline_ns) is not None and due_ns <= until_ns:
        script.now_ns = due_ns
        effects = script.server.wake(due_ns)
        while wanted := questions(effects):
            assert script.now_ns - last_ns <= most_ns
            last_ns = script.now_ns
            asked += wanted
            script.now_ns += 5 * MS
            effects = script.say(item(wanted[0]))
    script.now_ns = until_ns
    return asked


def test_a_client_that_waits_is_asked_for_the_last_items_in_order() -> None:
    """QGroundControl gives up after 1.5 s without a question (PlanManager.h)."""
    script = Script()
    script.collected(20)
    asked = answered(script, 6 * S, 300 * MS)
    assert asked[:18] == [*range(4, 20), 4, 5]


def test_the_acknowledgement_comes_after_the_last_item() -> None:
    """MAVSDK takes an ACCEPTED for an error where it has sent another item last."""
    script = Script()
    script.collected(20)
    assert answered(script, 900 * MS, 300 * MS) == [4, 5, 6, 7, 8]
    script.accepted()
    effects, asked = script.ended(), []
    while not results(effects):
        (seq,) = questions(effects)
        asked.append(seq)
        script.now_ns += 5 * MS
        effects = script.say(item(seq))
    assert asked == [*range(9, 20)]
    assert results(effects) == [MissionResult.ACCEPTED]


def test_a_client_that_stopped_answering_gets_its_acknowledgement_all_the_same() -> None:
    """MAVProxy answers no question after the last item."""
    script = Script()
    script.collected(20)
    script.wait(5 * S)
    assert results(script.ended()) == []
    assert results(script.wait(1500 * MS)) == [MissionResult.ACCEPTED]


def test_after_going_back_the_next_question_follows_at_once() -> None:
    """MAVSDK counts a question for an earlier item as a try, and forgets them at the next one."""
    script = Script()
    script.collected(20)
    (first,) = questions(script.wait(210 * MS))
    assert first == 4
    assert questions(script.say(item(4))) == [5]
    assert questions(script.say(item(5))) == []


def test_a_question_that_is_lost_while_a_client_waits_comes_again_soon() -> None:
    script = Script()
    script.collected(20)
    assert questions(script.wait(450 * MS)) == [4] * 5


def test_one_item_is_asked_for_sparingly() -> None:
    script = Script()
    script.collected(1)
    assert answered(script, 3 * S, 1250 * MS) == [0, 0]


def test_on_a_link_that_loses_frames_it_is_looked_whether_the_ack_arrived() -> None:
    script = Script()
    script.say(count(2))
    script.wait(200 * MS)
    script.say(item(0))
    script.wait(300 * MS)
    script.say(item(1))
    assert results(script.ended()) == [MissionResult.ACCEPTED]
    assert questions(script.wait(410 * MS)) == [1]
    assert results(script.say(item(1))) == [MissionResult.ACCEPTED]
    assert len(questions(script.wait(20 * S))) == 4


# -------------------------------------------------------------------- changing one's mind


def test_cancelling_what_is_on_its_way_stops_it() -> None:
    script = Script()
    script.collected(3)
    (effect,) = script.say(ack(MissionResult.OPERATION_CANCELLED))
    assert isinstance(effect, Withdraw)
    assert script.refused(Code.OPERATOR, "stopped") == []
    assert not script.server.busy


def test_another_plan_takes_the_place_of_the_one_on_its_way() -> None:
    script = Script()
    script.collected(3)
    script.accepted()
    (effect,) = script.collected(2)
    assert isinstance(effect, Withdraw)
    (upload,) = script.ended("aborted", "OPERATOR", "stopped by an operator")
    assert isinstance(upload, Upload)
    assert len(upload.plan.items) == 2
    assert results(script.ended()) == [MissionResult.ACCEPTED]


def test_the_same_plan_again_goes_on() -> None:
    """A client whose wait was over, or the network, sent the count once more."""
    script = Script()
    script.collected(3)
    script.accepted()
    assert script.collected(3) == []
    assert results(script.ended()) == [MissionResult.ACCEPTED]


def test_a_late_duplicate_of_the_count_does_no_harm() -> None:
    script = Script()
    script.collected(3)
    script.accepted()
    script.say(count(3))
    effects = script.wait(12 * S)
    assert results(effects) == []
    assert results(script.ended() + script.wait(2 * S)) == [MissionResult.ACCEPTED]


# --------------------------------------------------------------------- several types at once


def clear(kind: MissionType) -> MissionClearAll:
    return MissionClearAll(target_system=1, target_component=1, mission_type=kind)


def endings(effects: Sequence[PlanEffect]) -> list[tuple[int, int]]:
    """The type and the result of every MISSION_ACK."""
    acks = [each for each in messages(effects) if isinstance(each, MissionAck)]
    return [(each.mission_type, each.type) for each in acks]


def refusals(effects: Sequence[PlanEffect]) -> list[tuple[str, Code]]:
    refused = [each for each in effects if isinstance(each, Refused)]
    assert all(each.earlier for each in refused), "the message that came is not refused"
    return [(each.name, each.refusal.code) for each in refused]


MISSION, FENCE, RALLY = MissionType.MISSION, MissionType.FENCE, MissionType.RALLY
CANCELLED, ACCEPTED = MissionResult.OPERATION_CANCELLED, MissionResult.ACCEPTED


def test_an_upload_that_another_type_replaces_is_ended_and_told() -> None:
    script = Script()
    script.say(count(3))
    script.say(item(0))
    effects = script.say(count(2, FENCE))
    assert endings(effects) == [(MISSION, CANCELLED)]
    assert refusals(effects) == [("MISSION_COUNT", Code.SUPERSEDED)]
    assert "mission: given up after 1 of 3 items, by another upload, of fence" in texts(effects)
    assert questions(effects) == [0]
    script.say(item(0, FENCE))
    assert isinstance(script.say(item(1, FENCE))[-1], Upload)
    assert endings(script.ended() + script.wait(20 * S)) == [(FENCE, ACCEPTED)]


@pytest.mark.parametrize("kind", [MISSION, MissionType.ALL])
def test_an_upload_that_is_cleared_is_ended_and_told(kind: MissionType) -> None:
    script = Script()
    script.say(count(3))
    effects = script.say(clear(kind))
    assert endings(effects) == [(MISSION, CANCELLED)]
    assert refusals(effects) == [("MISSION_COUNT", Code.SUPERSEDED)]
    assert "mission: given up after 0 of 3 items, as it is to be cleared" in texts(effects)
    assert effects[-1] == Clear(kind)
    assert endings(script.ended() + script.wait(20 * S)) == [(kind, ACCEPTED)]


def test_a_count_of_the_same_type_begins_anew_and_ends_nothing() -> None:
    script = Script()
    script.say(count(3))
    script.say(item(0))
    assert endings(script.say(count(2))) == []
    assert script.say(count(0)) == [Clear(MISSION)]
    assert endings(script.ended() + script.wait(20 * S)) == [(MISSION, ACCEPTED)]


def test_a_clear_of_another_type_leaves_an_upload_alone() -> None:
    script = Script()
    script.say(count(2, RALLY))
    assert script.say(clear(MISSION)) == [Clear(MISSION)]
    assert questions(script.say(item(0, RALLY))) == [1]
    assert script.say(item(1, RALLY)) == [], "it waits until the clear is over"
    effects = script.ended()
    assert endings(effects) == [(MISSION, ACCEPTED)]
    assert isinstance(effects[-1], Upload)
    assert endings(script.ended()) == [(RALLY, ACCEPTED)]
    assert not script.server.busy


@pytest.mark.parametrize("refused", [False, True])
def test_a_plan_of_another_type_waits_for_the_one_on_its_way(refused: bool) -> None:
    script = Script()
    script.collected(3)
    script.accepted()
    assert script.collected(2, FENCE) == []
    assert script.say(clear(RALLY)) == []
    effects = script.ended("aborted", "NO_ANSWER", "silent") if refused else script.ended()
    assert endings(effects) == [(MISSION, MissionResult.ERROR if refused else ACCEPTED)]
    (upload,) = [each for each in effects if isinstance(each, Upload)]
    assert upload.plan.kind is FENCE
    effects = script.ended()
    assert endings(effects) == [(FENCE, ACCEPTED)]
    assert effects[-1] == Clear(RALLY)
    assert endings(script.ended()) == [(RALLY, ACCEPTED)]
    assert script.wait(20 * S) == []


def test_items_of_a_plan_on_its_way_are_taken_while_another_one_is_collected() -> None:
    """They keep its client waiting, and tell when its acknowledgement is due."""
    script = Script()
    script.collected(3)
    script.say(count(2, FENCE))
    script.wait(200 * MS)
    assert questions(script.say(item(0))) == [1], "the next of the mission"
    assert questions(script.say(item(0, FENCE))) == [1]


def test_who_waits_while_another_plan_is_brought_on_board_is_kept_waiting() -> None:
    script = Script()
    script.collected(3)
    script.collected(2, FENCE)
    asked = [
        each for each in messages(script.wait(210 * MS)) if isinstance(each, MissionRequestInt)
    ]
    assert {each.mission_type for each in asked} == {MISSION, FENCE}


def test_a_plan_on_its_way_that_is_cleared_is_ended_and_stopped() -> None:
    script = Script()
    script.collected(3)
    script.accepted()
    effects = script.say(clear(MISSION))
    assert endings(effects) == [(MISSION, CANCELLED)]
    assert "mission: given up, as it is to be cleared" in texts(effects)
    assert isinstance(effects[-1], Withdraw)
    assert script.say(clear(MISSION)) == [], "once more, as no answer came"
    assert script.ended("aborted", "OPERATOR", "stopped") == [Clear(MISSION)]
    assert endings(script.ended() + script.wait(20 * S)) == [(MISSION, ACCEPTED)]


def test_a_plan_that_waits_and_is_cleared_is_ended() -> None:
    script = Script()
    script.collected(3)
    script.accepted()
    script.collected(2, FENCE)
    effects = script.say(clear(FENCE))
    assert endings(effects) == [(FENCE, CANCELLED)]
    assert refusals(effects) == [("MISSION_COUNT", Code.SUPERSEDED)]
    assert not any(isinstance(each, Withdraw) for each in effects), "the mission goes on"
    effects = script.ended()
    assert endings(effects) == [(MISSION, ACCEPTED)]
    assert effects[-1] == Clear(FENCE)


def test_all_plans_are_cleared_after_the_clear_of_one() -> None:
    script = Script()
    script.say(clear(MISSION))
    assert script.say(clear(MissionType.ALL)) == []
    effects = script.ended()
    assert endings(effects) == [(MISSION, ACCEPTED)]
    assert effects[-1] == Clear(MissionType.ALL)
    assert endings(script.ended()) == [(MissionType.ALL, ACCEPTED)]


def test_a_plan_that_is_on_board_already_stops_nothing_when_it_is_sent_anew() -> None:
    """Only its acknowledgement was not due yet: there is nothing that the station could stop."""
    script = Script()
    script.collected(20)
    answered(script, 900 * MS, 300 * MS)
    assert results(script.ended()) == []
    (upload,) = script.collected(2)
    assert isinstance(upload, Upload)
    assert results(script.ended()) == [MissionResult.ACCEPTED]


def test_a_plan_that_waits_can_be_cancelled() -> None:
    script = Script()
    script.collected(3)
    script.accepted()
    script.collected(2, FENCE)
    assert script.say(ack(CANCELLED, FENCE)) == []
    effects = script.ended()
    assert endings(effects) == [(MISSION, ACCEPTED)]
    assert not script.server.busy


# ------------------------------------------------------------------------ all other messages


def test_downloads_go_to_the_vehicle_as_they_are() -> None:
    script = Script()
    to = {"target_system": 1, "target_component": 1}
    assert script.say(MissionRequestList(**to)) == [Pass()]
    assert script.say(MissionRequestInt(seq=0, **to)) == [Pass()]
    assert script.say(MissionRequest(seq=0, **to)) == [Pass()]
    assert script.say(ack(MissionResult.ACCEPTED)) == [Pass()]
    assert script.say(ack(MissionResult.OPERATION_CANCELLED)) == [Pass()]


def test_clear_is_asked_for_and_answered() -> None:
    script = Script()
    message = MissionClearAll(target_system=1, target_component=1, mission_type=MissionType.FENCE)
    assert script.say(message) == [Clear(MissionType.FENCE)]
    assert script.say(message) == []
    assert results(script.ended()) == [MissionResult.ACCEPTED]
    assert results(script.say(message)) == [MissionResult.ACCEPTED]


def test_a_clear_that_was_refused_is_decided_anew() -> None:
    """The mission was flown a second ago, and is over."""
    script = Script()
    message = MissionClearAll(target_system=1, target_component=1)
    assert script.say(message) == [Clear(MissionType.MISSION)]
    assert results(script.refused(Code.BUSY, "it is flown")) == [MissionResult.DENIED]
    assert script.say(message) == [Clear(MissionType.MISSION)]


def test_a_clear_is_a_new_one_once_it_cannot_be_a_repetition() -> None:
    """Another plan may be on board by then."""
    script = Script()
    message = MissionClearAll(target_system=1, target_component=1)
    script.say(message)
    script.ended()
    script.wait(2 * S - 1)
    assert results(script.say(message)) == [MissionResult.ACCEPTED]
    script.wait(1)
    assert script.say(message) == [Clear(MissionType.MISSION)]


def test_a_plan_without_items_is_a_clear() -> None:
    assert Script().say(count(0)) == [Clear(MissionType.MISSION)]


def test_clear_takes_the_place_of_an_upload_on_its_way() -> None:
    script = Script()
    script.collected(3)
    message = MissionClearAll(target_system=1, target_component=1)
    assert isinstance(script.say(message)[-1], Withdraw)
    assert script.refused(Code.OPERATOR, "stopped") == [Clear(MissionType.MISSION)]
    assert results(script.ended()) == [MissionResult.ACCEPTED]


def test_set_current_is_motion() -> None:
    message = MissionSetCurrent(seq=4, target_system=1, target_component=1)
    assert Script().say(message) == [SetCurrent(4)]


# ------------------------------------------------------------------- what was told already


def test_the_same_finding_of_another_plan_is_told_again() -> None:
    """A second later, as somebody has drawn it anew."""
    script, finding = Script(), "item 2: 3.0 m outside of geofence"
    for many in (3, 4, 4):
        script.collected(many)
        assert finding in texts(script.server.finding(finding, script.now_ns))
        assert texts(script.server.finding(finding, script.now_ns)) == "", "once of each plan"
        refused = script.refused(Code.TOO_FAR, "item 3: is too far")
        assert results(refused) == [MissionResult.DENIED]
        assert "item 3: is too far" in texts(refused)
        script.wait(S)


def test_another_clear_that_is_refused_is_told_too() -> None:
    script = Script()
    for clears in (MissionClearAll(target_system=1, target_component=1), count(0), count(0)):
        script.say(clears)
        assert "flown" in texts(script.refused(Code.BUSY, "the mission on board is being flown"))


def test_the_same_count_again_is_told_once_and_another_one_again() -> None:
    """It comes again where its acknowledgement is lost."""

    def unknown(many: int) -> MissionCount:
        return MissionCount(count=many, target_system=1, target_component=1, mission_type=7)

    script = Script()
    told = [texts(script.say(message)) for message in (unknown(2), unknown(2), unknown(3))]
    assert [bool(text) for text in told] == [True, False, True]
