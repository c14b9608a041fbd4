"""Many vectors at once: a row of numbers for each place of a vector, a column for each vector."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Final, TypeAlias

import numpy as np
import numpy.typing as npt

from tests.proof.vector import PLACE, Vector

Columns: TypeAlias = npt.NDArray[np.int64]
"""`columns[place][number]` is what stands at `place` of the vector with that number."""

Numbers: TypeAlias = npt.NDArray[Any]
"""One number, or one yes or no, for each of some vectors."""

HEIGHT: Final = 1 + len(PLACE)
NEVER: Final = -(1 << 62)
"""Stands for a time that there is not, which is None in a vector."""


def columns_of(vectors: Sequence[Vector]) -> Columns:
    """The vectors in their order."""
    columns = np.empty((HEIGHT, len(vectors)), dtype=np.int64)
    for number, vector in enumerate(vectors):
        columns[:, number] = [NEVER if value is None else value for value in vector]
    return columns


def vector_at(columns: Columns, number: int) -> Vector:
    """One of the vectors."""
    return [None if value == NEVER else value for value in columns[:, number].tolist()]


class Growing:
    """Columns to which others are added at the end."""

    def __init__(self, columns: Columns) -> None:
        self._columns = columns
        self.count: int = columns.shape[1]

    def add(self, columns: Columns) -> None:
        count = self.count + columns.shape[1]
        if count > self._columns.shape[1]:
            wider = np.empty((HEIGHT, 2 * count), dtype=np.int64)
            wider[:, : self.count] = self.some(0, self.count)
            self._columns = wider
        self._columns[:, self.count : count] = columns
        self.count = count

    def some(self, first: int, end: int) -> Columns:
        """Those from `first` on, before `end`."""
        return self._columns[:, first:end]
