"""The sockets of viewers, and the WebSocket on each: RFC 6455 by the library websockets.

Nothing here waits.  What a viewer may cost is bounded: what is read of it in a turn, the size of a
message, what waits to be sent to it (then the oldest messages of topics are left out; what cannot
be left out ends it), how long it may say nothing at all.  No compression: a message is as large as
it looks.
"""

from __future__ import annotations

import contextlib
import errno
import logging
import socket
import sys
from collections import deque
from collections.abc import Iterable
from dataclasses import dataclass, field
from http import HTTPStatus
from typing import TypeAlias

from websockets.datastructures import MultipleValuesError
from websockets.frames import CloseCode, Opcode
from websockets.frames import Frame as WireFrame
from websockets.http11 import Request
from websockets.protocol import State
from websockets.server import ServerProtocol
from websockets.typing import Subprotocol

from gcs.live.admission import Admission
from gcs.live.effects import Frame
from gcs.live.inputs import Came, Gone, Said
from gcs.live.protocol import SUBPROTOCOLS
from gcs.live.rate_limit import RateLimit

FIRST_PORTS = range(8765, 8775)
"""Tried in turn where no port is asked for; 8765 is what viewers offer."""
MAX_VIEWERS = 200
MAX_ACCEPTED = 16
"""New connections in a turn."""
READ_BYTES = 4_096
"""Of one viewer in a turn: some hundred of the smallest frames, a few milliseconds."""
MAX_MESSAGE_BYTES = 128 * 1024
FRAMES_A_SECOND = 100.0
BURST_FRAMES = 400.0
"""Of one viewer; who sends more loses its connection."""
MAX_WAITING_BYTES = 1 << 20
SEND_BUFFER_BYTES = 1 << 18
"""Of the kernel, so that what a slow viewer sees is not old."""
OPENING_NS = 5_000_000_000
"""For the handshake."""
PING_NS = 2_000_000_000
SILENT_NS = 10_000_000_000
"""Who has not even answered a ping for so long is gone: its network is dead, or it is stopped."""

_LOGGER = logging.getLogger("gcs.live.websockets")
# The library would log every mistake of every viewer; nobody could read that beside a flight.
_LOGGER.disabled = True


class PortTakenError(Exception):
    """Another program listens there."""


@dataclass(frozen=True, slots=True)
class Refused:
    """A page or name was not let in."""

    why: str


Event: TypeAlias = Came | Said | Gone | Refused


@dataclass(slots=True, eq=False)
class Viewer:
    """One connection; `select` can wait for it."""

    number: int
    sock: socket.socket
    opened_ns: int
    heard_ns: int
    protocol: ServerProtocol
    frames: RateLimit
    open: bool = False
    waiting: deque[Frame] = field(default_factory=deque)
    waiting_bytes: int = 0
    unsent: bytes = b""
    coming: bytearray = field(default_factory=bytearray)
    text: bool = False
    """Of the message whose parts are coming in."""

    def fileno(self) -> int:
        return self.sock.fileno()


