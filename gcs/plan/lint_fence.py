"""Mistakes in the shape of a fence."""

from __future__ import annotations

import math
from collections.abc import Iterator
from itertools import pairwise

from gcs.gate.geometry import polygon_fault
from gcs.plan.errors import Finding, Level
from gcs.plan.model import Circle, Geodetic, LatLon, Plan, Polygon, Zone

_RADIUS_M = 6_371_000.0
_FAR_M = 20_000.0
_POLE = "it goes round a pole, where no vehicle's own map holds"


def lint_fence(plan: Plan, home: Geodetic | None) -> Iterator[Finding]:
    """Bad polygons (too few corners, crossing edges), ceilings below floors, zones far from
    home."""
    for number, zone in enumerate(plan.fence.zones, start=1):
        for level, what in _zone_faults(zone, home):
            yield Finding(level, zone.where, f"fence zone {number}", what)


def _zone_faults(zone: Zone, home: Geodetic | None) -> Iterator[tuple[Level, str]]:
    if isinstance(zone.shape, Polygon):
        if not zone.shape.corners:
            yield Level.ERROR, "a polygon needs at least 3 corners, this one has 0"
            return
        fault = _POLE if _round_a_pole(zone.shape) else polygon_fault(_plane(zone.shape))
        if fault is not None:
            yield Level.ERROR, fault
    floor_m, ceiling_m = zone.floor_above_home_m, zone.ceiling_above_home_m
    if floor_m is not None and ceiling_m is not None and floor_m >= ceiling_m:
        yield Level.ERROR, f"its ceiling of {ceiling_m:g} m is not above its floor of {floor_m:g} m"
    if isinstance(zone.shape, Circle) and zone.shape.radius_m <= 0.0:
        yield Level.ERROR, f"its radius is {zone.shape.radius_m:g} m"
    first = zone.shape.centre if isinstance(zone.shape, Circle) else zone.shape.corners[0]
    if home is not None and isinstance(first, LatLon):
        far_m = distance_m(first, (home.lat_deg, home.lon_deg))
        if far_m > _FAR_M:
            yield Level.WARNING, f"is {far_m / 1000:.0f} km from home"


def _round_a_pole(polygon: Polygon) -> bool:
    """Its longitudes go once round the Earth, so that on no plane it is what it is."""
    lons_deg = [corner[1] for corner in polygon.corners if isinstance(corner, LatLon)]
    turns = (math.remainder(b - a, 360.0) for a, b in pairwise([*lons_deg, *lons_deg[:1]]))
    return abs(sum(turns)) > 180.0


def _plane(polygon: Polygon) -> tuple[tuple[float, float], ...]:
    """Corners as (east, north) metres, geographic ones about the first."""
    first = polygon.corners[0]
    if not isinstance(first, LatLon):
        return tuple((corner[0], corner[1]) for corner in polygon.corners)
    places = (north_east_m(first, (corner[0], corner[1])) for corner in polygon.corners)
    return tuple((east_m, north_m) for north_m, east_m in places)


# ----------------- rough distances on the globe, to find absurd values; never to decide a flight


def north_east_m(origin: tuple[float, float], point: tuple[float, float]) -> tuple[float, float]:
    """Metres north and east of `origin`, both (lat_deg, lon_deg); equirectangular."""
    mean_rad = math.radians(0.5 * (origin[0] + point[0]))
    north_m = _RADIUS_M * math.radians(point[0] - origin[0])
    east_rad = math.radians(math.remainder(point[1] - origin[1], 360.0))
    return (north_m, _RADIUS_M * east_rad * math.cos(mean_rad))


def distance_m(a: tuple[float, float], b: tuple[float, float]) -> float:
    """Great-circle distance between (lat_deg, lon_deg) points, by the haversine formula."""
    lat_a, lat_b = math.radians(a[0]), math.radians(b[0])
    dlat, dlon = lat_b - lat_a, math.radians(b[1] - a[1])
    h = math.sin(dlat / 2) ** 2 + math.cos(lat_a) * math.cos(lat_b) * math.sin(dlon / 2) ** 2
    return 2.0 * _RADIUS_M * math.asin(min(1.0, math.sqrt(h)))
