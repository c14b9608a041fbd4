"""The mission on board: what the gate says of it, its items, how far its transfer or flight is."""

from __future__ import annotations

import textwrap
from typing import Final

from rich.text import Text

from gcs import ipc
from gcs.gate.states import State
from gcs.tui import look
from gcs.tui.scene import ACCEPTED, COMPLETE, Scene

DONE, CURRENT, STOPPED = "✓", "▶", "■"
"""Marks before an item: flown; under way; where the flight of it was stopped."""
BAR: Final = 10
SAID_ROWS: Final = 3
_ABOVE: Final = {"home": "", "sea": " amsl", "ground": " agl"}
_NAME: Final = 19
"""`spline waypoint` and a few letters more."""


def draw(scene: Scene, columns: int, rows: int) -> Text:
    """As many items as there is room for, about the current one."""
    head = [*_verdict(scene, columns), *_progress(scene)]
    panel = Text(no_wrap=True, end="", overflow="ellipsis")
    for line, style in [*head, *_items(scene, rows - len(head))]:
        panel.append(f"{line}\n", style)
    return panel


def _verdict(scene: Scene, columns: int) -> list[tuple[str, str]]:
    """What is on board, and what is wrong with it, or with the last thing that was asked of it."""
    mission, total = scene.mission, len(scene.mission.items)
    last = scene.mission_said
    said = "" if last.kind in (ACCEPTED, COMPLETE) else last.text
    style = look.ANSWER.get(last.kind, look.DIM)
    if mission.unverified:
        said, style = mission.unverified, look.WARN
    counted = " from 0" if total and mission.items[0].seq == 0 else ""
    lines = [(f"mission: {total} items{counted}, verified", look.GOOD)]
    if not total:
        lines = [("mission: none that was verified", look.DIM)]
        if not said:
            lines.append((":mission upload FILE, then i", look.DIM))
    wrapped = textwrap.wrap(said, max(columns, 20), max_lines=SAID_ROWS, placeholder=" …")
    return [*lines, *((line, style) for line in wrapped)]


def _progress(scene: Scene) -> list[tuple[str, str]]:
    told = scene.progress
    if told is None or told.unit != "items" or told.total <= 0.0:
        return []
    filled = round(BAR * told.done / told.total)
    bar = "█" * filled + "░" * (BAR - filled)
    return [(f"{bar} {told.what} {told.done:g}/{told.total:g}", look.ACTIVE)]


def _items(scene: Scene, rows: int) -> list[tuple[str, str]]:
    """A window on the items, with one that was flown above the current one."""
    items = scene.mission.items
    seen = scene.snapshot
    seq = seen.mission_seq if seen is not None and scene.mission_begun else None
    at = 0 if seq is None or not items else max(0, seq - items[0].seq)
    first = max(0, min(at - 1, len(items) - rows))
    flying = seen is not None and seen.state == State.FLYING_MISSION.name
    return [_item(each, seq, flying) for each in items[first : first + max(rows, 0)]]


def _item(item: ipc.MissionItem, seq: int | None, flying: bool) -> tuple[str, str]:
    mark, style = " ", look.PLAIN
    if seq is not None and item.seq < seq:
        mark, style = DONE, look.DIM
    elif item.seq == seq:
        mark, style = (CURRENT, look.ACTIVE) if flying else (STOPPED, look.WARN)
    name = item.command.removeprefix("NAV_").removeprefix("DO_").replace("_", " ").lower()
    height = "" if item.alt_m is None else f"{item.alt_m:g} m{_ABOVE[item.datum]}"
    return f"{mark}{item.seq:>3} {name[:_NAME]:<{_NAME}} {height}", style
