"""The station's end of every link: bytes that come in become frames, messages become frames.

A link is a connection over which vehicles are reached, or a MAVLink client: a UDP or TCP peer or a
serial line.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass

from gcs.protocol.effects import Address
from gcs.report import Direction, FrameItem
from gcs.session.as_recorded import AsRecorded
from gcs.session.effects import Effect, Record, Transmit
from gcs.station.client_frames import ClientFrames
from gcs.station.signatures import NO_KEYS, Signatures
from gcs.wire.codec import FrameWriter
from gcs.wire.frame import Frame, Garbage, Item, Reason, StreamSplitter, split
from gcs.wire.hidden_frames import Separator
from gcs.wire.ids import MavAutopilot, MavState, MavType
from gcs.wire.messages import Heartbeat, Message
from gcs.wire.signing import UnsignableError

MAVLINK_VERSION = 3


MAX_DATAGRAM = 1400
"""Bytes of frames that leave as one datagram: fits an Ethernet frame, and a client's buffer
(MAVSDK's has 2,048 bytes)."""


MOST_NAMES = 1024
"""Components in whose names frames are written; of more, all begin to count anew."""


def groups(raws: Sequence[bytes]) -> Iterator[Sequence[bytes]]:
    """Frames in their order, a group for a datagram, as few as may be; none is cut."""
    begin = size = 0
    for number, raw in enumerate(raws):
        size += len(raw)
        if size > MAX_DATAGRAM and number > begin:
            yield raws[begin:number]
            begin, size = number, len(raw)
    if size:
        yield raws[begin:]


def datagrams(raws: Sequence[bytes]) -> list[bytes]:
    """Frames put together so."""
    return [b"".join(group) for group in groups(raws)]


@dataclass(slots=True)
class Counts:
    """Frames (and runs of garbage) that came in on a link, and frames that left."""

    received: int = 0
    sent: int = 0


class Links:
    """All links of a session; each has its own sequence numbers."""

    def __init__(
        self,
        sysid: int,
        compid: int,
        count: int,
        streams: Iterable[int] = (),
        waiting: Iterable[int] = (),
        signatures: Signatures | None = None,
    ) -> None:
        """`streams`: links that carry a byte stream (TCP, serial), not datagrams.
        `waiting`: links whose peer is not known before it has sent something.
        `signatures`: what frames that leave are signed with, if any are."""
        self._signatures = signatures or Signatures(NO_KEYS, sysid, compid, count)
        self._writers = [FrameWriter(sysid, compid) for _ in range(count)]
        self._splitters = {link: StreamSplitter() for link in streams}
        self._waiting = set(waiting)
        self._separators = [Separator() for _ in range(count)]
        """Of the links that vehicles are on, where they have no key."""
        self.counts = [Counts() for _ in range(count)]
        """Of the links that vehicles are on, since the start."""
        self._named: dict[tuple[int, int, int], FrameWriter] = {}
        """Who writes in the name of a component: by link, system and component."""
        self._clients: dict[int, ClientFrames] = {}

    def split(self, link: int, data: bytes, frames: Sequence[Frame] = ()) -> Sequence[Item]:
        """Frames and garbage in `data`; `frames` where a datagram was split already.

        A datagram is whole; a read of a stream goes on where the last one ended.
        """
        splitter = self._splitters.get(link)
        items = (frames or split(data)) if splitter is None else splitter.feed(data)
        if link < len(self.counts):
            self.counts[link].received += len(items)
        return items

    def again(self, link: int, recorded: AsRecorded) -> Sequence[Item]:
        """The same where an audit knows what it was split into."""
        splitter = self._splitters.get(link)
        if splitter is not None:
            splitter.go_on_after(recorded.rest)
        if link < len(self.counts):
            self.counts[link].received += len(recorded.parts)
        return [Garbage(raw, Reason(why)) if why else split(raw)[0] for raw, why in recorded.parts]

    def rest(self, link: int) -> bytes:
        """Bytes of a stream that are in no item yet; always empty for a link of datagrams."""
        splitter = self._splitters.get(link)
        return b"" if splitter is None else splitter.rest

    def peer_known(self, link: int) -> None:
        """A frame came in on `link`: from now on frames are sent there."""
        self._waiting.discard(link)

    def wait_for_peer(self, link: int) -> None:
        """Nothing is sent on a vehicle's link before a frame comes in on it."""
        self._waiting.add(link)

    def open(self, link: int, stream: bool) -> None:
        """A client's link is there; its number may have been another one's before."""
        self._splitters.pop(link, None)
        self._clients[link] = ClientFrames()
        if stream:
            self._splitters[link] = StreamSplitter()

    def close(self, link: int) -> None:
        """A client's link is gone."""
        self._splitters.pop(link, None)
        self._clients.pop(link, None)
        for key in [key for key in self._named if key[0] == link]:
            del self._named[key]

    def client_spoke(self, link: int, raw: bytes) -> None:
        """A good frame came in on a client's link: its MAVLink version is one that it knows.

        A link with a key has MAVLink 2 alone, as version 1 has no signatures.
        """
        if not self._signatures.signed(link):
            self._clients[link].spoke(raw)

    def pass_on(self, link: int, raw: bytes, now_ns: int, *, foreign: bool = False) -> list[Effect]:
        """A frame on a link, and its record: signed where the link has a key, else unchanged.

        `foreign`: a client has written it, and it goes to a vehicle.
        """
        return [
            effect
            for sent in self.unrecorded(link, raw, now_ns)
            for effect in self._apart(sent, foreign=foreign)
        ]

    def _apart(self, sent: Transmit, *, foreign: bool = False) -> list[Effect]:
        """What leaves, and its record, which has the frame without what is put before it where it
        would complete a frame hidden in those before."""
        record = Record(FrameItem(sent.link, Direction.SENT, sent.data))
        if sent.link < len(self._separators) and not self._signatures.signed(sent.link):
            data = self._separators[sent.link].apart(sent.data, foreign=foreign)
            sent = sent if data is sent.data else Transmit(sent.link, data)
        return [sent, record]

    def unrecorded(self, link: int, raw: bytes, now_ns: int) -> list[Transmit]:
        """The same without its record; nothing where it cannot be signed."""
        client = self._clients.get(link)
        passed = [raw] if client is None else client.passed([raw], now_ns)
        return [sent for each in passed for sent in self._leaving(link, each, now_ns)]

    def _leaving(self, link: int, raw: bytes, now_ns: int) -> list[Transmit]:
        try:
            sent = Transmit(link, self._signatures.outgoing(link, raw, now_ns))
        except UnsignableError:
            return []
        if link < len(self.counts):
            self.counts[link].sent += 1
        return [sent]

    def together(
        self, link: int, raws: Sequence[bytes], now_ns: int, left_out: Sequence[bytes] = ()
    ) -> list[Transmit]:
        """Frames that came together, unrecorded: on a client's link they leave together, too, but
        for those that are left out."""
        client = self._clients[link]
        if self._signatures.signed(link):
            passed = client.passed(raws, now_ns, left_out)
            signed = [sent for raw in passed for sent in self._leaving(link, raw, now_ns)]
            made = datagrams([sent.data for sent in signed])
        elif left_out:
            made = datagrams(client.passed(raws, now_ns, left_out))
        elif client.alters(now_ns):
            made = [client.joined(group, now_ns) for group in groups(raws)]
        else:
            client.keep(raws)
            made = datagrams(raws)
        return [Transmit(link, data) for data in made if data]

    def send_as(self, source: Address, link: int, message: Message, now_ns: int) -> list[Effect]:
        """One frame on one link in the name of a component (`source`), and its record."""
        key = (link, source.sysid, source.compid)
        writer = self._named.get(key)
        if writer is None:
            if len(self._named) >= MOST_NAMES:
                self._named.clear()
            writer = self._named[key] = FrameWriter(source.sysid, source.compid)
        raw: bytes | None = writer.write(message)
        client = self._clients.get(link)
        if raw is not None and client is not None:
            raw = client.answer(raw, now_ns)
        if raw is None:
            return []
        leaving = self._leaving(link, raw, now_ns)
        return [effect for sent in leaving for effect in self._apart(sent)]

    def send(self, link: int, message: Message, now_ns: int) -> list[Effect]:
        """One frame on one link, and its record; nothing where no peer is known."""
        if link in self._waiting:
            return []
        return self.pass_on(link, self._writers[link].write(message), now_ns)

    def heartbeat(self, now_ns: int) -> list[Effect]:
        """HEARTBEAT of a ground station, on every link."""
        beat = Heartbeat(
            custom_mode=0,
            type=MavType.GCS,
            autopilot=MavAutopilot.INVALID,
            base_mode=0,
            system_status=MavState.ACTIVE,
            mavlink_version=MAVLINK_VERSION,
        )
        links = range(len(self._writers))
        return [effect for link in links for effect in self.send(link, beat, now_ns)]
