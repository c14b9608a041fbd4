"""`gcs mission upload, download, fly, clear`: what they ask of the link."""

from __future__ import annotations

from pathlib import Path

import click
import pytest
from click.testing import CliRunner

from gcs import ipc, resources
from gcs.cli import errand, mission_live
from gcs.cli.exits import Exit
from gcs.config import LinkConfig
from tests.unit.cli.fake_link import FakeClient, FakeLink, NoInterrupts


@pytest.fixture
def client(monkeypatch: pytest.MonkeyPatch) -> FakeClient:
    """The link that the commands will talk to, in place of a process of their own."""
    fake = FakeClient(FakeLink("airborne"))

    def run(_config: LinkConfig, how: errand.ErrandConfig, what: errand.Errand) -> int:
        return errand.run_over(fake, NoInterrupts(), how, what)

    monkeypatch.setattr(errand, "run", run)
    return fake


@pytest.mark.parametrize(
    ("command", "args", "words"),
    [
        (mission_live.upload, ["FILE"], ["mission_upload"]),
        (mission_live.fly, ["FILE"], ["control", "mission_upload", "mission_start"]),
        (mission_live.download, ["-o", "NEW"], ["mission_download"]),
        (mission_live.clear, [], ["mission_clear"]),
    ],
    ids=["upload", "fly", "download", "clear"],
)
def test_each_asks_for_its_words_and_is_done(
    command: click.Command, args: list[str], words: list[str], client: FakeClient, tmp_path: Path
) -> None:
    paths = {"FILE": str(resources.find("demo")), "NEW": str(tmp_path / "new.plan")}
    result = CliRunner().invoke(command, [paths.get(arg, arg) for arg in args])
    assert result.exit_code == Exit.DONE, result.output
    asks = [sent for sent in client.sent if isinstance(sent, ipc.Ask)]
    assert [ask.word for ask in asks] == words
    assert {ask.path for ask in asks} <= {"", *paths.values()}


@pytest.mark.parametrize(
    ("name", "told"), [("there.plan", "exists already"), ("new.kml", "the suffix names no format")]
)
def test_a_download_goes_to_a_new_file_of_a_format_we_know(
    name: str, told: str, client: FakeClient, tmp_path: Path
) -> None:
    (tmp_path / "there.plan").write_text("precious")
    result = CliRunner().invoke(mission_live.download, ["-o", str(tmp_path / name)])
    assert result.exit_code == Exit.USAGE
    assert told in result.output
    assert client.sent == []


def test_a_download_writes_over_a_file_with_force(client: FakeClient, tmp_path: Path) -> None:
    there = tmp_path / "there.plan"
    there.write_text("old")
    result = CliRunner().invoke(mission_live.download, ["-o", str(there), "--force"])
    assert result.exit_code == Exit.DONE
    assert any(isinstance(sent, ipc.Ask) and sent.path == str(there) for sent in client.sent)


def test_a_file_that_is_no_plan_is_four_and_no_link_is_started(
    client: FakeClient, tmp_path: Path
) -> None:
    file = tmp_path / "plan.toml"
    file.write_text("schema = 1\nwaypint = 2\n")
    result = CliRunner().invoke(mission_live.fly, [str(file)])
    assert result.exit_code == Exit.BAD_FILE
    assert str(file) in result.output
    assert client.sent == []


def test_a_file_that_is_not_there_is_four_and_no_link_is_started(client: FakeClient) -> None:
    result = CliRunner().invoke(mission_live.upload, ["no such file.plan"])
    assert result.exit_code == Exit.BAD_FILE
    assert "no such mission file" in result.output
    assert client.sent == []
