"""Pictures of many flights: how a measure is distributed, and how near they came by each axis."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from gcs.campaign.case import MEASURES, Row
from gcs.campaign.plan import Choice, Plan
from gcs.flight_report.page.html_text import text
from gcs.flight_report.page.path_svg import grid
from gcs.flight_report.projection import Box, View

BINS = 32
MOST_DOTS = 1_500
_WIDTH_PX, _HEIGHT_PX = 640.0, 300.0
TITLES = {
    "closest_m": "Closest to the fence",
    "max_up_m": "Greatest height",
    "max_distance_m": "Farthest from home",
    "max_speed_m_s": "Fastest",
    "touchdown_m_s": "Touch-down",
    "flight_s": "Time armed",
    "energy_wh": "Energy",
}


def distributions(rows: Sequence[Row]) -> str:
    """A histogram of each measure."""
    flown = [row for row in rows if row.closest_m is not None]
    figures = []
    for name, unit in MEASURES.items():
        values = [v for row in flown if (v := getattr(row, name)) is not None]
        if values:
            figures.append(_figure(_histogram(values, unit), TITLES[name]))
    return f'<div class="pictures">{"".join(figures)}</div>'


def by_axis(plan: Plan, rows: Sequence[Row]) -> str:
    """Each flight as a dot, its closest approach over each axis of numbers."""
    flown = [row for row in rows if row.closest_m is not None]
    step = max(1, len(flown) // MOST_DOTS)
    shown = [row for place, row in enumerate(flown) if place % step == 0 or row.breach]
    figures = []
    for axis in plan.axes:
        single = isinstance(axis, Choice) and len(axis.values) < 2
        numbers = all(isinstance(row.inputs[axis.name], int | float) for row in shown)
        if shown and numbers and not single:
            dots = [(float(row.inputs[axis.name]), row) for row in shown]
            figures.append(_figure(_dots(axis.name, dots), axis.name))
    return f'<div class="pictures">{"".join(figures)}</div>' if figures else ""


def _figure(svg: str, caption: str) -> str:
    return f"<figure>{svg}<figcaption>{text(caption)}</figcaption></figure>"


def _histogram(values: Sequence[float], unit: str) -> str:
    low, high = min(values), max(values)
    if high - low < 1e-9:
        low, high = low - 0.5, high + 0.5
    counts = [0] * BINS
    for value in values:
        counts[min(BINS - 1, int((value - low) / (high - low) * BINS))] += 1
    view = View(Box(low, high, 0.0, 1.1 * max(counts)), _WIDTH_PX, _HEIGHT_PX)
    wide = (high - low) / BINS
    bars = []
    for number, count in enumerate(counts):
        left, top = view.px(low + number * wide, count)
        right, bottom = view.px(low + (number + 1) * wide, 0.0)
        bad = unit == "m" and low + (number + 0.5) * wide < 0.0
        bars.append(
            f'<rect x="{left:.1f}" y="{top:.1f}" width="{max(1.0, right - left - 1):.1f}" '
            f'height="{bottom - top:.1f}" style="fill:var(--{"bad" if bad else "c1"})"/>'
        )
    return _svg(view, [*bars, *grid(view, unit, "flights", "")])


def _dots(name: str, dots: Iterable[tuple[float, Row]]) -> str:
    placed = [(x, row.closest_m or 0.0, row) for x, row in dots]
    xs, ys = [each[0] for each in placed], [each[1] for each in placed]
    box = Box(min(xs), max(xs), min(0.0, *ys), max(ys)).padded(0.04, 1e-3)
    view = View(box, _WIDTH_PX, _HEIGHT_PX)
    marks = []
    for x, y, row in placed:
        px, py = view.px(x, y)
        colour = "bad" if row.breach else "c1"
        marks.append(
            f'<circle cx="{px:.1f}" cy="{py:.1f}" r="3" fill-opacity=".55" '
            f'style="fill:var(--{colour})"><title>{row.id}: {y:.2f} m</title></circle>'
        )
    _, zero = view.px(0.0, 0.0)
    edge = f'<path d="M0 {zero:.1f}H{_WIDTH_PX:.0f}" style="stroke:var(--bad)"/>'
    return _svg(view, [*grid(view, text(name), "closest, m", ""), edge, *marks])


def _svg(view: View, parts: Iterable[str]) -> str:
    size = f"0 0 {view.width_px:.0f} {view.height_px:.0f}"
    return f'<svg viewBox="{size}" role="img">{"".join(parts)}</svg>'
