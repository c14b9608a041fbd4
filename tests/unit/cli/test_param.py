"""`gcs param` over a scripted station: what is asked for, what is printed, how it exits."""

from __future__ import annotations

import json
from dataclasses import dataclass, field
from pathlib import Path

import pytest

from gcs import ipc
from gcs.exit_codes import ExitCode
from tests.unit.cli.command_line import gcs, in_place_of_one
from tests.unit.operator.fake_station import FakeStation


@dataclass
class Station(FakeStation):
    """A vehicle with some parameters; `BRAKE` ones appear once BRAKE_ENABLE is set."""

    values: dict[str, int | float] = field(
        default_factory=lambda: {"RTL_ALT": 15.5, "RTL_TYPE": 1, "BRAKE_ENABLE": 0, "STAT_BOOT": 3}
    )
    behind: dict[str, int | float] = field(default_factory=lambda: {"BRAKE_GAIN": 1.0})
    asked: list[str] = field(default_factory=list)
    described: bytes = b""
    """Its parameters.json."""

    def _asked(self, ask: ipc.Ask, now_s: float) -> list[ipc.Event]:
        self.asked.append(f"{ask.word} {ask.name}".strip())
        if ask.word == "file_read" and self.described and not ask.path.endswith(".xz"):
            return self._quick(
                ask, self.state, ipc.FileDataEvent(ask.id, 0, self.described, len(self.described))
            )
        if ask.word == "file_read":
            return self._refuse(ask, "IN_AIR", "not in the air")
        if ask.word == "param_list":
            return self._quick(ask, self.state, self._told(ask, *self.values))
        if ask.name not in self.values:
            return self._refuse(ask, "BAD_PARAMETER", f"no parameter {ask.name}; near: RTL_ALT")
        if ask.word == "param_set":
            assert ask.value is not None
            if ask.value < 0:
                return self._refuse(ask, "POLICY", "guarded")
            was = self.values[ask.name]
            self.values[ask.name] = type(was)(ask.value)
            if ask.name == "BRAKE_ENABLE":
                self.values |= self.behind
        return self._quick(ask, self.state, self._told(ask, ask.name))

    def _told(self, ask: ipc.Ask, *names: str) -> ipc.ParametersEvent:
        kinds = {int: "int32", float: "real32"}
        return ipc.ParametersEvent(
            ask.id, [ipc.Parameter(n, self.values[n], kinds[type(self.values[n])]) for n in names]
        )


@pytest.fixture
def station(monkeypatch: pytest.MonkeyPatch) -> Station:
    """That the commands talk to, in place of a process of their own."""
    return in_place_of_one(Station(), monkeypatch)


def test_a_list_by_pattern_or_part(station: Station) -> None:
    assert gcs("param", "list", "rtl_*").output.split() == ["RTL_ALT", "15.5", "RTL_TYPE", "1"]
    assert gcs("param", "list", "TYPE").output.split() == ["RTL_TYPE", "1"]
    none = gcs("param", "list", "NOPE")
    assert none.exit_code == ExitCode.DIFFERENT
    assert none.output == "no parameter matches 'NOPE'\n"
    rows = json.loads(gcs("param", "list", "--json").output)
    assert {"name": "RTL_ALT", "value": 15.5, "type": "real32"} in rows


def test_some_by_name_and_one_that_is_none(station: Station) -> None:
    result = gcs("param", "get", "rtl_alt", "RTL_ALTT", "RTL_TYPE")
    assert result.exit_code == ExitCode.USAGE
    assert result.output.split()[-4:] == ["RTL_ALT", "15.5", "RTL_TYPE", "1"]
    assert "near: RTL_ALT" in result.output


@pytest.mark.parametrize(
    ("name", "value", "code"),
    [
        ("RTL_TYPE", "2", ExitCode.DONE),
        ("RTL_TYPE", "-2", ExitCode.REFUSED_BY_GATE),
        ("RTL_TYP", "2", ExitCode.USAGE),
        ("RTL_TYPE", "two", ExitCode.USAGE),
    ],
)
def test_one_is_set(name: str, value: str, code: ExitCode, station: Station) -> None:
    result = gcs("param", "set", name, value)
    assert result.exit_code == code, result.output
    assert station.values["RTL_TYPE"] == (2 if code is ExitCode.DONE else 1)


