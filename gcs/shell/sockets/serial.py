"""Serial lines: a radio's or an autopilot's own port."""

from __future__ import annotations

import errno
import os
import sys
from typing import Protocol

from gcs.shell.endpoints import Endpoint
from gcs.shell.sockets.base import Link


class SerialUnavailable(OSError):  # noqa: N818 - it names the condition
    """Serial lines do not work here; `hint` says what to do."""

    def __init__(self, why: str, hint: str) -> None:
        super().__init__(errno.ENOSYS, why)
        self.hint = hint

    def __str__(self) -> str:
        return str(self.strerror)


class _Port(Protocol):
    """What is used of pyserial's `Serial`."""

    def fileno(self) -> int: ...
    def close(self) -> None: ...


class SerialLine(Link):
    """One device, read and written without waiting."""

    stream = True

    def __init__(self, endpoint: Endpoint) -> None:
        """Raises SerialUnavailable, or OSError if the device cannot be opened."""
        super().__init__(endpoint)
        self._port_open = _open(endpoint)
        self._fd = self._port_open.fileno()
        os.set_blocking(self._fd, False)
        self._lost = False
        self._unsent = b""
        """The end of what the line took only a part of."""

    def fileno(self) -> int:
        return -1 if self._lost else self._fd

    def drain(self, limit: int) -> list[bytes]:
        pieces: list[bytes] = []
        for _ in range(limit):
            try:
                piece = os.read(self._fd, self.read_bytes)
            except BlockingIOError:
                break
            except OSError as error:
                self._lose(error.strerror or str(error))
                break
            if not piece:
                break
            pieces.append(piece)
        return pieces

    def send(self, data: bytes) -> None:
        """What the line has no room for is dropped whole: half a frame would spoil the next."""
        if self._unsent:
            self._unsent = self._write(self._unsent)
        if self._unsent:
            self.counters.dropped += 1
            return
        rest = self._write(data)
        if rest == data:
            self.counters.dropped += 1
        else:
            self._unsent = rest

    def _write(self, data: bytes) -> bytes:
        """What is left of it."""
        try:
            return data[os.write(self._fd, data) :]
        except OSError:
            return data

    def _lose(self, why: str) -> None:
        self._lost = True
        self._news.append(f"{self.endpoint}: lost, {why}")

    def close(self) -> None:
        self._port_open.close()

    def describe(self) -> str:
        return f"serial {self.endpoint.device} at {self.endpoint.baud} baud"


def _open(endpoint: Endpoint) -> _Port:
    if sys.platform == "win32":
        why = "a select loop cannot watch a serial line on Windows"
        raise SerialUnavailable(why, "let mavlink-router or QGroundControl forward it to UDP")
    try:
        import serial
    except ImportError as error:
        why = "serial lines need pyserial, which is not installed"
        raise SerialUnavailable(why, "pip install 'mavgate[serial]'") from error
    port: _Port = serial.Serial(endpoint.device, endpoint.baud, timeout=0, exclusive=True)
    return port
