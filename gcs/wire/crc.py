"""The checksum of MAVLink: CRC-16/MCRF4XX over the frame without its magic, then the CRC extra."""

from __future__ import annotations

from fastcrc import crc16

from gcs.wire.dialect import MESSAGES

mcrf4xx = crc16.mcrf4xx

CRC_EXTRA = {msgid: bytes((message.crc_extra,)) for msgid, message in MESSAGES.items()}
"""Message id -> CRC extra, the byte to append, of every message of the dialect."""
