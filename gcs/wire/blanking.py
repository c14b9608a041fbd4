"""Keys are kept out of records: of a SETUP_SIGNING frame all is kept but its secret.

A record is given away, and whoever has the key flies the vehicle.  Both functions change nothing
when they are used on what they returned, so that an audit records the same again.
"""

from __future__ import annotations

import re
from typing import Final

from gcs.wire.crc import CRC_EXTRA, mcrf4xx
from gcs.wire.frame import CHECKSUM_SIZE, HEADER_V2, Frame, split

SETUP_SIGNING: Final = 256
_HEADER: Final = re.compile(rb"\xfd.{6}\x00\x01\x00", re.DOTALL)
"""Of MAVLink 2: MAVLink 1 has no message ids above 255."""
_BEFORE_KEY: Final = 10
"""initial_timestamp, target_system, target_component."""
_KEY: Final = 32


def without_key(frame: bytes) -> bytes:
    """A whole frame; a SETUP_SIGNING has zeros for its key then, and the checksum that goes with
    them.  Nothing else of it changes, whatever its key or its signature looks like."""
    if _HEADER.match(frame) is None:
        return frame
    end = HEADER_V2 + frame[1]
    first = HEADER_V2 + _BEFORE_KEY
    if len(frame) < end + CHECKSUM_SIZE or end <= first:
        return frame
    last = min(first + _KEY, end)  # a payload ends before the last zeros of its key
    kept = frame[:first] + bytes(last - first) + frame[last:end]
    checksum = mcrf4xx(kept[1:] + CRC_EXTRA[SETUP_SIGNING]).to_bytes(CHECKSUM_SIZE, "little")
    return kept + checksum + frame[end + CHECKSUM_SIZE :]


def without_keys(noise: bytes) -> bytes:
    """Bytes that are no frame, with zeros where a SETUP_SIGNING that was damaged or cut has its
    key.  A header within a key is none."""
    match = _HEADER.search(noise)
    if match is None:
        return noise
    kept = bytearray(noise)
    while match is not None:
        first = match.start() + HEADER_V2 + _BEFORE_KEY
        last = min(first + _KEY, len(kept))
        if first < last:
            kept[first:last] = bytes(last - first)
        match = _HEADER.search(noise, first + _KEY)
    return bytes(kept)


def datagram_without_keys(data: bytes) -> bytes:
    """What came in, which may hold both."""
    if not may_hold_key(data):
        return data
    return b"".join(
        without_key(each.raw) if type(each) is Frame else without_keys(each.raw)
        for each in split(data)
    )


def may_hold_key(data: bytes) -> bool:
    """Whether a SETUP_SIGNING seems to begin in it: what is recorded of it may differ from it."""
    return _HEADER.search(data) is not None
