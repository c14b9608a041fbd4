"""Rough distances on the globe, to find absurd values; never to decide about a flight."""

from __future__ import annotations

import math

_RADIUS_M = 6_371_000.0


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
