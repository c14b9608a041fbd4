"""Sockets: one class a kind of link.  All are non-blocking and never raise while in use."""

from __future__ import annotations

import contextlib
import errno
import socket
from typing import Final, Protocol, TypeAlias

from vehicle_sim.shell.readable import Readable, ReadableSockets
from vehicle_sim.shell.urls import Url, UrlKind
from vehicle_sim.simulation.world import Datagram, Input, Joined, Left, Peer
from vehicle_sim.wire.split import Reassembler

Address: TypeAlias = tuple[str, int]

RECEIVE_BUFFER_BYTES: Final = 4 * 1024 * 1024
READ_BYTES: Final = 65536
DRAIN_MAX: Final = 1000
UNSENT_MAX_BYTES: Final = 1024 * 1024
"""What a TCP client may leave unread before it is dropped."""
CONNECT_AGAIN_NS: Final = 1_000_000_000
ACCEPT_MAX: Final = 100
"""Connections let in at one turn of the loop."""
ACCEPT_AGAIN_NS: Final = 1_000_000_000
NO_DESCRIPTORS: Final = frozenset({errno.EMFILE, errno.ENFILE})


class EndpointError(Exception):
    """An endpoint could not be opened."""

    def __init__(self, url: Url, cause: OSError) -> None:
        super().__init__(f"{url}: {cause.strerror or cause}")
        self.url = url
        self.cause = cause


class Endpoint(Protocol):
    """One link of the world."""

    @property
    def link(self) -> int: ...
    @property
    def peers(self) -> tuple[Peer, ...]:
        """Who is spoken to without having been heard."""
        ...

    @property
    def url(self) -> Url:
        """As it was opened: port 0 has become the port that the system chose."""
        ...

    @property
    def restless(self) -> bool:
        """Whether it wants `idle`."""
        ...

    def attach(self, watch: ReadableSockets) -> None:
        """Have its sockets watched, now and later, under the number of the link."""
        ...

    def read(self, ready: Readable) -> list[Input]:
        """Everything that one of those sockets has to give."""
        ...

    def idle(self, now_ns: int) -> list[Input]:
        """Called every turn of the loop, for what is not started by reading."""
        ...

    def send(self, peer: Peer, data: bytes) -> None: ...
    def close(self) -> None: ...


def _family(host: str) -> socket.AddressFamily:
    return socket.AF_INET6 if ":" in host else socket.AF_INET


class Udp:
    """udpin: bound, speaks to all that it has heard.  udpout: connected, speaks at once."""

    def __init__(self, link: int, url: Url) -> None:
        self.link: Final = link
        self._connected = url.kind is UrlKind.UDP_OUT
        self._remote: Address = (url.host, url.port)
        self.peers: Final[tuple[Peer, ...]] = (self._remote,) if self._connected else ()
        self._socket = socket.socket(_family(url.host), socket.SOCK_DGRAM)
        try:
            self._socket.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, RECEIVE_BUFFER_BYTES)
            if self._connected:
                self._socket.connect(self._remote)
            else:
                self._socket.bind((url.host, url.port))
        except OSError as cause:
            self._socket.close()
            raise EndpointError(url, cause) from cause
        self._socket.setblocking(False)
        self.url: Final = url if self._connected else url.at(self._socket.getsockname()[1])

    restless = False

    @property
    def granted_bytes(self) -> int:
        """The receive buffer that the kernel gave."""
        return self._socket.getsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF)

    def attach(self, watch: ReadableSockets) -> None:
        watch.add(self._socket, self.link)

    def read(self, ready: Readable) -> list[Input]:
        heard: list[Input] = []
        for _ in range(DRAIN_MAX):
            try:
                data, source = self._socket.recvfrom(READ_BYTES)
            except BlockingIOError:
                break
            except OSError:
                # Nobody listens there (ICMP from loopback), which is no reason to stop.
                continue
            heard.append(Datagram(self.link, self._remote if self._connected else source, data))
        return heard

    def idle(self, now_ns: int) -> list[Input]:
        return []

    def send(self, peer: Peer, data: bytes) -> None:
        # A datagram that cannot be sent is a datagram lost.
        with contextlib.suppress(OSError):
            if self._connected:
                self._socket.send(data)
            else:
                self._socket.sendto(data, peer)  # type: ignore[call-overload]  # as received

    def close(self) -> None:
        self._socket.close()


class _Connection:
    """One TCP stream: bytes in are cut at frames, bytes out wait for the other side."""

    def __init__(self, stream: socket.socket, peer: Address) -> None:
        stream.setblocking(False)
        stream.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        self.stream = stream
        self.peer = peer
        self._reassembler = Reassembler()
        self._unsent = b""

    def read(self) -> bytes | None:
        """Whole frames, possibly none; None = closed."""
        try:
            data = self.stream.recv(READ_BYTES)
        except BlockingIOError:
            return b""
        except OSError:
            return None
        return self._reassembler.feed(data) if data else None

    def send(self, data: bytes) -> bool:
        """False = the other side is gone, or does not read."""
        self._unsent += data
        try:
            self._unsent = self._unsent[self.stream.send(self._unsent) :]
        except BlockingIOError:
            return len(self._unsent) <= UNSENT_MAX_BYTES
        except OSError:
            return False
        return True


