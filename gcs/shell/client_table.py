"""Which MAVLink clients are there, on which link number, and how much of each is handed on.

No sockets: `client_ports.py` has those.  A client is one peer on one client port.  It has a link
number of its own, the lowest that is free; the number is given again after it has gone.

What one client may cost the others is bounded here: at most `max_clients` are there, each may send
`rate_hz` messages a second with a second's worth at once, and a few commands beside that, and a
turn hands on `MAX_A_TURN` inputs.

On ports with a key, a peer that came by itself is not verified before the session says so
(`verify`).  Until then it takes none of those places: there are `UNVERIFIED_PLACES` beside them.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Protocol, TypeAlias

import msgspec

from gcs.session.inputs import ClientCame, ClientFlooded, ClientGone, Datagram, LinkEvent
from gcs.wire.frame import (
    MAGIC_V1,
    MAGIC_V2,
    Frame,
    Garbage,
    Item,
    StreamSplitter,
    plain_frames,
    split,
)
from gcs.wire.ids import MsgId

LAST_LINK = 254
MAX_A_TURN = 256
"""Inputs that one turn of the loop hands on; the rest waits in the sockets."""
MAX_CLIENT_DATAGRAM = 4096
"""Bytes; a longer one is dropped.  Clients send a frame a datagram, routers a few."""
NOISE_BYTES_A_MESSAGE = 64
"""Bytes that are no frame count as a message more for each piece of this size: to look for frames
in them costs more than frames do."""
READS_A_MESSAGE = 8
"""Of a stream: a frame may come in so many pieces and count as one message; each piece costs a turn
of the loop."""
EVICTABLE_NS = 3_000_000_000
"""A client that was heard within this time does not have to make room for another: whoever makes
up senders by the thousand must not drive out those who fly."""
UNVERIFIED_PLACES = 16
"""For peers that may have the key.  Whoever comes takes the place of the one that came first, so
that nobody can keep them all; so many that one who waits for a heartbeat before it signs anything
hears it before a handful of others, who come again and again, have driven it out."""
UNVERIFIED_HZ = 200.0
"""So many of them come in a second: each is recorded as it comes and goes."""
FLOOD_TOLD_NS = 1_000_000_000
COMMAND_HZ = 20.0
"""So many commands and modes a second are handed on of a sender whose messages are dropped: among
them is a stop, which is never to be lost for what the same client streams."""
COMMANDS = frozenset({MsgId.SET_MODE, MsgId.COMMAND_INT, MsgId.COMMAND_LONG})

MAGICS = (MAGIC_V2, MAGIC_V1)

Arrival: TypeAlias = ClientCame | Datagram | ClientGone | ClientFlooded | LinkEvent


@dataclass(frozen=True, slots=True)
class ClientLimits:
    """How many clients, how fast, and how long a silent one is kept."""

    max_clients: int = 32
    rate_hz: float = 500.0
    """Messages a second of one client: frames, however many of them come in one datagram."""
    silent_s: float = 15.0
    """A peer of a UDP port that has sent nothing for so long has gone: it cannot say so itself."""
    verifies: bool = False
    """The ports have a key, and nothing is taken without it."""


class Peer(Protocol):
    """The way out to one client."""

    name: str
    stream: bool
    expires: bool
    """Whether silence means that it has gone."""
    stays: bool
    """It was named by the user: it makes no room for another, and is verified as it comes."""

    def send(self, data: bytes) -> str:
        """Off at once, queued or dropped.  Not empty: why the client has gone."""
        ...

    def forget(self) -> None:
        """It has gone."""
        ...


@dataclass(slots=True)
class _Client:
    peer: Peer
    heard_ns: int
    tokens: float
    tokens_ns: int
    splitter: StreamSplitter | None
    """Of a stream: to count its frames, which the session splits once more."""
    verified: bool
    unfinished: float = 0.0
    """What the pieces of a frame that has not ended have been counted as."""
    dropped: int = 0
    told_ns: int = 0
    commands: float = COMMAND_HZ
    """How many commands may be handed on though it sends too much; as it was at `commands_ns`."""
    commands_ns: int = 0


class ClientTable:
    """The clients that are there; `take` gives what the session is to be told of them."""

    def __init__(self, first_link: int, limits: ClientLimits) -> None:
        self._first = first_link
        self._limits = limits
        beside = 2 * UNVERIFIED_PLACES if limits.verifies else 0  # also of those who have just gone
        self._room = min(limits.max_clients, LAST_LINK - first_link + 1 - beside)
        self._clients: dict[int, _Client] = {}
        self._arrivals: list[Arrival] = []
        self._unverified: list[int] = []
        """Their links, in the order in which they came."""
        self._new: set[int] = set()
        """Those of them that came in this turn: the session has not looked at what they sent."""
        self._given_up: set[int] = set()
        """Links whose clients went in this turn.  Where there are keys, nobody gets the number
        before the session knows: what it sends to the one, or says of it, is not the other's."""
        self._newcomers, self._newcomers_ns = UNVERIFIED_HZ, 0
        self._no_room: dict[str, int] = {}
        """Who has the key, and went as there was no place: its name, and when it may come again.
        Before `EVICTABLE_NS` it would hardly find one, and each time is told and recorded."""
        self._refused_told_ns = 0

    def __contains__(self, link: int) -> bool:
        return link in self._clients

    @property
    def full_turn(self) -> bool:
        """This turn has handed on enough."""
        return len(self._arrivals) >= MAX_A_TURN

    def take(self) -> list[Arrival]:
        """What came since the last call, in order."""
        taken, self._arrivals = self._arrivals, []
        self._new.clear()
        self._given_up.clear()
        return taken

    def news(self, text: str) -> None:
        """Of a port, not of a client."""
        self._arrivals.append(LinkEvent(self._first, text))

    # ----------------------------------------------------------------------- come and go

    def come(self, peer: Peer, now_ns: int) -> int | None:
        """Its link number; None where there is no room for it."""
        verified = peer.stays or not self._limits.verifies
        if not (self._has_room(peer, now_ns) if verified else self._may_try(peer, now_ns)):
            return None
        taken = self._clients.keys() | (self._given_up if self._limits.verifies else ())
        link = next((n for n in range(self._first, LAST_LINK + 1) if n not in taken), None)
        if link is None:
            return None
        rate_hz, splitter = self._limits.rate_hz, StreamSplitter() if peer.stream else None
        self._clients[link] = _Client(peer, now_ns, rate_hz, now_ns, splitter, verified)
        named = peer.stays or msgspec.UNSET
        self._arrivals.append(ClientCame(link, peer.name, peer.stream, verified, named))
        if not verified:
            self._unverified.append(link)
            self._new.add(link)
        return link

    def verify(self, link: int, now_ns: int) -> None:
        """The session has taken a frame with a good signature of the client that it knows there:
        it has one of the places of those who have the key, or goes where there is none."""
        if link not in self._unverified:
            return  # it has gone meanwhile
        client = self._clients[link]
        room = self._has_room(client.peer, now_ns)
        self._unverified.remove(link)
        client.verified = True
        if not room:
            self._no_room[client.peer.name] = now_ns + EVICTABLE_NS
            self.gone(link, "no room for it")

    def _may_try(self, peer: Peer, now_ns: int) -> bool:
        """Whether one more can come that is not verified: the first of them makes room for it."""
        more = (now_ns - self._newcomers_ns) * UNVERIFIED_HZ / 1e9
        self._newcomers, self._newcomers_ns = min(UNVERIFIED_HZ, self._newcomers + more), now_ns
        if self._newcomers < 1.0 or self._no_room.get(peer.name, now_ns) > now_ns:
            return False
        if len(self._unverified) >= UNVERIFIED_PLACES:
            first = self._unverified[0]
            if first in self._new:
                return False
            self.gone(first, f"made room for {peer.name}")
        self._newcomers -= 1.0
        return True

    def _has_room(self, peer: Peer, now_ns: int) -> bool:
        """Whether there is a place among those who are verified; the one of them that was silent
        longest makes room, if it was silent for a while."""
        if len(self._clients) - len(self._unverified) < self._room:
            return True
        there = ((link, client) for link, client in self._clients.items() if client.verified)
        passing = [link for link, client in there if not client.peer.stays]
        link = min(passing, key=lambda each: self._clients[each].heard_ns, default=None)
        if link is not None and now_ns - self._clients[link].heard_ns >= EVICTABLE_NS:
            self.gone(link, f"made room for {peer.name}")
            return True
        if now_ns - self._refused_told_ns >= FLOOD_TOLD_NS:
            self._refused_told_ns = now_ns
            text = f"no room for client {peer.name}: {self._room} are there, none of them silent"
            self._arrivals.append(LinkEvent(self._first, text, trouble=True))
        return False

    def gone(self, link: int, reason: str) -> None:
        """Its number is free from now on."""
        client = self._clients.pop(link)
        if not client.verified:
            self._unverified.remove(link)
        self._given_up.add(link)
        client.peer.forget()
        self._arrivals.append(ClientGone(link, reason))

    # ---------------------------------------------------------------------------- traffic

    def may_read(self, link: int, now_ns: int) -> bool:
        """Whether a stream is to be read on; what is not read slows its sender down."""
        return not self.full_turn and self._refill(self._clients[link], now_ns) > 0.0

    def heard(self, link: int, data: bytes, now_ns: int) -> None:
        """It sent this: handed on, or dropped where it sends too much.

        What is handed on is counted then, so one datagram may have more frames than are left for
        its sender, who waits for longer after it.
        """
        client = self._clients[link]
        if client.splitter is not None or (data and data[0] in MAGICS):
            client.heard_ns = now_ns
        too_much = self._refill(client, now_ns) <= 0.0
        if len(data) > MAX_CLIENT_DATAGRAM or (too_much and not _may_command(client, data, now_ns)):
            client.dropped += 1
            return
        frames: list[Frame] = []
        if client.splitter is not None:
            client.tokens -= _of_read(client, _messages(client.splitter.feed(data)))
        elif frames := plain_frames(data):
            client.tokens -= len(frames)
        else:
            client.tokens -= max(1, _messages(split(data)))
        self._arrivals.append(Datagram(link, data, tuple(frames)))

    def _refill(self, client: _Client, now_ns: int) -> float:
        rate_hz = self._limits.rate_hz
        more = (now_ns - client.tokens_ns) * rate_hz / 1e9
        client.tokens, client.tokens_ns = min(rate_hz, client.tokens + more), now_ns
        return client.tokens

    def send(self, link: int, data: bytes) -> None:
        """To that client; nothing where it has just gone."""
        client = self._clients.get(link)
        if client is not None and (why := client.peer.send(data)):
            self.gone(link, why)

    # ------------------------------------------------------------------------------- time

    def sweep(self, now_ns: int) -> None:
        """Those that were silent for too long, and what was dropped."""
        silent_ns = round(self._limits.silent_s * 1e9)
        self._no_room = {name: at for name, at in self._no_room.items() if at > now_ns}
        for link, client in list(self._clients.items()):
            if client.dropped and now_ns - client.told_ns >= FLOOD_TOLD_NS:
                self._arrivals.append(ClientFlooded(link, client.dropped))
                client.dropped, client.told_ns = 0, now_ns
            if client.peer.expires and now_ns - client.heard_ns >= silent_ns:
                self.gone(link, f"silent for {self._limits.silent_s:g} s")

    def close(self) -> None:
        """All of them, without a word."""
        clients = list(self._clients.values())
        self._clients.clear()
        for client in clients:
            client.peer.forget()


