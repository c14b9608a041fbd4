"""Vehicles, links and time: the whole simulation as one pure machine.

`handle(input, now_ns)` takes the wall time of the pacer; simulated time is
(now - start) * speedup, exactly in integers, lived in whole steps.  What is sent depends on the
inputs and their times alone, never on how many steps one call happened to cover.
"""

from __future__ import annotations

from collections.abc import Hashable, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from typing import Final, TypeAlias, assert_never

from vehicle_sim.services.effects import Client, Effect, Note, Send
from vehicle_sim.services.server import COMPONENT, VehicleServer
from vehicle_sim.wire.codec import encode
from vehicle_sim.wire.split import Counters, split

Peer: TypeAlias = Hashable
"""Who is at the other end of a link: an address, as the shell knows it."""

DATAGRAM_BYTES: Final = 1200
STEPS_AHEAD_NS: Final = 20_000_000
"""The longest sleep: what the vehicle says unasked is at most this late, in wall time."""
PEER_SILENT_NS: Final = 60_000_000_000
PEERS_MAX: Final = 32


@dataclass(frozen=True, slots=True)
class LinkSpec:
    """One endpoint.  `peers` are there from the start (a client's server); others are learnt."""

    peers: tuple[Peer, ...] = ()
    vehicle: int | None = None  # index of the one vehicle on it, None = all


@dataclass(frozen=True, slots=True)
class Datagram:
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


@dataclass(frozen=True, slots=True)
class Transmit:
    link: int
    peer: Peer
    data: bytes


@dataclass(frozen=True, slots=True)
class Log:
    level: str  # debug, info, warning, error, fatal
    node: str
    text: str


Output: TypeAlias = Transmit | Log


@dataclass(slots=True)
class _Channel:
    """One peer on one link."""

    number: int
    link: int
    peer: Peer
    lasting: bool
    heard_ns: int
    counters: Counters = field(default_factory=Counters)
    sequences: dict[int, int] = field(default_factory=dict)  # by system id
    clients: set[tuple[int, int]] = field(default_factory=set)


