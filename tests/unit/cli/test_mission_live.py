"""`gcs mission upload, download, fly, clear`: the requests that they send."""

from __future__ import annotations

from pathlib import Path

import pytest

from gcs import ipc, resources
from gcs.cli import oneshot_session
from gcs.config import StationConfig
from gcs.exit_codes import ExitCode
from tests.unit.cli.command_line import gcs
from tests.unit.operator.fake_station import FakeConnection, FakeStation, NoInterrupts


@pytest.fixture
def connection(monkeypatch: pytest.MonkeyPatch) -> FakeConnection:
    """To the station that the commands will talk to, in place of a process of their own."""
    fake = FakeConnection(FakeStation("airborne"))

    def run(
        _: StationConfig, how: oneshot_session.OneShotConfig, task: oneshot_session.Task
    ) -> int:
        return oneshot_session.run_over(fake, NoInterrupts(), how, task)

    monkeypatch.setattr(oneshot_session, "run", run)
    return fake


@pytest.mark.parametrize(
    ("command", "args", "words"),
    [
        ("upload", ["FILE"], ["mission_upload"]),
        ("fly", ["FILE"], ["control", "mission_upload", "mission_start"]),
        ("download", ["-o", "NEW"], ["mission_download"]),
        ("download", ["NEW"], ["mission_download"]),
        ("clear", [], ["mission_clear"]),
        ("set-current", ["3"], ["mission_set_current"]),
    ],
)
def test_each_sends_its_requests_and_is_done(
    command: str, args: list[str], words: list[str], connection: FakeConnection, tmp_path: Path
) -> None:
    paths = {"FILE": str(resources.find("demo")), "NEW": str(tmp_path / "new.plan")}
    result = gcs("mission", command, *[paths.get(arg, arg) for arg in args])
    assert result.exit_code == ExitCode.DONE, result.output
    requests = [sent for sent in connection.sent if isinstance(sent, ipc.Ask)]
    assert [request.word for request in requests] == words
    assert {request.path for request in requests} <= {"", *paths.values()}


@pytest.mark.parametrize(
    ("name", "told"), [("there.plan", "exists already"), ("new.kml", "the suffix names no format")]
)
def test_a_download_goes_to_a_new_file_of_a_format_we_know(
    name: str, told: str, connection: FakeConnection, tmp_path: Path
) -> None:
    (tmp_path / "there.plan").write_text("precious")
    result = gcs("mission", "download", "-o", tmp_path / name)
    assert result.exit_code == ExitCode.USAGE
    assert told in result.output
    assert connection.sent == []


def test_a_download_goes_to_one_file(connection: FakeConnection, tmp_path: Path) -> None:
    result = gcs("mission", "download", tmp_path / "a.plan", "-o", tmp_path / "b.plan")
    assert result.exit_code == ExitCode.USAGE
    assert "one file, not two" in result.output
    assert connection.sent == []


def test_a_download_writes_over_a_file_with_force(
    connection: FakeConnection, tmp_path: Path
) -> None:
    there = tmp_path / "there.plan"
    there.write_text("old")
    result = gcs("mission", "download", "-o", there, "--force")
    assert result.exit_code == ExitCode.DONE
    assert any(isinstance(sent, ipc.Ask) and sent.path == str(there) for sent in connection.sent)


def test_a_file_that_is_no_plan_is_four_and_no_station_is_started(
    connection: FakeConnection, tmp_path: Path
) -> None:
    file = tmp_path / "plan.toml"
    file.write_text("schema = 1\nwaypint = 2\n")
    result = gcs("mission", "fly", file)
    assert result.exit_code == ExitCode.BAD_FILE
    assert str(file) in result.output
    assert connection.sent == []


def test_a_file_that_is_not_there_is_four_and_no_station_is_started(
    connection: FakeConnection,
) -> None:
    result = gcs("mission", "upload", "no such file.plan")
    assert result.exit_code == ExitCode.BAD_FILE
    assert "no such mission file" in result.output
    assert connection.sent == []
