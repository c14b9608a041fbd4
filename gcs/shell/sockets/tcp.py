"""Connections: byte streams that come and go."""

from __future__ import annotations

import errno
import os
import socket

from gcs.shell.endpoints import Endpoint
from gcs.shell.sockets.base import MAX_READ, Link, News, bind, resolve

RECONNECT_NS = 1_000_000_000
CONNECTING_NS = 50_000_000
"""How often to look whether a connection is made: `select` for reading does not tell."""
MAX_CONNECTING_NS = 5_000_000_000
MAX_QUEUED = 65_536
"""Bytes that may wait for a slow peer; what comes on top is dropped, as UDP would."""
_UNDER_WAY = {errno.EINPROGRESS, errno.EWOULDBLOCK, errno.EALREADY}
if os.name == "nt":
    _UNDER_WAY.add(errno.EINVAL)  # what Windows says to a second look at a connection being made


class Stream:
    """One connected socket, with what it could not take yet."""

    def __init__(self, connected: socket.socket) -> None:
        connected.setblocking(False)
        connected.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        self.socket = connected
        self._queued = b""

    def read(self, limit: int, size: int = MAX_READ) -> tuple[list[bytes], bool]:
        """At most `limit` pieces of at most `size` bytes that came, and whether the other side is
        still there."""
        pieces: list[bytes] = []
        for _ in range(limit):
            try:
                piece = self.socket.recv(size)
            except BlockingIOError:
                return pieces, True
            except OSError:
                return pieces, False
            if not piece:
                return pieces, False
            pieces.append(piece)
        return pieces, True

    def write(self, data: bytes) -> bool:
        """Whether it was sent or queued.  Whole frames are dropped, never parts of them."""
        if len(self._queued) + len(data) > MAX_QUEUED:
            self.flush()
            if len(self._queued) + len(data) > MAX_QUEUED:
                return False
        self._queued += data
        self.flush()
        return True

    @property
    def queued(self) -> int:
        return len(self._queued)

    def flush(self) -> None:
        """Send what it takes.  A broken connection is noticed by the next read."""
        try:
            while self._queued:
                self._queued = self._queued[self.socket.send(self._queued) :]
        except OSError:
            return


class _Tcp(Link):
    """What both directions share: a stream that is there or not."""

    stream = True

    def __init__(self, endpoint: Endpoint) -> None:
        super().__init__(endpoint)
        self._stream: Stream | None = None
        self._deadline_ns: int | None = 0

    @property
    def deadline_ns(self) -> int | None:
        return self._deadline_ns

    @property
    def connected(self) -> bool:
        return self._stream is not None

    def send(self, data: bytes) -> None:
        if self._stream is None or not self._stream.write(data):
            self.counters.dropped += 1

    def _read(self, limit: int) -> list[bytes]:
        if self._stream is None:
            return []
        pieces, alive = self._stream.read(limit, self.read_bytes)
        if not alive:
            self._lose()
        return pieces

    def _lose(self) -> None:
        """The other side has gone; `poke` looks for another at once."""
        if self._stream is not None:
            self._stream.socket.close()
            self._stream = None
            self._news.append(News(f"{self.endpoint}: the connection was closed"))
        self._deadline_ns = 0


class TcpOut(_Tcp):
    """Connects, and connects again after a loss, one try a second."""

    def __init__(self, endpoint: Endpoint) -> None:
        """Raises OSError if the host has no address; nobody listening is no error."""
        super().__init__(endpoint)
        self._family, self._address = resolve(endpoint, socket.SOCK_STREAM)
        self._trying: socket.socket | None = None
        self._give_up_ns = 0

    def fileno(self) -> int:
        return self._stream.socket.fileno() if self._stream else -1

    def drain(self, limit: int) -> list[bytes]:
        return self._read(limit)

    def poke(self, now_ns: int) -> list[News]:
        if self._stream is not None:
            self._stream.flush()
            self._deadline_ns = now_ns + CONNECTING_NS if self._stream.queued else None
        elif self._deadline_ns is None or now_ns >= self._deadline_ns:
            self._connect(now_ns)
        return super().poke(now_ns)

    def send(self, data: bytes) -> None:
        super().send(data)
        if self._stream is not None and self._stream.queued:
            self._deadline_ns = 0

    def disconnect(self) -> None:
        """End the connection, if there is one; another is made as after a loss."""
        self._lose()

    def _connect(self, now_ns: int) -> None:
        if self._trying is None:
            self._trying = socket.socket(self._family, socket.SOCK_STREAM)
            self._trying.setblocking(False)
            self._give_up_ns = now_ns + MAX_CONNECTING_NS
        code = self._trying.connect_ex((self._address, self.endpoint.port))
        if code in (0, errno.EISCONN):
            self._stream, self._trying = Stream(self._trying), None
            self._deadline_ns = None
            self._news.append(News(f"{self.endpoint}: connected"))
        elif code in _UNDER_WAY and now_ns < self._give_up_ns:
            self._deadline_ns = now_ns + CONNECTING_NS
        else:
            self._trying.close()
            self._trying = None
            self.counters.refused += 1
            self._deadline_ns = now_ns + RECONNECT_NS

    def close(self) -> None:
        if self._trying is not None:
            self._trying.close()
        if self._stream is not None:
            self._stream.socket.close()
        self._trying = self._stream = None

    def describe(self) -> str:
        state = "connected to" if self.connected else "connecting to"
        return f"{state} tcp {self._address}:{self.endpoint.port}"


class TcpIn(_Tcp):
    """Waits for one to connect.  A newer connection takes the place of the older one."""

    def __init__(self, endpoint: Endpoint) -> None:
        """Raises AddressInUse, or OSError."""
        super().__init__(endpoint)
        family, address = resolve(endpoint, socket.SOCK_STREAM)
        self._listener = socket.socket(family, socket.SOCK_STREAM)
        self._listener.setblocking(False)
        if os.name == "posix":
            # Elsewhere this option would let two programs share the port.
            self._listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        self._port = bind(self._listener, address, endpoint)
        self._listener.listen(1)

    @property
    def port(self) -> int:
        return self._port

    def fileno(self) -> int:
        return (self._stream.socket if self._stream else self._listener).fileno()

    def drain(self, limit: int) -> list[bytes]:
        if self._stream is None:
            self._accept()
        return self._read(limit)

    def poke(self, now_ns: int) -> list[News]:
        self._accept()
        if self._stream is not None:
            self._stream.flush()
        self._deadline_ns = now_ns + RECONNECT_NS
        return super().poke(now_ns)

    def _accept(self) -> None:
        try:
            newer, peer = self._listener.accept()
        except OSError:
            return
        if self._stream is not None:
            self._stream.socket.close()
        self._stream = Stream(newer)
        self._news.append(News(f"{self.endpoint}: {peer[0]}:{peer[1]} connected"))

    def close(self) -> None:
        self._listener.close()
        if self._stream is not None:
            self._stream.socket.close()
            self._stream = None

    def describe(self) -> str:
        state = "connected on" if self.connected else "waiting for a connection on"
        return f"{state} tcp {self.endpoint.host}:{self._port}"
