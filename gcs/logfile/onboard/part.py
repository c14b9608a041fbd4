"""What the readers of autopilots' own logs give: the log in parts, each as tables.

A part is what begins in one window of the file, so memory stays bounded whatever the file's size.
All parts together are the file: what is no message is told as a gap, with its place.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, NamedTuple, Protocol

import numpy as np

from gcs.logfile.columns.layout import Records
from gcs.mcap_file.chunk_reader import Index

WINDOW_BYTES = 4 << 20
LONGEST_GAP = 64 << 10
"""A longer one is told in pieces."""
FIRST_TIMES = 5


class Rows(NamedTuple):
    """Messages of one kind, in the order of the file; the first column is `time_ns`.

    That is when the message says that it was logged, ns since 1970 or since the start; where it
    says nothing, the time of the message before it.
    """

    name: str
    offsets: Index
    """Where each begins in the file."""
    rows: Records


class Gap(NamedTuple):
    """Bytes of the file that are no message."""

    offset: int
    time_ns: int
    """Of the message before it."""
    raw: bytes


@dataclass(slots=True)
class Part:
    """A stretch of a log."""

    read_bytes: int
    """How much of the file has been read."""
    tables: list[Rows] = field(default_factory=list)
    gaps: list[Gap] = field(default_factory=list)


class OnboardLog(Protocol):
    """A log that is open for reading, again and again."""

    path: Path
    first_ns: int
    """A time near which its messages begin."""

    def parts(self, only: Collection[str] | None = None) -> Iterator[Part]:
        """The whole file in order; with `only`, tables of these names alone, and no gaps.

        Raises BadLogError where nothing can be read, and OSError.
        """
        ...


class GapsBetween:
    """Finds what lies between the messages, however the file is cut into windows."""

    def __init__(self, read: Callable[[int, int], bytes], begin: int) -> None:
        self._read = read
        self._from = begin
        """Up to here everything was told, as message or gap."""
        self._time_ns = 0

    def between(self, starts: Index, ends: Index, time_ns: Index) -> Iterator[Gap]:
        """More messages, in order: what lies before and between them."""
        if not len(starts):
            return
        before = np.concatenate(([self._from], ends[:-1]))
        when_ns = np.concatenate(([self._time_ns], time_ns[:-1]))
        for number in np.flatnonzero(starts > before).tolist():
            self._from, self._time_ns = int(before[number]), int(when_ns[number])
            yield from self.upto(int(starts[number]))
        self._from, self._time_ns = int(ends[-1]), int(time_ns[-1])

    def upto(self, place: int, *, more_follows: bool = False) -> Iterator[Gap]:
        """There is no message before `place`.  Where the gap may go on, only whole pieces of it."""
        while self._from < place:
            end = min(place, self._from + LONGEST_GAP)
            if more_follows and end - self._from < LONGEST_GAP:
                break
            yield Gap(self._from, self._time_ns, self._read(self._from, end))
            self._from = end


def middle_of(times_ns: list[int]) -> int:
    """Of the first ones: a damaged time among them is not where the log begins."""
    first = sorted(times_ns[:FIRST_TIMES])
    return first[len(first) // 2] if first else 0


def filled(told_ns: Index, last_ns: int) -> Index:
    """Where a time is -1, the one before it; before the first one `last_ns`."""
    known = np.maximum.accumulate(np.where(told_ns >= 0, np.arange(len(told_ns)), -1))
    times_ns: Index = np.where(known >= 0, told_ns[known], last_ns)
    return times_ns


def groups_of(numbers: Any) -> list[Index]:
    """The places of each number that occurs."""
    order = np.argsort(numbers, kind="stable")
    parts = np.split(order, np.flatnonzero(np.diff(numbers[order])) + 1)
    return [part for part in parts if len(part)]
