"""The state machine with the present state lit, and how it got there."""

from __future__ import annotations

from rich.text import Text

from gcs.gate.states import State
from gcs.tui import look
from gcs.tui.scene import Scene

# Read by rows: not flying or not ours, then the flying states, then the ways down.
ROWS: tuple[tuple[State, State], ...] = (
    (State.NO_VEHICLE, State.STALE),
    (State.GROUNDED, State.EXTERNAL),
    (State.TAKING_OFF, State.HOLDING),
    (State.HOVERING, State.TAKING_PICTURE),
    (State.VERIFYING, State.FLYING_MISSION),
    (State.MOVING, State.RETURNING),
    (State.STREAMING, State.LANDING),
)


def draw(scene: Scene) -> Text:
    """Eight rows of 32 cells."""
    seen = scene.snapshot
    present = "" if seen is None else seen.state
    severity = "NOMINAL" if seen is None else seen.severity
    lit = f"reverse {look.SEVERITY.get(severity, look.BAD)} bold".replace("bold bold", "bold")
    before = "" if scene.last_move is None else scene.last_move.before
    chart = Text(no_wrap=True, end="", overflow="ellipsis")
    for left, right in ROWS:
        for state in (left, right):
            style = (
                lit if state.name == present else look.PLAIN if state.name == before else look.DIM
            )
            chart.append(f" {state.name:<14} ", style)
        chart.append("\n")
    move = scene.last_move
    if move is None:
        return chart.append(" nothing has happened yet", look.DIM)
    return chart.append(f" {move.before} → {move.after}, {move.event}", look.DIM)
