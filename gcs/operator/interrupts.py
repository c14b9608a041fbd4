"""Signals of an operator's program as something that `select` can wait for."""

from __future__ import annotations

import signal
import socket
from types import FrameType, TracebackType

_NAMES = ("SIGINT", "SIGTERM", "SIGHUP", "SIGBREAK")


class Interrupts:
    """Within the block a Ctrl-C (or SIGTERM, SIGHUP) is noted in `name` and wakes `select`.

    Nothing is raised, so that no line is left half done: whoever waits looks at `name` and leaves
    in good order.  Main thread only.
    """

    def __init__(self) -> None:
        self.name = ""
        self._read, self._write = socket.socketpair()
        self._read.setblocking(False)
        self._write.setblocking(False)

    def __enter__(self) -> Interrupts:
        self._old_fd = signal.set_wakeup_fd(self._write.fileno(), warn_on_full_buffer=False)
        numbers = [getattr(signal, name) for name in _NAMES if hasattr(signal, name)]
        self._old = {number: signal.signal(number, self._note) for number in numbers}
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        for number, handler in self._old.items():
            signal.signal(number, handler)
        signal.set_wakeup_fd(self._old_fd)
        self._read.close()
        self._write.close()

    def fileno(self) -> int:
        return self._read.fileno()

    def forget(self) -> None:
        """Be ready for the next one: leaving takes a while, and a second Ctrl-C ends that."""
        self.name = ""
        try:
            self._read.recv(64)
        except BlockingIOError:
            return

    def _note(self, number: int, _frame: FrameType | None) -> None:
        self.name = signal.Signals(number).name
