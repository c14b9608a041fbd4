"""Reads an MCAP from its beginning, as far as it goes: also one whose writer was killed or writes.

The library's readers want a file that was finished.  `Reading` takes every complete record, and of
a last chunk that breaks off every message that can still be decompressed; `Following` takes what
is new in a file that grows.
"""

from __future__ import annotations

import mmap
import os
import sys
from collections.abc import Callable, Generator, Iterator
from dataclasses import dataclass
from io import BufferedReader
from pathlib import Path
from typing import TypeAlias

from gcs.mcap_file.errors import BadRecordError
from gcs.mcap_file.format import (
    MAGIC,
    RECORD_HEAD,
    UNREADABLE,
    Opcode,
    Record,
    inflate,
    inflate_what_is_there,
    parse,
    whole_records,
)

MAX_UNPACKED_BYTES = 16 << 20
MAX_UNPACKED_SHARE = 30
"""A file may unpack to so much, and so many times what was read of it; records of stations reach 10
times.  lz4 can make 255 bytes of one."""
MAX_LENGTH = 1 << 30
"""A record of a growing file that says it is longer is none, and would be waited for in vain."""
KEPT_BYTES = 16 * 1024 * 1024
"""So much of a mapped file, once read, stays in memory."""
_TOLD_BYTES = 128 * 1024
"""So often the progress is told."""
_NO_MCAP = "not an MCAP file (wrong first bytes)"


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


Progress: TypeAlias = Callable[[int], None]
"""Is told how many bytes have been read so far."""


class Reading:
    """`for record in Reading(path)`: everything in file order, then look at `condition`.

    Raises BadRecordError for what is no MCAP at all, and OSError.
    """

    def __init__(
        self, path: Path, progress: Progress | None = None, *, chunks: bool = True
    ) -> None:
        """`progress` is called now and then; without `chunks` there are only attachments and
        metadata, which is quick."""
        self.path = path
        self.condition = Condition(path.stat().st_size)
        self._progress = progress
        self._chunks = chunks

    def __iter__(self) -> Generator[Record, None, None]:
        if self.condition.size == 0:
            raise BadRecordError(self.path, "the file is empty")
        with (
            open(self.path, "rb") as file,
            mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ) as data,
        ):
            if data[: len(MAGIC)] != MAGIC:
                raise BadRecordError(self.path, _NO_MCAP)
            yield from self._records(data)

    def _records(self, data: mmap.mmap) -> Iterator[Record]:
        condition = self.condition
        start = len(MAGIC)
        kept_from = unpacked = told = 0
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
                    yield from self._inner(inflate_what_is_there(data[body:]))
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
            elif (record := self._parsed(opcode, data[body:end])) is not None:
                yield record
            start = condition.position = end
            if end - kept_from >= KEPT_BYTES:
                kept_from = release(data, kept_from, end)
            if self._progress is not None and end - told >= _TOLD_BYTES:
                told = end
                self._progress(end)
        condition.unread_bytes = max(0, condition.size - start)
        condition.position = condition.size

    def _inner(self, records: bytes) -> Iterator[Record]:
        """The records of a chunk, as far as they are whole."""
        for opcode, start, end in whole_records(records):
            record = self._parsed(opcode, records[start:end])
            if record is not None:
                yield record

    def _parsed(self, opcode: int, body: bytes) -> Record | None:
        try:
            return parse(opcode, body)
        except UNREADABLE:
            self.condition.damaged += 1
            return None


class Following(Reading):
    """`new_records` again and again; whole records and chunks only.

    Raises BadRecordError for what is no MCAP, and OSError.
    """

    def __init__(self, path: Path) -> None:
        super().__init__(path)
        with open(path, "rb") as file:
            begins = file.read(len(MAGIC))
            self._identity = _identity(file)
        if begins != MAGIC[: len(begins)]:
            raise BadRecordError(path, _NO_MCAP)
        self.condition.position = len(MAGIC)

    def new_records(self) -> Iterator[Record]:
        """What was finished since the last call; `condition.closed` once the file is."""
        condition = self.condition
        with open(self.path, "rb") as file:
            if _identity(file) != self._identity:
                # Its writer has finished it, and put a compacted copy into its place.
                condition.closed = True
            while not condition.closed:
                file.seek(condition.position)
                head = file.read(RECORD_HEAD.size)
                if len(head) < RECORD_HEAD.size:
                    return
                opcode, length = RECORD_HEAD.unpack(head)
                if opcode == 0 or length > MAX_LENGTH:
                    raise BadRecordError(self.path, "is damaged where it is written")
                body = file.read(length)
                if len(body) < length:
                    return
                condition.position += RECORD_HEAD.size + length
                if opcode in (Opcode.FOOTER, Opcode.DATA_END):
                    condition.closed = True
                elif opcode == Opcode.CHUNK:
                    records = inflate(body)
                    condition.damaged += records is None
                    yield from self._inner(records or b"")
                elif (record := self._parsed(opcode, body)) is not None:
                    yield record


def release(data: mmap.mmap, start: int, end: int) -> int:
    """Drop the pages before `end` from memory, where else a whole file would stay mapped.

    Gives where the kept ones begin.  They can be read again, from the disk.
    """
    end -= end % mmap.PAGESIZE
    if sys.platform != "win32":
        data.madvise(mmap.MADV_DONTNEED, start, end - start)
    return end


def _identity(file: BufferedReader) -> tuple[int, int]:
    """Which file it is, whatever its name."""
    told = os.fstat(file.fileno())
    return told.st_dev, told.st_ino
