"""Client ports: who is a client, on which link, and what one of them can do to the others."""

from __future__ import annotations

import os
import select
import socket
import struct
import sys
from collections.abc import Callable, Iterator

import pytest

from gcs.session.inputs import ClientCame, ClientFlooded, ClientGone, Datagram, LinkEvent
from gcs.shell.client_ports import ClientPorts
from gcs.shell.client_table import MAX_A_TURN, MAX_CLIENT_DATAGRAM, Arrival, ClientLimits
from gcs.shell.endpoints import Endpoint, Kind
from gcs.shell.sockets import AddressInUse
from gcs.shell.sockets import serial as serial_module
from gcs.shell.sockets.tcp import MAX_QUEUED

pytestmark = pytest.mark.slow  # sockets

FIRST_LINK = 2
FRAME = b"\xfd\x00\x00\x00\x00\xff\xbe\x00\x00\x00\x00\x00"
"""Looks like a frame to whoever looks at its first byte; nobody here looks at more."""
UDP_IN = Endpoint(Kind.UDP_IN, "127.0.0.1", 0)
TCP_IN = Endpoint(Kind.TCP_IN, "127.0.0.1", 0)
WAIT_S = 60.0


class Bench:
    """Ports, a clock of the test's own, and the other ends."""

    def __init__(self, *endpoints: Endpoint, limits: ClientLimits | None = None) -> None:
        self.now_ns = 1_000_000_000_000
        self.ports = ClientPorts(FIRST_LINK, limits)
        for endpoint in endpoints:
            self.ports.open(endpoint)
        self._opened: list[socket.socket] = []

    def advance(self, seconds: float) -> None:
        self.now_ns += round(seconds * 1e9)

    def udp(self, number: int = 0, *, bound: int = 0) -> socket.socket:
        """A program that sends to the port of that number from one of its own."""
        sock = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self._opened.append(sock)
        sock.bind(("127.0.0.1", bound))
        sock.connect(("127.0.0.1", self.ports.endpoints[number].port))
        sock.settimeout(WAIT_S)
        return sock

    def tcp(self, number: int = 0) -> socket.socket:
        sock = socket.create_connection(("127.0.0.1", self.ports.endpoints[number].port), WAIT_S)
        self._opened.append(sock)
        return sock

    def listener(self) -> socket.socket:
        sock = socket.create_server(("127.0.0.1", 0))
        sock.settimeout(WAIT_S)
        self._opened.append(sock)
        return sock

    def turn(self, wait_s: float = 0.0) -> list[Arrival]:
        """One turn of the loop: as `Loop._wait` and what follows it."""
        sources = self.ports.waiting + self.ports.sources(self.now_ns)
        sinks = self.ports.sinks
        readable, writable, _ = select.select(sources, sinks, [], wait_s)
        return self.ports.turn(readable, writable, self.now_ns)

    def turns(self, count: int = 4) -> list[Arrival]:
        return [arrival for _ in range(count) for arrival in self.turn()]

    def until(self, kind: type[Arrival]) -> list[Arrival]:
        """Turns until something of this kind came."""
        came: list[Arrival] = []
        for _ in range(200):
            came += self.turn(0.05)
            if any(isinstance(each, kind) for each in came):
                return came
            self.advance(0.05)
        raise AssertionError(f"no {kind.__name__} in {came}")

    def close(self) -> None:
        self.ports.close()
        for sock in self._opened:
            sock.close()


@pytest.fixture
def bench() -> Iterator[Callable[..., Bench]]:
    made: list[Bench] = []

    def make(*endpoints: Endpoint, limits: ClientLimits | None = None) -> Bench:
        made.append(Bench(*endpoints, limits=limits))
        return made[-1]

    yield make
    for each in made:
        each.close()


Make = Callable[..., Bench]


def name(sock: socket.socket, kind: str = "udp") -> str:
    return f"{kind} 127.0.0.1:{sock.getsockname()[1]}"


# --------------------------------------------------------------------------- many UDP peers


def test_each_sender_to_a_udp_port_is_a_client_with_a_link_of_its_own(bench: Make) -> None:
    here = bench(UDP_IN)
    one, other = here.udp(), here.udp()
    one.send(FRAME + b"1")
    other.send(FRAME + b"2")
    one.send(FRAME + b"3")
    assert here.turn() == [
        ClientCame(2, name(one), False),
        Datagram(2, FRAME + b"1"),
        ClientCame(3, name(other), False),
        Datagram(3, FRAME + b"2"),
        Datagram(2, FRAME + b"3"),
    ]


