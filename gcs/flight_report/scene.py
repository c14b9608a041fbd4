"""The flight in three dimensions, for the script that draws it: metres east, north, up."""

from __future__ import annotations

from collections.abc import Sequence

import msgspec

from gcs.flight_report.flight import Flight, VehicleFlight
from gcs.flight_report.page.fence_svg import zone_outline
from gcs.flight_report.page.path_svg import FENCE_REACH
from gcs.flight_report.projection import box_of
from gcs.flight_report.summary import main_trouble
from gcs.flight_report.track import Track, TrackPoint
from gcs.frames import Vec3

_LEAST_M = 6.0


class SceneTrack(msgspec.Struct):
    """Pieces of a path; each place is east, north, up and the time as a share of the flight."""

    name: str
    pieces: list[list[tuple[float, ...]]]
    plan: list[tuple[float, ...]]
    trouble: tuple[float, ...] | None = None
    colour: str = ""
    """A name of the style sheet's; without it the colour tells the time."""


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
    flown = [v for v in vehicles if v.totals.take_offs]
    scene = scene_of_tracks([(f"vehicle {v.sysid}", v.track, v.plan) for v in flown])
    if scene is None:
        return None
    for zone in flight.fence.zones:
        outline = zone_outline(zone)
        box = box_of((corner[0], corner[1]) for corner in outline)
        if box is not None and max(box.width, box.height) <= 2 * FENCE_REACH * scene.radius:
            corners = [_rounded(corner) for corner in outline]
            zone_ = SceneZone(zone.inclusion, corners, zone.floor_up_m, zone.ceiling_up_m)
            scene.zones.append(zone_)
    drawn = (v for v in flown if v.track.points)
    for track, vehicle in zip(scene.tracks, drawn, strict=True):
        trouble = main_trouble(vehicle)
        if trouble is not None:
            track.trouble = _rounded(_at(vehicle.track.points, trouble.t_s))
    return scene


def scene_of_tracks(tracks: Sequence[tuple[str, Track, Sequence[Vec3]]]) -> Scene | None:
    """Names, paths and plans; None where no path has a place."""
    known = [each for each in tracks if each[1].points]
    places = [point.enu for _, track, _ in known for point in track.points]
    if not places:
        return None
    low, high = (tuple(f(p[i] for p in places) for i in range(3)) for f in (min, max))
    radius_m = max(_LEAST_M, *(b - a for a, b in zip(low, high, strict=True))) / 2
    centre = tuple((a + b) / 2 for a, b in zip(low, high, strict=True))
    return Scene([_track(*each) for each in known], [], _rounded(centre), round(radius_m, 2))


def _track(name: str, track: Track, plan: Sequence[Vec3]) -> SceneTrack:
    first_s, last_s = track.points[0].t_s, track.points[-1].t_s
    length_s = max(last_s - first_s, 1e-3)
    pieces = [
        [(*_rounded(p.enu), round((p.t_s - first_s) / length_s, 3)) for p in piece]
        for piece in track.drawn()
    ]
    return SceneTrack(name, pieces, [_rounded(enu) for enu in plan])


def _at(points: Sequence[TrackPoint], t_s: float) -> Vec3:
    return min(points, key=lambda point: abs(point.t_s - t_s)).enu


def _rounded(place: Sequence[float]) -> tuple[float, ...]:
    return tuple(round(value, 2) for value in place)
