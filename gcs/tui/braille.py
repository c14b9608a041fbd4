"""A small drawing surface of Unicode braille: eight dots a cell, a style a cell, glyphs on top."""

from __future__ import annotations

import itertools
from operator import itemgetter
from typing import Final

from rich.text import Text

Point = tuple[float, float]

_BLANK: Final = 0x2800
# Unicode braille, dots by (column, row) of the cell: the bits are not in reading order.
_BITS: Final[tuple[tuple[int, ...], ...]] = ((0x01, 0x02, 0x04, 0x40), (0x08, 0x10, 0x20, 0x80))


class Canvas:
    """`columns` x `rows` cells, so twice as many dots across and four times as many down.

    Dots are addressed from the top left; whatever lies outside is not drawn.  A cell takes the
    style of what was drawn in it last, and a glyph hides the dots of its cell.
    """

    def __init__(self, columns: int, rows: int) -> None:
        self.columns, self.rows = columns, rows
        self.width, self.height = 2 * columns, 4 * rows
        self._dots = [[0] * columns for _ in range(rows)]
        self._styles = [[""] * columns for _ in range(rows)]
        self._glyphs: dict[tuple[int, int], tuple[str, str]] = {}
        self._used: set[int] = set()
        """Rows of cells in which anything was drawn."""

    def dot(self, x: float, y: float, style: str) -> None:
        column, row = int(x // 2), int(y // 4)
        if 0 <= column < self.columns and 0 <= row < self.rows:
            self._dots[row][column] |= _BITS[int(x) % 2][int(y) % 4]
            self._styles[row][column] = style
            self._used.add(row)

    def line(self, start: Point, end: Point, style: str, *, every: int = 1) -> None:
        """A straight line; `every` 3 draws each third dot."""
        clipped = clip(start, end, self.width - 1, self.height - 1)
        if clipped is None:
            return
        (x0, y0), (x1, y1) = clipped
        steps = int(max(abs(x1 - x0), abs(y1 - y0))) + 1
        for i in range(0, steps + 1, every):
            self.dot(x0 + (x1 - x0) * i / steps, y0 + (y1 - y0) * i / steps, style)

    def path(self, points: list[Point], style: str, *, every: int = 1) -> None:
        """Lines from dot to dot: points that fall in the dot of the one before are passed over."""
        kept = points[:1]
        for point in points[1:-1]:
            if int(point[0]) != int(kept[-1][0]) or int(point[1]) != int(kept[-1][1]):
                kept.append(point)
        for start, end in itertools.pairwise([*kept, *points[1:][-1:]]):
            self.line(start, end, style, every=every)

    def glyph(self, x: float, y: float, char: str, style: str) -> None:
        """One character in the cell of a dot."""
        self.text(int(x // 2), int(y // 4), char, style)

    def text(self, column: int, row: int, text: str, style: str) -> None:
        """Characters in cells; what sticks out is cut."""
        for offset, char in enumerate(text):
            if 0 <= column + offset < self.columns and 0 <= row < self.rows:
                self._glyphs[column + offset, row] = (char, style)
                self._used.add(row)

    def render(self) -> Text:
        """The picture, one line a row of cells; neighbours of one style are one span."""
        picture = Text(no_wrap=True, end="")
        for row in range(self.rows):
            if row:
                picture.append("\n")
            if row not in self._used:
                picture.append(" " * self.columns)
                continue
            cells = [self._cell(column, row) for column in range(self.columns)]
            for style, run in itertools.groupby(cells, key=itemgetter(1)):
                picture.append("".join(char for char, _ in run), style)
        return picture

    def _cell(self, column: int, row: int) -> tuple[str, str]:
        """Character and style."""
        dots = self._dots[row][column]
        plain = (chr(_BLANK + dots), self._styles[row][column]) if dots else (" ", "")
        return self._glyphs.get((column, row), plain)


def clip(start: Point, end: Point, x_max: float, y_max: float) -> tuple[Point, Point] | None:
    """The part of a line inside [0, x_max] x [0, y_max], None for none (Liang and Barsky 1984)."""
    (x0, y0), (x1, y1) = start, end
    dx, dy = x1 - x0, y1 - y0
    enter, leave = 0.0, 1.0
    for towards, room in ((-dx, x0), (dx, x_max - x0), (-dy, y0), (dy, y_max - y0)):
        if towards == 0.0:
            if room < 0.0:
                return None
            continue
        at = room / towards
        if towards < 0.0:
            enter = max(enter, at)
        else:
            leave = min(leave, at)
        if enter > leave:
            return None
    return (x0 + enter * dx, y0 + enter * dy), (x0 + leave * dx, y0 + leave * dy)
