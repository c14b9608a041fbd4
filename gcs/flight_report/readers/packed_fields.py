"""Named fields of the packed structs in which an import keeps an autopilot's own messages.

The channel's `ros1msg` schema lists them, one a line; a text stands there as
`string name # text of N bytes`, behind its length.
"""

from __future__ import annotations

import re
import struct
from collections.abc import Callable
from math import isfinite
from typing import TypeAlias

from gcs.flight_report.facts import Fact

Read: TypeAlias = Callable[[bytes], "list[Fact]"]
Value: TypeAlias = Callable[[bytes], "float | None"]

_LINE = re.compile(r"(\w+)(?:\[(\d+)\])? (\w+)(?: # text of (\d+) bytes)?\Z")
_CODES = {
    "bool": "?",
    "int8": "b",
    "uint8": "B",
    "int16": "h",
    "uint16": "H",
    "int32": "i",
    "uint32": "I",
    "int64": "q",
    "uint64": "Q",
    "float32": "f",
    "float64": "d",
}


class PackedFields:
    """Where each number of a packed struct lies.  Raises ValueError for another schema."""

    def __init__(self, schema: bytes) -> None:
        self._at: dict[str, tuple[struct.Struct, int]] = {}
        self._texts: dict[str, tuple[int, int]] = {}
        offset = 0
        for line in schema.decode("utf-8", "replace").splitlines():
            found = _LINE.match(line)
            if found is None:
                raise ValueError(line)
            kind, count, name, text_bytes = found.groups()
            if kind == "string" and text_bytes is not None:
                self._texts[name] = offset + 4, int(text_bytes)
                offset += 4 + int(text_bytes)
                continue
            if kind not in _CODES:
                raise ValueError(line)
            one = struct.Struct("<" + _CODES[kind])
            self._at[name] = one, offset
            offset += one.size * int(count or 1)

    def text(self, name: str, data: bytes) -> str:
        """Empty where there is no such text."""
        start, length = self._texts.get(name, (0, 0))
        raw = data[start : start + length].partition(b"\0")[0]
        return raw.decode("utf-8", "replace").strip()

    def values(self, *names: str) -> Callable[[bytes], tuple[float | None, ...]]:
        """Reads each of the names."""
        each = [self.value(name) for name in names]
        return lambda data: tuple(read(data) for read in each)

    def value(self, *names: str) -> Value:
        """Reads the first of the names that there is; what is not finite, or not there, is None."""
        known = next((self._at[name] for name in names if name in self._at), None)
        if known is None:
            return lambda data: None
        packed, offset = known

        def read(data: bytes) -> float | None:
            (number,) = packed.unpack_from(data, offset)
            return float(number) if isfinite(number) else None

        return read
