"""`@PARAM/param.pck`: all parameters of a vehicle in one file.

https://mavlink.io/en/services/parameter_ftp.html.  A header of three uint16: magic, parameters in
the file, parameters of the vehicle.  Then per parameter, behind any zeros that fill a block: type
and flags (4 bits each), how many letters the name shares with the one before and how many follow,
less one (4 bits each), those letters, the value.
"""

from __future__ import annotations

import struct
from typing import Final

from gcs.protocol.parameters import Parameter
from gcs.wire.ids import ParamType

PATH: Final = "@PARAM/param.pck"
MAGIC: Final = 0x671B
_HEADER: Final = struct.Struct("<HHH")
_TYPES: Final = {
    1: (ParamType.INT8, struct.Struct("<b")),
    2: (ParamType.INT16, struct.Struct("<h")),
    3: (ParamType.INT32, struct.Struct("<i")),
    4: (ParamType.REAL32, struct.Struct("<f")),
}


class PackError(ValueError):
    """The file is not one of parameters, or not a whole one."""


def unpack(data: bytes) -> tuple[Parameter, ...]:
    """Raises PackError."""
    if len(data) < _HEADER.size:
        raise PackError("it is too short")
    magic, count, total = _HEADER.unpack_from(data)
    if magic != MAGIC:
        raise PackError(f"it begins with {magic:#06x}, not with {MAGIC:#06x}")
    found: list[Parameter] = []
    at, name = _HEADER.size, b""
    try:
        while len(found) < count:
            while data[at] == 0:
                at += 1
            kind, form = _TYPES[data[at] & 0x0F]
            shared, given = data[at + 1] & 0x0F, (data[at + 1] >> 4) + 1
            name = name[:shared] + data[at + 2 : at + 2 + given]
            at += 2 + given
            found.append(Parameter(name.decode("ascii"), form.unpack_from(data, at)[0], kind))
            at += form.size
    except (IndexError, KeyError, struct.error, UnicodeDecodeError):
        raise PackError(f"it ends or is damaged behind {len(found)} parameters") from None
    if count != total:
        raise PackError(f"it has {count} of {total} parameters")
    return tuple(found)
