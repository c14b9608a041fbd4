"""A plan on its way: read and placed, turned into items and back, and when it counts as flown."""

from __future__ import annotations

import json

import msgspec
import pytest

from gcs.gate.effects import Level
from gcs.gate.refusal import Code, Refusal
from gcs.plan.errors import PlanError
from gcs.plan.item_messages import item_of, message_of
from gcs.protocol.autopilot import ARDUPILOT, PX4, Autopilot
from gcs.station.links import Links
from gcs.steps import drained
from gcs.vehicle.missions.plans import OnBoard, Prepared, on_board, prepare
from gcs.wire.messages import MissionItemInt
from tests.unit.plan import samples
from tests.unit.station import wire
from tests.unit.vehicle.jobs.script import brought, placed
from tests.unit.vehicle.plans import BOX, LAT, LON, plan

UP = samples.waypoint(1, LAT, LON, 10, command=22)
LOCAL = b"""
schema = 1
name = "square"
frame = "home"

[[waypoint]]
north_m = 10.0
east_m = 20.0
up_m = 5.0
"""


def prepared(data: bytes, autopilot: Autopilot = PX4, path: str = "a.plan") -> Prepared:
    found = drained(prepare(path, data, placed(autopilot)))
    assert isinstance(found, Prepared)
    return found


# ------------------------------------------------------------------------------- from a file


def test_a_plan_s_items_leave_in_order_from_nought() -> None:
    sent = prepared(BOX).sent
    assert [item.seq for item in sent] == [0, 1, 2, 3]
    assert [item.command for item in sent] == [22, 16, 16, 21]
    assert (sent[1].x, sent[1].y, sent[1].z) == (473978420, 85455940, 10.0)


def test_ardupilot_s_items_begin_behind_its_home() -> None:
    sent = prepared(BOX, ARDUPILOT).sent
    assert len(sent) == 5
    assert (sent[0].frame, sent[0].z) == (5, 488.0)  # MAV_FRAME_GLOBAL_INT, above the sea
    assert [item.seq for item in sent] == [0, 1, 2, 3, 4]


def test_metres_from_the_take_off_point_are_placed_on_earth_around_home() -> None:
    """10 m north are 89.93 units of 1e-6 degrees on a sphere of 6,371,000 m."""
    sent = prepared(LOCAL, path="square.toml").sent
    (stop,) = [item for item in sent if item.command == 16]
    assert (stop.x - round(LAT * 1e7)) == pytest.approx(899, abs=1)
    metres_a_degree_east = 111_194.9 * 0.67687  # cos 47.397742 degrees
    assert (stop.y - round(LON * 1e7)) == pytest.approx(20 / metres_a_degree_east * 1e7, abs=2)
    assert stop.z == 5.0
    assert stop.frame == 6  # MAV_FRAME_GLOBAL_RELATIVE_ALT_INT


@pytest.mark.parametrize("unknown", ["origin", "home", "home_ned"])
def test_a_place_on_earth_needs_the_vehicle_s_own(unknown: str) -> None:
    telemetry = placed()
    setattr(telemetry, unknown, None)
    found = drained(prepare("square.toml", LOCAL, telemetry))
    assert isinstance(found, Refusal)
    assert found.code is Code.NO_ORIGIN


@pytest.mark.parametrize("data", [b"", b"\xff\xfe", b"[]", plan(), BOX[:-1]])
def test_what_is_no_mission_is_an_error_that_names_the_file(data: bytes) -> None:
    with pytest.raises(PlanError, match=r"^a\.plan"):
        drained(prepare("a.plan", data, placed()))


def test_a_plan_of_a_fence_alone_has_a_hint() -> None:
    with pytest.raises(PlanError, match="no items") as caught:
        drained(prepare("a.plan", plan(), placed()))
    assert "mission clear" in caught.value.hint


def test_what_its_reader_doubts_is_remarked_with_its_item() -> None:
    """Written for an ardupilot, flown by a px4."""
    document = samples.box()
    document["mission"]["firmwareType"] = 3
    remarks = prepared(json.dumps(document).encode()).remarks
    assert any(level is Level.WARNING and "ardupilot" in text for level, text in remarks)


# --------------------------------------------------------------------------- to wire and back


def test_an_item_is_on_the_wire_what_it_is_in_the_plan() -> None:
    item = prepared(BOX).sent[2]
    message = message_of(item)
    (seen,) = wire.sent(Links(255, 190, count=1).send(0, message, 0))
    assert seen.get_type() == "MISSION_ITEM_INT"
    assert (seen.seq, seen.command, seen.frame) == (2, 16, 6)
    assert (seen.x, seen.y, seen.z) == (473978420, 85457940, 12.0)
    assert (seen.autocontinue, seen.mission_type) == (1, 0)


def test_what_comes_back_is_the_item_that_left() -> None:
    for item in prepared(BOX).sent:
        assert item_of(message_of(item)) == item


def test_whose_plan_it_is_comes_back_too() -> None:
    message = msgspec.structs.replace(message_of(prepared(BOX).sent[0]), mission_type=1)
    assert isinstance(message, MissionItemInt)
    assert item_of(message).mission_type == 1


# ------------------------------------------------------------------------------ when it is over


def kept(*items: object, autopilot: Autopilot = PX4) -> OnBoard:
    return brought(plan(UP, *items), placed(autopilot))


def stop(number: int, command: int = 16, *params: float) -> dict[str, object]:
    """A waypoint, or another item at a place."""
    first = [*params, 0, 0, 0][:3]
    return samples.simple(number, command, 3, [*first, None, LAT, LON, 10])


PICTURE = samples.simple(3, 203, 2, [0, 0, 0, 0, 1, 0, 0])
JUMP = samples.simple(3, 177, 2, [2, 3, 0, 0, 0, 0, 0])
RTL = samples.simple(3, 20, 2, [0, 0, 0, 0, 0, 0, 0])
LAND = stop(3, 21)
LOITER = stop(3, 19, 5)


@pytest.mark.parametrize(
    ("items", "last_seq"),
    [
        ((), 0),
        ((stop(2),), 1),
        ((stop(2), PICTURE), 1),  # a picture is taken on the way: the stop before it is the last
        ((stop(2), LOITER), 2),
        ((stop(2), LAND), None),  # over when it has landed
        ((stop(2), RTL), None),
    ],
)
def test_a_mission_is_over_at_its_last_stop_or_when_it_has_landed(
    items: tuple[object, ...], last_seq: int | None
) -> None:
    assert kept(*items).last_seq == last_seq


def test_a_mission_without_a_stop_is_over_at_its_last_item() -> None:
    speeds = [samples.simple(n, 178, 2, [1, 3, 0, 0, 0, 0, 0]) for n in (1, 2, 3)]
    assert brought(plan(*speeds), placed()).last_seq == 2
    assert brought(plan(*speeds), placed(ARDUPILOT)).last_seq == 3


def test_ardupilot_counts_its_home() -> None:
    assert kept(stop(2), autopilot=ARDUPILOT).last_seq == 2


def test_a_mission_that_jumps_back_passes_its_last_stop_many_times() -> None:
    assert kept(stop(2), JUMP).loops
    assert not kept(stop(2)).loops


def test_what_is_on_board_is_the_plan_and_what_was_sent_of_it() -> None:
    found = prepared(BOX)
    assert on_board(found.plan, found.sent).sent == found.sent
    assert on_board(found.plan, found.sent).plan == found.plan
