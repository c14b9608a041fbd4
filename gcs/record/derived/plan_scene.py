"""The fence and the mission in 3D and on the map: /geofence, /geofence/geojson, /mission."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from math import cos, degrees, radians
from typing import ClassVar

from foxglove.messages import GeoJson, SceneEntity, SceneUpdate, Timestamp, TriangleListPrimitive

from gcs.frames import enu_from_ned
from gcs.record.derived.body_frames import FrameNames
from gcs.record.derived.drawing import (
    EARTH_RADIUS_M,
    ball,
    channel,
    clear,
    color,
    entity,
    label,
    line,
    stamp,
    surface,
)
from gcs.record.derived.outline import Outline, corners, margin_outline, triangles
from gcs.record.topics import Deriver, Out
from gcs.report import FenceItem, FenceShape, MissionItem, RecordItem

OPEN_HEIGHT_M = 40.0
"""How far a zone without a ceiling is drawn above its floor, where no other zone is higher."""

_ROUTE = (1.0, 0.8, 0.2)
_INCLUSION = (0.2, 0.75, 0.4)
_EXCLUSION = (0.95, 0.25, 0.2)
_PALER = 0.55
"""The margin is the zone's colour, so much of the way to white."""


class PlanScene(Deriver):
    """Each anew whenever it changes; the missions of all vehicles in one message, as a viewer that
    seeks shows the last one."""

    takes: ClassVar = frozenset({FenceItem, MissionItem})

    def __init__(self, names: FrameNames) -> None:
        self._names = names
        self._missions: dict[int, MissionItem] = {}
        self._mission = channel("/mission", SceneUpdate.get_schema())
        self._fence = channel("/geofence", SceneUpdate.get_schema())
        self._fence_map = channel("/geofence/geojson", GeoJson.get_schema())

    def handle(self, item: RecordItem, now_ns: int) -> list[Out]:
        match item:
            case FenceItem():
                walls = fence(item, stamp(now_ns))
                on_map = fence_geojson(item)
                outs = [Out(self._fence, walls.encode(), latch="fence")]
                return outs + [Out(self._fence_map, m.encode(), "fence") for m in [on_map] if m]
            case MissionItem():
                self._missions[item.sysid] = item
                frames = {sysid: self._names.of(sysid).enu for sysid in self._missions}
                drawn = missions(self._missions, frames, stamp(now_ns))
                return [Out(self._mission, drawn.encode(), "mission")]
            case _:
                return []


def fence(item: FenceItem, at: Timestamp) -> SceneUpdate:
    """Every zone as a volume: green keeps the vehicle in, red keeps it out; the margin is paler.

    The margin's boundary is what the gate holds goals and legs to.
    """
    low_m, high_m = _drawn_heights(item.zones)
    entities = [
        _zone(zone, (item.margin_h_m, item.margin_v_m), (low_m, high_m), at) for zone in item.zones
    ]
    return SceneUpdate(deletions=clear(at), entities=entities)


def missions(
    of_vehicles: Mapping[int, MissionItem], frames: Mapping[int, str], at: Timestamp
) -> SceneUpdate:
    """Each path as a line, every point as a numbered ball; of several vehicles with theirs before
    it, `2: 1`."""
    paths = {sysid: item for sysid, item in of_vehicles.items() if item.path_ned}
    entities = [
        _mission(item, frames[sysid], f"{sysid}: " if len(paths) > 1 else "", at)
        for sysid, item in paths.items()
    ]
    return SceneUpdate(deletions=clear(at), entities=entities)


def _mission(item: MissionItem, frame_id: str, prefix: str, at: Timestamp) -> SceneEntity:
    points = [enu_from_ned(pos_ned) for pos_ned in item.path_ned]
    route = color(_ROUTE)
    return entity(
        f"mission {item.sysid}",
        at,
        frame_id=frame_id,
        lines=[line(points, route)],
        spheres=[ball(point, 0.4, route) for point in points],
        texts=[
            label((east, north, up + 0.8), f"{prefix}{number}")
            for number, (east, north, up) in enumerate(points, start=1)
        ],
    )


