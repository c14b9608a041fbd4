"""Bytes -> frames: finds the MAVLink frames in a datagram or a stream.

Frames with a right checksum are found first, so a stray magic byte hides no frame.  The checksum
of a message that the dialect lacks cannot be checked; such a frame is accepted only between good
frames.  All other bytes are `Garbage`, with a reason.
"""

from __future__ import annotations

import re
import struct
from collections.abc import Callable
from enum import StrEnum
from operator import attrgetter
from typing import Final, NamedTuple, TypeAlias

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
"""A longer datagram is garbage and is not searched: no sender makes one, and it would take long."""

_V1_START = struct.Struct("<BBBBBB").unpack_from  # magic, length, seq, sysid, compid, msgid
_V2_START = struct.Struct("<BBBBBBBI").unpack_from  # magic, length, flags, flags, then the same
# Calling Frame(...) costs as much time as the checksum; this does not.
_new = tuple.__new__
_crc_extra = CRC_EXTRA.get
_MAGIC = re.compile(b"[\xfd\xfe]")
_MAGICS = b"\xfd\xfe"
_TEXT = re.compile(rb"[\t\n\r\x20-\x7e]+\Z")


class Frame(NamedTuple):
    """One MAVLink frame as it was on the wire."""

    raw: bytes
    """Magic to checksum or signature, unchanged."""
    seq: int
    sysid: int
    compid: int
    msgid: int
    payload: bytes
    """As received: MAVLink 2 cuts trailing zeros; a newer sender may add fields at the end."""
    signature: bytes
    """13 bytes (link id, timestamp, signature), or empty.  It is not checked."""
    known: bool
    """Whether the dialect has the message.  If not, the checksum could not be checked."""

    @property
    def name(self) -> str:
        """The message's name, or UNKNOWN_<id>."""
        message = MESSAGES.get(self.msgid)
        return message.name if message else f"UNKNOWN_{self.msgid}"


raw_of: Final[Callable[[Frame], bytes]] = attrgetter("raw")
msgid_of: Final[Callable[[Frame], int]] = attrgetter("msgid")
"""For `map`, over frames that came together."""


class Reason(StrEnum):
    """Why bytes are not a frame."""

    CRC = "crc"
    TRUNCATED = "truncated"
    INCOMPAT = "incompat"
    OVERSIZE = "oversize"
    TEXT = "text"
    GARBAGE = "garbage"


class Garbage(NamedTuple):
    """Bytes in a row that are not part of a frame."""

    raw: bytes
    reason: Reason


Item: TypeAlias = Frame | Garbage


def msgid_in(raw: bytes) -> int:
    """Message id of a whole frame, of which nothing else is looked at."""
    return int.from_bytes(raw[7:10], "little") if raw[0] == MAGIC_V2 else raw[5]


def split(data: bytes) -> list[Item]:
    """The frames and garbage of one datagram, in order.  Every byte is in exactly one item."""
    if len(data) > MAX_DATAGRAM:
        return [Garbage(data, Reason.OVERSIZE)]
    frames, end = _known_frames(data)
    if end == len(data):
        return [*frames]
    return [*frames, *_scan(data[end:], whole=True)[0]]


def plain_frames(data: bytes) -> list[Frame]:
    """The frames of `data` where it is made of unsigned MAVLink 2 frames of known messages alone;
    else nothing: `split` tells what it is made of."""
    if len(data) > MAX_DATAGRAM:
        return []
    frames, end = _known_frames(data)
    return frames if end == len(data) else []


def _known_frames(data: bytes) -> tuple[list[Frame], int]:
    """The unsigned MAVLink 2 frames of known messages that `data` begins with, and where they end.

    What nearly every datagram is made of.  One loop without calls: all that is received passes
    through it.
    """
    frames: list[Frame] = []
    size = len(data)
    at = 0
    while at + HEADER_V2 < size:
        magic, length, incompat, _, seq, sysid, compid, low = _V2_START(data, at)
        stop = at + HEADER_V2 + length
        end = stop + CHECKSUM_SIZE
        if magic != MAGIC_V2 or incompat or end > size:
            break
        msgid = low & 0xFFFFFF
        crc_extra = _crc_extra(msgid)
        if crc_extra is None:
            break
        checksum = mcrf4xx(data[at + 1 : stop] + crc_extra)
        if checksum != data[stop] | data[stop + 1] << 8:
            break
        payload = data[at + HEADER_V2 : stop]
        frames.append(_new(Frame, (data[at:end], seq, sysid, compid, msgid, payload, b"", True)))
        at = end
    return frames, at


