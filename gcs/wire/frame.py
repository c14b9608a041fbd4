"""Bytes -> frames: what of a datagram or a stream is MAVLink, and what is left over.

A frame counts as found when its checksum is right; good frames are looked for first, so a stray
magic byte swallows nothing.  Only what lies between good frames can be a frame of a message that
the dialect lacks, whose checksum cannot be known; the rest is `Garbage`, with a reason.
"""

from __future__ import annotations

import re
import struct
from enum import StrEnum
from typing import NamedTuple, TypeAlias

from gcs.wire.crc import CRC_EXTRA, mcrf4xx
from gcs.wire.dialect import MESSAGES

MAGIC_V1 = 0xFE
MAGIC_V2 = 0xFD
SIGNED = 0x01
"""Bit of `incompat_flags`.  A frame with any other bit set must be dropped (MAVLink 2 spec)."""
HEADER_V1 = 6
HEADER_V2 = 10
CHECKSUM_SIZE = 2
SIGNATURE_SIZE = 13
MAX_FRAME = HEADER_V2 + 255 + CHECKSUM_SIZE + SIGNATURE_SIZE
MAX_DATAGRAM = 16_384
"""A longer datagram is garbage unseen: nobody sends one, and searching it would take time."""

_V1_START = struct.Struct("<BBBBBB").unpack_from  # magic, length, seq, sysid, compid, msgid
_V2_START = struct.Struct("<BBBBBBBI").unpack_from  # magic, length, flags, flags, then the same
# Frame(...) checks and names its arguments one by one, which costs as much as the checksum.
_new = tuple.__new__
_MAGIC = re.compile(b"[\xfd\xfe]")
_MAGICS = b"\xfd\xfe"
_TEXT = re.compile(rb"[\t\n\r\x20-\x7e]+\Z")


class Frame(NamedTuple):
    """One MAVLink frame as it was on the wire."""

    raw: bytes
    """Magic to checksum or signature, unchanged."""
    magic: int
    incompat_flags: int
    """0 in MAVLink 1, as is `compat_flags`."""
    compat_flags: int
    seq: int
    sysid: int
    compid: int
    msgid: int
    payload: bytes
    """As it came: MAVLink 2 cuts trailing zeros, a newer sender may send more than we know."""
    signature: bytes
    """Link id, timestamp and signature (13 bytes), or empty."""
    known: bool
    """False: the dialect lacks this message, so the checksum could not be checked."""

    @property
    def name(self) -> str:
        """The message's name, or UNKNOWN_<id>."""
        message = MESSAGES.get(self.msgid)
        return message.name if message else f"UNKNOWN_{self.msgid}"


class Reason(StrEnum):
    """Why bytes are no frame."""

    CRC = "crc"
    TRUNCATED = "truncated"
    INCOMPAT = "incompat"
    OVERSIZE = "oversize"
    TEXT = "text"
    GARBAGE = "garbage"


class Garbage(NamedTuple):
    """A run of bytes that were no frame."""

    raw: bytes
    reason: Reason


Item: TypeAlias = Frame | Garbage


def split(data: bytes) -> list[Item]:
    """Everything in one datagram, in order; every byte of it is in exactly one item."""
    if len(data) > MAX_DATAGRAM:
        return [Garbage(data, Reason.OVERSIZE)]
    if data:
        frame = _frame_at(data, 0, known=True)
        if frame is not None and len(frame.raw) == len(data):
            return [frame]
    items, _ = _scan(data, whole=True)
    return items


class StreamSplitter:
    """The same for a byte stream (TCP, serial), where a frame may come in pieces.

    Holds back at most what could still become a frame, so the buffer stays under `MAX_FRAME`.
    """

    __slots__ = ("_rest",)

    def __init__(self) -> None:
        self._rest = b""

    @property
    def waiting(self) -> int:
        """Bytes that are held back."""
        return len(self._rest)

    def feed(self, data: bytes) -> list[Item]:
        """Take the next bytes; give what they complete."""
        data = self._rest + data
        items, taken = _scan(data, whole=False)
        self._rest = data[taken:]
        return items

    def close(self) -> list[Item]:
        """The stream ended: give what was held back, as far as it goes."""
        data, self._rest = self._rest, b""
        return split(data)


