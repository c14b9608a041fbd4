"""`--firmware`: only with the autopilot that has it; parameters are set by its names."""

from __future__ import annotations

from pathlib import Path

import pytest
from click.testing import CliRunner

from vehicle_sim import cli
from vehicle_sim.autopilot.firmware import FIRMWARES
from vehicle_sim.autopilot.interface import Geodetic
from vehicle_sim.autopilot.parameters.parameters import ParameterError
from vehicle_sim.cli import Options, _BadFileError, main, plan_of
from vehicle_sim.shell.runtime import VehicleSetup, parameters_of


def options(words: list[str], monkeypatch: pytest.MonkeyPatch) -> Options:
    """What the command line's words mean, without a run."""
    meant: list[Options] = []

    def run(options: Options) -> int:
        meant.append(options)
        return 0

    monkeypatch.setattr(cli, "run", run)
    result = CliRunner().invoke(main, words)
    assert result.exit_code == 0, result.output
    return meant[0]


@pytest.mark.parametrize(
    ("autopilot", "firmware"), [("px4", "4.5"), ("px4", "4.7"), ("ardupilot", "1.14")]
)
def test_the_other_autopilots_firmware_is_a_mistake_of_usage(autopilot: str, firmware: str) -> None:
    result = CliRunner().invoke(main, ["--autopilot", autopilot, "--firmware", firmware])
    assert result.exit_code == 2
    assert "--firmware" in result.output
    assert f"firmware {firmware} is not one of {autopilot}'s" in result.output


def test_a_firmware_that_is_none_is_a_mistake_of_usage() -> None:
    result = CliRunner().invoke(main, ["--firmware", "9.9"])
    assert result.exit_code == 2


@pytest.mark.parametrize("autopilot", ["px4", "ardupilot"])
def test_the_older_one_is_usual(autopilot: str, monkeypatch: pytest.MonkeyPatch) -> None:
    played = options(["--autopilot", autopilot], monkeypatch).firmware
    assert played == FIRMWARES[autopilot][0]  # type: ignore[index]


def test_parameters_are_set_by_the_firmwares_names(monkeypatch: pytest.MonkeyPatch) -> None:
    words = ["--autopilot", "ardupilot", "--firmware", "4.7", "--param", "RTL_ALT_M=22"]
    plan = plan_of(options([*words, "--port", "0"], monkeypatch))
    setup = VehicleSetup(7, Geodetic(0.0, 0.0, 0.0), ())
    parameters = parameters_of(plan, setup)
    assert (parameters.value("RTL_ALT_M"), parameters.value("MAV_SYSID")) == (22.0, 7.0)
    parameters.reset()
    assert (parameters.value("RTL_ALT_M"), parameters.value("MAV_SYSID")) == (22.0, 7.0)


def test_an_older_firmwares_name_is_no_parameter(monkeypatch: pytest.MonkeyPatch) -> None:
    words = ["--autopilot", "ardupilot", "--firmware", "4.7", "--param", "RTL_ALT=2200"]
    plan = plan_of(options([*words, "--port", "0"], monkeypatch))
    with pytest.raises(ParameterError, match="RTL_ALT"):
        parameters_of(plan, VehicleSetup(1, Geodetic(0.0, 0.0, 0.0), ()))


def test_parameters_of_a_file_are_kept_whatever_their_names(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    file = tmp_path / "a.parm"
    file.write_text("# saved\nRTL_ALT_M 22\nNOBODYS,0.5\nMAV_SYSID 9\n")
    words = ["--autopilot", "ardupilot", "--firmware", "4.7", "--port", "0"]
    plan = plan_of(options([*words, "--param-file", str(file)], monkeypatch))
    parameters = parameters_of(plan, VehicleSetup(7, Geodetic(0.0, 0.0, 0.0), ()))
    names = ("RTL_ALT_M", "NOBODYS", "MAV_SYSID")
    assert [parameters.value(name) for name in names] == [22.0, 0.5, 7.0]
    parameters.set("NOBODYS", 2.0)
    parameters.reset()
    assert parameters.value("NOBODYS") == 0.5
    file.write_text("RTL_ALT_M 22\nRTL_ALT_M\n")
    with pytest.raises(_BadFileError, match=r"a\.parm:2"):
        plan_of(options([*words, "--param-file", str(file)], monkeypatch))
