"""Mission files that an agent may name: those of one folder, the shipped ones, and no others."""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace
from typing import cast

import pytest

from gcs.agents.agent import PlanFile
from gcs.agents.verdicts import Denied
from gcs.cli.mcp.plans import Plans
from gcs.operator.station import Station
from gcs.resources import missions_dir
from tests.each import each

HOME = {"latitude": 473977420, "longitude": 85455940, "altitude": 488000}


def plans(folder: Path | None, home: dict[str, int] | None = HOME) -> Plans:
    def telemetry(_message: str, _timeout_s: float) -> dict[str, int]:
        if home is None:
            raise TimeoutError
        return home

    snapshot = SimpleNamespace(vehicle="1/1 px4 quadrotor")
    station = SimpleNamespace(telemetry=telemetry, snapshot=snapshot)
    return Plans(cast(Station, station), "default", folder)


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    inside = tmp_path / "missions"
    inside.mkdir()
    (inside / "mine.toml").write_bytes((missions_dir() / "demo.toml").read_bytes())
    (tmp_path / "secret.toml").write_bytes(b"password = 1\n")
    (inside / "link.toml").symlink_to(tmp_path / "secret.toml")
    return inside


def test_a_file_of_the_folder_and_a_shipped_one_may_be_flown(folder: Path) -> None:
    for name in ("mine.toml", "demo.toml", "lab3/square.toml"):
        read = plans(folder).read(name)
        assert isinstance(read, PlanFile), read
        assert (read.code, len(read.digest)) == ("", 16)


@each("name", ["../secret.toml", "link.toml", "/etc/passwd", "lab3/../../pyproject.toml", "", "."])
def test_nothing_else_of_this_machine_is_read(name: str) -> None:
    read = plans(None).read(name)
    assert isinstance(read, Denied)
    assert read.code == "NO_SUCH_FILE"


def test_not_through_a_link_either(folder: Path) -> None:
    for name in ("../secret.toml", "link.toml", str(folder.parent / "secret.toml")):
        read = plans(folder).read(name)
        assert isinstance(read, Denied)
        assert "link.toml" not in name or "password" not in read.sentence


def test_what_is_wrong_with_a_file_is_told(folder: Path) -> None:
    (folder / "mine.toml").write_text("schema = 1\nname = 'far'\n", encoding="utf-8")
    read = plans(folder).read("mine.toml")
    assert isinstance(read, PlanFile)
    assert read.code == "BAD_MISSION"


def test_without_a_home_nothing_is_checked() -> None:
    read = plans(None, None).read("demo.toml")
    assert isinstance(read, Denied)
    assert read.code == "NO_HOME"
