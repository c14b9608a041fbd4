"""Who is connected: one `Channel` for each peer on each link, and what it has said and heard."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, fields
from typing import Final, TypeAlias

from vehicle_sim.services.server import COMPONENT, VehicleServer
from vehicle_sim.simulation.traffic import LinkSpec, Peer
from vehicle_sim.wire.codec import NUMBER1_MAX, SIGNED, Codec, MavlinkFrame
from vehicle_sim.wire.signing import RADIOS, Signing, Verdict
from vehicle_sim.wire.split import Counters

DATAGRAM_BYTES: Final = 1200
PEER_SILENT_NS: Final = 60_000_000_000
PEERS_MAX: Final = 32
"""On one link."""
CLIENTS_MAX: Final = 64
"""Ids in headers that are remembered of one peer; whoever makes them up costs no more memory."""
Packed: TypeAlias = tuple[Codec, bytes]
"""A message, packed once for all who are sent it."""
ALWAYS_2: Final = frozenset({300})
"""PROTOCOL_VERSION is sent as MAVLink 2 to whoever asks ("Version Handshaking")."""
ONLY_1: Final = frozenset({35})
"""RC_CHANNELS_RAW is for peers of MAVLink 1 alone, as ArduPilot sends it."""


@dataclass(frozen=True, slots=True)
class Connection:
    """One peer, for a display."""

    link: int
    vehicle: int | None  # index of the one that it can hear, None = all
    peer: Peer
    clients: tuple[tuple[int, int], ...]  # system and component, in the order of their appearance
    frames_in: int
    frames_out: int
    bad: int
    version: int  # of the MAVLink that it is sent
    heard_ns: int  # wall time of the last frame, of the connection if there was none


@dataclass(slots=True)
class Channel:
    """One peer on one link."""

    number: int
    link: int
    peer: Peer
    lasting: bool
    heard_ns: int
    vehicle: int | None = None  # index of the one on the link, None = all
    version: int = 2
    frames_out: int = 0
    counters: Counters = field(default_factory=Counters)
    clients: dict[tuple[int, int], None] = field(default_factory=dict)
    refused: set[Verdict] = field(default_factory=set)  # what has been said of it
    _heard_2: bool = False
    _sequences: dict[int, int] = field(default_factory=dict)  # by system id

    def hear(self, frame: MavlinkFrame) -> bool:
        """Note who and what speaks here; True = for the first time.

        A peer that has so far spoken MAVLink 1 only is sent MAVLink 1, until it speaks MAVLink 2
        for the first time (PX4's MAV_PROTO_VER 0).  What a radio says of itself says nothing of
        the peer behind it.
        """
        if frame.number not in RADIOS and not self._heard_2:
            self.version = frame.version
            self._heard_2 = frame.version == 2
        client = (frame.system, frame.component)
        if client in self.clients or len(self.clients) >= CLIENTS_MAX:
            return False
        self.clients[client] = None
        return True

    def frames(
        self, messages: Sequence[Packed], system: int, signing: Signing, unix_ns: int
    ) -> list[bytes]:
        """What the peer is sent: fewer where its MAVLink has no room for a message.

        MAVLink 1 knows no signature: under a key everybody is sent MAVLink 2.
        """
        sequence = self._sequences.get(system, 0)
        link_id = self.link & 0xFF
        signed, version = signing.on, self.version
        frames: list[bytes] = []
        for codec, payload in messages:
            if codec.number in ONLY_1 and (signed or version == 2):
                continue
            if signed:
                frame = codec.frame(payload, sequence, system, COMPONENT, SIGNED)
                frames.append(signing.seal(frame, link_id, unix_ns))
            elif version == 2 or codec.number in ALWAYS_2:
                frames.append(codec.frame(payload, sequence, system, COMPONENT))
            elif codec.number <= NUMBER1_MAX:
                frames.append(codec.frame1(payload, sequence, system, COMPONENT))
            else:
                continue
            sequence = (sequence + 1) & 0xFF
        self._sequences[system] = sequence
        self.frames_out += len(frames)
        return frames

    def refuse(self, verdict: Verdict) -> bool:
        """Count a frame that is not to be taken; True = for the first time."""
        match verdict:
            case Verdict.UNSIGNED:
                self.counters.unsigned += 1
            case Verdict.BAD_SIGNATURE:
                self.counters.bad_signature += 1
            case Verdict.REPLAYED:
                self.counters.replayed += 1
            case Verdict.GOOD:
                raise AssertionError("a good frame is not refused")
        first = verdict not in self.refused
        self.refused.add(verdict)
        return first

    def complaint(self) -> str | None:
        """What was wrong with what came in, None if nothing was."""
        if not self.counters.bad:
            return None
        counts = ((each.name, getattr(self.counters, each.name)) for each in fields(Counters))
        listed = ", ".join(f"{name} {count}" for name, count in counts if count)
        return f"{self.counters.bad} bad frames ({listed})"

    @property
    def connection(self) -> Connection:
        return Connection(
            self.link,
            self.vehicle,
            self.peer,
            tuple(self.clients),
            self.counters.frames,
            self.frames_out,
            self.counters.bad,
            self.version,
            self.heard_ns,
        )


class Channels:
    """All of them, by number, by peer and by who of the vehicles speaks on them."""

    def __init__(self, servers: Sequence[VehicleServer], links: Sequence[LinkSpec]) -> None:
        self._servers = tuple(
            tuple(servers) if link.vehicle is None else (servers[link.vehicle],) for link in links
        )
        self._only = tuple(link.vehicle for link in links)
        self._by_number: dict[int, Channel] = {}
        self._by_peer: tuple[dict[Peer, Channel], ...] = tuple({} for _ in links)
        self._audiences: dict[VehicleServer, dict[int, Channel]] = {each: {} for each in servers}
        self._next = 0

    def servers(self, link: int) -> tuple[VehicleServer, ...]:
        """Who is on that link."""
        return self._servers[link]

    def addressed(self, link: int, system: int) -> Sequence[VehicleServer]:
        """Who on that link may be meant by a message for that system id; 0 is for everybody.

        Looked up anew: a vehicle may take another id with a reboot.
        """
        servers = self._servers[link]
        if system == 0 or len(servers) == 1:
            return servers
        return [server for server in servers if server.system == system]

    def audience(self, server: VehicleServer) -> Mapping[int, Channel]:
        """By number, everybody who hears that vehicle."""
        return self._audiences[server]

    def find(self, link: int, peer: Peer) -> Channel | None:
        return self._by_peer[link].get(peer)

    def __iter__(self) -> Iterator[Channel]:
        return iter(self._by_number.values())

    def add(self, link: int, peer: Peer, now_ns: int, lasting: bool) -> Channel:
        """A new one; its number is never used again."""
        channel = Channel(self._next, link, peer, lasting, now_ns, self._only[link])
        self._next += 1
        self._by_number[channel.number] = channel
        self._by_peer[link][peer] = channel
        for server in self._servers[link]:
            self._audiences[server][channel.number] = channel
        return channel

    def remove(self, channel: Channel) -> None:
        del self._by_number[channel.number]
        del self._by_peer[channel.link][channel.peer]
        for server in self._servers[channel.link]:
            del self._audiences[server][channel.number]

    def full(self, link: int) -> bool:
        return len(self._by_peer[link]) >= PEERS_MAX

    def silent(self, link: int, now_ns: int) -> Collection[Channel]:
        """Peers that nobody connected and that have not been heard for long."""
        return [
            channel
            for channel in self._by_peer[link].values()
            if not channel.lasting and now_ns - channel.heard_ns > PEER_SILENT_NS
        ]


def datagrams(frames: Sequence[bytes]) -> list[bytes]:
    """Whole frames, joined up to `DATAGRAM_BYTES`."""
    whole = b"".join(frames)
    if len(whole) <= DATAGRAM_BYTES:
        return [whole]
    joined: list[bytes] = []
    for frame in frames:
        if joined and len(joined[-1]) + len(frame) <= DATAGRAM_BYTES:
            joined[-1] += frame
        else:
            joined.append(frame)
    return joined
