"""An operator's way to a station of its own: start it, speak JSON lines with it, see it end."""

from __future__ import annotations

import contextlib
import select
import shlex
import signal
import subprocess
import sys
import threading
import time
from abc import ABC, abstractmethod
from collections import deque
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import PurePath
from typing import Protocol

import msgspec

from gcs import config, ipc
from gcs.shell.pipes import LineSource

STATION_COMMAND: tuple[str, ...] = (sys.executable, "-m", "gcs.shell.station")
STDERR_LINES = 40
TERMINATE_WAIT_S = 5.0
if sys.platform == "win32":
    _CREATION_FLAGS = subprocess.CREATE_NEW_PROCESS_GROUP
else:
    _CREATION_FLAGS = 0


class Readable(Protocol):
    """Something `select` can wait for."""

    def fileno(self) -> int: ...


@dataclass(frozen=True, slots=True)
class StationEnded:
    """The station process has ended; nothing comes after this.

    `bye` is None if it ended without a good-bye; then `stderr_tail` has the last lines that it
    wrote to standard error.
    """

    bye: ipc.Bye | None
    exit_code: int | None
    stderr_tail: str


StationEvent = ipc.Event | StationEnded


@dataclass(frozen=True, slots=True)
class Polled:
    """What one wait brought: the station's events in order, and which other source is readable."""

    events: list[StationEvent] = field(default_factory=list)
    ready: list[Readable] = field(default_factory=list)


class Listened(Protocol):
    """A way to a station, for a program that is called for every event."""

    def send(self, command: ipc.Command) -> bool: ...
    def listen(self, on_event: Callable[[StationEvent], None]) -> None: ...
    def close(self) -> StationEnded: ...


class Polling(Protocol):
    """A way to a station, for a program that waits for its events."""

    def send(self, command: ipc.Command) -> bool: ...
    def poll(self, timeout_s: float, also: Sequence[Readable] = ()) -> Polled: ...
    def now_s(self) -> float: ...
    def close(self) -> StationEnded: ...


class Way(Polling, Listened, Protocol):
    """Either; `StationClient` and `JoinedStation` are ways."""


def command_line(argv: Sequence[str]) -> str:
    """What was typed, for the record: `gcs` stands for the file that it was started as."""
    program, *words = argv or [""]
    name = PurePath(program).name
    return shlex.join(["gcs" if name in ("gcs", "gcs.exe", "__main__.py") else name, *words])


@contextlib.contextmanager
def _ctrl_c_waits() -> Iterator[None]:
    """A program that is started within is not ended by a Ctrl-C before it is in its own session."""
    if sys.platform == "win32":
        yield
        return
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


class EventReader(ABC):
    """What both ways share: a clock, a thread that reads, and the good-bye."""

    def __init__(self) -> None:
        self._bye: ipc.Bye | None = None
        self._ended = False
        self._send_lock = threading.Lock()
        self._listener: threading.Thread | None = None

    def now_s(self) -> float:
        """The clock that time-outs of an operator's program are measured on."""
        return time.monotonic()

    @abstractmethod
    def poll(self, timeout_s: float, also: Sequence[Readable] = ()) -> Polled:
        """Wait until the station says something, one of `also` is readable, or the time is over.

        The last event is a `StationEnded`; after it every poll returns it again.
        """

    def listen(self, on_event: Callable[[StationEvent], None]) -> None:
        """Call `on_event` for every event, in a thread, until the station or the way to it has
        ended."""
        self._listener = threading.Thread(
            target=self._listen, args=(on_event,), name="station-events", daemon=True
        )
        self._listener.start()

    def _listen(self, on_event: Callable[[StationEvent], None]) -> None:
        while True:
            for event in self.poll(3600.0).events:
                on_event(event)
                if isinstance(event, StationEnded):
                    return

    def _event(self, line: bytes, whose: str) -> ipc.Event:
        try:
            event = ipc.decode_event(line)
        except msgspec.DecodeError as error:
            return ipc.Trouble(f"the {whose} wrote a line that is no event: {error}")
        if isinstance(event, ipc.Bye):
            self._bye = event
        return event


