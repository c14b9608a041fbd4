"""A chunk that is not what its head says is damaged, to the reader of records and of columns."""

from __future__ import annotations

import struct
import zlib
from pathlib import Path

import lz4.frame  # type: ignore[import-untyped]  # the package has no types
import pytest
import zstandard

from gcs.mcap_file.chunk_reader import ChunkFile
from gcs.mcap_file.format import MAGIC, MAX_CHUNK_BYTES, RECORD_HEAD, Message, Opcode
from gcs.mcap_file.reader import Reading

BODY = RECORD_HEAD.pack(Opcode.MESSAGE, 25) + struct.pack("<HIQQ", 1, 0, 5, 5) + b"abc"
PACKED = {"": BODY, "lz4": lz4.frame.compress(BODY), "zstd": zstandard.compress(BODY)}


def chunk(name: str, packed: bytes, size: int, crc: int) -> bytes:
    head = struct.pack("<QQQII", 5, 5, size & (2**64 - 1), crc, len(name)) + name.encode()
    body = head + struct.pack("<Q", len(packed)) + packed
    return RECORD_HEAD.pack(Opcode.CHUNK, len(body)) + body


@pytest.mark.parametrize("name", PACKED)
@pytest.mark.parametrize(
    ("more", "crc_wrong", "cut", "read", "in_columns"),
    [
        (0, False, 0, True, True),
        (-1, False, 0, False, False),
        (1, False, 0, False, False),
        (MAX_CHUNK_BYTES, False, 0, False, False),
        (2**64 - 1 - len(BODY), False, 0, False, False),
        (0, False, 20, False, False),
        (0, True, 0, False, True),  # columns trust what can be unpacked
    ],
)
def test_what_is_not_as_its_head_says_is_left_out(
    tmp_path: Path,
    name: str,
    more: int,
    crc_wrong: bool,
    cut: int,
    read: bool,
    in_columns: bool,
) -> None:
    packed = PACKED[name][: len(PACKED[name]) - cut]
    crc = zlib.crc32(BODY) ^ crc_wrong
    path = tmp_path / "x.mcap"
    path.write_bytes(MAGIC + chunk(name, packed, len(BODY) + more, crc))
    reading, file = Reading(path), ChunkFile(path)
    found = [record.data for record in reading if isinstance(record, Message)]
    assert (found, reading.condition.damaged) == ([b"abc"] if read else [], not read)
    assert sum(len(chunk.offsets[1]) for chunk in file.chunks()) == in_columns
    assert file.damaged == (not in_columns)


def test_a_compression_that_is_not_known_is_damage(tmp_path: Path) -> None:
    path = tmp_path / "x.mcap"
    path.write_bytes(MAGIC + chunk("bz2", BODY, len(BODY), 0))
    reading = Reading(path)
    assert (list(reading), reading.condition.damaged) == ([], 1)
