"""Curves over time on braille cells: axes, figures, a legend; readable without colours too."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from rich.text import Text

from gcs.tui.braille import Canvas

STYLES = ("green", "cyan", "yellow", "magenta", "red", "blue")
DASHES = (1, 3, 5, 2, 7, 4)
"""Each curve draws every n-th dot, so that curves differ without colours."""
MARKS = "abcdef"
MAX_CURVES = len(MARKS)
LEFT = 10
LEAST_COLUMNS, LEAST_ROWS = LEFT + 20, 5


@dataclass(frozen=True, slots=True)
class Curve:
    """`points`: seconds, value, in order of time; a value that is not finite breaks the curve."""

    name: str
    points: Sequence[tuple[float, float]]


def draw(curves: Sequence[Curve], columns: int, rows: int, counted: str = "messages") -> Text:
    """The picture, `rows` lines and one of legend a curve.  At most `MAX_CURVES` curves.
    `counted`: what one point is."""
    columns, rows = max(columns, LEAST_COLUMNS), max(rows, LEAST_ROWS)
    seen = [(t, v) for curve in curves for t, v in curve.points if math.isfinite(v)]
    if not seen:
        return Text("nothing to draw yet")
    t_low, t_high = min(t for t, _ in seen), max(t for t, _ in seen)
    low, high = _widened(min(v for _, v in seen), max(v for _, v in seen))
    canvas = Canvas(columns - LEFT, rows - 1)
    x_scale = (canvas.width - 3) / (t_high - t_low) if t_high > t_low else 0.0
    y_scale = (canvas.height - 1) / (high - low)

    def place(t: float, v: float) -> tuple[float, float]:
        return (t - t_low) * x_scale, (high - v) * y_scale

    for number, curve in enumerate(curves):
        style = STYLES[number]
        last = None
        for t, v in curve.points:
            here = place(t, v) if math.isfinite(v) else None
            if last is not None and here is not None:
                canvas.line(last, here, style, every=DASHES[number])
            elif here is not None:
                canvas.dot(*here, style)
            last = here
        ends = [place(t, v) for t, v in curve.points if math.isfinite(v)]
        if ends and len(curves) > 1:
            canvas.glyph(min(ends[-1][0] + 2, canvas.width - 1), ends[-1][1], MARKS[number], style)
    picture = _with_figures([*canvas.render().split("\n")], low, high)
    picture.append(_time_axis(t_low, t_high, columns), "dim")
    for number, curve in enumerate(curves):
        values = [v for _, v in curve.points if math.isfinite(v)]
        mark = f"{MARKS[number]} " if len(curves) > 1 else ""
        picture.append(f"\n{mark}{curve.name}", f"bold {STYLES[number]}")
        if values:
            now, least, most = (_figure(v) for v in (values[-1], min(values), max(values)))
            picture.append(f"  last {now}  min {least}  max {most}  ({len(values)} {counted})")
    return picture


def _with_figures(lines: Sequence[Text], low: float, high: float) -> Text:
    rows = len(lines)
    ticks = {
        round((rows - 1) * part): _figure(high - (high - low) * part)
        for part in (0, 0.25, 0.5, 0.75, 1)
    }
    picture = Text(no_wrap=True, end="")
    for row, line in enumerate(lines):
        picture.append(f"{ticks.get(row, ''):>{LEFT - 2}} ", "dim")
        picture.append("┤" if row in ticks else "│", "dim")
        picture.append_text(line)
        picture.append("\n")
    return picture


def _time_axis(t_low: float, t_high: float, columns: int) -> str:
    left, right = f"{t_low:.1f} s", f"{t_high:.1f} s"
    room = max(1, columns - LEFT - len(left) - len(right))
    return " " * LEFT + left + " " * room + right


def _widened(low: float, high: float) -> tuple[float, float]:
    """A curve that is flat stands in the middle."""
    if high - low > 1e-9 * max(abs(low), abs(high), 1e-9):
        return low, high
    room = max(abs(high) * 0.1, 0.5)
    return low - room, high + room


def _figure(value: float) -> str:
    size = abs(value)
    if size >= 1e7 or 0 < size < 1e-3:
        return f"{value:.2e}"
    return f"{value:.{3 if size < 10 else 2 if size < 1000 else 0}f}"
