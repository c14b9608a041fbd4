"""Between the wire and the vehicles: bytes in become calls, effects become bytes out.

Here are the channels, the signatures and what the links lose and delay.  Time is wall time.
"""

from __future__ import annotations

import struct
from collections.abc import Collection, Iterable, Sequence
from typing import Final

from vehicle_sim.effects import Client, Effect, Note, Report, Send
from vehicle_sim.services.server import COMPONENT, VehicleServer
from vehicle_sim.simulation.channels import Channel, Channels, Connection, Packed, datagrams
from vehicle_sim.simulation.impairment import NEVER_NS, Air, Direction, Impairment
from vehicle_sim.simulation.traffic import Datagram, LinkSpec, Log, Output, Peer, Transmit
from vehicle_sim.wire import messages as m
from vehicle_sim.wire.codec import BY_TYPE, MavlinkFrame
from vehicle_sim.wire.signing import Signing, SigningKey, Verdict
from vehicle_sim.wire.split import Counters, split

SEVERITY_WARNING: Final = 4


class Switchboard:
    """All traffic of a world.  What is to be said outside is appended to `out`, in order."""

    def __init__(
        self,
        servers: Sequence[VehicleServer],
        links: Sequence[LinkSpec],
        signing: SigningKey | None,
        unix_offset_ns: int,
        seed: int,
    ) -> None:
        """`unix_offset_ns` is what wall time lacks to the time since 1970."""
        self._servers = tuple(servers)
        self._active: dict[VehicleServer, None] = {}
        self._channels = Channels(servers, links)
        self._modes = tuple(link.mode for link in links)
        self._signing = Signing(signing, servers[0].unsigned_allowed)
        self._unix_offset_ns = unix_offset_ns
        self._unsendable: set[type[m.Message]] = set()  # what has been said of it
        streams = tuple(link.stream for link in links)
        self._inbound = Air[Datagram](seed, Direction.TO_VEHICLE, streams)
        self._outbound = Air[Transmit](seed, Direction.FROM_VEHICLE, streams)

    def counters(self, link: int, peer: Peer) -> Counters | None:
        """What was heard from a peer, good and bad."""
        channel = self._channels.find(link, peer)
        return channel.counters if channel is not None else None

    @property
    def connections(self) -> tuple[Connection, ...]:
        """Who is connected, in the order of their coming."""
        return tuple(channel.connection for channel in self._channels)

    def active(self) -> Collection[VehicleServer]:
        """Who was given something to do since this was asked last."""
        active, self._active = self._active, {}
        return active

    # -------------------------------------------------------------------------- bad links

    def impair(self, link: int | None, direction: Direction | None, impairment: Impairment) -> None:
        """From now on, on one link or all, in one direction or both; what is under way stays so."""
        if direction is not Direction.FROM_VEHICLE:
            self._inbound.impair(link, impairment)
        if direction is not Direction.TO_VEHICLE:
            self._outbound.impair(link, impairment)

    @property
    def arriving(self) -> bool:
        """Whether a datagram that was delayed is on its way to the vehicles."""
        return bool(self._inbound.flying)

    @property
    def departing(self) -> bool:
        """Whether a datagram that was delayed is on its way to the clients."""
        return bool(self._outbound.flying)

    @property
    def arrival_ns(self) -> int:
        """When the next datagram that was delayed arrives at the vehicles."""
        return self._inbound.deadline_ns

    @property
    def deadline_ns(self) -> int:
        """When the next datagram that was delayed arrives on either side."""
        if not self._inbound.flying and not self._outbound.flying:
            return NEVER_NS
        return min(self._inbound.deadline_ns, self._outbound.deadline_ns)

    def arrive(self, now_ns: int, out: list[Output]) -> None:
        """What was delayed and arrives at the vehicles by now."""
        for late in self._inbound.arrived(now_ns):
            self._take(late, now_ns, out)

    def depart(self, now_ns: int, out: list[Output]) -> None:
        """What was delayed and reaches the clients by now."""
        out += self._outbound.arrived(now_ns)

    # ------------------------------------------------------------------------------ peers

    def join(self, link: int, peer: Peer, now_ns: int, out: list[Output]) -> None:
        """A peer is there without having been heard."""
        if self._channels.find(link, peer) is None:
            self._greet(self._channels.add(link, peer, now_ns, lasting=True), now_ns, out)

    def _greet(self, channel: Channel, now_ns: int, out: list[Output]) -> None:
        mode = self._modes[channel.link]
        for server in self._channels.servers(channel.link):
            self._active[server] = None
            self.emit(server, server.open(channel.number, mode), now_ns, out)

    def leave(self, link: int, peer: Peer, out: list[Output]) -> None:
        """A connection has ended."""
        self._inbound.forget(link, peer)
        self._outbound.forget(link, peer)
        channel = self._channels.find(link, peer)
        if channel is not None:
            self._close(channel, out)

    def _close(self, channel: Channel, out: list[Output]) -> None:
        self._channels.remove(channel)
        for server in self._channels.servers(channel.link):
            self._active[server] = None
            server.close(channel.number)
        for system, component in sorted(channel.clients):
            out.append(Log("info", "link", f"client {system}/{component} gone"))
        complaint = channel.complaint()
        if complaint is not None:
            out.append(Log("warning", "link", f"link {channel.link}: {complaint}"))

    # -------------------------------------------------------------------------- receiving

    def receive(self, given: Datagram, now_ns: int, out: list[Output]) -> None:
        """A datagram was sent to the vehicles, and arrives if its link is good."""
        if not self._inbound.impaired(given.link):
            self._take(given, now_ns, out)
            return
        for arrived in self._inbound.handle(given.link, given.peer, given, now_ns):
            self._take(arrived, now_ns, out)

    def _take(self, given: Datagram, now_ns: int, out: list[Output]) -> None:
        channel = self._channels.find(given.link, given.peer)
        counters = channel.counters if channel is not None else Counters()
        frames = split(given.data, counters)
        if not frames and channel is None:
            # Noise makes no peer: only who speaks MAVLink is spoken to.
            return
        if channel is None:
            for silent in self._channels.silent(given.link, now_ns):
                self._close(silent, out)
            if self._channels.full(given.link):
                return
            channel = self._channels.add(given.link, given.peer, now_ns, lasting=False)
            channel.counters = counters
            # What it speaks decides what it is greeted in.
            self._hear(channel, frames, now_ns, out)
            self._greet(channel, now_ns, out)
        else:
            self._hear(channel, frames, now_ns, out)
        for frame in frames:
            client = Client(channel.number, frame.system, frame.component)
            verdict = self._signing.judge(frame, now_ns + self._unix_offset_ns)
            if verdict is not Verdict.GOOD:
                if channel.refuse(verdict):
                    who = f"{frame.system}/{frame.component}"
                    text = f"client {who}: a frame is ignored ({verdict.value}), as all such are"
                    out.append(Log("warning", "link", text))
                continue
            message = frame.message()
            if isinstance(message, m.SetupSigning):
                self._set_up_signing(client, message, given.link, now_ns, out)
            elif message is not None:
                system = getattr(message, "target_system", 0)
                for server in self._channels.addressed(given.link, system):
                    self._active[server] = None
                    effects = server.handle(client, frame.sequence, message, now_ns)
                    self.emit(server, effects, now_ns, out)

    def _hear(
        self, channel: Channel, frames: Sequence[MavlinkFrame], now_ns: int, out: list[Output]
    ) -> None:
        channel.heard_ns = now_ns
        for frame in frames:
            if channel.hear(frame):
                text = f"client {frame.system}/{frame.component} seen"
                out.append(Log("info", "link", text))

    def _set_up_signing(
        self, client: Client, asked: m.SetupSigning, link: int, now_ns: int, out: list[Output]
    ) -> None:
        """One key for all vehicles, whichever of them is told; kept in memory only.

        There is no answer in the protocol.  Under a key only a rightly signed frame gets here.
        As ArduPilot has it, not while armed: the other clients would lose a flying vehicle.
        """
        addressed = [
            server
            for server in self._channels.servers(link)
            if asked.target_system in (0, server.system)
        ]
        if not addressed or asked.target_component not in (0, COMPONENT):
            return
        if any(server.vehicle.armed for server in self._servers):
            text = m.Statustext(SEVERITY_WARNING, b"ERROR: Won't setup signing when armed")
            for server in addressed:
                self.emit(server, [Send(client.channel, text)], now_ns, out)
            return
        self._signing.follow(asked)
        what = "on" if self._signing.on else "off"
        by = f"client {client.system}/{client.component}"
        out.append(Log("info", "link", f"signing is {what}, set up by {by}"))

    # ---------------------------------------------------------------------------- sending

    def emit(
        self, server: VehicleServer, effects: list[Effect], at_ns: int, out: list[Output]
    ) -> None:
        """Messages of one vehicle and one moment share a datagram, channel by channel."""
        if not effects:
            return
        audience = self._channels.audience(server)
        packed: dict[int, Packed | None] = {}  # by the identity of the message
        waiting: dict[int, list[Packed]] = {}  # by channel
        numbers: Iterable[int]
        messages: Sequence[m.Message]
        for effect in effects:
            match effect:
                case Note():
                    out.append(Log(effect.level, f"vehicle{server.system}", effect.text))
                    continue
                case Send(number, message):
                    numbers = audience if number is None else (number,)
                    messages = [message]
                case Report(number, messages):
                    numbers = (number,)
            ready = self._pack(server, messages, packed, out)
            for each in numbers:
                # Else the channel closed between the request and its answer.
                if each in audience:
                    waiting.setdefault(each, []).extend(ready)
        unix_ns = at_ns + self._unix_offset_ns
        for number, row in waiting.items():
            channel = audience[number]
            frames = channel.frames(row, server.system, self._signing, unix_ns)
            if frames:
                self._send(channel, frames, at_ns, out)

    def _pack(
        self,
        server: VehicleServer,
        messages: Sequence[m.Message],
        packed: dict[int, Packed | None],
        out: list[Output],
    ) -> list[Packed]:
        """Each message once, for all who are sent it."""
        ready: list[Packed] = []
        for message in messages:
            key = id(message)
            if key not in packed:
                codec = BY_TYPE[type(message)]
                try:
                    packed[key] = (codec, codec.payload(message))
                except (struct.error, OverflowError) as wrong:
                    packed[key] = None
                    self._tell_unsendable(server, message, wrong, out)
            done = packed[key]
            if done is not None:
                ready.append(done)
        return ready

    def _tell_unsendable(
        self, server: VehicleServer, message: m.Message, wrong: Exception, out: list[Output]
    ) -> None:
        """A value that its field cannot hold is a bug of ours, and must not cost a vehicle."""
        kind = type(message)
        if kind not in self._unsendable:
            self._unsendable.add(kind)
            text = f"{kind.__name__} cannot be sent: {wrong}"
            out.append(Log("error", f"vehicle{server.system}", text))

    def _send(
        self, channel: Channel, frames: Sequence[bytes], at_ns: int, out: list[Output]
    ) -> None:
        for data in datagrams(frames):
            transmit = Transmit(channel.link, channel.peer, data)
            if self._outbound.impaired(channel.link):
                out += self._outbound.handle(channel.link, channel.peer, transmit, at_ns)
            else:
                out.append(transmit)
