"""DataFlash, ArduPilot's binary log format, as bytes.

Source: AP_Logger's README and LogStructure.  Every record is 0xA3 0x95, its type, and its fields
as the letters of its FMT record say; FMTU names unit and multiplier of each field by a letter
that UNIT and MULT explain.  Times are microseconds since boot.
"""

from __future__ import annotations

import struct
from typing import Final

HEAD: Final = b"\xa3\x95"

_LETTERS: Final = {
    "b": "b",
    "B": "B",
    "h": "h",
    "H": "H",
    "I": "I",
    "Q": "Q",
    "f": "f",
    "d": "d",
    "n": "4s",
    "N": "16s",
    "Z": "64s",
    "c": "h",  # hundredths
    "C": "H",
    "e": "i",
    "L": "i",  # 1e-7 degrees
    "M": "B",  # flight mode
}

UNITS: Final = {
    "-": "",
    "?": "UNKNOWN",
    "#": "instance",
    "%": "%",
    "A": "A",
    "a": "Ah",
    "b": "B",
    "d": "deg",
    "D": "deglatitude",
    "E": "rad/s",
    "G": "Gauss",
    "h": "degheading",
    "k": "deg/s",
    "m": "m",
    "n": "m/s",
    "o": "m/s/s",
    "O": "degC",
    "s": "s",
    "S": "satellites",
    "U": "deglongitude",
    "v": "V",
    "w": "Ohm",
    "X": "W.h",
    "Y": "us",
    "z": "Hz",
}
MULTIPLIERS: Final = {
    "-": 0.0,  # there is none
    "?": 1.0,  # unknown
    "0": 1.0,
    "B": 1e-2,
    "C": 1e-3,
    "F": 1e-6,
    "G": 1e-7,
}


class Record:
    """One kind of record."""

    __slots__ = ("_head", "_pack", "_size", "columns", "letters", "multipliers", "name", "units")

    def __init__(
        self, number: int, name: str, letters: str, columns: str, units: str, multipliers: str
    ) -> None:
        self.name: Final = name
        self.letters: Final = letters
        self.columns: Final = columns
        self.units: Final = units
        self.multipliers: Final = multipliers
        if not len(letters) == len(columns.split(",")) == len(units) == len(multipliers):
            raise AssertionError(f"{name}: a field without a letter, a unit or a multiplier")
        body = struct.Struct("<" + "".join(_LETTERS[letter] for letter in letters))
        self._pack = body.pack
        self._size = body.size + len(HEAD) + 1
        self._head = HEAD + bytes((number,))

    @property
    def number(self) -> int:
        return self._head[-1]

    def data(self, *values: float | bytes) -> bytes:
        """Raises `struct.error` for what does not fit."""
        return self._head + self._pack(*values)

    def format(self) -> bytes:
        return FMT.data(
            self.number,
            self._size,
            self.name.encode("ascii"),
            self.letters.encode("ascii"),
            self.columns.encode("ascii"),
        )

    def format_units(self, time_us: int) -> bytes:
        units, multipliers = self.units.encode("ascii"), self.multipliers.encode("ascii")
        return FMTU.data(time_us, self.number, units, multipliers)


# fmt: off
FMT = Record(128, "FMT", "BBnNZ", "Type,Length,Name,Format,Columns", "-b---", "-----")
UNIT = Record(106, "UNIT", "QbZ", "TimeUS,Id,Label", "s--", "F--")
MULT = Record(107, "MULT", "Qbd", "TimeUS,Id,Mult", "s--", "F--")
FMTU = Record(105, "FMTU", "QBNN", "TimeUS,FmtType,UnitIds,MultIds", "s---", "F---")
# fmt: on

DEFINING: Final = (FMT, UNIT, FMTU, MULT)


def definitions(time_us: int, records: tuple[Record, ...]) -> bytes:
    """What stands first in a file: all formats, then the letters, then who uses them."""
    every = (*DEFINING, *records)
    return b"".join(
        (
            *(record.format() for record in every),
            *(
                UNIT.data(time_us, ord(letter), unit.encode("ascii"))
                for letter, unit in UNITS.items()
            ),
            *(MULT.data(time_us, ord(letter), factor) for letter, factor in MULTIPLIERS.items()),
            *(record.format_units(time_us) for record in every),
        )
    )
