"""The loop with everything around it made of paper: a core, a clock, links, pipes of the test's.

`Rig.run` takes the test's steps: one is done before each turn of the loop.  After the last one the
core answers its next `Wake` with `Finish`, so a loop that is right always ends.  Time moves only
where a step moves it.
"""

from __future__ import annotations

import os
import socket
from collections.abc import Callable, Iterator, Sequence

from gcs import ipc
from gcs.session.effects import Effect, Finish, Record
from gcs.session.inputs import Input, RecorderChanged, Wake
from gcs.shell.client_ports import ClientPorts
from gcs.shell.clock import Clock
from gcs.shell.endpoints import Endpoint, Kind
from gcs.shell.loop import Loop
from gcs.shell.operator_sockets import OperatorSockets
from gcs.shell.pipes import LineSink, LineSource
from gcs.shell.recording import RecorderNews, Recording
from gcs.shell.signals import SignalSource
from gcs.shell.sim import SimProcess
from gcs.shell.sockets import Link
from gcs.shell.sockets.base import News

MS = 1_000_000
TICK_NS = 50 * MS
START_NS = 1_000 * MS
DONE = Finish(0, "the script is over")
EXIT_BUG = 70

Step = Callable[[], object]


class PaperClock(Clock):
    """Time stands still; asked how long to wait, it does the test's next step instead."""

    def __init__(self) -> None:
        super().__init__()
        self.time_ns = START_NS
        self.waits_s: list[float] = []
        self.steps: Iterator[Step] = iter(())
        self.after_last: Step = lambda: None

    def now_ns(self) -> int:
        return self.time_ns

    def seconds_until(self, deadline_ns: int) -> float:
        self.waits_s.append(max(0.0, (deadline_ns - self.time_ns) / 1e9))
        next(self.steps, self.after_last)()
        return 0.0


