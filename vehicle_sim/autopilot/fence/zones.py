"""The uploaded fence: what of it is sound, and how far a place is from leaving it.

Allowed is what lies inside every inclusion zone and outside every exclusion zone.  ArduCopter
and PX4 since 1.15 read it so; PX4 1.14 was content with one inclusion zone of several, which
FENCE_OPTIONS asks of ArduCopter too.

A zone is where it was put on the map: its heights mean nothing, in either autopilot.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from math import inf, isfinite, sqrt
from typing import TypeAlias

from vehicle_sim.autopilot.geo import Projection
from vehicle_sim.autopilot.interface import Flaw, Geodetic, PlanItem, Refusal
from vehicle_sim.autopilot.modes import Personality
from vehicle_sim.autopilot.rules import RULES

Vec2 = tuple[float, float]

_RETURN_POINT = 5000  # MAV_CMD_NAV_FENCE_RETURN_POINT
_POLYGONS = {5001: True, 5002: False}  # NAV_FENCE_POLYGON_VERTEX_INCLUSION, _EXCLUSION
_CIRCLES = {5003: True, 5004: False}  # NAV_FENCE_CIRCLE_INCLUSION, _EXCLUSION
_FRAMES = frozenset({0, 3, 5, 6})  # MAV_FRAME_GLOBAL, _RELATIVE_ALT, and both as _INT
_VERTICES_MIN = 3
_VERTICES_MAX: dict[Personality, int] = {"px4": 65535, "ardupilot": 255}  # as they store them


@dataclass(frozen=True, slots=True)
class CircleZone:
    """Radius in metres about a place, north and east of the origin [m]."""

    inclusion: bool
    centre_ne: Vec2
    radius_m: float

    def depth_m(self, north_m: float, east_m: float, beyond_m: float) -> float:
        """How deep inside the place is; negative: how far outside."""
        n, e = north_m - self.centre_ne[0], east_m - self.centre_ne[1]
        return self.radius_m - sqrt(n * n + e * e)


@dataclass(frozen=True, slots=True)
class Polygon:
    """Vertices north and east of the origin [m]; the last is joined to the first.

    Where edges cross, inside is what an odd number of edges surrounds.
    """

    inclusion: bool
    vertices_ne: tuple[Vec2, ...]
    low_ne: Vec2
    high_ne: Vec2

    def depth_m(self, north_m: float, east_m: float, beyond_m: float) -> float:
        """How deep inside the place is; negative: how far outside.

        A place that is further outside than `beyond_m` may be said to be just as far off as the
        polygon's bounding box, which is cheaper.
        """
        off_n = max(self.low_ne[0] - north_m, north_m - self.high_ne[0], 0.0)
        off_e = max(self.low_ne[1] - east_m, east_m - self.high_ne[1], 0.0)
        box_m = sqrt(off_n * off_n + off_e * off_e)
        if box_m > beyond_m:
            return -box_m
        inside = False
        nearest = inf
        a_n, a_e = self.vertices_ne[-1]
        for b_n, b_e in self.vertices_ne:
            d_n, d_e = b_n - a_n, b_e - a_e
            p_n, p_e = north_m - a_n, east_m - a_e
            if (a_e > east_m) != (b_e > east_m) and p_n < d_n * p_e / d_e:
                inside = not inside
            length = d_n * d_n + d_e * d_e
            along = (p_n * d_n + p_e * d_e) / length if length > 0.0 else 0.0
            along = min(1.0, max(0.0, along))
            p_n -= along * d_n
            p_e -= along * d_e
            nearest = min(nearest, p_n * p_n + p_e * p_e)
            a_n, a_e = b_n, b_e
        return sqrt(nearest) if inside else -sqrt(nearest)


Zone: TypeAlias = CircleZone | Polygon


@dataclass(frozen=True, slots=True)
class Fence:
    """All zones of one upload.  `return_point` is kept and not flown to: copters return home."""

    zones: tuple[Zone, ...] = ()
    return_ne: Vec2 | None = None

    def room_m(self, north_m: float, east_m: float, union: bool = False) -> float:
        """How far it is at least to the nearest border; negative = outside.

        So within a circle of that radius nothing changes.  Without zones it is infinite.
        `union`: one inclusion zone of several is enough.
        """
        room = inf
        widest = -inf
        for zone in self.zones:
            if zone.inclusion:
                depth = zone.depth_m(north_m, east_m, inf)
                if union:
                    widest = max(widest, depth)
                else:
                    room = min(room, depth)
            else:
                room = min(room, -zone.depth_m(north_m, east_m, room if room > 0.0 else 0.0))
        return min(room, widest) if widest > -inf else room


def check(items: tuple[PlanItem, ...], personality: Personality) -> Refusal | None:
    """The first item that the autopilot would not take; None when it takes them all.

    By ArduPilot's AC_PolyFence_loader and PX4's mission protocol, which name the same faults;
    only ArduPilot minds a second return point.
    """
    left = 0  # vertices that the present polygon still wants
    first = items[0] if items else None
    returns = 0
    for item in items:
        refusal = _item(item, personality)
        if refusal is not None:
            return refusal
        if left > 0 and first is not None:
            if item.command != first.command or item.p1 != first.p1:
                why = f"the polygon of item {first.seq} lacks {left} vertices"
                return Refusal(item.seq, Flaw.WHOLE, why)
            left -= 1
        elif item.command in _POLYGONS:
            first = item
            left = int(item.p1) - 1
        returns += item.command == _RETURN_POINT
        if returns > 1 and RULES[personality].one_fence_return_point:
            return Refusal(item.seq, Flaw.WHOLE, "a second return point")
    if left > 0 and first is not None:
        why = f"the polygon lacks {left} of {first.p1:g} vertices"
        return Refusal(first.seq, Flaw.WHOLE, why)
    return None


def _item(item: PlanItem, personality: Personality) -> Refusal | None:
    seq = item.seq
    if item.command not in (_RETURN_POINT, *_POLYGONS, *_CIRCLES):
        return Refusal(seq, Flaw.COMMAND, f"command {item.command} is not for a fence")
    refusal = check_place(item)
    if refusal is not None:
        return refusal
    radius_needed = item.command in _CIRCLES and RULES[personality].fence_circle_needs_radius
    if radius_needed and not 0.0 < item.p1 < inf:
        return Refusal(seq, Flaw.PARAM1, f"radius {item.p1:g} m")
    if item.command in _POLYGONS:
        whole = isfinite(item.p1) and item.p1 == int(item.p1)
        if not whole or not _VERTICES_MIN <= item.p1 <= _VERTICES_MAX[personality]:
            return Refusal(seq, Flaw.PARAM1, f"polygon of {item.p1:g} vertices")
    return None


def check_place(item: PlanItem) -> Refusal | None:
    """Whether the item lies on Earth, in a frame with latitude and longitude."""
    if item.frame not in _FRAMES:
        return Refusal(item.seq, Flaw.FRAME, f"frame {item.frame} is not supported")
    if abs(item.x) > 900_000_000 or abs(item.y) > 1_800_000_000:
        return Refusal(item.seq, Flaw.PLACE, "the position is not on Earth")
    return None


def build(items: Iterable[PlanItem], projection: Projection) -> Fence:
    """The fence of items that `check` has passed, in the vehicle's own projection."""
    zones: list[Zone] = []
    return_ne: Vec2 | None = None
    corners: list[Vec2] = []
    for item in items:
        where_ne = place_ne(item, projection)
        if item.command in _CIRCLES:
            radius_m = item.p1 if item.p1 > 0.0 else 0.0
            zones.append(CircleZone(_CIRCLES[item.command], where_ne, radius_m))
        elif item.command in _POLYGONS:
            corners.append(where_ne)
            if len(corners) == int(item.p1):
                zones.append(polygon(_POLYGONS[item.command], tuple(corners)))
                corners = []
        else:
            return_ne = where_ne
    return Fence(tuple(zones), return_ne)


def polygon(inclusion: bool, vertices_ne: tuple[Vec2, ...]) -> Polygon:
    """A polygon with its bounding box."""
    north = [vertex[0] for vertex in vertices_ne]
    east = [vertex[1] for vertex in vertices_ne]
    return Polygon(inclusion, vertices_ne, (min(north), min(east)), (max(north), max(east)))


def place_ne(item: PlanItem, projection: Projection) -> Vec2:
    """Metres north and east of the origin."""
    north, east, _ = projection.to_local(Geodetic(item.x * 1e-7, item.y * 1e-7, 0.0))
    return (north, east)