class Connections:
    """The listening socket and all viewers."""

    def __init__(self, admission: Admission) -> None:
        self._admission = admission
        self._listener: socket.socket | None = None
        self._viewers: dict[int, Viewer] = {}
        self._came = 0
        self._pinged_ns = 0

    def listen(self, port: int) -> str:
        """Listen where the admission says; the URL.  `port` 0: the first of `FIRST_PORTS` that is
        free.  Raises PortTakenError, or OSError for an address that is not this machine's."""
        host = self._admission.host
        ports = [port] if port else FIRST_PORTS
        for each in ports:
            try:
                self._listener = _listener(host, each)
            except PortTakenError:
                continue
            shown = f"[{host}]" if ":" in host else host
            return f"ws://{shown}:{each}"
        taken = f"{host}:{ports[0]}" if port else f"{host}:{ports[0]} to {ports[-1]}"
        raise PortTakenError(f"{taken}: the port is taken by another program")

    @property
    def readers(self) -> list[socket.socket | Viewer]:
        assert self._listener is not None
        return [self._listener, *self._viewers.values()]

    @property
    def writers(self) -> list[Viewer]:
        return [each for each in self._viewers.values() if each.unsent or each.waiting]

    def read(self, ready: Iterable[object], now_ns: int) -> list[Event]:
        """What those that are readable bring."""
        events: list[Event] = []
        for each in ready:
            if isinstance(each, Viewer):
                events += self._read(each, now_ns)
            elif each is self._listener:
                self._accept(now_ns)
        return events

    def write(self, ready: Iterable[object]) -> list[Event]:
        """Send to those that are writable."""
        return [
            event
            for each in ready
            if isinstance(each, Viewer) and each.number in self._viewers
            for event in self._flush(each)
        ]

    def tick(self, now_ns: int) -> list[Event]:
        """Ping, and end what has not opened, or has said nothing for too long."""
        ping = now_ns >= self._pinged_ns + PING_NS
        if ping:
            self._pinged_ns = now_ns
        events: list[Event] = []
        for each in [*self._viewers.values()]:
            if each.open and now_ns - each.heard_ns < SILENT_NS:
                if ping and each.protocol.state is State.OPEN:
                    each.protocol.send_ping(b"")
                    events += self._flush(each)
            elif each.open or now_ns - each.opened_ns >= OPENING_NS:
                events += self._end(each)
        return events

    def send(self, frame: Frame) -> list[Event]:
        """Queue it; it goes as soon as the viewer takes it."""
        viewer = self._viewers.get(frame.viewer)
        if viewer is None:
            return []
        viewer.waiting.append(frame)
        viewer.waiting_bytes += len(frame.data)
        if viewer.waiting_bytes > MAX_WAITING_BYTES and not _thinned(viewer):
            return self._end(viewer, CloseCode.TRY_AGAIN_LATER, "too slow")
        return [] if viewer.unsent else self._flush(viewer)

    def close(self) -> None:
        for viewer in [*self._viewers.values()]:
            self._end(viewer, CloseCode.GOING_AWAY, "the live view ends")
        if self._listener is not None:
            self._listener.close()

    # ----------------------------------------------------------------------------- inside

    def _accept(self, now_ns: int) -> None:
        assert self._listener is not None
        for _ in range(MAX_ACCEPTED):
            try:
                sock, _ = self._listener.accept()
            except OSError:  # none is left, or it has gone, or there are no descriptors left
                return
            if len(self._viewers) >= MAX_VIEWERS:
                sock.close()
                continue
            sock.setblocking(False)
            with contextlib.suppress(OSError):
                sock.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
                sock.setsockopt(socket.SOL_SOCKET, socket.SO_SNDBUF, SEND_BUFFER_BYTES)
            self._came += 1
            known = [Subprotocol(name) for name in SUBPROTOCOLS]
            protocol = ServerProtocol(
                subprotocols=known, max_size=MAX_MESSAGE_BYTES, logger=_LOGGER
            )
            frames = RateLimit.full(FRAMES_A_SECOND, BURST_FRAMES, now_ns)
            viewer = Viewer(self._came, sock, now_ns, now_ns, protocol, frames)
            self._viewers[self._came] = viewer

    def _read(self, viewer: Viewer, now_ns: int) -> list[Event]:
        if viewer.number not in self._viewers:
            return []
        try:
            data = viewer.sock.recv(READ_BYTES)
        except BlockingIOError:
            return []
        except OSError:
            data = b""
        if not data:
            return self._end(viewer)
        viewer.heard_ns = now_ns
        viewer.protocol.receive_data(data)
        events: list[Event] = []
        for event in viewer.protocol.events_received():
            if isinstance(event, Request):
                events += self._opened(viewer, event)
            elif isinstance(event, WireFrame):
                if not viewer.frames.take(now_ns):
                    why = f"more than {FRAMES_A_SECOND:g} messages a second"
                    return [*events, *self._end(viewer, CloseCode.POLICY_VIOLATION, why)]
                events += _message(viewer, event)
        ended = viewer.protocol.close_expected() or viewer.protocol.state is State.CLOSED
        return [*events, *(self._end(viewer) if ended else self._flush(viewer))]

    def _opened(self, viewer: Viewer, request: Request) -> list[Event]:
        if viewer.protocol.close_expected():
            return []  # it did not wait for the answer, and what it said was wrong
        try:
            origin, host = request.headers.get("Origin"), request.headers.get("Host")
            why = self._admission.why_refused(origin, host)
        except MultipleValuesError:
            why = "more than one Origin or Host"
        if why:
            response = viewer.protocol.reject(HTTPStatus.FORBIDDEN, f"mavgate: {why}\n")
        else:
            response = viewer.protocol.accept(request)
        viewer.protocol.send_response(response)
        viewer.open = viewer.protocol.state is State.OPEN
        return [Came(viewer.number)] if viewer.open else [Refused(why)] if why else []

    def _flush(self, viewer: Viewer) -> list[Event]:
        """Send what goes.  A queued message becomes bytes only when its turn has come."""
        own = b"".join(viewer.protocol.data_to_send())  # handshake, ping, pong
        viewer.unsent += own
        if len(viewer.unsent) > MAX_WAITING_BYTES:
            return self._end(viewer)
        while viewer.unsent or viewer.waiting:
            if not viewer.unsent:
                viewer.unsent = _next_bytes(viewer)
            try:
                viewer.unsent = viewer.unsent[viewer.sock.send(viewer.unsent) :]
            except BlockingIOError:
                return []
            except OSError:
                return self._end(viewer)
        return []

    def _end(
        self, viewer: Viewer, code: CloseCode = CloseCode.ABNORMAL_CLOSURE, why: str = ""
    ) -> list[Event]:
        """What it can be told at once, it is told."""
        if self._viewers.pop(viewer.number, None) is None:
            return []
        viewer.protocol.fail(code, why)
        if not viewer.unsent:
            with contextlib.suppress(OSError):
                viewer.sock.send(b"".join(viewer.protocol.data_to_send()))
        viewer.sock.close()
        viewer.waiting.clear()
        return [Gone(viewer.number)] if viewer.open else []


