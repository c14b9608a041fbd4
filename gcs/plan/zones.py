"""The fence of a plan as the gate wants it: zone specifications in home metres or degrees."""

from __future__ import annotations

from gcs.gate.policy.zonespec import CircleSpec, Frame, PolygonSpec, ZoneSpec
from gcs.plan.model import Circle, EastNorth, Fence, LatLon, Zone


def zone_specs(fence: Fence) -> tuple[ZoneSpec, ...]:
    """One `ZoneSpec` for each zone, in order; heights stay above home."""
    return tuple(_spec(number, zone) for number, zone in enumerate(fence.zones, start=1))


def _spec(number: int, zone: Zone) -> ZoneSpec:
    shape = zone.shape
    name, inclusion = zone.name or f"zone {number}", zone.inclusion
    floor_m, ceiling_m = zone.floor_above_home_m, zone.ceiling_above_home_m
    if isinstance(shape, Circle):
        return CircleSpec(
            shape.radius_m,
            _pair(shape.centre),
            name=name,
            inclusion=inclusion,
            frame=_frame(shape.centre),
            floor_up_m=floor_m,
            ceiling_up_m=ceiling_m,
        )
    return PolygonSpec(
        tuple(_pair(corner) for corner in shape.corners),
        name=name,
        inclusion=inclusion,
        frame=_frame(shape.corners[0]),
        floor_up_m=floor_m,
        ceiling_up_m=ceiling_m,
    )


def _frame(point: LatLon | EastNorth) -> Frame:
    return "geographic" if isinstance(point, LatLon) else "home"


def _pair(point: LatLon | EastNorth) -> tuple[float, float]:
    return (point[0], point[1])