def extended(frame: Frame) -> bytes:
    """The payload with its zeros restored: the dialect's full length, plus any bytes beyond it."""
    message = MESSAGES.get(frame.msgid)
    return frame.payload.ljust(message.max_len, b"\0") if message else frame.payload


def _scan(data: bytes, whole: bool) -> tuple[list[Item], int]:
    """Items found, and how many bytes they take: all if `whole`, else up to what may go on."""
    items: list[Item] = []
    size = len(data)
    at = left = 0
    while at < size:
        frame = _frame_at(data, at, known=True)
        if frame is None:
            magic = _MAGIC.search(data, at + 1)
            at = magic.start() if magic else size
            continue
        if left < at:
            items += _without_known(data[left:at], closed=True)[0]
        items.append(frame)
        at = left = at + len(frame.raw)
    if left == size:
        return items, size
    more, taken = _without_known(data[left:], closed=whole)
    return items + more, left + taken


def _frame_at(data: bytes, at: int, known: bool) -> Frame | None:
    """The frame that starts at `at`, if there is one: with a right checksum if the message is to
    be `known`, else of a message that the dialect lacks.
    """
    room = len(data) - at
    magic = data[at]
    if magic == MAGIC_V2 and room >= HEADER_V2 + CHECKSUM_SIZE:
        _, length, incompat, compat, seq, sysid, compid, low = _V2_START(data, at)
        msgid = low & 0xFFFFFF
        start = at + HEADER_V2
    elif magic == MAGIC_V1 and room >= HEADER_V1 + CHECKSUM_SIZE:
        _, length, seq, sysid, compid, msgid = _V1_START(data, at)
        incompat = compat = 0
        start = at + HEADER_V1
    else:
        return None
    stop = start + length
    end = sealed = stop + CHECKSUM_SIZE
    if incompat:
        if incompat != SIGNED:
            return None
        end += SIGNATURE_SIZE
    if end > len(data):
        return None
    crc_extra = CRC_EXTRA.get(msgid)
    if crc_extra is None:
        if known:
            return None
    elif not known or mcrf4xx(data[at + 1 : stop] + crc_extra) != data[stop] | data[stop + 1] << 8:
        return None
    header = (magic, incompat, compat, seq, sysid, compid, msgid)
    return _new(Frame, (data[at:end], *header, data[start:stop], data[sealed:end], known))


def _without_known(run: bytes, closed: bool) -> tuple[list[Item], int]:
    """Items in a run of bytes that holds no frame of a known message, and how many they take.

    A frame of an unknown message is believed if it starts where the last one ended and ends where
    the run does or where another magic stands.  A run that is not `closed` may go on.
    """
    items: list[Item] = []
    at = 0
    while at < len(run) and (frame := _frame_at(run, at, known=False)) is not None:
        end = at + len(frame.raw)
        believed = closed if end == len(run) else run[end] in _MAGICS
        if not believed:
            break
        items.append(frame)
        at = end
    stop = len(run) if closed else _unfinished_from(run, at)
    if at < stop:
        items.append(Garbage(run[at:stop], _why_not(run[at:stop])))
    return items, stop


def _unfinished_from(run: bytes, at: int) -> int:
    """Where the first frame starts that the next bytes could complete or confirm."""
    for magic in _MAGIC.finditer(run, at):
        start = magic.start()
        length = _length_at(run, start)
        if length is None or start + length > len(run):
            return start
        if start + length == len(run) and _frame_at(run, start, known=False):
            return start
    return len(run)


def _length_at(run: bytes, at: int) -> int | None:
    """The length of the frame that would start at `at`: None = not to be told yet, 0 = none can."""
    header = run[at : at + 3]
    if len(header) < 3:
        return None
    if header[0] == MAGIC_V1:
        return HEADER_V1 + header[1] + CHECKSUM_SIZE
    if header[2] & ~SIGNED:
        return 0
    signature = SIGNATURE_SIZE if header[2] & SIGNED else 0
    return HEADER_V2 + header[1] + CHECKSUM_SIZE + signature


def _why_not(run: bytes) -> Reason:
    """What is wrong with bytes that are no frame, judged by the first magic among them."""
    magic = _MAGIC.search(run)
    if magic is None:
        return Reason.TEXT if _TEXT.match(run) else Reason.GARBAGE
    length = _length_at(run, magic.start())
    if length == 0:
        return Reason.INCOMPAT
    if length is None or magic.start() + length > len(run):
        return Reason.TRUNCATED
    return Reason.CRC
