"""The zones of the fence in the local frame, and how they are placed there.

A vehicle must be inside every inclusion zone and outside every exclusion zone, as with the
autopilots' own fences.  A zone as it is written (`ZoneSpec`) is relative to home, relative to the
local origin, or geographic.  A zone that is placed (`Zone`) has local east and north coordinates,
and a floor and a ceiling in metres above the local origin.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

from gcs.frames import Vec3, enu_from_ned
from gcs.gate.airspace.projection import Projection
from gcs.gate.geometry import Circle, Point, Polygon, Shape, polygon_fault
from gcs.gate.policy.zonespec import (
    BoxSpec,
    CircleSpec,
    PolygonSpec,
    ZoneSpec,
    geographic_points,
    open_ring,
)
from gcs.gate.refusal import Code, Refusal


@dataclass(frozen=True, slots=True)
class Zone:
    """A prism; a floor of -inf or a ceiling of inf means that it has none."""

    name: str
    inclusion: bool
    shape: Shape
    floor_up_m: float = -math.inf
    ceiling_up_m: float = math.inf

    @property
    def title(self) -> str:
        """Its name in sentences, such as: inclusion circle 'home'."""
        kind = "circle" if isinstance(self.shape, Circle) else "polygon"
        return f"{'inclusion' if self.inclusion else 'exclusion'} {kind} '{self.name}'"


def build_zones(
    specs: Sequence[ZoneSpec], home_ned: Vec3 | None, projection: Projection | None
) -> tuple[Zone, ...] | Refusal:
    """Place all zones in the local frame, or refuse.

    NO_ORIGIN: home or the origin is needed and not known.  POLICY: a geographic polygon is not a
    simple one.
    """
    zones = []
    for spec in specs:
        placed = _place(spec, home_ned, projection)
        if isinstance(placed, Refusal):
            return placed
        zones.append(placed)
    return tuple(zones)


def _place(spec: ZoneSpec, home_ned: Vec3 | None, projection: Projection | None) -> Zone | Refusal:
    bounded = spec.floor_up_m is not None or spec.ceiling_up_m is not None
    if home_ned is None and (spec.frame == "home" or (spec.frame == "geographic" and bounded)):
        return _unplaced(spec, "home is not known yet")
    if projection is None and spec.frame == "geographic":
        return _unplaced(spec, "the vehicle's origin (GPS_GLOBAL_ORIGIN) is not known yet")

    if projection is not None and spec.frame == "geographic":
        points = geographic_points(spec) + (((90.0, 0.0),) if _round_a_pole(spec) else ())
        far = next((p for p in points if not projection.holds_at(p[0])), None)
        if far is not None:
            what = (
                f"fence zone '{spec.name}': the vehicle's own map does not hold at {far[0]:g} deg"
            )
            return Refusal(Code.POLICY, f"{what} of latitude", zone=spec.name)

    home_en, home_up_m = _east_north_up(home_ned or (0.0, 0.0, 0.0))

    def local(p: Point) -> Point:
        if spec.frame == "geographic" and projection is not None:
            north_m, east_m = projection.north_east(*p)
            return (east_m, north_m)
        if spec.frame == "home":
            return (home_en[0] + p[0], home_en[1] + p[1])
        return p

    placed: Shape
    match spec:
        case CircleSpec(radius_m, centre):
            placed = Circle(local(centre), radius_m)
        case BoxSpec((west, east), (south, north)):
            corners = ((west, south), (east, south), (east, north), (west, north))
            placed = Polygon(tuple(local(c) for c in corners))
        case PolygonSpec(corners):
            here = tuple(local(c) for c in open_ring(corners))
            fault = polygon_fault(here)
            if fault is not None:
                return Refusal(Code.POLICY, f"fence zone '{spec.name}': {fault}", zone=spec.name)
            placed = Polygon(here)
    datum_up_m = 0.0 if spec.frame == "local" else home_up_m
    return Zone(
        spec.name,
        spec.inclusion,
        placed,
        -math.inf if spec.floor_up_m is None else datum_up_m + spec.floor_up_m,
        math.inf if spec.ceiling_up_m is None else datum_up_m + spec.ceiling_up_m,
    )


def _round_a_pole(spec: ZoneSpec) -> bool:
    """Its longitudes go once round the Earth, so that a pole is in it."""
    if not isinstance(spec, PolygonSpec):
        return False
    lons_deg = [lon_deg for _, lon_deg in open_ring(spec.corners)]
    turns = (math.remainder(b - a, 360.0) for a, b in pairwise([*lons_deg, lons_deg[0]]))
    return abs(sum(turns)) > 180.0


def _unplaced(spec: ZoneSpec, why: str) -> Refusal:
    return Refusal(
        Code.NO_ORIGIN, f"fence zone '{spec.name}' cannot be placed: {why}", zone=spec.name
    )


def _east_north_up(pos_ned: Vec3) -> tuple[Point, float]:
    east, north, up = enu_from_ned(pos_ned)
    return (east, north), up