def test_what_is_sent_to_a_link_reaches_that_peer_alone_as_one_datagram(bench: Make) -> None:
    here = bench(UDP_IN)
    one, other = here.udp(), here.udp()
    one.send(FRAME)
    other.send(FRAME)
    here.turn()
    several = FRAME * 8
    here.ports.send(3, several)
    assert other.recv(4096) == several
    one.setblocking(False)
    with pytest.raises(BlockingIOError):
        one.recv(4096)


@pytest.mark.parametrize("noise", [b"", b"GET / HTTP/1.1\r\n", b"\x00" * 40])
def test_noise_makes_no_client(bench: Make, noise: bytes) -> None:
    here = bench(UDP_IN)
    here.udp().send(noise)
    assert here.turn() == []


def test_noise_does_not_keep_a_client(bench: Make) -> None:
    here = bench(UDP_IN, limits=ClientLimits(silent_s=10.0))
    peer = here.udp()
    peer.send(FRAME)
    here.turn()
    here.advance(9.0)
    peer.send(b"noise")
    assert here.turn() == [Datagram(2, b"noise")]
    here.advance(2.0)
    assert here.turn() == [ClientGone(2, "silent for 10 s")]


def test_a_silent_peer_has_gone_and_its_link_is_given_again(bench: Make) -> None:
    here = bench(UDP_IN, limits=ClientLimits(silent_s=10.0))
    quiet, lively = here.udp(), here.udp()
    quiet.send(FRAME)
    lively.send(FRAME)
    here.turn()
    here.advance(9.0)
    lively.send(FRAME)
    here.turn()
    here.advance(2.0)
    assert here.turn() == [ClientGone(2, "silent for 10 s")]
    third = here.udp()
    third.send(FRAME)
    assert here.turn() == [ClientCame(2, name(third), False), Datagram(2, FRAME)]


def test_a_peer_that_comes_back_is_a_new_client(bench: Make) -> None:
    here = bench(UDP_IN, limits=ClientLimits(silent_s=10.0))
    peer = here.udp()
    peer.send(FRAME)
    here.turn()
    here.advance(11.0)
    here.turn()
    peer.send(FRAME)
    assert here.turn() == [ClientCame(2, name(peer), False), Datagram(2, FRAME)]


def test_sending_to_a_link_that_has_gone_does_nothing(bench: Make) -> None:
    here = bench(UDP_IN)
    here.ports.send(2, FRAME)
    here.ports.send(77, FRAME)
    assert here.turn() == []


# ------------------------------------------------------------------------------- the limits


def test_the_one_that_was_silent_longest_makes_room(bench: Make) -> None:
    here = bench(UDP_IN, limits=ClientLimits(max_clients=2))
    first, second, third = here.udp(), here.udp(), here.udp()
    first.send(FRAME)
    second.send(FRAME)
    here.turn()
    here.advance(4.0)
    first.send(FRAME)
    here.turn()
    third.send(FRAME)
    assert here.turn() == [
        ClientGone(3, f"made room for {name(third)}"),
        ClientCame(3, name(third), False),
        Datagram(3, FRAME),
    ]


def test_a_crowd_of_new_senders_drives_nobody_out_who_is_heard(bench: Make) -> None:
    here = bench(UDP_IN, limits=ClientLimits(max_clients=2))
    first, second = here.udp(), here.udp()
    first.send(FRAME)
    second.send(FRAME)
    here.turn()
    here.advance(2.9)
    crowd = [here.udp() for _ in range(20)]
    for each in crowd:
        each.send(FRAME)
    assert here.turn() == [
        LinkEvent(
            2,
            f"no room for client {name(crowd[0])}: 2 are there, none of them silent",
            trouble=True,
        )
    ]
    first.send(FRAME)
    assert here.turn() == [Datagram(2, FRAME)]


def test_link_numbers_end_at_254(bench: Make) -> None:
    ports = ClientPorts(253, ClientLimits())
    ports.open(UDP_IN)
    here = bench()
    here.ports.close()
    here.ports = ports
    peers = [here.udp() for _ in range(3)]
    for peer in peers:
        peer.send(FRAME)
    came = here.turn()
    assert [each.link for each in came if isinstance(each, ClientCame)] == [253, 254]


def test_a_flood_of_one_peer_is_cut_to_its_rate_and_told_once_a_second(bench: Make) -> None:
    here = bench(UDP_IN, limits=ClientLimits(rate_hz=50.0))
    flooding, other = here.udp(), here.udp()
    for _ in range(80):
        flooding.send(FRAME)
    other.send(FRAME)
    came = here.turns()
    handed = [each for each in came if isinstance(each, Datagram) and each.link == 2]
    assert len(handed) == 50
    assert Datagram(3, FRAME) in came
    here.advance(0.5)
    flooding.send(FRAME)
    assert here.turn() == [ClientFlooded(2, 30), Datagram(2, FRAME)]
    for _ in range(80):
        flooding.send(FRAME)
    here.advance(0.6)
    assert ClientFlooded not in {type(each) for each in here.turn()}
    here.advance(0.6)
    (told,) = [each for each in here.turns() if isinstance(each, ClientFlooded)]
    assert told.dropped == 80 - 50  # after 1.1 s it has a second's worth again


