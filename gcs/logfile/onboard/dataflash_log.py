"""A DataFlash log of either form, and what must be known of it before its messages are told."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Protocol, TypeAlias

import numpy as np

from gcs.logfile.columns.layout import Records
from gcs.logfile.onboard.mapped import MappedFile
from gcs.logfile.onboard.part import FIRST_TIMES, Part, middle_of
from gcs.logfile.packed import TIME_FIELD
from gcs.mcap_file.chunk_reader import Index

_SEARCHED_BYTES = 8 << 20
"""Parameters and the firmware's name stand within so many."""
_SYSTEM_ID = (b"SYSID_THISMAV", b"MAV_SYSID")
"""Of ArduCopter 4.5 and of 4.7."""
_GPS_EPOCH_S = 315_964_800
"""1980-01-06, s since 1970."""
_LEAP_S = 18
"""GPS time is so far ahead of UTC since 2017."""
_WEEK_S = 7 * 86_400


@dataclass(slots=True)
class Head:
    base_ns: int = 0
    """What is to be added to its times, so that they are UTC; 0: no GPS told the time."""
    first_ns: int = 0
    system_id: int = 1
    is_copter: bool = False


class Once(Protocol):
    """One way over a file."""

    def parts(self, window_bytes: int) -> Iterator[Part]: ...


MakeOnce: TypeAlias = Callable[[MappedFile, Head, "Collection[str] | None"], Once]


class DataflashLog:
    """Raises OSError."""

    def __init__(self, path: Path, make: MakeOnce, window_bytes: int) -> None:
        self.path = path
        self._make = make
        self._window_bytes = window_bytes
        self.head = Head()
        self.head = _head_of(self.parts(("GPS", "PARM", "MSG")))
        self.first_ns = self.head.first_ns

    def parts(self, only: Collection[str] | None = None) -> Iterator[Part]:
        return self._make(MappedFile(self.path), self.head, only).parts(self._window_bytes)


def _head_of(parts: Iterator[Part]) -> Head:
    """As far as the first GPS time; a log without one is read whole."""
    head = Head()
    first_ns: list[int] = []
    for part in parts:
        times: list[tuple[int, int]] = []
        for name, offsets, rows in part.tables:
            early = rows[offsets < _SEARCHED_BYTES]
            _look_at(head, name, early, rows)
            first = slice(min(len(early), FIRST_TIMES))
            times += zip(offsets[first].tolist(), early[TIME_FIELD][first].tolist(), strict=True)
        first_ns += [time_ns for _, time_ns in sorted(times)]
        if head.base_ns and part.read_bytes >= _SEARCHED_BYTES:
            break
    head.first_ns = head.base_ns + middle_of(first_ns)
    return head


def _look_at(head: Head, name: str, early: Records, rows: Records) -> None:
    names = set(rows.dtype.names or ())
    if name == "PARM" and {"Name", "Value"} <= names:
        for value in early["Value"][np.isin(early["Name"], _SYSTEM_ID)].tolist():
            if 0 < value < 256:
                head.system_id = int(value)
    elif name == "MSG" and "Message" in names:
        head.is_copter |= any(b"ArduCopter" in text for text in early["Message"].tolist())
    elif name == "GPS" and not head.base_ns:
        head.base_ns = _base_ns(rows, names)


def _base_ns(rows: Records, names: set[str]) -> int:
    """By the first message with a week, as the autopilot's time was then."""
    for week, ms in (("GWk", "GMS"), ("Week", "TimeMS")):
        if {week, ms} <= names:
            known: Index = np.flatnonzero(rows[week] > 0)
            if len(known):
                return _utc_ns(rows[known[0]], week, ms) - int(rows[TIME_FIELD][known[0]])
    return 0


def _utc_ns(row: Any, week: str, ms: str) -> int:
    seconds = _GPS_EPOCH_S + int(row[week]) * _WEEK_S - _LEAP_S
    return seconds * 1_000_000_000 + int(row[ms]) * 1_000_000
