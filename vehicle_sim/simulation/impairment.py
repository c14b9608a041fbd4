"""Bad links: loss, delay, duplicates, reordering and outages, seeded and on wall time.

Each direction of each link is a `Path` with a number for every datagram.  What happens to a
datagram depends on (seed, link, direction, number) alone, never on when somebody looked.

A stream (TCP) loses, repeats and reorders nothing: what is lost on its way is sent again below.
There only delay and outage apply, and what an outage holds up arrives at its end.
"""

from __future__ import annotations

import heapq
from dataclasses import dataclass
from enum import Enum
from typing import Final, Generic, TypeVar

from vehicle_sim.numerics.noise import key_of, mix64
from vehicle_sim.simulation.traffic import Peer

NEVER_NS: Final = 1 << 62
REORDER_HOLD_NS: Final = 50_000_000
"""How much longer a reordered datagram takes: what is sent within this time overtakes it."""

_MASK: Final = 0xFFFFFFFFFFFFFFFF
_SOURCE: Final = 0x6C696E6B
"""Keeps the noise of links apart from that of sensors."""
_DRAWS: Final = 8
_LOSS, _DUPLICATE, _REORDER, _JITTER, _COPY_JITTER = range(5)


class Direction(Enum):
    TO_VEHICLE = 0
    FROM_VEHICLE = 1


@dataclass(frozen=True, slots=True)
class Impairment:
    """Rates are probabilities for each datagram; a delay lies in [delay, delay + jitter).

    A spread of delays reorders by itself.  `outage_until_ns` is wall time.  Raises ValueError.
    """

    loss: float = 0.0
    duplicate: float = 0.0
    reorder: float = 0.0
    delay_ns: int = 0
    jitter_ns: int = 0
    outage_until_ns: int = 0

    def __post_init__(self) -> None:
        for name in ("loss", "duplicate", "reorder"):
            rate: float = getattr(self, name)
            if not 0.0 <= rate <= 1.0:
                raise ValueError(f"{name} is a probability, from 0 to 1, not {rate:g}")
        if self.delay_ns < 0 or self.jitter_ns < 0:
            raise ValueError("a delay cannot be negative")


CLEAR: Final = Impairment()


class Path:
    """One direction of one link."""

    def __init__(self, seed: int, link: int, direction: Direction, stream: bool) -> None:
        self.impairment = CLEAR
        self._key = key_of(seed, link, _SOURCE + direction.value)
        self._stream = stream
        self._number = 0
        self._last_ns: dict[Peer, int] = {}  # arrival of the last piece of each stream

    def handle(self, peer: Peer, now_ns: int) -> tuple[int, ...]:
        """When a datagram that is sent now arrives: once, twice or never."""
        self._number += 1
        given = self.impairment
        if self._stream:
            sent_ns = max(now_ns, given.outage_until_ns)
            arrives_ns = max(sent_ns + self._delay_ns(_JITTER), self._last_ns.get(peer, 0))
            self._last_ns[peer] = arrives_ns
            return (arrives_ns,)
        if now_ns < given.outage_until_ns or self._draw(_LOSS) < given.loss:
            return ()
        arrives_ns = now_ns + self._delay_ns(_JITTER)
        if self._draw(_REORDER) < given.reorder:
            arrives_ns += REORDER_HOLD_NS
        if self._draw(_DUPLICATE) < given.duplicate:
            return (arrives_ns, now_ns + self._delay_ns(_COPY_JITTER))
        return (arrives_ns,)

    def forget(self, peer: Peer) -> None:
        self._last_ns.pop(peer, None)

    def _delay_ns(self, draw: int) -> int:
        given = self.impairment
        return given.delay_ns + int(given.jitter_ns * self._draw(draw))

    def _draw(self, draw: int) -> float:
        """Uniform in [0, 1)."""
        bits = mix64(self._key + mix64(self._number * _DRAWS + draw) & _MASK)
        return (bits >> 11) * 2.0**-53


T = TypeVar("T")


class Air(Generic[T]):
    """One direction of all links, and what is under way on it."""

    def __init__(self, seed: int, direction: Direction, streams: tuple[bool, ...]) -> None:
        """`streams` says of each link whether it is one."""
        self._seed = seed
        self._direction = direction
        self._streams = streams
        self._paths: dict[int, Path] = {}
        self.flying: list[tuple[int, int, int, Peer, T]] = []  # arrival, order, link
        self._count = 0

    def impair(self, link: int | None, impairment: Impairment) -> None:
        """From now on; what is under way stays so.  None = every link.  Raises ValueError."""
        if link is not None and not 0 <= link < len(self._streams):
            raise ValueError(f"there is no link {link}, only {len(self._streams)} from 0 on")
        for number in range(len(self._streams)) if link is None else (link,):
            path = self._paths.get(number)
            if path is None:
                path = Path(self._seed, number, self._direction, self._streams[number])
                self._paths[number] = path
            path.impairment = impairment

    def impaired(self, link: int) -> bool:
        """Whether the link's datagrams must come this way."""
        return link in self._paths

    def handle(self, link: int, peer: Peer, datagram: T, now_ns: int) -> list[T]:
        """One is sent; what has arrived by now."""
        for at_ns in self._paths[link].handle(peer, now_ns):
            self._count += 1
            heapq.heappush(self.flying, (at_ns, self._count, link, peer, datagram))
        return self.arrived(now_ns)

    def arrived(self, now_ns: int) -> list[T]:
        """In order of arrival."""
        arrived = []
        while self.flying and self.flying[0][0] <= now_ns:
            arrived.append(heapq.heappop(self.flying)[4])
        return arrived

    def forget(self, link: int, peer: Peer) -> None:
        """The peer has left; a stream's last bytes end with it."""
        if link in self._paths:
            self._paths[link].forget(peer)
        if self._streams[link]:
            self.flying = [each for each in self.flying if each[2:4] != (link, peer)]
            heapq.heapify(self.flying)

    @property
    def deadline_ns(self) -> int:
        """Wall time of the next arrival."""
        return self.flying[0][0] if self.flying else NEVER_NS
