"""Mission items on the wire, for either autopilot, and what a vehicle gives back of them."""

from __future__ import annotations

import json
import math
import struct

import pytest

from gcs.plan.compare import same_meaning
from gcs.plan.errors import PlanError
from gcs.plan.formats.reader import read
from gcs.plan.model import AutopilotName, Geodetic, Plan
from gcs.plan.wire import WireItem, from_wire, to_wire
from tests.unit.plan.samples import box, plan_document, read_json, simple, survey, waypoint


def jumping() -> Plan:
    """Ids that are not positions: the jump goes to the item with id 7, the second."""
    return read_json(
        plan_document(
            waypoint(5, 47.39775, 8.5456, 10, command=22),
            waypoint(7, 47.39785, 8.5456, 10),
            simple(9, 177, 2, [7, 2, 0, 0, 0, 0, 0]),
        )
    )


def test_px4_counts_from_the_first_item_and_keeps_nan() -> None:
    first, second, *_ = to_wire(read_json(box()), "px4")

    assert (first.seq, first.command, first.current) == (0, 22, 1)
    assert (second.frame, second.x, second.y, second.z) == (6, 473978420, 85455940, 10.0)
    assert math.isnan(second.param4)


def test_ardupilot_has_home_at_index_0_and_gets_no_nan() -> None:
    items = to_wire(read_json(box()), "ardupilot")

    assert len(items) == 5
    assert (items[0].seq, items[0].command, items[0].frame) == (0, 16, 5)
    assert (items[0].x, items[0].y, items[0].z) == (473977420, 85455940, 488.0)
    assert items[1].command == 22
    assert not any(math.isnan(item.param4) for item in items)


@pytest.mark.parametrize(("autopilot", "seq"), [("px4", 1.0), ("ardupilot", 2.0)])
def test_a_jump_names_the_seq_of_its_target(autopilot: AutopilotName, seq: float) -> None:
    items = to_wire(jumping(), autopilot)

    assert items[-1].param1 == seq
    assert from_wire(items, autopilot).items[-1].params[0] == 2.0


def test_a_jump_to_nowhere_does_not_leave() -> None:
    plan = read_json(plan_document(simple(1, 177, 2, [9, 1, 0, 0, 0, 0, 0])))

    with pytest.raises(PlanError, match="no item"):
        to_wire(plan, "px4")


def test_a_tag_is_the_same_on_the_wire() -> None:
    tag, jump = simple(2, 600, 2, [7, 0, 0, 0, 0, 0, 0]), simple(3, 601, 2, [7, 2, 0, 0, 0, 0, 0])
    plan = read_json(plan_document(waypoint(1, 47.39775, 8.5456, 10, command=22), tag, jump))

    items = to_wire(plan, "ardupilot")

    assert [(each.command, each.param1) for each in items[2:]] == [(600, 7.0), (601, 7.0)]
    assert [each.params for each in from_wire(items, "ardupilot").items[1:]] == [
        each.params for each in plan.items[1:]
    ]
    with pytest.raises(PlanError, match="no item"):
        to_wire(read_json(plan_document(jump)), "ardupilot")


def test_a_height_that_is_not_set_goes_to_px4_alone() -> None:
    document = box()
    document["mission"]["items"][0]["params"][6] = None
    plan = read_json(document)

    assert math.isnan(to_wire(plan, "px4")[0].z)
    with pytest.raises(PlanError, match="altitude"):
        to_wire(plan, "ardupilot")


@pytest.mark.parametrize("frame", [0, 2, 3, 10])
def test_px4_is_sent_no_frame_with_a_place_for_what_has_none(frame: int) -> None:
    """It answers UNSUPPORTED to a return in frames 0, 3 and 6, and so to all that has no place (PX4
    1.14.3).  What is to be a place of a return or of DO_LAND_START means nothing to it."""
    plan = read_json(
        plan_document(
            simple(1, 20, frame, [0, 0, 0, 0, 47.39775, 8.5456, 10]),
            simple(2, 189, frame, [0, 0, 0, 0, 47.39775, 8.5456, 10]),
            simple(3, 178, frame, [1, 5, -1, 0, 0, 0, 0]),
            simple(4, 203, frame, [0, 0, 0, 0, 1, 2, 3]),
            simple(5, 177, frame, [1, 2, 0, 0, 0, 0, 0]),
        )
    )
    returns, lands, speed, photo, jump = to_wire(plan, "px4")
    assert {each.frame for each in (returns, lands, speed, photo, jump)} == {2}
    assert returns[9:12] == lands[9:12] == (0, 0, 0.0)
    assert (photo.x, photo.y, photo.z) == (1, 2, 3.0)
    assert jump.param1 == 0.0


