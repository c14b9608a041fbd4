"""Zones of the fence as they are written in a policy or a plan file, not yet placed.

The fields are the keys of a `[[fence]]` table of a policy; `kind` says which of the structs.
"""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import Annotated, Final, Literal, NamedTuple, TypeAlias

from msgspec import Meta, Struct

from gcs.gate.geometry import Point, polygon_fault

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
        case PolygonSpec(corners) if zone.frame == "geographic":
            if len(set(corners)) < 3:
                return Fault("corners", "a polygon needs at least 3 corners")
            return _degrees_fault("corners", zone.frame, corners)
        case PolygonSpec(corners):
            fault = polygon_fault(corners)
            return None if fault is None else Fault("corners", fault)


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
            return Fault("radius_m", nothing)
        case BoxSpec(east_m, north_m):
            for key, (low, high) in (("east_m", east_m), ("north_m", north_m)):
                if high - low <= 2.0 * margin_h_m:
                    return Fault(key, nothing)
        case _:
            pass
    floor_up_m, ceiling_up_m = zone.floor_up_m, zone.ceiling_up_m
    if floor_up_m is None or ceiling_up_m is None or ceiling_up_m - floor_up_m > 2.0 * margin_v_m:
        return None
    what = f"the margin of {margin_v_m:g} m leaves nothing below this ceiling"
    return Fault("ceiling_up_m", what)
