"""/gate/fence written and read: the zones that the gate stands on, for programs.

Points are objects here: viewers take no arrays of arrays.  Records made before 2026-11-28 have
pairs `corners_en` and `centre_en`, which are read as well.
"""

from __future__ import annotations

import msgspec

from gcs.report import FenceItem, FenceShape

FENCE_TOPIC = "/gate/fence"


class PointEn(msgspec.Struct, frozen=True):
    """A place seen from above: metres east and north of the local origin."""

    east_m: float
    north_m: float


class FenceZone(msgspec.Struct, frozen=True):
    """One zone: a polygon's corners, or a circle; a height that is not there is no bound."""

    name: str
    inclusion: bool
    corners: list[PointEn] = []
    centre: PointEn | None = None
    radius_m: float = 0.0
    floor_up_m: float | None = None
    ceiling_up_m: float | None = None


class Fence(msgspec.Struct, frozen=True):
    """What `gcs.report.FenceItem` says."""

    zones: list[FenceZone]
    origin: tuple[float, float, float] | None
    margin_h_m: float
    margin_v_m: float


class _Zone(FenceZone, frozen=True):
    """A zone of either form."""

    corners_en: list[tuple[float, float]] = []
    centre_en: tuple[float, float] | None = None


class _Fence(msgspec.Struct):
    zones: list[_Zone]
    origin: tuple[float, float, float] | None = None
    margin_h_m: float | None = None
    margin_v_m: float | None = None


_decode = msgspec.json.Decoder(_Fence).decode


def written(item: FenceItem) -> Fence:
    """The message's fields."""
    zones = [
        FenceZone(
            zone.name,
            zone.inclusion,
            [PointEn(*corner) for corner in zone.corners_en],
            None if zone.centre_en is None else PointEn(*zone.centre_en),
            zone.radius_m,
            zone.floor_up_m,
            zone.ceiling_up_m,
        )
        for zone in item.zones
    ]
    return Fence(zones, item.origin, item.margin_h_m, item.margin_v_m)


def read(data: bytes) -> FenceItem:
    """A margin that is not told is 0.  Raises `msgspec.DecodeError` for what is no such message."""
    found = _decode(data)
    zones = [_shape(zone) for zone in found.zones]
    return FenceItem(zones, found.origin, found.margin_h_m or 0.0, found.margin_v_m or 0.0)


def _shape(zone: _Zone) -> FenceShape:
    centre = zone.centre_en
    if zone.centre is not None:
        centre = (zone.centre.east_m, zone.centre.north_m)
    return FenceShape(
        zone.name,
        zone.inclusion,
        [(corner.east_m, corner.north_m) for corner in zone.corners] or zone.corners_en,
        centre,
        zone.radius_m,
        zone.floor_up_m,
        zone.ceiling_up_m,
    )
