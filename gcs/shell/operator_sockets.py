"""Connections of operators' programs to the station's local socket, for the one loop.

Whoever connects is not trusted to be well: nothing here waits for it, what is read and kept of it
is bounded, and one that breaks a limit is told why and dropped.  What it costs others is one
`recv` and a few lines in a turn of the loop.  Before its `ipc.Join` the session hears nothing.
"""

from __future__ import annotations

import hmac
import socket
import time
from collections import deque
from collections.abc import Callable, Iterator, Sequence

from gcs import ipc
from gcs.exit_codes import ExitCode
from gcs.session.effects import EVERYONE
from gcs.session.inputs import (
    Input,
    OperatorGone,
    OperatorJoined,
    OperatorLine,
    OperatorNoise,
)
from gcs.session.requests import FIRST

MAX_OPERATORS = 16
MAX_ACCEPTS_A_TURN = 4
MAX_READ_BYTES = 8_192
"""Of one operator in one turn."""
MAX_LINE_BYTES = 16_384
MAX_LINES_A_TURN = 8
"""Of one operator in one turn; the rest waits for the next one."""
LINES_A_SECOND = 50.0
BURST_LINES = 100.0
MAX_NOISE = 10
"""Lines that are no command; then the operator is broken."""
JOIN_WAIT_S = 2.0
MAX_QUEUED_BYTES = 256 << 10
MAX_QUEUED_TOPIC_BYTES = 4 << 20
"""Of an operator that watches the topics of the record: the schemas of a fleet's come at once."""
UNREAD_S = 10.0
"""An operator that has taken nothing for so long while something waited for it does not read."""
SEND_BUFFER_BYTES = 64 << 10
NAME_LETTERS = 80


class Connection:
    """One operator: what it said and is still to be handed on, what waits for it."""

    def __init__(self, sock: socket.socket, now_s: float) -> None:
        sock.setblocking(False)
        sock.setsockopt(socket.SOL_SOCKET, socket.SO_SNDBUF, SEND_BUFFER_BYTES)
        self._socket = sock
        self.number = 0
        """The operator's, once it has joined."""
        self.closing = False
        """Its good-bye is queued: nothing more is read, and it is closed once that is sent."""
        self.since_s = self.heard_s = now_s
        self.lines: deque[bytes] = deque()
        self.noise = 0
        self.ended = False
        self.max_queued_bytes = MAX_QUEUED_BYTES
        self._rest = b""
        self._tokens, self._tokens_s = BURST_LINES, now_s
        self._queue: deque[bytes] = deque()
        self._queued_bytes = 0
        self._taken_s = now_s

    def fileno(self) -> int:
        return self._socket.fileno()

    @property
    def joined(self) -> bool:
        return self.number != 0

    @property
    def waiting(self) -> bool:
        """Whether something is queued for it."""
        return bool(self._queue)

    def read(self, now_s: float) -> str:
        """Take in what came, at most `MAX_READ_BYTES`; why it is to be dropped, if it is."""
        try:
            data = self._socket.recv(MAX_READ_BYTES)
        except BlockingIOError:
            return ""
        except OSError:
            data = b""
        if not data:
            self.ended = True
            return ""
        self.heard_s = now_s
        *lines, self._rest = (self._rest + data).split(b"\n")
        self.lines.extend(line for line in lines if line)
        if len(self._rest) > MAX_LINE_BYTES or any(len(line) > MAX_LINE_BYTES for line in lines):
            return f"a line of more than {MAX_LINE_BYTES} bytes"
        self._tokens += (now_s - self._tokens_s) * LINES_A_SECOND
        self._tokens_s = now_s
        self._tokens = min(self._tokens, BURST_LINES) - len(lines)
        return f"more than {LINES_A_SECOND:g} lines a second" if self._tokens < 0.0 else ""

    def put(self, line: bytes, now_s: float, *, droppable: bool) -> str:
        """Queue a line and send what goes; why it is to be dropped, if it is.

        A `droppable` line is left out while others wait: the next one is as good.
        """
        if not self._queue:
            self._taken_s = now_s
        elif droppable:
            return ""
        self._queue.append(line)
        self._queued_bytes += len(line)
        self.flush(now_s)
        return "it does not read" if self._queued_bytes > self.max_queued_bytes else ""

    def flush(self, now_s: float) -> None:
        """Send what the socket takes now."""
        while self._queue:
            line = self._queue[0]
            try:
                sent = self._socket.send(line)
            except BlockingIOError:
                return
            except OSError:
                self.give_up()
                return
            self._taken_s = now_s
            self._queued_bytes -= sent
            if sent < len(line):
                self._queue[0] = line[sent:]
                return
            self._queue.popleft()

    def give_up(self) -> None:
        """Nothing more is handed on or sent."""
        self.ended = True
        self.lines.clear()
        self._queue.clear()
        self._queued_bytes = 0

    def overdue(self, now_s: float) -> str:
        """Why its patience with us, or ours with it, is over; empty if it is not."""
        if not self.joined and now_s - self.since_s > JOIN_WAIT_S:
            return f"no `join` within {JOIN_WAIT_S:g} s"
        if self._queue and now_s - self._taken_s > UNREAD_S:
            return "it does not read"
        return ""

    def close(self) -> None:
        self._socket.close()


