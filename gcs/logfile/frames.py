"""Finds MAVLink frames in a large buffer, with numpy and without a loop over the frames.

Only *regular* frames: messages of the dialect with a length that the dialect allows.  A frame with
a right checksum is taken wherever it stands, the first of two that overlap, as `gcs/wire/frame.py`
does it; what lies between them is for the caller to look at.
"""

from __future__ import annotations

from dataclasses import dataclass, fields
from functools import cache
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from gcs.logfile.checksums import crc_of_rows
from gcs.mcap_file.chunk_reader import Bytes, Index, rows_at
from gcs.wire.dialect import MESSAGES
from gcs.wire.frame import (
    CHECKSUM_SIZE,
    HEADER_V1,
    HEADER_V2,
    MAGIC_V1,
    MAGIC_V2,
    MAX_FRAME,
    SIGNATURE_SIZE,
    SIGNED,
)

Mask = NDArray[np.bool_]
Small = NDArray[np.int32]

PADDING = MAX_FRAME
"""Bytes that a buffer must have behind its end, so that whole rows can be read near it."""


_CACHED_BYTES = 1 << 18


@dataclass(frozen=True, slots=True)
class Frames:
    """Frames in a buffer, one an element of each array, in order of their start."""

    start: Index
    """Where the magic byte is."""
    size: Small
    """Magic to checksum or signature, bytes."""
    header: Small
    """Bytes before the payload: 6 or 10, which also tells the version."""
    length: Small
    """Bytes of payload as sent."""
    msgid: Small

    def __len__(self) -> int:
        return len(self.start)

    def pick(self, which: Mask | Index) -> Frames:
        """Those that a mask or an index array names."""
        return Frames(*(getattr(self, each.name)[which] for each in fields(self)))

    def and_also(self, others: Frames) -> Frames:
        """These, then the others."""
        return Frames(
            *(
                np.concatenate((getattr(self, each.name), getattr(others, each.name)))
                for each in fields(self)
            )
        )

    @property
    def end(self) -> Index:
        return self.start + self.size

    def source(self, data: Bytes) -> tuple[Bytes, Bytes, Bytes]:
        """seq, sysid, compid.  They end the header of version 2 before three bytes of message id,
        and of version 1 before one.
        """
        after = self.start + self.header - np.where(self.header == HEADER_V1, 1, 3)
        return data[after - 3], data[after - 2], data[after - 1]


class _Limits(NamedTuple):
    """By message id, up to 65535: what a frame of that message must be like."""

    crc_extra: NDArray[np.uint8]
    shortest: NDArray[np.int16]
    """Payload without extensions, of which MAVLink 1 cuts nothing."""
    longest: NDArray[np.int16]
    """Payload with all extensions; -1: no such message."""


@cache
def _limits() -> _Limits:
    limits = _Limits(
        np.zeros(65_536, np.uint8),
        np.zeros(65_536, np.int16),
        np.full(65_536, -1, np.int16),
    )
    for msgid, message in MESSAGES.items():
        limits.crc_extra[msgid] = message.crc_extra
        limits.shortest[msgid] = message.min_len
        limits.longest[msgid] = message.max_len
    return limits


def candidates(data: Bytes, size: int) -> Frames:
    """What looks like a regular frame within the first `size` bytes; checksums are not looked at.

    `data` must have `PADDING` bytes more than `size`.
    """
    assert len(data) >= size + PADDING
    start = _magic_places(data[:size])
    magic = data[start]
    one = _version_1(data, start[magic == MAGIC_V1], size)
    two = _version_2(data, start[magic == MAGIC_V2], size)
    if not len(one) or not len(two):
        return two if len(two) else one
    both = one.and_also(two)
    return both.pick(np.argsort(both.start, kind="stable"))


def _magic_places(data: Bytes) -> Index:
    """Where a byte is 0xFD or 0xFE, in pieces that fit into the processor's cache."""
    places = [np.zeros(0, np.int64)]
    for first in range(0, len(data), _CACHED_BYTES):
        piece = data[first : first + _CACHED_BYTES] - np.uint8(MAGIC_V2)
        places.append(np.flatnonzero(piece <= MAGIC_V1 - MAGIC_V2) + first)
    return np.concatenate(places)


