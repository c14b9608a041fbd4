"""Links over loopback: real sockets on free ports, a clock that the test advances."""

from __future__ import annotations

import builtins
import errno
import select
import socket
from collections.abc import Callable, Iterator
from contextlib import ExitStack, closing

import pytest

from gcs.bridge.peers.link_loops import LEFT_OUT_NS
from gcs.shell.endpoints import Endpoint, Kind, parse_endpoint
from gcs.shell.sockets import AddressInUse, Link, SerialUnavailable, TcpIn, TcpOut, UdpIn, open_link
from gcs.shell.sockets.base import News, grow_buffer
from gcs.shell.sockets.tcp import MAX_QUEUED, RECONNECT_NS
from gcs.shell.sockets.udp import MAX_PEERS, MOST_LEFT_OUT, THERE_NS

pytestmark = pytest.mark.slow

FRAME = b"\xfd\x01\x00\x00 a frame"
ODD = b"these bytes alone"
PATIENCE_S = 60.0

Opener = Callable[[Endpoint], Link]


@pytest.fixture
def opened() -> Iterator[Opener]:
    with ExitStack() as stack:

        def opener(endpoint: Endpoint) -> Link:
            link = open_link(endpoint)
            stack.callback(link.close)
            return link

        yield opener


def read(link: Link, limit: int = 100) -> list[bytes]:
    """Wait as the loop does, then drain."""
    readable, _, _ = select.select([link], [], [], PATIENCE_S)
    assert readable, "nothing came"
    return link.drain(limit)


def read_bytes(link: Link, size: int) -> bytes:
    """From a stream, whatever pieces it comes in."""
    data = b""
    while len(data) < size:
        data += b"".join(read(link))
    return data


def due_ns(link: Link) -> int | None:
    return link.deadline_ns


def free_port(kind: socket.SocketKind) -> int:
    """One that was free a moment ago."""
    with socket.socket(socket.AF_INET, kind) as sock:
        sock.bind(("127.0.0.1", 0))
        return int(sock.getsockname()[1])


def udp_in(port: int = 0) -> Endpoint:
    return Endpoint(Kind.UDP_IN, "127.0.0.1", port)


def udp_out(port: int) -> Endpoint:
    return Endpoint(Kind.UDP_OUT, "127.0.0.1", port)


def tcp_in(port: int = 0) -> Endpoint:
    return Endpoint(Kind.TCP_IN, "127.0.0.1", port)


def tcp_out(port: int) -> Endpoint:
    return Endpoint(Kind.TCP_OUT, "127.0.0.1", port)


# ---------------------------------------------------------------------------------- udp


def test_a_waiting_port_answers_whoever_sent(opened: Opener) -> None:
    station = opened(udp_in())
    vehicle = opened(udp_out(station.port))
    station.send(FRAME)
    assert station.counters.dropped == 1
    vehicle.send(FRAME)
    vehicle.send(FRAME + b"2")
    assert read(station) == [FRAME, FRAME + b"2"]
    station.send(b"\xfdanswer")
    assert read(vehicle) == [b"\xfdanswer"]
    (news,) = station.poke(0)
    assert news.text.endswith("sends to us")
    assert not news.trouble
    assert station.poke(0) == []


def test_a_second_sender_is_warned_of_once(opened: Opener) -> None:
    """Beside one that is there: it may be another vehicle, or somebody who plays the first one."""
    station = opened(udp_in())
    vehicle, *others = (opened(udp_out(station.port)) for _ in range(MAX_PEERS + 1))
    vehicle.send(FRAME)
    read(station)
    station.poke(0)
    told: list[News] = []
    for _ in range(3):
        for each in (*others, vehicle):
            each.send(FRAME)
            read(station)
            told += station.poke(0)
    assert len(told) == MAX_PEERS + 1, "each is told of once, however often it makes room and comes"
    assert all(each.trouble for each in told)
    assert told[0].text == (
        f"{station.endpoint}: {address_of(others[0])} sends to us, beside {address_of(vehicle)}: "
        "one of them may play the vehicle to us"
    )


