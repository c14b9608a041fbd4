"""Datagrams."""

from __future__ import annotations

import socket

from gcs.shell.endpoints import Endpoint
from gcs.shell.sockets.base import MAX_READ, Link, bind, grow_buffer, resolve

MAX_PEERS = 4
"""How many senders an open port answers; the one heard longest ago makes room."""
_MAGICS = (0xFD, 0xFE)


class _Udp(Link):
    """What both directions share: one socket that never blocks."""

    def __init__(self, endpoint: Endpoint) -> None:
        """Raises OSError."""
        super().__init__(endpoint)
        family, self._address = resolve(endpoint, socket.SOCK_DGRAM)
        self._socket = socket.socket(family, socket.SOCK_DGRAM)
        self._socket.setblocking(False)
        self.rcvbuf = grow_buffer(self._socket)
        """Bytes of receive buffer that were granted."""

    def fileno(self) -> int:
        return self._socket.fileno()

    def close(self) -> None:
        self._socket.close()


class UdpIn(_Udp):
    """A port that waits, and answers whoever sent MAVLink to it lately."""

    def __init__(self, endpoint: Endpoint) -> None:
        """Raises AddressInUse, or OSError."""
        super().__init__(endpoint)
        self._port = bind(self._socket, self._address, endpoint)
        self._peers: dict[tuple[str, int], None] = {}
        """Known peers, the one heard last at the end."""
        self._latest: tuple[str, int] | None = None

    @property
    def port(self) -> int:
        return self._port

    def drain(self, limit: int) -> list[bytes]:
        datagrams: list[bytes] = []
        for _ in range(limit):
            try:
                data, peer = self._socket.recvfrom(MAX_READ)
            except BlockingIOError:
                break
            except OSError:
                # Windows reports here that an earlier datagram of ours found nobody.
                self.counters.refused += 1
                continue
            datagrams.append(data)
            if peer != self._latest and data[:1] and data[0] in _MAGICS:
                self._meet(peer)
        return datagrams

    def _meet(self, peer: tuple[str, int]) -> None:
        self._latest = peer
        if peer not in self._peers:
            self._news.append(f"{self.endpoint}: {peer[0]}:{peer[1]} sends to us")
            if len(self._peers) == MAX_PEERS:
                del self._peers[next(iter(self._peers))]
        else:
            del self._peers[peer]
        self._peers[peer] = None

    def send(self, data: bytes) -> None:
        if not self._peers:
            self.counters.dropped += 1
        for peer in self._peers:
            try:
                self._socket.sendto(data, peer)
            except OSError:
                self.counters.dropped += 1

    def describe(self) -> str:
        buffer = f"receive buffer {self.rcvbuf >> 10} KiB"
        host = self.endpoint.host
        return f"listening on udp {host}:{self._port}, {buffer}"


class UdpOut(_Udp):
    """A connected socket: sends to one place, hears from there alone."""

    def __init__(self, endpoint: Endpoint) -> None:
        """Raises OSError."""
        super().__init__(endpoint)
        try:
            self._socket.connect((self._address, endpoint.port))
        except OSError:
            self._socket.close()
            raise

    def drain(self, limit: int) -> list[bytes]:
        datagrams: list[bytes] = []
        for _ in range(limit):
            try:
                datagrams.append(self._socket.recv(MAX_READ))
            except BlockingIOError:
                break
            except OSError:
                # Nobody listens there (yet): the kernel tells on the next call.
                self.counters.refused += 1
        return datagrams

    def send(self, data: bytes) -> None:
        try:
            self._socket.send(data)
        except ConnectionRefusedError:
            self.counters.refused += 1
        except OSError:
            self.counters.dropped += 1

    def describe(self) -> str:
        to = f"{self._address}:{self.endpoint.port}"
        return f"sending to and hearing from udp {to}, receive buffer {self.rcvbuf >> 10} KiB"
