"""The policy's fence as a vehicle can keep it by itself, and what of it no autopilot keeps.

A circle about home to stay in, and a ceiling, are the vehicle's parameters; every other zone is
uploaded, placed on Earth about the home that the vehicle has now.  It stands where the policy's
stands: the margin that a stop needs is inside of it, in what the gate permits.  A vehicle is sent
only where it still stops inside, within the policy's margin, by the stopping law of its kind
(`gcs/gate/airspace/stopping.py`), from the last setpoint on; so its own reaction to silence must be
no later than the policy counts on, which is `[stream] deadman_s`.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final

from gcs.gate.airspace.projection import Projection
from gcs.gate.airspace.zones import Zone as PlacedZone
from gcs.gate.airspace.zones import build_zones
from gcs.gate.condition import Condition, Severity
from gcs.gate.geometry import Circle as PlacedCircle
from gcs.gate.geometry import Point
from gcs.gate.geometry import Polygon as PlacedPolygon
from gcs.gate.policy.policy import Policy
from gcs.gate.refusal import Code, Refusal
from gcs.plan.kept_on_board import as_zones, not_kept
from gcs.plan.model import Circle, Fence, LatLon, Polygon, Zone
from gcs.protocol.fence_parameters import Breach, KeptFence
from gcs.vehicle.talk.telemetry import Telemetry

BREACHES: Final[dict[Severity, Breach]] = {
    Severity.RETURN: "return",
    Severity.LAND: "land",
    Severity.TERMINATE: "terminate",
}
"""By the severity of `fence_breached`; what is less holds, as the gate's own brake does."""


@dataclass(frozen=True, slots=True)
class VehicleFence:
    """`zones` to be uploaded, `kept` for the parameters, `not_kept` a sentence each."""

    zones: Fence
    kept: KeptFence
    not_kept: tuple[str, ...]


def vehicle_fence(policy: Policy, telemetry: Telemetry) -> VehicleFence | Refusal:
    """Refused where it is not known yet where the vehicle's origin and home are."""
    origin, home_ned, autopilot = telemetry.origin, telemetry.home_ned, telemetry.autopilot.name
    if origin is None or home_ned is None:
        return Refusal(Code.NO_ORIGIN, "the vehicle's origin and home are not known yet")
    projection = Projection(origin, autopilot)
    placed = build_zones(policy.fence, home_ned, projection)
    if isinstance(placed, Refusal):
        return placed
    uploaded = as_zones(policy)
    zones = tuple(
        _on_earth(zone, projection)
        for spec, zone in zip(policy.fence, placed, strict=True)
        if spec in uploaded
    )
    inside = [zone for zone in placed if zone.inclusion]
    home_en, home_up_m = (home_ned[1], home_ned[0]), -home_ned[2]
    breach = BREACHES.get(policy.severities[Condition.FENCE_BREACHED], "hold")
    kept = KeptFence(
        min([policy.max_distance_m, *(_reach_m(zone, home_en) for zone in inside)]),
        min([policy.max_up_m, *(zone.ceiling_up_m - home_up_m for zone in inside)]),
        bool(zones),
        breach,
        policy.stream.deadman_s,
    )
    return VehicleFence(Fence(zones), kept, tuple(not_kept(policy, autopilot)))


def _on_earth(zone: PlacedZone, projection: Projection) -> Zone:
    def place(point: Point) -> LatLon:
        return LatLon(*projection.lat_lon(point[1], point[0]))

    match zone.shape:
        case PlacedCircle(centre_en, radius_m):
            return Zone(Circle(place(centre_en), radius_m), zone.inclusion, name=zone.name)
        case PlacedPolygon(corners_en):
            corners = tuple(map(place, corners_en))
            return Zone(Polygon(corners), zone.inclusion, name=zone.name)


def _reach_m(zone: PlacedZone, home_en: Point) -> float:
    """The farthest from home that it lets the vehicle be."""
    match zone.shape:
        case PlacedCircle(centre_en, radius_m):
            return math.dist(centre_en, home_en) + radius_m
        case PlacedPolygon(corners_en):
            return max(math.dist(corner, home_en) for corner in corners_en)
