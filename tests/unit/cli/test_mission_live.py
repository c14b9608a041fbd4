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
        (mission_live.download, ["-o", "FILE"], ["mission_download"]),
        (mission_live.clear, [], ["mission_clear"]),
    ],
    ids=["upload", "fly", "download", "clear"],
)
def test_each_asks_for_its_words_and_is_done(
    command: click.Command, args: list[str], words: list[str], client: FakeClient
) -> None:
    file = resources.find("demo")
    result = CliRunner().invoke(command, [str(file) if arg == "FILE" else arg for arg in args])
    assert result.exit_code == Exit.DONE, result.output
    asks = [sent for sent in client.sent if isinstance(sent, ipc.Ask)]
    assert [ask.word for ask in asks] == words
    assert {ask.path for ask in asks} <= {"", str(file)}


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
