"""Frames <-> messages.  `struct` packs and unpacks payloads, with layouts from the dialect."""

from __future__ import annotations

import struct
from collections.abc import Callable
from operator import itemgetter
from typing import TypeAlias

import msgspec

from gcs.wire.crc import CRC_EXTRA, mcrf4xx
from gcs.wire.dialect import MESSAGES, TYPE_CODES, FieldDef, MessageDef
from gcs.wire.frame import MAGIC_V2, Frame
from gcs.wire.messages import CLASSES, Message
from gcs.wire.text import clean

Scalar: TypeAlias = int | float | str
Value: TypeAlias = Scalar | tuple[Scalar, ...]
"""A field's value: a string for `char`, a tuple for any other array."""
_Unpacked: TypeAlias = "tuple[int | float | bytes, ...]"
"""What `struct` gives: an array is as many values as it has elements, a string is bytes."""
_Getter: TypeAlias = "Callable[[_Unpacked], Value]"
"""Takes the value of one field out of what `struct` unpacked."""


class EncodeError(ValueError):
    """A message does not fit its wire format: a bug here, or input that was not checked."""


class Layout:
    """How the payload of one message class is packed.

    It has the fields of the class.  A newer dialect may know more extensions: those stand last,
    so they are ignored on decoding and left out (which means zero) on encoding.
    """

    __slots__ = ("_fields", "_is_plain", "_name", "_pack", "decode")

    def __init__(self, cls: type[Message], definition: MessageDef) -> None:
        self._name = definition.name
        self._fields = definition.fields[: len(cls.__struct_fields__)]
        packed = struct.Struct("<" + "".join(_format(field) for field in self._fields))
        self._pack = packed.pack
        # Without text and arrays, `struct` takes and gives the field values as they are.
        self._is_plain = all(f.type != "char" and not f.array_length for f in self._fields)
        getters = None if self._is_plain else _getters(self._fields)
        self.decode = _decoder(cls, packed, getters)
        """Payload -> message.  A short payload is extended with zeros, which MAVLink 2 cuts."""

    def encode(self, message: Message) -> bytes:
        """Raises EncodeError, which names the field."""
        values: tuple[Value, ...] = msgspec.structs.astuple(message)
        try:
            return self._pack(*(values if self._is_plain else self._flat(values)))
        except (struct.error, OverflowError, TypeError) as error:
            raise EncodeError(f"{self._name}: {self._misfit(values)}: {error}") from error

    def _flat(self, values: tuple[Value, ...]) -> list[Scalar | bytes]:
        flat: list[Scalar | bytes] = []
        for field, value in zip(self._fields, values, strict=True):
            if isinstance(value, str):
                flat.append(self._encode_text(field, value))
            elif isinstance(value, tuple):
                if len(value) != field.array_length:
                    raise EncodeError(
                        f"{self._name}.{field.name}: "
                        f"{len(value)} elements instead of {field.array_length}"
                    )
                flat += value
            else:
                flat.append(value)
        return flat

    def _encode_text(self, field: FieldDef, text: str) -> bytes:
        raw = text.encode()
        size = max(1, field.array_length)
        if len(raw) > size:
            raise EncodeError(f"{self._name}.{field.name}: {text!r} is longer than {size} bytes")
        return raw

    def _misfit(self, values: tuple[Value, ...]) -> str:
        """The first field whose value does not pack by itself."""
        for field, value in zip(self._fields, values, strict=True):
            items = value if isinstance(value, tuple) else (value,)
            try:
                if field.type != "char":
                    struct.pack(f"<{len(items)}{TYPE_CODES[field.type]}", *items)
            except (struct.error, OverflowError):
                return f"{field.name} = {value!r}"
        return "wrong type of a value"


def _decoder(
    cls: type[Message], packed: struct.Struct, getters: list[_Getter] | None
) -> Callable[[bytes], Message]:
    """A closure, which is faster than a method: every received message passes through it."""
    unpack, size = packed.unpack_from, packed.size
    if getters is None:
        return lambda payload: cls(*unpack(payload.ljust(size, b"\0")))

    def decode(payload: bytes) -> Message:
        values = unpack(payload.ljust(size, b"\0"))
        return cls(*[get(values) for get in getters])

    return decode


def _format(field: FieldDef) -> str:
    if field.type == "char":
        return f"{max(1, field.array_length)}s"
    return f"{field.array_length or ''}{TYPE_CODES[field.type]}"


def _getters(fields: tuple[FieldDef, ...]) -> list[_Getter]:
    """One for each field."""
    getters: list[_Getter] = []
    at = 0
    for field in fields:
        if field.type == "char":
            getters.append(_text_getter(at))
            at += 1
        elif field.array_length:
            getters.append(itemgetter(slice(at, at + field.array_length)))
            at += field.array_length
        else:
            getters.append(itemgetter(at))
            at += 1
    return getters


def _text_getter(at: int) -> Callable[[_Unpacked], str]:
    """Text ends at its first NUL; bytes that are not UTF-8 become replacement characters, and so
    do controls (`clean`): the frame keeps them."""

    def get(values: _Unpacked) -> str:
        raw = values[at]
        assert isinstance(raw, bytes)
        return clean(raw.partition(b"\0")[0].decode("utf-8", "replace"))

    return get


_LAYOUTS: dict[int, Layout] = {
    msgid: Layout(cls, MESSAGES[msgid]) for msgid, cls in CLASSES.items()
}


def decode(frame: Frame) -> Message | None:
    """The message in a frame, None if there is no class for it."""
    layout = _LAYOUTS.get(frame.msgid)
    return None if layout is None else layout.decode(frame.payload)


def encode(message: Message) -> bytes:
    """The whole payload with trailing zeros and extensions.  Raises EncodeError."""
    return _LAYOUTS[message.MSG_ID].encode(message)


_MAGIC = bytes((MAGIC_V2,))
# The header without its magic, which the checksum leaves out:
# length, two bytes of flags, seq, sysid, compid, msgid (3 bytes).
_HEADER = struct.Struct("<BBBBBBHB")
_CHECKSUM = struct.Struct("<H")


class FrameWriter:
    """Makes the MAVLink 2 frames that one component sends on one link, and numbers them."""

    __slots__ = ("compid", "seq", "sysid")

    def __init__(self, sysid: int, compid: int) -> None:
        self.sysid = sysid
        self.compid = compid
        self.seq = 0
        """Sequence number of the next frame, 0 to 255."""

    def write(self, message: Message) -> bytes:
        """The message as one frame.  Raises EncodeError."""
        return self.write_payload(message.MSG_ID, encode(message))

    def write_payload(self, msgid: int, payload: bytes) -> bytes:
        """One frame.  Trailing zeros of the payload are cut, but not its first byte (MAVLink 2)."""
        payload = payload.rstrip(b"\0") or payload[:1]
        ids = (self.seq, self.sysid, self.compid, msgid & 0xFFFF, msgid >> 16)
        body = _HEADER.pack(len(payload), 0, 0, *ids) + payload
        self.seq = (self.seq + 1) & 0xFF
        return _MAGIC + body + _CHECKSUM.pack(mcrf4xx(body + CRC_EXTRA[msgid]))