class World:
    """See the module.  `start_ns` is the wall time at which simulated time is 0."""

    def __init__(
        self,
        vehicles: Sequence[VehicleServer],
        links: Sequence[LinkSpec],
        speedup: Fraction = Fraction(1),
        start_ns: int = 0,
    ) -> None:
        if len({server.vehicle.dt_ns for server in vehicles}) != 1:
            raise ValueError("all vehicles of a world take steps of the same length")
        self._servers = tuple(vehicles)
        self._links = tuple(links)
        # Fractions are exact and slow: the two integers are as exact.
        self._numerator, self._denominator = speedup.numerator, speedup.denominator
        self._start_ns = start_ns
        self._dt_ns = self._servers[0].vehicle.dt_ns
        self._steps_ahead = max(1, int(STEPS_AHEAD_NS * speedup) // self._dt_ns)
        self._steps = 0
        self._channels: dict[int, _Channel] = {}
        self._by_peer: dict[tuple[int, Peer], _Channel] = {}
        self._next_channel = 0
        self._greeted = False

    @property
    def time_ns(self) -> int:
        """Simulated time."""
        return self._steps * self._dt_ns

    def counters(self, link: int, peer: Peer) -> Counters | None:
        """What was heard from a peer, good and bad."""
        channel = self._by_peer.get((link, peer))
        return channel.counters if channel is not None else None

    @property
    def deadline_ns(self) -> int:
        """Wall time at which the next `Wake` is wanted at the latest: always that of a step."""
        steps = min(
            self._steps + self._steps_ahead,
            *(-(-server.stream_due_ns // self._dt_ns) for server in self._servers),
            *(self._steps_until(server.deadline_ns) for server in self._servers),
        )
        return self._wall_ns(max(steps, self._steps + 1))

    def handle(self, given: Input, now_ns: int) -> list[Output]:
        """Live up to `now_ns`, then take the input."""
        out: list[Output] = []
        if not self._greeted:
            self._greeted = True
            for number, link in enumerate(self._links):
                for peer in link.peers:
                    out += self._open(number, peer, now_ns, lasting=True)
        steps = (now_ns - self._start_ns) * self._numerator // (self._denominator * self._dt_ns)
        while self._steps < steps:
            self._steps += 1
            wall_ns = self._wall_ns(self._steps)
            for server in self._servers:
                self._emit(server, server.step(wall_ns), out)
        match given:
            case Datagram():
                self._receive(given, now_ns, out)
            case Joined():
                out += self._open(given.link, given.peer, now_ns, lasting=True)
            case Left():
                channel = self._by_peer.get((given.link, given.peer))
                if channel is not None:
                    self._close(channel, out)
            case Wake():
                pass
            case _:
                assert_never(given)
        return out

    def _wall_ns(self, steps: int) -> int:
        """When that step is over: the first nanosecond that reaches it."""
        return self._start_ns - (-steps * self._dt_ns * self._denominator // self._numerator)

    def _steps_until(self, wall_ns: int) -> int:
        """Number of the first step that is over at that time or later."""
        steps_ns = (wall_ns - self._start_ns) * self._numerator
        return -(-steps_ns // (self._denominator * self._dt_ns))

    def _servers_on(self, link: int) -> tuple[VehicleServer, ...]:
        only = self._links[link].vehicle
        return self._servers if only is None else (self._servers[only],)

    # ------------------------------------------------------------------------------ peers

    def _open(self, link: int, peer: Peer, now_ns: int, lasting: bool) -> list[Output]:
        if (link, peer) in self._by_peer:
            return []
        channel = _Channel(self._next_channel, link, peer, lasting, now_ns)
        self._next_channel += 1
        self._channels[channel.number] = channel
        self._by_peer[link, peer] = channel
        out: list[Output] = []
        for server in self._servers_on(link):
            self._emit(server, server.open(channel.number), out)
        return out

    def _close(self, channel: _Channel, out: list[Output]) -> None:
        del self._channels[channel.number]
        del self._by_peer[channel.link, channel.peer]
        for server in self._servers_on(channel.link):
            server.close(channel.number)
        out.extend(
            Log("info", "link", f"client {system}/{component} gone")
            for system, component in sorted(channel.clients)
        )

    def _make_room(self, now_ns: int, out: list[Output]) -> bool:
        """Forget peers that have long been silent; False = too many are not."""
        learnt = [channel for channel in self._channels.values() if not channel.lasting]
        for channel in learnt:
            if now_ns - channel.heard_ns > PEER_SILENT_NS:
                self._close(channel, out)
        return len(self._channels) < PEERS_MAX

    # --------------------------------------------------------------------------- messages

    def _receive(self, given: Datagram, now_ns: int, out: list[Output]) -> None:
        counters = Counters()
        frames = split(given.data, counters)
        channel = self._by_peer.get((given.link, given.peer))
        if channel is None:
            # Noise makes no peer: only who speaks MAVLink is spoken to.
            if not frames or not self._make_room(now_ns, out):
                return
            out += self._open(given.link, given.peer, now_ns, lasting=False)
            channel = self._by_peer[given.link, given.peer]
        channel.heard_ns = now_ns
        channel.counters.add(counters)
        for frame in frames:
            client = Client(channel.number, frame.system, frame.component)
            if (frame.system, frame.component) not in channel.clients:
                channel.clients.add((frame.system, frame.component))
                out.append(Log("info", "link", f"client {frame.system}/{frame.component} seen"))
            message = frame.message()
            if message is None:
                continue
            for server in self._servers_on(given.link):
                effects = server.handle(client, frame.sequence, message, now_ns)
                self._emit(server, effects, out)

    def _emit(self, server: VehicleServer, effects: list[Effect], out: list[Output]) -> None:
        """Messages of one vehicle and one moment share a datagram, channel by channel."""
        if not effects:
            return
        packed: dict[int, list[bytes]] = {}
        for effect in effects:
            match effect:
                case Note():
                    out.append(Log(effect.level, f"vehicle{server.system}", effect.text))
                case Send(channel=None):
                    for number, channel in self._channels.items():
                        if server in self._servers_on(channel.link):
                            self._pack(packed, number, server, effect)
                case Send(channel=number) if number in self._channels:
                    self._pack(packed, number, server, effect)
                case Send():
                    # The channel closed between the request and its answer.
                    continue
        for number, frames in packed.items():
            channel = self._channels[number]
            out.extend(Transmit(channel.link, channel.peer, data) for data in _datagrams(frames))

    def _pack(
        self, packed: dict[int, list[bytes]], number: int, server: VehicleServer, effect: Send
    ) -> None:
        sequences = self._channels[number].sequences
        sequence = sequences.get(server.system, 0)
        sequences[server.system] = (sequence + 1) & 0xFF
        frame = encode(effect.message, sequence, server.system, COMPONENT)
        packed.setdefault(number, []).append(frame)


def _datagrams(frames: list[bytes]) -> list[bytes]:
    """Whole frames, joined up to `DATAGRAM_BYTES`."""
    datagrams = [frames[0]]
    for frame in frames[1:]:
        if len(datagrams[-1]) + len(frame) <= DATAGRAM_BYTES:
            datagrams[-1] += frame
        else:
            datagrams.append(frame)
    return datagrams
