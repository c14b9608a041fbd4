"""The fence as the verifier stands on it, told to the screen and to the record."""

from __future__ import annotations

import math
from collections.abc import Iterable

from gcs import ipc
from gcs.gate.airspace.projection import Origin
from gcs.gate.airspace.zones import Zone
from gcs.gate.geometry import Circle
from gcs.record.items import FenceItem, ZoneItem

NO_BOUND_M = 1e4
"""Stands for a missing floor or ceiling in a drawing; viewers take no infinity."""


def fence_item(zones: Iterable[Zone], origin: Origin | None) -> FenceItem:
    """For the record: each zone in the local tangent plane, heights up of the local origin."""
    where = None if origin is None else (origin.lat_deg, origin.lon_deg, origin.alt_amsl_m)
    return FenceItem(tuple(_zone_item(zone) for zone in zones), where)


def fences_event(zones: Iterable[Zone]) -> ipc.Fences:
    """For the screen."""
    return ipc.Fences([_shape(zone) for zone in zones])


def _zone_item(zone: Zone) -> ZoneItem:
    corners_en, centre_en, radius_m = _outline(zone)
    return ZoneItem(
        zone.name,
        zone.inclusion,
        corners_en,
        centre_en,
        radius_m,
        max(zone.floor_up_m, -NO_BOUND_M),
        min(zone.ceiling_up_m, NO_BOUND_M),
    )


def _shape(zone: Zone) -> ipc.FenceShape:
    corners_en, centre_en, radius_m = _outline(zone)
    return ipc.FenceShape(
        zone.name,
        zone.inclusion,
        list(corners_en),
        centre_en,
        radius_m,
        zone.floor_up_m if math.isfinite(zone.floor_up_m) else None,
        zone.ceiling_up_m if math.isfinite(zone.ceiling_up_m) else None,
    )


def _outline(
    zone: Zone,
) -> tuple[tuple[tuple[float, float], ...], tuple[float, float] | None, float]:
    """Corners, centre, radius; a polygon has no centre and a circle no corners."""
    if isinstance(zone.shape, Circle):
        return (), zone.shape.centre_en, zone.shape.radius_m
    return zone.shape.corners_en, None, 0.0
