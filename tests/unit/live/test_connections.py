"""Viewers' sockets on loopback: let in or not, slow, silent, and too much; the clock is the test's.

Frames are as in RFC 6455, 5.2.
"""

from __future__ import annotations

import socket
import struct
from collections.abc import Callable, Iterator
from contextlib import ExitStack, closing

import pytest
from hypothesis import given
from hypothesis import strategies as st

from gcs.live.admission import Admission
from gcs.live.connections import (
    BURST_FRAMES,
    MAX_MESSAGE_BYTES,
    MAX_WAITING_BYTES,
    OPENING_NS,
    PING_NS,
    SILENT_NS,
    Connections,
    Event,
    PortTakenError,
    Refused,
)
from gcs.live.effects import Frame
from gcs.live.inputs import Came, Gone, Said
from tests.system.hostile_viewers import HANDSHAKE

pytestmark = pytest.mark.slow  # sockets

MORE, TEXT, CLOSE, PING, PONG = 0x00, 0x81, 0x88, 0x89, 0x8A
FIRST = 0x01
"""Of a text in several parts."""
PIECE = 60_000


def framed(first: int, data: bytes = b"") -> bytes:
    """As a client sends it: masked, with noughts."""
    size = len(data)
    if size < 126:
        return bytes([first, 0x80 | size]) + bytes(4) + data
    return bytes([first, 0xFE]) + struct.pack(">H", size) + bytes(4) + data


def topic_message(viewer: int, size: int, first: bytes = b"\x00") -> Frame:
    return Frame(viewer, first + bytes(size - 1), text=False, of_a_topic=True)


class Bench:
    def __init__(self, stack: ExitStack) -> None:
        self._stack = stack
        self.now_ns = 0
        with closing(socket.create_server(("127.0.0.1", 0))) as free:
            self.port: int = free.getsockname()[1]
        self.connections = Connections(Admission("127.0.0.1"))
        self.connections.listen(self.port)
        stack.callback(self.connections.close)

    def connect(self, first: bytes = HANDSHAKE) -> socket.socket:
        client = self._stack.enter_context(socket.socket())
        client.settimeout(5.0)
        client.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 1 << 14)
        client.connect(("127.0.0.1", self.port))
        client.sendall(first)
        return client

    def turn(self) -> list[Event]:
        """What is there is read, and what goes is sent."""
        readers = [*self.connections.readers]
        events = self.connections.read(readers, self.now_ns)
        return events + self.connections.write([*self.connections.writers])

    def until(self, done: Callable[[list[Event]], bool]) -> list[Event]:
        events: list[Event] = []
        for _ in range(20_000):
            events += self.turn()
            if done(events):
                return events
        raise AssertionError(events[-5:])

    def ended(self) -> list[Event]:
        """The one viewer comes and goes."""
        events = self.until(lambda _: len(self.connections.readers) == 2)
        return events + self.until(lambda _: len(self.connections.readers) == 1)

    def opened(self) -> tuple[socket.socket, int]:
        client = self.connect()
        (came,) = self.until(lambda events: bool(events))
        assert isinstance(came, Came)
        assert client.recv(4_096).startswith(b"HTTP/1.1 101 ")
        return client, came.viewer


@pytest.fixture
def bench() -> Iterator[Bench]:
    with ExitStack() as stack:
        yield Bench(stack)


def gone(events: list[Event]) -> bool:
    return any(isinstance(event, Gone) for event in events)


@pytest.mark.parametrize("name", ["foxglove.sdk.v1", "foxglove.websocket.v1"])
def test_both_names_of_the_protocol_are_spoken(bench: Bench, name: str) -> None:
    client = bench.connect(HANDSHAKE.replace(b"foxglove.sdk.v1", name.encode()))
    assert bench.until(lambda events: bool(events)) == [Came(1)]
    assert f"\r\nSec-WebSocket-Protocol: {name}\r\n".encode() in client.recv(4_096)


@pytest.mark.parametrize(
    ("old", "new", "status"),
    [
        (b"\r\n\r\n", b"\r\nOrigin: https://evil.example\r\n\r\n", b"403"),
        (b"\r\n\r\n", b"\r\nOrigin: file://\r\nOrigin: file://\r\n\r\n", b"403"),
        (b"127.0.0.1", b"evil.example", b"403"),
        (b"foxglove.sdk.v1", b"other.v1", b"400"),
        (b"GET", b"POST", b"405"),
    ],
)
def test_others_are_not_let_in(bench: Bench, old: bytes, new: bytes, status: bytes) -> None:
    client = bench.connect(HANDSHAKE.replace(old, new))
    events = bench.ended()
    assert all(isinstance(event, Refused) for event in events)
    assert bool(events) == (status == b"403")
    assert client.recv(4_096).startswith(b"HTTP/1.1 " + status)


PAGE = HANDSHAKE.replace(b"\r\n\r\n", b"\r\nOrigin: https://evil.example\r\n\r\n")
PARTS = [
    *(HANDSHAKE, PAGE, b"\xff" * 99, b"\r\n\r\n", framed(CLOSE), framed(CLOSE, b"\x03\xe8")),
    *(framed(PING), framed(PONG), framed(TEXT, b"{}"), framed(FIRST, b"{"), framed(MORE | 0x80)),
]