def test_a_return_from_a_file_in_frame_3_is_stored_by_a_px4_and_read_back_equal() -> None:
    """real_autopilots.md 6: what a real one stores is what leaves, item for item."""
    sent = to_wire(read_json(plan_document(simple(1, 20, 3, [0, 0, 0, 0, 0, 0, 0]))), "px4")
    stored = WireItem(0, 2, 20, 1, 1, 0.0, 0.0, 0.0, 0.0, 0, 0, 0.0)
    assert same_meaning(sent, [stored], "px4") == []


def test_an_empty_plan_is_no_item_not_even_home() -> None:
    assert to_wire(Plan("a", "ardupilot", Geodetic(1.0, 1.0, 1.0)), "ardupilot") == ()


def test_items_out_of_order_are_no_plan() -> None:
    items = to_wire(read_json(box()), "px4")

    with pytest.raises(PlanError, match="expected 1"):
        from_wire((items[0], items[2]), "px4")


def as_ardupilot_keeps(item: WireItem) -> WireItem:
    """What an ArduCopter gives back of an item, as seen on one."""
    frame = {6: 3, 5: 0, 2: 0}[item.frame]
    one = struct.unpack("<f", struct.pack("<f", item.param1))[0]
    unused = 0.0 if item.param3 == -1.0 else item.param3
    if item.seq == 0:
        return item._replace(frame=0, x=-353632621, y=1491652374, z=584.1)
    return item._replace(frame=frame, param1=one, param3=unused, z=round(item.z, 2))


def test_what_ardupilot_gives_back_means_the_same() -> None:
    document = survey()
    document["mission"]["items"].insert(1, simple(9, 178, 2, [1, 4.1, -1, 0, 0, 0, 0]))
    document["mission"]["items"][0]["params"][6] = 10.004
    sent = to_wire(read_json(document), "ardupilot")

    received = [as_ardupilot_keeps(item) for item in sent]

    assert list(sent) != received
    assert same_meaning(sent, received, "ardupilot") == []


@pytest.mark.parametrize(
    ("change", "field"),
    [
        ({"command": 21}, "command"),
        ({"frame": 5}, "frame"),
        ({"x": 473978423}, "latitude"),
        ({"y": 0}, "longitude"),
        ({"z": 10.5}, "altitude"),
        ({"z": math.nan}, "altitude"),
        ({"param1": 3.0}, "param1"),
        ({"param4": 1.0}, "param4"),
        ({"autocontinue": 0}, "autocontinue"),
    ],
)
def test_what_would_be_flown_otherwise_is_a_difference(
    change: dict[str, float], field: str
) -> None:
    sent = list(to_wire(read_json(box()), "px4"))
    received = list(sent)
    received[1] = received[1]._replace(**change)  # type: ignore[arg-type]  # fields of one row

    differences = same_meaning(sent, received, "px4")

    assert [(difference.seq, difference.field) for difference in differences] == [(1, field)]
    assert f": {field}: sent " in str(differences[0])


def test_a_missing_item_is_a_difference() -> None:
    sent = to_wire(read_json(box()), "px4")

    differences = same_meaning(sent, sent[:-1], "px4")

    assert [(d.field, d.sent, d.received) for d in differences] == [("items", "4", "3")]


def test_reading_what_was_written_from_the_wire_is_the_same_plan() -> None:
    plan = read_json(box())

    again = from_wire(to_wire(plan, "px4"), "px4")

    assert again.items == plan.items
    assert read("a.plan", json.dumps(box()).encode()).items == again.items
