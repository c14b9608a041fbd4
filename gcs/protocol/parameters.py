"""What a value of the parameter protocol means (https://mavlink.io/en/services/parameter.html).

How an integer travels in the float differs: px4 puts its bytes there, ardupilot its value.
"""

from __future__ import annotations

import math
import struct
from dataclasses import dataclass
from typing import Final

from gcs.float32 import float32, value_text
from gcs.protocol.autopilot import ParamEncoding
from gcs.wire.ids import ParamType

BY_NAME = -1
"""param_index that says: look at the name."""

_INTEGER = {
    ParamType.UINT8: "B",
    ParamType.INT8: "b",
    ParamType.UINT16: "H",
    ParamType.INT16: "h",
    ParamType.UINT32: "I",
    ParamType.INT32: "i",
}

_RANGES: Final = {
    ParamType.UINT8: (0, 0xFF),
    ParamType.INT8: (-0x80, 0x7F),
    ParamType.UINT16: (0, 0xFFFF),
    ParamType.INT16: (-0x8000, 0x7FFF),
    ParamType.UINT32: (0, 0xFFFFFFFF),
    ParamType.INT32: (-0x80000000, 0x7FFFFFFF),
}


@dataclass(frozen=True, slots=True)
class Parameter:
    """One of a vehicle's; an integer type has a whole number."""

    name: str
    value: int | float
    type: ParamType

    @property
    def text(self) -> str:
        """The value in the fewest digits that mean it."""
        return value_text(self.value)


def why_not(name: str, value: float, type_: ParamType, encoding: ParamEncoding) -> str:
    """Why a parameter of that type cannot be set to the value; empty where it can."""
    if not math.isfinite(value):
        return f"{name}: the value is not a finite number"
    limits = _RANGES.get(type_)
    if limits is None:
        if type_ is not ParamType.REAL32:
            return f"{name} is of a type that the parameter protocol does not carry"
        return "" if math.isfinite(float32(value)) else f"{name}: {value:g} is no 32-bit float"
    kind = type_.name.lower()
    if value != int(value):
        return f"{name} is a whole number ({kind}), not {value:g}"
    if not limits[0] <= value <= limits[1]:
        return f"{name} is {kind}, {limits[0]} to {limits[1]}, not {int(value)}"
    if decode_value(float32(encode_value(value, type_, encoding)), type_, encoding) != value:
        return f"{name}: {int(value)} cannot travel in the float of a PARAM_SET"
    return ""


def decode_value(wire: float, type_: ParamType, encoding: ParamEncoding) -> int | float:
    """A PARAM_VALUE's float as what it means.  64-bit types do not fit and stay as they are.

    Bytewise integers whose bits are a signalling NaN (such as -8388607) come out with bit 22 set:
    `struct` goes through a double, which quietens them.  No parameter of PX4's is one.
    """
    code = _INTEGER.get(type_)
    if code is None:
        return wire
    if encoding is ParamEncoding.BYTEWISE:
        value: int = struct.unpack_from("<" + code, struct.pack("<f", wire))[0]
        return value
    return round(wire) if math.isfinite(wire) else wire


def encode_value(value: float, type_: ParamType, encoding: ParamEncoding) -> float:
    """The float that `decode_value` makes `value` of; an integer type takes a whole number."""
    code = _INTEGER.get(type_)
    if code is None or encoding is not ParamEncoding.BYTEWISE:
        return value
    packed = struct.pack("<" + code, round(value)).ljust(4, b"\0")
    return float(struct.unpack("<f", packed)[0])