def address_of(link: Link) -> str:
    with closing(socket.fromfd(link.fileno(), socket.AF_INET, socket.SOCK_DGRAM)) as same:
        host, port = same.getsockname()
        return f"{host}:{port}"


def test_two_vehicles_on_one_port_both_hear(opened: Opener) -> None:
    station = opened(udp_in())
    vehicles = [opened(udp_out(station.port)) for _ in range(2)]
    for vehicle in vehicles:
        vehicle.send(FRAME)
        read(station)
    station.send(b"\xfdall")
    assert [read(vehicle) for vehicle in vehicles] == [[b"\xfdall"]] * 2


def test_the_peer_heard_longest_ago_makes_room(opened: Opener) -> None:
    station = opened(udp_in())
    vehicles = [opened(udp_out(station.port)) for _ in range(MAX_PEERS + 1)]
    for vehicle in [*vehicles[:MAX_PEERS], vehicles[0], vehicles[MAX_PEERS]]:
        vehicle.send(FRAME)
        read(station)
    station.send(b"\xfdall")
    heard_lately = [vehicles[0], *vehicles[2:]]
    assert len(heard_lately) == MAX_PEERS
    assert [read(vehicle) for vehicle in heard_lately] == [[b"\xfdall"]] * MAX_PEERS
    assert vehicles[1].drain(1) == []


def test_garbage_makes_no_peer(opened: Opener) -> None:
    station = opened(udp_in())
    stranger = opened(udp_out(station.port))
    stranger.send(b"GET / HTTP/1.1")
    stranger.send(b"")
    assert read(station) == [b"GET / HTTP/1.1", b""]
    station.send(b"\xfdanswer")
    assert station.counters.dropped == 1
    assert stranger.drain(1) == []


class LimitedSocket(socket.socket):
    """As on macOS: more than its limit is refused, not cut."""

    limit = 1 << 20

    def setsockopt(self, level: int, option: int, value: int) -> None:  # type: ignore[override]
        if option == socket.SO_RCVBUF and value > self.limit:
            raise OSError(errno.ENOBUFS, "No buffer space available")
        super().setsockopt(level, option, value)


@pytest.mark.parametrize("limit", [1 << 20, 0])
def test_a_receive_buffer_over_the_systems_limit_is_asked_for_smaller(limit: int) -> None:
    with LimitedSocket(socket.AF_INET, socket.SOCK_DGRAM) as sock:
        before = sock.getsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF)
        sock.limit = limit
        granted = grow_buffer(sock)
        assert granted == sock.getsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF)
        assert (granted == before) is (limit == 0)


def test_draining_takes_no_more_than_asked_and_never_waits(opened: Opener) -> None:
    station = opened(udp_in())
    vehicle = opened(udp_out(station.port))
    for n in range(5):
        vehicle.send(FRAME + bytes((n,)))
    assert len(read(station, limit=3)) == 3
    assert len(read(station, limit=3)) == 2
    assert station.drain(3) == []


def test_a_peer_that_sends_back_is_left_out_until_it_is_silent(opened: Opener) -> None:
    station = opened(udp_in())
    vehicle, other = opened(udp_out(station.port)), opened(udp_out(station.port))
    now_ns = 1_000 * LEFT_OUT_NS
    station.poke(now_ns)
    vehicle.send(FRAME)
    assert read(station) == [FRAME]
    other.send(b"\xfd before, " + ODD)
    read(station)
    station.poke(now_ns)
    station.leave_out(b"never sent", LEFT_OUT_NS)
    station.leave_out(ODD, LEFT_OUT_NS)
    (news,) = station.poke(now_ns)
    assert "is left out, until it has been silent for 5 s: it sends back what clients" in news.text
    station.send(b"for the vehicle")
    assert read(vehicle) == [b"for the vehicle"]
    other.drain(1)
    assert other.counters.refused == 0
    for _ in range(3):
        other.send(FRAME)
        vehicle.send(b"\xfd of the vehicle")
        assert read(station) == [b"\xfd of the vehicle"], "the other's came before it"
        now_ns += LEFT_OUT_NS
        station.poke(now_ns)
    now_ns += 1
    station.poke(now_ns)
    other.send(FRAME)
    assert read(station) == [FRAME], "it was silent for long enough"
    station.send(b"for both")
    assert read(other) == [b"for both"]


