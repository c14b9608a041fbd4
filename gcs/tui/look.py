"""Styles of the drawings, as Rich writes them, in one place."""

from __future__ import annotations

from typing import Final

from gcs.tui.verdict_ahead import Ahead

VEHICLE: Final = "bold bright_white"
PENDING: Final = "bold #ffd75f"
ACTIVE: Final = "bold #5fd7ff"
HOME: Final = "#d7afff"
FENCE: Final = "#5faf5f"
OWN_FENCE: Final = "#5fafaf"
NO_FLY: Final = "#ff5f5f"
TRAIL: Final = "#5f87af"
MISSION: Final = "#d787ff"
OTHER: Final = "bold #ffaf87"
GRID: Final = "#3a3a4a"
DIM: Final = "#8a8a9a"
GOOD: Final = "#87d787"
WARN: Final = "#ffaf5f"
BAD: Final = "bold #ff5f5f"
PLAIN: Final = "#d0d0d8"

SEVERITY: Final[dict[str, str]] = {
    "NOMINAL": GOOD,
    "CAUTION": WARN,
    "HOLD": WARN,
    "RETURN": BAD,
    "LAND": BAD,
    "TERMINATE": BAD,
}
ANSWER: Final[dict[str, str]] = {
    "accepted": ACTIVE,
    "complete": GOOD,
    "refused": BAD,
    "aborted": WARN,
    "superseded": WARN,
    "timed out": BAD,
    "taken over": WARN,
}
FOUND: Final = "reverse"
ALARM: Final = "bold #16161e on #ff5f5f"
ALARM_OVER: Final = "#16161e on #ffaf5f"
LEVEL: Final[tuple[str, ...]] = ("", DIM, PLAIN, WARN, BAD, "bold reverse #ff5f5f")
AHEAD: Final[dict[Ahead, str]] = {
    Ahead.UNKNOWN: PENDING,
    Ahead.FREE: f"bold {GOOD}",
    Ahead.LATER: f"bold {WARN}",
    Ahead.REFUSED: BAD,
}
"""The pending goal's mark, and the line that says why."""
