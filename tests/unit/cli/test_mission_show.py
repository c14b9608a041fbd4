"""`gcs mission show`: the route in figures, as text, SVG and a page."""

from __future__ import annotations

import json
import math
import re
import xml.etree.ElementTree as ET
from pathlib import Path

import pytest

from gcs.cli.mission.mission import has_braille
from gcs.exit_codes import ExitCode
from tests.each import each
from tests.sample_files import SAMPLES
from tests.unit.cli.command_line import gcs

SQUARE = """\
schema = 1
name = "a <square>"
frame = "home"
takeoff_up_m = 5.0
end = "land"
waypoint = [
  {north_m = 30, east_m = 0, up_m = 5},
  {north_m = 30, east_m = 40, up_m = 5},
  {north_m = 0, east_m = 0, up_m = 8},
]
[fence]
north_m = [-10, 50]
east_m = [-10, 50]
"""


@pytest.fixture
def square(tmp_path: Path) -> Path:
    path = tmp_path / "square.toml"
    path.write_text(SQUARE)
    return path


def test_the_figures_are_those_of_the_geometry(square: Path) -> None:
    """Up 5, north 30, east 40, 50 back over the ground and 3 up, down 8."""
    document = json.loads(gcs("mission", "show", square, "--json").output)
    route = document["route"]

    back_m = math.hypot(50.0, 3.0)
    lengths = [leg["length_m"] for leg in route["legs"]]
    assert lengths == pytest.approx([5.0, 30.0, 40.0, back_m, 8.0], abs=0.02)
    assert route["length_m"] == pytest.approx(83.0 + back_m, abs=0.05)
    assert (route["climb_m"], route["highest_m"]) == (pytest.approx(8.0), pytest.approx(8.0))
    assert route["farthest_m"] == pytest.approx(50.0, abs=0.02)
    assert [leg["item"] for leg in route["legs"]] == [1, 2, 3, 4, 5]
    ends_s = list(route["ends_s"].values())
    assert ends_s == sorted(ends_s)
    assert ends_s[-1] == pytest.approx(route["flight_s"])


def test_a_policy_with_a_battery_says_what_share_it_takes(square: Path, tmp_path: Path) -> None:
    policy = tmp_path / "my.toml"
    policy.write_text("[battery]\nendurance_s = 1000\n")
    command = ("mission", "show", square, "--policy", policy)

    route = json.loads(gcs(*command, "--json").output)["route"]

    # At 15 % it is low: a full one gives 850 s.
    assert route["battery"].startswith(f"{100 * route['flight_s'] / 850:.0f} % of what a full one")
    policy.write_text("[battery]\nendurance_s = 60\n")
    assert "the battery is low after 51 s" in " ".join(gcs(*command).output.split())


def test_the_picture_in_ascii(square: Path) -> None:
    lines = gcs("mission", "show", square, "--ascii").output.split("\n")
    begin = next(n for n, line in enumerate(lines) if "stay inside" in line)
    picture = [line for line in lines[begin:] if line.strip()]
    text = "\n".join(picture)

    assert "north is up; |" in text
    assert "heights above home along 120 m over the ground" in text
    # North of home, then east; the way back is a slope.
    assert re.search(r"^ \. +2\.+:*3 +\.$", text, re.MULTILINE)
    assert re.search(r"^ \. +H +\.$", text, re.MULTILINE)
    assert not set(text) & {chr(dots) for dots in range(0x2801, 0x2900)}


@each("command", ["--svg", "--html"])
@pytest.mark.parametrize("name", ["square", "fence", "survey", "tables/fence.txt", "xml/field.kml"])
def test_a_picture_is_well_formed_and_asks_no_network(
    square: Path, tmp_path: Path, name: str, command: str
) -> None:
    file = {"square": str(square)}.get(name, str(SAMPLES / name) if "/" in name else name)
    out = tmp_path / f"out{command}"

    assert gcs("mission", "show", file, command, out).exit_code == ExitCode.DONE

    text = out.read_text(encoding="utf-8")
    assert "://" not in text.replace("http://www.w3.org/2000/svg", "")
    assert "<script" not in text
    assert "a <square>" not in text
    if command == "--svg":
        root = ET.fromstring(text)
        drawn = [element.tag.rpartition("}")[2] for element in root.iter()]
        assert ("polygon" in drawn or "polyline" in drawn) is True
    assert gcs("mission", "show", file, command, out).exit_code == ExitCode.USAGE


def test_what_cannot_be_flown_is_told_in_the_picture(tmp_path: Path) -> None:
    (tmp_path / "a.csv").write_text("lat_deg,lon_deg\n47.3978,8.5456\n")
    shown = gcs("mission", "show", tmp_path / "a.csv")
    assert shown.exit_code == ExitCode.DONE
    assert "not flown as it is: item 1 (NAV_WAYPOINT): it has no height" in shown.output


@each("case", [("utf-8", True), ("latin-1", False), ("ascii", False), ("klingon", False)])
def test_braille_is_drawn_where_it_can_be(case: tuple[str, bool]) -> None:
    assert has_braille(case[0]) is case[1]
