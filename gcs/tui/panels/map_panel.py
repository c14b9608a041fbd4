"""The top-down map: fence, trail, vehicle, home, pending and active goal, scale."""

from __future__ import annotations

import math
from dataclasses import replace

from rich.text import Text

from gcs import ipc
from gcs.tui import fleet, look
from gcs.tui.braille import Canvas
from gcs.tui.scene import Scene
from gcs.tui.verdict_ahead import Ahead
from gcs.tui.view import View, fit, nice_length, outline

ARROWS = "↑↗→↘↓↙←↖"
HOME, PENDING, ACTIVE = "⌂", "◇", "◉"
OTHERS = "◆"
"""What the operator in control has in mind, for those who look on."""
OTHER_GOAL = "○"
OTHERS_M = 200.0
"""How far from the vehicle that is shown another one may be, so that the map has room for both."""
REFUSED = "✗"
"""The pending goal that the gate would refuse."""
OFF_EVERY = 5
"""Of five dots one: a fence that is switched off."""
OWN_EVERY = 3
"""The fence that the vehicle keeps by itself, where it is not the policy's."""
SMALL_FENCE_M = 30.0
"""A fence no wider than this is shown whole."""


def draw(scene: Scene, columns: int, rows: int) -> Text:
    """The map in so many cells; the last row is the legend."""
    if columns < 8 or rows < 4:
        return Text("")
    canvas = Canvas(columns, rows - 1)
    view = view_of(scene, columns, rows)
    _grid(canvas, view)
    for zone in scene.own_zones:
        style = look.OWN_FENCE if zone.inclusion else look.NO_FLY
        canvas.path([view.dots(e, n) for e, n in outline(zone)], style, every=OWN_EVERY)
    for zone in scene.zones:
        style = look.FENCE if zone.inclusion else look.NO_FLY
        every = (1 if zone.inclusion else 2) if scene.fence_on else OFF_EVERY
        canvas.path([view.dots(e, n) for e, n in outline(zone)], style, every=every)
    canvas.path([view.dots(e, n) for e, n, _ in scene.mission.points_enu], look.MISSION, every=2)
    canvas.path([view.dots(e, n) for e, n, _ in scene.trail], look.TRAIL)
    _markers(canvas, view, scene)
    _scale(canvas, view)
    seen = scene.snapshot
    legend = _legend(
        columns,
        mission=bool(scene.mission.points_enu),
        own=bool(scene.own_zones),
        others=seen is not None and bool(seen.others),
    )
    return Text.assemble(canvas.render(), "\n", legend, end="", no_wrap=True)


def arrow(yaw_deg: float) -> str:
    """The arrow nearest to a heading, clockwise from north."""
    return ARROWS[round(yaw_deg / 45.0) % 8]


def place(scene: Scene, columns: int, rows: int, at: tuple[int, int]) -> tuple[float, float]:
    """East and north of a cell of the map, to the decimetre."""
    view = view_of(scene, columns, rows)
    x, y = 2 * at[0] + 1, 4 * at[1] + 2
    east_m = view.centre_en[0] + (x - view.width / 2) * view.m_per_dot
    north_m = view.centre_en[1] - (y - view.height / 2) * view.m_per_dot
    return (round(east_m, 1) + 0.0, round(north_m, 1) + 0.0)


def view_of(scene: Scene, columns: int, rows: int) -> View:
    """What the map in so many cells shows, the legend's row left out."""
    width, height = 2 * columns, 4 * (rows - 1)
    seen = scene.snapshot
    points = [scene.pending.goal_enu[:2]]
    centre = (0.0, 0.0)
    if seen is not None:
        known = (seen.pos_enu, scene.active_enu, seen.home_enu)
        points += [point[:2] for point in known if point is not None]
        points += _near(seen)
        centre = seen.home_enu[:2] if seen.home_enu is not None else centre
    points += _small_fence(scene)
    points += [point[:2] for point in scene.mission.points_enu]
    fitting = fit(centre, points, width, height, scene.zoom)
    middle_en = (centre[0] + scene.pan_en[0], centre[1] + scene.pan_en[1])
    return replace(fitting, centre_en=middle_en)


def _near(seen: ipc.Snapshot) -> list[tuple[float, float]]:
    """Where the other vehicles are that are not far away."""
    here = seen.pos_enu
    others = [each.pos_enu for each in seen.others if each.pos_enu is not None]
    return [] if here is None else [p[:2] for p in others if math.dist(p, here) <= OTHERS_M]