class OperatorSockets:
    """All connections.  Client numbers are never used twice; `FIRST` is the operator's pipes'."""

    def __init__(
        self,
        listener: socket.socket,
        token: str = "",
        now_s: Callable[[], float] = time.monotonic,
    ) -> None:
        """`token`: what a `Join` must bring, where anyone on this machine can connect."""
        listener.setblocking(False)
        self._listener = listener
        self._token = token
        self._now_s = now_s
        self._next = FIRST + 1
        self._connections: list[Connection] = []

    def fileno(self) -> int:
        return self._listener.fileno()

    @property
    def alone(self) -> bool:
        """Nobody is connected: this is all that there is to watch."""
        return not self._connections

    @property
    def sources(self) -> list[OperatorSockets | Connection]:
        """What `select` should watch for reading."""
        ready = (each for each in self._connections if not each.closing and not each.lines)
        return [self, *ready]

    @property
    def sinks(self) -> list[Connection]:
        """What `select` should watch for writing."""
        return [each for each in self._connections if each.waiting]

    @property
    def busy(self) -> bool:
        """Whether lines that were read still wait for their turn."""
        return any(each.lines and not each.closing for each in self._connections)

    # ----------------------------------------------------------------------------- turn

    def turn(self, readable: Sequence[object], writable: Sequence[object]) -> Iterator[Input]:
        """Do what a turn of the loop has for the operators; what the session is to hear of them.

        A generator, so that whoever takes the inputs can do what is more urgent between two.
        """
        now_s = self._now_s()
        if self in readable:
            yield from self._accept(now_s)
        for connection in list(self._connections):
            if connection in writable:
                connection.flush(now_s)
            why = connection.overdue(now_s)
            if not why and connection in readable and not connection.lines:
                why = connection.read(now_s)
            yield from self._hand_on(connection)
            if why:
                yield from self._drop(connection, why)
            elif connection.ended and not connection.lines:
                yield from self._forget(connection, "its connection ended")
            elif connection.closing and not connection.waiting:
                yield from self._forget(connection, "it has left")

    def _accept(self, now_s: float) -> Iterator[Input]:
        for _ in range(MAX_ACCEPTS_A_TURN):
            try:
                sock, _ = self._listener.accept()
            except OSError:
                return
            if len(self._connections) >= MAX_OPERATORS:
                yield from self._drop(self._least_needed(), "too many operators: you were silent")
            self._connections.append(Connection(sock, now_s))

    def _least_needed(self) -> Connection:
        """Who makes room, so that a stop finds its way in: who has not joined, then who has been
        silent longest."""
        return min(self._connections, key=lambda each: (each.joined, each.heard_s))

    def _hand_on(self, connection: Connection) -> Iterator[Input]:
        for _ in range(MAX_LINES_A_TURN):
            if not connection.lines or connection.closing:
                return
            line = connection.lines.popleft()
            try:
                command = ipc.decode_command(line)
            except (ValueError, RecursionError) as error:
                yield from self._noise(connection, f"{error}: {line[:200]!r}")
            else:
                yield from self._line(connection, command)

    def _line(self, connection: Connection, command: ipc.Command) -> Iterator[Input]:
        if connection.joined:
            yield OperatorLine(connection.number, command)
        elif not isinstance(command, ipc.Join):
            yield from self._drop(connection, "the first line must be a `join`")
        elif command.schema != ipc.SCHEMA:
            why = f"it speaks schema {command.schema}, this station {ipc.SCHEMA}"
            yield from self._drop(connection, why)
        elif not hmac.compare_digest(command.token.encode(), self._token.encode()):
            yield from self._drop(connection, "the token is not this station's")
        else:
            connection.number, self._next = self._next, self._next + 1
            name = command.name[:NAME_LETTERS]
            yield OperatorJoined(connection.number, name, command.hold_on_leave)

    def _noise(self, connection: Connection, text: str) -> Iterator[Input]:
        connection.noise += 1
        if not connection.joined:
            yield from self._drop(connection, "the first line must be a `join`")
        elif connection.noise > MAX_NOISE:
            yield from self._drop(connection, f"more than {MAX_NOISE} lines that are no command")
        else:
            yield OperatorNoise(connection.number, text)

    def _drop(self, connection: Connection, why: str) -> Iterator[Input]:
        """Tell it why, if it takes that at once, and close."""
        text = f"the station closed the connection: {why}"
        line = ipc.encode(ipc.Trouble(text, "", ExitCode.NOT_COMPLETED))
        connection.put(line, self._now_s(), droppable=True)
        yield from self._forget(connection, why)

    def _forget(self, connection: Connection, why: str) -> Iterator[Input]:
        if connection not in self._connections:
            return
        self._connections.remove(connection)
        connection.close()
        connection.lines.clear()
        if connection.joined:
            yield OperatorGone(connection.number, why)

    # ---------------------------------------------------------------------------- tell

    def tell(self, line: bytes, operator: int, *, droppable: bool, last: bool) -> None:
        """Queue an event's line for one operator, or for all that have joined (`EVERYONE`).

        `last`: it is the operator's good-bye; the connection closes once it is sent.
        """
        for connection in self._connections:
            mine = operator in (EVERYONE, connection.number)
            if not mine or not connection.joined or connection.closing or connection.ended:
                continue
            if connection.put(line, self._now_s(), droppable=droppable):
                connection.give_up()
            connection.closing = last

    def allow_more(self, operator: int) -> None:
        """It watches topics: more may wait for it than for others."""
        for connection in self._connections:
            if connection.number == operator:
                connection.max_queued_bytes = MAX_QUEUED_TOPIC_BYTES

    def close(self) -> None:
        """Everything; what is queued goes as far as the sockets take it at once."""
        for connection in self._connections:
            connection.flush(self._now_s())
            connection.close()
        self._connections.clear()
        self._listener.close()
