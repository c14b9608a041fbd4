"""How far out and up a policy's fence reaches, as a cylinder about home."""

from __future__ import annotations

import math
from dataclasses import dataclass

from gcs.gate.policy.policy import Policy
from gcs.gate.policy.zonespec import BoxSpec, CircleSpec, PolygonSpec, ZoneSpec


@dataclass(frozen=True, slots=True)
class Cylinder:
    """Metres from home, and metres above it."""

    reach_m: float
    ceiling_up_m: float


def cylinder_of(policy: Policy) -> Cylinder:
    """Zones that stand about home, whose size is known before the vehicle has told where it is."""
    inside = [zone for zone in policy.fence if zone.inclusion and zone.frame == "home"]
    ceilings = [zone.ceiling_up_m for zone in inside if zone.ceiling_up_m is not None]
    return Cylinder(
        min([policy.max_distance_m, *map(_reach_m, inside)]), min([policy.max_up_m, *ceilings])
    )


def _reach_m(zone: ZoneSpec) -> float:
    match zone:
        case CircleSpec(radius_m=radius_m, centre=(east_m, north_m)):
            return math.hypot(east_m, north_m) + radius_m
        case BoxSpec(east_m=east_m, north_m=north_m):
            return math.hypot(max(map(abs, east_m)), max(map(abs, north_m)))
        case PolygonSpec(corners=corners):
            return max(math.hypot(*corner) for corner in corners)
