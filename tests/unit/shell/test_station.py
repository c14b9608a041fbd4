"""The station process: what keeps it from starting, as its operator is told."""

from __future__ import annotations

import gc
import os
import sys
from contextlib import ExitStack
from pathlib import Path
from typing import cast

import pytest

from gcs.config import StationConfig
from gcs.exit_codes import ExitCode
from gcs.session.effects import Finish
from gcs.shell import sockets, station
from gcs.shell.endpoints import Endpoint
from gcs.shell.pipes import LineSink
from gcs.shell.signals import SignalSource
from gcs.shell.station import CannotStartError, _open_links


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
