"""Signals become bytes on a socket that the loop reads, so nothing happens between two lines."""

from __future__ import annotations

import signal
import socket


class SignalSource:
    """SIGTERM and SIGHUP mean "the operator is lost"; SIGINT is the parent's to decide on.

    Must be made in the main thread; lives as long as the process.
    """

    def __init__(self) -> None:
        self._read, self._write = socket.socketpair()
        self._read.setblocking(False)
        self._write.setblocking(False)
        signal.set_wakeup_fd(self._write.fileno(), warn_on_full_buffer=False)
        signal.signal(signal.SIGINT, signal.SIG_IGN)
        for name in ("SIGTERM", "SIGHUP", "SIGBREAK"):
            number = getattr(signal, name, None)
            if number is not None:
                signal.signal(number, lambda *_: None)

    def fileno(self) -> int:
        return self._read.fileno()

    def read(self) -> list[str]:
        """Names of the signals that came since the last call."""
        try:
            numbers = self._read.recv(64)
        except BlockingIOError:
            return []
        return [signal.Signals(number).name for number in numbers]
