"""Every file of `tests/samples`: what is read out of it, or where it is refused and why."""

from __future__ import annotations

import pytest

from gcs.cli.main import run
from gcs.exit_codes import ExitCode
from gcs.plan.errors import PlanError
from gcs.plan.formats.reader import read
from gcs.plan.formats.writer import write
from gcs.plan.lint import lint
from gcs.plan.model import AutopilotName, Geodetic, Geographic, Plan
from tests.sample_files import SAMPLES

READ: dict[str, tuple[int, int, int]] = {
    "csv/everything.csv": (6, 3, 1),
    "csv/least.csv": (2, 0, 0),
    "local/everything.toml": (9, 2, 0),
    "local/least.toml": (3, 0, 0),
    "plans/around_a_zone.plan": (5, 4, 0),
    "plans/box.plan": (6, 0, 0),
    "plans/corridor.plan": (10, 0, 0),
    "plans/fence_and_rally.plan": (0, 4, 2),
    "plans/photos_and_a_jump.plan": (9, 0, 0),
    "plans/survey.plan": (10, 0, 0),
    "plans/survey_of_an_older_version.plan": (10, 0, 0),
    "plans/through_a_zone.plan": (4, 4, 0),
    "plans/without_a_mission.plan": (0, 0, 0),
    "tables/above_sea_level.txt": (4, 0, 0),
    "tables/fence.txt": (0, 4, 0),
    "tables/fence_of_the_old_kind.txt": (0, 1, 0),
    "tables/jump.waypoints": (5, 0, 0),
    "tables/protobuf.txt": (2, 0, 0),
    "tables/rally.txt": (0, 0, 2),
    "tables/rally_of_the_old_kind.txt": (0, 0, 2),
    "tables/version_100.txt": (3, 0, 0),
    "tables/with_home.waypoints": (5, 0, 0),
    "tables/without_home.txt": (4, 0, 0),
    "xml/field.kml": (2, 2, 0),
    "xml/route.gpx": (3, 0, 0),
    "xml/track.gpx": (3, 0, 0),
}
"""Items that are flown, zones, rally points."""

REFUSED: dict[str, tuple[str, str]] = {
    "csv/bad_latitude.csv": ("3", "latitude 147.398"),
    "csv/bad_separator.csv": ("1", "is not known"),
    "local/bad_key.toml": ("4", "is missing"),
    "local/bad_schema.toml": ("1", "2 is not known"),
    "plans/bad_file_version.plan": ("version", "is 42"),
    "plans/bad_kind.plan": ("fileType", 'is "Parameters"'),
    "plans/bad_mission_version.plan": ("mission.version", "is 7"),
    "plans/bad_structure_scan.plan": ("mission.items[1].complexItemType", "as a polygon"),
    "plans/bad_survey_version.plan": ("mission.items[1].version", "is 9"),
    "plans/bad_survey_without_items.plan": (
        "mission.items[1].TransectStyleComplexItem.Items",
        "is missing",
    ),
    "tables/bad_decimal_mark.txt": ("2", 'is "47,397742"'),
    "tables/bad_open_fence.txt": ("5", "does not close the polygon"),
    "tables/bad_repeated_number.txt": ("4", "it repeats"),
    "xml/bad_entities.kml": ("2", "a document type may hide"),
    "xml/bad_two_routes.gpx": ("3", "one of 2 routes and tracks"),
}
WITH_HOME = {name for name in READ if name.endswith((".waypoints", "everything.csv"))}
"""Tables as ArduPilot's programs write them."""


def plan_of(name: str) -> Plan:
    autopilot: AutopilotName | None = "ardupilot" if name in WITH_HOME else None
    return read(name, (SAMPLES / name).read_bytes(), autopilot)


def test_no_sample_is_forgotten() -> None:
    found = {
        path.relative_to(SAMPLES).as_posix()
        for path in SAMPLES.rglob("*")
        if path.is_file() and path.suffix != ".md"
    }
    assert found == {*READ, *REFUSED}


@pytest.mark.parametrize(("name", "counts"), READ.items(), ids=READ)
def test_a_sample_is_read(name: str, counts: tuple[int, int, int]) -> None:
    plan = plan_of(name)
    assert (len(plan.items), len(plan.fence.zones), len(plan.rally)) == counts
    planned = name.startswith("plans/") and not name.endswith("without_a_mission.plan")
    assert (plan.home is not None) == (planned or name in WITH_HOME)


@pytest.mark.parametrize(("name", "why"), REFUSED.items(), ids=REFUSED)
def test_a_bad_sample_is_refused_at_its_place(name: str, why: tuple[str, str]) -> None:
    with pytest.raises(PlanError) as caught:
        plan_of(name)
    assert caught.value.where == why[0]
    assert why[1] in caught.value.what


def test_a_jump_in_a_table_keeps_its_target() -> None:
    plan = plan_of("tables/jump.waypoints")
    target = plan.index_of(plan.items[3].params[0])
    assert target == 1
    assert plan.items[target].place == Geographic(47.3980118, 8.545594, 8.0)


def test_a_height_above_the_sea_that_is_underground_is_called_so() -> None:
    found = lint(plan_of("tables/above_sea_level.txt"), "px4", Geodetic(47.3977, 8.5456, 488.0))
    assert [each.where for each in found if "underground" in each.what] == ["4"]


@pytest.mark.parametrize("suffix", ["plan", "waypoints"])
@pytest.mark.parametrize("name", ["plans/box.plan", "plans/survey.plan", "tables/without_home.txt"])
def test_a_sample_survives_every_format(name: str, suffix: str) -> None:
    plan = plan_of(name)
    again = read(f"again.{suffix}", write(f"again.{suffix}", plan, "px4").data, "px4")
    assert again.items == plan.items


def test_the_gate_clears_the_way_around_a_zone_and_refuses_the_one_through_it(
    capsys: pytest.CaptureFixture[str],
) -> None:
    assert run(["mission", "check", str(SAMPLES / "plans" / "around_a_zone.plan")]) == ExitCode.DONE
    through = str(SAMPLES / "plans" / "through_a_zone.plan")
    assert run(["mission", "check", through]) == ExitCode.REFUSED_BY_GATE
    assert "goes inside exclusion polygon 'geoFence.polygons[1]'" in capsys.readouterr().out
