"""Reads an MCAP from its beginning, as far as it goes: also one whose writer was killed.

The library's readers want a file that was finished.  This loop takes every complete record, and
of a last chunk that breaks off every message that can still be decompressed.  Formats: the MCAP
specification, https://mcap.dev/spec.
"""

from __future__ import annotations

import mmap
import struct
import sys
import zlib
from collections.abc import Callable, Generator, Iterator
from dataclasses import dataclass
from io import BytesIO
from pathlib import Path
from typing import NamedTuple, TypeAlias

from mcap.data_stream import ReadDataStream
from mcap.exceptions import McapError
from mcap.opcode import Opcode
from mcap.records import Attachment, Channel, Metadata, Schema

MAGIC = b"\x89MCAP0\r\n"
RECORD_HEAD = struct.Struct("<BQ")
"""Opcode and length of what follows, before every record of an MCAP."""
_MESSAGE = struct.Struct("<HIQQ")
_CHUNK = struct.Struct("<QQQII")
_PIECE_BYTES = 16 * 1024
MAX_CHUNK_BYTES = 128 << 20
"""A chunk that unpacks to more is damaged."""
MAX_UNPACKED_BYTES = 16 << 20
MAX_UNPACKED_SHARE = 30
"""A file may unpack to so much, and so many times what was read of it; records of stations reach 10
times.  lz4 can make 255 bytes of one."""
_KEPT_BYTES = 16 * 1024 * 1024
"""So much of a mapped file, once read, stays in memory."""

_READERS: dict[int, Callable[[ReadDataStream], Schema | Channel | Attachment | Metadata]] = {
    Opcode.SCHEMA: Schema.read,
    Opcode.CHANNEL: Channel.read,
    Opcode.ATTACHMENT: Attachment.read,
    Opcode.METADATA: Metadata.read,
}


class BadRecordError(Exception):
    """The file is no MCAP: `path` and what is wrong with it."""

    def __init__(self, path: Path, reason: str) -> None:
        super().__init__(f"{path}: {reason}")
        self.path = path
        self.reason = reason


class Message(NamedTuple):
    channel_id: int
    sequence: int
    log_time_ns: int
    publish_time_ns: int
    data: bytes


Record: TypeAlias = Schema | Channel | Message | Attachment | Metadata


@dataclass(slots=True)
class Condition:
    """What was found out about the file itself; whole once the iteration has ended."""

    size: int
    position: int = 0
    """How far the file has been read."""
    closed: bool = False
    """Footer and closing magic are there: the writer finished it."""
    broken_chunk: bool = False
    """The last chunk breaks off."""
    damaged: int = 0
    """Records and chunks in the middle that could not be used."""
    unread_bytes: int = 0
    """The end of the file, where a damaged record does not tell where the next one begins."""
    behind_bytes: int = 0
    """What stands behind the closing magic: nothing of this record."""


class Reading:
    """`for record in Reading(path)`: everything in file order, then look at `condition`.

    Raises BadRecordError for what is no MCAP at all, and OSError.
    """

    def __init__(self, path: Path, *, chunks: bool = True) -> None:
        """Without `chunks`: only attachments and metadata, which is quick."""
        self.path = path
        self._chunks = chunks
        self.condition = Condition(path.stat().st_size)

    def __iter__(self) -> Generator[Record, None, None]:
        if self.condition.size == 0:
            raise BadRecordError(self.path, "the file is empty")
        with (
            open(self.path, "rb") as file,
            mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ) as data,
        ):
            if data[: len(MAGIC)] != MAGIC:
                raise BadRecordError(self.path, "not an MCAP file (wrong first bytes)")
            yield from self._records(data)

    def _records(self, data: mmap.mmap) -> Iterator[Record]:
        condition = self.condition
        start = len(MAGIC)
        kept_from = unpacked = 0
        while start + RECORD_HEAD.size <= condition.size:
            opcode, length = RECORD_HEAD.unpack_from(data, start)
            body = start + RECORD_HEAD.size
            end = body + length
            if opcode == Opcode.FOOTER:
                condition.closed = data[end : end + len(MAGIC)] == MAGIC
                if condition.closed:
                    condition.behind_bytes = condition.size - end - len(MAGIC)
                start = condition.size if condition.closed else end + len(MAGIC)
                break
            if end > condition.size:
                if opcode == Opcode.CHUNK and self._chunks:
                    condition.broken_chunk = True
                    start = condition.size
                    yield from self._inner(_inflate_what_is_there(data[body:]))
                break
            if opcode == Opcode.CHUNK and not self._chunks:
                pass
            elif opcode == Opcode.CHUNK:
                records = inflate(data[body:end])
                condition.damaged += records is None
                unpacked += len(records or b"")
                if unpacked > MAX_UNPACKED_BYTES + MAX_UNPACKED_SHARE * end:
                    reason = f"{end} bytes of it unpack to {unpacked}: no station records so"
                    raise BadRecordError(self.path, reason)
                yield from self._inner(records or b"")
            elif opcode == 0:
                break
            else:
                yield from self._take(opcode, data[body:end])
            start = condition.position = end
            if end - kept_from >= _KEPT_BYTES:
                kept_from = _release(data, kept_from, end)
        condition.unread_bytes = max(0, condition.size - start)
        condition.position = condition.size

    def _inner(self, records: bytes) -> Iterator[Record]:
        """The records of a chunk, as far as they are whole."""
        start = 0
        while start + RECORD_HEAD.size <= len(records):
            opcode, length = RECORD_HEAD.unpack_from(records, start)
            body = start + RECORD_HEAD.size
            start = body + length
            if start <= len(records):
                yield from self._take(opcode, records[body:start])

    def _take(self, opcode: int, body: bytes) -> Iterator[Record]:
        try:
            record = _parse(opcode, body)
        except (McapError, struct.error, UnicodeDecodeError, OverflowError):
            # The last one is what a read of more than 2^63 bytes raises: an attachment's length.
            self.condition.damaged += 1
        else:
            if record is not None:
                yield record


