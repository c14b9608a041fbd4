"""Reads an MCAP chunk by chunk, and the messages of a channel by the indexes of a chunk.

Nothing is done message by message in Python: an index tells where the messages of a channel are,
and numpy takes them from there.  A file that was never closed has no summary: its chunks are
found from its beginning, and each is walked through.
"""

from __future__ import annotations

import struct
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from io import BytesIO
from pathlib import Path
from typing import BinaryIO, NamedTuple, TypeAlias

import numpy as np
from mcap.data_stream import ReadDataStream
from mcap.exceptions import McapError
from mcap.records import Footer, MetadataIndex
from numpy.typing import NDArray

from gcs.mcap_file.errors import BadRecordError
from gcs.mcap_file.format import (
    MAGIC,
    RECORD_HEAD,
    UNREADABLE,
    Channel,
    Metadata,
    Opcode,
    Schema,
    inflate,
    parse,
    whole_records,
)

Bytes = NDArray[np.uint8]
Index = NDArray[np.int64]

MESSAGE_HEAD = np.dtype(
    [
        ("opcode", "u1"),
        ("length", "<u8"),
        ("channel", "<u2"),
        ("sequence", "<u4"),
        ("log_time", "<u8"),
        ("publish_time", "<u8"),
    ]
)
"""A Message record up to its data."""
MESSAGE_BYTES = MESSAGE_HEAD.itemsize - RECORD_HEAD.size
"""What a Message record without data says as its length."""
ENTRY = np.dtype([("time", "<u8"), ("offset", "<u8")])
"""Of one message in the index of a chunk."""

_CHUNK_INDEX = struct.Struct("<QQQQI")
_INDEX = struct.Struct("<HI")
_LENGTH = struct.Struct("<Q")
_CHANNEL_ID = struct.Struct("<H")
_FOOTER_BYTES = RECORD_HEAD.size + 20
_INDEX_PLACE = struct.Struct("<HQ")
"""Channel, and the place of its index in the file."""

Wanted: TypeAlias = Callable[[Channel], bool]


@dataclass(slots=True)
class Chunk:
    """Records as they stand in a chunk, and where the Message records of each channel begin."""

    data: Bytes
    offsets: dict[int, Index]


class _Place(NamedTuple):
    """A chunk, and behind it its indexes, as the summary tells where they are."""

    start: int
    chunk_bytes: int
    index_bytes: int
    indexes: tuple[tuple[int, int], ...]
    """Channel and place in the file."""


