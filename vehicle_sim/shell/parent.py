"""Standard input as a lifeline: its end means that whoever started the vehicle is gone."""

from __future__ import annotations

import os
import socket
import stat
import sys
import threading
from typing import Protocol


class ParentPipe(Protocol):
    """Something to watch for reading."""

    def fileno(self) -> int: ...
    def read(self) -> bytes:
        """What is there to read; nothing at its end."""
        ...


class Pipe:
    """A pipe, a socket or a terminal, where `select` takes it."""

    def fileno(self) -> int:
        return sys.stdin.fileno()

    def read(self) -> bytes:
        return os.read(self.fileno(), 4096)


class Forwarded:
    """What `select` does not take: a thread reads it and passes it on through a socket.

    That is everything on Windows, and files, /dev/null among them, elsewhere.
    """

    def __init__(self) -> None:
        self._ear, mouth = socket.socketpair()
        threading.Thread(target=_forward, args=(mouth,), daemon=True).start()

    def fileno(self) -> int:
        return self._ear.fileno()

    def read(self) -> bytes:
        return self._ear.recv(4096)


def _forward(mouth: socket.socket) -> None:
    # Without a standard input (`<&-`) it has ended before it began.
    while sys.stdin is not None and (data := os.read(sys.stdin.fileno(), 4096)):
        mouth.sendall(data)
    mouth.close()


def standard_input() -> ParentPipe:
    return Pipe() if sys.platform != "win32" and _can_be_selected() else Forwarded()


def _can_be_selected() -> bool:
    if sys.stdin is None:
        return False
    kind = os.fstat(sys.stdin.fileno()).st_mode
    return stat.S_ISFIFO(kind) or stat.S_ISSOCK(kind) or sys.stdin.isatty()
