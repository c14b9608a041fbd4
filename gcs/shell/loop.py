"""The only loop: wait for bytes or for the deadline, hand them to the session, do what it says.

No threads of ours, no asyncio: one `select`, every readable socket drained, one owner of all
state.  Whatever may block (the operator's pipe, a slow disk's flush) is bounded or dropped.
"""

from __future__ import annotations

import select
import traceback
from collections.abc import Callable, Sequence
from contextlib import suppress
from pathlib import Path
from typing import Protocol, TypeAlias

from gcs import ipc
from gcs.resources import MissionNotFoundError, find
from gcs.session.effects import (
    EVERYONE,
    AskRule,
    ClientVerified,
    Effect,
    Emit,
    Finish,
    LeaveOutPeer,
    ReadFile,
    Record,
    ShowTopics,
    Transmit,
    WriteFile,
)
from gcs.session.inputs import (
    Datagram,
    FileRead,
    FileWritten,
    Input,
    LinkEvent,
    OperatorGone,
    OperatorLine,
    OperatorNoise,
    SignalCame,
    SimGone,
    SimLine,
    Wake,
)
from gcs.session.requests import FIRST
from gcs.shell.client_ports import ClientPorts
from gcs.shell.clock import Clock
from gcs.shell.datagram_runs import pieces, runs
from gcs.shell.operator_sockets import OperatorSockets
from gcs.shell.pipes import LineSink, LineSource
from gcs.shell.recording import Recording
from gcs.shell.rule_process import RuleProcess
from gcs.shell.signals import SignalSource
from gcs.shell.sim import SimProcess
from gcs.shell.sockets import Link
from gcs.shell.topic_stream import TopicStream
from gcs.station.frame_intake import FramesRaisedError

MAX_PLAN_BYTES = 16 << 20
MAX_DATAGRAMS_A_TURN = 256
LOOK_NS = 50_000_000
"""The rest is looked at so often, however much comes of vehicles."""

DENSE_NS = 500_000
DENSE_DATAGRAMS = 3
"""Where datagrams of vehicles come so close one after another, or so many together, turns are
`GATHER_NS` apart: a turn for 5 datagrams costs a third of 5 turns, and nobody waits long."""
GATHER_NS = 2_000_000
"""Only vehicles wait for that: what clients and operators send is read at once.  So long after
something was sent to a vehicle, vehicles do not wait either: what comes may be its answer, for
which the next question waits, such as that for a mission's next item."""
ALONE_NS = 4_000_000
"""Where datagrams came further apart than this, twice, a turn reads one: a second read that finds
nothing costs as much as the first one, and what does come then is there in the next turn."""


class Core(Protocol):
    """What the loop drives: `gcs.station.session.Session`, or a test's stand-in."""

    @property
    def deadline_ns(self) -> int: ...
    def handle(self, given: Input, now_ns: int) -> Sequence[Effect]: ...
    def fault(self, given: Input, report: str, now_ns: int) -> Sequence[Effect]: ...


class HasFileno(Protocol):
    """A pipe or a socket."""

    def fileno(self) -> int: ...


Source: TypeAlias = int | HasFileno
"""What `select` can wait for: a number, where it never changes, is one call less in each turn."""


