"""Reads ArduPilot's DataFlash logs in their binary form (.BIN), in windows.

A message is A3 95, its type, and what the FMT message of that type says.  Where no message of a
known type begins, the bytes up to the next one are a gap.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator
from typing import Any

import numpy as np

from gcs.logfile.onboard.dataflash_format import FMT, HEAD_BYTES, Formats, text_of
from gcs.logfile.onboard.dataflash_log import Head
from gcs.logfile.onboard.mapped import MappedFile, chain
from gcs.logfile.onboard.part import GapsBetween, Part, Rows, filled, groups_of
from gcs.mcap_file.chunk_reader import Bytes, Index, rows_at

_MAGIC = (0xA3, 0x95)
_LEAST_SPAN = 4 << 10
"""Behind a new format so many bytes are looked at; while there is no newer one always more."""


class OnceOverBinary:
    """One way over the file."""

    def __init__(self, file: MappedFile, head: Head, only: Collection[str] | None) -> None:
        self._file = file
        self._data = file.data
        self._only = only
        self._base_ns = head.base_ns
        self._last_ns = head.first_ns
        self._formats = Formats()
        self._number_of = np.zeros(256, np.int32)
        """Of each type the number of its format."""
        self._size_of = np.zeros(256, np.int64)
        """Of each type the bytes of a message; 0: it is not known."""
        self._size_of[FMT] = self._formats.all[0].size
        self._span = _LEAST_SPAN
        self._gaps = GapsBetween(file.read, 0)

    def parts(self, window_bytes: int) -> Iterator[Part]:
        at, size = 0, len(self._file)
        while at < size:
            at, starts, numbers = self._messages(at, min(size, at + window_bytes))
            part = Part(read_bytes=min(at, size))
            time_ns = self._times(starts, numbers)
            self._fill(part, starts, numbers, time_ns)
            if self._only is None:
                sizes = np.array([each.size for each in self._formats.all], np.int64)
                part.gaps += self._gaps.between(starts, starts + sizes[numbers], time_ns)
                part.gaps += self._gaps.upto(min(at, size), more_follows=at < size)
            yield part
            self._file.done(at)

    def _messages(self, at: int, stop: int) -> tuple[int, Index, Any]:
        """How far it was read, where messages begin, and the numbers of their formats."""
        starts, numbers = [np.zeros(0, np.int64)], [np.zeros(0, np.int32)]
        while at < stop:
            begin, end = at, min(stop, at + self._span)
            found, kinds = self._candidates(begin, end)
            ends = found + self._size_of[kinds]
            behind = np.append(found, end)
            taken, at = chain(found, ends, begin, end, lambda _, n: int(behind[n]))  # noqa: B023
            found, kinds, ends = found[taken], kinds[taken], ends[taken]
            known = self._number_of[kinds]
            learned = self._learn(found, kinds)
            if learned:
                found, known, at = found[:learned], known[:learned], int(ends[learned - 1])
            self._span = _LEAST_SPAN if learned else 2 * self._span
            starts.append(found)
            numbers.append(known)
        return at, np.concatenate(starts), np.concatenate(numbers)

    def _candidates(self, begin: int, end: int) -> tuple[Index, Bytes]:
        """Where a header of a known type stands before `end`, and that type."""
        data = self._data
        places = self._file.places_of(_MAGIC[0], begin, min(end, len(data) - HEAD_BYTES + 1))
        places = places[data[places + 1] == _MAGIC[1]]
        kinds = data[places + 2]
        size = self._size_of[kinds]
        whole = (size > 0) & (places + size <= len(data))
        return places[whole], kinds[whole]

    def _learn(self, starts: Index, kinds: Bytes) -> int:
        """How many of these messages stand before the first that needs a new format; 0: all."""
        learned = 0
        for number in np.flatnonzero(kinds == FMT).tolist():
            if learned and (number != learned or starts[number] != starts[number - 1] + self._fmt):
                break
            if self._learn_one(int(starts[number])) or learned:
                learned = number + 1
        return learned

    @property
    def _fmt(self) -> int:
        return self._formats.all[0].size

    def _learn_one(self, start: int) -> bool:
        raw = self._file.read(start + HEAD_BYTES, start + self._fmt)
        texts = text_of(raw[2:6]), text_of(raw[6:22]), text_of(raw[22:])
        number = self._formats.learn((raw[0], raw[1], *texts))
        if number is None:
            return False
        self._number_of[raw[0]], self._size_of[raw[0]] = number, raw[1]
        return True

    def _times(self, starts: Index, numbers: Any) -> Index:
        """What each says, else the time of the one before."""
        time_ns = np.full(len(starts), -1, np.int64)
        columns: dict[tuple[int, Any, int], list[int]] = {}
        for number in np.unique(numbers).tolist():
            time = self._formats.all[number].time
            if time is not None:
                columns.setdefault((time.offset, time.code, time.ns), []).append(number)
        for (offset, code, ns), mine in columns.items():
            which = np.flatnonzero(np.isin(numbers, mine))
            raw = rows_at(self._data, starts[which] + (HEAD_BYTES + offset), code.itemsize)
            time_ns[which] = self._base_ns + _ns(raw.view(code).ravel(), ns)
        time_ns = filled(time_ns, self._last_ns)
        if len(time_ns):
            self._last_ns = int(time_ns[-1])
        return time_ns

    def _fill(self, part: Part, starts: Index, numbers: Any, time_ns: Index) -> None:
        for group in groups_of(numbers):
            format_ = self._formats.all[numbers[group[0]]]
            if self._only is None or format_.name in self._only:
                places = starts[group]
                rows = format_.rows(self._data, places, time_ns[group])
                part.tables.append(Rows(format_.name, places, rows))


def _ns(told: Any, ns: int) -> Index:
    """Of a time that damage may have made any number: within 63 bits, with room for a base."""
    limit = 2**62 // ns
    if told.dtype.kind == "i":
        told = np.maximum(told, 0)
    in_ns: Index = np.minimum(told.astype(np.uint64), np.uint64(limit)).astype(np.int64) * ns
    return in_ns
