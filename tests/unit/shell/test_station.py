"""The station process: what keeps it from starting, as its operator is told."""

from __future__ import annotations

from contextlib import ExitStack

import pytest

from gcs.config import StationConfig
from gcs.exit_codes import ExitCode
from gcs.shell import sockets
from gcs.shell.endpoints import Endpoint
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