class StationClient(EventReader):
    """A station process that was started by this program, and ends with it.

    `poll` (or `listen`, which does it in a thread) brings its events; `send` writes one command
    and never waits for the station.  When its standard input is closed, or this program dies, the
    station knows that the operator is lost.
    """

    def __init__(self, process: subprocess.Popen[bytes], *, keep: bool = False) -> None:
        """`keep`: the station lives on without us (`StationConfig.keep`)."""
        super().__init__()
        assert process.stdin is not None
        assert process.stdout is not None
        assert process.stderr is not None
        self._process = process
        self._keep = keep
        self._stdin = process.stdin
        self._stdout, self._stderr = process.stdout, process.stderr
        self._events = LineSource(process.stdout.fileno())
        self._errors = LineSource(process.stderr.fileno())
        self._error_lines: deque[str] = deque(maxlen=STDERR_LINES)

    @classmethod
    def start(
        cls, setup: config.StationConfig, command: Sequence[str] | None = None
    ) -> StationClient:
        """Start `python -m gcs.shell.station '<config>'` (or `command` in its place)."""
        if not setup.command_line:
            setup = msgspec.structs.replace(setup, command_line=command_line(sys.argv))
        words = [*(command or STATION_COMMAND), config.encode(setup)]
        # In a session of its own: a Ctrl-C is for the operator's program, which then leaves in
        # good order; the station hears of everything through its pipe.
        with _ctrl_c_waits():
            process = subprocess.Popen(
                words,
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                stderr=subprocess.PIPE,
                start_new_session=True,
                creationflags=_CREATION_FLAGS,
            )
        return cls(process, keep=setup.keep)

    @property
    def pid(self) -> int:
        return self._process.pid

    @property
    def running(self) -> bool:
        """Whether the process has not ended yet."""
        return self._process.poll() is None

    def send(self, command: ipc.Command) -> bool:
        """Write one command at once.  False if the station has ended.  From any thread."""
        with self._send_lock:
            try:
                self._stdin.write(ipc.encode(command))
                self._stdin.flush()
            except (OSError, ValueError):  # ValueError: we closed it ourselves
                return False
        return True

    def poll(self, timeout_s: float, also: Sequence[Readable] = ()) -> Polled:
        if self._ended:
            return Polled([self._end()])
        sources: list[Readable] = [self._events, *also]
        if not self._errors.ended:
            sources.append(self._errors)
        ready, _, _ = select.select(sources, [], [], max(0.0, timeout_s))
        polled = Polled(ready=[source for source in ready if source in also])
        if self._errors in ready:
            self._read_errors()
        if self._events in ready:
            polled.events.extend(self._read_events())
        return polled

    def close(self) -> StationEnded:
        """Wait for the process to end; send it a SIGTERM, then kill it, if it does not.

        One that is kept is left alone.
        """
        with self._send_lock, contextlib.suppress(OSError):
            self._stdin.close()
        if self._keep and self._process.poll() is None:
            self._process.returncode = 0  # nobody is to wait for it any more
        elif not self._wait_for_end(TERMINATE_WAIT_S):
            self._process.terminate()
            if not self._wait_for_end(TERMINATE_WAIT_S):
                self._process.kill()
                self._process.wait()
        if self._listener is not None:
            self._listener.join(TERMINATE_WAIT_S)
        self._ended = True
        self._events.close()
        self._errors.close()
        self._stdout.close()
        self._stderr.close()
        return self._end()

    def _wait_for_end(self, timeout_s: float) -> bool:
        """Whether the process ended in time; its last events are read meanwhile."""
        deadline_s = self.now_s() + timeout_s
        while self._listener is None and not self._ended and self.now_s() < deadline_s:
            self.poll(deadline_s - self.now_s())
        try:
            self._process.wait(max(0.0, deadline_s - self.now_s()))
        except subprocess.TimeoutExpired:
            return False
        return True

    def _read_events(self) -> list[StationEvent]:
        events: list[StationEvent] = [self._event(line, "link") for line in self._events.read()]
        if self._events.ended:
            if self._bye is None or not self._bye.goes_on:
                with contextlib.suppress(subprocess.TimeoutExpired):
                    self._process.wait(TERMINATE_WAIT_S)
            while not self._errors.ended and select.select([self._errors], [], [], 0.0)[0]:
                self._read_errors()
            self._ended = True
            events.append(self._end())
        return events

    def _read_errors(self) -> None:
        for line in self._errors.read():
            self._error_lines.append(line.decode(errors="replace").rstrip())

    def _end(self) -> StationEnded:
        return StationEnded(self._bye, self._process.poll(), "\n".join(self._error_lines))
