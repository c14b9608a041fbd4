"""Keys are kept out of records: of a SETUP_SIGNING frame all is kept but its secret.

A record is given away, and whoever has the key flies the vehicle.
"""

from __future__ import annotations

import re
from typing import Final

from gcs.wire.crc import CRC_EXTRA, mcrf4xx
from gcs.wire.frame import CHECKSUM_SIZE, HEADER_V2

SETUP_SIGNING: Final = 256
_HEADER: Final = re.compile(rb"\xfd.{6}\x00\x01\x00", re.DOTALL)
"""Of MAVLink 2: MAVLink 1 has no message ids above 255."""
_BEFORE_KEY: Final = 10
"""initial_timestamp, target_system, target_component."""
_KEY: Final = 32


def without_key(raw: bytes) -> bytes:
    """A whole SETUP_SIGNING frame with zeros for its key, and the checksum that goes with them."""
    return blanked(raw, mend=True)


def blanked(data: bytes, *, mend: bool) -> bytes:
    """Any bytes, with zeros where a SETUP_SIGNING in them has its key.

    `mend`: the checksum of a frame that is there goes with them, as far as it is there, too.  (What
    is no frame must not become one.)
    """
    match = _HEADER.search(data)
    if match is None:
        return data
    out = bytearray(data)
    while match is not None:
        start = match.start()
        payload = start + HEADER_V2
        end = payload + out[start + 1]
        first, last = payload + _BEFORE_KEY, min(payload + _BEFORE_KEY + _KEY, len(out))
        if mend:
            last = min(last, end)  # a shorter payload ends before its key's last zeros
        if first < last:
            out[first:last] = bytes(last - first)
        if mend and end < len(out):
            checksum = mcrf4xx(bytes(out[start + 1 : end]) + CRC_EXTRA[SETUP_SIGNING])
            there = min(CHECKSUM_SIZE, len(out) - end)
            out[end : end + there] = checksum.to_bytes(CHECKSUM_SIZE, "little")[:there]
        match = _HEADER.search(data, match.end())
    return bytes(out)