def fence_geojson(item: FenceItem) -> GeoJson | None:
    """The fence for the map panel; None while the origin is not known."""
    if item.origin is None:
        return None
    features = [
        {
            "type": "Feature",
            "properties": {
                "name": zone.name,
                "style": {
                    "color": _hex(_INCLUSION if zone.inclusion else _EXCLUSION),
                    "fillOpacity": 0.05 if zone.inclusion else 0.3,
                    "weight": 2,
                },
            },
            "geometry": {
                "type": "Polygon",
                "coordinates": [[_lon_lat(item.origin, at) for at in _ring(corners(zone))]],
            },
        }
        for zone in item.zones
        if corners(zone)
    ]
    return GeoJson(geojson=json.dumps({"type": "FeatureCollection", "features": features}))


def _drawn_heights(zones: Sequence[FenceShape]) -> tuple[float, float]:
    """Where zones without a floor or a ceiling are drawn to end; viewers take no infinity."""
    floors = [zone.floor_up_m for zone in zones if zone.floor_up_m is not None]
    ceilings = [zone.ceiling_up_m for zone in zones if zone.ceiling_up_m is not None]
    low_m = min([0.0, *floors])
    return low_m, max(ceilings, default=max([low_m, *floors]) + OPEN_HEIGHT_M)


def _zone(
    zone: FenceShape, margins: tuple[float, float], drawn: tuple[float, float], at: Timestamp
) -> SceneEntity:
    rgb = _INCLUSION if zone.inclusion else _EXCLUSION
    outline = corners(zone)
    floor = drawn[0] if zone.floor_up_m is None else zone.floor_up_m
    ceiling = max(floor, drawn[1]) if zone.ceiling_up_m is None else zone.ceiling_up_m
    if len(outline) < 3:
        return entity(f"zone {zone.name}", at)
    low, high = ([(east, north, up) for east, north in outline] for up in (floor, ceiling))
    shown = [_walls(outline, floor, ceiling, rgb, 0.10 if zone.inclusion else 0.28)]
    if not zone.inclusion:
        shown += [surface(ring, triangles(outline), color(rgb, 0.28)) for ring in (low, high)]
    lines = [line(ring, color(rgb, 0.9), closed=True) for ring in (low, high)]
    lines.append(
        line([p for pair in zip(low, high, strict=True) for p in pair], color(rgb, 0.3), pairs=True)
    )
    near = margin_outline(zone, margins[0]) if any(margins) else ()
    into_m = margins[1] if zone.inclusion else -margins[1]
    bottom = floor if zone.floor_up_m is None else floor + into_m
    top = ceiling if zone.ceiling_up_m is None else ceiling - into_m
    red, green, blue = (part + (1.0 - part) * _PALER for part in rgb)
    pale = (red, green, blue)
    if near and bottom < top:
        rings = [[(east, north, up) for east, north in near] for up in (bottom, top)]
        lines += [line(ring, color(pale, 0.7), closed=True, pixels=1.0) for ring in rings]
        shown.append(_walls(near, bottom, top, pale, 0.05))
    texts = [label((*outline[0], ceiling + 1.0), zone.name)]
    return entity(f"zone {zone.name}", at, triangles=shown, lines=lines, texts=texts)


def _walls(
    outline: Outline, floor: float, ceiling: float, rgb: tuple[float, float, float], alpha: float
) -> TriangleListPrimitive:
    count = len(outline)
    points = [(east, north, up) for up in (floor, ceiling) for east, north in outline]
    sides = [(i, (i + 1) % count) for i in range(count)]
    both = [((i, j, count + j), (i, count + j, count + i)) for i, j in sides]
    return surface(points, [triangle for pair in both for triangle in pair], color(rgb, alpha))


def _hex(rgb: tuple[float, float, float]) -> str:
    return "#" + "".join(f"{round(255 * part):02x}" for part in rgb)


def _ring(outline: Outline) -> Outline:
    """GeoJSON (RFC 7946, 3.1.6): a ring ends where it began."""
    return [*outline, outline[0]]


def _lon_lat(origin: tuple[float, float, float], at_en: tuple[float, float]) -> list[float]:
    """Equirectangular about the origin, within 0.2 m at 1 km."""
    lat_deg, lon_deg, _ = origin
    east, north = at_en
    return [
        lon_deg + degrees(east / (EARTH_RADIUS_M * cos(radians(lat_deg)))),
        lat_deg + degrees(north / EARTH_RADIUS_M),
    ]
