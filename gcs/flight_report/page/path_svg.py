"""The path as a picture: from above, and from the side with heights.

Everything is drawn in pixels of a view that fits the flight; the fence is in full where it is of
the flight's size, and else as far as it reaches into the view.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from typing import TypeAlias

from gcs.flight_report.flight import Flight, Request, VehicleFlight
from gcs.flight_report.number_format import clock
from gcs.flight_report.page.fence_svg import fence_from_above, fence_from_aside, zone_outline
from gcs.flight_report.page.html_text import text
from gcs.flight_report.projection import Box, View, box_of, ticks
from gcs.flight_report.summary import main_trouble
from gcs.flight_report.track import TrackPoint
from gcs.frames import Vec3

WIDTH_PX = 640.0
FENCE_REACH = 3.0
"""A fence that is more than this many times as large as the flight is not shown in full."""
_LEAST_M = 6.0
_STRETCH = 6.0
"""Heights are drawn at most so many times as large as distances."""
_COLOURS = ((60, 105, 200), (20, 150, 160), (95, 165, 75), (225, 160, 30))
"""From the beginning of the flight to its end; readable on light and on dark."""
_PIECES = 96

Plane: TypeAlias = Callable[[Vec3], tuple[float, float]]


@dataclass(frozen=True, slots=True)
class Picture:
    svg: str
    caption: str


def path_pictures(flight: Flight, vehicle: VehicleFlight) -> list[Picture]:
    """From above, and from the side that shows more of it; empty where no position is known."""
    points = [point for piece in vehicle.track.drawn() for point in piece]
    if not points:
        return []
    return [_from_above(flight, vehicle, points), _from_aside(flight, vehicle, points)]


def _from_above(flight: Flight, vehicle: VehicleFlight, points: list[TrackPoint]) -> Picture:
    def plane(enu: Vec3) -> tuple[float, float]:
        return enu[0], enu[1]

    outlines = [zone_outline(zone) for zone in flight.fence.zones]
    corners = [corner for outline in outlines for corner in outline]
    box = _box(points, vehicle.requests, vehicle.plan, plane, box_of(corners))
    box = box.at_least(box.height / 1.1, box.width / 2.2)
    view = View(box, WIDTH_PX, WIDTH_PX * box.height / box.width)
    parts = [
        *grid(view, "east", "north"),
        *fence_from_above(flight.fence, view),
        *_drawing(view, plane, vehicle, points),
    ]
    caption = "From above: north is up, metres from the local origin."
    return Picture(_svg(view, "The path from above", parts), caption + _beyond(corners, box))


def _from_aside(flight: Flight, vehicle: VehicleFlight, points: list[TrackPoint]) -> Picture:
    extents = [
        max(p.enu[axis] for p in points) - min(p.enu[axis] for p in points) for axis in (0, 1)
    ]
    axis = 0 if extents[0] >= extents[1] else 1
    side, along = (("south", "east"), ("east", "north"))[axis]

    def plane(enu: Vec3) -> tuple[float, float]:
        return enu[axis], enu[2]

    limits = [
        (corner[axis], height)
        for zone in flight.fence.zones
        for corner in zone_outline(zone)
        for height in (zone.floor_up_m, zone.ceiling_up_m)
        if height is not None
    ]
    box = _box(points, vehicle.requests, vehicle.plan, plane, box_of(limits))
    box = Box(box.left, box.right, min(box.bottom, -0.5), box.top)
    true_px = WIDTH_PX * box.height / box.width
    height_px = min(max(0.55 * WIDTH_PX, min(0.8 * WIDTH_PX, true_px)), _STRETCH * true_px)
    view = View(box, WIDTH_PX, max(90.0, height_px))
    stretch = view.y_scale / view.x_scale
    parts = [
        *grid(view, along, "up"),
        *fence_from_aside(flight.fence, view, axis),
        *_drawing(view, plane, vehicle, points),
    ]
    caption = f"From the {side}: {along} to the right, metres above the local origin."
    if stretch > 1.05:
        caption += f" Heights are drawn {stretch:.1f} times as large as distances."
    return Picture(_svg(view, f"The path from the {side}", parts), caption)


def _box(
    points: Iterable[TrackPoint],
    requests: Iterable[Request],
    plan: Iterable[Vec3],
    plane: Plane,
    fence: Box | None,
) -> Box:
    """The flight, the goals near it, and the fence where it is not much larger than these."""
    flown = box_of(plane(point.enu) for point in points)
    assert flown is not None
    reach = max(flown.width, flown.height, _LEAST_M)
    near = flown.padded(0.0, 0.75 * reach)
    for enu in (*plan, *(request.goal_enu for request in requests if request.goal_enu)):
        x, y = plane(enu)
        if near.holds(x, y):
            flown = flown.joined(Box(x, x, y, y))
    flown = flown.at_least(_LEAST_M, _LEAST_M / 2)
    size = max(flown.width, flown.height)
    if fence is not None and max(fence.width, fence.height) <= FENCE_REACH * size:
        return flown.joined(fence).padded(0.04, 0.5)
    return flown.padded(0.12, 0.5)


def _drawing(
    view: View, plane: Plane, vehicle: VehicleFlight, points: list[TrackPoint]
) -> list[str]:
    parts = [*_plan(view, plane, vehicle.plan), *_path(view, plane, vehicle.track.drawn())]
    labels: list[tuple[float, float]] = []
    parts += [
        _goal(view, plane(request.goal_enu), request, labels)
        for request in vehicle.requests
        if request.goal_enu is not None and request.word == "goto"
    ]
    parts += _ends(view, plane, points)
    first = main_trouble(vehicle)
    if first is not None:
        near = min(points, key=lambda point: abs(point.t_s - first.t_s))
        x, y = view.px(*plane(near.enu))
        title = text(f"{clock(first.t_s)} {first.title}")
        parts.append(
            f'<g class="trouble"><title>{title}</title>'
            f'<circle cx="{x:.1f}" cy="{y:.1f}" r="9"/>'
            f'<text x="{x:.1f}" y="{y + 4.5:.1f}" text-anchor="middle">!</text></g>'
        )
    return parts


def _plan(view: View, plane: Plane, plan: Sequence[Vec3]) -> list[str]:
    """The mission's places in their order, and straight lines between them."""
    if not plan:
        return []
    places = [view.px(*plane(enu)) for enu in plan]
    line = " ".join(f"{x:.1f},{y:.1f}" for x, y in places)
    dots = "".join(
        f'<circle cx="{x:.1f}" cy="{y:.1f}" r="3.5"><title>mission, place {n}</title></circle>'
        for n, (x, y) in enumerate(places, 1)
    )
    return [f'<g class="plan"><polyline points="{line}"/>{dots}</g>']


