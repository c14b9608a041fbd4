"""Frames <-> messages, by `struct` tables that are derived from the dialect once."""

from __future__ import annotations

import struct
from collections.abc import Callable
from operator import itemgetter
from typing import TypeAlias

import msgspec

from gcs.wire.crc import CRC_EXTRA, mcrf4xx
from gcs.wire.dialect import MESSAGES, TYPE_CODES, FieldDef, MessageDef
from gcs.wire.frame import MAGIC_V1, MAGIC_V2, Frame
from gcs.wire.messages import CLASSES, Message

Scalar: TypeAlias = int | float | str
Value: TypeAlias = Scalar | tuple[Scalar, ...]
"""A field's value: a string for `char`, a tuple for any other array."""


class EncodeError(ValueError):
    """A message of ours does not fit its wire format: our own bug, or unchecked input."""


class _Layout:
    """How one message's payload is packed and unpacked."""

    __slots__ = ("_cuts", "_struct", "definition", "plain", "size")

    def __init__(self, definition: MessageDef) -> None:
        self.definition = definition
        self._struct = struct.Struct("<" + "".join(_format(f) for f in definition.fields))
        self.size = self._struct.size
        self.plain = all(f.type != "char" and not f.array_length for f in definition.fields)
        """Whether what `struct` gives are the field values already."""
        self._cuts = _cuts(definition.fields)

    def unpack(self, payload: bytes) -> tuple[Value, ...]:
        """Field values in wire order.  A short payload is extended with zeros (MAVLink 2)."""
        values = self._struct.unpack_from(payload.ljust(self.size, b"\0"))
        return values if self.plain else tuple([cut(values) for cut in self._cuts])

    def pack(self, values: tuple[Value, ...]) -> bytes:
        """Raises EncodeError, which names the field."""
        try:
            flat = values if self.plain else self._flat(values)
            return self._struct.pack(*flat)
        except (struct.error, OverflowError, TypeError) as error:
            raise EncodeError(f"{self.definition.name}: {self._blame(values)}: {error}") from error

    def _flat(self, values: tuple[Value, ...]) -> list[Scalar | bytes]:
        flat: list[Scalar | bytes] = []
        for field, value in zip(self.definition.fields, values, strict=True):
            if isinstance(value, str):
                flat.append(_encode_text(self.definition, field, value))
            elif isinstance(value, tuple):
                if len(value) != field.array_length:
                    raise EncodeError(
                        f"{self.definition.name}.{field.name}: "
                        f"{len(value)} elements instead of {field.array_length}"
                    )
                flat += value
            else:
                flat.append(value)
        return flat

    def _blame(self, values: tuple[Value, ...]) -> str:
        """The first field that does not pack by itself."""
        for field, value in zip(self.definition.fields, values, strict=True):
            items = value if isinstance(value, tuple) else (value,)
            try:
                if field.type != "char":
                    struct.pack(f"<{len(items)}{TYPE_CODES[field.type]}", *items)
            except (struct.error, OverflowError):
                return f"{field.name} = {value!r}"
        return "wrong type of a value"


def _format(field: FieldDef) -> str:
    if field.type == "char":
        return f"{max(1, field.array_length)}s"
    return f"{field.array_length or ''}{TYPE_CODES[field.type]}"


_Flat: TypeAlias = "tuple[int | float | bytes, ...]"


def _cuts(fields: tuple[FieldDef, ...]) -> list[Callable[[_Flat], Value]]:
    """One function a field that takes its value from what `struct` unpacked."""
    cuts: list[Callable[[_Flat], Value]] = []
    at = 0
    for field in fields:
        if field.type == "char":
            cuts.append(_text_cut(at))
            at += 1
        elif field.array_length:
            cuts.append(itemgetter(slice(at, at + field.array_length)))
            at += field.array_length
        else:
            cuts.append(itemgetter(at))
            at += 1
    return cuts


def _text_cut(at: int) -> Callable[[_Flat], Value]:
    def cut(values: _Flat) -> Value:
        raw = values[at]
        assert isinstance(raw, bytes)
        return raw.partition(b"\0")[0].decode("utf-8", "replace")

    return cut


def _encode_text(definition: MessageDef, field: FieldDef, text: str) -> bytes:
    raw = text.encode()
    if len(raw) > max(1, field.array_length):
        raise EncodeError(
            f"{definition.name}.{field.name}: {text!r} is longer than {field.array_length} bytes"
        )
    return raw


