"""`gcs mission convert`, and files that cannot be read."""

from __future__ import annotations

import json
import re
from pathlib import Path

import pytest

from gcs.cli.mission.convert import convert
from gcs.cli.mission.mission import show
from gcs.cli.mission.new import new
from gcs.exit_codes import ExitCode
from gcs.plan.formats.reader import read
from gcs.resources import find
from tests.each import each
from tests.unit.cli.command_line import gcs

HOME = "47.397742,8.545594,488"


@pytest.mark.parametrize("suffix", [".plan", ".txt", ".toml", ".csv", ".kml", ".gpx"])
def test_a_shipped_mission_is_written_in_each_format_and_read_again(
    tmp_path: Path, suffix: str
) -> None:
    out = tmp_path / f"out{suffix}"

    result = gcs("mission", "convert", "demo", "-o", out, "--home", HOME)

    assert result.exit_code == ExitCode.DONE
    items = {".kml": 4, ".gpx": 4}.get(suffix, 7)  # a route has places, and no commands
    assert f"{out}: written, {items} items, 0 zones, 0 rally points" in result.output
    assert len(read(str(out), out.read_bytes()).items) == items


def test_metres_survive_degrees(tmp_path: Path) -> None:
    there, back = tmp_path / "a.plan", tmp_path / "a.toml"
    gcs("mission", "convert", "demo", "-o", there, "--home", HOME)
    gcs("mission", "convert", there, "-o", back)

    demo = read("demo.toml", find("demo").read_bytes())
    again = read("a.toml", back.read_bytes())

    assert [item.place for item in again.items] == [item.place for item in demo.items]
    assert [item.params for item in again.items] == [item.params for item in demo.items]


def test_what_would_be_lost_is_named_and_strict_writes_nothing(tmp_path: Path) -> None:
    out = tmp_path / "a.gpx"
    command = ("mission", "convert", "demo", "-o", out, "--home", HOME)

    result = gcs(*command, "--strict")

    assert result.exit_code == ExitCode.DIFFERENT
    assert "lost: " in result.output
    assert "IMAGE_START_CAPTURE: is not kept by this format (item 5)" in result.output
    assert not out.exists()
    assert gcs(*command).exit_code == ExitCode.DONE
    assert gcs(*command).exit_code == ExitCode.USAGE
    document = json.loads(gcs(*command, "--force", "--json").output)
    assert (document["written"], document["format"]) == (str(out), "gpx")
    assert "DO_CHANGE_SPEED" in [loss["item"] for loss in document["lost"]]


def test_standard_output_is_the_file_alone() -> None:
    result = gcs("mission", "convert", "demo", "-o", "-", "--to", "csv")

    assert result.exit_code == ExitCode.DONE
    assert result.output.startswith("what,id,command")
    assert len(read("a.csv", result.output.encode()).items) == 7


def test_a_route_without_heights_is_flown_at_one(tmp_path: Path) -> None:
    drawn = tmp_path / "drawn.kml"
    drawn.write_text(
        "<kml><Placemark><LineString><coordinates>8.5456,47.3977 8.5457,47.3978</coordinates>"
        "</LineString></Placemark></kml>"
    )
    out = tmp_path / "a.plan"

    assert "have no height" in gcs("mission", "convert", drawn, "-o", "-", "--to", "csv").output
    gcs("mission", "convert", drawn, "-o", out, "--height", "12")

    assert [item.place[2] for item in read("a.plan", out.read_bytes()).items] == [12.0, 12.0]


EXAMPLES = [
    words
    for command in (convert, show, *new.commands.values())
    for words in re.findall(r"Example: gcs (.+)", command.epilog or "")
]


def test_every_example_works(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    assert len(EXAMPLES) == 5
    for words in EXAMPLES:
        result = gcs(*words.split())
        assert result.exit_code == ExitCode.DONE, (words, result.output)


WRONG: list[tuple[tuple[str, ...], ExitCode, str]] = [
    (("demo", "-o", "a.kmz"), ExitCode.BAD_FILE, "the suffix names no format"),
    (("demo", "-o", "a.plan"), ExitCode.BAD_FILE, "--home LAT,LON,ALT"),
    (("demo", "-o", "-"), ExitCode.USAGE, "--to names the format"),
    (("demo", "-o", "-", "--to", "csv", "--json"), ExitCode.USAGE, "--json says nothing of it"),
    (("demo", "-o", "no/such/a.csv"), ExitCode.BAD_FILE, "No such file or directory"),
    (("demo", "-o", "a.csv", "--home", "1,2"), ExitCode.USAGE, "not three numbers"),
    (("nothing", "-o", "a.csv"), ExitCode.BAD_FILE, "no such mission file"),
    ((".", "-o", "a.csv"), ExitCode.BAD_FILE, "is a folder\n  hint: name a file in it: one.plan"),
]


def test_what_cannot_be_done_is_told(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "one.plan").write_text("{}")
    for words, code, told in WRONG:
        result = gcs("mission", "convert", *words)
        assert (result.exit_code, told in result.output) == (code, True), (words, result.output)


@each("command", ["check", "show", "upload", "fly"])
def test_a_folder_is_no_mission_file(command: str) -> None:
    result = gcs("mission", command, "/")
    assert (result.exit_code, "/: is a folder" in result.output) == (ExitCode.BAD_FILE, True)
