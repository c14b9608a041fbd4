"""Which part of the world the map shows, and at what scale."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from gcs import ipc
from gcs.tui.braille import Point

HALF_SPANS_M = (2.0, 5.0, 10.0, 20.0, 50.0, 100.0, 200.0, 500.0, 1000.0, 2000.0, 5000.0)
MARGIN = 1.15
SAME_M = 1.0
"""Zones are the same where their edges are no farther apart."""


@dataclass(frozen=True, slots=True)
class View:
    """North is up; `m_per_dot` metres a braille dot in both directions."""

    centre_en: tuple[float, float]
    m_per_dot: float
    width: int
    height: int

    def dots(self, east_m: float, north_m: float) -> Point:
        """Where a point falls, in dots from the top left."""
        x = (east_m - self.centre_en[0]) / self.m_per_dot + self.width / 2
        y = (self.centre_en[1] - north_m) / self.m_per_dot + self.height / 2
        return (x, y)

    @property
    def half_width_m(self) -> float:
        return self.width / 2 * self.m_per_dot

    @property
    def half_height_m(self) -> float:
        return self.height / 2 * self.m_per_dot


def fit(
    centre_en: tuple[float, float],
    points_en: Iterable[tuple[float, float]],
    width: int,
    height: int,
    zoom: int = 0,
) -> View:
    """The closest of the fixed scales that has every point in it, `zoom` scales farther.

    Fixed scales around a fixed centre keep the picture still while the vehicle moves.
    """
    need_m = max(
        (max(abs(e - centre_en[0]), abs(n - centre_en[1])) * MARGIN for e, n in points_en),
        default=0.0,
    )
    fitting = next((i for i, m in enumerate(HALF_SPANS_M) if m >= need_m), len(HALF_SPANS_M) - 1)
    chosen = min(max(fitting + zoom, 0), len(HALF_SPANS_M) - 1)
    return View(centre_en, HALF_SPANS_M[chosen] / (min(width, height) / 2), width, height)


def nice_length(m_at_most: float) -> float:
    """The largest of 1, 2, 5 x 10^n that is not longer."""
    # The logarithm may round up to the next power of ten: 0.5 of that is always short enough.
    power = 10.0 ** math.floor(math.log10(m_at_most))
    return max(step * power for step in (0.5, 1, 2, 5) if step * power <= m_at_most)


def outline(zone: ipc.FenceShape) -> list[tuple[float, float]]:
    """A closed line along a zone's edge, east and north."""
    if zone.centre_en is not None:
        east, north = zone.centre_en
        turns = [2 * math.pi * i / 96 for i in range(97)]
        return [
            (east + zone.radius_m * math.sin(a), north + zone.radius_m * math.cos(a)) for a in turns
        ]
    return [*zone.corners_en, *zone.corners_en[:1]]


def others(
    zones: Sequence[ipc.FenceShape], known: Sequence[ipc.FenceShape]
) -> list[ipc.FenceShape]:
    """Those zones that are not among the known ones, as seen from above."""
    return [zone for zone in zones if not any(_same(zone, each) for each in known)]


def _same(one: ipc.FenceShape, other: ipc.FenceShape) -> bool:
    edge, points = outline(one), outline(other)
    if one.inclusion != other.inclusion or len(edge) != len(points):
        return False
    return all(min(math.dist(p, q) for q in points) < SAME_M for p in edge)
