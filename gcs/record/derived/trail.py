"""Where a vehicle has been, as few points that keep the shape of the way."""

from __future__ import annotations

from math import dist, inf, sqrt

from gcs.frames import Vec3

SPACING_M = 0.2
TOLERANCE_M = 0.05
MOST_CORNERS = 800
_WINDOW = 64
"""Samples of one straight stretch that are kept to look back at."""


class Trail:
    """Points of a way, ENU, such that no sample lies far from the line through them.

    A straight stretch is two points: a corner is made where a sample would lie farther than
    `TOLERANCE_M` from the line (an opening window).  Where there are `MOST_CORNERS`, each new one
    takes the place of the one that matters least, by the area of the triangle with its neighbours
    (Visvalingam and Whyatt 1993); so adding a point never takes long.
    """

    __slots__ = ("_areas", "_corners", "_window")

    def __init__(self) -> None:
        self._corners: list[Vec3] = []
        self._areas: list[float] = []
        self._window: list[Vec3] = []

    @property
    def points_enu(self) -> list[Vec3]:
        """The corners, and where the vehicle is."""
        return self._corners + self._window[-1:]

    def add(self, at_enu: Vec3) -> bool:
        """Whether the point was far enough from the last to change the trail."""
        if not self._corners:
            self._add_corner(at_enu)
            return True
        last = self._window[-1] if self._window else self._corners[-1]
        if dist(last, at_enu) < SPACING_M:
            return False
        start = self._corners[-1]
        straight = len(self._window) < _WINDOW and all(
            _distance(between, start, at_enu) <= TOLERANCE_M for between in self._window
        )
        if not straight:
            self._add_corner(last)
            self._window.clear()
        self._window.append(at_enu)
        return True

    def _add_corner(self, at_enu: Vec3) -> None:
        self._corners.append(at_enu)
        self._areas.append(inf)
        before = len(self._corners) - 2
        if before > 0:
            self._areas[before] = _area(*self._corners[-3:])
        if len(self._corners) > MOST_CORNERS:
            self._drop_least()

    def _drop_least(self) -> None:
        """A neighbour of it counts no less than it did, so that a bend stays."""
        least = min(self._areas)
        i = self._areas.index(least)
        del self._corners[i], self._areas[i]
        for neighbour in (i - 1, i):
            if 0 < neighbour < len(self._corners) - 1:
                self._areas[neighbour] = max(
                    least, _area(*self._corners[neighbour - 1 : neighbour + 2])
                )


def _distance(point: Vec3, a: Vec3, b: Vec3) -> float:
    """From a point to the segment a-b, metres."""
    abx, aby, abz = b[0] - a[0], b[1] - a[1], b[2] - a[2]
    apx, apy, apz = point[0] - a[0], point[1] - a[1], point[2] - a[2]
    length2 = abx * abx + aby * aby + abz * abz
    along = (apx * abx + apy * aby + apz * abz) / length2 if length2 else 0.0
    along = min(1.0, max(0.0, along))
    dx, dy, dz = apx - along * abx, apy - along * aby, apz - along * abz
    return sqrt(dx * dx + dy * dy + dz * dz)


def _area(a: Vec3, b: Vec3, c: Vec3) -> float:
    """Of a triangle: half the length of the cross product, square metres."""
    abx, aby, abz = b[0] - a[0], b[1] - a[1], b[2] - a[2]
    acx, acy, acz = c[0] - a[0], c[1] - a[1], c[2] - a[2]
    x, y, z = aby * acz - abz * acy, abz * acx - abx * acz, abx * acy - aby * acx
    return 0.5 * sqrt(x * x + y * y + z * z)
