"""Is there a place in a polygon that keeps a distance to its boundary?

The box of the polygon is cut into squares.  A square whose centre has so little clearance that no
point of it can have enough is dropped; every other is cut into four, the most promising first
(V. Agafonkin's polylabel, 2016, which ends here at the first place that is found).
"""

from __future__ import annotations

import math
from heapq import heapify, heappop, heappush
from typing import Final

from gcs.gate.geometry import TOLERANCE_M, Point, Polygon

LOOKED_AT: Final = 400_000
"""So many edges are looked at before the search is given up: some tenths of a second."""

FINEST: Final = 0.01
"""A square that is smaller than this share of the distance is not cut any further."""


def has_room(polygon: Polygon, distance_m: float) -> bool:
    """False: no place inside is farther than `distance_m` from the boundary, but by a hundredth.

    True where there is one, and where the search is given up.  Then every goal is refused for
    itself.
    """
    south_west, north_east = _box(polygon)
    width_m, height_m = (b - a for a, b in zip(south_west, north_east, strict=True))
    half_m = 0.5 * max(min(width_m, height_m), max(width_m, height_m) / 256.0)
    cells = [
        _cell(polygon, (south_west[0] + (2 * i + 1) * half_m, south_west[1] + (2 * k + 1) * half_m))
        for i in range(math.ceil(width_m / (2.0 * half_m)))
        for k in range(math.ceil(height_m / (2.0 * half_m)))
    ]
    open_cells = [(-clear_m - half_m * math.sqrt(2.0), half_m, at) for clear_m, at in cells]
    heapify(open_cells)
    if any(clear_m > distance_m for clear_m, _ in cells):
        return True
    left = LOOKED_AT // len(polygon.edges)
    while open_cells:
        best_m, half_m, (east, north) = heappop(open_cells)
        if -best_m <= distance_m + TOLERANCE_M:
            return False
        half_m *= 0.5
        if half_m < FINEST * distance_m:
            continue
        for corner in ((-half_m, -half_m), (half_m, -half_m), (-half_m, half_m), (half_m, half_m)):
            clear_m, at = _cell(polygon, (east + corner[0], north + corner[1]))
            if clear_m > distance_m:
                return True
            heappush(open_cells, (-clear_m - half_m * math.sqrt(2.0), half_m, at))
            left -= 1
        if left <= 0:
            return True
    return False


def _cell(polygon: Polygon, centre: Point) -> tuple[float, Point]:
    return polygon.clearance(centre), centre


def _box(polygon: Polygon) -> tuple[Point, Point]:
    easts, norths = zip(*polygon.corners_en, strict=True)
    return (min(easts), min(norths)), (max(easts), max(norths))
