"""Reads an MCAP that is being written: what is new in it, each time it is asked."""

from __future__ import annotations

import os
from collections.abc import Iterator
from io import BufferedReader
from pathlib import Path

from mcap.opcode import Opcode

from gcs.record.reading import MAGIC, RECORD_HEAD, BadRecordError, Reading, Record, inflate

MAX_LENGTH = 1 << 30
"""A record that says it is longer is no record, and would be waited for in vain."""


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
            raise BadRecordError(path, "not an MCAP file (wrong first bytes)")
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
                else:
                    yield from self._take(opcode, body)


def _identity(file: BufferedReader) -> tuple[int, int]:
    """Which file it is, whatever its name."""
    told = os.fstat(file.fileno())
    return told.st_dev, told.st_ino
