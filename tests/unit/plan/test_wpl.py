"""QGC WPL 110: home at item 0 or not, sequence, and the traps of a hand-edited table."""

from __future__ import annotations

import math

import pytest

from gcs.plan.errors import Level, PlanError
from gcs.plan.formats.reader import read
from gcs.plan.formats.wpl_writer import write_wpl
from gcs.plan.model import AutopilotName, Circle, Frame, Geodetic, Geographic, LatLon, Polygon
from tests.sample_files import elsewhere
from tests.unit.plan.samples import read_text, wpl

HOME = "0 1 0 16 0 0 0 0 -35.363262 149.165237 584 1"
TAKEOFF = "1 0 3 22 0 0 0 0 -35.363 149.165 20 1"
FIRST = "2 0 3 16 0 0 0 0 -35.362 149.165 20 1"
JUMP = "3 0 2 177 2 1 0 0 0 0 0 1"
LAND = "4 0 3 21 0 0 0 0 -35.363 149.165 0 1"
WITH_HOME = wpl(HOME, TAKEOFF, FIRST, JUMP, LAND)
WITHOUT_HOME = wpl(
    "0 1 3 22 0 0 0 0 -35.363 149.165 20 1",
    "1 0 3 16 0 0 0 0 -35.362 149.165 20 1",
    "2 0 2 177 1 1 0 0 0 0 0 1",
)


def refused(text: str, autopilot: AutopilotName | None = None) -> PlanError:
    with pytest.raises(PlanError) as caught:
        read_text(text, autopilot)
    return caught.value


@pytest.mark.parametrize("autopilot", ["ardupilot", "px4", None])
def test_home_before_a_take_off_is_home_for_everyone(autopilot: AutopilotName | None) -> None:
    plan = read_text(WITH_HOME, autopilot)

    assert plan.home == Geodetic(-35.363262, 149.165237, 584.0)
    assert [item.command for item in plan.items] == [22, 16, 177, 21]
    assert [item.do_jump_id for item in plan.items] == [1, 2, 3, 4]
    assert plan.items[2].params[0] == 2.0
    assert [(n.level, n.where, n.item) for n in plan.notes] == [(Level.NOTE, "2", "item 0")]


@pytest.mark.parametrize("autopilot", ["ardupilot", None])
def test_a_home_of_0_0_is_none_and_its_row_is_not_flown(autopilot: AutopilotName | None) -> None:
    plan = read_text(wpl("0 1 0 16 0 0 0 0 0 0 0 1", TAKEOFF, FIRST, JUMP, LAND), autopilot)

    assert plan.home is None
    assert plan.firmware == "ardupilot"
    assert [item.command for item in plan.items] == [22, 16, 177, 21]
    assert plan.items[2].params[0] == 2.0
    (note,) = plan.notes
    assert (note.level, note.what) == (
        Level.NOTE,
        "is where home goes, and is 0, 0: no home was given",
    )


@pytest.mark.parametrize("command", [5005, 5010, 5101])
def test_a_part_of_a_fence_of_another_kind_is_no_mission_item(command: int) -> None:
    error = refused(wpl(f"0 0 0 {command} 40 0 0 0 47.0 8.0 0 1"))

    assert error.where == "2"
    assert "of a fence or of rally points of a kind that is not known" in error.what


def test_without_home_the_jump_still_goes_to_the_same_item() -> None:
    plan = read_text(WITHOUT_HOME, "px4")

    assert plan.home is None
    assert plan.items[2].params[0] == plan.items[1].do_jump_id == 2
    assert plan.notes == ()


def test_an_ardupilot_file_without_home_is_told_and_loses_no_item() -> None:
    plan = read_text(WITHOUT_HOME, "ardupilot")

    assert len(plan.items) == 3
    assert "is not home" in plan.notes[0].what


def test_a_px4_file_that_begins_with_a_bare_waypoint_is_flown_whole_and_told() -> None:
    text = wpl(HOME, "1 0 0 16 0 0 0 0 -35.362 149.165 600 1")

    px4, ardupilot = read_text(text, "px4"), read_text(text, "ardupilot")

    assert (len(px4.items), px4.home) == (2, None)
    assert px4.notes[0].level is Level.WARNING
    assert (len(ardupilot.items), ardupilot.home is not None) == (1, True)


