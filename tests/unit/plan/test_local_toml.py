"""Missions in metres from the take-off point."""

from __future__ import annotations

import math

import pytest

from gcs.gate.airspace.projection import Origin, Projection
from gcs.plan.errors import PlanError
from gcs.plan.model import (
    Circle,
    EastNorth,
    Frame,
    Geodetic,
    Geographic,
    LatLon,
    Local,
    Plain,
    Polygon,
)
from gcs.plan.place import georeference
from gcs.plan.zones import zone_specs
from tests.unit.plan.samples import LOCAL, read_text


def test_a_flight_is_take_off_speed_waypoints_picture_and_landing() -> None:
    plan = read_text(LOCAL, name="a.toml")

    assert [item.command for item in plan.items] == [22, 178, 16, 2000, 93, 16, 21]
    assert plan.items[0].place == Local(0.0, 0.0, 1.5)
    assert plan.items[2].place == Local(1.0, 2.0, 1.5)
    assert plan.items[2].params[0] == 1.0
    assert math.isnan(plan.items[2].params[3])
    assert plan.items[-1].place == Local(-1.0, 0.0, 0.0)
    assert [item.where for item in plan.items] == ["1", "4", "6", "11", "11", "13", "1"]
    assert [item.do_jump_id for item in plan.items] == [1, 2, 3, 4, 5, 6, 7]


def test_its_fence_is_a_box_with_an_exclusion_circle() -> None:
    box, hole = read_text(LOCAL, name="a.toml").fence.zones

    assert box.inclusion
    assert isinstance(box.shape, Polygon)
    assert box.shape.corners[1] == EastNorth(5.0, -5.0)
    assert (box.floor_above_home_m, box.ceiling_above_home_m) == (0.0, 2.0)
    assert not hole.inclusion
    assert hole.shape == Circle(EastNorth(3.0, 3.0), 1.0)
    assert [spec.frame for spec in zone_specs(read_text(LOCAL, name="a.toml").fence)] == [
        "home"
    ] * 2


@pytest.mark.parametrize(("end", "commands"), [("return", [20]), ("hold", []), ("land", [21])])
def test_how_it_ends_is_said(end: str, commands: list[int]) -> None:
    plan = read_text(f'end = "{end}"\n' + LOCAL, name="a.toml")

    assert [item.command for item in plan.items][6:] == commands


def test_placed_on_earth_it_counts_above_home_and_comes_back_to_the_metre() -> None:
    origin = Origin(47.397742, 8.545594, 488.0)
    projection = Projection(origin, "px4")
    home = Geodetic(47.4, 8.5, 490.0)

    plan = georeference(read_text(LOCAL, name="a.toml"), projection.lat_lon, (10.0, 20.0), home)

    place = plan.items[2].place
    assert isinstance(place, Geographic)
    assert plan.items[2].frame is Frame.HOME
    assert place.alt_m == 1.5
    assert projection.north_east(place.lat_deg, place.lon_deg) == pytest.approx((11, 22), abs=0.01)
    assert plan.home == home
    assert all(isinstance(item.place, Geographic | Plain) for item in plan.items)
    assert isinstance(plan.fence.zones[0].shape, Polygon)
    assert isinstance(plan.fence.zones[0].shape.corners[0], LatLon)


@pytest.mark.parametrize(
    ("old", "new", "where", "words"),
    [
        ("schema = 1", "schema = 2", "1", ["schema", "2"]),
        ("schema = 1\n", "", "1", ["schema", "missing"]),
        ('"home"', '"local"', "3", ["frame", "home"]),
        ('frame = "home"\n', "", "1", ["frame", "missing"]),
        ("up_m = 1.5", "up = 1.5", "6", ["up_m", "missing"]),
        ("up_m = 1.5", 'up_m = "high"', "9", ["up_m", "number"]),
        ("up_m = 1.5", "up_m = nan", "9", ["up_m", "finite"]),
        ("hold_s = 1.0", "hold_s = -1.0", "10", ["hold_s"]),
        ("hold_s = 1.0", "holds = 1.0", "10", ["holds", "unknown"]),
        ("picture = true", 'picture = "yes"', "11", ["picture"]),
        ("[-5, 5]", "[5, -5]", "19", ["north_m", "empty"]),
        ("[0, 2]", "[0, 2, 3]", "21", ["up_m", "pair"]),
        ("speed_m_s = 2.0", "speed_m_s = 2,0", "4", ["TOML"]),
        ("speed_m_s = 2.0", f"speed_m_s = {10**400}", "4", ["speed_m_s", "too large"]),
        ("radius_m = 1.0", "radius_m = 0.0", "24", ["radius_m"]),
    ],
)
def test_what_is_wrong_is_refused_with_its_line(
    old: str, new: str, where: str, words: list[str]
) -> None:
    with pytest.raises(PlanError) as caught:
        read_text(LOCAL.replace(old, new, 1), name="a.toml")

    assert caught.value.where == where
    for word in words:
        assert word in str(caught.value)


def test_a_mistyped_key_is_told_what_it_might_be() -> None:
    with pytest.raises(PlanError) as caught:
        read_text(LOCAL.replace("hold_s", "holds_s"), name="a.toml")

    assert "hold_s" in caught.value.hint


def test_a_mission_without_a_waypoint_is_none() -> None:
    with pytest.raises(PlanError, match="waypoint"):
        read_text('schema = 1\nframe = "home"\n', name="a.toml")


@pytest.mark.parametrize(
    ("old", "new", "meant"),
    [
        ("up_m = 1.5", "up = 1.5", "`up` is unknown here: did you mean up_m?"),
        ("schema = 1", "shema = 1", "`shema` is unknown here: did you mean schema?"),
        ("up_m = 1.5\n", "", "up_m = a number"),
    ],
)
def test_a_key_that_is_missing_is_looked_for_under_another_name(
    old: str, new: str, meant: str
) -> None:
    with pytest.raises(PlanError, match="missing") as caught:
        read_text(LOCAL.replace(old, new, 1), name="a.toml")

    assert caught.value.hint == meant
