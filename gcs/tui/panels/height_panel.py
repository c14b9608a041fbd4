"""The height bar: ground, ceiling, vehicle, pending and active goal, metres up of the origin."""

from __future__ import annotations

from rich.text import Text

from gcs.tui import look
from gcs.tui.panels.map_panel import ACTIVE, PENDING
from gcs.tui.scene import Scene

TOPS_M = (3.0, 6.0, 12.0, 30.0, 60.0, 120.0, 300.0, 600.0, 1200.0)


def draw(scene: Scene, rows: int) -> Text:
    """Nine cells wide: figure, tick, markers."""
    if rows < 4:
        return Text("")
    seen = scene.snapshot
    heights = [scene.pending.goal_enu[2]]
    if seen is not None:
        heights += [p[2] for p in (seen.pos_enu, scene.active_enu) if p is not None]
    top_m = next((top for top in TOPS_M if top >= max(heights) * 1.1), TOPS_M[-1])

    def row_of(up_m: float) -> int:
        return round((rows - 1) * (1.0 - min(max(up_m / top_m, 0.0), 1.0)))

    cells: dict[int, list[tuple[str, str]]] = {}
    for zone in scene.zones:
        ceiling_m = zone.ceiling_up_m if zone.inclusion else None
        if ceiling_m is not None and ceiling_m <= top_m:
            cells.setdefault(row_of(ceiling_m), []).append(("▔", look.FENCE))
    cells.setdefault(row_of(heights[0]), []).append((PENDING, look.PENDING))
    if scene.active_enu is not None:
        cells.setdefault(row_of(scene.active_enu[2]), []).append((ACTIVE, look.ACTIVE))
    if seen is not None and seen.pos_enu is not None:
        style = look.DIM if scene.lost else look.VEHICLE
        cells.setdefault(row_of(seen.pos_enu[2]), []).insert(0, ("◀", style))

    ticks = {row_of(top_m * i / 3): f"{top_m * i / 3:g}" for i in range(4)}
    vehicle_row = row_of(seen.pos_enu[2]) if seen is not None and seen.pos_enu else rows - 1
    bar = Text(no_wrap=True, end="")
    for row in range(rows):
        if row:
            bar.append("\n")
        bar.append(f"{ticks.get(row, ''):>4}", look.DIM)
        bar.append("┤" if row in ticks else "│", look.DIM if row < vehicle_row else look.VEHICLE)
        for char, style in cells.get(row, [])[:4]:
            bar.append(char, style)
    return bar
