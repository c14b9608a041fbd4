"""The path of a vehicle, thinned out while it comes in so that its shape stays.

Points are dropped by the area of the triangle that they make with their neighbours, the least
first (Visvalingam and Whyatt 1993): a straight line needs two points, a curve as many as it takes.
"""

from __future__ import annotations

import heapq
from dataclasses import dataclass, field
from itertools import groupby
from math import dist, sqrt
from operator import attrgetter
from typing import NamedTuple

from gcs.frames import Vec3

KEPT_POINTS = 1_500
_BUFFERED_POINTS = 4_000
LONGEST_STEP_S = 3.0
"""Between two points farther apart in time nothing is known: the line is interrupted there."""


class TrackPoint(NamedTuple):
    t_s: float
    enu: Vec3
    piece: int = 0
    """Counts up at every interruption."""


@dataclass(slots=True)
class Track:
    """Where the vehicle was, and how far it flew."""

    points: list[TrackPoint] = field(default_factory=list)
    length_m: float = 0.0
    _last: TrackPoint | None = None

    def add(self, t_s: float, enu: Vec3, *, flying: bool) -> None:
        """`length_m` grows only while `flying`: an estimate wanders on the ground."""
        last = self._last
        piece = 0 if last is None else last.piece
        if last is not None and t_s - last.t_s > LONGEST_STEP_S:
            piece += 1
        elif last is not None and flying:
            self.length_m += dist(last.enu, enu)
        self._last = point = TrackPoint(t_s, enu, piece)
        self.points.append(point)
        if len(self.points) >= _BUFFERED_POINTS:
            self.points = simplified(self.points, KEPT_POINTS)

    def drawn(self) -> list[list[TrackPoint]]:
        """The track in pieces, interrupted where positions are missing."""
        kept = simplified(self.points, KEPT_POINTS)
        return [list(piece) for _, piece in groupby(kept, key=attrgetter("piece"))]


def simplified(points: list[TrackPoint], count: int) -> list[TrackPoint]:
    """At most `count` of the points, in their order, first and last among them."""
    total = len(points)
    if total <= max(count, 2):
        return points
    before = list(range(-1, total - 1))
    after = list(range(1, total + 1))
    areas = [0.0] * total
    heap = []
    for i in range(1, total - 1):
        areas[i] = _area(points[i - 1].enu, points[i].enu, points[i + 1].enu)
        heap.append((areas[i], i))
    heapq.heapify(heap)
    alive = [True] * total
    left = total
    while left > count and heap:
        area, i = heapq.heappop(heap)
        if not alive[i] or area != areas[i]:
            continue
        alive[i] = False
        left -= 1
        low, high = before[i], after[i]
        after[low], before[high] = high, low
        for j in (low, high):
            if 0 < j < total - 1:
                # Never less than what was dropped beside it, else a curve is worn down one by one.
                fresh = _area(points[before[j]].enu, points[j].enu, points[after[j]].enu)
                areas[j] = max(area, fresh)
                heapq.heappush(heap, (areas[j], j))
    return [point for point, keep in zip(points, alive, strict=True) if keep]


def _area(a: Vec3, b: Vec3, c: Vec3) -> float:
    ux, uy, uz = b[0] - a[0], b[1] - a[1], b[2] - a[2]
    vx, vy, vz = c[0] - a[0], c[1] - a[1], c[2] - a[2]
    x, y, z = uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx
    return sqrt(x * x + y * y + z * z) / 2
