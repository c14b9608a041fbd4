"""Reads files of parameters: MAVProxy's `NAME value`, Mission Planner's `NAME,value`, and
QGroundControl's `sysid compid NAME value type`, tab between each.

`#` begins a comment.  Which format a line is in, the line itself tells; a file may not mix them.
"""

from __future__ import annotations

import re
from typing import Final

from gcs.parameter_files.model import Entry, ParameterFileError

NAME: Final = re.compile(r"[A-Za-z0-9_]{1,16}", re.ASCII)
_NUMBER: Final = re.compile(
    r"[+-]?((\d+(\.\d*)?|\.\d+)([eE][+-]?\d+)?|nan|inf)", re.ASCII | re.IGNORECASE
)
KINDS: Final = {
    1: "uint8", 2: "int8", 3: "uint16", 4: "int16", 5: "uint32", 6: "int32",
    7: "uint64", 8: "int64", 9: "real32", 10: "real64",
}  # fmt: skip
"""MAV_PARAM_TYPE, as QGroundControl writes it."""
EXPECTED: Final = "a line is `NAME value`, `NAME,value` or `sysid compid NAME value type`"


def read(path: str, data: bytes) -> dict[str, Entry]:
    """By name, in the order of the file.  Raises ParameterFileError."""
    try:
        text = data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        at = data[: error.start].count(b"\n") + 1
        raise ParameterFileError(f"{path}:{at}: not UTF-8 text", "is it a log?") from None
    found: dict[str, Entry] = {}
    kind = ""
    for number, raw in enumerate(text.splitlines(), start=1):
        line = raw.split("#", 1)[0].strip()
        if not line:
            continue
        where = f"{path}:{number}"
        parts = _parts(line)
        entry = _entry(where, number, parts)
        before, kind = kind, f"{len(parts)} fields, comma: {',' in line}"
        if before and kind != before:
            raise ParameterFileError(f"{where}: {line!r}: not as the lines before it", EXPECTED)
        if entry.name in found:
            first = found[entry.name].line
            raise ParameterFileError(f"{where}: {entry.name}: it is in line {first} already")
        found[entry.name] = entry
    if not found:
        raise ParameterFileError(f"{path}: holds no parameters", EXPECTED)
    return found


def _parts(line: str) -> list[str]:
    if "," in line and not line.split(",")[0].strip().count(" "):
        return [part.strip() for part in line.split(",")]
    return line.split()


def _entry(where: str, number: int, parts: list[str]) -> Entry:
    if len(parts) not in (2, 5):
        raise ParameterFileError(f"{where}: {len(parts)} fields, not 2 or 5", EXPECTED)
    name, value = parts[2:4] if len(parts) == 5 else parts
    if not NAME.fullmatch(name):
        raise ParameterFileError(
            f"{where}: {name!r}: no name of a parameter", "up to 16 letters, digits and _"
        )
    kind = ""
    if len(parts) == 5:
        if not (parts[4].isdecimal() and int(parts[4]) in KINDS):
            raise ParameterFileError(
                f"{where}: {name}: {parts[4]!r} is no MAV_PARAM_TYPE (1 to 10)"
            )
        kind = KINDS[int(parts[4])]
    if not _NUMBER.fullmatch(value):
        hint = "the decimal mark is a point" if "," in value else ""
        raise ParameterFileError(f"{where}: {name}: {value!r} is not a number", hint)
    if kind and not kind.startswith("real") and not re.fullmatch(r"[+-]?\d+", value):
        raise ParameterFileError(f"{where}: {name}: {value!r} is not a whole number ({kind})")
    whole = bool(re.fullmatch(r"[+-]?\d+", value)) and not kind.startswith("real")
    return Entry(name, int(value) if whole else float(value), kind, number)
