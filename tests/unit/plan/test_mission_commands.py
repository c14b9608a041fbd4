"""`gcs mission check` and `show`: exit codes, and what they print."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from gcs.cli.main import run
from gcs.exit_codes import ExitCode
from gcs.plan.items import ROWS
from tests.sample_files import elsewhere
from tests.unit.plan.samples import LOCAL, box, plan_document, simple, waypoint


@pytest.fixture
def file(tmp_path: Path) -> Path:
    path = tmp_path / "box.plan"
    path.write_text(json.dumps(box()))
    return path


def write(path: Path, document: dict[str, Any]) -> str:
    path.write_text(json.dumps(document))
    return str(path)


def test_a_good_mission_is_cleared_leg_by_leg(
    file: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run(["mission", "check", str(file)]) == ExitCode.DONE

    out = capsys.readouterr().out
    assert "clear    item 2 (NAV_WAYPOINT): leg to E +0.00 N +11.12 U +10.00" in out
    assert "verdict: may be flown" in out


def test_a_mission_outside_the_fence_is_refused_with_distance_and_zone(
    file: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    document = box()
    document["mission"]["items"][1]["params"][4] = 47.3997420
    write(file, document)

    assert run(["mission", "check", str(file)]) == ExitCode.REFUSED_BY_GATE

    out = capsys.readouterr().out
    assert "refused  item 2 (NAV_WAYPOINT)" in out
    assert "72.4 m outside inclusion circle 'home'" in out


def test_the_fence_of_the_file_counts_too(file: Path, capsys: pytest.CaptureFixture[str]) -> None:
    document = box()
    circle = {"center": [47.3978, 8.545594], "radius": 3.0}
    document["geoFence"]["circles"] = [{"inclusion": False, "circle": circle, "version": 1}]
    write(file, document)

    assert run(["mission", "check", str(file), "--json"]) == ExitCode.REFUSED_BY_GATE

    legs = json.loads(capsys.readouterr().out)["legs"]
    refused = [(leg["item"], leg["code"]) for leg in legs if not leg["cleared"]]
    assert (2, "TOO_CLOSE") in refused


def test_home_moves_the_fence(file: Path) -> None:
    far = ["--home", "47.4010,8.5456,488"]

    assert run(["mission", "check", str(file), *far]) == ExitCode.REFUSED_BY_GATE


def test_what_cannot_be_known_is_refused(file: Path, capsys: pytest.CaptureFixture[str]) -> None:
    terrain = simple(2, 16, 10, [0, 0, 0, None, 47.3978, 8.5456, 10])
    path = write(file, plan_document(waypoint(1, 47.397742, 8.545594, 10, 22), terrain))

    assert run(["mission", "check", path]) == ExitCode.REFUSED_BY_GATE
    assert "heights above terrain" in capsys.readouterr().out


def test_an_own_failsafe_return_through_the_ceiling_is_warned_of(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "a.toml").write_text(LOCAL.partition("[[fence.exclude]]")[0])

    assert run(["mission", "check", str(tmp_path / "a.toml")]) == ExitCode.DONE
    assert "failsafe return cannot be gated" in capsys.readouterr().out


def test_an_error_of_lint_is_a_bad_file(file: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = write(file, plan_document(simple(1, 177, 2, [1, 1, 0, 0, 0, 0, 0])))

    assert run(["mission", "check", path]) == ExitCode.BAD_FILE
    assert "mission.items[0]: item 1 (DO_JUMP): jumps to itself" in capsys.readouterr().out


@pytest.mark.parametrize("command", ["check", "show"])
def test_a_file_that_cannot_be_read_says_where_and_hints(
    command: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "a.toml"
    path.write_text(LOCAL.replace("hold_s", "holds_s"))

    assert run(["mission", command, str(path)]) == ExitCode.BAD_FILE

    error = capsys.readouterr().err
    assert f"{path}:10: waypoint[1].holds_s: " in error
    assert "hint: did you mean hold_s?" in error


@pytest.mark.parametrize(
    ("arguments", "code"),
    [
        (["nowhere.plan"], ExitCode.BAD_FILE),
        (["demo", "--policy", "nowhere.toml"], ExitCode.BAD_FILE),
        (["demo", "--home", "1,2"], ExitCode.USAGE),
        (["demo", "--home", "100,2,3"], ExitCode.USAGE),
        (["demo", "--autopilot", "other"], ExitCode.USAGE),
        (["."], ExitCode.BAD_FILE),
    ],
)
def test_wrong_arguments(arguments: list[str], code: ExitCode) -> None:
    assert run(["mission", "check", *arguments]) == code


def test_a_policy_of_ones_own_with_a_fence_file(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    document = box()
    circle = {"center": [47.397742, 8.545594], "radius": 5.0}
    document["geoFence"]["circles"] = [{"inclusion": True, "circle": circle, "version": 1}]
    write(tmp_path / "yard.plan", document)
    policy = tmp_path / "policy.toml"
    policy.write_text('[[fence]]\nkind = "file"\npath = "yard.plan"\n')
    mission = write(tmp_path / "box.plan", box())

    code = run(["mission", "check", mission, "--policy", str(policy)])

    assert code == ExitCode.REFUSED_BY_GATE
    assert "inclusion circle" in capsys.readouterr().out


def test_show_prints_every_item_and_the_notes(
    file: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run(["mission", "show", str(file)]) == ExitCode.DONE

    out = capsys.readouterr().out
    for word in ("NAV_TAKEOFF", "NAV_LAND", "above", "planned home: 47.3977420, 8.5455940, 488 m"):
        assert word in out


def test_show_prints_json_without_nan(file: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["mission", "show", str(file), "--json"]) == ExitCode.DONE

    shown = json.loads(capsys.readouterr().out)
    assert shown["items"][1]["params"] == [0, 0, 0, None]
    assert shown["items"][1]["place"] == {"lat_deg": 47.397842, "lon_deg": 8.545594, "alt_m": 10}


def test_a_real_mission_keeps_to_a_real_fence(capsys: pytest.CaptureFixture[str]) -> None:
    box_file = elsewhere("plans", "MC_mission_box.plan")
    avoid = elsewhere("plans", "multicopter_mission_geofence_avoid.plan")

    assert run(["mission", "check", str(box_file)]) == ExitCode.DONE
    assert run(["mission", "check", str(avoid)]) == ExitCode.REFUSED_BY_GATE
    assert "outside inclusion circle 'home'" in capsys.readouterr().out


def test_check_counts_the_zones_of_policy_and_file(
    file: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    run(["mission", "check", str(file)])
    assert "fence: 1 zone from the policy, 0 from the file\n" in capsys.readouterr().out


def test_show_breaks_no_word_on_a_narrow_terminal(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setenv("COLUMNS", "80")
    assert run(["mission", "show", "survey"]) == ExitCode.DONE
    lines = capsys.readouterr().out.splitlines()
    assert max(map(len, lines)) <= 80
    assert any("DO_SET_CAM_TRIGG_DIST" in line for line in lines)
    assert " id " not in lines[2]


def test_a_mission_without_items_says_so(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    empty = tmp_path / "empty.waypoints"
    empty.write_text("QGC WPL 110\n")
    assert run(["mission", "show", str(empty)]) == ExitCode.DONE
    assert "no items" in capsys.readouterr().out


def test_a_version_that_is_not_known_is_named_once(
    file: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    write(file, box() | {"version": 3})
    assert run(["mission", "check", str(file)]) == ExitCode.BAD_FILE
    assert f"{file}:version: is 3, expected 1" in capsys.readouterr().err


def test_a_policy_is_no_mission_and_the_option_is_named(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    policy = tmp_path / "policy.toml"
    policy.write_text('name = "mine"\nmargin_h_m = 3.0\n')
    assert run(["mission", "check", str(policy)]) == ExitCode.BAD_FILE
    err = capsys.readouterr().err
    assert "is a policy and no mission" in err
    assert "--policy FILE" in err


def test_how_items_are_flown_is_printed_with_every_command(
    capsys: pytest.CaptureFixture[str],
) -> None:
    assert run(["mission", "items"]) == ExitCode.DONE
    out = capsys.readouterr().out
    assert "   82  NAV_SPLINE_WAYPOINT\n         PX4 1.14, PX4 1.15: refused" in out
    assert all(row.command.name in out for row in ROWS)


def test_a_rally_point_in_a_zone_is_refused_with_the_zone_and_the_metres(
    file: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """clients.md, row 2."""
    document = box()
    circle = {"center": [47.3980, 8.545594], "radius": 10.0}
    document["geoFence"]["circles"] = [{"inclusion": False, "circle": circle, "version": 1}]
    document["rallyPoints"] = {"points": [[47.3980, 8.545594, 0]], "version": 2}
    write(file, document)

    assert run(["mission", "check", str(file)]) == ExitCode.REFUSED_BY_GATE

    out = capsys.readouterr().out
    assert "  refused  rally point 1: " in out
    assert "inside exclusion circle 'geoFence.circles[0]'" in out


def test_a_corner_cut_through_a_zone_is_refused_with_item_zone_and_metres(
    file: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """clients.md, row 1: an acceptance radius of 80 m; no leg comes near the circle."""
    north = waypoint(2, 47.397742 + 90 / 111194.9, 8.545594, 10)
    north["params"][1] = 80.0
    east = waypoint(3, 47.397742 + 90 / 111194.9, 8.545594 + 90 / 75270.0, 10)
    document = plan_document(waypoint(1, 47.397742, 8.545594, 10, command=22), north, east)
    centre = [47.397742 + 60 / 111194.9, 8.545594 + 36 / 75270.0]
    circle = {"center": centre, "radius": 4.0}
    document["geoFence"]["circles"] = [{"inclusion": False, "circle": circle, "version": 1}]
    write(file, document)

    assert run(["mission", "check", str(file)]) == ExitCode.REFUSED_BY_GATE

    out = capsys.readouterr().out
    assert "refused  item 3 (NAV_WAYPOINT): turn to " in out
    assert "inside exclusion circle 'geoFence.circles[0]'" in out
    north["params"][1] = 0.0
    write(file, document)
    assert run(["mission", "check", str(file)]) == ExitCode.DONE