def test_comments_blank_lines_crlf_and_a_byte_order_mark_are_no_trouble() -> None:
    lines = WITH_HOME.replace("\n", "\r\n").splitlines(keepends=True)
    text = "\ufeff# drawn by hand\r\n" + lines[0] + "\r\n# home\r\n" + "".join(lines[1:])

    plan = read_text(text.replace("584", "584  # the ground\t", 0))

    assert plan == read_text(WITH_HOME)
    assert plan.items[0].where == "6"


def test_frames_of_the_wire_are_frames_of_the_file() -> None:
    plan = read_text(wpl("0 1 5 22 0 0 0 0 47 8 500 1", "1 0 6 16 0 0 0 0 47 8 20 1"))

    assert [item.frame for item in plan.items] == [Frame.AMSL, Frame.HOME]


@pytest.mark.parametrize(
    ("text", "where", "words"),
    [
        ("QGC WPL 120\n0 1\n", "1", ["QGC WPL 120", "QGC WPL 110"]),
        ("QGC WPL 100\n0 3 16 0 0 0 0 1 8 47 9 0 1\n", "2", ["no action", "2, 3, 4"]),
        ("QGC WPL PB 110\nwaypoint {\nseq: 0\n}\n", "2", ["has no current, frame"]),
        ("QGC WPL PB 110\nwaypoint {\nseq: 0\n", "2", ["has no end"]),
        ("QGC WPL PB 110\nwaypoint {\nhue: 0\n}\n", "3", ["hue", "one of seq"]),
        (wpl(HOME, TAKEOFF, TAKEOFF), "4", ["1 follows 1", "repeats", "expected 2"]),
        (wpl(HOME, FIRST, TAKEOFF), "4", ["1 follows 2", "steps back"]),
        (wpl(HOME, "1 0 3 16 0 0 0 0 -35,362 149,165 20 1"), "3", ["lat", '"-35,362"']),
        (wpl(HOME, "1 0 3 16 0 0 0 -35.362 149.165 20 1"), "3", ["11 fields", "12"]),
        (wpl(HOME, "1 0 3 16 0 0 0 0 -35.362 249.165 20 1"), "3", ["longitude 249"]),
        (wpl(HOME, "1 0 3 16 inf 0 0 0 -35.362 149.165 20 1"), "3", ["p1", '"inf"']),
        (wpl(HOME, "1 0 3 16.5 0 0 0 0 -35.362 149.165 20 1"), "3", ["command", "whole"]),
        (wpl(HOME, "1 0 3 1_6 0 0 0 0 -35.362 149.165 20 1"), "3", ["command", '"1_6"']),
        (wpl(HOME, "nan 0 3 16 0 0 0 0 -35.362 149.165 20 1"), "3", ["seq"]),
        (wpl(HOME, "1 0 3 16 1e999 0 0 0 -35.362 149.165 20 1"), "3", ["p1"]),
        (wpl(HOME, TAKEOFF, "2 0 2 177 9 1 0 0 0 0 0 1"), "4", ["seq 9"]),
        (wpl(HOME, TAKEOFF, "2 0 2 177 0 1 0 0 0 0 0 1"), "4", ["seq 0"]),
        (wpl("0 0 0 5001 4 0 0 0 47 8 0 1", "1 0 0 5001 4 0 0 0 47 8 0 1"), "2", ["2 corners"]),
        (wpl("0 0 0 5001 2 0 0 0 47 8 0 1", "1 0 0 5001 2 0 0 0 47 8 0 1"), "2", ["corner count"]),
        (wpl("0 0 0 5003 0 0 0 0 47 8 0 1"), "2", ["radius 0"]),
    ],
)
def test_traps_are_refused_with_their_line(text: str, where: str, words: list[str]) -> None:
    error = refused(text, "ardupilot")

    assert error.where == where
    assert str(error).startswith(f"a.txt:{where}: ")
    for word in words:
        assert word in str(error)


