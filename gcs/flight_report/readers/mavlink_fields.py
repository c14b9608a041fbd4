"""Named fields straight from the bytes of a recorded MAVLink message.

It is a frame header, then the payload in wire order, zero-extended (`gcs/record/ros1.py`), so a
field lies at the offset that the dialect gives it.
"""

from __future__ import annotations

import struct
from collections.abc import Callable
from functools import cache
from typing import TypeAlias

from gcs.flight_report.facts import Fact
from gcs.record.ros1 import FRAME_BYTES
from gcs.wire.dialect import MESSAGES, TYPE_CODES, FieldDef, MessageDef
from gcs.wire.text import clean

Number: TypeAlias = "int | float"
ReadNumbers: TypeAlias = Callable[[bytes], tuple[Number, ...]]
"""The fields of a recorded message; an array gives as many numbers as it has elements.

Raises struct.error where the message is too short for them."""

Read: TypeAlias = Callable[[bytes], "list[Fact]"]


@cache
def _by_name() -> dict[str, MessageDef]:
    return {definition.name: definition for definition in MESSAGES.values()}


def _field(message: str, name: str) -> FieldDef:
    return next(field for field in _by_name()[message].fields if field.name == name)


@cache
def numbers(message: str, *names: str) -> ReadNumbers:
    """Reads these fields of that message, in this order.  Raises KeyError, StopIteration."""
    fields = [_field(message, name) for name in names]
    parts = [
        (
            struct.Struct(f"<{field.array_length or 1}{TYPE_CODES[field.type]}").unpack_from,
            FRAME_BYTES + field.offset,
        )
        for field in fields
    ]

    def read(data: bytes) -> tuple[Number, ...]:
        found: list[Number] = []
        for unpack, offset in parts:
            found += unpack(data, offset)
        return tuple(found)

    return read


def text(message: str, name: str, data: bytes) -> str:
    """A `char` array, up to its first NUL; what is no UTF-8, or a control, becomes replacement
    characters."""
    field = _field(message, name)
    start = FRAME_BYTES + field.offset
    raw = data[start : start + field.size]
    return clean(raw.partition(b"\0")[0].decode("utf-8", "replace"))
