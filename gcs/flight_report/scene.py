"""The flight in three dimensions, for the script that draws it: metres east, north, up."""

from __future__ import annotations

from collections.abc import Sequence
from math import inf

import msgspec

from gcs.flight_report.fence_svg import zone_outline
from gcs.flight_report.flight import Flight, VehicleFlight
from gcs.flight_report.path_svg import FENCE_REACH
from gcs.flight_report.projection import box_of
from gcs.flight_report.summary import main_trouble
from gcs.flight_report.track import TrackPoint
from gcs.frames import Vec3

_LEAST_M = 6.0


class SceneTrack(msgspec.Struct):
    """Pieces of a path; each place is east, north, up and the time as a share of the flight."""

    name: str
    pieces: list[list[tuple[float, ...]]]
    plan: list[tuple[float, ...]]
    trouble: tuple[float, ...] | None = None


class SceneZone(msgspec.Struct):
    inclusion: bool
    corners: list[tuple[float, ...]]
    floor: float | None
    ceiling: float | None


class Scene(msgspec.Struct):
    tracks: list[SceneTrack]
    zones: list[SceneZone]
    centre: tuple[float, ...]
    """Of what was flown."""
    radius: float


def scene_of(flight: Flight, vehicles: Sequence[VehicleFlight]) -> Scene | None:
    """None where nothing flew that has a position."""
    flown = [v for v in vehicles if v.track.points and v.totals.take_offs]
    places = [point.enu for v in flown for point in v.track.points]
    if not places:
        return None
    low, high = (tuple(f(p[i] for p in places) for i in range(3)) for f in (min, max))
    radius_m = max(_LEAST_M, *(b - a for a, b in zip(low, high, strict=True))) / 2
    zones = []
    for zone in flight.fence.zones:
        outline = zone_outline(zone)
        box = box_of((corner[0], corner[1]) for corner in outline)
        if box is not None and max(box.width, box.height) <= 2 * FENCE_REACH * radius_m:
            corners = [_rounded(corner) for corner in outline]
            zones.append(SceneZone(zone.inclusion, corners, zone.floor_up_m, zone.ceiling_up_m))
    first_s = min((v.track.points[0].t_s for v in flown), default=inf)
    last_s = max(v.track.points[-1].t_s for v in flown)
    centre = tuple((a + b) / 2 for a, b in zip(low, high, strict=True))
    return Scene(
        [_track(v, first_s, max(last_s - first_s, 1e-3)) for v in flown],
        zones,
        _rounded(centre),
        round(radius_m, 2),
    )


def _track(vehicle: VehicleFlight, first_s: float, length_s: float) -> SceneTrack:
    pieces = [
        [(*_rounded(p.enu), round((p.t_s - first_s) / length_s, 3)) for p in piece]
        for piece in vehicle.track.drawn()
    ]
    trouble = main_trouble(vehicle)
    return SceneTrack(
        f"vehicle {vehicle.sysid}",
        pieces,
        [_rounded(enu) for enu in vehicle.plan],
        None if trouble is None else _rounded(_at(vehicle.track.points, trouble.t_s)),
    )


def _at(points: Sequence[TrackPoint], t_s: float) -> Vec3:
    return min(points, key=lambda point: abs(point.t_s - t_s)).enu


def _rounded(place: Sequence[float]) -> tuple[float, ...]:
    return tuple(round(value, 2) for value in place)
