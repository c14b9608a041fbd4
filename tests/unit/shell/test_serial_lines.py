"""A serial line whose device is unplugged, and plugged in again: one end of a pseudo-terminal."""

from __future__ import annotations

import os
import sys
from dataclasses import dataclass
from pathlib import Path

import pytest

if sys.platform == "win32":
    pytest.skip("no serial lines on Windows", allow_module_level=True)

import pty
import termios
import tty

from gcs.shell.endpoints import Endpoint, parse_endpoint
from gcs.shell.sockets import serial
from gcs.shell.sockets.serial import REOPEN_NS, SerialLine


class Opened:
    """What pyserial makes of a device: raw, and reads that wait for nothing."""

    def __init__(self, device: str) -> None:
        self._fd = os.open(device, os.O_RDWR | os.O_NOCTTY | os.O_NONBLOCK)
        tty.setraw(self._fd)
        mode = termios.tcgetattr(self._fd)
        mode[6][termios.VMIN] = mode[6][termios.VTIME] = 0
        termios.tcsetattr(self._fd, termios.TCSANOW, mode)

    def fileno(self) -> int:
        return self._fd

    def close(self) -> None:
        os.close(self._fd)


@dataclass
class Plug:
    """The other end, and the name under which the device is found."""

    device: Path
    master: int = -1

    def put_in(self) -> None:
        self.master, slave = pty.openpty()
        self.device.unlink(missing_ok=True)
        self.device.symlink_to(os.ttyname(slave))
        os.close(slave)

    def pull_out(self) -> None:
        os.close(self.master)
        self.device.unlink()


@pytest.fixture
def plug(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Plug:
    def opened(endpoint: Endpoint) -> Opened:
        return Opened(endpoint.device)

    monkeypatch.setattr(serial, "_open", opened)
    plug = Plug(tmp_path / "tty")
    plug.put_in()
    return plug


def line_to(plug: Plug) -> SerialLine:
    return SerialLine(parse_endpoint(f"serial://{plug.device}:57600"))


def due_ns(line: SerialLine) -> int | None:
    return line.deadline_ns


def test_a_quiet_line_is_not_lost(plug: Plug) -> None:
    line = line_to(plug)
    assert line.drain(9) == []
    assert line.fileno() >= 0
    assert line.poke(0) == []
    os.write(plug.master, b"abc")
    assert line.drain(9) == [b"abc"]
    line.send(b"def")
    assert os.read(plug.master, 9) == b"def"
    line.close()


def test_one_that_is_unplugged_is_told_once_and_watched_no_more(plug: Plug) -> None:
    line = line_to(plug)
    plug.pull_out()
    assert line.drain(9) == []
    assert line.fileno() == -1
    (news,) = line.poke(1)
    assert "lost" in news.text
    assert line.drain(9) == []
    assert line.poke(2) == []
    line.send(b"def")
    assert line.counters.dropped == 1
    line.close()


def test_it_is_opened_again_within_a_second(plug: Plug) -> None:
    line = line_to(plug)
    plug.pull_out()
    line.drain(9)
    line.poke(1)
    plug.put_in()
    assert due_ns(line) == 1 + REOPEN_NS
    assert line.poke(REOPEN_NS) == []
    (news,) = line.poke(1 + REOPEN_NS)
    assert "there again" in news.text
    assert due_ns(line) is None
    os.write(plug.master, b"abc")
    assert line.drain(9) == [b"abc"]
    line.close()
