"""QGroundControl's .plan: what is read, and what is refused with its JSON path."""

from __future__ import annotations

import json
import math
from collections.abc import Callable
from typing import Any

import pytest

from gcs.plan.errors import PlanError
from gcs.plan.formats.reader import read
from gcs.plan.model import Circle, Frame, Geodetic, Geographic, LatLon, Plain, Polygon
from tests.sample_files import elsewhere
from tests.unit.plan.samples import box, plan_document, read_json, refused, simple, survey

Change = Callable[[dict[str, Any]], object]


def test_a_plan_is_read_with_home_that_is_no_item() -> None:
    plan = read_json(box())

    assert plan.firmware == "px4"
    assert plan.home == Geodetic(47.397742, 8.545594, 488.0)
    assert [item.command for item in plan.items] == [22, 16, 16, 21]
    assert plan.items[2].place == Geographic(47.3978420, 8.5457940, 12.0)
    assert plan.items[2].frame is Frame.HOME
    assert math.isnan(plan.items[2].params[3])
    assert plan.items[2].where == "mission.items[2]"
    assert (plan.cruise_speed_m_s, plan.hover_speed_m_s) == (15.0, 5.0)


def test_a_survey_is_expanded_and_keeps_its_ids() -> None:
    plan = read_json(survey())

    assert [item.do_jump_id for item in plan.items] == [1, 2, 3, 4]
    assert plan.items[2].where == "mission.items[1].TransectStyleComplexItem.Items[1]"


def test_parameters_of_an_item_without_position_are_no_position() -> None:
    plan = read_json(plan_document(simple(1, 203, 2, [1, 0, 0, 0, 1, 0, 0])))

    assert plan.items[0].place == Plain(1.0, 0.0, 0.0)


def test_inclusion_false_is_an_exclusion_zone() -> None:
    document = box()
    corners = [[47.0, 8.0], [47.1, 8.0], [47.1, 8.1]]
    document["geoFence"]["polygons"] = [{"inclusion": False, "polygon": corners, "version": 1}]
    circle = {"center": [47.0, 8.0], "radius": 25.5}
    document["geoFence"]["circles"] = [{"inclusion": True, "circle": circle, "version": 1}]

    polygon, ring = read_json(document).fence.zones

    assert not polygon.inclusion
    assert polygon.shape == Polygon((LatLon(47.0, 8.0), LatLon(47.1, 8.0), LatLon(47.1, 8.1)))
    assert ring.inclusion
    assert ring.shape == Circle(LatLon(47.0, 8.0), 25.5)


def test_a_ring_that_is_closed_by_its_first_corner_is_the_same_polygon() -> None:
    corners = [[47.0, 8.0], [47.1, 8.0], [47.1, 8.1]]
    document = box()
    ring = {"inclusion": True, "polygon": [*corners, corners[0]], "version": 1}
    document["geoFence"]["polygons"] = [ring]
    shape = read_json(document).fence.zones[0].shape
    assert isinstance(shape, Polygon)
    assert [list(corner) for corner in shape.corners] == corners


def test_a_home_without_height_is_kept_without_height() -> None:
    document = box()
    document["mission"]["plannedHomePosition"][2] = None

    assert read_json(document).home == Geodetic(47.397742, 8.545594, None)


def _set(*path: str | int, to: object) -> Change:
    def change(document: dict[str, Any]) -> None:
        node: Any = document
        for key in path[:-1]:
            node = node[key]
        node[path[-1]] = to

    return change


def _drop(*path: str | int) -> Change:
    def change(document: dict[str, Any]) -> None:
        node: Any = document
        for key in path[:-1]:
            node = node[key]
        del node[path[-1]]

    return change


ITEM = ("mission", "items", 1)


@pytest.mark.parametrize(
    ("change", "where", "words"),
    [
        (_set("fileType", to="Params"), "fileType", ['"Params"', '"Plan"']),
        (_set("version", to=42), "version", ["42", "expected 1"]),
        (_set("version", to=True), "version", ["true", "expected 1"]),
        (_set("mission", "version", to=7), "mission.version", ["7", "expected 2"]),
        (_drop("mission", "items"), "mission.items", ["missing"]),
        (_set("mission", "items", to={}), "mission.items", ["a list"]),
        (_set(*ITEM, "command", to="16"), "mission.items[1].command", ['"16"', "a number"]),
        (_set(*ITEM, "command", to=1.5), "mission.items[1].command", ["whole"]),
        (_set(*ITEM, "frame", to=8), "mission.items[1]", ["frame 8", "above home"]),
        (_set(*ITEM, "frame", to=2), "mission.items[1]", ["frame 2"]),
        (_set(*ITEM, "params", to=[0] * 6), "mission.items[1].params", ["6 elements", "7"]),
        (_set(*ITEM, "params", 4, to=91.0), "mission.items[1]", ["latitude 91"]),
        (_set(*ITEM, "params", 4, to="x"), "mission.items[1].params[4]", ['"x"', "a number"]),
        (_set(*ITEM, "params", 0, to=10**400), "mission.items[1].params[0]", ["a number"]),
        (_set(*ITEM, "doJumpId", to=1), "mission.items[1].doJumpId", ["also", "items[0]"]),
        (_set(*ITEM, "type", to="Simple"), "mission.items[1].type", ['"Simple"', "ComplexItem"]),
        (_set("mission", "plannedHomePosition", to=[1, 2]), "mission.plannedHomePosition", ["3"]),
        (_set("rallyPoints", "version", to=3), "rallyPoints.version", ["1 or 2"]),
        (_set("geoFence", "version", to=3), "geoFence.version", ["expected 2"]),
    ],
)
def test_what_is_wrong_is_refused_with_its_path(
    change: Change, where: str, words: list[str]
) -> None:
    document = box()
    change(document)

    error = refused(document)

    assert error.where == where
    assert str(error).startswith(f"a.plan:{where}: ")
    for word in words:
        assert word in str(error)


