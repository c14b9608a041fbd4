"""The link's pipes: lines in, lines out, and neither may ever make the link wait."""

from __future__ import annotations

import os
import socket
import sys
import threading
from collections import deque

MAX_LINE_BYTES = 65_536
MAX_QUEUED_BYTES = 1 << 20


class LineSource:
    """Lines from a file descriptor, for a select loop.  `fileno()` is readable when there is news.

    On Windows `select` takes sockets only, so there a thread forwards the descriptor to one.
    """

    def __init__(self, fd: int, *, keep_blank: bool = False) -> None:
        """`keep_blank`: hand out empty lines too, for whoever counts lines."""
        self._keep_blank = keep_blank
        self._rest = b""
        self._forwarded: socket.socket | None = None
        self._fd = fd
        self.ended = False
        if sys.platform == "win32":
            self._forwarded, feeder = socket.socketpair()
            threading.Thread(target=_forward, args=(fd, feeder), daemon=True).start()

    def fileno(self) -> int:
        return self._fd if self._forwarded is None else self._forwarded.fileno()

    def read(self) -> list[bytes]:
        """What came: whole lines without their newline.  Sets `ended` at end of file.

        One read a call, and only after `select` said so, so it does not block.  A line longer
        than `MAX_LINE_BYTES` comes in pieces, each of which will fail to decode, and is told.
        """
        try:
            if self._forwarded is None:
                data = os.read(self._fd, MAX_LINE_BYTES)
            else:
                data = self._forwarded.recv(MAX_LINE_BYTES)
        except OSError:
            data = b""
        if not data:
            self.ended = True
            last, self._rest = self._rest, b""
            return [last] if last else []
        *lines, self._rest = (self._rest + data).split(b"\n")
        if len(self._rest) > MAX_LINE_BYTES:
            lines.append(self._rest)
            self._rest = b""
        return [line for line in lines if line or self._keep_blank]


def _forward(fd: int, feeder: socket.socket) -> None:
    """Windows only: copy a pipe into a socket until either ends."""
    with feeder:
        while data := os.read(fd, MAX_LINE_BYTES):
            feeder.sendall(data)


class LineSink:
    """Lines to the operator.  A slow reader loses snapshots first; nothing ever waits for it.

    `offer` queues a line that may be dropped while others wait; `put` queues one that may not,
    up to `MAX_QUEUED_BYTES`, after which the reader counts as lost (`broken`).
    """

    def __init__(self, fd: int) -> None:
        self._fd = fd
        self._queue: deque[bytes] = deque()
        self._queued_bytes = 0
        self.broken = False
        self.dropped = 0
        self._news = threading.Condition()
        self._thread: threading.Thread | None = None
        if sys.platform == "win32":
            self._thread = threading.Thread(target=self._write_on, daemon=True)
            self._thread.start()
        else:
            os.set_blocking(fd, False)

    @property
    def waiting(self) -> bool:
        """Whether `select` should tell when the pipe can take more."""
        return bool(self._queue) and not self.broken and self._thread is None

    def fileno(self) -> int:
        return self._fd

    def offer(self, line: bytes) -> None:
        """A snapshot: the next one is as good."""
        if self._queue:
            self.dropped += 1
        else:
            self.put(line)

    def put(self, line: bytes) -> None:
        if self.broken:
            return
        if self._queued_bytes + len(line) > MAX_QUEUED_BYTES:
            self.broken = True
            self._queue.clear()
            return
        if self._thread is not None:
            with self._news:
                self._append(line)
                self._news.notify()
        else:
            self._append(line)
            self.flush()

    def _append(self, line: bytes) -> None:
        self._queue.append(line)
        self._queued_bytes += len(line)

    def flush(self) -> None:
        """Write what the pipe takes now."""
        while self._queue and not self.broken:
            line = self._queue[0]
            try:
                written = os.write(self._fd, line)
            except BlockingIOError:
                return
            except OSError:
                self.broken = True
                self._queue.clear()
                return
            self._queued_bytes -= written
            if written < len(line):
                self._queue[0] = line[written:]
                return
            self._queue.popleft()

    def _write_on(self) -> None:
        """Windows only: pipes cannot be made non-blocking there, so a thread waits instead."""
        while not self.broken:
            with self._news:
                self._news.wait_for(lambda: bool(self._queue))
                line = self._queue.popleft()
                self._queued_bytes -= len(line)
            try:
                os.write(self._fd, line)
            except OSError:
                self.broken = True
