"""The options that turn a deliberate difference from the real autopilots off."""

from __future__ import annotations

import pytest
from click.testing import CliRunner

from tests.unit.vehicle_shell.test_firmware_option import options
from vehicle_sim.cli import main, plan_of


def test_it_boots_quickly_unless_told_otherwise(monkeypatch: pytest.MonkeyPatch) -> None:
    assert plan_of(options(["--port", "0"], monkeypatch)).boot == "quick"


def test_it_boots_as_the_real_one_when_told(monkeypatch: pytest.MonkeyPatch) -> None:
    assert plan_of(options(["--port", "0", "--boot", "real"], monkeypatch)).boot == "real"


def test_another_boot_is_a_mistake_of_usage() -> None:
    result = CliRunner().invoke(main, ["--boot", "slow"])
    assert result.exit_code == 2
    assert "--boot" in result.output


def test_it_has_a_camera_unless_told_otherwise(monkeypatch: pytest.MonkeyPatch) -> None:
    assert plan_of(options(["--port", "0"], monkeypatch)).camera


def test_it_has_none_when_told(monkeypatch: pytest.MonkeyPatch) -> None:
    assert not plan_of(options(["--port", "0", "--camera", "none"], monkeypatch)).camera


def test_anybody_commands_unless_told_otherwise(monkeypatch: pytest.MonkeyPatch) -> None:
    assert not plan_of(options(["--port", "0"], monkeypatch)).operator_control


def test_one_station_commands_when_told(monkeypatch: pytest.MonkeyPatch) -> None:
    assert plan_of(options(["--port", "0", "--operator-control"], monkeypatch)).operator_control
