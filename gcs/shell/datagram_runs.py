"""Datagrams that came together and hold nothing but plain frames become one input.

A vehicle that sends a frame a datagram, hundreds of times a second, and a loop that was away for a
few milliseconds: what came meanwhile is split here, datagram by datagram, and handed on as one run.
So it is routed, sent on, recorded and counted as one, at a fraction of the cost.

Of vehicles only: a client's datagrams are counted against its rate one by one (`client_table.py`).
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from gcs.session.inputs import Datagram
from gcs.vehicle.received_frames import MOST_IN_TURN
from gcs.wire.frame import Frame, plain_frames

MAX_RUN = 8192
"""Bytes: clients are not to wait for the first frame until hundreds of others are split."""
MAX_FRAMES = MOST_IN_TURN
"""More of them would be counted one by one."""


def runs(link: int, datagrams: Iterable[bytes]) -> Iterator[Datagram]:
    """The inputs for what was read of a link of datagrams, in order.

    One whose bytes are not all plain frames (see `plain_frames`) is an input of its own: where it
    ends matters for what its garbage is.
    """
    frames: list[Frame] = []
    together: list[bytes] = []
    size = 0
    for data in datagrams:
        found = plain_frames(data)
        many = size + len(data) > MAX_RUN or len(frames) + len(found) > MAX_FRAMES
        if frames and (many or not found):
            yield Datagram(link, b"".join(together), tuple(frames))
            frames, together, size = [], [], 0
        if found:
            frames += found
            together.append(data)
            size += len(data)
        else:
            yield Datagram(link, data)
    if frames:
        yield Datagram(link, b"".join(together), tuple(frames))


def pieces(link: int, reads: Iterable[bytes]) -> Iterator[Datagram]:
    """The same for a byte stream, where only the session knows how one read goes on."""
    return (Datagram(link, data) for data in reads)