def test_the_only_peer_that_is_there_is_not_left_out(opened: Opener) -> None:
    station = opened(udp_in())
    gone, other = opened(udp_out(station.port)), opened(udp_out(station.port))
    station.poke(THERE_NS)
    gone.send(FRAME)
    read(station)
    other.send(FRAME)
    read(station)
    station.poke(2 * THERE_NS + 1)
    other.send(b"\xfd" + ODD)
    assert read(station) == [b"\xfd" + ODD]
    station.leave_out(ODD, LEFT_OUT_NS)
    assert len(station.poke(2 * THERE_NS + 1)) == 0
    other.send(FRAME)
    assert read(station) == [FRAME], "the other one has not been heard for more than 3 s"
    gone.send(b"\xfd again")
    read(station)
    other.send(ODD + FRAME)
    read(station)
    station.leave_out(ODD, LEFT_OUT_NS)
    other.send(FRAME)
    assert read(station) == [FRAME], "what does not begin as MAVLink says nothing of its sender"
    other.send(FRAME + ODD)
    read(station)
    station.leave_out(ODD, LEFT_OUT_NS)
    other.send(FRAME)
    gone.send(b"\xfd there")
    assert read(station) == [b"\xfd there"], "now it is heard again, and the other one is not"


def test_of_very_many_that_were_left_out_the_first_is_forgotten(opened: Opener) -> None:
    station = opened(udp_in())
    vehicle = opened(udp_out(station.port))
    peers = [opened(udp_out(station.port)) for _ in range(MOST_LEFT_OUT + 1)]
    for peer in peers:
        vehicle.send(FRAME)
        peer.send(b"\xfd" + ODD)
        read(station)
        station.leave_out(ODD, LEFT_OUT_NS)
    peers[1].send(FRAME)
    peers[0].send(b"\xfd first")
    assert read(station) == [b"\xfd first"]


def test_nobody_listening_is_counted_and_no_error(opened: Opener) -> None:
    vehicle = opened(udp_out(free_port(socket.SOCK_DGRAM)))
    for _ in range(3):
        vehicle.send(FRAME)
    vehicle.drain(10)
    assert vehicle.counters.refused > 0


def test_a_port_in_use_is_an_error_of_its_own(opened: Opener) -> None:
    station = opened(udp_in())
    with pytest.raises(AddressInUse, match=rf"udpin://127\.0\.0\.1:{station.port} is in use"):
        opened(udp_in(station.port))
    server = opened(tcp_in())
    with pytest.raises(AddressInUse):
        opened(tcp_in(server.port))


def test_an_address_that_is_not_ours_is_another_error(opened: Opener) -> None:
    with pytest.raises(OSError, match="address") as caught:
        opened(Endpoint(Kind.UDP_IN, "192.0.2.1", 0))
    assert not isinstance(caught.value, AddressInUse)


def test_a_link_describes_itself_with_the_buffer_it_got(opened: Opener) -> None:
    station = opened(udp_in())
    assert isinstance(station, UdpIn)
    assert station.rcvbuf > 0
    assert f"127.0.0.1:{station.port}, receive buffer {station.rcvbuf >> 10} KiB" in (
        station.describe()
    )


# ---------------------------------------------------------------------------------- tcp


