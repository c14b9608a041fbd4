"""The station process: what keeps it from starting, as its operator is told."""

from __future__ import annotations

import gc
import os
import select
import socket
import sys
from contextlib import ExitStack
from pathlib import Path
from typing import Literal, cast

import msgspec
import pytest

from gcs.config import StationConfig
from gcs.exit_codes import ExitCode
from gcs.gate.policy.parse import DEFAULT
from gcs.session.effects import Finish
from gcs.session.inputs import ClientCame
from gcs.shell import sockets, station
from gcs.shell.endpoints import Endpoint
from gcs.shell.pipes import LineSink
from gcs.shell.signals import SignalSource
from gcs.shell.station import CannotStartError, _open_client_ports, _open_links, _read_policy


def test_a_serial_line_that_cannot_be_used_is_told_with_its_own_hint(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    def open_link(_: Endpoint) -> sockets.Link:
        raise sockets.SerialUnavailable("serial lines need pyserial", "install pyserial")

    monkeypatch.setattr(sockets, "open_link", open_link)
    with ExitStack() as opened, pytest.raises(CannotStartError) as caught:
        _open_links(StationConfig(endpoints=["/dev/ttyUSB0,57600"]), opened)
    assert caught.value == CannotStartError(
        ExitCode.USAGE, "/dev/ttyUSB0,57600: serial lines need pyserial", "install pyserial"
    )


@pytest.mark.slow  # sockets
@pytest.mark.parametrize(
    ("key", "unsigned", "verified"),
    [("", "refuse", True), ("client.key", "refuse", False), ("client.key", "warn", True)],
)
def test_a_peer_is_to_be_verified_where_nothing_is_taken_without_the_key(
    key: str, unsigned: Literal["refuse", "warn"], verified: bool
) -> None:
    config = StationConfig(clients=["udpin://127.0.0.1:0"], client_key_path=key)
    policy = msgspec.structs.replace(
        DEFAULT, signing=msgspec.structs.replace(DEFAULT.signing, unsigned=unsigned)
    )
    with ExitStack() as opened, socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as peer:
        ports = _open_client_ports(config, policy, [], opened)
        assert ports is not None
        peer.sendto(b"\xfd", ("127.0.0.1", ports.endpoints[0].port))
        readable, _, _ = select.select(ports.waiting, [], [], 60.0)
        came = ports.turn(readable, [], 1_000_000_000)[0]
    assert isinstance(came, ClientCame)
    assert came.verified is verified


def test_what_is_there_at_the_start_is_left_out_of_every_later_garbage_collection(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    """A full collection of 60,000 objects stops the loop (153 ms were seen on a loaded machine)."""
    frozen: list[int] = []

    class Watched:
        def __init__(self, *_: object) -> None:
            """In place of the loop."""

        def run(self) -> Finish:
            frozen.append(gc.get_freeze_count())
            return Finish(0, "")

    monkeypatch.setattr(station, "Loop", Watched)
    monkeypatch.setattr(station, "LocalSocket", _none)
    monkeypatch.setattr(station, "_open_links", lambda *_: [])
    read, write = os.pipe()
    there, before = [[number] for number in range(20_000)], gc.get_freeze_count()
    try:
        with open(os.devnull) as nothing:
            monkeypatch.setattr(sys, "stdin", nothing)
            config = StationConfig(log_dir=str(tmp_path), record=False)
            assert station._run(config, LineSink(write), cast("SignalSource", None)) == 0
    finally:
        os.close(read)
        os.close(write)
    assert frozen[0] - before > len(there)


def _none(*_: object, **__: object) -> None:
    raise OSError("not in this test")


@pytest.mark.parametrize(
    ("text", "clients", "retarget"),
    [
        ("", [], "refuse"),
        ("", ["udpin://127.0.0.1:14551"], "replace"),
        ('retarget = "refuse"', ["udpin://127.0.0.1:14551"], "refuse"),
        ('retarget = "replace"', [], "replace"),
    ],
)
def test_clients_replace_their_own_goals_unless_the_policy_says_otherwise(
    text: str, clients: list[str], retarget: str, tmp_path: Path
) -> None:
    (tmp_path / "my.toml").write_text(text)
    setup = StationConfig(clients=clients, policy_path=str(tmp_path / "my.toml"))
    assert _read_policy(setup)[0].retarget == retarget