def test_a_file_is_saved_and_differs_from_another(station: Station, tmp_path: Path) -> None:
    file = tmp_path / "a.params"
    assert gcs("param", "save", file).exit_code == ExitCode.DONE
    assert "1\t1\tRTL_ALT\t15.5\t9" in file.read_text()
    assert gcs("param", "save", file).exit_code == ExitCode.USAGE
    assert gcs("param", "save", tmp_path / "a.txt").exit_code == ExitCode.USAGE
    assert gcs("param", "diff", file).exit_code == ExitCode.DONE
    station.values["RTL_ALT"] = 20.0
    differs = gcs("param", "diff", file, "vehicle")
    assert differs.exit_code == ExitCode.DIFFERENT
    assert differs.output.split() == ["RTL_ALT", "15.5", "20"]
    part = tmp_path / "part.parm"
    part.write_text("RTL_ALT 20\n")
    assert gcs("param", "diff", "vehicle", part).exit_code == ExitCode.DONE
    asked = len(station.asked)
    assert gcs("param", "diff", file, file).exit_code == ExitCode.DONE
    assert len(station.asked) == asked


def test_only_what_differs_is_loaded_and_what_appears_then(
    station: Station, tmp_path: Path
) -> None:
    file = tmp_path / "a.parm"
    file.write_text("BRAKE_ENABLE 1\nBRAKE_GAIN 2.5\nRTL_ALT 15.5\nRTL_TYPE 1\nSTAT_BOOT 9\n")
    asked = gcs("param", "load", file)  # nobody is there to say yes
    assert asked.exit_code == ExitCode.USAGE
    assert "--yes" in asked.output
    assert gcs("param", "load", file, "--dry-run").exit_code == ExitCode.DIFFERENT
    assert not any(each.startswith("param_set") for each in station.asked)
    loaded = gcs("param", "load", file, "--yes")
    assert loaded.exit_code == ExitCode.DONE, loaded.output
    sets = [each for each in station.asked if each.startswith("param_set")]
    assert sets == ["param_set BRAKE_ENABLE", "param_set BRAKE_GAIN"]
    assert station.values["BRAKE_GAIN"] == 2.5
    assert station.values["STAT_BOOT"] == 3
    station.values["RTL_TYPE"] = 5
    rows = json.loads(gcs("param", "load", file, "--yes", "--json").output)
    assert rows == [{"name": "RTL_TYPE", "value": 1.0, "set": True, "why": ""}]
    assert gcs("param", "load", file, "--yes").output == f"nothing differs from {file}\n"


def test_what_failed_is_told_and_says_how_it_exits(station: Station, tmp_path: Path) -> None:
    file = tmp_path / "a.param"
    file.write_text("RTL_ALT,-1\nRTL_TYPE,0\nNOBODYS,1\n")
    loaded = gcs("param", "load", file, "--yes")
    assert loaded.exit_code == ExitCode.REFUSED_BY_GATE
    assert "param set RTL_ALT -1: refused POLICY: guarded" in loaded.output
    assert "NOBODYS: the vehicle does not have it" in loaded.output
    assert "1 of 2 parameters are set" in loaded.output


def test_a_bad_file_is_four_and_no_station_is_started(station: Station, tmp_path: Path) -> None:
    file = tmp_path / "a.parm"
    file.write_text("RTL_ALT x\n")
    for command in ("load", "diff"):
        result = gcs("param", command, file)
        assert result.exit_code == ExitCode.BAD_FILE
        assert "a.parm:1: RTL_ALT: 'x' is not a number" in result.output
    assert station.asked == []


BOUNDS = [{"name": "RTL_ALT", "min": 5, "max": 100, "units": "m"}, {"name": "RTL_TYPE", "max": 3}]


def test_what_is_beyond_the_vehicles_own_bounds_is_not_sent(
    station: Station, tmp_path: Path
) -> None:
    station.described = json.dumps({"version": 1, "parameters": BOUNDS}).encode()
    low = gcs("param", "set", "rtl_alt", "4")
    assert low.exit_code == ExitCode.USAGE
    assert "RTL_ALT: 4 m: the vehicle's own bounds are from 5 to 100" in low.output
    told = json.loads(gcs("param", "set", "RTL_TYPE", "4", "--json").output)
    assert (told["code"], told["numbers"]) == ("BAD_PARAMETER", {"value": 4, "min": None, "max": 3})
    assert gcs("param", "set", "RTL_TYPE", "3").exit_code == ExitCode.DONE
    file = tmp_path / "a.parm"
    file.write_text("RTL_ALT 101\nRTL_TYPE 0\n")
    loaded = gcs("param", "load", file, "--yes")
    assert loaded.exit_code == ExitCode.USAGE
    assert "1 of 2 parameters are set" in loaded.output
    assert (station.values["RTL_ALT"], station.values["RTL_TYPE"]) == (15.5, 0)


def test_what_nobody_describes_is_said_so(station: Station) -> None:
    result = gcs("param", "show", "RTL_TYPE")
    assert result.exit_code == ExitCode.DONE
    assert result.output.splitlines() == [
        "RTL_TYPE = 1 (int32)",
        "the vehicle has no description of it",
    ]
