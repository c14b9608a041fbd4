"""Height, speed and battery of the last ten minutes, for a wide screen."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Final

from rich.text import Text

from gcs.tui.flight_numbers import FlightNumbers, Sample
from gcs.tui.plot import Curve, draw

LAST_NS: Final = 600_000_000_000
CURVES: Final[tuple[tuple[str, Callable[[Sample], float | None]], ...]] = (
    ("height, m", lambda sample: sample.up_m),
    ("speed, m/s", lambda sample: sample.speed_m_s),
    ("battery, %", lambda sample: sample.battery_pct),
)
LEGEND_ROWS: Final = 1
LEAST_ROWS: Final = 6


class Graphs:
    """Drawn anew once there is another sample, so once a second."""

    def __init__(self, numbers: FlightNumbers) -> None:
        self._numbers = numbers
        self._drawn_for: tuple[object, ...] = ()
        self._drawn = Text("")

    def draw(self, columns: int, rows: int) -> Text:
        samples = self._numbers.samples
        drawn_for = (columns, rows, len(samples), samples[-1].time_ns if samples else 0)
        if drawn_for != self._drawn_for:
            self._drawn_for, self._drawn = drawn_for, self._anew(columns, rows)
        return self._drawn

    def _anew(self, columns: int, rows: int) -> Text:
        samples = self._numbers.samples
        each_rows = rows // len(CURVES)
        if not samples or each_rows < LEAST_ROWS:
            return Text("nothing flown yet" if not samples else "")
        last_ns = samples[-1].time_ns
        shown = [each for each in samples if last_ns - each.time_ns <= LAST_NS]
        picture = Text(no_wrap=True, end="")
        for n, (name, value) in enumerate(CURVES):
            points = [((each.time_ns - last_ns) / 1e9, _or_nan(value(each))) for each in shown]
            picture.append("\n" if n else "")
            picture.append_text(
                draw([Curve(name, points)], columns, each_rows - LEGEND_ROWS - 1, "seconds")
            )
        return picture


def _or_nan(value: float | None) -> float:
    """A value that was not known breaks the curve."""
    return math.nan if value is None else value
