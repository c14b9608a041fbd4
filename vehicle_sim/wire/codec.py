"""Messages <-> payloads and whole frames.

A payload is packed by one `struct` derived from the dialect; extensions are always packed and
trailing zeros cut, as MAVLink 2 asks ("Empty-Byte Payload Truncation").  A message that goes to
several channels is packed once and framed for each: what differs is its header.
"""

from __future__ import annotations

import struct
from typing import Final, NamedTuple, cast

from fastcrc.crc16 import mcrf4xx

from vehicle_sim.wire.layouts import CRC_EXTRAS, PACKINGS
from vehicle_sim.wire.messages import IDS, TYPES, Message

STX1: Final = 0xFE
STX2: Final = 0xFD
SIGNED: Final = 0x01  # incompat_flags
NUMBER1_MAX: Final = 0xFF
"""MAVLink 1 has one byte for the message's number."""

_HEADER1: Final = struct.Struct("<BBBBB")
_HEADER2: Final = struct.Struct("<BBBBBB3s")
_CHECKSUM: Final = struct.Struct("<H")


Value = float | bytes | tuple[float, ...]


class Codec:
    """One message's way to its payload and back."""

    __slots__ = (
        "_arrays",
        "_id_bytes",
        "_pack",
        "_struct",
        "base_size",
        "crc_extra",
        "kind",
        "number",
        "size",
    )

    def __init__(self, number: int) -> None:
        packing = PACKINGS[number]
        self.number: Final = number
        self.kind = TYPES[number]
        self._struct: Final = struct.Struct(packing.form)
        self._pack: Final = self._struct.pack
        self.size: Final = self._struct.size
        self.base_size: Final = packing.base_size
        self.crc_extra: Final = bytes((CRC_EXTRAS[number],))
        self._id_bytes: Final = number.to_bytes(3, "little")
        self._arrays: Final = packing.arrays

    def payload(self, message: Message) -> bytes:
        """Packed, trailing zeros cut, at least one byte.

        Raises `struct.error` or OverflowError for a value that its field cannot hold.
        """
        packed = self._pack(*(_spread(message, self._arrays) if self._arrays else message))
        return packed.rstrip(b"\0") or b"\0"

    def frame(
        self, payload: bytes, sequence: int, system: int, component: int, flags: int = 0
    ) -> bytes:
        """MAVLink 2, around a payload of `payload()`; `flags` are its incompat_flags."""
        body = (
            _HEADER2.pack(len(payload), flags, 0, sequence, system, component, self._id_bytes)
            + payload
        )
        return b"\xfd" + body + _CHECKSUM.pack(mcrf4xx(body + self.crc_extra))

    def frame1(self, payload: bytes, sequence: int, system: int, component: int) -> bytes:
        """MAVLink 1: the base fields at full length; for numbers up to `NUMBER1_MAX`."""
        size = self.base_size
        body = _HEADER1.pack(size, sequence, system, component, self.number) + payload[:size].ljust(
            size, b"\0"
        )
        return b"\xfe" + body + _CHECKSUM.pack(mcrf4xx(body + self.crc_extra))

    def message(self, payload: bytes) -> Message:
        """Of a payload that may be cut or longer than this dialect knows."""
        values = self._struct.unpack(payload[: self.size].ljust(self.size, b"\0"))
        return self.kind._make(_gather(values, self._arrays) if self._arrays else values)


def _spread(message: Message, arrays: tuple[tuple[int, int], ...]) -> list[Value]:
    spread: list[Value] = [*cast(tuple[Value, ...], message)]
    # From the end, so that the positions of those before stay right.
    for index, _ in reversed(arrays):
        spread[index : index + 1] = cast(tuple[float, ...], spread[index])
    return spread


def _gather(values: tuple[float | bytes, ...], arrays: tuple[tuple[int, int], ...]) -> list[Value]:
    gathered: list[Value] = list(values)
    for index, count in arrays:
        gathered[index : index + count] = [
            cast(tuple[float, ...], tuple(gathered[index : index + count]))
        ]
    return gathered


CODECS: Final = {number: Codec(number) for number in TYPES}
BY_TYPE: Final = {kind: CODECS[number] for kind, number in IDS.items()}


def encode(message: Message, sequence: int, system: int, component: int) -> bytes:
    """One unsigned MAVLink 2 frame."""
    codec = BY_TYPE[type(message)]
    return codec.frame(codec.payload(message), sequence, system, component)


class MavlinkFrame(NamedTuple):
    """One frame whose checksum was right."""

    version: int  # 1 or 2
    sequence: int
    system: int
    component: int
    number: int
    payload: bytes
    signed: bool
    raw: bytes  # as it came, from the start byte to the end of a signature

    def message(self) -> Message | None:
        """None for a message that this vehicle has no use for."""
        codec = CODECS.get(self.number)
        return codec.message(self.payload) if codec is not None else None
