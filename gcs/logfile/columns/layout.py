"""How a message lies in memory: a MAVLink payload is a packed little-endian struct, as here."""

from __future__ import annotations

from functools import cache
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from gcs.logfile.frames import Frames
from gcs.mcap_file.chunk_reader import Bytes, rows_at
from gcs.wire.dialect import FieldDef, MessageDef

Records: TypeAlias = "NDArray[np.void]"
"""A structured array; its fields are those of `record_type`."""

HEAD = (("time_ns", "<i8"), ("frame_seq", "u1"), ("sysid", "u1"), ("compid", "u1"))
"""What stands before the message's own fields.  Some messages have a field `seq` of their own."""
HEAD_BYTES = 11

_LAST_NS = np.uint64(2**63 - 1)


@cache
def record_type(definition: MessageDef) -> np.dtype[np.void]:
    """`HEAD`, then the fields of the message in wire order, packed; text as bytes (`S50`)."""
    fields: list[Any] = [*HEAD, *(_field(field) for field in definition.fields)]
    return np.dtype(fields)


def _field(field: FieldDef) -> tuple[str, str] | tuple[str, str, int]:
    if field.type == "char":
        return field.name, f"S{field.array_length or 1}"
    kind = {"float": "float32", "double": "float64"}.get(field.type, field.type)
    code = np.dtype(kind).newbyteorder("<").str
    return (field.name, code, field.array_length) if field.array_length else (field.name, code)


def records(definition: MessageDef, data: Bytes, frames: Frames, time_us: Any) -> Records:
    """One record a frame; `data` as in `find_frames`, times are unsigned microseconds.

    What MAVLink 2 cut off, and extensions that MAVLink 1 lacks, are zero.
    """
    made = np.zeros(len(frames), record_type(definition))
    made["time_ns"] = ns_of_us(time_us)
    made["frame_seq"], made["sysid"], made["compid"] = frames.source(data)
    payload = rows_at(data, frames.start + frames.header, definition.max_len)
    for length in np.unique(frames.length).tolist():
        if length < definition.max_len:
            payload[frames.length == length, length:] = 0
    fill_payload(definition, made, payload)
    return made


def fill_payload(definition: MessageDef, made: Records, payload: Bytes) -> None:
    """Set the fields of the message from rows of whole payloads."""
    rows = made.view(np.uint8).reshape(len(made), made.dtype.itemsize)
    rows[:, HEAD_BYTES : HEAD_BYTES + payload.shape[1]] = payload
    for field in definition.fields:
        if field.type == "char" and field.array_length > 1:
            start = HEAD_BYTES + field.offset
            text = rows[:, start : start + field.array_length]
            # Text ends at its first NUL; numpy leaves out only those at the end.
            text[np.logical_or.accumulate(text == 0, axis=1)] = 0


def ns_of_us(time_us: NDArray[np.uint64]) -> NDArray[np.int64]:
    """Microseconds that a damaged file may have made any number; at most the last ns of 64 bits."""
    return np.minimum(time_us, _LAST_NS // np.uint64(1000)).astype(np.int64) * 1000
