"""A route as SVG, from above and from the side, and as one HTML page that needs no network."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from importlib.resources import files
from typing import TypeAlias

from gcs.cli.mission.route import Route
from gcs.flight_report.flight import Fence
from gcs.flight_report.number_format import clock
from gcs.flight_report.page.fence_svg import fence_from_above, fence_from_aside, zone_outline
from gcs.flight_report.page.html_text import text
from gcs.flight_report.page.path_svg import WIDTH_PX, colour_of, grid
from gcs.flight_report.projection import Box, View, box_of
from gcs.frames import Vec3
from gcs.plan import commands
from gcs.plan.legs import LegKind
from gcs.plan.model import Plan

Plane: TypeAlias = Callable[[Vec3], tuple[float, float]]
_LEAST_M = 6.0
_HIGHEST_PX = 760.0
_LABEL_ROOM_PX = 18.0
_GAP_PX = 24.0
_LINE_PX = 22.0


def picture_file(plan: Plan, route: Route) -> str:
    """A whole SVG file: both pictures, one over the other, and the facts below them."""
    pictures = _pictures(route)
    height = sum(view.height_px + _GAP_PX for view, _, _ in pictures)
    lines = [plan.name, *(f"{name}: {value}" for name, value in route.facts)]
    full = height + _LINE_PX * len(lines) + 10.0
    parts, y = [], 0.0
    for view, title, inner in pictures:
        parts.append(
            f'<svg y="{y:.0f}" width="{view.width_px:.0f}" height="{view.height_px:.0f}" '
            f'viewBox="0 0 {view.width_px:.0f} {view.height_px:.0f}">'
            f"<title>{text(title)}</title>{inner}</svg>"
        )
        y += view.height_px + _GAP_PX
    for number, line in enumerate(lines):
        parts.append(f'<text x="6" y="{y + _LINE_PX * number:.0f}">{text(line)}</text>')
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{WIDTH_PX:.0f}" height="{full:.0f}" '
        f'viewBox="0 0 {WIDTH_PX:.0f} {full:.0f}">\n<style>{_style()}</style>\n'
        + "\n".join(parts)
        + "\n</svg>\n"
    )


def page(plan: Plan, route: Route) -> str:
    """Facts, both pictures, the items as a table."""
    tiles = "".join(
        f"<div><dt>{text(name)}</dt><dd>{text(value)}</dd></div>"
        for name, value in route.facts
        if name != "battery"
    )
    battery = f'<p class="quiet">Battery: {text(route.battery)}.</p>' if route.battery else ""
    problems = "".join(
        f'<div class="trouble-box warning"><h2>Not flown as it is</h2><p>{text(one)}</p></div>'
        for one in route.problems
    )
    figures = "".join(
        f'<figure><svg viewBox="0 0 {view.width_px:.0f} {view.height_px:.0f}" role="img" '
        f'aria-label="{text(title)}">{inner}</svg><figcaption>{text(title)}</figcaption></figure>'
        for view, title, inner in _pictures(route)
    )
    name = text(plan.name)
    return (
        '<!doctype html>\n<html lang="en">\n<head>\n<meta charset="utf-8">\n'
        '<meta http-equiv="Content-Security-Policy" content="default-src \'none\'; '
        "style-src 'unsafe-inline'; img-src data:\">\n"
        '<meta name="viewport" content="width=device-width, initial-scale=1">\n'
        f'<link rel="icon" href="data:,">\n<title>{name}</title>\n'
        f"<style>{_style()}</style>\n</head>\n<body>\n"
        f"<header><div><h1>{name}</h1></div></header>\n<main>{problems}"
        f'<dl class="tiles">{tiles}</dl>{battery}'
        f'<section><div class="pictures">{figures}</div></section>'
        f"{_table(plan, route)}</main>\n"
        f"<footer><p>{text(plan.source)}, by gcs mission show: with a vehicle as it is delivered, "
        "in still air; nothing is judged here.</p></footer>\n</body>\n</html>\n"
    )


def _style() -> str:
    return files("gcs.flight_report.page").joinpath("report.css").read_text(encoding="utf-8")


def _table(plan: Plan, route: Route) -> str:
    if not plan.items:
        return ""
    rows = []
    for number, item in enumerate(plan.items, start=1):
        way_m, end_s, at = (
            route.item_length_m(number),
            route.ends_s.get(number),
            route.places.get(number),
        )
        cells = (
            commands.name(item.command),
            "" if at is None else f"E {at[0]:+.1f} N {at[1]:+.1f} U {at[2]:+.1f} m",
            f"{way_m:.1f} m" if way_m else "",
            "" if end_s is None else clock(end_s),
        )
        inner = "".join(f"<td>{text(cell)}</td>" for cell in cells)
        rows.append(f"<tr><th>{number}</th>{inner}</tr>")
    heads = "".join(f"<th>{head}</th>" for head in ("#", "item", "ends at", "way", "after"))
    return (
        f"<section><h2>Items</h2><table><thead><tr>{heads}</tr></thead>"
        f"<tbody>{''.join(rows)}</tbody></table></section>"
    )


def _pictures(route: Route) -> list[tuple[View, str, str]]:
    """View, caption and what is drawn, from above and from the side; none for nothing."""
    corners = [corner for zone in route.zones for corner in zone_outline(zone)]
    ends = [end for leg in route.legs for end in (leg.from_enu, leg.to_enu)]
    ends += [
        (east + d_east, north + d_north, up)
        for (east, north, up), radius_m in route.circles
        for d_east, d_north in ((radius_m, 0), (-radius_m, 0), (0, radius_m), (0, -radius_m))
    ]
    ends += route.rally_enu
    box = box_of([*corners, *(end[:2] for end in ends)])
    if box is None:
        return []
    box = box.at_least(_LEAST_M, _LEAST_M).padded(0.06, 0.5)
    box = box.at_least(max(box.height * WIDTH_PX / _HIGHEST_PX, box.width), box.height)
    view = View(box, WIDTH_PX, WIDTH_PX * box.height / box.width)
    fence = Fence(list(route.zones))
    above = [
        *grid(view, "east", "north"),
        *fence_from_above(fence, view),
        *_drawing(route, view, lambda enu: (enu[0], enu[1])),
    ]
    pictures = [(view, "From above: north is up, metres from home.", "".join(above))]
    if ends:
        pictures.append(_from_aside(route, fence, ends))
    return pictures


def _from_aside(route: Route, fence: Fence, ends: list[Vec3]) -> tuple[View, str, str]:
    spans = [max(e[axis] for e in ends) - min(e[axis] for e in ends) for axis in (0, 1)]
    axis = 0 if spans[0] >= spans[1] else 1
    side, along = (("south", "east"), ("east", "north"))[axis]
    box = box_of([(end[axis], end[2]) for end in ends])
    assert box is not None
    box = box.at_least(_LEAST_M, 2.0).padded(0.06, 0.5)
    box = Box(box.left, box.right, min(box.bottom, -0.5), box.top)
    view = View(box, WIDTH_PX, 0.5 * WIDTH_PX)
    inner = [
        *grid(view, along, "up"),
        *fence_from_aside(fence, view, axis),
        *_drawing(route, view, lambda enu: (enu[axis], enu[2])),
    ]
    stretch = view.y_scale / view.x_scale
    title = (
        f"From the {side}: {along} to the right, metres above home. Heights are drawn "
        f"{stretch:.1f} times as large as distances."
    )
    return view, title, "".join(inner)


def _drawing(route: Route, view: View, plane: Plane) -> Iterator[str]:
    """The legs in the colours of their order, dashed on the way of a return; then the marks."""
    yield '<g class="path">'
    total_m = max(route.length_m, 1e-9)
    done_m = 0.0
    for leg in route.legs:
        (x0, y0), (x1, y1) = view.px(*plane(leg.from_enu)), view.px(*plane(leg.to_enu))
        colour = colour_of((done_m + leg.length_m / 2) / total_m)
        dashes = ' stroke-dasharray="3 8"' if leg.kind is LegKind.RETURN else ""
        title = f"item {leg.item}: {leg.kind.value}, {leg.length_m:.1f} m"
        yield (
            f'<polyline points="{x0:.1f},{y0:.1f} {x1:.1f},{y1:.1f}" stroke="{colour}"{dashes}>'
            f"<title>{text(title)}</title></polyline>"
        )
        done_m += leg.length_m
    for centre, radius_m in route.circles:
        ring = [
            (
                centre[0] + radius_m * math.sin(math.tau * i / 72),
                centre[1] + radius_m * math.cos(math.tau * i / 72),
                centre[2],
            )
            for i in range(73)
        ]
        points = " ".join(f"{x:.1f},{y:.1f}" for x, y in (view.px(*plane(p)) for p in ring))
        yield f'<polyline points="{points}" stroke="{colour_of(0.5)}"/>'
    yield "</g>"
    yield from _marks(route, view, plane)


def _marks(route: Route, view: View, plane: Plane) -> Iterator[str]:
    """Home, rally points, and the items' numbers where there is room for them."""
    taken: list[tuple[float, float]] = []
    named = [("H", (0.0, 0.0, 0.0))] if route.legs else []
    named += [("R", point) for point in route.rally_enu]
    named += [(str(number), place) for number, place in route.places.items()]
    for name, enu in named:
        x, y = view.px(*plane(enu))
        if any(abs(x - a) + abs(y - b) < _LABEL_ROOM_PX for a, b in taken):
            continue
        taken.append((x, y))
        yield (
            f'<g class="goal"><circle cx="{x:.1f}" cy="{y:.1f}" r="4"/>'
            f'<text x="{x + 7:.1f}" y="{y - 5:.1f}">{text(name)}</text></g>'
        )
