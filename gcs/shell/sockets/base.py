"""What every link can do, whatever carries it; made for one `select` loop without threads."""

from __future__ import annotations

import errno
import socket
from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import NamedTuple

from gcs.shell.endpoints import Endpoint

WANTED_RCVBUF = 4 << 20
"""Bytes of receive buffer to ask for: 0.1 s of garbage collection must not lose a burst."""
LEAST_RCVBUF = 64 << 10
MAX_READ = 65_536


class AddressInUse(OSError):  # noqa: N818 - it names the condition, as FileExistsError would
    """Somebody else has the port."""

    def __init__(self, endpoint: Endpoint) -> None:
        super().__init__(errno.EADDRINUSE, f"{endpoint} is in use by another program")
        self.endpoint = endpoint

    def __str__(self) -> str:
        return str(self.strerror)


@dataclass(slots=True)
class Counters:
    """What went wrong without being an error."""

    refused: int = 0
    """Datagrams that nobody listened for."""
    dropped: int = 0
    """Sends that found no peer, no room or no route."""


class News(NamedTuple):
    """What happened to a link, as a line."""

    text: str
    trouble: bool = False
    """Somebody should look at it."""


class Link(ABC):
    """One open link.

    `fileno()` is what `select` should watch for reading, -1 while there is nothing to watch.
    `poke(now_ns)` is wanted at `deadline_ns` at the latest (None: never): there a link connects,
    reconnects or takes a new peer.  Nothing here ever waits, and only opening raises.
    """

    stream = False
    """Whether what `drain` gives are pieces of one byte stream, not whole datagrams."""
    read_bytes = MAX_READ
    """The most that one of these pieces has."""

    def __init__(self, endpoint: Endpoint) -> None:
        self.endpoint = endpoint
        self.counters = Counters()
        self._news: list[News] = []

    @abstractmethod
    def fileno(self) -> int: ...

    @abstractmethod
    def drain(self, limit: int) -> list[bytes]:
        """What is waiting, at most `limit` datagrams or reads."""

    @abstractmethod
    def send(self, data: bytes) -> None:
        """Off at once, or counted as dropped."""

    def leave_out(self, data: bytes, silent_ns: int) -> None:  # noqa: B027 - most have one peer
        """Where several peers share this link: neither hear nor answer the one that has just sent
        `data` any more, until it was silent for `silent_ns`.  Not where no other one is there."""

    @abstractmethod
    def describe(self) -> str:
        """One line for a person."""

    @abstractmethod
    def close(self) -> None: ...

    @property
    def port(self) -> int:
        """The port that it is bound to or sends to; 0 for a serial line."""
        return self.endpoint.port

    @property
    def deadline_ns(self) -> int | None:
        return None

    def poke(self, now_ns: int) -> list[News]:
        """Do what is due; what happened to the link since the last call (a peer came, a
        connection was lost), a line each.
        """
        news, self._news = self._news, []
        return news


def resolve(endpoint: Endpoint, type_: socket.SocketKind) -> tuple[socket.AddressFamily, str]:
    """Family and numeric address of the host.  Raises OSError if it has none."""
    flags = socket.AI_PASSIVE if endpoint.listens else 0
    found = socket.getaddrinfo(endpoint.host, endpoint.port, type=type_, flags=flags)
    family, _, _, _, address = found[0]
    return family, str(address[0])


def bind(sock: socket.socket, address: str, endpoint: Endpoint) -> int:
    """Take the port and return it.  Raises AddressInUse, or OSError."""
    try:
        sock.bind((address, endpoint.port))
    except OSError as error:
        sock.close()
        if error.errno == errno.EADDRINUSE:
            raise AddressInUse(endpoint) from error
        raise
    return int(sock.getsockname()[1])


def grow_buffer(sock: socket.socket) -> int:
    """Ask for `WANTED_RCVBUF`; the bytes that the kernel granted.

    Linux grants what it can.  macOS and the BSDs refuse what is over their limit
    (kern.ipc.maxsockbuf), so there half as much is asked for, and again.
    """
    wanted = WANTED_RCVBUF
    while wanted >= LEAST_RCVBUF:
        try:
            sock.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, wanted)
        except OSError:
            wanted //= 2
        else:
            break
    return sock.getsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF)
