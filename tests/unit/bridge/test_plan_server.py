"""The mission protocol towards a client: flight scripts of both sides, `plan_scripts.txt`."""

from __future__ import annotations

from pathlib import Path

import pytest

from gcs.bridge.conversation.pending_requests import From
from gcs.bridge.effects import Reply
from gcs.bridge.plans.effects import Upload
from gcs.protocol.effects import Address
from gcs.wire.ids import MissionType
from gcs.wire.messages import MissionAck, MissionRequestInt
from tests.unit.bridge.plan_scripts import (
    BY,
    MS,
    VEHICLE,
    S,
    Script,
    answers_of,
    count,
    float_item,
    item,
)

SCRIPTS = (Path(__file__).parent / "plan_scripts.txt").read_text(encoding="utf-8")


@pytest.mark.parametrize(
    "script", SCRIPTS.split("== ")[1:], ids=lambda script: script.partition("\n")[0]
)
def test_both_sides(script: str) -> None:
    Script().play(script.partition("\n")[2])


# ---------------------------------------------------------------------------- what is in a plan


def test_a_plan_has_its_items_its_kind_and_where_it_is_from() -> None:
    (upload,) = Script().collected(3)
    assert isinstance(upload, Upload)
    assert [each.x for each in upload.plan.items] == [473977000, 473977001, 473977002]
    assert upload.plan.kind is MissionType.MISSION
    assert upload.plan.source == "the mission of 245/190"


def test_items_in_degrees_are_those_in_integers() -> None:
    script = Script()
    script.say(count(1))
    script.wait(260 * MS)
    (upload,) = script.say(float_item(0))
    assert isinstance(upload, Upload)
    assert upload.plan.items[0].x == 473977000


@pytest.mark.parametrize("anew", [False, True])
def test_an_item_counts_once_unless_the_count_begins_anew(anew: bool) -> None:
    script = Script()
    script.say(count(3))
    script.say(item(0))
    if anew:
        script.say(count(2))
        script.say(item(0, z=20.0))
    else:
        assert script.say(item(0, z=20.0)) == []
    effects = script.say(item(1)) + ([] if anew else script.say(item(2)))
    (upload,) = [each for each in effects if isinstance(each, Upload)]
    assert [each.z for each in upload.plan.items] == ([20.0, 10.0] if anew else [10.0] * 3)


@pytest.mark.parametrize("kind", [MissionType.FENCE, MissionType.RALLY])
def test_items_are_of_their_plans_kind(kind: MissionType) -> None:
    (upload,) = Script().collected(2, kind)
    assert isinstance(upload, Upload)
    assert [each.mission_type for each in upload.plan.items] == [kind, kind]


# ------------------------------------------------------------------------- from whom, for whom


@pytest.mark.parametrize("compid", [1, 190])
def test_answers_come_from_the_autopilot_and_go_to_who_asked(compid: int) -> None:
    """A plan for the mission planner, component 190, is the autopilot's."""
    (answer,) = Script().say(count(1), From(BY.link, BY.source, Address(1, compid)))
    assert isinstance(answer, Reply)
    assert (answer.link, answer.source) == (BY.link, VEHICLE)
    assert isinstance(answer.message, MissionRequestInt)
    assert (answer.message.target_system, answer.message.target_component) == (245, 190)


def test_another_component_takes_no_plans_and_says_so_itself() -> None:
    camera = Address(1, 100)
    effects = Script().say(count(2), From(BY.link, BY.source, camera))
    assert answers_of(effects) == ["refuses UNSUPPORTED", "ack UNSUPPORTED"]
    assert all(each.source == camera for each in effects if isinstance(each, Reply))


def test_the_opaque_id_comes_back() -> None:
    script = Script()
    script.say(count(1, opaque_id=77))
    script.say(item(0))
    (told,) = script.ended()
    assert isinstance(told, Reply)
    assert isinstance(told.message, MissionAck)
    assert told.message.opaque_id == 77


# --------------------------------------------------------- who answers while it is kept waiting


def answering(script: Script, span_ns: int, most_ns: int) -> list[int]:
    """What it is asked for in so long; no longer silence than `most_ns`."""
    until_ns, asked = script.now_ns + span_ns, []
    last_ns = script.now_ns
    while (due_ns := script.server.deadline_ns) is not None and due_ns <= until_ns:
        script.now_ns = due_ns
        effects = script.server.wake(due_ns)
        while wanted := questions(answers_of(effects)):
            assert script.now_ns - last_ns <= most_ns
            last_ns = script.now_ns
            asked += wanted
            script.now_ns += 5 * MS
            effects = script.say(item(wanted[0]))
    script.now_ns = until_ns
    return asked


def questions(answers: list[str]) -> list[int]:
    return [int(each.split()[1]) for each in answers if each.startswith(("ask", "old"))]


def waiting(many: int) -> Script:
    script = Script()
    script.collected(many)
    return script


def test_it_is_asked_for_the_last_items_in_order() -> None:
    """QGroundControl gives up after 1.5 s without a question (PlanManager.h)."""
    asked = answering(waiting(20), 6 * S, 300 * MS)
    assert asked[:18] == [*range(4, 20), 4, 5]


def test_one_item_is_asked_for_sparingly() -> None:
    assert answering(waiting(1), 3 * S, 1250 * MS) == [0, 0]


def test_the_acknowledgement_comes_after_the_last_item() -> None:
    """MAVSDK takes an ACCEPTED for an error where it has sent another item last."""
    script = waiting(20)
    assert answering(script, 900 * MS, 300 * MS) == [4, 5, 6, 7, 8]
    script.verdict("accepted")
    answers, asked = answers_of(script.ended()), []
    while answers != ["ack ACCEPTED"]:
        (seq,) = questions(answers)
        asked.append(seq)
        script.now_ns += 5 * MS
        answers = answers_of(script.say(item(seq)))
    assert asked == [*range(9, 20)]


def test_a_plan_that_is_on_board_already_stops_nothing_when_it_is_sent_anew() -> None:
    """Only its acknowledgement was not due yet: there is nothing that the station could stop."""
    script = waiting(20)
    answering(script, 900 * MS, 300 * MS)
    script.play("""
        ended -> ask 9
        collect 2 -> upload 2
        ended -> ack ACCEPTED
    """)
