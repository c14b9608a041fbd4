"""Zones of the fence as they are written in a policy or a plan file, not yet placed.

The fields are the keys of a `[[fence]]` table of a policy; `kind` says which of the structs.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from heapq import heapify, heappop, heappush
from types import MappingProxyType
from typing import Annotated, Final, Literal, NamedTuple, TypeAlias

from msgspec import Meta, Struct

from gcs.gate.geometry import REACH_M, TOLERANCE_M, Circle, Point, Polygon, polygon_fault

EARTH_M: Final = 6_371_000.0
HOME_EN: Final = (0.0, 0.0)
HOME_HINT: Final = 'home is [0, 0] in frame = "home", the default: the vehicle takes off there'
ROOM_HINT: Final = "a larger zone, or a smaller margin_h_m"
CORNERS_HINT: Final = "corners in order round the zone, each once"

Frame: TypeAlias = Literal["home", "local", "geographic"]
"""What a zone's numbers count from.

home: metres east, north and up of home.  local: of the local origin.  geographic: degrees of
latitude and longitude, heights above home; known only once the vehicle's origin is.
"""

Text: TypeAlias = Annotated[str, Meta(pattern=r"\S")]
Height: TypeAlias = Annotated[float, Meta(ge=-1.0e4, le=1.0e5)]
Radius: TypeAlias = Annotated[float, Meta(ge=0.01, le=1.0e5)]
Coordinate: TypeAlias = Annotated[float, Meta(ge=-1.0e6, le=1.0e6)]
Pair: TypeAlias = tuple[Coordinate, Coordinate]


class _Zone(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True, tag_field="kind"):
    """What all kinds of zones have.

    `inclusion` True: stay inside; False: stay outside.  A floor or ceiling of None is none: the
    zone is open on that side.
    """

    name: Text
    inclusion: bool = True
    frame: Frame = "home"
    floor_up_m: Height | None = None
    ceiling_up_m: Height | None = None


class CircleSpec(_Zone, frozen=True, tag="circle"):
    """`centre` is (east, north) metres, or (latitude, longitude) degrees if geographic."""

    radius_m: Radius
    centre: Pair = (0.0, 0.0)


class BoxSpec(_Zone, frozen=True, tag="box"):
    """Sides parallel to east and north, each as (from, to) in metres."""

    east_m: Pair
    north_m: Pair


class PolygonSpec(_Zone, frozen=True, tag="polygon"):
    """Corners in order, either way round, as (east, north) or (latitude, longitude)."""

    corners: tuple[Pair, ...]


ZoneSpec: TypeAlias = CircleSpec | BoxSpec | PolygonSpec

KINDS: Final[Mapping[str, type[ZoneSpec]]] = MappingProxyType(
    {"circle": CircleSpec, "box": BoxSpec, "polygon": PolygonSpec}
)


class Fault(NamedTuple):
    """What is wrong with the value of a key, and what to do about it."""

    key: str
    what: str
    hint: str = ""


def zone_fault(zone: ZoneSpec) -> Fault | None:
    """The first thing about the zone that cannot be meant; None if there is none."""
    fault = _shape_fault(zone)
    floor_up_m, ceiling_up_m = zone.floor_up_m, zone.ceiling_up_m
    if fault is not None or floor_up_m is None or ceiling_up_m is None:
        return fault
    if floor_up_m >= ceiling_up_m:
        what = f"{ceiling_up_m:g} is not above the floor of {floor_up_m:g}"
        return Fault("ceiling_up_m", what)
    return None


def _shape_fault(zone: ZoneSpec) -> Fault | None:
    match zone:
        case CircleSpec():
            return _degrees_fault("centre", zone.frame, (zone.centre,))
        case BoxSpec():
            for key, (low, high) in (("east_m", zone.east_m), ("north_m", zone.north_m)):
                if low >= high:
                    what = f"[{low:g}, {high:g}] is empty"
                    return Fault(key, what, "write the smaller number first")
            return None
        case PolygonSpec(corners):
            fault = _degrees_fault("corners", zone.frame, corners)
            if fault is None:
                bad = polygon_fault(plane_corners(zone))
                fault = None if bad is None else Fault("corners", bad, CORNERS_HINT)
            return fault


def plane_corners(zone: PolygonSpec) -> tuple[Point, ...]:
    """Its corners as (east, north) metres, without a last one that only closes the ring.

    Geographic ones about the first, seen from straight above it: whether edges meet, and how much
    room there is between them, is the same wherever the vehicle's own origin is, but for a few
    parts in a thousand.  A corner that is not within 1000 km of the first is infinitely far.
    """
    corners = open_ring(zone.corners)
    if zone.frame != "geographic" or not corners:
        return corners
    lat0_deg, lon0_deg = corners[0]
    return tuple(_seen_from_above(*corner, lat0_deg, lon0_deg) for corner in corners)


def geographic_points(zone: ZoneSpec) -> tuple[Point, ...]:
    """The (latitude, longitude) that a geographic zone is made of; a box has none."""
    match zone:
        case CircleSpec():
            return (zone.centre,)
        case PolygonSpec():
            return zone.corners
        case BoxSpec():
            return ()


def open_ring(corners: tuple[Point, ...]) -> tuple[Point, ...]:
    """Without a last corner that only closes the ring, as GeoJSON and others write it."""
    closed = len(corners) > 3 and corners[0] == corners[-1]
    return corners[:-1] if closed else corners


def _seen_from_above(
    lat_deg: float, lon_deg: float, lat0_deg: float, lon0_deg: float
) -> tuple[float, float]:
    """East and north of the second place: the orthographic projection of a sphere."""
    lat, lat0 = math.radians(lat_deg), math.radians(lat0_deg)
    dlon = math.radians(lon_deg - lon0_deg)
    north = math.cos(lat0) * math.sin(lat) - math.sin(lat0) * math.cos(lat) * math.cos(dlon)
    east = math.cos(lat) * math.sin(dlon)
    up = math.sin(lat0) * math.sin(lat) + math.cos(lat0) * math.cos(lat) * math.cos(dlon)
    if math.atan2(math.hypot(north, east), up) * EARTH_M > REACH_M:
        return (math.inf, math.inf)
    return (east * EARTH_M, north * EARTH_M)


def _degrees_fault(key: str, frame: Frame, points: tuple[Point, ...]) -> Fault | None:
    for lat_deg, lon_deg in points if frame == "geographic" else ():
        if not (abs(lat_deg) <= 90.0 and abs(lon_deg) <= 180.0):
            what = f"[{lat_deg:g}, {lon_deg:g}] is nowhere"
            return Fault(key, what, "latitude first, in degrees")
    return None


def room_fault(zone: ZoneSpec, margin_h_m: float, margin_v_m: float) -> Fault | None:
    """Where the margins leave no place inside an inclusion zone to fly to; None if there is one."""
    if not zone.inclusion:
        return None
    nothing = f"the margin of {margin_h_m:g} m leaves nothing of this zone"
    match zone:
        case CircleSpec(radius_m) if radius_m <= margin_h_m:
            return Fault("radius_m", nothing, ROOM_HINT)
        case BoxSpec(east_m, north_m):
            for key, (low, high) in (("east_m", east_m), ("north_m", north_m)):
                if high - low <= 2.0 * margin_h_m:
                    return Fault(key, nothing, ROOM_HINT)
        case PolygonSpec() if not has_room(Polygon(plane_corners(zone)), margin_h_m):
            return Fault("corners", nothing, ROOM_HINT)
        case _:
            pass
    floor_up_m, ceiling_up_m = zone.floor_up_m, zone.ceiling_up_m
    if floor_up_m is None or ceiling_up_m is None or ceiling_up_m - floor_up_m > 2.0 * margin_v_m:
        return None
    what = f"the margin of {margin_v_m:g} m leaves nothing below this ceiling"
    return Fault("ceiling_up_m", what, "a higher ceiling, or a smaller margin_v_m")


def home_fault(zone: ZoneSpec) -> Fault | None:
    """Where home, from which the zone counts, is not where the vehicle may be; None if it is.

    A floor is no fault, as the vehicle climbs through it, and an exclusion zone is not looked at:
    `check_start` tells of one that the vehicle stands in.
    """
    if zone.frame != "home" or not zone.inclusion:
        return None
    if zone.ceiling_up_m is not None and zone.ceiling_up_m < 0.0:
        return Fault("ceiling_up_m", "home is above this ceiling", HOME_HINT)
    match zone:
        case CircleSpec(radius_m, centre):
            outside = {"centre": Circle(centre, radius_m).clearance(HOME_EN) < 0.0}
        case BoxSpec(east_m, north_m):
            outside = {
                "east_m": not east_m[0] <= 0.0 <= east_m[1],
                "north_m": not north_m[0] <= 0.0 <= north_m[1],
            }
        case PolygonSpec():
            outside = {"corners": Polygon(plane_corners(zone)).clearance(HOME_EN) < 0.0}
    key = next((key for key, is_outside in outside.items() if is_outside), None)
    return None if key is None else Fault(key, "home is outside this zone", HOME_HINT)


# ------------------------------------------------------------------- is there room for a margin?

_LOOKED_AT: Final = 400_000
"""So many edges are looked at before the search is given up: some tenths of a second."""

_FINEST: Final = 0.01
"""A square that is smaller than this share of the distance is not cut any further."""


def has_room(polygon: Polygon, distance_m: float) -> bool:
    """False: no place inside is farther than `distance_m` from the boundary, but by a hundredth.

    True where there is one, and where the search is given up.  Then every goal is refused for
    itself.

    The box of the polygon is cut into squares.  A square whose centre has so little clearance that
    no point of it can have enough is dropped; every other is cut into four, the most promising
    first (V. Agafonkin's polylabel, 2016, which ends here at the first place that is found).
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
    left = _LOOKED_AT // len(polygon.edges)
    while open_cells:
        best_m, half_m, (east, north) = heappop(open_cells)
        if -best_m <= distance_m + TOLERANCE_M:
            return False
        half_m *= 0.5
        if half_m < _FINEST * distance_m:
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