def test_a_survey_of_an_unknown_version_is_refused() -> None:
    document = survey()
    document["mission"]["items"][1]["version"] = 9

    error = refused(document)

    assert error.where == "mission.items[1].version"
    assert error.expected == "4 or 5"


@pytest.mark.parametrize("items", [None, []])
def test_a_survey_that_is_only_a_polygon_is_refused_and_not_guessed(
    items: list[object] | None,
) -> None:
    document = survey()
    style = document["mission"]["items"][1]["TransectStyleComplexItem"]
    if items is None:
        del style["Items"]
    else:
        style["Items"] = items

    error = refused(document)

    assert error.where == "mission.items[1].TransectStyleComplexItem.Items"


def test_a_structure_scan_is_refused_because_its_path_is_not_in_the_file() -> None:
    document = survey()
    document["mission"]["items"][1]["complexItemType"] = "StructureScan"

    assert "polygon" in str(refused(document))


def test_an_old_fence_with_corners_is_refused_with_a_hint() -> None:
    document = box()
    document["geoFence"] = {"version": 1, "polygon": [[47.0, 8.0]]}

    error = refused(document)

    assert error.where == "geoFence.version"
    assert "ignored elsewhere" in str(error)
    assert error.hint


def test_an_old_fence_without_corners_holds_nothing_to_lose() -> None:
    document = box()
    document["geoFence"] = {"version": 1, "polygon": []}

    assert [note.where for note in read_json(document).notes] == ["geoFence"]


@pytest.mark.parametrize(
    ("data", "where"),
    [
        (b'{"fileType": "Plan",\n "version": }', "2:13"),
        (b'{"fileType": NaN}', ""),
        (b'{"version": 1, "version": 1}', ""),
        (b'{"name": "\xff"}', "1"),
        (b'{"a": ' + b"[" * 100_000, ""),
    ],
)
def test_what_is_no_json_is_refused_where_it_stops(data: bytes, where: str) -> None:
    with pytest.raises(PlanError) as caught:
        read("a.plan", data)

    assert caught.value.where == where


def test_a_byte_order_mark_does_not_matter() -> None:
    assert read("a.plan", b"\xef\xbb\xbf" + json.dumps(box()).encode()) == read_json(box())


@pytest.mark.parametrize(
    ("name", "where", "what"),
    [
        ("wrong_overall_version", "version", "is 42"),
        ("wrong_mission_version", "mission.version", "is 7"),
        ("with_survey_wrong_version", "mission.items[1].version", "is 9"),
        (
            "with_survey_missing_items",
            "mission.items[1].TransectStyleComplexItem.Items",
            "is missing",
        ),
        ("with_structured_scan", "mission.items[1].complexItemType", "as a polygon"),
    ],
)
def test_real_files_that_cannot_be_flown_are_refused(name: str, where: str, what: str) -> None:
    path = elsewhere("plans", f"qgroundcontrol_sample_{name}.plan")

    with pytest.raises(PlanError) as caught:
        read(path.name, path.read_bytes())

    assert caught.value.where == where
    assert what in caught.value.what


@pytest.mark.parametrize(
    ("name", "items", "zones", "rally"),
    [
        ("MC_mission_box", 6, 0, 0),
        ("ce_geofence_outfield", 0, 2, 0),
        ("example-mission", 5, 0, 2),
        ("multicopter_mission_geofence_avoid", 5, 3, 0),
        ("qgroundcontrol_sample", 6, 0, 0),
        ("qgroundcontrol_sample_with_digicam_control", 1, 0, 0),
        ("qgroundcontrol_sample_with_survey", 13, 0, 0),
        ("qgroundcontrol_sample_without_mission", 0, 0, 0),
    ],
)
def test_real_files_are_read(name: str, items: int, zones: int, rally: int) -> None:
    path = elsewhere("plans", f"{name}.plan")

    plan = read(path.name, path.read_bytes())

    assert (len(plan.items), len(plan.fence.zones), len(plan.rally)) == (items, zones, rally)
