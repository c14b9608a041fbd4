"""The operator's program of `gcs bridge`: it looks on until it is told to end."""

from __future__ import annotations

from typing import Protocol

from gcs import ipc
from gcs.operator.client import Polling, StationEnded
from gcs.operator.dialogue import Dialogue, Hints, InterruptSource
from gcs.operator.errors import Interrupted

DRAW_S = 0.5
HINTS = Hints(
    "start one with `vehicle-sim`, use --sim, or say with --vehicle where it is",
    "choose one with --target",
)


class Display(Protocol):
    """Where it is shown: lines on a pipe, or a page on a terminal."""

    def event(self, event: ipc.Event) -> None: ...
    def draw(self) -> None:
        """At least twice a second."""
        ...


def watch(
    connection: Polling, interrupts: InterruptSource, display: Display, timeout_s: float | None
) -> StationEnded:
    """Until a signal; the station has then left in good order.

    Raises ExitError if the station ends by itself, or if no vehicle is heard for `timeout_s`.
    """
    dialogue = Dialogue(connection, interrupts, lambda event, _: display.event(event))
    try:
        if timeout_s is not None:
            try:
                dialogue.wait_until_heard(timeout_s, HINTS)
            except Exception:  # whatever it is, the station is left in order before it is told
                dialogue.leave("no vehicle was heard")
                raise
        while True:
            dialogue.poll(DRAW_S)
            display.draw()
    except Interrupted as interrupt:
        return dialogue.leave(str(interrupt))