class Loop:
    """Runs one session to its `Finish`."""

    def __init__(
        self,
        core: Core,
        clock: Clock,
        links: Sequence[Link],
        operator: LineSource,
        screen: LineSink,
        recording: Recording,
        signals: SignalSource,
        sim: SimProcess | None,
        others: OperatorSockets | None = None,
        on_snapshot: Callable[[ipc.Snapshot], None] = lambda _: None,
        client_ports: ClientPorts | None = None,
        rule: RuleProcess | None = None,
    ) -> None:
        """`operator` and `screen` are the pipes of the operator who started the station, `others`
        everybody else, `client_ports` where others speak MAVLink with the vehicle through it.
        `rule` is the operator's own.
        `on_snapshot` is called with each one, and must not wait."""
        self._core = core
        self._clock = clock
        self._links = links
        self._operator = operator
        self._screen = screen
        self._recording = recording
        self._signals = signals
        self._sim = sim
        self._others = others
        self._on_snapshot = on_snapshot
        self._client_ports = client_ports
        self._rule = rule
        self._topics = TopicStream(recording, self._tell)
        self._signals_fd, self._operator_fd = signals.fileno(), operator.fileno()
        self._operator_open = True
        self._sim_open = sim is not None
        self._finish: Finish | None = None
        self._look_ns = 0
        self._read_ns = 0
        self._gather_until_ns = 0
        """Until then nothing of vehicles is read."""
        self._sent_ns = 0
        """When something was sent to a vehicle last."""
        self._alone = False
        """Datagrams came one by one, `ALONE_NS` and more apart."""
        self._recording_ns = 0
        """When the record is to be looked after."""
        self._busy = False
        """Lines that were read of other operators wait for their turn."""

    def run(self) -> Finish:
        """Returns when the session says so; whoever called closes what it opened."""
        while self._finish is None:
            try:
                self._turn()
            except Exception:  # noqa: BLE001 - the last resort: a bug of ours must not drop a vehicle
                # Met outside of any input, it is one of the loop itself: as if it were the clock's.
                self._fault(Wake(), traceback.format_exc(), self._clock.now_ns())
        return self._finish

    def _turn(self) -> None:
        """Wait once, and hand on all that came."""
        readable, writable = self._wait()
        if writable and self._screen in writable:
            self._screen.flush()
        links = self._read_links(readable)
        now_ns = self._clock.now_ns()
        only_links = 0 < links == len(readable) and not writable and not self._busy
        # Of all else what is due by time alone can wait as long as a tick.
        if not only_links or now_ns >= self._look_ns:
            self._look_ns = now_ns + LOOK_NS
            self._read_others(readable, writable)
            now_ns = self._clock.now_ns()
        if self._screen.broken and self._operator_open:
            self._operator_open = False
            self._feed(OperatorGone(FIRST, "nobody reads the link's output"))
        if now_ns >= self._core.deadline_ns:
            self._feed(Wake())
        if now_ns >= self._recording_ns:
            for change in self._recording.upkeep(now_ns):
                self._feed(change)
        if self._recording.raised:
            for given, report in self._recording.faults():
                self._fault(given, report, self._recording.time_ns(self._clock.now_ns()))

    def _read_others(self, readable: list[Source], writable: list[Source]) -> None:
        """All but the links to vehicles."""
        self._read_client_ports(readable, writable)
        if self._signals_fd in readable:
            for name in self._signals.read():
                self._feed(SignalCame(name))
        if self._operator_open and self._operator_fd in readable:
            self._read_operator()
        if self._sim_open and self._sim is not None and self._sim.lines in readable:
            self._read_sim(self._sim)
        if self._rule is not None and self._rule.lines in readable:
            self._read_rule(self._rule)
        self._wake_if_due()
        self._read_operators(readable, writable)

    def _wait(self) -> tuple[list[Source], list[Source]]:
        """Once a turn, for each datagram of a slow stream: nothing here is more than it must be."""
        core_ns, recording_ns = self._core.deadline_ns, self._recording.deadline_ns
        self._recording_ns = recording_ns
        deadline_ns = core_ns if core_ns < recording_ns else recording_ns
        sources: list[Source] = [self._signals_fd]
        from_links: list[Source] = []
        for link in self._links:
            fd = link.fileno()
            if fd >= 0:
                from_links.append(fd)
            due_ns = link.deadline_ns
            if due_ns is not None and due_ns < deadline_ns:
                deadline_ns = due_ns
        if self._operator_open:
            sources.append(self._operator_fd)
        if self._sim_open and self._sim is not None:
            sources.append(self._sim.lines)
        if self._rule is not None:
            sources.append(self._rule.lines)
        sinks: list[Source] = [self._screen] if self._screen.waiting else []
        others = self._others
        self._busy = False
        if others is not None and others.alone:
            sources.append(others)
        elif others is not None:
            sources += others.sources
            sinks += others.sinks
            self._busy = others.busy
        ports = self._client_ports
        if ports is not None:
            sources += ports.waiting
            if ports.others:
                sources += ports.sources(self._clock.now_ns())
                sinks += ports.sinks
            due_ns = ports.deadline_ns
            if due_ns < deadline_ns:
                deadline_ns = due_ns
        if self._gather_until_ns:
            wait_s = self._clock.seconds_until(min(self._gather_until_ns, core_ns))
            if self._busy:
                wait_s = 0.0
            readable, writable, _ = select.select(sources, sinks, [], wait_s)
            if (
                readable or writable or self._busy
            ) and self._clock.now_ns() < self._gather_until_ns:
                return readable, writable
            self._gather_until_ns = 0
        wait_s = 0.0 if self._busy else self._clock.seconds_until(deadline_ns)
        readable, writable, _ = select.select(sources + from_links, sinks, [], wait_s)
        return readable, writable

    def _wake_if_due(self) -> None:
        if self._clock.now_ns() >= self._core.deadline_ns:
            self._feed(Wake())

    def _read_links(self, readable: list[Source]) -> int:
        """How many of them were read."""
        began_ns, datagrams, read = self._clock.now_ns(), 0, 0
        apart = began_ns - self._read_ns >= ALONE_NS
        most = 1 if apart and self._alone else MAX_DATAGRAMS_A_TURN
        for number, link in enumerate(self._links):
            if link.fileno() in readable:
                read += 1
                came = link.drain(most)
                datagrams += len(came)
                for given in pieces(number, came) if link.stream else runs(number, came):
                    self._feed(given)
                    if most > 1:
                        self._wake_if_due()
            elif (due_ns := link.deadline_ns) is None or due_ns > began_ns:
                continue
            for news in link.poke(self._clock.now_ns()):
                self._feed(LinkEvent(number, news.text, news.trouble))
        if datagrams:
            before_ns, self._read_ns, self._alone = self._read_ns, began_ns, apart
            dense = datagrams >= DENSE_DATAGRAMS or began_ns - before_ns < DENSE_NS
            if dense and began_ns - self._sent_ns >= GATHER_NS:
                # Before the next turn more are to come.  A turn that took longer than that is
                # followed by the next one at once.
                self._gather_until_ns = began_ns + GATHER_NS
        return read

    def _read_client_ports(self, readable: list[Source], writable: list[Source]) -> None:
        """Whatever they send, and however much of it: the grid's deadline is met in between."""
        if self._client_ports is None:
            return
        for given in self._client_ports.turn(readable, writable, self._clock.now_ns()):
            self._feed(given)
            self._wake_if_due()

    def _read_operator(self) -> None:
        for line in self._operator.read():
            try:
                command = ipc.decode_command(line)
            except (ValueError, RecursionError) as error:
                self._feed(OperatorNoise(FIRST, f"{error}: {line[:200]!r}"))
            else:
                self._feed(OperatorLine(FIRST, command))
        if self._operator.ended:
            self._operator_open = False
            self._feed(OperatorGone(FIRST, "the command stream ended"))

    def _read_operators(self, readable: list[Source], writable: list[Source]) -> None:
        """Whatever they send, and however much of it: the grid's deadline is met between lines."""
        if self._others is None:
            return
        for given in self._others.turn(readable, writable):
            if isinstance(given, OperatorGone):
                self._topics.remove(given.operator)
            self._feed(given)
            self._wake_if_due()

    def _read_sim(self, sim: SimProcess) -> None:
        for line in sim.lines.read():
            self._feed(SimLine(line.decode(errors="replace")))
        if sim.lines.ended:
            self._sim_open = False
            self._feed(SimGone(sim.ended()))

    def _read_rule(self, rule: RuleProcess) -> None:
        """Once it has ended, no question has an answer any more, and the session refuses each."""
        for said in rule.answers():
            self._feed(said)
        if rule.lines.ended:
            self._rule = None

    def _feed(self, given: Input) -> None:
        """One input with all its effects; then whatever they lead back to."""
        if self._finish is not None:
            return
        # The log_time of an input's first message tells when it was handled.
        now_ns = self._recording.time_ns(self._clock.now_ns())
        effects: Sequence[Effect] = ()
        answers: list[Input] = []
        report = ""
        dropped: Sequence[tuple[Datagram, Exception]] = ()
        try:
            effects = self._core.handle(given, now_ns)
        except FramesRaisedError as raised:
            effects, dropped = raised.effects, raised.dropped
        except Exception:  # noqa: BLE001 - the last resort: a bug of ours must not drop a vehicle
            report = traceback.format_exc()
        sent = given if type(given) is Datagram and given.link < len(self._links) else None
        for effect in effects:
            try:
                if type(effect) is Record:  # nearly all of them are one of these two
                    if sent is None:
                        self._recording.write(effect.item, now_ns)
                    else:
                        self._recording.write_of(sent, effect.item, now_ns)
                    continue
                if type(effect) is Transmit:
                    self._transmit(effect.link, effect.data)
                    continue
                answer = self._perform(effect, now_ns)
            except Exception:  # noqa: BLE001 - the same; and the effects after it still count
                report = report or traceback.format_exc()
            else:
                if answer is not None:
                    answers.append(answer)
        if report:
            self._fault(given, report, now_ns)
        for frame, error in dropped:
            told = "".join(traceback.format_exception(error))
            self._fault(frame, told, self._recording.time_ns(self._clock.now_ns()))
        answers += self._recording.changes()
        for follows in answers:
            self._feed(follows)

    def _fault(self, given: Input, report: str, now_ns: int) -> None:
        """Perform the session's answer to a bug of ours.

        What fails of it, perhaps for the same reason, must not keep the rest from leaving: a hold
        for the vehicle may be in it.
        """
        for effect in self._core.fault(given, report, now_ns):
            with suppress(Exception):
                self._perform(effect, now_ns)

    def _perform(self, effect: Effect, now_ns: int) -> FileRead | FileWritten | None:
        """Do it; the answer, where it has one."""
        match effect:
            case Transmit(link, data):
                self._transmit(link, data)
            case Record(item):
                self._recording.write(item, now_ns)
            case Emit(event, operator):
                self._emit(event, operator)
            case ShowTopics(operator):
                self._show_topics(operator)
            case ReadFile(token, path):
                return _read(token, path)
            case WriteFile(token, path, data):
                return _write(token, path, data)
            case AskRule() if self._rule is not None:
                self._rule.ask(effect)
            case ClientVerified(link) if self._client_ports is not None:
                self._client_ports.verify(link, now_ns)
            case LeaveOutPeer(link, data, silent_ns):
                self._links[link].leave_out(data, silent_ns)
            case Finish():
                self._finish = effect
        return None

    def _transmit(self, link: int, data: bytes) -> None:
        if link < len(self._links):
            self._links[link].send(data)
            self._sent_ns = self._clock.now_ns()
        elif self._client_ports is not None:
            self._client_ports.send(link, data)

    def _emit(self, event: ipc.Event, operator: int) -> None:
        """One line, to whom it is for; what comes again anyway may be dropped on the way."""
        line = ipc.encode(event)
        droppable = isinstance(event, ipc.Snapshot | ipc.MessageEvent | ipc.BridgeStatus)
        last = isinstance(event, ipc.Bye)
        if isinstance(event, ipc.Snapshot):
            self._on_snapshot(event)
        self._tell(line, operator, droppable, last=last)

    def _show_topics(self, operator: int) -> None:
        if self._others is not None:
            self._others.allow_more(operator)
        self._topics.add(operator)

    def _tell(self, line: bytes, operator: int, droppable: bool, *, last: bool = False) -> None:
        if operator in (EVERYONE, FIRST):
            put: Callable[[bytes], None] = self._screen.offer if droppable else self._screen.put
            put(line)
            if last:
                self._operator_open = False
                self._screen.hang_up()
        if operator != FIRST and self._others is not None:
            self._others.tell(line, operator, droppable=droppable, last=last)


def _read(token: int, path: str) -> FileRead:
    try:
        with find(path).open("rb") as file:
            data = file.read(MAX_PLAN_BYTES + 1)
    except MissionNotFoundError as error:
        return FileRead(token, path, None, f"no such file; {error.hint}")
    except (OSError, ValueError) as error:
        return FileRead(token, path, None, getattr(error, "strerror", None) or str(error))
    if len(data) > MAX_PLAN_BYTES:
        return FileRead(token, path, None, f"larger than {MAX_PLAN_BYTES >> 20} MiB")
    return FileRead(token, path, data)


def _write(token: int, path: str, data: bytes) -> FileWritten:
    try:
        file = Path(path)
        if file.exists() and not file.is_file():
            return FileWritten(token, path, "is no regular file")
        file.write_bytes(data)
    except (OSError, ValueError) as error:
        return FileWritten(token, path, getattr(error, "strerror", None) or str(error))
    return FileWritten(token, path)
