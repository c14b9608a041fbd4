"""The kinds of client port: sockets that turn what comes into clients of a `ClientTable`.

A UDP port that waits has many peers, a TCP port many connections; each of them is a client with a
link of its own.  A UDP port that sends, a TCP connection that is made from here and a serial line
are one client each.  Nothing here waits: what a client does not take is dropped (UDP, serial) or
ends its connection (TCP).
"""

from __future__ import annotations

import os
import socket
from abc import ABC, abstractmethod
from collections.abc import Sequence
from typing import Protocol, assert_never

from gcs.shell.client_table import MAGICS, MAX_A_TURN, ClientTable
from gcs.shell.endpoints import Endpoint, Kind
from gcs.shell.sockets import open_link
from gcs.shell.sockets.base import MAX_READ, bind, grow_buffer, resolve
from gcs.shell.sockets.tcp import Stream, TcpOut

READS_A_TURN = 1024
"""Datagrams that one port reads in a turn; those over a client's rate cost next to nothing."""
STREAM_READ = 4096
"""Bytes of one read of a stream: what the session handles at once between two ticks."""
ACCEPTS_A_TURN = 4


class Source(Protocol):
    """What `select` can wait for."""

    def fileno(self) -> int: ...


class Port(ABC):
    """One endpoint of `--client`."""

    def __init__(self, endpoint: Endpoint, table: ClientTable) -> None:
        self.endpoint = endpoint
        self._table = table

    @abstractmethod
    def sources(self, now_ns: int) -> Sequence[Source]: ...

    @abstractmethod
    def turn(self, ready: Sequence[object], now_ns: int) -> None:
        """Read what is there, into the table."""

    @abstractmethod
    def describe(self) -> str: ...

    @abstractmethod
    def close(self) -> None: ...

    @property
    def port(self) -> int:
        return self.endpoint.port

    @property
    def sinks(self) -> Sequence[Source]:
        """What waits to be written to."""
        return ()

    def flush(self, writable: Sequence[object]) -> None:  # noqa: B027 - most have no sinks
        """They can be written to again."""


# ------------------------------------------------------------------------------------- UDP


class _UdpPeer:
    """One sender to a port that waits."""

    stream = False
    expires = True
    stays = False

    def __init__(self, port: UdpPort, address: tuple[str, int]) -> None:
        self.name = f"udp {address[0]}:{address[1]}"
        self._port = port
        self._address = address
        self._sendto = port.socket.sendto

    def send(self, data: bytes) -> str:
        try:  # noqa: SIM105 - every frame passes here, and `suppress` costs as much as the rest
            self._sendto(data, self._address)
        except OSError:
            pass
        return ""

    def forget(self) -> None:
        self._port.links.pop(self._address, None)


class UdpPort(Port):
    """Waits for datagrams; every sender of MAVLink is a client."""

    def __init__(self, endpoint: Endpoint, table: ClientTable) -> None:
        """Raises AddressInUse, or OSError."""
        super().__init__(endpoint, table)
        family, address = resolve(endpoint, socket.SOCK_DGRAM)
        self.socket = socket.socket(family, socket.SOCK_DGRAM)
        self.socket.setblocking(False)
        grow_buffer(self.socket)
        self._bound = bind(self.socket, address, endpoint)
        self.links: dict[tuple[str, int], int] = {}

    @property
    def port(self) -> int:
        return self._bound

    def sources(self, now_ns: int) -> Sequence[Source]:
        return (self.socket,)

    def turn(self, ready: Sequence[object], now_ns: int) -> None:
        if self.socket not in ready:
            return
        table, links = self._table, self.links
        for _ in range(READS_A_TURN):
            if table.full_turn:
                return
            try:
                data, address = self.socket.recvfrom(MAX_READ)
            except BlockingIOError:
                return
            except OSError:
                continue  # Windows reports here that an earlier datagram of ours found nobody.
            link = links.get(address)
            if link is None:
                if not data or data[0] not in MAGICS:
                    continue
                link = table.come(_UdpPeer(self, address), now_ns)
                if link is None:
                    continue
                links[address] = link
            table.heard(link, data, now_ns)

    def describe(self) -> str:
        return f"waiting for datagrams on udp {self.endpoint.host}:{self._bound}"

    def close(self) -> None:
        self.socket.close()


# ------------------------------------------------------------------------------------- TCP


class _TcpPeer:
    """One connection to a port that waits."""

    stream = True
    expires = False
    stays = False

    def __init__(self, port: TcpPort, connected: Stream, peer: tuple[str, int]) -> None:
        self.name = f"tcp {peer[0]}:{peer[1]}"
        self.connected = connected
        self._port = port

    def fileno(self) -> int:
        return self.connected.socket.fileno()

    def send(self, data: bytes) -> str:
        return "" if self.connected.write(data) else "it does not read what it is sent"

    def forget(self) -> None:
        self._port.links.pop(self, None)
        self.connected.socket.close()


