"""Plane outlines for drawing: a zone's corners, its margin, and its area as triangles."""

from __future__ import annotations

from collections.abc import Sequence
from math import atan2, ceil, cos, hypot, pi, sin

from gcs.report import FenceShape

CIRCLE_CORNERS = 72
ARC_STEP_RAD = pi / 12

Point = tuple[float, float]
Outline = Sequence[Point]


def corners(zone: FenceShape) -> Outline:
    """The zone's outline, east and north in metres; a circle as a polygon for drawing."""
    if zone.centre_en is None:
        return zone.corners_en
    return _circle(zone.centre_en, zone.radius_m)


def margin_outline(zone: FenceShape, margin_m: float) -> Outline:
    """How near to its boundary the gate lets a goal be: inside an inclusion, outside an exclusion.

    Empty where the margin leaves nothing of the zone.
    """
    into_m = margin_m if zone.inclusion else -margin_m
    if zone.centre_en is not None:
        radius_m = zone.radius_m - into_m
        return _circle(zone.centre_en, radius_m) if radius_m > 0.0 else ()
    outline = list(zone.corners_en)
    if len(outline) < 3:
        return ()
    if _area(outline) < 0.0:
        outline.reverse()
    return _moved(outline, into_m)


def triangles(outline: Outline) -> list[tuple[int, int, int]]:
    """The area, by cutting off ears (Meisters 1975): three numbers of corners each."""
    left = list(range(len(outline)))
    if _area(outline) < 0.0:
        left.reverse()
    found: list[tuple[int, int, int]] = []
    while len(left) > 3:
        ear = next((i for i in range(len(left)) if _is_ear(outline, left, i)), None)
        if ear is None:
            return found
        found.append((left[ear - 1], left[ear], left[(ear + 1) % len(left)]))
        del left[ear]
    return [*found, (left[0], left[1], left[2])] if len(left) == 3 else found


def _circle(centre: Point, radius_m: float) -> Outline:
    east, north = centre
    turns = [2 * pi * i / CIRCLE_CORNERS for i in range(CIRCLE_CORNERS)]
    return [(east + radius_m * sin(a), north + radius_m * cos(a)) for a in turns]


def _moved(outline: list[Point], into_m: float) -> Outline:
    """A polygon, anticlockwise, with every side moved inwards (outwards where negative).

    A corner that opens on the side it moves to becomes an arc: what is as near as the margin to a
    corner lies on a circle about it.
    """
    moved: list[Point] = []
    count = len(outline)
    for i, at in enumerate(outline):
        before, after = outline[i - 1], outline[(i + 1) % count]
        first, second = _normal(before, at), _normal(at, after)
        bend = first[0] * second[1] - first[1] * second[0]
        if bend * into_m < 0.0:
            moved += _arc(at, first, second, into_m)
            continue
        scale = 1.0 + first[0] * second[0] + first[1] * second[1]
        if scale < 1e-6:
            continue
        reach = into_m / scale
        moved.append(
            (at[0] + (first[0] + second[0]) * reach, at[1] + (first[1] + second[1]) * reach)
        )
    least_m = abs(into_m) - 1e-6
    clear = [at for at in moved if _to_edge(at, outline) >= least_m]
    return clear if len(clear) >= 3 else ()


def _to_edge(at: Point, outline: Sequence[Point]) -> float:
    """The distance to the nearest side, metres."""
    return min(_to_side(at, outline[i - 1], b) for i, b in enumerate(outline))


def _to_side(at: Point, a: Point, b: Point) -> float:
    east, north = b[0] - a[0], b[1] - a[1]
    length2 = east * east + north * north
    along = ((at[0] - a[0]) * east + (at[1] - a[1]) * north) / length2 if length2 else 0.0
    along = min(1.0, max(0.0, along))
    return hypot(at[0] - a[0] - along * east, at[1] - a[1] - along * north)


def _arc(at: Point, first: Point, second: Point, into_m: float) -> list[Point]:
    start = atan2(first[1], first[0])
    turn = atan2(
        first[0] * second[1] - first[1] * second[0], first[0] * second[0] + first[1] * second[1]
    )
    steps = max(1, ceil(abs(turn) / ARC_STEP_RAD))
    angles = [start + turn * step / steps for step in range(steps + 1)]
    return [(at[0] + into_m * cos(angle), at[1] + into_m * sin(angle)) for angle in angles]


def _normal(a: Point, b: Point) -> Point:
    """Of length 1, to the left of a-b: inwards where the outline runs anticlockwise."""
    east, north = b[0] - a[0], b[1] - a[1]
    length = hypot(east, north) or 1.0
    return (-north / length, east / length)


def _area(outline: Outline) -> float:
    """Positive where the outline runs anticlockwise."""
    return (
        sum(outline[i - 1][0] * at[1] - at[0] * outline[i - 1][1] for i, at in enumerate(outline))
        / 2.0
    )


def _is_ear(outline: Outline, left: list[int], i: int) -> bool:
    a, b, c = (outline[left[j % len(left)]] for j in (i - 1, i, i + 1))
    if _cross(a, b, c) <= 0.0:
        return False
    others = (outline[j] for j in left)
    return not any(_within(p, a, b, c) for p in others if p not in (a, b, c))


def _within(p: Point, a: Point, b: Point, c: Point) -> bool:
    return _cross(a, b, p) >= 0.0 and _cross(b, c, p) >= 0.0 and _cross(c, a, p) >= 0.0


def _cross(a: Point, b: Point, c: Point) -> float:
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
