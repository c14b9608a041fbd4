"""What a value of the parameter protocol means (https://mavlink.io/en/services/parameter.html).

How an integer travels in the float differs: px4 puts its bytes there, ardupilot its value.
"""

from __future__ import annotations

import math
import struct

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