def test_a_decimal_comma_gets_a_hint() -> None:
    text = wpl(HOME, "1 0 3 16 0 0 0 0 -35,362 149,165 20 1")

    assert "a point" in refused(text).hint


def test_a_gap_in_seq_is_told_and_jumps_keep_their_target() -> None:
    text = wpl(HOME, TAKEOFF, "5 0 3 16 0 0 0 0 -35.362 149.165 20 1", "6 0 2 177 5 1 0 0 0 0 0 1")

    plan = read_text(text, "ardupilot")

    assert plan.items[2].params[0] == plan.items[1].do_jump_id == 2
    assert [(n.where, n.level) for n in plan.notes] == [("4", Level.WARNING), ("2", Level.NOTE)]


def test_nan_as_text_is_read_as_unset_and_told() -> None:
    plan = read_text(wpl("0 1 3 22 0 0 0 NaN 47.0 8.0 20 1"), "px4")

    assert math.isnan(plan.items[0].params[3])
    assert [(n.where, n.item) for n in plan.notes] == [("2", "p4")]


def test_fence_and_rally_items_are_no_part_of_the_mission() -> None:
    text = wpl(
        "0 0 0 5000 0 0 0 0 47.0 8.0 30 1",
        "1 0 0 5002 3 0 0 0 47.0 8.0 0 1",
        "2 0 0 5002 3 0 0 0 47.1 8.0 0 1",
        "3 0 0 5002 3 0 0 0 47.1 8.1 0 1",
        "4 0 0 5003 40 0 0 0 47.0 8.0 0 1",
        "5 0 0 5100 0 0 0 0 47.0 8.0 25 1",
    )

    plan = read_text(text)

    assert plan.items == ()
    polygon, circle = plan.fence.zones
    assert (polygon.inclusion, circle.inclusion) == (False, True)
    assert isinstance(polygon.shape, Polygon)
    assert polygon.shape.corners[1] == LatLon(47.1, 8.0)
    assert circle.shape == Circle(LatLon(47.0, 8.0), 40.0)
    assert plan.rally[0].alt_above_home_m == 25.0
    assert plan.fence.breach_return is not None


def test_the_same_plan_is_written_with_home_for_ardupilot_and_without_for_px4() -> None:
    plan = read_text(WITH_HOME, "ardupilot")

    ardupilot = write_wpl(plan, "ardupilot").data.decode().splitlines()
    px4 = write_wpl(plan, "px4")

    assert len(ardupilot) == 6
    assert ardupilot[1].split()[8:11] == ["-35.363262", "149.165237", "584.0"]
    assert ardupilot[4].split()[4] == "2.0"
    assert px4.data.decode().splitlines()[3].split()[3:5] == ["177", "1.0"]
    assert "home" in [finding.item for finding in px4.lost]


def test_an_ardupilot_file_is_not_written_without_home() -> None:
    with pytest.raises(PlanError, match="home"):
        write_wpl(read_text(WITHOUT_HOME, "px4"), "ardupilot")


@pytest.mark.parametrize(
    ("folder", "name", "items", "has_home"),
    [
        ("wpl", "mpmission.txt", 6, True),
        ("wpl", "cmac-foamy-mission-cw.txt", 11, True),
        ("wpl", "mission_planner_sample.txt", 4, False),
        ("fences", "fence-110.txt", 0, False),
        ("rally", "rally-110.txt", 0, False),
    ],
)
def test_real_files_are_read(folder: str, name: str, items: int, has_home: bool) -> None:
    path = elsewhere(folder, name)

    plan = read(path.name, path.read_bytes(), "ardupilot")

    assert (len(plan.items), plan.home is not None) == (items, has_home)


def test_a_real_jump_keeps_its_target() -> None:
    path = elsewhere("wpl", "cmac-foamy-mission-cw.txt")

    plan = read(path.name, path.read_bytes(), "ardupilot")

    target = plan.index_of(plan.items[5].params[0])
    assert target == 1
    assert plan.items[target].place == Geographic(-35.364563, 149.163773, 60.0)


def test_a_table_of_more_items_than_any_vehicle_stores_is_refused_at_once() -> None:
    error = refused(wpl(*[FIRST] * 10_001))
    assert "at most 10000 items" in str(error)
