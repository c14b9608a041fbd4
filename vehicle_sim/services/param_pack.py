"""`@PARAM/param.pck`: all parameters in one file, as ArduPilot packs them.

A header of three uint16 (magic, parameters in the file, parameters in all; in an upload the last
one is the file's length), then per parameter: type and flags (4 bits each), length of the prefix
shared with the name before and of the rest less one (4 bits each), the rest of the name, the
value, and the default if it differs (flag 1, only with the second magic).
"""

from __future__ import annotations

import struct
from itertools import takewhile
from typing import Final

from vehicle_sim.autopilot.parameters.parameters import ParameterError, Parameters
from vehicle_sim.autopilot.parameters.tables import StoredAs
from vehicle_sim.storage.store import StoreError, StoreFault
from vehicle_sim.storage.virtual_files import Virtual

PATH: Final = "@PARAM/param.pck"
UPLOAD_BYTES_MAX: Final = 0xFFFF
NAME_MAX: Final = 16

_MAGIC: Final = 0x671B
_MAGIC_DEFAULTS: Final = 0x671C
_HEADER: Final = struct.Struct("<HHH")
_HAS_DEFAULT: Final = 0x10
_FLOAT: Final = 4
_TYPES: Final = {StoredAs.INT8: 1, StoredAs.INT16: 2, StoredAs.INT32: 3, StoredAs.REAL32: _FLOAT}
"""AP_Param's types."""
_FORMATS: Final = {
    1: struct.Struct("<b"),
    2: struct.Struct("<h"),
    3: struct.Struct("<i"),
    _FLOAT: struct.Struct("<f"),
}


def param_pack(parameters: Parameters) -> Virtual:
    """The virtual file of one vehicle's parameters; an upload sets them."""
    return Virtual(lambda query: _read(parameters, query), lambda data: _upload(parameters, data))


def _read(parameters: Parameters, query: str) -> bytes:
    """`query`: `start=`, `count=` and `withdefaults=` joined by `&`, as ArduPilot takes them."""
    wanted = {"start": 0, "count": 0, "withdefaults": 0}
    for term in filter(None, query.split("&")):
        key, _, text = term.partition("=")
        if key in wanted:
            if not (text.isascii() and text.isdecimal() and int(text) < UPLOAD_BYTES_MAX):
                raise StoreError(StoreFault.BAD_PATH, query)
            wanted[key] = int(text)
    if wanted["withdefaults"] > 1 or wanted["start"] >= len(parameters):
        raise StoreError(StoreFault.BAD_PATH, query)
    end = wanted["start"] + wanted["count"] if wanted["count"] else None
    return pack(parameters, slice(wanted["start"], end), wanted["withdefaults"] == 1)


def pack(parameters: Parameters, part: slice, with_defaults: bool) -> bytes:
    """The file for some of the parameters, in the order of their indices."""
    specs = parameters.specs[part]
    magic = _MAGIC_DEFAULTS if with_defaults else _MAGIC
    packed = bytearray(_HEADER.pack(magic, len(specs), len(parameters)))
    last = ""
    for spec in specs:
        kind = _TYPES[spec.stored_as]
        value = _packed(kind, parameters.value(spec.name))
        default = _packed(kind, parameters.default(spec.name))
        differs = with_defaults and value != default
        # At least one byte of the name is always given.
        shared = min(_shared(last, spec.name), len(spec.name) - 1)
        rest = spec.name[shared:].encode("ascii")
        packed += bytes((kind | (_HAS_DEFAULT if differs else 0), shared | (len(rest) - 1) << 4))
        packed += rest + value + (default if differs else b"")
        last = spec.name
    return bytes(packed)


def _shared(one: str, other: str) -> int:
    """Length of the prefix that two names have in common."""
    return sum(1 for _ in takewhile(lambda pair: pair[0] == pair[1], zip(one, other, strict=False)))


def _packed(kind: int, value: float) -> bytes:
    return _FORMATS[kind].pack(value if kind == _FLOAT else int(value))


def unpack(data: bytes) -> list[tuple[str, float]]:
    """Names and values of an upload.  Raises ValueError for what is not one."""
    if len(data) < _HEADER.size:
        raise ValueError("too short for a header")
    magic, count, length = _HEADER.unpack_from(data)
    if magic != _MAGIC or length != len(data):
        raise ValueError("not the header of an upload")
    values: list[tuple[str, float]] = []
    at, name = _HEADER.size, b""
    for _ in range(count):
        if at + 2 > len(data):
            raise ValueError("cut in an entry")
        form = _FORMATS.get(data[at])
        shared, given = data[at + 1] & 0xF, (data[at + 1] >> 4) + 1
        at += 2
        if form is None or shared > len(name) or shared + given > NAME_MAX:
            raise ValueError("no entry")
        if at + given + form.size > len(data):
            raise ValueError("cut in an entry")
        name = name[:shared] + data[at : at + given]
        (value,) = form.unpack_from(data, at + given)
        values.append((name.decode("ascii", "replace"), float(value)))
        at += given + form.size
    return values


def _upload(parameters: Parameters, data: bytes) -> None:
    """Sets what is known and fits; the rest is passed over, as ArduPilot does."""
    try:
        values = unpack(data)
    except ValueError:
        raise StoreError(StoreFault.BAD_PATH, PATH) from None
    for name, value in values:
        try:
            parameters.set(name, value)
        except ParameterError:
            continue
