"""Datagrams that came together and hold nothing but plain frames become one input.

A vehicle that sends a frame a datagram, hundreds of times a second, and a loop that was away for a
few milliseconds: what came meanwhile is split here, datagram by datagram, and handed on as one run.
So it is routed, sent on, recorded and counted as one, at a fraction of the cost.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from gcs.session.inputs import Datagram
from gcs.wire.frame import Frame, plain_frames

MAX_RUN = 4096
"""Bytes: clients are not to wait for the first frame until hundreds of others are split."""


def runs(link: int, datagrams: Iterable[bytes]) -> Iterator[Datagram]:
    """The inputs for what was read of a link of datagrams, in order.

    One whose bytes are not all plain frames (see `plain_frames`) is an input of its own: where it
    ends matters for what its garbage is.
    """
    frames: list[Frame] = []
    size = 0
    for data in datagrams:
        found = plain_frames(data)
        if frames and (not found or size + len(data) > MAX_RUN):
            yield _run(link, frames)
            frames, size = [], 0
        if found:
            frames += found
            size += len(data)
        else:
            yield Datagram(link, data)
    if frames:
        yield _run(link, frames)


def pieces(link: int, reads: Iterable[bytes]) -> Iterator[Datagram]:
    """The same for a byte stream, where only the session knows how one read goes on."""
    return (Datagram(link, data) for data in reads)


def _run(link: int, frames: list[Frame]) -> Datagram:
    return Datagram(link, b"".join([frame.raw for frame in frames]), tuple(frames))
