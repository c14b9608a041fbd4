"""What lint says of a plan, with the item that it says it of."""

from __future__ import annotations

from typing import Any

import pytest

from gcs.plan.errors import Finding, Level
from gcs.plan.formats.reader import read
from gcs.plan.lint import lint
from gcs.plan.model import AutopilotName, Geodetic
from tests.sample_files import elsewhere
from tests.unit.plan.samples import (
    LOCAL,
    box,
    plan_document,
    read_json,
    read_text,
    simple,
    survey,
    waypoint,
)

TAKEOFF = waypoint(1, 47.39775, 8.5456, 10, command=22)
AWAY = waypoint(2, 47.39785, 8.5456, 10)


def findings(*items: dict[str, Any], who: AutopilotName = "px4") -> list[Finding]:
    return lint(read_json(plan_document(*items)), who)


def only(found: list[Finding]) -> Finding:
    assert len(found) == 1, found
    return found[0]


def test_good_plans_are_clean() -> None:
    assert lint(read_json(box()), "px4") == []
    assert lint(read_json(survey()), "px4") == []
    assert lint(read_text(LOCAL, name="a.toml"), "px4") == []


@pytest.mark.parametrize(
    ("jump", "words"),
    [
        ([3, 1], "itself"),
        ([9, 1], "not there"),
        ([0, 1], "before the start"),
        ([2, -2], "repeat count"),
        ([2, 1.5], "repeat count"),
    ],
)
def test_bad_jumps(jump: list[float | None], words: str) -> None:
    found = only(findings(TAKEOFF, AWAY, simple(3, 177, 2, [*jump, 0, 0, 0, 0, 0])))

    assert (found.level, found.index, found.item) == (Level.ERROR, 2, "item 3 (DO_JUMP)")
    assert words in found.what


@pytest.mark.parametrize(
    ("tags", "jump", "index", "words"),
    [
        ([7], [9, 1], 3, "jumps to tag 9, which no JUMP_TAG has"),
        ([1.5], [1.5, 1], 2, "its tag is 1.5"),
        ([70000], [70000, 1], 2, "its tag is 70000"),
        ([7], [7, 1.5], 3, "repeat count"),
        ([7, 7], [7, 1], 3, "its tag 7 is that of item 3 too"),
    ],
)
def test_bad_tags(tags: list[float], jump: list[float | None], index: int, words: str) -> None:
    marks = [simple(3, 600, 2, [tag, 0, 0, 0, 0, 0, 0]) for tag in tags]
    again = simple(9, 601, 2, [*jump, 0, 0, 0, 0, 0])
    found = findings(*in_order(TAKEOFF, AWAY, *marks, AWAY, again), who="ardupilot")
    (error,) = [each for each in found if each.level is Level.ERROR]
    assert words in error.what
    assert error.index == index + (words[:5] in ("jumps", "repea"))


def test_a_loop_to_a_tag_without_a_waypoint() -> None:
    marks, again = (
        simple(3, 600, 2, [7, 0, 0, 0, 0, 0, 0]),
        simple(4, 601, 2, [7, 5, 0, 0, 0, 0, 0]),
    )
    found = findings(*in_order(TAKEOFF, AWAY, marks, again), who="ardupilot")
    assert "without a waypoint" in only([f for f in found if f.level is Level.ERROR]).what


def test_a_load_that_is_put_down_is_refused_with_its_reason() -> None:
    put_down = waypoint(3, 47.39785, 8.5456, 10, command=94)
    found = findings(TAKEOFF, AWAY, put_down, who="ardupilot")
    (error,) = [each for each in found if each.level is Level.ERROR]
    assert error.item == "item 3 (NAV_PAYLOAD_PLACE)"
    assert "descends by itself until it feels the ground" in error.what


def test_a_loop_without_a_waypoint() -> None:
    found = findings(
        TAKEOFF,
        AWAY,
        simple(3, 178, 2, [1, 3, -1, 0, 0, 0, 0]),
        simple(4, 177, 2, [3, 5, 0, 0, 0, 0, 0]),
    )

    assert "without a waypoint" in only(found).what


LAND = simple(9, 21, 3, [0, 0, 0, 0, 47.39785, 8.5456, 0])
BACK = simple(9, 20, 2, [0] * 7)


def in_order(*items: dict[str, Any]) -> list[dict[str, Any]]:
    return [item | {"doJumpId": number} for number, item in enumerate(items, start=1)]


