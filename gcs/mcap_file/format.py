"""How an MCAP is built: records one after the other, and chunks that hold more of them, packed.

What all readers and writers of this room share.  The specification is https://mcap.dev/spec.
"""

from __future__ import annotations

import struct
import zlib
from collections.abc import Callable, Iterator
from io import BytesIO
from typing import NamedTuple, Protocol, TypeAlias

from mcap.data_stream import ReadDataStream
from mcap.exceptions import McapError
from mcap.opcode import Opcode
from mcap.records import Attachment, Channel, Metadata, Schema

__all__ = ["Attachment", "Channel", "Metadata", "Opcode", "Schema"]

MAGIC = b"\x89MCAP0\r\n"
RECORD_HEAD = struct.Struct("<BQ")
"""Opcode and length of what follows, before every record of an MCAP."""
MAX_CHUNK_BYTES = 128 << 20
"""A chunk that unpacks to more, or says so, is damaged."""

_MESSAGE = struct.Struct("<HIQQ")
_CHUNK = struct.Struct("<QQQII")
_PIECE_BYTES = 16 * 1024


class Message(NamedTuple):
    channel_id: int
    sequence: int
    log_time_ns: int
    publish_time_ns: int
    data: bytes


Record: TypeAlias = Schema | Channel | Message | Attachment | Metadata

_READERS: dict[int, Callable[[ReadDataStream], Schema | Channel | Attachment | Metadata]] = {
    Opcode.SCHEMA: Schema.read,
    Opcode.CHANNEL: Channel.read,
    Opcode.ATTACHMENT: Attachment.read,
    Opcode.METADATA: Metadata.read,
}
UNREADABLE = (McapError, struct.error, UnicodeDecodeError, OverflowError)
"""What `parse` raises for a damaged record; the last one is what a read of more than 2^63 bytes
raises: an attachment's length."""


def parse(opcode: int, body: bytes) -> Record | None:
    """One record; None for a kind that nobody here reads.  Raises UNREADABLE."""
    if opcode == Opcode.MESSAGE:
        channel_id, sequence, log_time_ns, publish_time_ns = _MESSAGE.unpack_from(body)
        data = body[_MESSAGE.size :]
        return Message(channel_id, sequence, log_time_ns, publish_time_ns, data)
    reader = _READERS.get(opcode)
    return reader(ReadDataStream(BytesIO(body))) if reader is not None else None


def whole_records(data: bytes) -> Iterator[tuple[int, int, int]]:
    """Opcode, and where the body starts and ends, of every record that is whole."""
    start = 0
    while start + RECORD_HEAD.size <= len(data):
        opcode, length = RECORD_HEAD.unpack_from(data, start)
        start += RECORD_HEAD.size
        if start + length > len(data):
            break
        yield opcode, start, start + length
        start += length


def inflate(chunk: bytes, *, checked: bool = True) -> bytes | None:
    """The records of a whole chunk; None if they are not what was written.

    Without `checked` the checksum is not looked at.
    """
    found = _parts_of(chunk)
    if found is None:
        return None
    size, crc, compression, packed = found
    if size > MAX_CHUNK_BYTES:
        return None
    records = _unpack(compression, packed, size + 1)
    if records is None or len(records) != size:
        return None
    return None if checked and crc and zlib.crc32(records) != crc else records


def inflate_what_is_there(chunk: bytes) -> bytes:
    """The records of a chunk that may break off anywhere: all that can be decompressed.

    The lengths and the checksum in its header are not looked at: a writer that seeks fills them
    in when the chunk is finished, until then they are 2^64-1.
    """
    found = _parts_of(chunk)
    if found is None:
        return b""
    _, _, compression, packed = found
    match compression:
        case b"":
            return packed
        case b"lz4":
            import lz4.frame  # type: ignore[import-untyped]  # the package has no types

            # RuntimeError is what lz4 raises for damaged input.
            return _unpack_in_pieces(lz4.frame.LZ4FrameDecompressor(), RuntimeError, packed)
        case b"zstd":
            import zstandard

            unpacker = zstandard.ZstdDecompressor().decompressobj()
            return _unpack_in_pieces(unpacker, zstandard.ZstdError, packed)
        case _:
            return b""


def _parts_of(chunk: bytes) -> tuple[int, int, bytes, bytes] | None:
    """The size and checksum of its records, the name of the compression, and what is packed."""
    if len(chunk) < _CHUNK.size:
        return None
    _, _, size, crc, name_length = _CHUNK.unpack_from(chunk)
    name_end = _CHUNK.size + name_length
    return size, crc, chunk[_CHUNK.size : name_end], chunk[name_end + 8 :]


def _unpack(compression: bytes, packed: bytes, most: int) -> bytes | None:
    """At most so many bytes of what is packed; None where it is damaged."""
    match compression:
        case b"":
            return packed
        case b"lz4":
            import lz4.frame

            try:
                return bytes(lz4.frame.LZ4FrameDecompressor().decompress(packed, most))
            except RuntimeError:
                return None
        case b"zstd":
            import zstandard

            try:
                return zstandard.ZstdDecompressor().stream_reader(packed).read(most)
            except zstandard.ZstdError:
                return None
        case _:
            return None


def _unpack_in_pieces(unpacker: _Unpacker, damaged: type[Exception], packed: bytes) -> bytes:
    records = bytearray()
    for start in range(0, len(packed), _PIECE_BYTES):
        if unpacker.eof or len(records) > MAX_CHUNK_BYTES:
            break
        try:
            records += unpacker.decompress(packed[start : start + _PIECE_BYTES])
        except damaged:
            break
    return bytes(records)


class _Unpacker(Protocol):
    @property
    def eof(self) -> bool: ...
    def decompress(self, data: bytes, /) -> bytes: ...
