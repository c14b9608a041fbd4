"""`gcs vehicle-log` over a scripted station: which log, which way, what is kept and checked."""

from __future__ import annotations

import json
import zlib
from dataclasses import dataclass, field
from pathlib import Path

import pytest

from gcs import ipc
from gcs.exit_codes import ExitCode
from tests.unit.cli.command_line import gcs, in_place_of_one
from tests.unit.operator.fake_station import FakeStation

LOG = bytes(range(256)) * 100
LOGS = [ipc.LogInfo(0, 10, 1_700_000_000), ipc.LogInfo(1, len(LOG), 1_800_000_000)]
LOGS += [ipc.LogInfo(2, 30, 1_600_000_000)]
DAY = "/fs/microsd/log/2027-01-15"


@dataclass
class Station(FakeStation):
    """A PX4 with three logs, the second one the latest; `ftp`: it serves them as files."""

    ftp: bool = True
    breaks_at: int = len(LOG)
    asked: list[ipc.Ask] = field(default_factory=list)

    def _asked(self, ask: ipc.Ask, now_s: float) -> list[ipc.Event]:
        self.asked.append(ask)
        match ask.word:
            case "log_list":
                return self._quick(ask, self.state, ipc.LogsEvent(ask.id, LOGS))
            case "file_list" if self.ftp and ask.path == "/fs/microsd/log":
                files = [ipc.FileInfo("2027-01-15", None)]
                return self._quick(ask, self.state, ipc.FilesEvent(ask.id, files))
            case "file_list" if self.ftp and ask.path == DAY:
                files = [ipc.FileInfo("a.ulg", 10), ipc.FileInfo("b.ulg", len(LOG))]
                return self._quick(ask, self.state, ipc.FilesEvent(ask.id, files))
            case "file_crc":
                crc = zlib.crc32(LOG, 0xFFFFFFFF) ^ 0xFFFFFFFF
                info = ipc.FileInfo(ask.path, None, crc)
                return self._quick(ask, self.state, ipc.FilesEvent(ask.id, [info]))
            case "file_read" | "log_read":
                return self._data(ask)
        return self._refuse(ask, "VEHICLE_REFUSED", "no such file")

    def _data(self, ask: ipc.Ask) -> list[ipc.Event]:
        parts: list[ipc.Event] = [
            ipc.FileDataEvent(ask.id, at, LOG[at : at + 10_000], len(LOG))
            for at in range(ask.offset, self.breaks_at, 10_000)
        ]
        ended = "complete" if self.breaks_at == len(LOG) else "aborted"
        begun = ipc.VerdictEvent(ask.id, ask.word, "accepted")
        return [begun, *parts, ipc.EndingEvent(ask.id, ask.word, ended)]

    @property
    def read(self) -> ipc.Ask:
        """The latest that was asked for bytes."""
        return [ask for ask in self.asked if ask.word.endswith("_read")][-1]


@pytest.fixture
def station(monkeypatch: pytest.MonkeyPatch) -> Station:
    """That the commands talk to, in place of a process of their own."""
    return in_place_of_one(Station(), monkeypatch)


def test_the_list(station: Station) -> None:
    lines = gcs("vehicle-log", "list").output.splitlines()
    assert lines[1].split() == ["1", str(len(LOG)), "2027-01-15", "08:00:00"]
    rows = json.loads(gcs("vehicle-log", "list", "--json").output)
    assert [row["number"] for row in rows] == [0, 1, 2]


@pytest.mark.parametrize(
    ("which", "words", "read"),
    [
        ("latest", [], "file_read"),
        ("1", ["--by", "ftp"], "file_read"),
        ("1", ["--by", "messages"], "log_read"),
    ],
)
def test_a_log_is_fetched(
    which: str, words: list[str], read: str, station: Station, tmp_path: Path
) -> None:
    file = tmp_path / "a.ulg"
    result = gcs("vehicle-log", "get", which, "-o", file, *words)
    assert result.exit_code == ExitCode.DONE, result.output
    assert file.read_bytes() == LOG
    assert station.read.word == read
    path = f"{DAY}/b.ulg" if read == "file_read" else ""
    assert (station.read.path, station.read.item) == (path, 1)
    assert gcs("vehicle-log", "get", which, "-o", file).exit_code == ExitCode.USAGE


def test_what_has_no_file_comes_by_messages(station: Station, tmp_path: Path) -> None:
    station.ftp = False
    file = tmp_path / "a.ulg"
    assert gcs("vehicle-log", "get", "1", "-o", file).exit_code == ExitCode.DONE
    assert station.read.word == "log_read"
    other = gcs("vehicle-log", "get", "1", "-o", tmp_path / "b.ulg", "--by", "ftp")
    assert other.exit_code == ExitCode.NOT_COMPLETED


def test_what_was_broken_off_goes_on(station: Station, tmp_path: Path) -> None:
    file = tmp_path / "a.ulg"
    station.breaks_at = 20_000
    broken = gcs("vehicle-log", "get", "1", "-o", file)
    assert broken.exit_code == ExitCode.NOT_COMPLETED
    assert "a.ulg.part: the same command goes on with it" in broken.output
    assert not file.exists()
    station.breaks_at = len(LOG)
    went_on = gcs("vehicle-log", "get", "1", "-o", file)
    assert went_on.exit_code == ExitCode.DONE
    assert station.read.offset == 20_000
    assert "of which 20000 were there, its check sum is the vehicle's" in went_on.output
    assert file.read_bytes() == LOG


def test_a_part_of_something_else_is_found_by_its_check_sum(
    station: Station, tmp_path: Path
) -> None:
    part = tmp_path / "a.ulg.part"
    part.write_bytes(b"something else")
    result = gcs("vehicle-log", "get", "1", "-o", tmp_path / "a.ulg")
    assert result.exit_code == ExitCode.NOT_COMPLETED
    assert "check sum is not the vehicle's" in result.output
    assert not part.exists()


@pytest.mark.parametrize("which", ["9", "newest"])
def test_a_log_that_is_none(which: str, station: Station) -> None:
    assert gcs("vehicle-log", "get", which).exit_code == ExitCode.USAGE
