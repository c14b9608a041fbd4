"""How the messages of a DataFlash log look, by its FMT messages; of the binary and the text form.

The multipliers of the format letters (c, C, e, E, L) are applied: the text form has them applied
already.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Any, TypeAlias

import numpy as np

from gcs.logfile.columns.layout import Records
from gcs.logfile.packed import TIME_FIELD
from gcs.mcap_file.chunk_reader import Bytes, Index, rows_at

FMT, FMT_BYTES = 0x80, 89
HEAD_BYTES = 3
_CODES: dict[str, Any] = {
    "a": ("<i2", 32),
    "b": "i1",
    "B": "u1",
    "g": "<f2",
    "h": "<i2",
    "H": "<u2",
    "i": "<i4",
    "I": "<u4",
    "f": "<f4",
    "d": "<f8",
    "n": "S4",
    "N": "S16",
    "Z": "S64",
    "c": "<i2",
    "C": "<u2",
    "e": "<i4",
    "E": "<u4",
    "L": "<i4",
    "M": "u1",
    "q": "<i8",
    "Q": "<u8",
}
"""Format letter -> numpy (AP_Logger/README.md of ArduPilot)."""
_MULTIPLIERS = {"c": 0.01, "C": 0.01, "e": 0.01, "E": 0.01, "L": 1e-7}
_MOST_FORMATS = 4096
"""A log has one for each of 256 types; what a damaged one has beyond this is not understood."""
_IN_TEXT: dict[str, Any] = {"a": "S256", "M": "S16"}
"""Of the text form, which has lists and the names of modes there."""


Definition: TypeAlias = tuple[int, int, str, str, str]
"""What a FMT message says: type, length, name, format letters, columns."""


@dataclass(frozen=True, slots=True)
class TimeColumn:
    """The column that tells when a message was logged."""

    name: str
    code: np.dtype[Any]
    offset: int
    """In the message without its head."""
    ns: int
    """Of one unit."""


class Format:
    """What one FMT message says of the messages of a kind."""

    def __init__(self, definition: Definition, name: str, text: bool) -> None:
        self.definition = definition
        self.kind, self.size, _, letters, columns = definition
        self.name = name
        """Of its table, which no other format has."""
        self.letters = letters
        self.columns = tuple(columns.split(",")) if columns else ()
        codes = {**_CODES, **_IN_TEXT} if text else _CODES
        raw = _struct(letters, self.columns, codes)
        if raw is not None and not text and raw.itemsize != self.size - HEAD_BYTES:
            raw = None
        understood = raw is not None
        # What cannot be understood is kept as bytes.
        self.raw = raw or np.dtype([("data", "u1", (max(1, self.size - HEAD_BYTES),))])
        self._scaled = {
            name: _MULTIPLIERS[letter]
            for name, letter in zip(self.columns, letters, strict=False)
            if understood and letter in _MULTIPLIERS
        }
        self.table = np.dtype([(TIME_FIELD, "<i8"), *map(self._field, self.raw.names or ())])
        self.time = self._time_column()
        self._copied = self._equal_bytes()

    def _field(self, name: str) -> Any:
        code = self.raw[name]
        if name in self._scaled:
            return name, "<f8"
        return (name, "<f4") if code == np.float16 else (name, code)

    def _time_column(self) -> TimeColumn | None:
        """`TimeUS`; in logs of before 2015 `TimeMS`, which in their GPS message is the time of the
        week, and `T` there is the autopilot's."""
        names = self.raw.names or ()
        old = "T" if self.name.startswith("GPS") and "T" in names else "TimeMS"
        for name, ns in (("TimeUS", 1_000), (old, 1_000_000)):
            if name in names and self.raw[name].kind in "iu":
                assert self.raw.fields is not None
                return TimeColumn(name, self.raw[name], self.raw.fields[name][1], ns)
        return None

    def _equal_bytes(self) -> list[tuple[int, int, int]]:
        """Stretches that are the same in message and table: where in each, and how long."""
        stretches: list[tuple[int, int, int]] = []
        assert self.raw.fields is not None
        assert self.table.fields is not None
        for name in self.raw.names or ():
            (code, from_), (made, to) = self.raw.fields[name][:2], self.table.fields[name][:2]
            if code != made:
                continue
            last = stretches[-1] if stretches else (0, 0, 0)
            if stretches and (last[0] + last[2], last[1] + last[2]) == (from_, to):
                stretches[-1] = last[0], last[1], last[2] + code.itemsize
            else:
                stretches.append((from_, to, code.itemsize))
        return stretches

    def rows(self, data: Bytes, places: Index, time_ns: Index) -> Records:
        """The messages of a binary log that begin at these places."""
        raw = rows_at(data, places + HEAD_BYTES, self.raw.itemsize)
        made = np.empty(len(places), self.table)
        as_bytes = made.view(np.uint8).reshape(len(made), self.table.itemsize)
        for from_, to, width in self._copied:
            as_bytes[:, to : to + width] = raw[:, from_ : from_ + width]
        fields = raw.view(self.raw).ravel()
        for name in self.raw.names or ():
            if self.raw[name] != self.table[name]:
                made[name] = fields[name] * self._scaled.get(name, 1)
        made[TIME_FIELD] = time_ns
        return made


class Formats:
    """The formats of one log as far as it was read, numbered as they came."""

    def __init__(self, text: bool = False) -> None:
        self.all: list[Format] = []
        self._text = text
        self._number_of: dict[Definition, int] = {}
        self._latest: dict[int, int] = {}
        self.learn((FMT, FMT_BYTES, "FMT", "BBnNZ", "Type,Length,Name,Format,Columns"))

    def learn(self, definition: Definition) -> int | None:
        """Its number in `all`; None where it is known already, or can be none."""
        kind, size, name, *_ = definition
        if size < HEAD_BYTES or (kind == FMT and self.all):
            return None
        number = self._number_of.get(definition)
        if number is None:
            if len(self.all) == _MOST_FORMATS:
                return None
            number = self._number_of[definition] = len(self.all)
            self.all.append(Format(definition, self._free_name(name, kind), self._text))
        elif self._latest[kind] == number:
            return None
        self._latest[kind] = number
        return number

    def _free_name(self, name: str, kind: int) -> str:
        """Where a name has two layouts in one log, the second is a table of its own."""
        plain = re.sub(r"\W", "_", name) or f"type_{kind}"
        taken = {each.name for each in self.all}
        free, number = plain, 1
        while free in taken:
            number += 1
            free = f"{plain}_{number}"
        return free


def text_of(raw: bytes) -> str:
    return raw.partition(b"\0")[0].decode("utf-8", "backslashreplace")


def _struct(
    letters: str, columns: tuple[str, ...], codes: dict[str, Any]
) -> np.dtype[np.void] | None:
    """None where the format is not one."""
    if not letters or len(letters) != len(columns) or len(set(columns)) != len(columns):
        return None
    if not all(name.isidentifier() for name in columns) or TIME_FIELD in columns:
        return None
    if not set(letters) <= codes.keys():
        return None
    return np.dtype([_column(n, codes[code]) for n, code in zip(columns, letters, strict=True)])


def _column(name: str, code: Any) -> Any:
    return (name, *code) if isinstance(code, tuple) else (name, code)
