"""Messages that are packed structs, as numpy and ROS 1 both have them, and the schema between.

Logs other than MAVLink are recorded so: one topic a kind of message, the struct as it is, with a
`ros1msg` schema that viewers decode.  Text has a fixed length here, so that a struct has, too.
"""

from __future__ import annotations

import re
from typing import Any

import numpy as np

from gcs.logfile.columns.layout import Records
from gcs.mcap_file.writer import Channel

TIME_FIELD = "time_ns"
"""First field of every table: when it was logged, ns since 1970 or since the start.  In a record it
is the log time and no part of the message.
"""

_TYPES = {
    "u1": "uint8",
    "i1": "int8",
    "u2": "uint16",
    "i2": "int16",
    "u4": "uint32",
    "i4": "int32",
    "u8": "uint64",
    "i8": "int64",
    "f4": "float32",
    "f8": "float64",
    "b1": "bool",
}
_CODES = {name: code for code, name in _TYPES.items()}
LENGTH = "_length_of_"
"""Prefix of the field that stands before a text: its length, as ROS 1 writes strings."""
_FIELD = re.compile(r"(\w+)(?:\[(\d+)\])? (\w+)(?: # text of (\d+) bytes)?\Z")


def channel_of(topic: str, name: str, table: Records) -> Channel:
    """The channel for the rows of a table."""
    return Channel(topic, "ros1", name, "ros1msg", schema_text(table.dtype).encode())


def schema_text(kind: np.dtype[np.void]) -> str:
    """The ros1msg definition of all fields but the time."""
    lines = []
    for name, field in _fields(kind):
        if field.kind == "S":
            lines.append(f"string {name} # text of {field.itemsize} bytes")
            continue
        base, shape = field.subdtype or (field, ())
        count = f"[{shape[0]}]" if shape else ""
        lines.append(f"{_TYPES[base.str[1:]]}{count} {name}")
    return "\n".join(lines) + "\n"


def messages_of(table: Records) -> np.ndarray[Any, np.dtype[np.uint8]]:
    """One message a row."""
    if not any(field.kind == "S" for _, field in _fields(table.dtype)):
        # Then a message is the row without its time.
        rows = table.view(np.uint8).reshape(len(table), table.dtype.itemsize)
        return rows[:, table.dtype[TIME_FIELD].itemsize :]
    made = np.zeros(len(table), _message_type(table.dtype))
    for name, field in _fields(table.dtype):
        made[name] = table[name]
        if field.kind == "S":
            made[LENGTH + name] = field.itemsize
    return made.view(np.uint8).reshape(len(table), made.dtype.itemsize)


def record_type(schema: bytes) -> np.dtype[np.void] | None:
    """The struct of the messages of such a schema; None if it is not one of these."""
    fields: list[Any] = []
    for line in schema.decode("utf-8", "replace").splitlines():
        found = _FIELD.match(line)
        if found is None:
            return None
        kind, count, name, text = found.groups()
        if kind == "string" and text is not None:
            fields += [(LENGTH + name, "<u4"), (name, f"S{text}")]
        elif kind in _CODES:
            code = _CODES[kind]
            fields.append((name, "<" + code, int(count)) if count else (name, "<" + code))
        else:
            return None
    if not fields or len({each[0] for each in fields}) != len(fields):
        return None
    return np.dtype(fields)


def _fields(kind: np.dtype[np.void]) -> list[tuple[str, np.dtype[Any]]]:
    assert kind.fields is not None
    return [(name, kind.fields[name][0]) for name in kind.names or () if name != TIME_FIELD]


def _message_type(kind: np.dtype[np.void]) -> np.dtype[np.void]:
    fields: list[Any] = []
    for name, field in _fields(kind):
        if field.kind == "S":
            fields.append((LENGTH + name, "<u4"))
        fields.append((name, field))
    return np.dtype(fields)
