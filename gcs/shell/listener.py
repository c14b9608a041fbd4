"""Hears vehicles without a station: opens links, and sends nothing that a vehicle acts upon."""

from __future__ import annotations

import select
from collections.abc import Iterator, Sequence
from types import TracebackType

from gcs.shell.clock import Clock
from gcs.shell.endpoints import Endpoint, Kind
from gcs.shell.sockets import open_link
from gcs.shell.sockets.base import Link
from gcs.wire.codec import FrameWriter
from gcs.wire.frame import Frame, StreamSplitter, split
from gcs.wire.messages import Heartbeat

SYSID = 254
COMPID = 190
"""Not a ground station's usual 255: no autopilot shall take this for its ground station, and miss
it when it goes."""
HEARTBEAT_NS = 1_000_000_000
WAIT_S = 0.1
BURST = 256
MAV_TYPE_GENERIC = 0
MAV_AUTOPILOT_INVALID = 8
MAV_STATE_ACTIVE = 4
MAVLINK_VERSION = 3


class Listener:
    """A few open links; `frames` waits shortly and gives what came, with its time.

    Where a vehicle answers only who speaks (udpout), a heartbeat goes out once a second, of a
    generic component; on all other links nothing is sent at all.
    """

    def __init__(self, endpoints: Sequence[Endpoint], clock: Clock) -> None:
        """Raises AddressInUse, SerialUnavailable, or another OSError."""
        self._clock = clock
        self._links: list[Link] = []
        self._splitters: dict[Link, StreamSplitter] = {}
        self._writer = FrameWriter(SYSID, COMPID)
        self._heartbeat_at_ns = 0
        for endpoint in endpoints:
            try:
                link = open_link(endpoint)
            except OSError:
                self.close()
                raise
            self._links.append(link)
            self._splitters[link] = StreamSplitter()

    def __enter__(self) -> Listener:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self.close()

    def close(self) -> None:
        for link in self._links:
            link.close()

    def frames(self) -> Iterator[tuple[int, Frame]]:
        """What came within `WAIT_S`: time in ns since the Unix epoch, frame."""
        self._be_heard()
        for link in self._links:
            link.poke(self._clock.now_ns())
        open_ones = [link for link in self._links if link.fileno() >= 0]
        ready, _, _ = select.select(open_ones, [], [], WAIT_S)
        for link in ready:
            for data in link.drain(BURST):
                now_ns = self._clock.now_ns()
                items = self._splitters[link].feed(data) if link.stream else split(data)
                for item in items:
                    if isinstance(item, Frame):
                        yield now_ns, item

    def _be_heard(self) -> None:
        now_ns = self._clock.now_ns()
        if now_ns < self._heartbeat_at_ns:
            return
        self._heartbeat_at_ns = now_ns + HEARTBEAT_NS
        beat = Heartbeat(
            0, MAV_TYPE_GENERIC, MAV_AUTOPILOT_INVALID, 0, MAV_STATE_ACTIVE, MAVLINK_VERSION
        )
        for link in self._links:
            if link.endpoint.kind is Kind.UDP_OUT:
                link.send(self._writer.write(beat))
