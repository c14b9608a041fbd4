"""The MAVLink dialect as tables: every message and enum.

Made at import from `pymavlink.dialects.v20.all` (a superset of common, ardupilotmega and
development) and from `supplement.py`.  The import takes about 0.1 s, so only what talks to a
vehicle or reads a record imports this.
"""

from __future__ import annotations

import struct
from types import MappingProxyType
from typing import Any, NamedTuple, TypeAlias

from pymavlink.dialects.v20 import all as pymavlink_dialect

from gcs.wire import supplement

TYPE_CODES = MappingProxyType(
    {
        "char": "c",
        "uint8": "B",
        "int8": "b",
        "uint16": "H",
        "int16": "h",
        "uint32": "I",
        "int32": "i",
        "uint64": "Q",
        "int64": "q",
        "float": "f",
        "double": "d",
    }
)
"""Field type -> `struct` code.  All fields are little-endian and packed."""

_SIZES = {type_: struct.calcsize("<" + code) for type_, code in TYPE_CODES.items()}


class FieldDef(NamedTuple):
    """One field of a message, at its place on the wire."""

    name: str
    type: str
    """A key of `TYPE_CODES`."""
    array_length: int
    """Number of elements, 0 for a scalar.  A `char` array is a string."""
    offset: int
    """Bytes from the start of the payload."""
    extension: bool
    """Whether it exists in MAVLink 2 only; then it is not part of the CRC extra."""
    enum: str
    """Name of the enum of its values, or ""."""
    units: str
    """As the dialect writes them ("cm/s", "degE7"), or ""."""

    @property
    def size(self) -> int:
        """Bytes on the wire."""
        return _SIZES[self.type] * (self.array_length or 1)


class MessageDef(NamedTuple):
    """One message of the dialect."""

    msgid: int
    name: str
    crc_extra: int
    min_len: int
    """Bytes without extensions, as in MAVLink 1."""
    max_len: int
    """Bytes with all extensions."""
    fields: tuple[FieldDef, ...]
    """In wire order."""


class EnumEntry(NamedTuple):
    value: int
    name: str
    """Full name, such as MAV_RESULT_ACCEPTED."""


class EnumDef(NamedTuple):
    name: str
    entries: tuple[EnumEntry, ...]


_Row: TypeAlias = tuple[str, str, int, bool, str, str]
"""A field without its offset: name, type, array length, extension, enum, units."""


def _lay_out(msgid: int, name: str, crc_extra: int, rows: list[_Row]) -> MessageDef:
    """The message whose fields are these, in wire order."""
    fields: list[FieldDef] = []
    offset = min_len = 0
    for field_name, type_, array_length, extension, enum, units in rows:
        field = FieldDef(field_name, type_, array_length, offset, extension, enum, units)
        fields.append(field)
        offset += field.size
        if not extension:
            min_len = offset
    return MessageDef(msgid, name, crc_extra, min_len, offset, tuple(fields))


def _from_pymavlink(message: Any) -> MessageDef:
    """One generated class of pymavlink.  `Any` ends here: the dialect module is untyped.

    A class's `array_lengths` pairs with `ordered_fieldnames` (wire order), its `fieldtypes` with
    `fieldnames` (declared order).  Extensions are the parameters of `__init__` with a default.
    """
    init = message.__init__
    base_count = init.__code__.co_argcount - 1 - len(init.__defaults__ or ())
    types = dict(zip(message.fieldnames, message.fieldtypes, strict=True))
    wire_order = zip(message.ordered_fieldnames, message.array_lengths, strict=True)
    rows = [
        (
            name,
            types[name].removesuffix("_t"),
            array_length,
            position >= base_count,
            message.fieldenums_by_name.get(name, ""),
            message.fieldunits_by_name.get(name, ""),
        )
        for position, (name, array_length) in enumerate(wire_order)
    ]
    return _lay_out(message.id, message.msgname, message.crc_extra, rows)


def _from_supplement(
    message: supplement.SupplementMessage, shorter: MessageDef | None
) -> MessageDef:
    """`shorter` is pymavlink's version of the message; its enums and units are kept."""
    known = {field.name: field for field in shorter.fields} if shorter else {}
    rows: list[_Row] = []
    for field in message.fields:
        twin = known.get(field.name)
        meaning = (twin.enum, twin.units) if twin else ("", "")
        rows.append((field.name, field.type, field.array_length, field.extension, *meaning))
    return _lay_out(message.msgid, message.name, message.crc_extra, rows)


def _load_messages() -> dict[int, MessageDef]:
    found: dict[int, MessageDef] = {}
    for message in pymavlink_dialect.mavlink_map.values():
        definition = _from_pymavlink(message)
        found[definition.msgid] = definition
    for extra in supplement.messages():
        shorter = found.get(extra.msgid)
        definition = _from_supplement(extra, shorter)
        if shorter is None or definition.max_len > shorter.max_len:
            found[extra.msgid] = definition
    return dict(sorted(found.items()))


def _load_enums() -> dict[str, EnumDef]:
    found: dict[str, EnumDef] = {}
    for enum_name, table in pymavlink_dialect.enums.items():
        names = {
            int(value): str(entry.name)
            for value, entry in table.items()
            if not entry.name.endswith("_ENUM_END")
        }
        names = supplement.ENTRIES.get(enum_name, {}) | names
        entries = tuple(EnumEntry(value, names[value]) for value in sorted(names))
        found[enum_name] = EnumDef(enum_name, entries)
    return found


MESSAGES = MappingProxyType(_load_messages())
"""Message id -> definition, in order of id."""

MESSAGES_BY_NAME = MappingProxyType({message.name: message for message in MESSAGES.values()})
"""Message name -> definition."""

ENUMS = MappingProxyType(_load_enums())
"""Enum name -> definition, entries in order of value."""
