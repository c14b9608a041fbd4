"""MAVLink's checksum of many frames at once.

CRC-16/MCRF4XX without its start value is linear over GF(2): the checksum of a frame is the XOR of
one table entry for each of its bytes, and the table depends only on how far the byte is from the
end.  So all frames of one length are checked column by column, two bytes at a time.
"""

from __future__ import annotations

from functools import cache

import numpy as np
from numpy.typing import NDArray

from gcs.mcap_file.chunk_reader import Bytes

Words = NDArray[np.uint16]

_BLOCK_ROWS = 16_384
"""So many rows at a time stay in the processor's cache."""


def crc_of_rows(rows: Bytes, crc_extra: Bytes) -> Words:
    """The checksum of each row followed by its byte of `crc_extra`."""
    count, width = rows.shape
    sums = _table(0).take(crc_extra) ^ _start_value(width + 1)
    even = width - width % 2
    words = np.ascontiguousarray(rows[:, :even]).view("<u2")
    for first in range(0, count, _BLOCK_ROWS):
        block = slice(first, first + _BLOCK_ROWS)
        part = sums[block]
        for column in range(even // 2):
            # Behind these two bytes: the rest of the row and the CRC extra.
            behind = width - 2 * column - 1
            part ^= _pair_table(behind).take(words[block, column], mode="clip")
    if width % 2:
        sums ^= _table(1).take(rows[:, -1])
    return sums


@cache
def _step_table() -> Words:
    """What one byte makes of a register of 0 (polynomial 0x1021, reflected: 0x8408)."""
    table: Words = np.arange(256, dtype=np.uint16)
    for _ in range(8):
        table = ((table >> 1) ^ np.where(table & 1, 0x8408, 0)).astype(np.uint16)
    return table


def _push_zero(register: Words) -> Words:
    pushed: Words = (register >> 8) ^ _step_table()[register & 0xFF]
    return pushed


@cache
def _table(behind: int) -> Words:
    """What a byte adds to the checksum when `behind` bytes follow it."""
    return _step_table() if behind == 0 else _push_zero(_table(behind - 1))


@cache
def _pair_table(behind: int) -> Words:
    """The same for two bytes as a little-endian word; `behind` bytes follow the second one."""
    return (_table(behind)[:, None] ^ _table(behind + 1)[None, :]).ravel()


@cache
def _start_value(length: int) -> np.uint16:
    """What the register's start value 0xFFFF adds after `length` bytes."""
    register = np.array([0xFFFF], np.uint16)
    for _ in range(length):
        register = _push_zero(register)
    return np.uint16(register[0])