class _Streams:
    """The connections of one TCP link."""

    restless = True

    def __init__(self, link: int) -> None:
        self.link: Final = link
        self.peers: Final[tuple[Peer, ...]] = ()
        self._connections: dict[Peer, _Connection] = {}
        self._lost: list[Peer] = []
        self._watch: ReadableSockets | None = None

    def attach(self, watch: ReadableSockets) -> None:
        self._watch = watch

    def _join(self, stream: socket.socket, peer: Address) -> Joined:
        self._connections[peer] = _Connection(stream, peer)
        if self._watch is not None:
            self._watch.add(stream, self.link)
        return Joined(self.link, peer)

    def _drop(self, peer: Peer) -> Left:
        stream = self._connections.pop(peer).stream
        if self._watch is not None:
            self._watch.drop(stream)
        stream.close()
        return Left(self.link, peer)

    def _read(self, ready: Readable) -> list[Input]:
        for peer, connection in list(self._connections.items()):
            if connection.stream is ready:
                data = connection.read()
                if data is None:
                    return [self._drop(peer)]
                return [Datagram(self.link, peer, data)] if data else []
        return []

    def idle(self, now_ns: int) -> list[Input]:
        lost, self._lost = self._lost, []
        return [self._drop(peer) for peer in lost if peer in self._connections]

    def send(self, peer: Peer, data: bytes) -> None:
        connection = self._connections.get(peer)
        if connection is not None and not connection.send(data) and peer not in self._lost:
            self._lost.append(peer)

    def close(self) -> None:
        for connection in self._connections.values():
            connection.stream.close()


class TcpServer(_Streams):
    """tcpin: any number of clients."""

    def __init__(self, link: int, url: Url) -> None:
        super().__init__(link)
        self._listener = socket.socket(_family(url.host), socket.SOCK_STREAM)
        try:
            self._listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
            self._listener.bind((url.host, url.port))
            self._listener.listen()
        except OSError as cause:
            self._listener.close()
            raise EndpointError(url, cause) from cause
        self._listener.setblocking(False)
        self._full = False
        self._again_ns: int | None = None
        self.url: Final = url.at(self._listener.getsockname()[1])

    def attach(self, watch: ReadableSockets) -> None:
        super().attach(watch)
        watch.add(self._listener, self.link)

    def read(self, ready: Readable) -> list[Input]:
        if ready is not self._listener:
            return self._read(ready)
        joined: list[Input] = []
        while len(joined) < ACCEPT_MAX:
            try:
                stream, peer = self._listener.accept()
            except OSError as cause:
                # Nobody more waits, or who did went away again; or there is no room for them.
                if cause.errno in NO_DESCRIPTORS:
                    self._rest()
                break
            joined.append(self._join(stream, (peer[0], peer[1])))
        return joined

    def _rest(self) -> None:
        """Who waits is let in later: a listener that cannot accept would wake us all the time."""
        if self._watch is not None and not self._full:
            self._watch.drop(self._listener)
            self._full = True

    def idle(self, now_ns: int) -> list[Input]:
        gone = super().idle(now_ns)
        if self._full:
            if self._again_ns is None:
                self._again_ns = now_ns + ACCEPT_AGAIN_NS
            elif now_ns >= self._again_ns and self._watch is not None:
                self._full, self._again_ns = False, None
                self._watch.add(self._listener, self.link)
        return gone

    def close(self) -> None:
        super().close()
        self._listener.close()


class TcpClient(_Streams):
    """tcpout: one connection, tried once a second until it stands, and again when it breaks."""

    def __init__(self, link: int, url: Url) -> None:
        super().__init__(link)
        self.url: Final = url
        self._again_ns = 0

    def read(self, ready: Readable) -> list[Input]:
        return self._read(ready)

    def idle(self, now_ns: int) -> list[Input]:
        gone = super().idle(now_ns)
        if self._connections or now_ns < self._again_ns:
            return gone
        self._again_ns = now_ns + CONNECT_AGAIN_NS
        remote = (self.url.host, self.url.port)
        try:
            stream = socket.create_connection(remote, timeout=0.2)
        except OSError:
            return gone
        return [*gone, self._join(stream, remote)]


def open_endpoint(link: int, url: Url) -> Udp | TcpServer | TcpClient:
    """Raises EndpointError."""
    match url.kind:
        case UrlKind.UDP_IN | UrlKind.UDP_OUT:
            return Udp(link, url)
        case UrlKind.TCP_IN:
            return TcpServer(link, url)
        case UrlKind.TCP_OUT:
            return TcpClient(link, url)