def test_large_datagrams_cost_as_many_messages_as_fit_into_them(bench: Make) -> None:
    here = bench(UDP_IN, limits=ClientLimits(rate_hz=50.0))
    peer = here.udp()
    large = FRAME + b"x" * (10 * 64)
    for _ in range(20):
        peer.send(large)
    assert len([each for each in here.turns() if isinstance(each, Datagram)]) == 5


def test_a_datagram_that_no_client_makes_is_dropped(bench: Make) -> None:
    here = bench(UDP_IN)
    peer = here.udp()
    peer.send(FRAME)
    peer.send(FRAME + b"x" * MAX_CLIENT_DATAGRAM)
    assert here.turn() == [ClientCame(2, name(peer), False), Datagram(2, FRAME)]


def test_one_turn_hands_on_a_bounded_number(bench: Make) -> None:
    here = bench(UDP_IN, limits=ClientLimits(rate_hz=1e6))
    peer = here.udp()
    for _ in range(MAX_A_TURN + 50):
        peer.send(FRAME)
    assert len(here.turn()) == MAX_A_TURN
    assert len(here.turn()) == 50 + 1


# ------------------------------------------------------------------------------------- TCP


def test_each_tcp_connection_is_a_client(bench: Make) -> None:
    here = bench(TCP_IN)
    one, other = here.tcp(), here.tcp()
    assert [each for each in here.turns() if isinstance(each, ClientCame)] == [
        ClientCame(2, name(one, "tcp"), True),
        ClientCame(3, name(other, "tcp"), True),
    ]
    other.sendall(FRAME)
    assert here.until(Datagram) == [Datagram(3, FRAME)]
    here.ports.send(2, FRAME)
    assert one.recv(4096) == FRAME


def test_a_closed_connection_has_gone(bench: Make) -> None:
    here = bench(TCP_IN)
    one = here.tcp()
    here.until(ClientCame)
    one.close()
    assert here.until(ClientGone) == [ClientGone(2, "the connection was closed")]
    again = here.tcp()
    assert here.until(ClientCame) == [ClientCame(2, name(again, "tcp"), True)]


def test_a_tcp_client_that_does_not_read_ends(bench: Make) -> None:
    here = bench(TCP_IN)
    lazy, lively = here.tcp(), here.tcp()
    here.turns()
    piece = FRAME * 100
    sent = 0
    while not (came := here.turn()):
        here.ports.send(2, piece)
        sent += len(piece)
    assert came == [ClientGone(2, "it does not read what it is sent")]
    assert sent > MAX_QUEUED
    here.ports.send(3, FRAME)
    assert lively.recv(4096) == FRAME
    assert lazy.fileno() >= 0


def test_what_a_tcp_client_could_not_take_at_once_comes_when_it_reads(bench: Make) -> None:
    here = bench(TCP_IN)
    slow = here.tcp()
    here.turns()
    number = 0
    while not here.ports.sinks:
        here.ports.send(2, numbered(number))
        number += 1
    wanted = 200 * number
    got = b""
    while len(got) < wanted:
        got += slow.recv(1 << 20)
        here.turn()
    assert got == b"".join(map(numbered, range(number)))
    assert here.ports.sinks == []


def numbered(number: int) -> bytes:
    """As long as a large message."""
    return struct.pack("<I", number) * 50


def test_a_flooding_connection_is_read_later_and_loses_nothing(bench: Make) -> None:
    here = bench(TCP_IN, limits=ClientLimits(rate_hz=50.0))
    flooding, other = here.tcp(), here.tcp()
    here.turns()
    stream = bytes(range(256)) * 64
    flooding.sendall(stream)
    here.until(Datagram)
    here.turns(20)
    other.sendall(FRAME)
    came = here.until(Datagram)
    assert came == [Datagram(3, FRAME)]  # the flooding one is not even read
    got = 4096
    while got < len(stream):
        here.advance(1.0)
        got += sum(len(each.data) for each in here.turns(8) if isinstance(each, Datagram))
    assert got == len(stream)


def test_a_connection_that_finds_no_room_is_closed(bench: Make) -> None:
    here = bench(TCP_IN, limits=ClientLimits(max_clients=1))
    here.tcp()
    here.until(ClientCame)
    second = here.tcp()
    assert "no room for client" in str(here.until(LinkEvent))
    assert second.recv(10) == b""