def _may_command(client: _Client, data: bytes, now_ns: int) -> bool:
    """Whether this is one command or mode, of which few enough came of late."""
    if client.splitter is not None or _only_message(data) not in COMMANDS:
        return False
    more = (now_ns - client.commands_ns) * COMMAND_HZ / 1e9
    client.commands, client.commands_ns = min(COMMAND_HZ, client.commands + more), now_ns
    if client.commands < 1.0:
        return False
    client.commands -= 1.0
    return True


def _only_message(data: bytes) -> int:
    """The number of the message in a datagram of one frame, by its header alone; -1 for others."""
    if len(data) > 9 and data[0] == MAGIC_V2:
        signed = 13 * (data[2] & 1)
        return int.from_bytes(data[7:10], "little") if len(data) == 12 + data[1] + signed else -1
    if len(data) > 5 and data[0] == MAGIC_V1:
        return data[5] if len(data) == 8 + data[1] else -1
    return -1


def _of_read(client: _Client, messages: int) -> float:
    """What a read of a stream counts as, in which so many messages ended."""
    if not messages:
        client.unfinished += 1 / READS_A_MESSAGE
        return 1 / READS_A_MESSAGE
    counted, client.unfinished = client.unfinished, 0.0
    return max(1 / READS_A_MESSAGE, messages - counted)


def _messages(items: Iterable[Item]) -> int:
    """What they count as."""
    return sum(
        1 + len(each.raw) // NOISE_BYTES_A_MESSAGE if type(each) is Garbage else 1 for each in items
    )
