"""The plot of `gcs topic show`: redrawn in place on a terminal, printed once elsewhere."""

from __future__ import annotations

import sys
import time
from collections import deque
from types import TracebackType
from typing import TYPE_CHECKING

from rich.console import Console
from rich.live import Live
from rich.text import Text

from gcs.exit_codes import ExitCode
from gcs.operator.errors import ExitError
from gcs.topics.selector import path_text
from gcs.tui.plot import MAX_CURVES, Curve, draw

if TYPE_CHECKING:
    from gcs.topics.selector import Path
    from gcs.topics.topic import Heard, Value

REDRAW_S = 0.2
ROWS = 22
COLUMNS = 110


class Plot:
    """Collects the points; `window_s` None: all of a record, drawn at the end."""

    def __init__(self, window_s: float | None) -> None:
        self.curves: dict[str, deque[tuple[float, float]]] = {}
        self._window_s = window_s
        self._start_ns: int | None = None
        self._console = Console(highlight=False, markup=False)
        self._live: Live | None = None
        self._drawn_s = 0.0

    def __enter__(self) -> Plot:
        if self._window_s is not None and sys.stdout.isatty():
            self._live = Live(console=self._console, auto_refresh=False)
            self._live.start()
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        if self._live is not None:
            self._live.stop()
        elif kind is None and self.curves:
            self._console.print(self._picture(), soft_wrap=True)

    def add(self, heard: Heard, path: Path, value: Value) -> None:
        """Raises ExitError for what is no number, and for too many curves."""
        name = f"{heard.topic.name}{path_text(path)}"
        if isinstance(value, str | list | dict):
            raise ExitError(
                ExitCode.USAGE,
                f"{name}: is no number",
                "one field, or one element of an array: NAME.field[0]",
            )
        curve = self.curves.get(name)
        if curve is None:
            if len(self.curves) == MAX_CURVES:
                text = f"{name}: would be curve {MAX_CURVES + 1}; {MAX_CURVES} can be told apart"
                raise ExitError(ExitCode.USAGE, text, "name fewer, or one component's topic")
            curve = self.curves[name] = deque()
        if self._start_ns is None:
            self._start_ns = heard.time_ns
        t_s = (heard.time_ns - self._start_ns) / 1e9
        curve.append((t_s, float("nan") if value is None else float(value)))
        while self._window_s is not None and t_s - curve[0][0] > self._window_s:
            curve.popleft()

    def redraw(self) -> None:
        """Where it is watched, a few times a second."""
        now_s = time.monotonic()
        if self._live is not None and now_s - self._drawn_s >= REDRAW_S:
            self._drawn_s = now_s
            self._live.update(self._picture(), refresh=True)

    def _picture(self) -> Text:
        size = self._console.size
        shown = self._console.is_terminal
        columns = size.width - 1 if shown else COLUMNS
        rows = min(ROWS, size.height - len(self.curves) - 2) if shown else ROWS
        curves = [Curve(name, list(points)) for name, points in self.curves.items()]
        return draw(curves, columns, rows)
