"""ULog, PX4's log format, as bytes.

Source: "ULog File Format" of the PX4 guide, file version 1.  A file is a header, the definitions
(flags, formats, information, parameters) and the data; every message begins with its length
(uint16, without these three bytes) and its type (one letter).
"""

from __future__ import annotations

import struct
from typing import Final, NamedTuple

from vehicle_sim.flight_log.snapshot import Values

MAGIC: Final = b"ULog\x01\x12\x35"
VERSION: Final = 1
DEFAULT_PARAMETERS: Final = 0x01  # compat flag: there are 'Q' messages
SYSTEM_WIDE: Final = 0x01  # which default a 'Q' message gives

_LETTERS: Final = {
    "bool": "?",
    "uint8_t": "B",
    "uint32_t": "I",
    "int32_t": "i",
    "uint64_t": "Q",
    "float": "f",
    "double": "d",
}


def file_header(time_us: int) -> bytes:
    """The header, and the flags that must follow it at once; `time_us` is since boot."""
    flags = bytes((DEFAULT_PARAMETERS,)) + bytes(7)  # compatible
    flags += bytes(8)  # incompatible: none, so nothing is appended to the data either
    flags += bytes(3 * 8)
    return MAGIC + bytes((VERSION,)) + time_us.to_bytes(8, "little") + message("B", flags)


def message(kind: str, body: bytes) -> bytes:
    return len(body).to_bytes(2, "little") + kind.encode("ascii") + body


def information(name: str, value: str | int) -> bytes:
    """Text, or an unsigned 32-bit number."""
    if isinstance(value, int):
        return message("I", _keyed("uint32_t", name) + value.to_bytes(4, "little"))
    return message("I", _keyed(f"char[{len(value)}]", name) + value.encode("ascii"))


def parameter(name: str, value: float, integer: bool) -> bytes:
    return message("P", _parameter(name, value, integer))


def default_parameter(name: str, value: float, integer: bool) -> bytes:
    return message("Q", bytes((SYSTEM_WIDE,)) + _parameter(name, value, integer))


def logged_text(time_us: int, severity: int, text: str) -> bytes:
    """The level is the digit of the syslog severity, which is MAV_SEVERITY."""
    head = struct.pack("<BQ", ord("0") + severity, time_us)
    return message("L", head + text.encode("ascii", "replace"))


def _parameter(name: str, value: float, integer: bool) -> bytes:
    if integer:
        return _keyed("int32_t", name) + struct.pack("<i", int(value))
    return _keyed("float", name) + struct.pack("<f", value)


def _keyed(kind: str, name: str) -> bytes:
    key = f"{kind} {name}".encode("ascii")
    return bytes((len(key),)) + key


class UlogField(NamedTuple):
    kind: str
    name: str
    length: int = 0  # of an array, 0 = no array


class Topic:
    """One uORB topic: its format, its subscription and its data.

    Fields stand by falling size, as PX4's generator sorts them, so that none needs padding.
    """

    __slots__ = ("_number", "_pack", "_size", "fields", "name")

    def __init__(self, number: int, name: str, fields: tuple[UlogField, ...]) -> None:
        self.name: Final = name
        self.fields: Final = fields
        self._number = number
        body = struct.Struct("<HcH" + "".join(map(_letters, fields)))
        self._pack = body.pack
        self._size = body.size - 3

    def format(self) -> bytes:
        columns = "".join(f"{_declared(field)} {field.name};" for field in self.fields)
        return message("F", f"{self.name}:{columns}".encode("ascii"))

    def subscription(self) -> bytes:
        head = struct.pack("<BH", 0, self._number)  # the first instance
        return message("A", head + self.name.encode("ascii"))

    def data(self, values: Values) -> bytes:
        """Arrays are spread over `values`.  Raises `struct.error` for what does not fit."""
        return self._pack(self._size, b"D", self._number, *values)


def _letters(field: UlogField) -> str:
    return f"{field.length or ''}{_LETTERS[field.kind]}"


def _declared(field: UlogField) -> str:
    return f"{field.kind}[{field.length}]" if field.length else field.kind
