"""The fence in the pictures of the path: zones, and the margin that goals keep from them."""

from __future__ import annotations

from collections.abc import Sequence
from math import cos, pi, sin

from gcs.flight_report.flight import Fence
from gcs.flight_report.page.html_text import text
from gcs.flight_report.projection import View
from gcs.report import FenceShape

_CORNERS = 72
FARTHEST_PX = 1e7


def zone_outline(zone: FenceShape) -> Sequence[tuple[float, float]]:
    """East and north in metres; a circle as a polygon."""
    if zone.centre_en is None:
        return zone.corners_en
    east, north = zone.centre_en
    turns = [2 * pi * i / _CORNERS for i in range(_CORNERS)]
    return [(east + zone.radius_m * sin(a), north + zone.radius_m * cos(a)) for a in turns]


def fence_from_above(fence: Fence, view: View) -> list[str]:
    """A margin is a stroke of twice its width: inside, cut off by the zone; outside, under it."""
    parts = []
    for number, zone in enumerate(fence.zones):
        places = [view.px(*corner) for corner in zone_outline(zone)]
        points = " ".join(f"{_drawable(x):.1f},{_drawable(y):.1f}" for x, y in places)
        if not points:
            continue
        shape = f'<polygon points="{points}"'
        margin_px = 2.0 * fence.margin_h_m * view.x_scale
        kind = "inside" if zone.inclusion else "outside"
        clip = f"zone{number}"
        if zone.inclusion:
            parts.append(f'<clipPath id="{clip}">{shape}/></clipPath>')
        cut = f' clip-path="url(#{clip})"' if zone.inclusion else ""
        parts.append(
            f'<g class="zone {kind}"><title>{_name(zone)}</title>'
            f'{shape} class="margin" stroke-width="{margin_px:.1f}"{cut}/>'
            + ("" if zone.inclusion else f'{shape} class="ground"/>')
            + f'{shape} class="edge"/></g>'
        )
    return parts


def fence_from_aside(fence: Fence, view: View, axis: int) -> list[str]:
    """Every zone as its greatest width and its heights; an open bound ends with the view."""
    parts = []
    box = view.box
    for zone in fence.zones:
        along = [corner[axis] for corner in zone_outline(zone)]
        if not along:
            continue
        floor = box.bottom if zone.floor_up_m is None else zone.floor_up_m
        ceiling = box.top if zone.ceiling_up_m is None else zone.ceiling_up_m
        left, top = view.px(min(along), ceiling)
        right, bottom = view.px(max(along), floor)
        left, right, top, bottom = map(_drawable, (left, right, top, bottom))
        width, height = right - left, bottom - top
        if width <= 0 or height <= 0:
            continue
        kind = "inside" if zone.inclusion else "outside"
        out = 1.0 if not zone.inclusion else -1.0
        dx, dy = fence.margin_h_m * view.x_scale * out, fence.margin_v_m * view.y_scale * out
        wide, high = width + 2 * dx, height + 2 * dy
        margin = (
            f'<rect class="margin-line" x="{left - dx:.1f}" y="{top - dy:.1f}" '
            f'width="{wide:.1f}" height="{high:.1f}"/>'
            if wide > 0 and high > 0
            else ""
        )
        parts.append(
            f'<g class="zone {kind}"><title>{_name(zone)}</title>{margin}'
            f'<rect class="edge" x="{left:.1f}" y="{top:.1f}" width="{width:.1f}" '
            f'height="{height:.1f}"/></g>'
        )
    return parts


def _drawable(pixels: float) -> float:
    """Browsers draw no coordinates of any size; farther out nobody sees the difference."""
    return max(-FARTHEST_PX, min(FARTHEST_PX, pixels))


def _name(zone: FenceShape) -> str:
    kind = "stay inside" if zone.inclusion else "stay outside"
    bounds = [
        f"{word} {bound:.1f} m"
        for word, bound in (("floor", zone.floor_up_m), ("ceiling", zone.ceiling_up_m))
        if bound is not None
    ]
    return text(", ".join([f"{zone.name}: {kind}", *bounds]))
