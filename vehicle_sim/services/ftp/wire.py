"""FILE_TRANSFER_PROTOCOL's payload: opcodes, layout (MAVLink FTP, Payload Format), refusals."""

from __future__ import annotations

import struct
from enum import IntEnum
from typing import Final, NamedTuple

from vehicle_sim.storage.store import StoreError, StoreFault

DATA_MAX: Final = 239
_HEADER: Final = struct.Struct("<HBBBBBxI")


class Opcode(IntEnum):
    """What is asked, and the two kinds of answer."""

    NONE = 0
    TERMINATE_SESSION = 1
    RESET_SESSIONS = 2
    LIST_DIRECTORY = 3
    OPEN_FILE_RO = 4
    READ_FILE = 5
    CREATE_FILE = 6
    WRITE_FILE = 7
    REMOVE_FILE = 8
    CREATE_DIRECTORY = 9
    REMOVE_DIRECTORY = 10
    OPEN_FILE_WO = 11
    TRUNCATE_FILE = 12
    RENAME = 13
    CALC_FILE_CRC32 = 14
    BURST_READ_FILE = 15
    ACK = 128
    NAK = 129


class Nak(IntEnum):
    """The first byte of a NAK's data."""

    FAIL = 1
    FAIL_ERRNO = 2
    INVALID_DATA_SIZE = 3
    INVALID_SESSION = 4
    NO_SESSIONS_AVAILABLE = 5
    EOF = 6
    UNKNOWN_COMMAND = 7
    FILE_EXISTS = 8
    FILE_PROTECTED = 9
    FILE_NOT_FOUND = 10


class Request(NamedTuple):
    """What a client sent.  `size` is what it claims, `data` what is there of it."""

    sequence: int
    session: int
    opcode: int
    size: int
    offset: int
    data: bytes


class Reply(NamedTuple):
    """What is sent back; its size is that of its data."""

    sequence: int
    session: int
    opcode: Opcode
    req_opcode: int
    offset: int = 0
    data: bytes = b""
    burst_complete: bool = False


def parse(payload: bytes) -> Request:
    """Of a payload of any length; what is missing is zero."""
    header = payload[: _HEADER.size].ljust(_HEADER.size, b"\0")
    sequence, session, opcode, size, _, _, offset = _HEADER.unpack(header)
    data = payload[_HEADER.size : _HEADER.size + min(size, DATA_MAX)]
    return Request(sequence, session, opcode, size, offset, data.ljust(min(size, DATA_MAX), b"\0"))


def pack(reply: Reply) -> bytes:
    """The payload; the codec fills it up with zeros, and MAVLink 2 cuts them again."""
    header = _HEADER.pack(
        reply.sequence & 0xFFFF,
        reply.session,
        reply.opcode,
        len(reply.data),
        reply.req_opcode,
        reply.burst_complete,
        reply.offset,
    )
    return header + reply.data


NAKS: Final = {
    StoreFault.NOT_FOUND: bytes((Nak.FILE_NOT_FOUND,)),
    StoreFault.EXISTS: bytes((Nak.FILE_EXISTS,)),
    StoreFault.PROTECTED: bytes((Nak.FILE_PROTECTED,)),
    StoreFault.NO_SPACE: bytes((Nak.FAIL_ERRNO, 28)),
    StoreFault.WRONG_KIND: bytes((Nak.FAIL_ERRNO, 21)),
    StoreFault.NOT_EMPTY: bytes((Nak.FAIL_ERRNO, 39)),
    StoreFault.BAD_PATH: bytes((Nak.FAIL_ERRNO, 22)),
    StoreFault.BROKEN: bytes((Nak.FAIL_ERRNO, 5)),
}
"""The data of a NAK: Linux's errno where MAVLink has no word of its own."""


class FtpRefusedError(Exception):
    """A request gets this NAK."""

    def __init__(self, nak: Nak) -> None:
        super().__init__(nak.name)
        self.nak: Final = nak


def reason(refusal: FtpRefusedError | StoreError) -> bytes:
    """The data of the NAK."""
    return bytes((refusal.nak,)) if isinstance(refusal, FtpRefusedError) else NAKS[refusal.fault]
