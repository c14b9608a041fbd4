"""A line of the station's log in a record: level, node and text of foxglove.Log.

The SDK encodes this schema and does not decode it.  Wire format: Protocol Buffers encoding,
https://protobuf.dev/programming-guides/encoding/; field numbers: foxglove's Log.proto.
"""

from __future__ import annotations

from collections.abc import Iterator

_LEVEL, _MESSAGE, _NAME = 2, 3, 4
_FIXED_BYTES = {1: 8, 5: 4}


def read_log_line(data: bytes) -> tuple[int, str, str] | None:
    """Level (1 debug to 5 fatal), node and text; None where the bytes are no such message."""
    level, texts = 0, {_MESSAGE: "", _NAME: ""}
    try:
        for number, value in _fields(data):
            if number == _LEVEL and isinstance(value, int):
                level = value
            elif number in texts and isinstance(value, bytes):
                texts[number] = value.decode("utf-8", "replace")
    except (IndexError, ValueError):
        return None
    return level, texts[_NAME], texts[_MESSAGE]


def _fields(data: bytes) -> Iterator[tuple[int, int | bytes]]:
    """Number and value of each field.  Raises IndexError where it breaks off, ValueError."""
    at = 0
    while at < len(data):
        key, at = _varint(data, at)
        if key >> 3 == 0:
            raise ValueError("field 0")
        match key & 7:
            case 0:
                value, at = _varint(data, at)
                yield key >> 3, value
            case 2:
                length, at = _varint(data, at)
                if at + length > len(data):
                    raise IndexError
                yield key >> 3, data[at : at + length]
                at += length
            case kind if kind in _FIXED_BYTES:
                at += _FIXED_BYTES[kind]
            case kind:
                raise ValueError(kind)


def _varint(data: bytes, at: int) -> tuple[int, int]:
    value = 0
    for shift in range(0, 64, 7):
        byte = data[at]
        at += 1
        value |= (byte & 0x7F) << shift
        if byte < 0x80:
            return value, at
    raise ValueError("varint")
