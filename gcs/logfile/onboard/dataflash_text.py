"""Reads ArduPilot's DataFlash logs in their text form (.log), in windows.

A message is a line, `NAME, value, value`, and its columns are what the line `FMT` of that name
says.  A line that is not so is a gap.  What has a multiplier has it applied, lists are text as they
stand there, and so is the mode, which has its name.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator
from typing import Any, NamedTuple

import numpy as np

from gcs.logfile.columns.layout import Records
from gcs.logfile.onboard.dataflash_format import Format, Formats
from gcs.logfile.onboard.dataflash_log import Head
from gcs.logfile.onboard.mapped import MappedFile
from gcs.logfile.onboard.part import GapsBetween, Part, Rows, filled
from gcs.logfile.packed import TIME_FIELD

FIRST_WORD = b"FMT,"
_LONGEST_LINE = 16 << 10


class _Line(NamedTuple):
    """A message; `values` are as many as its format has columns."""

    start: int
    end: int
    values: list[bytes]


class OnceOverText:
    """One way over the file."""

    def __init__(self, file: MappedFile, head: Head, only: Collection[str] | None) -> None:
        self._file = file
        self._only = only
        self._base_ns = head.base_ns
        self._last_ns = head.first_ns
        self._formats = Formats(text=True)
        self._of_name: dict[bytes, Format] = {b"FMT": self._formats.all[0]}
        at = file.find(FIRST_WORD, 0, len(file))
        self._separator = b", " if file.read(at, at + 5) == b"FMT, " else b","
        self._gaps = GapsBetween(file.read, 0)

    def parts(self, window_bytes: int) -> Iterator[Part]:
        at, size = 0, len(self._file)
        while at < size:
            end = self._line_end(min(size, at + window_bytes))
            lines = self._lines(at, end)
            at = end
            part = Part(read_bytes=at)
            tables = [(format_, *_table(format_, mine)) for format_, mine in lines.items()]
            self._give_times(part, tables)
            if self._only is None:
                part.gaps += self._gaps.upto(at, more_follows=at < size)
            yield part
            self._file.done(at)

    def _line_end(self, at: int) -> int:
        """Behind the line that has the byte before `at`."""
        end = self._file.find(b"\n", at - 1, min(len(self._file), at + _LONGEST_LINE))
        return end + 1 if end >= 0 else min(len(self._file), at + _LONGEST_LINE)

    def _lines(self, begin: int, end: int) -> dict[Format, list[_Line]]:
        found: dict[Format, list[_Line]] = {}
        separator, of_name = self._separator, self._of_name
        start = begin
        for text in self._file.read(begin, end).split(b"\n"):
            after = start + len(text) + 1
            name, _, rest = text.partition(separator)
            format_ = of_name.get(name)
            if format_ is not None and (self._is_wanted(format_) or name == b"FMT"):
                count = len(format_.columns)
                # The last column may have the separator in its text.
                values = rest.rstrip(b"\r").split(separator, count - 1)
                if len(values) == count:
                    found.setdefault(format_, []).append(_Line(start, min(after, end), values))
                    if name == b"FMT":
                        self._learn(values)
            start = after
        return found

    def _is_wanted(self, format_: Format) -> bool:
        return self._only is None or format_.name in self._only

    def _learn(self, values: list[bytes]) -> None:
        kind, size, name, letters, columns = (value.decode("utf-8", "replace") for value in values)
        if not (kind.strip().isdecimal() and size.strip().isdecimal()):
            return
        number = self._formats.learn((int(kind), int(size), name, letters, columns))
        if number is not None:
            made = self._formats.all[number]
            if (made.table.names or ())[1:] == made.columns:
                self._of_name[values[2]] = made

    def _give_times(self, part: Part, tables: list[tuple[Format, list[_Line], Records]]) -> None:
        """Each has its own time, else that of the one before; then what is no line is known."""
        lines = [line for _, mine, _ in tables for line in mine]
        starts = np.array([line.start for line in lines], np.int64)
        ends = np.array([line.end for line in lines], np.int64)
        told = [rows[TIME_FIELD] for _, _, rows in tables]
        time_ns = np.concatenate([np.zeros(0, np.int64), *told])
        time_ns[time_ns >= 0] += self._base_ns
        order = np.argsort(starts)
        time_ns[order] = filled(time_ns[order], self._last_ns)
        if len(order):
            self._last_ns = int(time_ns[order[-1]])
        if self._only is None:
            part.gaps += self._gaps.between(starts[order], ends[order], time_ns[order])
        at = 0
        for format_, mine, rows in tables:
            part_of = slice(at, at + len(mine))
            at += len(mine)
            rows[TIME_FIELD] = time_ns[part_of]
            if len(mine) and self._is_wanted(format_):
                part.tables.append(Rows(format_.name, starts[part_of], rows))


def _table(format_: Format, lines: list[_Line]) -> tuple[list[_Line], Records]:
    """Those lines whose values are what their columns say; times are -1 where none is told."""
    try:
        return lines, _rows(format_, lines)
    except (ValueError, OverflowError):
        kept = [line for line in lines if _is_readable(format_, line)]
        return kept, _rows(format_, kept)


def _is_readable(format_: Format, line: _Line) -> bool:
    try:
        _rows(format_, [line])
    except (ValueError, OverflowError):
        return False
    return True


def _rows(format_: Format, lines: list[_Line]) -> Records:
    """Raises ValueError and OverflowError."""
    made = np.zeros(len(lines), format_.table)
    if not lines:
        return made
    columns = zip(*(line.values for line in lines), strict=True)
    for name, values in zip(format_.columns, columns, strict=True):
        made[name] = _numbers(values, format_.table[name])
    made[TIME_FIELD] = -1
    if format_.time is not None:
        limit = 2**62 // format_.time.ns
        told = np.minimum(made[format_.time.name].astype(np.float64), limit)
        made[TIME_FIELD] = told.astype(np.int64) * format_.time.ns
    return made


def _numbers(values: tuple[bytes, ...], code: np.dtype[Any]) -> Any:
    """Raises ValueError and OverflowError."""
    if code.kind == "S":
        if max(map(len, values), default=0) > code.itemsize:
            raise ValueError
        return values
    if code.kind == "f":
        return list(map(float, values))
    numbers = list(map(int, values))
    limits = np.iinfo(code)
    if numbers and not (limits.min <= min(numbers) and max(numbers) <= limits.max):
        raise OverflowError
    return numbers
