"""`--live [HOST:PORT]` and `gcs live [HOST:PORT]`: how an address is read and told."""

from __future__ import annotations

import click
import pytest
from click.testing import CliRunner

from gcs.cli.live_option import ADDRESS, ALLOW, LIVE, LiveView, lines_about, live_view
from gcs.cli.options import with_options
from gcs.live.program import Opened


@pytest.mark.parametrize(
    ("text", "address"),
    [
        ("127.0.0.1", ("127.0.0.1", 0)),
        ("127.0.0.1:9000", ("127.0.0.1", 9000)),
        ("9000", ("127.0.0.1", 9000)),
        (":9000", ("127.0.0.1", 9000)),
        ("localhost", ("localhost", 0)),
        ("0.0.0.0:8765", ("0.0.0.0", 8765)),
        ("[::1]:8765", ("::1", 8765)),
        ("[::1]", ("::1", 0)),
    ],
)
def test_an_address(text: str, address: tuple[str, int]) -> None:
    assert ADDRESS.convert(text, None, None) == address


@pytest.mark.parametrize("text", ["localhost:", "localhost:x", "localhost:0", "1.2.3.4:65536", "0"])
def test_no_address(text: str) -> None:
    with pytest.raises(click.BadParameter, match="is not as in"):
        ADDRESS.convert(text, None, None)


@pytest.mark.parametrize(
    ("words", "address"),
    [
        ([], None),
        (["--live"], ("127.0.0.1", 0)),
        (["--live", "--other"], ("127.0.0.1", 0)),
        (["--live", "9000"], ("127.0.0.1", 9000)),
        (["--live=localhost:9000"], ("localhost", 9000)),
    ],
)
def test_the_option_takes_an_address_or_none(
    words: list[str], address: tuple[str, int] | None
) -> None:
    assert viewed(words) == (0, [address and LiveView(*address)])


def viewed(words: list[str]) -> tuple[int, list[LiveView | None]]:
    """The exit code of a command with these words, and the live view that it was to open."""
    seen = []

    @click.command()
    @with_options(LIVE, ALLOW)
    @click.option("--other", is_flag=True)
    def command(live: tuple[str, int] | None, allow: tuple[str, ...], other: bool) -> None:
        seen.append(live_view(live, allow))

    return CliRunner().invoke(command, words).exit_code, seen


def test_who_is_let_in_too_is_said_with_a_live_view() -> None:
    allow = ["--allow", "https://viewer.example", "--allow", "station.lan"]
    let_in = ("https://viewer.example", "station.lan")
    assert viewed(["--live", *allow]) == (0, [LiveView("127.0.0.1", 0, let_in)])
    assert viewed(allow) == (2, [])


@pytest.mark.parametrize(
    ("host", "warned"),
    [
        ("127.0.0.1", False),
        ("127.8.8.8", False),
        ("::1", False),
        ("localhost", False),
        ("0.0.0.0", True),
        ("192.168.1.7", True),
        ("my-laptop", True),
    ],
)
def test_whoever_lets_other_machines_in_is_told(host: str, warned: bool) -> None:
    lines = lines_about(Opened("ws://x:1", "abcd", "logs/x_viewer-1.json"), host)
    assert lines[0] == "live view: ws://x:1"
    assert lines[2].strip() == "logs/x_viewer-1.json"
    assert '{"code": "abcd"}' in "\n".join(lines)
    assert ("can reach" in lines[-1]) == warned
