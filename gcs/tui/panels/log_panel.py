"""The log under the panels: as wide as the screen, from a level on, and repeats folded."""

from __future__ import annotations

import re
import time
from collections import deque
from collections.abc import Iterable
from dataclasses import dataclass
from itertools import islice
from typing import Final

from rich.text import Text
from textual.events import MouseScrollDown, MouseScrollUp

from gcs import ipc
from gcs.operator.text import event_text
from gcs.tui import look
from gcs.tui.panels.panel import Panel

LOG_LINES: Final = 2000
WHEEL_ROWS: Final = 3
DEBUG, INFO, WARN = 1, 2, 3
NEXT_LEVEL: Final = {INFO: WARN, WARN: DEBUG, DEBUG: INFO}
LEVEL_NAMES: Final = {DEBUG: "debug and above", INFO: "info and above", WARN: "warnings and errors"}
_NUMBER = re.compile(r"\d+(\.\d+)?")


@dataclass(frozen=True, slots=True)
class Entry:
    """One line, and how it is drawn."""

    level: int
    line: Text


class LogPanel(Panel):
    """Shows what is said to it from `level` on, newest at the bottom, and keeps it all.

    Of equal lines that follow each other only the first is shown; how many came after it is said
    before the next other line.  Debug lines are equal if they differ in their numbers only.
    """

    def __init__(self) -> None:
        super().__init__(self._tail, "log")
        self.level = INFO
        self._entries: deque[Entry] = deque(maxlen=LOG_LINES)
        self._rows: deque[Text] = deque(maxlen=LOG_LINES)
        """What is shown of them, wrapped."""
        self._columns = 0
        self._back = 0
        """How many rows below are out of sight, by the wheel."""
        self._like = ""
        self._folded = 0
        self._last: tuple[str, str, int] = ("", "", INFO)
        self._sought = ""

    def tell(self, text: str, style: str, level: int = INFO, time_ns: int | None = None) -> None:
        """`time_ns` of the wall clock; None is now."""
        like = _NUMBER.sub("#", text) if level == DEBUG else text
        stamp = time.strftime(
            "%H:%M:%S ", time.localtime(None if time_ns is None else time_ns / 1e9)
        )
        if like == self._like:
            self._folded += 1
            self._last = (stamp, style, level)
            return
        self.tell_folded()
        self._like = like
        self._add(stamp, text, style, level)

    def before(self, lines: Iterable[ipc.LogEvent]) -> None:
        """What was said before this screen was there."""
        for line in lines:
            self.tell(event_text.log_line(line), look.LEVEL[line.level], line.level, line.time_ns)

    def tell_folded(self) -> None:
        """Say now how often the last line has come again."""
        if self._folded:
            stamp, style, level = self._last
            times = "once" if self._folded == 1 else f"{self._folded} times"
            self._add(stamp, f"  … the like of it {times} more", style, level)
            self._folded = 0

    def cycle_level(self) -> str:
        """The next level; returns its name."""
        self.level = NEXT_LEVEL[self.level]
        self._write_again()
        return LEVEL_NAMES[self.level]

    def search(self, text: str) -> None:
        """Show only lines with this in them, in any case of letters; empty shows all again."""
        if text.lower() != self._sought:
            self._sought = text.lower()
            self._write_again()

    def on_mouse_scroll_up(self, event: MouseScrollUp) -> None:
        self._scroll(event, WHEEL_ROWS)

    def on_mouse_scroll_down(self, event: MouseScrollDown) -> None:
        self._scroll(event, -WHEEL_ROWS)

    def _scroll(self, event: MouseScrollUp | MouseScrollDown, rows: int) -> None:
        event.stop()
        self._back = max(0, min(self._back + rows, len(self._rows) - self.content_size.height))
        self.redraw()

    def _tail(self, columns: int, rows: int) -> Text:
        if columns != self._columns:
            self._columns = columns
            self._write_again()
        end = len(self._rows) - self._back
        shown = list(islice(self._rows, max(0, end - rows), end))
        if self._back and shown:
            shown[-1] = Text(f"… {self._back + 1} rows below", look.DIM)
        return Text("\n", no_wrap=True, end="").join(shown)

    def _add(self, stamp: str, text: str, style: str, level: int) -> None:
        entry = Entry(level, Text.assemble((stamp, look.DIM), (text, style)))
        self._entries.append(entry)
        self._show(entry)

    def _show(self, entry: Entry) -> None:
        if self._sought and self._sought not in entry.line.plain.lower():
            return
        if self._columns > 0 and (entry.level >= self.level or self._sought):
            line = entry.line
            if self._sought:
                line = line.copy()
                line.highlight_words([self._sought], look.FOUND, case_sensitive=False)
            wrapped = line.wrap(self.app.console, self._columns)
            self._rows.extend(wrapped)
            self._back += len(wrapped) if self._back else 0

    def _write_again(self) -> None:
        self._rows.clear()
        self._back = 0
        for entry in self._entries:
            self._show(entry)