@given(st.lists(st.sampled_from(PARTS), max_size=6))
def test_whatever_a_viewer_sends_the_next_one_is_let_in(parts: list[bytes]) -> None:
    """None of them waits for an answer."""
    with ExitStack() as stack:
        bench = Bench(stack)
        bench.connect(b"".join(parts)).shutdown(socket.SHUT_WR)
        events = bench.ended()
        assert events.count(Came(1)) == events.count(Gone(1)) <= 1
        bench.opened()


def test_a_message_in_parts_is_one(bench: Bench) -> None:
    client, viewer = bench.opened()
    client.sendall(framed(FIRST, b'{"op"') + framed(PING) + framed(MORE | 0x80, b":1}"))
    assert bench.until(lambda events: bool(events)) == [Said(viewer, b'{"op":1}', True)]
    assert client.recv(2) == bytes([PONG, 0])


def test_a_close_is_answered(bench: Bench) -> None:
    client, viewer = bench.opened()
    client.sendall(framed(CLOSE, b"\x03\xe8"))
    assert bench.until(gone) == [Gone(viewer)]
    assert client.recv(4) == bytes([CLOSE, 2, 3, 0xE8])


@pytest.mark.parametrize(
    "hostile",
    [
        framed(TEXT, bytes(10))[:1] + b"\xff" + struct.pack(">Q", MAX_MESSAGE_BYTES + 1),
        framed(FIRST, b"{" * PIECE) + framed(MORE, b" " * PIECE) * 2,
        framed(FIRST, b"{") + framed(MORE) * 1_000,
        framed(TEXT, b"{}") * (int(BURST_FRAMES) + 1),
        framed(PING, b"x" * 100) * 1_000,
        b"\xff" * 100,
    ],
    ids=["large", "large in parts", "many parts", "many", "pings", "noise"],
)
def test_too_much_ends_the_connection(bench: Bench, hostile: bytes) -> None:
    client, viewer = bench.opened()
    client.sendall(hostile)
    events = bench.until(gone)
    assert len(events) <= BURST_FRAMES + 1
    assert events[-1] == Gone(viewer)


def test_who_does_not_open_is_ended_and_nobody_hears_of_it(bench: Bench) -> None:
    bench.connect(HANDSHAKE[:-2])
    bench.until(lambda _: len(bench.connections.readers) == 2)
    bench.turn()
    bench.now_ns = OPENING_NS
    assert bench.connections.tick(bench.now_ns) == []
    assert len(bench.connections.readers) == 1


def test_a_viewer_that_answers_pings_stays_and_one_that_is_dead_goes(bench: Bench) -> None:
    client, viewer = bench.opened()
    for _ in range(2 * SILENT_NS // PING_NS):
        bench.now_ns += PING_NS
        assert bench.connections.tick(bench.now_ns) == []
        assert client.recv(2) == bytes([PING, 0])
        client.sendall(framed(PONG))
        bench.until(lambda _: _heard(bench) == bench.now_ns)
    bench.now_ns += SILENT_NS - 1
    assert bench.connections.tick(bench.now_ns) == []
    bench.now_ns += 1
    assert bench.connections.tick(bench.now_ns) == [Gone(viewer)]


def _heard(bench: Bench) -> int:
    (viewer,) = bench.connections._viewers.values()
    return viewer.heard_ns


def test_a_slow_viewer_misses_the_older_messages_of_topics_and_nothing_else(bench: Bench) -> None:
    client, viewer = bench.opened()
    for number in range(200):
        assert bench.connections.send(topic_message(viewer, PIECE, bytes([number]))) == []
    assert bench.connections.send(Frame(viewer, b"status", text=True)) == []
    (kept,) = bench.connections._viewers.values()
    assert sum(len(frame.data) for frame in kept.waiting) <= MAX_WAITING_BYTES
    client.setblocking(False)
    received = bytearray()
    for _ in range(20_000):
        bench.turn()
        try:
            received += client.recv(1 << 16)
        except BlockingIOError:
            if received.endswith(b"status"):
                break
    head = bytes([0x82, 126]) + struct.pack(">H", PIECE)
    seen = [number for number in range(200) if head + bytes([number, 0, 0, 0]) in received]
    assert seen[0] == 0
    assert seen[-1] == 199
    assert len(seen) < 100


def test_a_viewer_that_reads_nothing_of_what_must_not_be_missed_is_ended(bench: Bench) -> None:
    _, viewer = bench.opened()
    events: list[Event] = []
    for _ in range(200):
        events += bench.connections.send(Frame(viewer, b"s" * PIECE, text=True))
    assert events == [Gone(viewer)]


def test_a_port_that_is_taken_is_told(bench: Bench) -> None:
    other = Connections(Admission("127.0.0.1"))
    with pytest.raises(PortTakenError, match=f"127.0.0.1:{bench.port}: the port is taken"):
        other.listen(bench.port)
