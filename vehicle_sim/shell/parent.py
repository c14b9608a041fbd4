"""Standard input as a lifeline: its end means that whoever started the vehicle is gone."""

from __future__ import annotations

import os
import socket
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
    """Where `select` takes any file."""

    def fileno(self) -> int:
        return sys.stdin.fileno()

    def read(self) -> bytes:
        return os.read(self.fileno(), 4096)


class Forwarded:
    """Where `select` takes sockets only (Windows): a thread reads and passes it on."""

    def __init__(self) -> None:
        self._ear, mouth = socket.socketpair()
        threading.Thread(target=_forward, args=(mouth,), daemon=True).start()

    def fileno(self) -> int:
        return self._ear.fileno()

    def read(self) -> bytes:
        return self._ear.recv(4096)


def _forward(mouth: socket.socket) -> None:
    while data := os.read(sys.stdin.fileno(), 4096):
        mouth.sendall(data)
    mouth.close()


def standard_input() -> ParentPipe:
    return Forwarded() if sys.platform == "win32" else Pipe()
