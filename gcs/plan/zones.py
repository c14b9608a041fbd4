"""The fence of a plan as the gate wants it: zone specifications in home metres or degrees."""

from __future__ import annotations

from gcs.gate.policy.zonespec import CircleSpec, Frame, PolygonSpec, ZoneSpec
from gcs.plan.model import Circle, EastNorth, Fence, LatLon, Zone


def zone_specs(fence: Fence) -> tuple[ZoneSpec, ...]:
    """One `ZoneSpec` for each zone, in order; heights stay above home."""
    return tuple(_spec(number, zone) for number, zone in enumerate(fence.zones, start=1))


def _spec(number: int, zone: Zone) -> ZoneSpec:
    shape: CircleSpec | PolygonSpec
    if isinstance(zone.shape, Circle):
        first = zone.shape.centre
        shape = CircleSpec(zone.shape.radius_m, _pair(first))
    else:
        first = zone.shape.corners[0]
        shape = PolygonSpec(tuple(_pair(corner) for corner in zone.shape.corners))
    frame: Frame = "geographic" if isinstance(first, LatLon) else "home"
    return ZoneSpec(
        zone.name or f"zone {number}",
        shape,
        zone.inclusion,
        frame,
        zone.floor_above_home_m,
        zone.ceiling_above_home_m,
    )


def _pair(point: LatLon | EastNorth) -> tuple[float, float]:
    return (point[0], point[1])
