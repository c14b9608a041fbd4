"""Any frame of the dialect as field names and values, also of messages that have no class here."""

from __future__ import annotations

import struct
from functools import cache

from gcs.wire.dialect import MESSAGES, TYPE_CODES, FieldDef
from gcs.wire.frame import Frame

Plain = int | float | str
FieldValue = Plain | list[Plain] | None


def fields_of(frame: Frame) -> dict[str, FieldValue]:
    """In wire order, with the dialect's names and units; empty for a message it does not know.

    A `char` array is text up to its first NUL, any other array a list.  What MAVLink 2 cut off,
    and extensions that MAVLink 1 has not, are zero.
    """
    definition = MESSAGES.get(frame.msgid)
    if definition is None:
        return {}
    payload = frame.payload.ljust(definition.max_len, b"\0")
    return {field.name: _value(field, payload) for field in definition.fields}


def _value(field: FieldDef, payload: bytes) -> FieldValue:
    if field.type == "char":
        raw = payload[field.offset : field.offset + field.size]
        return raw.partition(b"\0")[0].decode("utf-8", "replace")
    values: tuple[int | float, ...] = _layout(field).unpack_from(payload, field.offset)
    return list(values) if field.array_length else values[0]


@cache
def _layout(field: FieldDef) -> struct.Struct:
    return struct.Struct(f"<{field.array_length or 1}{TYPE_CODES[field.type]}")