def _release(data: mmap.mmap, start: int, end: int) -> int:
    """Drop the pages before `end` from memory, where else a whole file would stay mapped.

    Gives where the kept ones begin.  They can be read again, from the disk.
    """
    end -= end % mmap.PAGESIZE
    if sys.platform != "win32":
        data.madvise(mmap.MADV_DONTNEED, start, end - start)
    return end


def _message(body: bytes) -> Message:
    channel_id, sequence, log_time_ns, publish_time_ns = _MESSAGE.unpack_from(body)
    return Message(channel_id, sequence, log_time_ns, publish_time_ns, body[_MESSAGE.size :])


def _parse(opcode: int, body: bytes) -> Record | None:
    if opcode == Opcode.MESSAGE:
        return _message(body)
    reader = _READERS.get(opcode)
    return reader(ReadDataStream(BytesIO(body))) if reader is not None else None


def inflate(chunk: bytes) -> bytes | None:
    """The records of a whole chunk; None if they are not what was written."""
    if len(chunk) < _CHUNK.size:
        return None
    _, _, size, crc, _ = _CHUNK.unpack_from(chunk)
    records = _inflate_what_is_there(chunk)
    if len(records) != size or (crc and zlib.crc32(records) != crc):
        return None
    return records


def _inflate_what_is_there(chunk: bytes) -> bytes:
    """The records of a chunk that may break off anywhere: all that can be decompressed.

    The lengths and the checksum in its header are not looked at: a writer that seeks fills them
    in when the chunk is finished, until then they are 2^64-1.
    """
    if len(chunk) < _CHUNK.size:
        return b""
    name_length = _CHUNK.unpack_from(chunk)[-1]
    name_end = _CHUNK.size + name_length
    compression = chunk[_CHUNK.size : name_end]
    packed = chunk[name_end + 8 :]
    match compression:
        case b"":
            return packed
        case b"lz4":
            return _unpack_lz4(packed)
        case b"zstd":
            return _unpack_zstd(packed)
        case _:
            return b""


def _unpack_lz4(packed: bytes) -> bytes:
    import lz4.frame  # type: ignore[import-untyped]  # the package has no types

    unpacker = lz4.frame.LZ4FrameDecompressor()
    records = bytearray()
    for start in range(0, len(packed), _PIECE_BYTES):
        if unpacker.eof or len(records) > MAX_CHUNK_BYTES:
            break
        try:
            records += unpacker.decompress(packed[start : start + _PIECE_BYTES])
        except RuntimeError:  # what lz4 raises for damaged input
            break
    return bytes(records)


def _unpack_zstd(packed: bytes) -> bytes:
    import zstandard

    unpacker = zstandard.ZstdDecompressor().decompressobj()
    records = bytearray()
    for start in range(0, len(packed), _PIECE_BYTES):
        if unpacker.eof or len(records) > MAX_CHUNK_BYTES:
            break
        try:
            records += unpacker.decompress(packed[start : start + _PIECE_BYTES])
        except zstandard.ZstdError:
            break
    return bytes(records)
