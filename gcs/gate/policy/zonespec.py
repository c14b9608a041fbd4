"""Zones of the fence as people write them, and the reading of one from a policy file."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, TypeAlias

from gcs.gate.geometry import Point, polygon_fault
from gcs.gate.policy.tomlfile import Table

Frame: TypeAlias = Literal["home", "local", "geographic"]
"""What a zone's numbers count from.

home: metres east, north and up of home.  local: of the local origin.  geographic: degrees of
latitude and longitude, heights above home; known only once the vehicle's origin is.
"""


@dataclass(frozen=True, slots=True)
class CircleSpec:
    """`centre` is (east, north) metres, or (latitude, longitude) degrees if geographic."""

    radius_m: float
    centre: Point = (0.0, 0.0)


@dataclass(frozen=True, slots=True)
class BoxSpec:
    """Sides parallel to east and north, each as (from, to) in metres."""

    east_m: tuple[float, float]
    north_m: tuple[float, float]


@dataclass(frozen=True, slots=True)
class PolygonSpec:
    """Corners in order, either way round, as (east, north) or (latitude, longitude)."""

    corners: tuple[Point, ...]


@dataclass(frozen=True, slots=True)
class FileSpec:
    """The fence of a plan file; the shell reads it and hands its zones over as plain numbers."""

    path: str


ShapeSpec: TypeAlias = CircleSpec | BoxSpec | PolygonSpec | FileSpec


@dataclass(frozen=True, slots=True)
class ZoneSpec:
    """One zone as written.  A bound of None is none: the zone is open on that side."""

    name: str
    shape: ShapeSpec
    inclusion: bool = True
    frame: Frame = "home"
    floor_up_m: float | None = None
    ceiling_up_m: float | None = None


_KINDS: tuple[Literal["circle", "box", "polygon", "file"], ...] = (
    "circle",
    "box",
    "polygon",
    "file",
)
_FRAMES: tuple[Frame, ...] = ("home", "local", "geographic")


def read_zone(table: Table, margin_h_m: float, margin_v_m: float) -> ZoneSpec:
    """One [[fence]] table.  Raises PolicyError, also where the margins leave nothing of an
    inclusion zone."""
    kind = table.word("kind", "circle", _KINDS)
    if kind == "file":
        path = table.text("path", None)
        name = table.text("name", path)
        table.done()
        return ZoneSpec(name, FileSpec(path))
    name = table.text("name", None)
    inclusion = table.flag("inclusion", True)
    frame = table.word("frame", "home", _FRAMES)
    floor_up_m = table.number_or_none("floor_up_m", None, least=-1.0e4)
    ceiling_up_m = table.number_or_none("ceiling_up_m", None, least=-1.0e4)
    shape: ShapeSpec
    match kind:
        case "circle":
            shape = _circle(table, frame)
        case "box":
            shape = _box(table, frame)
        case "polygon":
            shape = _polygon(table, frame)
    table.done()
    if floor_up_m is not None and ceiling_up_m is not None and floor_up_m >= ceiling_up_m:
        table.fail("ceiling_up_m", f"{ceiling_up_m:g} is not above the floor of {floor_up_m:g}")
    zone = ZoneSpec(name, shape, inclusion, frame, floor_up_m, ceiling_up_m)
    if inclusion and (fault := room_fault(zone, margin_h_m, margin_v_m)):
        table.fail(*fault)
    return zone


def _circle(table: Table, frame: Frame) -> CircleSpec:
    radius_m = table.number("radius_m", 0.0, least=0.01)
    if radius_m == 0.0:
        table.missing("radius_m")
    centre = table.pair("centre", None if frame == "geographic" else (0.0, 0.0))
    _check_degrees(table, "centre", frame, (centre,))
    return CircleSpec(radius_m, centre)


def _box(table: Table, frame: Frame) -> BoxSpec:
    if frame == "geographic":
        table.fail("frame", "a box is in metres", "write a polygon")
    east_m, north_m = table.pair("east_m", None), table.pair("north_m", None)
    for key, (low, high) in (("east_m", east_m), ("north_m", north_m)):
        if low >= high:
            table.fail(key, f"[{low:g}, {high:g}] is empty", "write the smaller number first")
    return BoxSpec(east_m, north_m)


def _polygon(table: Table, frame: Frame) -> PolygonSpec:
    corners = table.pairs("corners")
    _check_degrees(table, "corners", frame, corners)
    if frame != "geographic":
        fault = polygon_fault(corners)
        if fault is not None:
            table.fail("corners", fault)
    elif len(set(corners)) < 3:
        table.fail("corners", "a polygon needs at least 3 corners")
    return PolygonSpec(corners)


def _check_degrees(table: Table, key: str, frame: Frame, points: tuple[Point, ...]) -> None:
    if frame == "geographic":
        for lat_deg, lon_deg in points:
            if not (abs(lat_deg) <= 90.0 and abs(lon_deg) <= 180.0):
                table.fail(
                    key, f"[{lat_deg:g}, {lon_deg:g}] is nowhere", "latitude first, in degrees"
                )


def room_fault(zone: ZoneSpec, margin_h_m: float, margin_v_m: float) -> tuple[str, str] | None:
    """(key, what) where the margins leave no place inside an inclusion zone to fly to."""
    nothing = f"the margin of {margin_h_m:g} m leaves nothing of this zone"
    match zone.shape:
        case CircleSpec(radius_m, _) if radius_m <= margin_h_m:
            return "radius_m", nothing
        case BoxSpec(east_m, north_m):
            for key, (low, high) in (("east_m", east_m), ("north_m", north_m)):
                if high - low <= 2.0 * margin_h_m:
                    return key, nothing
        case _:
            pass
    floor_up_m, ceiling_up_m = zone.floor_up_m, zone.ceiling_up_m
    if floor_up_m is None or ceiling_up_m is None or ceiling_up_m - floor_up_m > 2.0 * margin_v_m:
        return None
    return (
        "ceiling_up_m",
        f"the margin of {margin_v_m:g} m leaves nothing below this ceiling",
    )
