"""`gcs mission new`: made from a file or a point, written, and checked as it was written."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from gcs.exit_codes import ExitCode
from gcs.gate.airspace.projection import Origin, Projection
from gcs.plan.formats.reader import read
from gcs.plan.model import Geographic
from tests.unit.cli.command_line import gcs

HOME = "47.397742,8.545594,488"
FIELD = """\
schema = 1
frame = "home"
waypoint = [{north_m = 20, east_m = 10, up_m = 10}, {north_m = 60, east_m = 10, up_m = 10},
            {north_m = 60, east_m = 50, up_m = 10}]
[fence]
north_m = [10, 70]
east_m = [10, 50]
"""


@pytest.fixture
def field(tmp_path: Path) -> Path:
    path = tmp_path / "field.toml"
    path.write_text(FIELD)
    return path


def test_a_survey_is_written_checked_and_told(field: Path, tmp_path: Path) -> None:
    """40 x 60 m, pictures of 20 x 15 m, sides 50 %, front 60 %: four lines north, each 6 m."""
    out = tmp_path / "out.plan"
    command = ("mission", "new", "survey", field, "-o", out, "--footprint", "20x15", "--side", "50")

    result = gcs(*command, "--front", "60", "--height", "20", "--home", HOME)

    assert result.exit_code == ExitCode.DONE, result.output
    assert "out.plan: written, 19 items, 4 lines, about 44 pictures" in result.output
    assert "one each 6.0 m, 1.2 s; lines at most 10.0 m apart" in result.output
    assert "verdict: may be flown" in result.output
    plan = read(str(out), out.read_bytes())
    plane = Projection(Origin(47.397742, 8.545594, 488.0), "px4")
    places = [item.place for item in plan.items if item.command == 16]
    at = [plane.north_east(p.lat_deg, p.lon_deg) for p in places if isinstance(p, Geographic)]
    assert [round(east) for _, east in at] == [15, 15, 25, 25, 35, 35, 45, 45]
    assert [round(north) for north, _ in at] == [10, 70, 70, 10, 10, 70, 70, 10]
    assert gcs("mission", "check", out).exit_code == ExitCode.DONE


def test_what_the_fence_refuses_is_said_and_the_exit_code_says_it_too(
    field: Path, tmp_path: Path
) -> None:
    out = tmp_path / "out.csv"
    made = ("mission", "new", "survey", field, "-o", out, "--camera", "sony-rx0")
    command = (*made, "--height", "60", "--policy", "lab")

    result = gcs(*command)

    assert result.exit_code == ExitCode.REFUSED_BY_GATE
    assert "home: 47.3977420, 8.5455940, as nothing says where it takes off" in result.output
    assert "more: gcs mission check" in result.output
    assert "verdict: refused by the gate" in result.output
    document = json.loads(gcs(*command, "--force", "--json").output)
    assert document["check"]["exit_code"] == ExitCode.REFUSED_BY_GATE
    assert document["footprint_m"] == pytest.approx([13.2 * 60 / 7.7, 8.8 * 60 / 7.7])


def test_a_corridor_follows_the_route_of_a_mission(field: Path, tmp_path: Path) -> None:
    out = tmp_path / "out.plan"
    command = ("mission", "new", "corridor", field, "-o", out, "--width", "20", "--height", "15")

    result = gcs(*command, "--footprint", "40x30", "--home", HOME, "--json")

    assert result.exit_code == ExitCode.DONE, result.output
    first, second = json.loads(result.output)["runs"]
    # The take-off is where the line begins, then its three waypoints and the landing's place.
    assert first[0] == pytest.approx([0.0, 0.0], abs=6.0)
    assert len(first) == len(second)


def test_an_orbit_looks_at_its_point(tmp_path: Path) -> None:
    out = tmp_path / "out.plan"
    command = ("mission", "new", "orbit", "47.3980,8.5460", "-o", out, "--radius", "15")

    result = gcs(*command, "--height", "12", "--photos", "12", "--home", HOME)

    assert result.exit_code == ExitCode.DONE, result.output
    assert "32 items, 1 line, about 13 pictures" in result.output
    plan = read(str(out), out.read_bytes())
    looked_at = next(item.place for item in plan.items if item.command == 195)
    assert looked_at[:2] == (47.398, 8.546)
    assert sum(item.command == 16 for item in plan.items) == 25


WRONG: list[tuple[tuple[str, ...], ExitCode, str]] = [
    (("survey", "FIELD", "-o", "a.plan"), ExitCode.USAGE, "name the camera, in one way"),
    (
        ("survey", "FIELD", "-o", "a.plan", "--camera", "sony-rx0", "--footprint", "2x2"),
        ExitCode.USAGE,
        "name the camera, in one way",
    ),
    (
        ("survey", "FIELD", "-o", "a.plan", "--sensor", "2x2"),
        ExitCode.USAGE,
        "--sensor and --focal belong together",
    ),
    (("survey", "FIELD", "-o", "a.plan", "--footprint", "2"), ExitCode.USAGE, "not two numbers"),
    (("survey", "FIELD", "-o", "a.kml", "--footprint", "2x2"), ExitCode.USAGE, "the suffix"),
    (("survey", "demo", "-o", "a.plan", "--footprint", "9x9"), ExitCode.BAD_FILE, "no polygon"),
    (
        ("survey", "FIELD", "-o", "a.plan", "--footprint", "0.05x9", "--side", "0"),
        ExitCode.USAGE,
        "more than 2000 items",
    ),
    (
        ("survey", "FIELD", "-o", "a.plan", "--footprint", "9x9", "--zone", "3"),
        ExitCode.USAGE,
        "has 1 polygon",
    ),
    (
        ("corridor", "TREES", "-o", "a.plan", "--footprint", "9x9", "--width", "9"),
        ExitCode.BAD_FILE,
        "no line of two points",
    ),
    (("orbit", "47", "-o", "a.plan", "--radius", "9"), ExitCode.USAGE, "LAT,LON"),
    (("orbit", "97,8", "-o", "a.plan", "--radius", "9"), ExitCode.USAGE, "no place on Earth"),
]


def test_what_cannot_be_made_is_told(
    field: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "trees.csv").write_text("what,lat_deg,lon_deg,radius_m\nexclusion,47,8,5\n")
    files = {"FIELD": str(field), "TREES": "trees.csv"}
    for words, code, told in WRONG:
        result = gcs("mission", "new", *(files.get(w, w) for w in words), "--height", "20")
        assert (result.exit_code, told in result.output) == (code, True), (words, result.output)
    assert not (tmp_path / "a.plan").exists()
