"""A route in the terminal: from above in braille dots, and its heights along the way.

Where the terminal has no braille, the same picture in ASCII.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Iterator
from typing import Final

from rich.text import Text

from gcs.cli.mission.route import Route
from gcs.flight_report.page.fence_svg import zone_outline
from gcs.flight_report.projection import Box, box_of, round_step
from gcs.frames import Vec3
from gcs.plan.legs import LegKind
from gcs.tui.braille import Canvas

_LEAST_M: Final = 5.0
_ROWS_MOST: Final = 24
_PROFILE_ROWS: Final = 5
_CIRCLE_POINTS: Final = 48
_Dot = Callable[[tuple[float, float]], tuple[float, float]]
_WAY, _INSIDE, _OUTSIDE, _MARK = "bright_cyan", "green", "red", "bold yellow"
_ASCII: Final = {
    0x2800 + dots: ".:+#"[min(3, (dots.bit_count() - 1) // 2)] for dots in range(1, 256)
}


def route_lines(route: Route, columns: int, *, ascii_only: bool) -> Iterator[Text]:
    """The pictures, where there is something to draw, and the facts."""
    box = _box(route)
    if box is not None:
        yield from _pictures(route, box, columns, ascii_only)
    for name, value in route.facts:
        yield Text(f"{name}: {value}")
    for problem in route.problems:
        yield Text(f"not flown as it is: {problem}", "red")


def _pictures(route: Route, box: Box, columns: int, ascii_only: bool) -> Iterator[Text]:
    yield from _shown(_from_above(route, box, columns), ascii_only)
    step_m = round_step(box.width, 6)
    dash = "-" if ascii_only else "─"
    length = max(1, round(step_m / _metres_a_dot(box, columns) / 2))
    yield Text(f"north is up; |{dash * length}| {step_m:g} m", "dim")
    if any(leg.from_enu[2] != leg.to_enu[2] for leg in route.legs):
        yield Text()
        yield from _profile(route, columns, ascii_only)


def _box(route: Route) -> Box | None:
    corners = [corner for zone in route.zones for corner in zone_outline(zone)]
    ends = [end[:2] for leg in route.legs for end in (leg.from_enu, leg.to_enu)]
    rings = [
        (centre[0] + east, centre[1] + north)
        for centre, radius_m in route.circles
        for east, north in ((radius_m, 0.0), (-radius_m, 0.0), (0.0, radius_m), (0.0, -radius_m))
    ]
    rally = [point[:2] for point in route.rally_enu]
    box = box_of([*corners, *ends, *rings, *rally])
    return None if box is None else box.at_least(_LEAST_M, _LEAST_M).padded(0.04, 0.1)


def _metres_a_dot(box: Box, columns: int) -> float:
    return max(box.width / (2 * columns - 1), box.height / (4 * _ROWS_MOST - 1))


def _from_above(route: Route, box: Box, columns: int) -> Canvas:
    scale_m = _metres_a_dot(box, columns)
    rows = max(2, min(_ROWS_MOST, math.ceil(box.height / scale_m / 4)))
    canvas = Canvas(min(columns, math.ceil(box.width / scale_m / 2) + 1), rows)

    def dot(east_north: tuple[float, float]) -> tuple[float, float]:
        return (east_north[0] - box.left) / scale_m, (box.top - east_north[1]) / scale_m

    for zone in route.zones:
        outline = list(zone_outline(zone))
        style = _INSIDE if zone.inclusion else _OUTSIDE
        canvas.path([dot(corner) for corner in (*outline, *outline[:1])], style, every=2)
    for centre, radius_m in route.circles:
        turns = [2.0 * math.pi * i / _CIRCLE_POINTS for i in range(_CIRCLE_POINTS + 1)]
        ring = [
            dot((centre[0] + radius_m * math.sin(a), centre[1] + radius_m * math.cos(a)))
            for a in turns
        ]
        canvas.path(ring, _WAY)
    for leg in route.legs:
        ends = dot(_flat(leg.from_enu)), dot(_flat(leg.to_enu))
        canvas.line(*ends, _WAY, every=3 if leg.kind is LegKind.RETURN else 1)
    _mark(canvas, route, dot)
    return canvas


def _flat(enu: Vec3) -> tuple[float, float]:
    return (enu[0], enu[1])


def _mark(canvas: Canvas, route: Route, dot: _Dot) -> None:
    """H for home, R for rally points, and the items' numbers where there is room for them."""
    taken: set[tuple[int, int]] = set()

    def put(text: str, at: tuple[float, float]) -> None:
        column, row = int(at[0] // 2), int(at[1] // 4)
        column = max(0, min(column, canvas.columns - len(text)))
        cells = {(column + i, row) for i in range(-1, len(text) + 1)}
        if not cells & taken:
            canvas.text(column, row, text, _MARK)
            taken.update(cells)

    if route.legs:
        put("H", dot((0.0, 0.0)))
    for point in route.rally_enu:
        put("R", dot(_flat(point)))
    for number, place in route.places.items():
        put(str(number), dot(_flat(place)))


def _profile(route: Route, columns: int, ascii_only: bool) -> Iterator[Text]:
    """Heights above home along the way over the ground; climbs straight up have no width."""
    points = [(0.0, route.legs[0].from_enu[2])]
    for leg in route.legs:
        far_m = points[-1][0] + math.dist(leg.from_enu[:2], leg.to_enu[:2])
        if leg.from_enu[2] != points[-1][1]:
            points.append((points[-1][0], leg.from_enu[2]))
        points.append((far_m, leg.to_enu[2]))
    length_m = max(points[-1][0], 1e-3)
    low_m, high_m = min(0.0, *(up for _, up in points)), max(up for _, up in points)
    labels = (f"{high_m:.0f} m ", f"{low_m:.0f} m ")
    margin = max(map(len, labels))
    canvas = Canvas(max(10, columns - margin - 1), _PROFILE_ROWS)
    span_m = max(high_m - low_m, 1e-3)
    dots = [
        ((canvas.width - 1) * far / length_m, (canvas.height - 1) * (high_m - up) / span_m)
        for far, up in points
    ]
    for start, end in itertools.pairwise(dots):
        canvas.line(start, end, _WAY)
    rows = list(_shown(canvas, ascii_only))
    for number, row in enumerate(rows):
        head = labels[0] if number == 0 else labels[1] if number == len(rows) - 1 else ""
        yield Text(head.rjust(margin), "dim").append_text(row)
    yield Text(" " * margin + f"heights above home along {length_m:.0f} m over the ground", "dim")


def _shown(canvas: Canvas, ascii_only: bool) -> Iterator[Text]:
    for row in canvas.render().split("\n", allow_blank=True):
        if ascii_only:
            styles = row.spans
            row = Text(row.plain.translate(_ASCII), spans=styles)
        row.rstrip()
        yield row