def connect(client: Link, now_ns: int = 0) -> int:
    """Poke until it is connected; the time that it is then."""
    assert isinstance(client, TcpOut)
    for _ in range(20):
        news = client.poke(now_ns)
        if client.connected:
            assert any("connected" in line.text for line in news)
            return now_ns
        now_ns = due_ns(client) or now_ns
    raise AssertionError("not connected")


def test_a_client_and_a_server_exchange_a_stream(opened: Opener) -> None:
    server = opened(tcp_in())
    client = opened(tcp_out(server.port))
    assert client.fileno() == -1
    assert due_ns(client) == 0
    connect(client)
    assert due_ns(client) is None
    client.send(b"abc")
    assert read_bytes(server, 3) == b"abc"
    server.send(b"xyz")
    assert read(client) == [b"xyz"]
    assert "connected to tcp" in client.describe()


def test_a_client_tries_again_once_a_second(opened: Opener) -> None:
    port = free_port(socket.SOCK_STREAM)
    client = opened(tcp_out(port))
    now_ns = 0
    while client.counters.refused == 0:
        client.poke(now_ns)
        assert client.deadline_ns is not None
        now_ns = client.deadline_ns
    failed_ns = now_ns - RECONNECT_NS
    assert client.deadline_ns == failed_ns + RECONNECT_NS
    client.send(FRAME)
    assert client.counters.dropped == 1
    client.poke(now_ns - 1)
    assert client.counters.refused == 1
    server = opened(tcp_in(port))
    connect(client, now_ns)
    select.select([server], [], [], PATIENCE_S)
    server.drain(1)
    assert isinstance(server, TcpIn)
    assert server.connected


def test_a_lost_connection_is_told_and_made_again(opened: Opener) -> None:
    server = opened(tcp_in())
    client = opened(tcp_out(server.port))
    now_ns = connect(client)
    server.drain(1)
    server.close()
    assert read(client) == []
    assert client.fileno() == -1
    assert due_ns(client) == 0
    assert any("closed" in line.text for line in client.poke(now_ns))
    again = opened(tcp_in(server.port))
    connect(client, now_ns + RECONNECT_NS)
    client.send(b"back")
    assert read_bytes(again, 4) == b"back"


def test_a_newer_client_takes_the_place_of_the_older(opened: Opener) -> None:
    server = opened(tcp_in())
    old, new = opened(tcp_out(server.port)), opened(tcp_out(server.port))
    connect(old)
    server.poke(0)
    connect(new)
    server.poke(RECONNECT_NS)
    server.send(b"hello")
    assert read(new) == [b"hello"]
    assert read(old) == []


def test_a_slow_reader_costs_whole_frames_and_no_memory(opened: Opener) -> None:
    server = opened(tcp_in())
    with closing(socket.create_connection(("127.0.0.1", server.port))) as reader:
        server.poke(0)
        frame = bytes(range(250)) * 4
        for _ in range(20_000):
            server.send(frame)
        lost = server.counters.dropped
        assert lost > 0
        received = bytearray()
        reader.settimeout(PATIENCE_S)
        while len(received) < (20_000 - lost) * len(frame):
            received += reader.recv(1 << 16)
            server.poke(0)
        assert received == frame * (20_000 - lost)
    assert len(frame) < MAX_QUEUED


# ------------------------------------------------------------------------------- serial


def test_without_pyserial_the_hint_says_what_to_install(monkeypatch: pytest.MonkeyPatch) -> None:
    genuine = builtins.__import__

    def without_serial(name: str, *rest: object) -> object:
        if name == "serial":
            raise ImportError(name)
        return genuine(name, *rest)  # type: ignore[arg-type]  # passed through as they came

    monkeypatch.setattr(builtins, "__import__", without_serial)
    with pytest.raises(SerialUnavailable, match="pyserial") as caught:
        open_link(parse_endpoint("/dev/ttyUSB0,57600"))
    assert "pip install" in caught.value.hint
