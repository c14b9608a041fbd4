"""What a shell is offered, by click's own way of asking."""

from __future__ import annotations

import shutil
import subprocess
from pathlib import Path

import pytest
from click.shell_completion import ShellComplete

from gcs import resources
from gcs.cli import main
from gcs.cli.completion import SHELLS
from gcs.operator import joined
from gcs.shell.stations import Description
from tests.each import each
from tests.unit.cli.command_line import gcs


def offered(line: str) -> list[str]:
    """For a line of which the last word is unfinished."""
    *words, last = line.split(" ")
    asked = ShellComplete(main.gcs, {}, "gcs", "_GCS_COMPLETE")
    return [item.value for item in asked.get_completions(words, last)]


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "logs").mkdir()
    for name in ("a.mcap", "logs/b.mcap", "logs/c.txt", "yard.toml", "to_sea.plan", "x.ulg"):
        (tmp_path / name).touch()
    return tmp_path


@each(
    "case",
    [
        ("missi", ["mission"]),
        ("mission sh", ["show"]),
        ("goto --tim", ["--timeout"]),
        ("log info a", ["a.mcap"]),
        ("log info lo", ["logs/b.mcap"]),
        ("log info logs/", ["logs/b.mcap"]),
        ("log import x", ["x.ulg"]),
        ("topic echo ATTITUDE --log a", ["a.mcap"]),
        ("arm --policy l", ["lab"]),
        ("arm --policy y", ["yard.toml"]),
        ("mission show to", ["to_sea.plan"]),
        ("mission show lab3/f", ["lab3/first_step"]),
        ("mode LOI", ["LOITER"]),
        ("mode auto.lo", ["AUTO.LOITER"]),
        ("completion f", ["fish"]),
    ],
)
def test_words_files_by_kind_and_what_is_shipped(folder: Path, case: tuple[str, list[str]]) -> None:
    line, expected = case
    assert offered(line) == expected


def test_every_shipped_mission_is_offered(folder: Path) -> None:
    names = {name.rpartition(".")[0] for name in resources.shipped()}
    assert names <= set(offered("mission fly "))


def test_vehicles_are_those_of_running_stations(monkeypatch: pytest.MonkeyPatch) -> None:
    running = [
        Description(1, 1, [], vehicle="7/1 px4 quadrotor"),
        Description(2, 1, [], vehicles=["12/1 ardupilot quadrotor", "13/1 px4 quadrotor"]),
    ]
    monkeypatch.setattr(joined, "running_stations", lambda: running)
    assert offered("hold --vehicle ") == ["7", "12", "13"]
    assert offered("hold --vehicle 1") == ["12", "13"]


def test_a_wrong_file_of_settings_spoils_no_completion(folder: Path) -> None:
    (folder / "mavgate.toml").write_text("x = 1")
    assert offered("goto --tim") == ["--timeout"]


@pytest.mark.slow
@pytest.mark.parametrize("shell", SHELLS)
def test_the_script_is_one_that_the_shell_reads(shell: str) -> None:
    printed = gcs("completion", shell)
    assert printed.exit_code == 0
    assert {"gcs", "vehicle-sim"} <= set(printed.output.split())
    if path := shutil.which(shell):
        subprocess.run([path, "-n"], input=printed.output, text=True, check=True)
