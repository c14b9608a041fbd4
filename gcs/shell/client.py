"""The operator's end of the link process: start it, speak JSON lines with it, see it end."""

from __future__ import annotations

import contextlib
import select
import subprocess
import sys
import threading
import time
from collections import deque
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Protocol

import msgspec

from gcs import config, ipc
from gcs.shell.pipes import LineSource

LINK_COMMAND: tuple[str, ...] = (sys.executable, "-m", "gcs.shell.link")
STDERR_LINES = 40
TERMINATE_WAIT_S = 5.0


class Readable(Protocol):
    """Something `select` can wait for."""

    def fileno(self) -> int: ...


@dataclass(frozen=True, slots=True)
class LinkDown:
    """The link process has ended; nothing comes after this.

    `bye` is None where it ended without a good-bye; then `stderr_tail` has its last words.
    """

    bye: ipc.Bye | None
    exit_code: int | None
    stderr_tail: str


Heard = ipc.Event | LinkDown


@dataclass(frozen=True, slots=True)
class Polled:
    """What one wait brought: the link's events in order, and which of the others is readable."""

    heard: list[Heard] = field(default_factory=list)
    ready: list[Readable] = field(default_factory=list)


class LinkClient:
    """A link process of our own.

    `poll` (or `listen`, which does it in a thread) brings its events; `send` writes one command
    and never waits for the link.  Closing its standard input, or dying, tells it that the
    operator is lost.
    """

    def __init__(self, process: subprocess.Popen[bytes]) -> None:
        assert process.stdin is not None
        assert process.stdout is not None
        assert process.stderr is not None
        self._process = process
        self._stdin = process.stdin
        self._stdout, self._stderr = process.stdout, process.stderr
        self._events = LineSource(process.stdout.fileno())
        self._errors = LineSource(process.stderr.fileno())
        self._last_words: deque[str] = deque(maxlen=STDERR_LINES)
        self._bye: ipc.Bye | None = None
        self._down = False
        self._send_lock = threading.Lock()
        self._listener: threading.Thread | None = None

    @classmethod
    def start(cls, link: config.LinkConfig, command: Sequence[str] | None = None) -> LinkClient:
        """Start `python -m gcs.shell.link '<config>'` (or `command` in its place)."""
        words = [*(command or LINK_COMMAND), config.encode(link)]
        process = subprocess.Popen(
            words, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE
        )
        return cls(process)

    @property
    def pid(self) -> int:
        return self._process.pid

    def now_s(self) -> float:
        """The clock that time-outs of an operator's program are measured on."""
        return time.monotonic()

    def send(self, command: ipc.Command) -> bool:
        """Write one command at once.  False where the link has gone.  From any thread."""
        with self._send_lock:
            try:
                self._stdin.write(ipc.encode(command))
                self._stdin.flush()
            except (OSError, ValueError):  # ValueError: we closed it ourselves
                return False
        return True

    def poll(self, timeout_s: float, also: Sequence[Readable] = ()) -> Polled:
        """Wait until the link says something, one of `also` is readable, or the time is over.

        The last thing heard is a `LinkDown`; after it every poll returns it again.
        """
        if self._down:
            return Polled([self._obituary()])
        sources: list[Readable] = [self._events, *also]
        if not self._errors.ended:
            sources.append(self._errors)
        ready, _, _ = select.select(sources, [], [], max(0.0, timeout_s))
        polled = Polled(ready=[source for source in ready if source in also])
        if self._errors in ready:
            self._read_errors()
        if self._events in ready:
            polled.heard.extend(self._read_events())
        return polled

    def listen(self, tell: Callable[[Heard], None]) -> None:
        """Call `tell` for everything heard, in a thread, until the link is down."""
        self._listener = threading.Thread(
            target=self._listen, args=(tell,), name="link-reader", daemon=True
        )
        self._listener.start()

    def close(self) -> LinkDown:
        """See the link process end, by force where it does not after a SIGTERM of its own."""
        with self._send_lock, contextlib.suppress(OSError):
            self._stdin.close()
        try:
            self._process.wait(TERMINATE_WAIT_S)
        except subprocess.TimeoutExpired:
            self._process.terminate()
            try:
                self._process.wait(TERMINATE_WAIT_S)
            except subprocess.TimeoutExpired:
                self._process.kill()
                self._process.wait()
        if self._listener is not None:
            self._listener.join(TERMINATE_WAIT_S)
        self._down = True
        self._stdout.close()
        self._stderr.close()
        return self._obituary()

    def _listen(self, tell: Callable[[Heard], None]) -> None:
        while True:
            for heard in self.poll(3600.0).heard:
                tell(heard)
                if isinstance(heard, LinkDown):
                    return

    def _read_events(self) -> list[Heard]:
        heard: list[Heard] = []
        for line in self._events.read():
            try:
                event = ipc.decode_event(line)
            except msgspec.DecodeError as error:
                event = ipc.Trouble(f"the link wrote a line that is no event: {error}")
            if isinstance(event, ipc.Bye):
                self._bye = event
            heard.append(event)
        if self._events.ended:
            with contextlib.suppress(subprocess.TimeoutExpired):
                self._process.wait(TERMINATE_WAIT_S)
            while not self._errors.ended and select.select([self._errors], [], [], 0.0)[0]:
                self._read_errors()
            self._down = True
            heard.append(self._obituary())
        return heard

    def _read_errors(self) -> None:
        for line in self._errors.read():
            self._last_words.append(line.decode(errors="replace").rstrip())

    def _obituary(self) -> LinkDown:
        return LinkDown(self._bye, self._process.poll(), "\n".join(self._last_words))
