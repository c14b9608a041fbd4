"""MAVLink's checksum: CRC-16/MCRF4XX over the frame without its magic byte, then the CRC extra."""

from __future__ import annotations

from fastcrc import crc16

from gcs.wire.dialect import MESSAGES

mcrf4xx = crc16.mcrf4xx

CRC_EXTRA = {msgid: bytes((message.crc_extra,)) for msgid, message in MESSAGES.items()}
"""Message id -> CRC extra (one byte, to be appended), for every message of the dialect."""