def _next_bytes(viewer: Viewer) -> bytes:
    frame = viewer.waiting.popleft()
    viewer.waiting_bytes -= len(frame.data)
    if frame.text:
        viewer.protocol.send_text(frame.data)
    else:
        viewer.protocol.send_binary(frame.data)
    return b"".join(viewer.protocol.data_to_send())


def _thinned(viewer: Viewer) -> bool:
    """Leave out the older half of the messages of topics that wait; whether that was enough."""
    of_topics = [frame for frame in viewer.waiting if frame.of_a_topic]
    older = {id(frame) for frame in of_topics[: (len(of_topics) + 1) // 2]}
    viewer.waiting = deque(frame for frame in viewer.waiting if id(frame) not in older)
    viewer.waiting_bytes = sum(len(frame.data) for frame in viewer.waiting)
    return viewer.waiting_bytes <= MAX_WAITING_BYTES


def _message(viewer: Viewer, frame: WireFrame) -> list[Event]:
    """A whole message, once all its parts are there."""
    if frame.opcode in (Opcode.TEXT, Opcode.BINARY):
        viewer.text = frame.opcode is Opcode.TEXT
        viewer.coming.clear()
    elif frame.opcode is not Opcode.CONT:
        return []
    viewer.coming += frame.data
    return [Said(viewer.number, bytes(viewer.coming), viewer.text)] if frame.fin else []


def _listener(host: str, port: int) -> socket.socket:
    family, kind, _, _, address = socket.getaddrinfo(
        host, port, type=socket.SOCK_STREAM, flags=socket.AI_PASSIVE
    )[0]
    made = socket.socket(family, kind)
    try:
        if sys.platform != "win32":  # where it would share the port with another program
            made.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        made.bind(address)
        made.listen(MAX_VIEWERS)
    except OSError as error:
        made.close()
        if error.errno == errno.EADDRINUSE:
            raise PortTakenError(str(error)) from error
        raise
    made.setblocking(False)
    return made
