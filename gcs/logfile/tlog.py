"""Reads .tlog files: before each MAVLink frame 8 bytes, big-endian microseconds since 1970.

The format is MAVProxy's, QGroundControl's and Mission Planner's.  Real files hold damaged
stretches and end within a frame; such bytes are told as gaps, and none is lost: the time stamps,
the frames and the gaps of a file together are the file.  It is read in windows, so memory stays
bounded whatever its size.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import BinaryIO, NamedTuple

import numpy as np
from numpy.typing import NDArray

from gcs.logfile.frames import PADDING, Frames, Mask, find_frames, find_message
from gcs.mcap_file.chunk_reader import Bytes, rows_at
from gcs.mcap_file.errors import BadLogError
from gcs.mcap_file.format import MAGIC as MCAP_MAGIC
from gcs.wire.frame import HEADER_V1, HEADER_V2, MAGIC_V1, MAX_FRAME, frame_at

WINDOW_BYTES = 4 << 20
STAMP_BYTES = 8
SEARCHED_BYTES = 1 << 20
"""A file without a frame in so many bytes at its beginning is taken for no .tlog."""

_LONGEST_GAP = 64 << 10
"""A longer one is told in pieces."""
_MAGIC = re.compile(b"[\xfd\xfe]")

Stamps = NDArray[np.uint64]


class Gap(NamedTuple):
    """Bytes of a window that are neither frame nor time stamp."""

    start: int
    end: int


@dataclass(frozen=True, slots=True)
class Window:
    """A part of a file.  `data` is used again for the next one: copy what is to be kept."""

    data: Bytes
    """With `PADDING` bytes behind its end."""
    frames: Frames
    stamped: Mask
    """Whether 8 bytes before the frame are its time stamp; else it directly follows another."""
    time_us: Stamps
    """As they stand in the file; 0 where a frame has none."""
    gaps: list[Gap]
    """In order."""
    read_bytes: int
    """How much of the file has been read."""


class Excerpt(NamedTuple):
    """The frames of one message in a part of a file; `data` as in `Window`."""

    data: Bytes
    frames: Frames
    time_us: Stamps


def read_windows(path: Path, window_bytes: int = WINDOW_BYTES) -> Iterator[Window]:
    """The whole file, in order.  Raises BadLogError where it is no .tlog, and OSError."""
    for piece in _pieces(path, window_bytes):
        found = find_frames(piece.data, piece.size)
        found = found.pick(found.start < piece.decided)
        end = piece.settle(found)
        frames, stamped, gaps = _fill_gaps(piece.data, found, piece.begin, end)
        time_us = _stamps(piece.data, frames)
        time_us[~stamped] = 0
        yield Window(piece.data, frames, stamped, time_us, gaps, piece.read_bytes)


def read_message(path: Path, msgid: int, window_bytes: int = WINDOW_BYTES) -> Iterator[Excerpt]:
    """The frames of one message, faster than `read_windows`.  A frame's time is what stands before
    it.  Raises as `read_windows`, except that a file without any such frame is not refused.
    """
    for piece in _pieces(path, window_bytes):
        found = find_message(piece.data, piece.size, msgid)
        found = found.pick(found.start < piece.decided)
        piece.settle(found)
        yield Excerpt(piece.data, found, _stamps(piece.data, found))


# ---------------------------------------------------------------------------------- windows


class _Piece:
    """Bytes in memory; those that are not settled yet are in the next piece again."""

    def __init__(self, data: Bytes, begin: int, size: int, last: bool, read_bytes: int) -> None:
        self.data = data
        self.begin = begin
        self.size = size
        self.last = last
        self.read_bytes = read_bytes
        self.decided = size if last else max(begin, size - MAX_FRAME)
        """A frame that starts before is whole, and nothing that comes can change that."""
        self.end = size

    def settle(self, found: Frames) -> int:
        """Up to where this piece counts: the rest is kept for the next one."""
        if not self.last:
            self.end = int(found.end[-1]) if len(found) else self.begin
            if self.size - self.end > _LONGEST_GAP:
                self.end = self.decided - STAMP_BYTES
        return self.end


def _pieces(path: Path, window_bytes: int) -> Iterator[_Piece]:
    with open(path, "rb") as file:
        _refuse_others(path, file)
        room = window_bytes + _LONGEST_GAP + MAX_FRAME
        # The first bytes are before the file: no frame there has room for its time stamp.
        data = np.zeros(STAMP_BYTES + room + PADDING, np.uint8)
        kept = read_bytes = 0
        last = False
        while not last:
            at = STAMP_BYTES + kept
            view = data.data[at : at + window_bytes]
            count = file.readinto(view)
            read_bytes += count
            size = at + count
            last = not count or not file.peek(1)
            data[size : size + PADDING] = 0
            piece = _Piece(data, STAMP_BYTES, size, last, read_bytes)
            yield piece
            kept = size - piece.end
            data[STAMP_BYTES : STAMP_BYTES + kept] = data[piece.end : size].copy()


def _refuse_others(path: Path, file: BinaryIO) -> None:
    """Raises BadLogError where the beginning of the file holds no frame."""
    head = file.read(SEARCHED_BYTES)
    file.seek(0)
    if not head:
        raise BadLogError(path, "the file is empty")
    if head.startswith(MCAP_MAGIC):
        raise BadLogError(path, "an MCAP file, no .tlog")
    data = np.frombuffer(head + bytes(PADDING), np.uint8)
    if not len(find_frames(data, len(head))):
        where = "" if len(head) < SEARCHED_BYTES else f" in its first {SEARCHED_BYTES} bytes"
        raise BadLogError(path, f"no .tlog: there is no MAVLink frame{where}")


def _stamps(data: Bytes, frames: Frames) -> Stamps:
    rows = rows_at(data, frames.start - STAMP_BYTES, STAMP_BYTES)
    return rows.view(">u8").ravel().astype(np.uint64)


# ------------------------------------------------------------------------------------- gaps


class _Found(NamedTuple):
    """A frame in a gap, as the columns of `Frames`, and whether a time stamp stands before it."""

    start: int
    size: int
    header: int
    length: int
    msgid: int
    stamped: bool


def _fill_gaps(data: Bytes, frames: Frames, begin: int, end: int) -> tuple[Frames, Mask, list[Gap]]:
    """All frames from `begin` to `end`, which of them have a time stamp, and what lies between.

    `frames` are the regular ones.  Between them may be frames of messages that the dialect lacks,
    or of an unusual length.
    """
    before = np.concatenate(([begin], frames.end))
    after = np.concatenate((frames.start, [end]))
    space = after - before
    stamped = space[:-1] >= STAMP_BYTES
    # The time stamp of the next frame is no part of a gap; behind the last one there is none.
    after[:-1] -= np.where(stamped, STAMP_BYTES, 0)
    gaps: list[Gap] = []
    more: list[_Found] = []
    for number in np.flatnonzero(after > before).tolist():
        for item in _search(data, int(before[number]), int(after[number])):
            if isinstance(item, Gap):
                gaps.append(item)
            else:
                more.append(item)
    if not more:
        return frames, stamped, gaps
    added = np.array(more, np.int64)
    order = np.argsort(np.concatenate((frames.start, added[:, 0])), kind="stable")
    extra = Frames(
        added[:, 0],
        added[:, 1].astype(np.int32),
        added[:, 2].astype(np.int32),
        added[:, 3].astype(np.int32),
        added[:, 4].astype(np.int32),
    )
    with_stamp = np.concatenate((stamped, added[:, 5] != 0))[order]
    return frames.and_also(extra).pick(order), with_stamp, gaps


def _search(data: Bytes, begin: int, end: int) -> Iterator[Gap | _Found]:
    """Frames that `find_frames` does not look for, and the gaps around them.

    The checksum of a message that the dialect lacks cannot be checked.  Such a frame is accepted if
    a time stamp stands between it and what is before it, and the same or the gap's end follows.
    """
    run = data[begin:end].tobytes()
    taken = 0
    for magic in _MAGIC.finditer(run):
        start = magic.start()
        if start < taken:
            continue
        frame = frame_at(run, start, known=True)
        if frame is None and start - taken == STAMP_BYTES:
            frame = frame_at(run, start, known=False)
            if frame is not None and not _may_end(run, start + len(frame.raw)):
                frame = None
        if frame is None:
            continue
        stamped = start - taken >= STAMP_BYTES
        gap_end = start - STAMP_BYTES if stamped else start
        if taken < gap_end:
            yield Gap(begin + taken, begin + gap_end)
        header = HEADER_V1 if run[start] == MAGIC_V1 else HEADER_V2
        size = len(frame.raw)
        yield _Found(begin + start, size, header, len(frame.payload), frame.msgid, stamped)
        taken = start + size
    if taken < len(run):
        yield Gap(begin + taken, end)


def _may_end(run: bytes, end: int) -> bool:
    if end == len(run):
        return True
    following = run[end + STAMP_BYTES : end + STAMP_BYTES + 1]
    return _MAGIC.match(following) is not None
