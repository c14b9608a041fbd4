"""The station's end of every link: bytes that come in become frames, messages become frames.

A link is a connection over which vehicles are reached: a UDP or TCP endpoint or a serial line.
"""

from __future__ import annotations

from collections.abc import Iterable

from gcs.report import Direction, FrameItem
from gcs.session.effects import Effect, Record, Transmit
from gcs.wire.codec import FrameWriter
from gcs.wire.frame import Item, StreamSplitter, split
from gcs.wire.ids import MavAutopilot, MavState, MavType
from gcs.wire.messages import Heartbeat, Message

MAVLINK_VERSION = 3


class Links:
    """All links of a session; each has its own sequence numbers."""

    def __init__(
        self,
        sysid: int,
        compid: int,
        count: int,
        streams: Iterable[int] = (),
        waiting: Iterable[int] = (),
    ) -> None:
        """`streams`: links that carry a byte stream (TCP, serial), not datagrams.
        `waiting`: links whose peer is not known before it has sent something."""
        self._writers = [FrameWriter(sysid, compid) for _ in range(count)]
        self._splitters = {link: StreamSplitter() for link in streams}
        self._waiting = set(waiting)

    def split(self, link: int, data: bytes) -> list[Item]:
        """Frames and garbage in `data`.

        A datagram is whole; a read of a stream goes on where the last one ended.
        """
        splitter = self._splitters.get(link)
        return split(data) if splitter is None else splitter.feed(data)

    def rest(self, link: int) -> bytes:
        """Bytes of a stream that are in no item yet; always empty for a link of datagrams."""
        splitter = self._splitters.get(link)
        return b"" if splitter is None else splitter.rest

    def peer_known(self, link: int) -> None:
        """A frame came in on `link`: from now on frames are sent there."""
        self._waiting.discard(link)

    def send(self, link: int, message: Message) -> list[Effect]:
        """One frame on one link, and its record; nothing where no peer is known."""
        if link in self._waiting:
            return []
        raw = self._writers[link].write(message)
        return [Transmit(link, raw), Record(FrameItem(link, Direction.SENT, raw))]

    def heartbeat(self) -> list[Effect]:
        """HEARTBEAT of a ground station, on every link."""
        beat = Heartbeat(
            custom_mode=0,
            type=MavType.GCS,
            autopilot=MavAutopilot.INVALID,
            base_mode=0,
            system_status=MavState.ACTIVE,
            mavlink_version=MAVLINK_VERSION,
        )
        return [effect for link in range(len(self._writers)) for effect in self.send(link, beat)]