class StreamSplitter:
    """The same for a byte stream (TCP, serial), where a frame may arrive in pieces.

    Keeps only bytes that may still become a frame, so at most `MAX_FRAME`.
    """

    __slots__ = ("_rest",)

    def __init__(self) -> None:
        self._rest = b""

    @property
    def waiting(self) -> int:
        """Number of bytes kept for the next `feed`."""
        return len(self._rest)

    @property
    def rest(self) -> bytes:
        """The bytes kept for the next `feed`: the beginning of a frame, perhaps."""
        return self._rest

    def go_on_after(self, rest: bytes) -> None:
        """As if all before it had been taken, and these bytes kept."""
        self._rest = rest

    def feed(self, data: bytes) -> list[Item]:
        """Take the next bytes; return the items that they complete."""
        data = self._rest + data
        frames, end = _known_frames(data)
        items, taken = _scan(data[end:], whole=False)
        self._rest = data[end + taken :]
        return [*frames, *items]

    def close(self) -> list[Item]:
        """The stream ended: return what was kept."""
        data, self._rest = self._rest, b""
        return split(data)


def _scan(data: bytes, whole: bool) -> tuple[list[Item], int]:
    """The items, and how many bytes they take: all of them if `whole`, else without the end that
    the next bytes may complete.
    """
    items: list[Item] = []
    size = len(data)
    at = rest = 0
    while at < size:
        frame = frame_at(data, at, known=True)
        if frame is None:
            magic = _MAGIC.search(data, at + 1)
            at = magic.start() if magic else size
            continue
        if rest < at:
            items += _without_known(data[rest:at], closed=True)[0]
        items.append(frame)
        at = rest = at + len(frame.raw)
    if rest == size:
        return items, size
    more, taken = _without_known(data[rest:], closed=whole)
    return items + more, rest + taken


def frame_at(data: bytes, at: int, known: bool) -> Frame | None:
    """The frame that starts at `at`, if there is one: of a message that the dialect has and with
    a right checksum if `known`, else of a message that the dialect lacks.
    """
    room = len(data) - at
    magic = data[at]
    if magic == MAGIC_V2 and room >= HEADER_V2 + CHECKSUM_SIZE:
        _, length, incompat, _, seq, sysid, compid, low = _V2_START(data, at)
        msgid = low & 0xFFFFFF
        start = at + HEADER_V2
    elif magic == MAGIC_V1 and room >= HEADER_V1 + CHECKSUM_SIZE:
        _, length, seq, sysid, compid, msgid = _V1_START(data, at)
        incompat = 0
        start = at + HEADER_V1
    else:
        return None
    stop = start + length
    end = checked = stop + CHECKSUM_SIZE
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
    header = (seq, sysid, compid, msgid)
    return _new(Frame, (data[at:end], *header, data[start:stop], data[checked:end], known))


def _without_known(run: bytes, closed: bool) -> tuple[list[Item], int]:
    """The items of bytes that hold no frame of a known message, and how many bytes they take.

    A frame of an unknown message is accepted if it starts where the one before ended, and ends
    where `run` ends or at another magic byte.  A run that is not `closed` may continue.
    """
    items: list[Item] = []
    at = 0
    while at < len(run) and (frame := frame_at(run, at, known=False)) is not None:
        end = at + len(frame.raw)
        accepted = closed if end == len(run) else run[end] in _MAGICS
        if not accepted:
            break
        items.append(frame)
        at = end
    stop = len(run) if closed else _unfinished_from(run, at)
    if at < stop:
        items.append(Garbage(run[at:stop], why_not(run[at:stop])))
    return items, stop


def _unfinished_from(run: bytes, at: int) -> int:
    """Start of the first frame that the next bytes could complete or confirm, else the end."""
    for magic in _MAGIC.finditer(run, at):
        start = magic.start()
        length = _length_at(run, start)
        if length is None or start + length > len(run):
            return start
        if start + length == len(run) and frame_at(run, start, known=False):
            return start
    return len(run)


def _length_at(run: bytes, at: int) -> int | None:
    """Length of the frame that would start at `at`.  None: too few bytes; 0: no frame can start."""
    header = run[at : at + 3]
    if len(header) < 3:
        return None
    if header[0] == MAGIC_V1:
        return HEADER_V1 + header[1] + CHECKSUM_SIZE
    if header[2] & ~SIGNED:
        return 0
    signature = SIGNATURE_SIZE if header[2] & SIGNED else 0
    return HEADER_V2 + header[1] + CHECKSUM_SIZE + signature


def why_not(run: bytes) -> Reason:
    """Why bytes are no frame, judged by the first magic byte in them."""
    magic = _MAGIC.search(run)
    if magic is None:
        return Reason.TEXT if _TEXT.match(run) else Reason.GARBAGE
    length = _length_at(run, magic.start())
    if length == 0:
        return Reason.INCOMPAT
    if length is None or magic.start() + length > len(run):
        return Reason.TRUNCATED
    return Reason.CRC
