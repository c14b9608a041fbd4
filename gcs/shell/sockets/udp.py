"""Datagrams."""

from __future__ import annotations

import socket
from collections.abc import Sequence

from gcs.shell.endpoints import Endpoint
from gcs.shell.sockets.base import MAX_READ, Link, News, bind, grow_buffer, resolve

MAX_PEERS = 4
"""How many senders an open port answers; the one heard longest ago makes room."""
_MAGICS = (0xFD, 0xFE)
_BEGINS = (b"\xfd", b"\xfe")
THERE_NS = 3_000_000_000
"""How long after its last datagram a peer still counts as there."""
MOST_LEFT_OUT = 64
MOST_WARNED_OF = 64
_Peer = tuple[str, int]


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
        self._peers: dict[_Peer, int] = {}
        """Known peers, the one heard last at the end, and about when each was heard last."""
        self._latest: _Peer | None = None
        self._left_out: dict[_Peer, int] = {}
        """Peers that are not heard, and when each sent something last."""
        self._warned_of: set[_Peer] = set()
        """Peers that came beside others, which is told once of each."""
        self._left_out_ns = 0
        """One of these is a peer as any other again once it was silent for so long."""
        self._drained: list[bytes] = []
        self._changes: list[tuple[int, _Peer | None]] = []
        """From which of these datagrams on they are of which peer."""
        self._now_ns = 0
        """As it was when the loop last asked."""

    @property
    def port(self) -> int:
        return self._port

    def drain(self, limit: int) -> list[bytes]:
        datagrams = self._drained = []
        changes = self._changes = [(0, self._latest)]
        for _ in range(limit):
            try:
                data, peer = self._socket.recvfrom(MAX_READ)
            except BlockingIOError:
                break
            except OSError:
                # Windows reports here that an earlier datagram of ours found nobody.
                self.counters.refused += 1
                continue
            if self._left_out and self._is_left_out(peer):
                continue
            datagrams.append(data)
            if peer != self._latest and data[:1] and data[0] in _MAGICS:
                changes.append((len(datagrams) - 1, peer))
                self._meet(peer)
        return datagrams

    def _is_left_out(self, peer: _Peer) -> bool:
        """A datagram of it came."""
        last_ns = self._left_out.get(peer)
        if last_ns is None:
            return False
        if self._now_ns - last_ns > self._left_out_ns:
            del self._left_out[peer]
            return False
        self._left_out[peer] = self._now_ns
        return True

    def leave_out(self, data: bytes, silent_ns: int) -> None:
        sent = (at for at, each in enumerate(self._drained) if each[:1] in _BEGINS and data in each)
        number = next(sent, None)
        if number is None:
            return
        peer = next(each for begin, each in reversed(self._changes) if begin <= number)
        if peer is None or peer not in self._peers:
            return
        since_ns = self._now_ns - THERE_NS
        if not any(each != peer and ns >= since_ns for each, ns in self._peers.items()):
            return
        del self._peers[peer]
        self._latest = None
        if len(self._left_out) == MOST_LEFT_OUT:
            del self._left_out[next(iter(self._left_out))]
        self._left_out[peer] = self._now_ns
        self._left_out_ns = silent_ns
        why = "it sends back what clients are sent"
        until = f"until it has been silent for {silent_ns / 1e9:.0f} s"
        host, port = peer
        self._news.append(News(f"{self.endpoint}: {host}:{port} is left out, {until}: {why}"))

    def poke(self, now_ns: int) -> list[News]:
        self._now_ns = now_ns
        return super().poke(now_ns)

    def _meet(self, peer: _Peer) -> None:
        if self._latest in self._peers:
            self._peers[self._latest] = self._now_ns
        self._latest = peer
        if peer not in self._peers:
            since_ns = self._now_ns - THERE_NS
            others = [each for each, heard_ns in self._peers.items() if heard_ns >= since_ns]
            self._tell_of(peer, others)
            if len(self._peers) == MAX_PEERS:
                del self._peers[next(iter(self._peers))]
        else:
            del self._peers[peer]
        self._peers[peer] = self._now_ns

    def _tell_of(self, peer: _Peer, others: Sequence[_Peer]) -> None:
        """It has come, and is there beside `others`."""
        text = f"{self.endpoint}: {peer[0]}:{peer[1]} sends to us"
        if not others:
            self._news.append(News(text))
        elif peer not in self._warned_of and len(self._warned_of) < MOST_WARNED_OF:
            self._warned_of.add(peer)
            named = ", ".join(f"{host}:{port}" for host, port in others)
            text += f", beside {named}: one of them may play the vehicle to us"
            self._news.append(News(text, trouble=True))

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