def _small_fence(scene: Scene) -> list[tuple[float, float]]:
    """The corners to be seen of each fence that fits on the map without making all else tiny."""
    shown = []
    for zone in (*scene.zones, *scene.own_zones):
        if zone.inclusion and (edge := outline(zone)):
            easts, norths = zip(*edge, strict=True)
            corners = [(min(easts), min(norths)), (max(easts), max(norths))]
            if max(max(easts) - min(easts), max(norths) - min(norths)) <= SMALL_FENCE_M:
                shown += corners
    return shown


def _grid(canvas: Canvas, view: View) -> None:
    step_m = nice_length(view.half_height_m / 2)
    east_m, north_m = view.centre_en
    across = int(view.half_width_m // step_m) + 1
    along = int(view.half_height_m // step_m) + 1
    first_e = round(east_m / step_m) * step_m
    first_n = round(north_m / step_m) * step_m
    for i in range(-across, across + 1):
        for j in range(-along, along + 1):
            canvas.dot(*view.dots(first_e + i * step_m, first_n + j * step_m), look.GRID)


def _markers(canvas: Canvas, view: View, scene: Scene) -> None:
    seen = scene.snapshot
    if seen is not None and seen.home_enu is not None:
        canvas.glyph(*view.dots(*seen.home_enu[:2]), HOME, look.HOME)
    if scene.active_enu is not None:
        goal = view.dots(*scene.active_enu[:2])
        if seen is not None and seen.pos_enu is not None:
            canvas.line(view.dots(*seen.pos_enu[:2]), goal, look.ACTIVE, every=3)
        canvas.glyph(*goal, ACTIVE, look.ACTIVE)
    if seen is not None:
        for other in seen.others:
            _other(canvas, view, other)
    of_shown = seen is not None and (not seen.others or _is_of(scene.other_goal, seen.sysid))
    if scene.other_goal is not None and of_shown and not scene.in_control:
        canvas.glyph(*view.dots(*scene.other_goal.goal_enu[:2]), OTHERS, look.PENDING)
    goal_enu, ahead = scene.pending.goal_enu, scene.ahead.of(scene.pending.ask)
    typed = scene.typed
    if typed is not None and typed.ask is not None and typed.goal_enu is not None:
        goal_enu, ahead = typed.goal_enu, scene.typed_ahead.of(typed.ask)
    mark = REFUSED if ahead is Ahead.REFUSED else PENDING
    canvas.glyph(*view.dots(*goal_enu[:2]), mark, look.AHEAD[ahead])
    if seen is not None and seen.pos_enu is not None:
        char = "●" if seen.yaw_deg is None else arrow(seen.yaw_deg)
        style = look.DIM if scene.lost else look.VEHICLE
        canvas.glyph(*view.dots(*seen.pos_enu[:2]), char, style)


def _is_of(goal: ipc.OperatorGoal | None, sysid: int) -> bool:
    return goal is not None and goal.vehicle == sysid


def _other(canvas: Canvas, view: View, other: ipc.OtherVehicle) -> None:
    """Another vehicle by its number, and the goal that it flies to."""
    if other.pos_enu is None:
        return
    style = look.BAD if fleet.too_close(other) else look.OTHER
    place = view.dots(*other.pos_enu[:2])
    if other.goal_enu is not None and other.goal_enu != other.pos_enu:
        goal = view.dots(*other.goal_enu[:2])
        canvas.line(place, goal, style, every=4)
        canvas.glyph(*goal, OTHER_GOAL, style)
    canvas.glyph(*place, str(other.vehicle), style)


def _scale(canvas: Canvas, view: View) -> None:
    length_m = nice_length(view.half_width_m / 2)
    cells = max(2, round(length_m / view.m_per_dot / 2))
    bar = "├" + "─" * (cells - 2) + "┤"
    canvas.text(1, canvas.rows - 1, f"{bar} {length_m:g} m ", look.DIM)
    canvas.text(canvas.columns // 2, 0, "N", look.DIM)
    canvas.text(canvas.columns - 1, canvas.rows // 2, "E", look.DIM)


def _legend(columns: int, *, mission: bool, own: bool, others: bool) -> Text:
    parts = (
        ("↑", look.VEHICLE, "vehicle"),
        *([("1", look.OTHER, "others")] if others else []),
        (PENDING, look.PENDING, "pending"),
        (ACTIVE, look.ACTIVE, "active"),
        (HOME, look.HOME, "home"),
        *([("┄", look.MISSION, "mission")] if mission else []),
        *([("┄", look.OWN_FENCE, "its own")] if own else []),
        ("─", look.FENCE, "fence"),
        ("╌", look.NO_FLY, "no-fly"),
    )
    legend = Text(" ", end="", no_wrap=True)
    for char, style, name in parts:
        if legend.cell_len + len(name) + 3 > columns:
            break
        legend.append(char, style).append(f" {name}  ", look.DIM)
    return legend
