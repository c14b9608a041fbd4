"""`gcs mission items`: how each MAV_CMD of a mission is flown, by autopilot and version."""

from __future__ import annotations

from collections.abc import Iterator

from gcs.plan.items import ROWS, VERSIONS, Flown


def items_lines() -> Iterator[str]:
    """A paragraph a command: its number and name, and what each firmware does with it."""
    yield "How each mission item is flown.  Recorded: PX4 1.14 and ArduCopter 4.7."
    for row in ROWS:
        yield f"{int(row.command):5d}  {row.command.name}"
        cells = (row.px4_1_14, row.px4_1_15, row.copter_4_5, row.copter_4_7)
        for names, flown in _grouped(cells):
            yield f"         {names}: {flown.value}"


def _grouped(cells: tuple[Flown, ...]) -> Iterator[tuple[str, Flown]]:
    """Firmwares that do the same stand in one line."""
    for flown in dict.fromkeys(cells):
        names = [name for name, cell in zip(VERSIONS, cells, strict=True) if cell is flown]
        yield ("all" if len(names) == len(cells) else ", ".join(names)), flown