class TcpPort(Port):
    """Waits for connections; each is a client."""

    def __init__(self, endpoint: Endpoint, table: ClientTable) -> None:
        """Raises AddressInUse, or OSError."""
        super().__init__(endpoint, table)
        family, address = resolve(endpoint, socket.SOCK_STREAM)
        self._listener = socket.socket(family, socket.SOCK_STREAM)
        self._listener.setblocking(False)
        if os.name == "posix":
            # Elsewhere this option would let two programs share the port.
            self._listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        self._bound = bind(self._listener, address, endpoint)
        self._listener.listen(8)
        self.links: dict[_TcpPeer, int] = {}

    @property
    def port(self) -> int:
        return self._bound

    def sources(self, now_ns: int) -> Sequence[Source]:
        table = self._table
        peers = [peer for peer, link in self.links.items() if table.may_read(link, now_ns)]
        return [self._listener, *peers]

    @property
    def sinks(self) -> Sequence[Source]:
        return [peer for peer in self.links if peer.connected.queued]

    def flush(self, writable: Sequence[object]) -> None:
        for peer in self.links:
            if peer in writable:
                peer.connected.flush()

    def turn(self, ready: Sequence[object], now_ns: int) -> None:
        if self._listener in ready:
            self._accept(now_ns)
        for peer, link in list(self.links.items()):
            if peer in ready and link in self._table and self._table.may_read(link, now_ns):
                self._read(peer, link, now_ns)

    def _read(self, peer: _TcpPeer, link: int, now_ns: int) -> None:
        """One piece: the rest waits for the next turn, so that nobody waits for one that floods."""
        pieces, alive = peer.connected.read(1, STREAM_READ)
        for piece in pieces:
            self._table.heard(link, piece, now_ns)
        if not alive:
            self._table.gone(link, "the connection was closed")

    def _accept(self, now_ns: int) -> None:
        for _ in range(ACCEPTS_A_TURN):
            try:
                connected, address = self._listener.accept()
            except OSError:
                return
            peer = _TcpPeer(self, Stream(connected), address)
            link = self._table.come(peer, now_ns)
            if link is None:
                connected.close()
            else:
                self.links[peer] = link

    def describe(self) -> str:
        return f"waiting for connections on tcp {self.endpoint.host}:{self._bound}"

    def close(self) -> None:
        self._listener.close()


# --------------------------------------------------- one client: UDP out, TCP out, serial


class LinkPort(Port):
    """A link of the ordinary kind: its client is there while the link is.

    It is itself the way to its client.
    """

    expires = False
    stays = True

    def __init__(self, endpoint: Endpoint, table: ClientTable) -> None:
        """Raises SerialUnavailable, or another OSError."""
        super().__init__(endpoint, table)
        self.link = open_link(endpoint)
        self.link.read_bytes = STREAM_READ
        self.stream = self.link.stream
        where = endpoint.device or f"{endpoint.host}:{endpoint.port}"
        self.name = f"{endpoint.kind.value.removesuffix('out')} {where}"
        self._client: int | None = None

    def sources(self, now_ns: int) -> Sequence[Source]:
        client = self._client
        if self.link.fileno() < 0 or client is None:
            return ()
        may_read = not self.stream or self._table.may_read(client, now_ns)
        return (self.link,) if may_read else ()

    def turn(self, ready: Sequence[object], now_ns: int) -> None:
        for news in self.link.poke(now_ns):
            self._table.news(news.text)
        self._come_or_go(now_ns)
        client = self._client
        if client is None or self.link not in ready or self._table.full_turn:
            return
        # A stream that floods is read on later; of datagrams the table drops some.
        for data in self.link.drain(1 if self.stream else MAX_A_TURN):
            self._table.heard(client, data, now_ns)
        self._come_or_go(now_ns)

    def _come_or_go(self, now_ns: int) -> None:
        there = self.link.fileno() >= 0
        if there and self._client is None:
            self._client = self._table.come(self, now_ns)
        elif not there and self._client is not None:
            self._table.gone(self._client, "the connection was lost")

    # As the table's `Peer`:

    def send(self, data: bytes) -> str:
        dropped = self.link.counters.dropped
        self.link.send(data)
        if isinstance(self.link, TcpOut) and self.link.counters.dropped > dropped:
            return "it does not read what it is sent"
        return ""

    def forget(self) -> None:
        self._client = None
        if isinstance(self.link, TcpOut):
            self.link.disconnect()

    @property
    def deadline_ns(self) -> int | None:
        return self.link.deadline_ns

    def describe(self) -> str:
        return self.link.describe()

    def close(self) -> None:
        self.link.close()


def open_port(endpoint: Endpoint, table: ClientTable) -> Port:
    """Raises AddressInUse, SerialUnavailable, or another OSError."""
    match endpoint.kind:
        case Kind.UDP_IN:
            return UdpPort(endpoint, table)
        case Kind.TCP_IN:
            return TcpPort(endpoint, table)
        case Kind.UDP_OUT | Kind.TCP_OUT | Kind.SERIAL:
            return LinkPort(endpoint, table)
        case _:
            assert_never(endpoint.kind)