class PaperCore:
    """Notes what it is given and when; answers as the test says, and ticks on a grid."""

    def __init__(self) -> None:
        self.deadline_ns = START_NS + TICK_NS
        self.given: list[tuple[int, Input]] = []
        self.answers: dict[Input, Sequence[Effect]] = {}
        self.fails_at: set[Input] = set()
        self.raises: dict[Input, Exception] = {}
        self.does: dict[Input, Step] = {}
        self.faults: list[tuple[Input, str]] = []
        self.answer_to_fault: Sequence[Effect] = ()
        self.last_wake: Sequence[Effect] = ()

    @property
    def inputs(self) -> list[Input]:
        return [given for _, given in self.given]

    def handle(self, given: Input, now_ns: int) -> Sequence[Effect]:
        self.given.append((now_ns, given))
        self.does.get(given, lambda: None)()
        if given in self.fails_at:
            raise ZeroDivisionError("planted")
        if given in self.raises:
            raise self.raises[given]
        if isinstance(given, Wake):
            self.deadline_ns += TICK_NS * (1 + (now_ns - self.deadline_ns) // TICK_NS)
            if self.last_wake:
                return self.last_wake
        return self.answers.get(given, ())

    def fault(self, given: Input, report: str, now_ns: int) -> Sequence[Effect]:
        """As the session does: what fails on the clock ends it."""
        self.faults.append((given, report))
        if isinstance(given, Wake):
            return [*self.answer_to_fault, Finish(EXIT_BUG, "an internal error")]
        return self.answer_to_fault


class PaperLink(Link):
    """`bring` makes it readable; what is sent is kept."""

    def __init__(self) -> None:
        super().__init__(Endpoint(Kind.UDP_IN, "127.0.0.1", 14550))
        self._near, self._far = socket.socketpair()
        self._came: list[bytes] = []
        self.sent: list[bytes] = []
        self.pokes_ns: list[int] = []
        self.due_ns: int | None = None
        self.open = True
        self.left_out: list[bytes] = []
        self.send_fails = False
        self.drain_fails = False

    def bring(self, *datagrams: bytes) -> None:
        self._came += datagrams
        self._far.send(b"!")

    def tell(self, line: str, *, trouble: bool = False) -> None:
        """News of the link itself, for the next poke."""
        self._news.append(News(line, trouble))

    def fileno(self) -> int:
        return self._near.fileno() if self.open else -1

    def drain(self, limit: int) -> list[bytes]:
        self._near.recv(64)
        if self.drain_fails:
            raise RuntimeError("planted: drain")
        came, self._came = self._came[:limit], self._came[limit:]
        if self._came:
            self._far.send(b"!")
        return came

    def send(self, data: bytes) -> None:
        if self.send_fails:
            raise RuntimeError("planted: send")
        self.sent.append(data)

    def leave_out(self, data: bytes, silent_ns: int) -> None:
        self.left_out.append(data)

    def poke(self, now_ns: int) -> list[News]:
        self.pokes_ns.append(now_ns)
        if self.due_ns is not None and now_ns >= self.due_ns:
            self.due_ns = None
        return super().poke(now_ns)

    @property
    def deadline_ns(self) -> int | None:
        return self.due_ns

    def describe(self) -> str:
        return "a paper link"

    def close(self) -> None:
        self._near.close()
        self._far.close()


class PaperRecording(Recording):
    """Keeps items and times; tells the changes that the test puts in its way."""

    def __init__(self) -> None:
        super().__init__(None)
        self.written: list[tuple[int, object]] = []
        self.news: list[RecorderChanged] = []
        self.upkeep_news: list[RecorderNews] = []
        self.fails_at: list[object] = []
        self.due_ns = 1 << 62

    @property
    def deadline_ns(self) -> int:
        return self.due_ns

    def write(self, item: object, now_ns: int) -> None:
        if item in self.fails_at:
            raise RuntimeError("planted: write")
        self.written.append((now_ns, item))

    def changes(self) -> Iterator[RecorderChanged]:
        news, self.news = self.news, []
        yield from news

    def upkeep(self, now_ns: int) -> Iterator[RecorderNews]:
        news, self.upkeep_news = self.upkeep_news, []
        yield from news


class PaperSignals(SignalSource):
    """Signals that nobody sends to this process."""

    def __init__(self) -> None:
        self._read, self._write = socket.socketpair()
        self._names: list[str] = []

    def bring(self, *names: str) -> None:
        self._names += names
        self._write.send(b"!")

    def read(self) -> list[str]:
        self._read.recv(64)
        names, self._names = self._names, []
        return names

    def close(self) -> None:
        self._read.close()
        self._write.close()


class PaperSim(SimProcess):
    """A vehicle's process: its output, and how it ended."""

    def __init__(self, out_fd: int) -> None:
        self.lines = LineSource(out_fd)

    def ended(self) -> int:
        return 3


class Rig:
    """One loop, and the other end of everything that it holds."""

    def __init__(
        self,
        links: int = 2,
        others: OperatorSockets | None = None,
        on_snapshot: Callable[[ipc.Snapshot], None] = lambda _: None,
        recording: Recording | None = None,
        client_ports: ClientPorts | None = None,
    ) -> None:
        self.clock, self.core, self.recording = PaperClock(), PaperCore(), PaperRecording()
        self.links = [PaperLink() for _ in range(links)]
        self.signals = PaperSignals()
        operator_fd, self._operator_in = os.pipe()
        self._screen_out, screen_fd = os.pipe()
        sim_fd, self._sim_in = os.pipe()
        self._fds = {operator_fd, self._operator_in, self._screen_out, screen_fd, sim_fd}
        self._fds.add(self._sim_in)
        self.screen = LineSink(screen_fd)
        self._loop = Loop(
            self.core,
            self.clock,
            self.links,
            LineSource(operator_fd),
            self.screen,
            recording or self.recording,
            self.signals,
            PaperSim(sim_fd),
            others,
            on_snapshot,
            client_ports,
        )

    def run(self, *steps: Step) -> Finish:
        """Run the loop through the steps, one a turn, and then to its end."""
        self.clock.steps = iter(steps)
        self.clock.after_last = self._end
        return self._loop.run()

    def _end(self) -> None:
        self.core.last_wake = (DONE,)
        self.clock.time_ns = self.core.deadline_ns

    # ---------------------------------------------------------------------------- steps

    def advance(self, milliseconds: float) -> None:
        self.clock.time_ns += round(milliseconds * MS)

    def type(self, text: str | bytes) -> None:
        """Bytes from the operator."""
        os.write(self._operator_in, text.encode() if isinstance(text, str) else text)

    def hang_up(self) -> None:
        """The operator's end of the command stream is closed."""
        self._close(self._operator_in)

    def look_away(self) -> None:
        """Nobody reads the screen's pipe any more."""
        self._close(self._screen_out)

    def sim_prints(self, text: str) -> None:
        os.write(self._sim_in, text.encode())

    def sim_ends(self) -> None:
        self._close(self._sim_in)

    # ----------------------------------------------------------------------------- looks

    def events(self) -> list[ipc.Event]:
        """What the operator can read by now."""
        os.set_blocking(self._screen_out, False)
        data = b""
        try:
            while piece := os.read(self._screen_out, 1 << 16):
                data += piece
        except BlockingIOError:
            pass
        return [ipc.decode_event(line) for line in data.splitlines()]

    def times_ns(self, given: Input) -> list[int]:
        return [time_ns for time_ns, came in self.core.given if came == given]

    def close(self) -> None:
        for fd in list(self._fds):
            self._close(fd)
        for link in self.links:
            link.close()
        self.signals.close()

    def _close(self, fd: int) -> None:
        os.close(fd)
        self._fds.discard(fd)


def recorded(item: object) -> Record:
    """The effect that records `item`; the loop does not look into it."""
    return Record(item)  # type: ignore[arg-type]  # any marker will do here