@pytest.mark.parametrize(
    ("items", "index", "words"),
    [
        ([AWAY, TAKEOFF, AWAY, BACK], 1, "a take-off must be the first item that is flown"),
        ([TAKEOFF, TAKEOFF, AWAY, BACK], 1, "a take-off must be the first item that is flown"),
        ([LAND, AWAY], 0, "a landing must not be the first item that is flown"),
    ],
)
def test_what_px4_stores_and_never_starts(
    items: list[dict[str, Any]], index: int, words: str
) -> None:
    found = [f for f in findings(*in_order(*items)) if "never starts the mission" in f.what]
    assert [(f.level, f.index) for f in found] == [(Level.WARNING, index)]
    assert words in found[0].what


def test_no_px4_climbs_first_to_a_landing() -> None:
    assert not [f for f in findings(*in_order(LAND, AWAY, BACK)) if "climbs first" in f.hint]


def test_an_ardupilot_s_landing_ends_the_flight_unless_it_is_the_last() -> None:
    def told(*items: dict[str, Any]) -> list[int | None]:
        found = findings(*in_order(*items), who="ardupilot")
        return [f.index for f in found if "lands and stops its motors" in f.what]

    assert told(TAKEOFF, AWAY, LAND, AWAY, BACK) == [2]
    assert told(TAKEOFF, AWAY, LAND) == []
    assert told(TAKEOFF, AWAY, LAND, simple(4, 2001, 2, [0] * 7)) == []


def test_that_a_px4_takes_off_again_after_a_landing_is_told() -> None:
    (found,) = findings(*in_order(TAKEOFF, AWAY, LAND, AWAY, BACK))
    assert (found.level, found.index) == (Level.WARNING, 2)
    assert found.what == "lands, and takes off again by itself for what follows"
    assert findings(*in_order(TAKEOFF, AWAY, LAND)) == []


@pytest.mark.parametrize(
    ("to", "words"),
    [
        (6, "always goes on with item 6; items 4 to 5 are only reached by another jump"),
        (5, "always goes on with item 5; item 4 is only reached by another jump"),
        (4, "goes on with the next item, as if it were not there"),
    ],
)
def test_a_jump_ahead_for_ever_repeats_nothing(to: int, words: str) -> None:
    jump = simple(3, 177, 2, [to, -1, 0, 0, 0, 0, 0])
    found = findings(*in_order(TAKEOFF, AWAY, jump, AWAY, AWAY, BACK))
    assert only(found).what == words


def test_a_jump_for_ever_hides_what_follows() -> None:
    last = waypoint(4, 47.39775, 8.5456, 0, command=21)
    found = only(findings(TAKEOFF, AWAY, simple(3, 177, 2, [2, -1, 0, 0, 0, 0, 0]), last))

    assert (found.level, "never flown" in found.what) == (Level.WARNING, True)


@pytest.mark.parametrize(("who", "level"), [("px4", Level.ERROR), ("ardupilot", Level.WARNING)])
def test_a_waypoint_at_0_0(who: AutopilotName, level: Level) -> None:
    document = plan_document(TAKEOFF, waypoint(2, 0, 0, 10))
    document["mission"]["firmwareType"] = {"px4": 12, "ardupilot": 3}[who]

    found = only(lint(read_json(document), who))

    assert (found.level, found.index) == (level, 1)


def test_what_a_multirotor_flies_is_not_called_unknown() -> None:
    land_start, to_alt = simple(3, 189, 2, [0] * 7), waypoint(4, 47.39785, 8.5456, 20, command=31)
    for who in ("px4", "ardupilot"):
        found = lint(read_json(plan_document(TAKEOFF, AWAY, land_start, to_alt)), who)
        assert [
            f for f in found if f.level is not Level.WARNING or "written for" not in f.what
        ] == []


def test_an_ardupilot_on_the_ground_does_not_start_without_a_take_off() -> None:
    document = plan_document(AWAY)
    document["mission"]["firmwareType"] = 3
    found = only(lint(read_json(document), "ardupilot"))
    assert (found.level, "will not start" in found.hint) == (Level.WARNING, True)


@pytest.mark.parametrize(("enable", "count"), [(0, 1), (2, 1), (1, 0)])
def test_a_mission_that_switches_the_vehicle_s_fence_off_is_warned_of(
    enable: int, count: int
) -> None:
    document = plan_document(TAKEOFF, AWAY, simple(3, 207, 2, [enable, 0, 0, 0, 0, 0, 0]))
    document["mission"]["firmwareType"] = 3
    found = lint(read_json(document), "ardupilot")
    assert ["fence off" in f.what for f in found] == [True] * count


def test_a_landing_at_0_0_is_here() -> None:
    assert findings(TAKEOFF, AWAY, waypoint(3, 0, 0, 0, command=21)) == []


