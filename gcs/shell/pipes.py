"""A station's pipes: lines in, lines out, and neither may ever make the station wait."""

from __future__ import annotations

import contextlib
import os
import select
import socket
import sys
import threading
import time
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
            self.close()
            last, self._rest = self._rest, b""
            return [last] if last else []
        *lines, self._rest = (self._rest + data).split(b"\n")
        if len(self._rest) > MAX_LINE_BYTES:
            lines.append(self._rest)
            self._rest = b""
        return [line for line in lines if line or self._keep_blank]

    def close(self) -> None:
        """Nothing more is read; the descriptor itself stays open, it is the caller's."""
        self.ended = True
        if self._forwarded is not None:
            self._forwarded.close()


def _forward(fd: int, feeder: socket.socket) -> None:
    """Windows only: copy a pipe into a socket until either ends, or is closed by us."""
    with feeder, contextlib.suppress(OSError):
        while data := os.read(fd, MAX_LINE_BYTES):
            feeder.sendall(data)


class LineSink:
    """Lines to the operator.  A slow reader loses snapshots first; nothing ever waits for it.

    `offer` queues a line that may be dropped while others wait; `put` queues one that may not,
    up to `MAX_QUEUED_BYTES`, after which the reader counts as lost (`broken`).  Only `drain`, for
    the very end, waits for the reader.
    """

    def __init__(self, fd: int) -> None:
        self._fd = fd
        self._queue: deque[bytes] = deque()
        self._queued_bytes = 0
        self.broken = False
        self.dropped = 0
        self._hanging_up = False
        self._changed = threading.Condition()
        self._thread: threading.Thread | None = None
        if sys.platform == "win32":
            self._thread = threading.Thread(target=self._write_in_thread, daemon=True)
            self._thread.start()
        else:
            os.set_blocking(fd, False)

    def hang_up(self) -> None:
        """The reader sees the end of file once it has read what is queued."""
        with self._changed:
            self._hanging_up = True
            if not self._queue:
                self._end_file()
            self._changed.notify_all()

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
        if self.broken or self._hanging_up:
            return
        if self._queued_bytes + len(line) > MAX_QUEUED_BYTES:
            with self._changed:
                self._break()
                self._changed.notify_all()
            return
        if self._thread is not None:
            with self._changed:
                self._append(line)
                self._changed.notify()
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
                self._break()
                return
            self._written(written)
            if written < len(line):
                return

    def drain(self, timeout_s: float) -> None:
        """Write what is queued, as the reader takes it, for at most so long (real seconds)."""
        deadline_s = time.monotonic() + timeout_s
        if self._thread is not None:
            with self._changed:
                self._changed.wait_for(lambda: self.broken or not self._queue, timeout_s)
            return
        while self.waiting and (left_s := deadline_s - time.monotonic()) > 0.0:
            if select.select([], [self], [], left_s)[1]:
                self.flush()

    def _written(self, size: int) -> None:
        """So many bytes of the first line have gone."""
        self._queued_bytes -= size
        if size < len(self._queue[0]):
            self._queue[0] = self._queue[0][size:]
        else:
            self._queue.popleft()
        if self._hanging_up and not self._queue:
            self._end_file()

    def _end_file(self) -> None:
        """The descriptor stays what it is for this process: the null device takes its place."""
        null = os.open(os.devnull, os.O_WRONLY)
        os.dup2(null, self._fd)
        os.close(null)
        self.broken = True

    def _break(self) -> None:
        """Nobody reads; what is queued is for nobody."""
        self.broken = True
        self._queue.clear()

    def _write_in_thread(self) -> None:
        """Windows only: pipes cannot be made non-blocking there, so a thread waits instead."""
        while True:
            with self._changed:
                self._changed.wait_for(lambda: self.broken or bool(self._queue))
                if self.broken:
                    return
                line = self._queue[0]
            try:
                written = os.write(self._fd, line)
            except OSError:
                written = 0
            with self._changed:
                if written and self._queue:
                    self._written(written)
                else:
                    self._break()
                self._changed.notify_all()
