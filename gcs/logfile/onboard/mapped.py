"""A file as one array of bytes, of which only what is being read is in memory; and messages that
follow one another in it."""

from __future__ import annotations

import mmap
from collections.abc import Callable
from pathlib import Path

import numpy as np

from gcs.mcap_file.chunk_reader import Bytes, Index
from gcs.mcap_file.reader import KEPT_BYTES, release

_CACHED_BYTES = 1 << 18


class MappedFile:
    """Raises OSError; the file must not be empty."""

    def __init__(self, path: Path) -> None:
        with open(path, "rb") as file:
            self._map = mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ)
        self.data: Bytes = np.frombuffer(self._map, np.uint8)
        self._kept_from = 0

    def __len__(self) -> int:
        return len(self.data)

    def read(self, begin: int, end: int) -> bytes:
        return self._map[begin:end]

    def find(self, what: bytes, begin: int, end: int) -> int:
        """Where it begins; -1 where it does not lie between."""
        return self._map.find(what, begin, end)

    def done(self, upto: int) -> None:
        """What is before `upto` is not needed again soon."""
        if upto - self._kept_from >= KEPT_BYTES:
            self._kept_from = release(self._map, self._kept_from, upto)

    def places_of(self, byte: int, begin: int, end: int) -> Index:
        """Where that byte is, in pieces that fit into the processor's cache."""
        places = [
            np.flatnonzero(self.data[first : min(end, first + _CACHED_BYTES)] == byte) + first
            for first in range(begin, end, _CACHED_BYTES)
        ]
        return np.concatenate(places) if places else np.zeros(0, np.int64)


def chain(
    starts: Index, ends: Index, at: int, stop: int, otherwise: Callable[[int, int], int | None]
) -> tuple[Index, int]:
    """Of candidates those that follow one another from `at` on, and where that ends.

    `starts` rise.  Where no candidate begins, `otherwise(at, number)` says where to go on; `number`
    is that of the next candidate.  None ends the chain.  There is a step of Python only where the
    candidates do not lie end to end.
    """
    last_of_run = np.flatnonzero(ends[:-1] != starts[1:])
    taken = []
    while at < stop:
        number = int(np.searchsorted(starts, at))
        if number < len(starts) and starts[number] == at:
            run = int(np.searchsorted(last_of_run, number))
            last = int(last_of_run[run]) if run < len(last_of_run) else len(starts) - 1
            taken.append(np.arange(number, last + 1))
            at = int(ends[last])
            continue
        onward = otherwise(at, number)
        if onward is None:
            break
        at = onward
    return (np.concatenate(taken) if taken else np.zeros(0, np.int64)), at