@pytest.mark.parametrize(
    ("items", "level", "words"),
    [
        ([AWAY], Level.NOTE, "no take-off"),
        ([TAKEOFF, waypoint(2, 47.39785, 8.5456, -3)], Level.WARNING, "3 m lower than home"),
        ([TAKEOFF, waypoint(2, 47.39785, 8.5456, 600)], Level.WARNING, "600 m above home"),
        ([TAKEOFF, waypoint(2, 47.39785, 8.5806, 10)], Level.WARNING, "2.6 km from item 1"),
        ([TAKEOFF, waypoint(2, 8.5456, 47.39785, 10)], Level.ERROR, "km from item 1"),
        ([TAKEOFF, simple(2, 16, 0, [0, 0, 0, 0, 47.3978, 8.5456, 100])], Level.ERROR, "388.0 m"),
        ([TAKEOFF, simple(2, 16, 10, [0, 0, 0, 0, 47.3978, 8.5456, 9])], Level.WARNING, "terrain"),
        ([TAKEOFF, simple(2, 30001, 2, [0] * 7)], Level.ERROR, "verified here"),
        ([TAKEOFF, waypoint(2, 47.39785, 8.5456, 10, 82)], Level.WARNING, "refuses this item"),
        ([TAKEOFF, simple(2, 114, 2, [5] * 7)], Level.WARNING, "never starts the mission"),
        ([TAKEOFF, simple(2, 179, 2, [1, 0, 0, 0, 0, 0, 0])], Level.WARNING, "moves home"),
        ([TAKEOFF, simple(2, 20, 2, [0] * 7), AWAY | {"doJumpId": 3}], Level.WARNING, "ends the"),
    ],
)
def test_doubtful_items(items: list[dict[str, Any]], level: Level, words: str) -> None:
    found = only(findings(*items))

    assert found.level is level
    assert words in found.what
    assert found.where.startswith("mission.items[")


def test_an_altitude_that_is_not_set() -> None:
    document = box()
    document["mission"]["items"][0]["params"][6] = None
    plan = read_json(document)

    assert only(lint(plan, "px4")).level is Level.WARNING
    assert Level.ERROR in [found.level for found in lint(plan, "ardupilot")]


def test_a_plan_for_the_other_autopilot_is_told() -> None:
    assert "written for px4" in only(lint(read_json(box()), "ardupilot")).what


def test_where_the_vehicle_stands_counts_more_than_the_planned_home() -> None:
    document = plan_document(TAKEOFF, simple(2, 16, 0, [0, 0, 0, 0, 47.3978, 8.5456, 500]))
    plan = read_json(document)

    assert lint(plan, "px4") == []
    assert "underground" in only(lint(plan, "px4", Geodetic(47.3977, 8.5456, 550.0))).what


@pytest.mark.parametrize(
    ("corners", "words"),
    [
        ([[0, 0], [1, 1], [1, 0], [0, 1]], "intersects itself"),
        ([[0, 0], [1, 0], [1, 0], [0, 1]], "same point"),
        ([[0, 0], [1, 0], [2, 0]], "lie on each other"),
    ],
)
def test_a_fence_that_is_no_polygon(corners: list[list[float]], words: str) -> None:
    document = box()
    places = [[47.3977 + 1e-4 * north, 8.5456 + 1e-4 * east] for north, east in corners]
    document["geoFence"]["polygons"] = [{"inclusion": True, "polygon": places, "version": 1}]

    found = only(lint(read_json(document), "px4"))

    assert (found.level, found.item) == (Level.ERROR, "fence zone 1")
    assert found.where == "geoFence.polygons[0]"
    assert words in found.what


@pytest.mark.parametrize(
    ("corners", "told"),
    [
        ([[80, 0], [80, 90], [80, 180], [80, -90]], ["it goes round a pole"]),
        ([[-80, 0], [-80, -120], [-80, 120], [-80, 0]], ["it goes round a pole"]),
        ([[10, 179], [10, -179], [11, 180]], []),  # over the date line alone
    ],
)
def test_a_fence_round_a_pole_is_called_so(corners: list[list[float]], told: list[str]) -> None:
    """As degrees of a plane its edges would lie on each other."""
    document = box()
    document["geoFence"]["polygons"] = [{"inclusion": True, "polygon": corners, "version": 1}]

    found = [each for each in lint(read_json(document), "px4") if each.level is Level.ERROR]

    assert [each.what.partition(",")[0] for each in found] == told


def test_the_real_file_that_is_underground_is_called_so() -> None:
    path = elsewhere("wpl", "mission_planner_sample.txt")

    found = lint(read(path.name, path.read_bytes()), "px4", Geodetic(47.3977, 8.5456, 488.0))

    underground = [finding.where for finding in found if "underground" in finding.what]
    assert underground == ["2", "3", "4"]


def test_without_a_home_amsl_heights_are_told_to_be_unchecked() -> None:
    plan = read_text("QGC WPL 110\n0 1 0 22 0 0 0 0 47.3977 8.5456 500 1\n", "px4")

    assert "home is not known" in only(lint(plan, "px4")).what