def _version_1(data: Bytes, start: Index, size: int) -> Frames:
    msgid = data[start + 5].astype(np.int32)
    length = data[start + 1].astype(np.int32)
    # Without extensions, but pymavlink sends them in MAVLink 1 too.
    fits = (length >= _limits().shortest[msgid]) & (length <= _limits().longest[msgid])
    start, msgid, length = start[fits], msgid[fits], length[fits]
    whole = HEADER_V1 + length + CHECKSUM_SIZE
    header = np.full(len(start), HEADER_V1, np.int32)
    return _inside(Frames(start, whole, header, length, msgid), size)


def _version_2(data: Bytes, start: Index, size: int) -> Frames:
    # The message id's upper byte is 0 in every message of the dialect.
    start = start[(data[start + 9] == 0) & (data[start + 2] <= SIGNED)]
    msgid = data[start + 7].astype(np.int32) | data[start + 8].astype(np.int32) << 8
    length = data[start + 1].astype(np.int32)
    fits = length <= _limits().longest[msgid]
    start, msgid, length = start[fits], msgid[fits], length[fits]
    signed = data[start + 2].astype(np.int32)
    whole = HEADER_V2 + length + CHECKSUM_SIZE + signed * SIGNATURE_SIZE
    header = np.full(len(start), HEADER_V2, np.int32)
    return _inside(Frames(start, whole, header, length, msgid), size)


def _inside(frames: Frames, size: int) -> Frames:
    inside = frames.end <= size
    return frames if inside.all() else frames.pick(inside)


def are_intact(data: Bytes, frames: Frames) -> Mask:
    """Whether the checksum of each is right."""
    intact = np.zeros(len(frames), np.bool_)
    extra = _limits().crc_extra[frames.msgid]
    covered = frames.header + frames.length - 1
    order = np.argsort(covered, kind="stable")
    for group in np.split(order, np.flatnonzero(np.diff(covered[order])) + 1):
        if not len(group):
            continue
        width = int(covered[group[0]])
        rows = rows_at(data, frames.start[group] + 1, width + CHECKSUM_SIZE)
        told = rows[:, width].astype(np.uint16) | rows[:, width + 1].astype(np.uint16) << 8
        intact[group] = crc_of_rows(rows[:, :width], extra[group]) == told
    return intact


def are_first(frames: Frames) -> Mask:
    """Which remain when, from the left, each that overlaps one that remains is left out."""
    first = np.ones(len(frames), np.bool_)
    if len(frames) < 2 or not (frames.start[1:] < np.maximum.accumulate(frames.end)[:-1]).any():
        return first
    taken_to = 0
    for number, (start, end) in enumerate(
        zip(frames.start.tolist(), frames.end.tolist(), strict=True)
    ):
        if start < taken_to:
            first[number] = False
        else:
            taken_to = end
    return first


def find_frames(data: Bytes, size: int) -> Frames:
    """Every regular frame with a right checksum within the first `size` bytes, none overlapping."""
    found = candidates(data, size)
    found = found.pick(are_intact(data, found))
    return found.pick(are_first(found))


def find_message(data: Bytes, size: int, msgid: int) -> Frames:
    """`find_frames` for one message: checksums are computed only where they can matter."""
    found = candidates(data, size)
    # Only a candidate that another one overlaps can depend on the checksums of others.
    reached = np.maximum.accumulate(found.end) if len(found) else found.end
    apart_left = np.ones(len(found), np.bool_)
    apart_left[1:] = found.start[1:] >= reached[:-1]
    wanted = found.msgid == msgid
    if (apart_left | ~wanted).all():
        mine = found.pick(wanted)
        return mine.pick(are_intact(data, mine))
    # A run of candidates that overlap begins at one that is apart from all before it.
    run = np.cumsum(apart_left)
    entangled = np.isin(run, run[wanted & ~apart_left])
    kept = found.pick(wanted | entangled)
    kept = kept.pick(are_intact(data, kept))
    kept = kept.pick(are_first(kept))
    return kept.pick(kept.msgid == msgid)