# ------------------------------------------------------------------- one client: out, serial


def test_a_udp_port_that_sends_has_its_client_at_once_and_keeps_it(bench: Make) -> None:
    there = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    there.bind(("127.0.0.1", 0))
    there.settimeout(WAIT_S)
    port = there.getsockname()[1]
    here = bench(Endpoint(Kind.UDP_OUT, "127.0.0.1", port), UDP_IN, limits=ClientLimits(1))
    assert here.turn() == [ClientCame(2, f"udp 127.0.0.1:{port}", False, named=True)]
    here.advance(100.0)
    here.udp(1).send(FRAME)
    assert [type(each) for each in here.turn()] == [LinkEvent]
    here.ports.send(2, FRAME)
    data, back = there.recvfrom(4096)
    assert data == FRAME
    there.sendto(FRAME + b"x", back)
    assert here.turn() == [Datagram(2, FRAME + b"x")]
    there.close()


def test_a_tcp_connection_from_here_is_made_again_after_a_loss(bench: Make) -> None:
    here = bench()
    server = here.listener()
    port = server.getsockname()[1]
    here.ports.open(Endpoint(Kind.TCP_OUT, "127.0.0.1", port))
    came = here.until(ClientCame)
    assert ClientCame(2, f"tcp 127.0.0.1:{port}", True, named=True) in came
    accepted, _ = server.accept()
    accepted.sendall(FRAME)
    assert here.until(Datagram)[-1] == Datagram(2, FRAME)
    accepted.close()
    assert ClientGone(2, "the connection was lost") in here.until(ClientGone)
    assert ClientCame(2, f"tcp 127.0.0.1:{port}", True, named=True) in here.until(ClientCame)


class PtyPort:
    """What `serial._open` gives, of a pseudo-terminal."""

    def __init__(self, fd: int) -> None:
        self._fd = fd

    def fileno(self) -> int:
        return self._fd

    def close(self) -> None:
        os.close(self._fd)


@pytest.fixture
def line(monkeypatch: pytest.MonkeyPatch) -> Iterator[int]:
    """The far end of a serial line that `SerialLine` opens."""
    if sys.platform == "win32":
        pytest.skip("no pseudo-terminals")
    import pty
    import tty

    far, near = pty.openpty()
    tty.setraw(near)
    tty.setraw(far)
    monkeypatch.setattr(serial_module, "_open", lambda _: PtyPort(near))
    yield far
    os.close(far)


def test_a_serial_line_is_one_client(bench: Make, line: int) -> None:
    here = bench(Endpoint(Kind.SERIAL, device="/dev/ttyUSB7", baud=57_600))
    assert here.turn() == [ClientCame(2, "serial /dev/ttyUSB7", True, named=True)]
    os.write(line, FRAME)
    assert here.until(Datagram) == [Datagram(2, FRAME)]
    here.ports.send(2, FRAME)
    assert os.read(line, 4096) == FRAME


def test_a_full_serial_line_drops_whole_datagrams_and_never_half_of_one(
    bench: Make, line: int
) -> None:
    here = bench(Endpoint(Kind.SERIAL, device="/dev/ttyUSB7"))
    here.turn()
    os.set_blocking(line, False)
    got = b""
    for number in range(4000):
        here.ports.send(2, b"%04d" % number + b"." * 249 + b"\n")
        if number % 1000 == 999:
            got += read_all(line)
    here.ports.send(2, b"last\n")
    got += read_all(line)
    lines = got.splitlines()
    assert lines[-1] == b"last"
    assert all(len(each) == 253 for each in lines[:-1])
    assert 4 < len(lines) < 4000


def read_all(fd: int) -> bytes:
    got = b""
    try:
        while piece := os.read(fd, 1 << 16):
            got += piece
    except BlockingIOError:
        pass
    return got


# ------------------------------------------------------------------------------------ opening


def test_a_port_that_is_taken_is_told_as_such(bench: Make) -> None:
    here = bench(UDP_IN)
    with pytest.raises(AddressInUse, match="is in use by another program"):
        here.ports.open(Endpoint(Kind.UDP_IN, "127.0.0.1", here.ports.endpoints[0].port))


def test_what_the_ports_are_is_told_in_their_order(bench: Make) -> None:
    here = bench(UDP_IN, TCP_IN)
    here.turns(3)
    udp, tcp = (endpoint.port for endpoint in here.ports.endpoints)
    assert here.ports.describe() == (
        f"waiting for datagrams on udp 127.0.0.1:{udp}",
        f"waiting for connections on tcp 127.0.0.1:{tcp}",
    )