_LAYOUTS: dict[int, _Layout] = {msgid: _Layout(MESSAGES[msgid]) for msgid in CLASSES}
_TYPED = {msgid: (cls, _LAYOUTS[msgid]) for msgid, cls in CLASSES.items()}


def _layout(msgid: int) -> _Layout | None:
    """Layouts of messages without a class are made when they are first asked for."""
    layout = _LAYOUTS.get(msgid)
    if layout is None and msgid in MESSAGES:
        layout = _LAYOUTS[msgid] = _Layout(MESSAGES[msgid])
    return layout


def decode(frame: Frame) -> Message | None:
    """The message in a frame, None if it is of a kind that has no class."""
    typed = _TYPED.get(frame.msgid)
    if typed is None:
        return None
    cls, layout = typed
    return cls(*layout.unpack(frame.payload))


def decode_fields(frame: Frame) -> dict[str, Value] | None:
    """Field values by name in the order people read them, None if the dialect lacks the message."""
    layout = _layout(frame.msgid)
    if layout is None:
        return None
    names = (field.name for field in layout.definition.fields)
    values = dict(zip(names, layout.unpack(frame.payload), strict=True))
    return {name: values[name] for name in layout.definition.declared}


def encode(message: Message) -> bytes:
    """The whole payload, zeros and extensions included.  Raises EncodeError."""
    return _LAYOUTS[message.MSG_ID].pack(msgspec.structs.astuple(message))


def encode_fields(msgid: int, fields: dict[str, Value]) -> bytes:
    """The whole payload of any message of the dialect; fields that are left out are zero.

    Raises EncodeError, also for a message or a field that does not exist.
    """
    layout = _layout(msgid)
    if layout is None:
        raise EncodeError(f"no message {msgid} in the dialect")
    known = {field.name for field in layout.definition.fields}
    if strange := fields.keys() - known:
        raise EncodeError(f"{layout.definition.name} has no field {', '.join(sorted(strange))}")
    zeros = layout.unpack(b"")
    pairs = zip(layout.definition.fields, zeros, strict=True)
    return layout.pack(tuple(fields.get(field.name, zero) for field, zero in pairs))


# Without the magic, as the checksum wants them: length, (flags,) seq, sysid, compid, msgid.
_V1_HEADER = struct.Struct("<BBBBB")
_V2_HEADER = struct.Struct("<BBBBBBHB")
_CHECKSUM = struct.Struct("<H")
_MAGIC = (bytes((MAGIC_V2,)), bytes((MAGIC_V1,)))


class FrameWriter:
    """Frames from one component on one link: it owns the sequence number."""

    __slots__ = ("_mavlink1", "compid", "seq", "sysid")

    def __init__(self, sysid: int, compid: int, mavlink1: bool = False) -> None:
        self.sysid = sysid
        self.compid = compid
        self.seq = 0
        """Of the next frame."""
        self._mavlink1 = mavlink1

    def write(self, message: Message) -> bytes:
        """One frame.  Raises EncodeError."""
        return self.write_payload(message.MSG_ID, encode(message))

    def write_payload(self, msgid: int, payload: bytes) -> bytes:
        """One frame around a payload of the message's full length, which is cut as the version of
        MAVLink asks.  Raises EncodeError for a message that the version cannot carry.
        """
        body = self._body_v1(msgid, payload) if self._mavlink1 else self._body_v2(msgid, payload)
        self.seq = (self.seq + 1) & 0xFF
        checksum = mcrf4xx(body + CRC_EXTRA[msgid])
        return _MAGIC[self._mavlink1] + body + _CHECKSUM.pack(checksum)

    def _body_v2(self, msgid: int, payload: bytes) -> bytes:
        """MAVLink 2 cuts trailing zeros, but for the first byte."""
        payload = payload.rstrip(b"\0") or payload[:1]
        ids = (self.seq, self.sysid, self.compid, msgid & 0xFFFF, msgid >> 16)
        return _V2_HEADER.pack(len(payload), 0, 0, *ids) + payload

    def _body_v1(self, msgid: int, payload: bytes) -> bytes:
        """MAVLink 1 carries the base fields of messages up to id 255."""
        if msgid > 0xFF:
            raise EncodeError(f"{MESSAGES[msgid].name} does not exist in MAVLink 1")
        payload = payload[: MESSAGES[msgid].min_len]
        return _V1_HEADER.pack(len(payload), self.seq, self.sysid, self.compid, msgid) + payload
