"""A frame made anew with another sequence number, or as MAVLink 1; its payload stays.

What is signed loses its signature: that was of the bytes as they were.
"""

from __future__ import annotations

from functools import cache
from struct import Struct

from gcs.wire.crc import CRC_EXTRA, mcrf4xx
from gcs.wire.dialect import MESSAGES
from gcs.wire.frame import (
    CHECKSUM_SIZE,
    HEADER_V1,
    HEADER_V2,
    MAGIC_V1,
    MAGIC_V2,
    SIGNATURE_SIZE,
    SIGNED,
)

MOST_IN_V1 = 0xFF
"""The largest message id that MAVLink 1 has room for."""

SEQ_V2 = 4
"""Where the sequence number stands in a MAVLink 2 frame."""
_BYTES = [bytes((number,)) for number in range(256)]
_V1, _V2 = bytes((MAGIC_V1,)), bytes((MAGIC_V2,))
_checksum = Struct("<H").pack


def is_mavlink1(raw: bytes) -> bool:
    return raw[0] == MAGIC_V1


def source_of(raw: bytes) -> bytes:
    """System and component id, two bytes."""
    return raw[3:5] if raw[0] == MAGIC_V1 else raw[5:7]


def seq_of(raw: bytes) -> int:
    return raw[2] if raw[0] == MAGIC_V1 else raw[4]


@cache
def crc_change(length: int, changed: int) -> int:
    """How the checksum of a MAVLink 2 frame with a payload of that length changes where the bits
    `changed` of its sequence number do."""
    behind = bytes(HEADER_V2 - SEQ_V2 - 1 + length + 1)  # and the CRC extra
    return mcrf4xx(bytes((changed,)) + behind) ^ mcrf4xx(b"\0" + behind)


def with_seq(raw: bytes, seq: int) -> bytes:
    """The same frame with that sequence number, 0 to 255, unsigned."""
    if raw[0] == MAGIC_V2 and not raw[2]:
        # Nearly all frames.  A CRC is linear, so that no byte behind the number need be looked at
        # again: 1.8 us in place of 3.0, on a loaded machine.
        end = len(raw) - CHECKSUM_SIZE
        checksum = (raw[end] | raw[end + 1] << 8) ^ crc_change(raw[1], raw[SEQ_V2] ^ seq)
        return raw[:SEQ_V2] + _BYTES[seq] + raw[SEQ_V2 + 1 : end] + _checksum(checksum)
    if raw[0] == MAGIC_V1:
        old, body = raw[1:-CHECKSUM_SIZE], raw[1:2] + bytes((seq,)) + raw[3:-CHECKSUM_SIZE]
        return _V1 + body + _checksum(_crc(old, body, raw[-CHECKSUM_SIZE:], raw[5]))
    flags = raw[2]
    end = len(raw) - (SIGNATURE_SIZE if flags & SIGNED else 0)
    stop = end - CHECKSUM_SIZE
    body = bytes((raw[1], flags & ~SIGNED, raw[3], seq)) + raw[5:stop]
    msgid = raw[7] | raw[8] << 8 | raw[9] << 16
    return _V2 + body + _checksum(_crc(raw[1:stop], body, raw[stop:end], msgid))


def _crc(old: bytes, new: bytes, checksum: bytes, msgid: int) -> int:
    """Of `new`; `checksum` is that of `old`, which is as long.

    The CRC extra of a message that the dialect lacks is not known.  But a CRC is linear: what two
    bodies with the same extra differ in is what their checksums differ in.
    """
    crc_extra = CRC_EXTRA.get(msgid)
    if crc_extra is not None:
        return mcrf4xx(new + crc_extra)
    differs = bytes(a ^ b for a, b in zip(old, new, strict=True)) + b"\0"
    return int.from_bytes(checksum, "little") ^ mcrf4xx(differs) ^ mcrf4xx(bytes(len(differs)))


def as_mavlink1(raw: bytes) -> bytes | None:
    """The same message as a MAVLink 1 frame; None where MAVLink 1 cannot say it: a number above
    255, or a message that the dialect lacks.  Fields that MAVLink 2 added are left out."""
    if raw[0] == MAGIC_V1:
        return raw
    msgid = raw[7] | raw[8] << 8 | raw[9] << 16
    message = MESSAGES.get(msgid)
    if msgid > MOST_IN_V1 or message is None:
        return None
    size = message.min_len
    payload = raw[HEADER_V2 : HEADER_V2 + raw[1]].ljust(size, b"\0")[:size]
    body = bytes((size, raw[4], raw[5], raw[6], msgid)) + payload
    assert len(body) == HEADER_V1 - 1 + size
    return _V1 + body + _checksum(mcrf4xx(body + CRC_EXTRA[msgid]))