class ChunkFile:
    """One MCAP file, in order: `for chunk in ChunkFile(path).chunks()`.

    Raises BadRecordError where the file is no MCAP, and OSError.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        self.channels: dict[int, Channel] = {}
        """Of the summary; where there is none, those that were met since."""
        self.schemas: dict[int, Schema] = {}
        self.metadata: dict[str, dict[str, str]] = {}
        self.damaged = 0
        """Chunks and records that could not be used."""
        self.read_bytes = 0
        self.size = path.stat().st_size
        self._places: list[_Place] = []
        with open(path, "rb") as file:
            if not self.size:
                raise BadRecordError(path, "the file is empty")
            if file.read(len(MAGIC)) != MAGIC:
                raise BadRecordError(path, "not an MCAP file (wrong first bytes)")
            self._read_summary(file)

    def chunks(self, wanted: Wanted | None = None) -> Iterator[Chunk]:
        """Each chunk with messages; of `wanted` channels only, where that is asked for."""
        with open(self.path, "rb") as file:
            yield from self._by_summary(file, wanted) if self._places else self._in_order(file)

    # ------------------------------------------------------------------------- a closed file

    def _read_summary(self, file: BinaryIO) -> None:
        """Without a whole summary, the file is read in order."""
        start = max(len(MAGIC), self.size - _FOOTER_BYTES - len(MAGIC))
        file.seek(start)
        tail = file.read()
        if len(tail) != _FOOTER_BYTES + len(MAGIC) or tail[0] != Opcode.FOOTER:
            return
        footer = Footer.read(ReadDataStream(BytesIO(tail[RECORD_HEAD.size :])))
        if not tail.endswith(MAGIC) or not len(MAGIC) <= footer.summary_start < start:
            return
        file.seek(footer.summary_start)
        summary = file.read(start - footer.summary_start)
        for opcode, at, end in whole_records(summary):
            if opcode == Opcode.CHUNK_INDEX:
                self._place(summary[at:end])
            elif opcode == Opcode.METADATA_INDEX:
                self._metadata(file, summary[at:end])
            else:
                self._learn(opcode, summary[at:end])
        self._places.sort(key=lambda place: place.start)

    def _place(self, body: bytes) -> None:
        try:
            _, _, start, chunk_bytes, list_bytes = _CHUNK_INDEX.unpack_from(body)
            at = _CHUNK_INDEX.size
            indexes = tuple(_INDEX_PLACE.iter_unpack(body[at : at + list_bytes]))
            (index_bytes,) = _LENGTH.unpack_from(body, at + list_bytes)
        except struct.error:
            self.damaged += 1
            return
        self._places.append(_Place(start, chunk_bytes, index_bytes, indexes))

    def _metadata(self, file: BinaryIO, body: bytes) -> None:
        try:
            index = MetadataIndex.read(ReadDataStream(BytesIO(body)))
        except (McapError, struct.error, UnicodeDecodeError):
            self.damaged += 1
            return
        if RECORD_HEAD.size < index.length <= self.size and index.offset <= self.size:
            file.seek(index.offset + RECORD_HEAD.size)
            self._learn(Opcode.METADATA, file.read(index.length - RECORD_HEAD.size))

    def _by_summary(self, file: BinaryIO, wanted: Wanted | None) -> Iterator[Chunk]:
        chosen = {n for n, each in self.channels.items() if wanted is None or wanted(each)}
        for place in self._places:
            mine = [each for each in place.indexes if each[0] in chosen]
            if not mine or place.start >= self.size:
                continue
            file.seek(place.start)
            whole = place.chunk_bytes + place.index_bytes
            read = file.read(min(whole, self.size - place.start))
            self.read_bytes = place.start + len(read)
            data = self._unpack(read[RECORD_HEAD.size : place.chunk_bytes])
            if data is None:
                continue
            offsets: dict[int, Index] = {}
            for channel, at in mine:
                found = _index(read, at - place.start)
                if found is None:
                    self.damaged += 1
                else:
                    offsets[channel] = found
            yield Chunk(data, offsets)

    # ----------------------------------------------------------------------------- any file

    def _in_order(self, file: BinaryIO) -> Iterator[Chunk]:
        position = len(MAGIC)
        file.seek(position)
        while position + RECORD_HEAD.size <= self.size:
            opcode, length = RECORD_HEAD.unpack(file.read(RECORD_HEAD.size))
            position += RECORD_HEAD.size + length
            if position > self.size:
                self.damaged += 1
                break
            self.read_bytes = position
            if opcode == Opcode.CHUNK:
                data = self._unpack(file.read(length))
                if data is not None:
                    yield self._walk(data)
            elif opcode == Opcode.MESSAGE:
                loose = RECORD_HEAD.pack(opcode, length) + file.read(length)
                yield self._walk(np.frombuffer(loose, np.uint8))
            elif opcode in (Opcode.SCHEMA, Opcode.CHANNEL, Opcode.METADATA):
                self._learn(opcode, file.read(length))
            elif opcode in (0, Opcode.DATA_END):
                break
            else:
                file.seek(length, 1)

    def _walk(self, data: Bytes) -> Chunk:
        """Learn the schemas and channels, and find the messages, record by record."""
        found: dict[int, list[int]] = {}
        raw = data.tobytes()
        for opcode, start, end in whole_records(raw):
            if opcode != Opcode.MESSAGE:
                self._learn(opcode, raw[start:end])
            elif end - start >= MESSAGE_BYTES:
                (channel,) = _CHANNEL_ID.unpack_from(raw, start)
                found.setdefault(channel, []).append(start - RECORD_HEAD.size)
        return Chunk(data, {n: np.array(each, np.int64) for n, each in found.items()})

    def _unpack(self, body: bytes) -> Bytes | None:
        """The records of a chunk; None if it is damaged; its checksum is not looked at."""
        records = inflate(body, checked=False)
        if records is None:
            self.damaged += 1
            return None
        return np.frombuffer(records, np.uint8)

    def _learn(self, opcode: int, body: bytes) -> None:
        if opcode not in (Opcode.SCHEMA, Opcode.CHANNEL, Opcode.METADATA):
            return
        try:
            record = parse(opcode, body)
        except UNREADABLE:
            self.damaged += 1
            return
        match record:
            case Schema():
                self.schemas[record.id] = record
            case Channel():
                self.channels[record.id] = record
            case Metadata():
                self.metadata[record.name] = record.metadata


def rows_at(data: Bytes, starts: Index, width: int) -> Bytes:
    """`width` bytes from each of `starts`, one row each; all must lie inside `data`."""
    if width == 0 or not len(starts):
        return np.zeros((len(starts), width), np.uint8)
    # A view of overlapping items, from which numpy copies whole items.
    items = np.ndarray((len(data) - width + 1,), f"V{width}", data, 0, (1,))
    return items[starts].view(np.uint8).reshape(len(starts), width)


def heads_of(chunk: Chunk, starts: Index) -> NDArray[np.void]:
    """The beginnings of Message records, as `MESSAGE_HEAD`; `starts` must be inside."""
    width = MESSAGE_HEAD.itemsize
    return rows_at(chunk.data, starts, width).view(MESSAGE_HEAD).ravel()


def _index(data: bytes, at: int) -> Index | None:
    """The offsets in the Message Index record at `at`; None if there is no whole one."""
    try:
        opcode, length = RECORD_HEAD.unpack_from(data, at)
        _, listed = _INDEX.unpack_from(data, at + RECORD_HEAD.size)
        if at < 0 or opcode != Opcode.MESSAGE_INDEX or length != listed + _INDEX.size:
            return None
        start = at + RECORD_HEAD.size + _INDEX.size
        entries = np.frombuffer(data, ENTRY, listed // ENTRY.itemsize, start)
    except (struct.error, ValueError):
        return None
    return entries["offset"].astype(np.int64)
