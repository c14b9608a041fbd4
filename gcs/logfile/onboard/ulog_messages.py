"""What a ULog has beside its data: texts, parameters, drop-outs, what it says of itself."""

from __future__ import annotations

import struct
from dataclasses import dataclass, field
from typing import Any, NamedTuple

TEXTS, PARAMETERS = "logged_messages", "parameters"
DROPOUTS, DEFAULTS = "dropouts", "parameter_defaults"
"""Tables that are made of what is no topic of the log.  Defaults are those of the airframe where it
has its own, else of the firmware."""
TEXT_BYTES, NAME_BYTES = 128, 32
"""PX4's own are shorter.  A longer text is several rows; a longer name is taken for damage."""
FIELDS = {
    TEXTS: [("level", "u1"), ("text", f"S{TEXT_BYTES}")],
    PARAMETERS: [("name", f"S{NAME_BYTES}"), ("value", "<f8")],
    DEFAULTS: [("name", f"S{NAME_BYTES}"), ("value", "<f8")],
    DROPOUTS: [("duration_ms", "<u4")],
}
_SYSTEM_ID = b"MAV_SYS_ID"
_SYNC = b"\x2f\x73\x13\x20\x25\x0c\xbb\x12"
_VALUES = {
    "int8_t": struct.Struct("<b"),
    "uint8_t": struct.Struct("<B"),
    "int16_t": struct.Struct("<h"),
    "uint16_t": struct.Struct("<H"),
    "int32_t": struct.Struct("<i"),
    "uint32_t": struct.Struct("<I"),
    "int64_t": struct.Struct("<q"),
    "uint64_t": struct.Struct("<Q"),
    "float": struct.Struct("<f"),
    "double": struct.Struct("<d"),
    "bool": struct.Struct("<?"),
}
_TIME = struct.Struct("<Q")


class Row(NamedTuple):
    """Of the table `table`; without a time it has that of the message before it."""

    table: str
    offset: int
    time_us: int | None
    values: tuple[Any, ...]


@dataclass(slots=True)
class Messages:
    info: dict[str, str] = field(default_factory=dict)
    system_id: int = 1
    rows: list[Row] = field(default_factory=list)
    """Those that nobody has taken yet."""
    _initial: dict[bytes, float] = field(default_factory=dict)
    _defaults: dict[int, dict[bytes, float]] = field(default_factory=dict)
    """By bit of `Q`: 0 the firmware's, 1 the airframe's."""
    _tells_defaults: bool = False
    _data_began: bool = False

    def data_begins(self, offset: int) -> None:
        """What was told of parameters so far are their values at the start."""
        if self._data_began:
            return
        self._data_began = True
        if self._tells_defaults:
            # One whose default is not told has it.
            known = {**self._initial, **self._defaults.get(0, {}), **self._defaults.get(1, {})}
            self.rows += [Row(DEFAULTS, offset, None, each) for each in known.items()]

    def take(self, kind: str, content: bytes, offset: int) -> bool:
        """Whether it is what its type says."""
        try:
            return self._take(kind, content, offset)
        except (struct.error, IndexError, ValueError):
            return False

    def _take(self, kind: str, content: bytes, offset: int) -> bool:
        match kind:
            case "B":
                self._tells_defaults = bool(content[0] & 1)
            case "I":
                type_, key, value = _named(content)
                self.info[key] = _shown(type_, value)
            case "P":
                self._parameter(content, offset)
            case "Q":
                self._default(content, offset)
            case "L":
                (time_us,) = _TIME.unpack_from(content, 1)
                self._text(content[0], time_us, content[9:], offset)
            case "C":
                (time_us,) = _TIME.unpack_from(content, 3)
                self._text(content[0], time_us, content[11:], offset)
            case "O":
                (duration_ms,) = struct.unpack("<H", content)
                self.rows.append(Row(DROPOUTS, offset, None, (duration_ms,)))
            case "S":
                return content == _SYNC
            case _:
                # What is kept nowhere: M and R.
                return True
        return True

    def _parameter(self, content: bytes, offset: int) -> None:
        name, value = _number(content)
        self.rows.append(Row(PARAMETERS, offset, None, (name, value)))
        if not self._data_began:
            self._initial[name] = value
        if name == _SYSTEM_ID and 0 < value < 256:
            self.system_id = int(value)

    def _default(self, content: bytes, offset: int) -> None:
        name, value = _number(content[1:])
        for bit in range(8):
            if content[0] >> bit & 1:
                self._defaults.setdefault(bit, {})[name] = value
        if self._data_began:
            self.rows.append(Row(DEFAULTS, offset, None, (name, value)))

    def _text(self, level: int, time_us: int, text: bytes, offset: int) -> None:
        self.data_begins(offset)
        for at in range(0, max(1, len(text)), TEXT_BYTES):
            values = level - ord("0") & 0xFF, text[at : at + TEXT_BYTES]
            self.rows.append(Row(TEXTS, offset, time_us, values))


def _named(content: bytes) -> tuple[str, str, bytes]:
    """Type, name and value.  Raises ValueError."""
    length = content[0]
    type_, name = content[1 : 1 + length].decode("utf-8", "replace").split(" ", 1)
    return type_, name, content[1 + length :]


def _number(content: bytes) -> tuple[bytes, float]:
    """Raises ValueError and struct.error."""
    type_, name, value = _named(content)
    packed, raw = _VALUES.get(type_), name.encode()
    if packed is None or not 0 < len(raw) <= NAME_BYTES:
        raise ValueError(type_)
    (number,) = packed.unpack(value)
    return raw, number


def _shown(type_: str, value: bytes) -> str:
    """Raises struct.error."""
    if type_.startswith("char["):
        return value.decode("utf-8", "ignore")
    packed = _VALUES.get(type_)
    return str(packed.unpack(value)[0]) if packed else value.hex(" ")
