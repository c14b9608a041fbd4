"""Serial lines: a radio's or an autopilot's own port."""

from __future__ import annotations

import errno
import os
import select
import sys
from typing import Final, Protocol

from gcs.shell.endpoints import Endpoint
from gcs.shell.sockets.base import Link, News

REOPEN_NS: Final = 1_000_000_000
"""How often to look whether a device that was unplugged is there again."""


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
    """One device, read and written without waiting; one that was unplugged is opened again."""

    stream = True

    def __init__(self, endpoint: Endpoint) -> None:
        """Raises SerialUnavailable, or OSError if the device cannot be opened."""
        super().__init__(endpoint)
        self._port_open: _Port | None = _open(endpoint)
        self._fd = _watched(self._port_open)
        self._unsent = b""
        """The end of what the line took only a part of."""
        self._reopen_ns = 0
        """While it is lost: when to look for it again."""

    def fileno(self) -> int:
        return self._fd

    @property
    def deadline_ns(self) -> int | None:
        return self._reopen_ns if self._port_open is None else None

    def drain(self, limit: int) -> list[bytes]:
        pieces: list[bytes] = []
        for _ in range(limit if self._port_open is not None else 0):
            try:
                piece = os.read(self._fd, self.read_bytes)
            except BlockingIOError:
                break
            except OSError as error:
                self._lose(error.strerror or str(error))
                break
            if not piece:
                if not pieces and _hung_up(self._fd):
                    self._lose("the device is gone")
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
        if self._port_open is None:
            return data
        try:
            return data[os.write(self._fd, data) :]
        except OSError:
            return data

    def poke(self, now_ns: int) -> list[News]:
        if self._port_open is None and now_ns >= self._reopen_ns:
            self._reopen_ns = now_ns + REOPEN_NS
            self._reopen()
        return super().poke(now_ns)

    def _reopen(self) -> None:
        try:
            self._port_open = _open(self.endpoint)
        except OSError:
            return
        self._fd = _watched(self._port_open)
        self._news.append(News(f"{self.endpoint}: it is there again"))

    def _lose(self, why: str) -> None:
        self.close()
        self._port_open, self._fd, self._unsent = None, -1, b""
        self._news.append(
            News(f"{self.endpoint}: lost, {why}; it is opened when it is there again")
        )

    def close(self) -> None:
        if self._port_open is not None:
            self._port_open.close()

    def describe(self) -> str:
        return f"serial {self.endpoint.device} at {self.endpoint.baud} baud"


def _watched(port: _Port) -> int:
    """What `select` watches of a port."""
    fd = port.fileno()
    os.set_blocking(fd, False)
    return fd


def _hung_up(fd: int) -> bool:
    """Nothing to read is also what a line says whose other end is quiet."""
    poll = select.poll()
    poll.register(fd, select.POLLIN)
    return any(found & (select.POLLHUP | select.POLLERR) for _, found in poll.poll(0))


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
