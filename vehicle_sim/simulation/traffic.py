"""What goes into a world and what comes out of it."""

from __future__ import annotations

from collections.abc import Hashable
from dataclasses import dataclass
from typing import NamedTuple, TypeAlias

from vehicle_sim.services.stream_sets import LinkMode

Peer: TypeAlias = Hashable
"""Who is at the other end of a link: an address, as the shell knows it."""


@dataclass(frozen=True, slots=True)
class LinkSpec:
    """One endpoint.  `peers` are there from the start (a client's server); others are learnt."""

    peers: tuple[Peer, ...] = ()
    vehicle: int | None = None  # index of the one vehicle on it, None = all
    stream: bool = False  # TCP: nothing is lost or overtaken on it
    mode: LinkMode = LinkMode.NORMAL  # which of the vehicles' stream sets is sent on it


class Datagram(NamedTuple):
    link: int
    peer: Peer
    data: bytes


@dataclass(frozen=True, slots=True)
class Joined:
    """A connection was made; datagram links need no such thing."""

    link: int
    peer: Peer


@dataclass(frozen=True, slots=True)
class Left:
    link: int
    peer: Peer


@dataclass(frozen=True, slots=True)
class Wake:
    """Nothing but that time has passed."""


Input: TypeAlias = Datagram | Joined | Left | Wake


class Transmit(NamedTuple):
    link: int
    peer: Peer
    data: bytes


@dataclass(frozen=True, slots=True)
class Log:
    level: str  # debug, info, warning, error, fatal
    node: str
    text: str


Output: TypeAlias = Transmit | Log
