"""Values over time, reduced while they come in: minimum and maximum of every stretch are kept.

A plot is about 1,000 pixels wide, a log may have millions of values.  `Series` keeps at most
`MAX_ROWS` rows: when there are more, neighbouring stretches are joined, and a stretch of several
rows is drawn as two, its least and its greatest value in the order in which they came.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from math import isfinite
from typing import TypeAlias

MAX_ROWS = 2_000
BREAK_S = 3.0
"""The line of a plot is not drawn across a gap longer than this, or than three stretches."""

Values: TypeAlias = Sequence[float | None]


@dataclass(slots=True)
class _Range:
    """Least and greatest of one column in one stretch; None where no row had a value."""

    low: float | None
    high: float | None
    low_first: bool = True

    @classmethod
    def of(cls, value: float | None) -> _Range:
        known = value if value is not None and isfinite(value) else None
        return cls(known, known)

    def join(self, later: _Range) -> None:
        if later.low is None or later.high is None:
            return
        if self.low is None or self.high is None:
            self.low, self.high, self.low_first = later.low, later.high, later.low_first
            return
        new_low, new_high = later.low < self.low, later.high > self.high
        if new_low and new_high:
            self.low_first = later.low_first
        elif new_low or new_high:
            self.low_first = new_high
        self.low, self.high = min(self.low, later.low), max(self.high, later.high)


@dataclass(slots=True)
class _Stretch:
    first_s: float
    last_s: float
    rows: int
    ranges: list[_Range]

    def join(self, later: _Stretch) -> None:
        self.last_s = later.last_s
        self.rows += later.rows
        for mine, theirs in zip(self.ranges, later.ranges, strict=True):
            mine.join(theirs)


@dataclass(slots=True)
class Series:
    """Columns over one time axis.  `add` takes rows in time order."""

    names: tuple[str, ...]
    _stretches: list[_Stretch] = field(default_factory=list)
    _rows_each: int = 1

    def add(self, t_s: float, values: Values) -> None:
        """One row, a value for each name; None and NaN are unknown."""
        row = _Stretch(t_s, t_s, 1, [_Range.of(value) for value in values])
        last = self._stretches[-1] if self._stretches else None
        if last is not None and last.rows < self._rows_each:
            last.join(row)
            return
        self._stretches.append(row)
        while len(self._stretches) * (1 if self._rows_each == 1 else 2) > MAX_ROWS:
            self._halve()

    def _halve(self) -> None:
        self._rows_each *= 2
        pairs = zip(self._stretches[::2], self._stretches[1::2], strict=False)
        odd = self._stretches[len(self._stretches) // 2 * 2 :]
        joined = []
        for first, second in pairs:
            first.join(second)
            joined.append(first)
        self._stretches = joined + odd

    @property
    def empty(self) -> bool:
        """Nothing that could be drawn was added."""
        return not any(r.low is not None for s in self._stretches for r in s.ranges)

    def rows(self) -> list[tuple[float, list[float | None]]]:
        """The rows to draw, times rising, with a row of None where there is a gap."""
        rows: list[tuple[float, list[float | None]]] = []
        before: _Stretch | None = None
        for stretch in self._stretches:
            longest_s = BREAK_S
            if before is not None:
                longest_s = max(BREAK_S, 3.0 * (before.last_s - before.first_s))
            if before is not None and stretch.first_s - before.last_s > longest_s:
                middle_s = (before.last_s + stretch.first_s) / 2
                rows.append((middle_s, [None] * len(self.names)))
            rows += _drawn(stretch)
            before = stretch
        return rows


def _drawn(stretch: _Stretch) -> list[tuple[float, list[float | None]]]:
    if stretch.rows == 1 or stretch.last_s <= stretch.first_s:
        return [(stretch.first_s, [r.high for r in stretch.ranges])]
    one = [r.low if r.low_first else r.high for r in stretch.ranges]
    two = [r.high if r.low_first else r.low for r in stretch.ranges]
    return [(stretch.first_s, one), (stretch.last_s, two)]