def _path(view: View, plane: Plane, pieces: Sequence[Sequence[TrackPoint]]) -> list[str]:
    """The path in short pieces, each of the colour of its time."""
    first_s, last_s = pieces[0][0].t_s, pieces[-1][-1].t_s
    total = sum(len(piece) for piece in pieces)
    length = max(2, -(-total // _PIECES))
    parts = []
    for piece in pieces:
        for start in range(0, max(1, len(piece) - 1), length):
            run = piece[start : start + length + 1]
            middle_s = (run[0].t_s + run[-1].t_s) / 2
            share = (middle_s - first_s) / (last_s - first_s) if last_s > first_s else 0.0
            line = " ".join(f"{x:.1f},{y:.1f}" for x, y in (view.px(*plane(p.enu)) for p in run))
            parts.append(f'<polyline points="{line}" stroke="{colour_of(share)}"/>')
    return [f'<g class="path">{"".join(parts)}</g>']


def _goal(
    view: View,
    at: tuple[float, float],
    request: Request,
    labels: list[tuple[float, float]],
) -> str:
    """`labels`: where those of earlier goals are."""
    refused = request.outcome == "refused"
    kind = "refused" if refused else "accepted"
    words = f"#{request.request_id} {request.word} {request.outcome}"
    if request.sentence:
        words += f": {request.sentence}"
    x, y = view.px(*at)
    # A goal out of sight is marked where the edge is next to it.
    x, y = min(max(x, 9.0), view.width_px - 9.0), min(max(y, 9.0), view.height_px - 9.0)
    mark = (
        f'<path d="M{x - 5:.1f} {y - 5:.1f}l10 10m0 -10l-10 10"/>'
        if refused
        else f'<circle cx="{x:.1f}" cy="{y:.1f}" r="5"/>'
    )
    label = f"#{request.request_id} {_beyond_edge(view.box, at)}".strip()
    left, label_y = _label_place(view, x, y, labels)
    labels.append((left, label_y))
    anchor, label_x = ("start", left) if left > x else ("end", left + _LABEL_PX[0])
    return (
        f'<g class="goal {kind}"><title>{text(words)}</title>{mark}'
        f'<text x="{label_x:.1f}" y="{label_y:.1f}" text-anchor="{anchor}">{label}</text></g>'
    )


_LABEL_PX = (48.0, 20.0)
"""So large is the label of a goal on a phone and on paper, where it is largest."""


def _label_place(
    view: View, x: float, y: float, labels: Sequence[tuple[float, float]]
) -> tuple[float, float]:
    """The left end and the line of a label beside a mark, where no other one is, if there is such a
    place: above it to the right, else below it, else to the left."""
    wide, high = _LABEL_PX
    right, left = x + 9.0, x - 9.0 - wide
    columns = (right, left) if x < view.width_px - 60.0 else (left,)
    places = [
        (column, min(max(line, 12.0), view.height_px - 4.0))
        for column in columns
        for line in (y - 6.0, y + high)
    ]
    free = (
        (column, line)
        for column, line in places
        if all(abs(column - a) >= wide or abs(line - b) >= high for a, b in labels)
    )
    return next(free, places[0])


def _beyond_edge(box: Box, at: tuple[float, float]) -> str:
    """An arrow to a place that is out of the view; empty for one in it."""
    x, y = at
    if not box.left <= x <= box.right:
        return "→" if x > box.right else "←"
    if not box.bottom <= y <= box.top:
        return "↑" if y > box.top else "↓"
    return ""


def _ends(view: View, plane: Plane, points: Sequence[TrackPoint]) -> list[str]:
    parts = []
    for point, name, d in (
        (points[0], "begin", "M-6 5h12l-6 -11z"),
        (points[-1], "end", "M-5 -5h10v10h-10z"),
    ):
        x, y = view.px(*plane(point.enu))
        title = text(f"{name} of the path, {clock(point.t_s)}")
        parts.append(
            f'<path class="path-end" transform="translate({x:.1f} {y:.1f})" d="{d}">'
            f"<title>{title}</title></path>"
        )
    return parts


def grid(view: View, x_name: str, y_name: str, unit: str = ", m") -> list[str]:
    """Lines of round numbers, and what both axes are."""
    box = view.box
    parts = []
    for x in ticks(box.left, box.right, 7):
        at, _ = view.px(x, 0.0)
        parts.append(f'<path d="M{at:.1f} 0V{view.height_px:.1f}"/>')
        if 24.0 < at < view.width_px - 120.0:
            parts.append(
                f'<text x="{at:.1f}" y="{view.height_px - 5:.1f}" text-anchor="middle">{x:g}</text>'
            )
    for y in ticks(box.bottom, box.top, max(2, round(view.height_px / 80))):
        _, at = view.px(0.0, y)
        parts.append(f'<path d="M0 {at:.1f}H{view.width_px:.1f}"/>')
        if 40.0 < at < view.height_px - 18.0:
            parts.append(f'<text x="5" y="{at - 3:.1f}">{y:g}</text>')
    parts.append(
        f'<text x="{view.width_px - 5:.1f}" y="{view.height_px - 5:.1f}" text-anchor="end">'
        f"{x_name}{unit}</text>"
    )
    parts.append(f'<text x="5" y="18">{y_name}{unit}</text>')
    return [f'<g class="grid">{"".join(parts)}</g>']


def _beyond(corners: Sequence[tuple[float, float]], box: Box) -> str:
    if corners and not any(box.holds(*corner) for corner in corners):
        return " The fence is larger than this view."
    return ""


def _svg(view: View, title: str, parts: Iterable[str]) -> str:
    return (
        f'<svg viewBox="0 0 {view.width_px:.0f} {view.height_px:.0f}" role="img" '
        f'aria-label="{text(title)}">{"".join(parts)}</svg>'
    )


def colour_of(share: float) -> str:
    """The colour of a time, `share` of the way from the beginning to the end."""
    place = min(max(share, 0.0), 1.0) * (len(_COLOURS) - 1)
    index = min(int(place), len(_COLOURS) - 2)
    rest = place - index
    low, high = _COLOURS[index], _COLOURS[index + 1]
    red, green, blue = (round(a + (b - a) * rest) for a, b in zip(low, high, strict=True))
    return f"#{red:02x}{green:02x}{blue:02x}"
