"""The frames of a record as a .tlog.

An imported .tlog comes out byte for byte (`gcs/logfile/imports/tlog.py` says how it is kept).  Of a
flight that the station recorded, each frame that was received or sent gets its log time; bytes that
were no frame, and frames that were refused and so were never on a link, are left out.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

import numpy as np

from gcs.logfile.imports.result import METADATA
from gcs.logfile.tlog import STAMP_BYTES
from gcs.mcap_file.batch_writer import Sink
from gcs.mcap_file.chunk_reader import (
    MESSAGE_BYTES,
    MESSAGE_HEAD,
    Bytes,
    Chunk,
    ChunkFile,
    Index,
    heads_of,
    rows_at,
)
from gcs.mcap_file.errors import BadLogError
from gcs.mcap_file.format import Channel
from gcs.record import ros1
from gcs.report import Direction
from gcs.wire.frame import HEADER_V1, HEADER_V2

_HEAD = MESSAGE_HEAD.itemsize
_TAIL_LENGTH_BYTES = 4


@dataclass(slots=True)
class Exported:
    """What was written, and what was left out."""

    frames: int = 0
    garbage_bytes: int = 0
    left_out: int = 0
    """Frames that were refused, and records of garbage."""
    damaged: int = 0
    """Parts of the source that could not be read."""


class _Part(NamedTuple):
    """Equally long pieces of the .tlog, and the log time of each."""

    log_ns: Index
    pieces: Bytes


def export_tlog(
    source: Path, target: Sink, progress: Callable[[int], None] | None = None
) -> Exported:
    """Write all frames of `source`; `progress` gets the bytes that were read so far.

    Raises BadLogError where it is no MCAP or has no frames, and OSError.
    """
    file = ChunkFile(source)
    exporting = _Export(file)
    for chunk in file.chunks(has_frames):
        target.write(exporting.chunk(chunk))
        if progress is not None:
            progress(file.read_bytes)
    result = exporting.result
    result.damaged += file.damaged
    if not result.frames:
        raise BadLogError(source, "there are no MAVLink frames in it")
    return result


def has_frames(channel: Channel) -> bool:
    """Whether what is on a channel stood on a link: frames, or bytes that were none."""
    return _is_frames(channel) or _is_garbage(channel)


def _is_frames(channel: Channel) -> bool:
    is_ours = channel.message_encoding == "ros1" and channel.topic.startswith("/mavlink/")
    return is_ours and channel.metadata.get(ros1.PAYLOAD_LENGTH_KEY, "").isdecimal()


def _is_garbage(channel: Channel) -> bool:
    parts = channel.topic.split("/")
    return channel.message_encoding == "ros1" and parts[1:2] == ["link"] and parts[-1] == "garbage"


class _Export:
    def __init__(self, file: ChunkFile) -> None:
        self._file = file
        self.result = Exported()

    @property
    def _imported(self) -> bool:
        return self._file.metadata.get(METADATA, {}).get("format") == "tlog"

    def chunk(self, chunk: Chunk) -> bytes:
        """Its part of the .tlog."""
        parts: list[_Part] = []
        for number, offsets in chunk.offsets.items():
            channel = self._file.channels.get(number)
            if channel is None:
                continue
            offsets = self._inside(chunk, offsets)
            if _is_frames(channel):
                length = int(channel.metadata[ros1.PAYLOAD_LENGTH_KEY])
                parts += self._frames(chunk, offsets, min(length, 255))
            elif _is_garbage(channel):
                parts += self._garbage(chunk, offsets)
        return _in_order(parts)

    def _inside(self, chunk: Chunk, offsets: Index) -> Index:
        """Of whole Message records."""
        offsets = offsets[(offsets >= 0) & (offsets <= len(chunk.data) - _HEAD)]
        heads = heads_of(chunk, offsets)
        room = (len(chunk.data) - offsets - _HEAD + MESSAGE_BYTES).astype(np.uint64)
        whole = (heads["length"] <= room) & (heads["length"] >= MESSAGE_BYTES)
        whole &= heads["opcode"] == 5
        self.result.damaged += int((~whole).sum())
        return offsets[whole]

    def _frames(self, chunk: Chunk, offsets: Index, full: int) -> Iterator[_Part]:
        heads = heads_of(chunk, offsets)
        size = heads["length"].astype(np.int64) - MESSAGE_BYTES
        least = ros1.FRAME_BYTES + full + _TAIL_LENGTH_BYTES
        start = offsets + _HEAD
        long_enough = size >= least
        self.result.damaged += int((~long_enough).sum())
        starts, size, heads = start[long_enough], size[long_enough], heads[long_enough]
        frame = rows_at(chunk.data, starts, ros1.FRAME_BYTES)
        kept = np.ones(len(starts), np.bool_)
        stamped = kept
        if self._imported:
            stamped = heads["publish_time"] % 1000 == 0
        else:
            kept = frame[:, 1] != Direction.REFUSED
            self.result.left_out += int((~kept).sum())
        magic, length = frame[:, 2].astype(np.int64), frame[:, 3].astype(np.int64)
        group = ((size << 8 | length) << 8 | magic) << 1 | stamped
        group[~kept] = -1
        order = np.argsort(group, kind="stable")
        for part in np.split(order, np.flatnonzero(np.diff(group[order])) + 1):
            if len(part) and kept[part[0]]:
                first = part[0]
                rows = rows_at(chunk.data, starts[part], int(size[first]))
                pieces = _rebuilt(rows, full, int(length[first]), int(magic[first]))
                if stamped[first]:
                    time_ns = heads["publish_time" if self._imported else "log_time"][part]
                    pieces = np.concatenate((_stamps(time_ns // 1000), pieces), axis=1)
                self.result.frames += len(part)
                yield _Part(heads["log_time"][part].astype(np.int64), pieces)

    def _garbage(self, chunk: Chunk, offsets: Index) -> Iterator[_Part]:
        if not self._imported:
            self.result.left_out += len(offsets)
            return
        heads = heads_of(chunk, offsets)
        lengths = heads["length"].astype(np.int64) - MESSAGE_BYTES
        starts = offsets + _HEAD
        for start, length, log_ns in zip(
            starts.tolist(), lengths.tolist(), heads["log_time"].tolist(), strict=True
        ):
            message = chunk.data[start : start + length].tobytes()
            reason_end = 4 + int.from_bytes(message[:4], "little")
            raw = message[reason_end + 4 :]
            self.result.garbage_bytes += len(raw)
            yield _Part(np.array([log_ns], np.int64), np.frombuffer(raw, np.uint8)[None, :])


def _rebuilt(rows: Bytes, full: int, length: int, magic: int) -> Bytes:
    """The frames that were recorded as `rows`, all of one version and payload length."""
    at = ros1.FRAME_BYTES
    payload = rows[:, at : at + min(length, full)]
    tail = rows[:, at + full + _TAIL_LENGTH_BYTES :]
    if magic == ros1.MAGIC_V2:
        head = rows[:, 2 : 2 + HEADER_V2]
    else:
        head = np.concatenate((rows[:, 2:4], rows[:, 6 : 6 + HEADER_V1 - 2]), axis=1)
    return np.concatenate((head, payload, tail), axis=1)


def _stamps(time_us: Index) -> Bytes:
    return time_us.astype(">u8").view(np.uint8).reshape(len(time_us), STAMP_BYTES)


def _in_order(parts: list[_Part]) -> bytes:
    """All pieces by their log time."""
    if not parts:
        return b""
    log_ns = np.concatenate([part.log_ns for part in parts])
    sizes = np.concatenate([np.full(len(p.log_ns), p.pieces.shape[1], np.int64) for p in parts])
    order = np.argsort(log_ns, kind="stable")
    ends = np.cumsum(sizes[order])
    starts = np.empty(len(order), np.int64)
    starts[order] = ends - sizes[order]
    data = np.empty(int(ends[-1]), np.uint8)
    at = 0
    for _, pieces in parts:
        count, width = pieces.shape
        if width:
            item = f"V{width}"
            items = np.ndarray((len(data) - width + 1,), item, data, 0, (1,))
            items[starts[at : at + count]] = np.ascontiguousarray(pieces).view(item).ravel()
        at += count
    return data.tobytes()
