"""What is shown while a command is under way: nothing on a pipe, nothing for the first second."""

from __future__ import annotations

import sys
from types import TracebackType
from typing import TYPE_CHECKING

from gcs import ipc
from gcs.enu_text import signed_enu

if TYPE_CHECKING:
    from rich.progress import Progress, TaskID

SHOW_AFTER_S = 1.0


class ProgressDisplay:
    """A line on standard error that is shown after a while and leaves no trace.

    `update` is given every event and the present time; it needs no thread of its own.  Whoever
    prints a line calls `clear` first; the display comes back below it by itself.
    """

    def __init__(self, what: str, started_s: float, *, shown: bool | None = None) -> None:
        self._what = what
        self._started_s = started_s
        self._shown = sys.stderr.isatty() if shown is None else shown
        self._progress: Progress | None = None
        self._task: TaskID | None = None
        self._transfer: ipc.ProgressEvent | None = None

    def __enter__(self) -> ProgressDisplay:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self.clear()

    def clear(self) -> None:
        """Take the display off the screen."""
        if self._progress is not None:
            self._progress.stop()
            self._progress = self._task = None

    def update(self, event: ipc.Event, now_s: float) -> None:
        if not self._shown or now_s - self._started_s < SHOW_AFTER_S:
            return
        match event:
            case ipc.ProgressEvent():
                self._transfer = event
                unit = f" {event.unit}" if event.unit else ""
                text = f"{event.what}: {event.done:g} of {event.total:g}{unit}"
                self._draw(text, event.done, event.total or None, now_s)
            case ipc.Snapshot() if self._transfer is None:
                self._draw(f"{event.state}  {signed_enu(event.pos_enu)}", 0.0, None, now_s)
            case ipc.EndingEvent():
                self._transfer = None
            case _:
                pass

    def _draw(self, text: str, done: float, total: float | None, now_s: float) -> None:
        if self._progress is None:
            self._progress, self._task = _start(self._what)
        assert self._task is not None
        elapsed = f"{now_s - self._started_s:.0f} s"
        self._progress.update(self._task, completed=done, total=total, text=text, elapsed=elapsed)


def _start(what: str) -> tuple[Progress, TaskID]:
    from rich.console import Console
    from rich.progress import BarColumn, Progress, SpinnerColumn, TextColumn

    progress = Progress(
        SpinnerColumn(),
        TextColumn("{task.description}", markup=False),
        BarColumn(bar_width=24),
        TextColumn("{task.fields[text]}", markup=False),
        TextColumn("{task.fields[elapsed]}", markup=False),
        console=Console(stderr=True, force_terminal=True),
        transient=True,
    )
    progress.start()
    return progress, progress.add_task(what, total=None, text="", elapsed="")
