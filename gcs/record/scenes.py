"""What the 3D panel and the map draw: quadrotor, fence and mission, in `map` (ENU, metres)."""

from __future__ import annotations

import json
from collections.abc import Sequence
from math import cos, degrees, pi, radians, sin, sqrt

from foxglove.messages import (
    Color,
    CubePrimitive,
    CylinderPrimitive,
    GeoJson,
    LinePrimitive,
    LinePrimitiveLineType,
    Point3,
    Pose,
    Quaternion,
    SceneEntity,
    SceneEntityDeletion,
    SceneEntityDeletionType,
    SceneUpdate,
    SpherePrimitive,
    TextPrimitive,
    Timestamp,
    TriangleListPrimitive,
    Vector3,
)

from gcs.frames import Vec3, enu_from_ned
from gcs.report import FenceItem, FenceShape, MissionItem

CIRCLE_CORNERS = 72
EARTH_RADIUS_M = 6_371_000.0
NO_BOUND_M = 1e4
"""Where a zone without a floor or a ceiling is drawn to end; viewers take no infinity."""

ARM_M = 0.35
"""Centre to motor: a little larger than life, so that it is seen from a hundred metres."""

NO_TURN = Quaternion(x=0.0, y=0.0, z=0.0, w=1.0)
_DARK = Color(r=0.12, g=0.13, b=0.16, a=1.0)
_FRONT = Color(r=1.0, g=0.45, b=0.1, a=0.9)
_REAR = Color(r=0.85, g=0.87, b=0.9, a=0.9)
_ROUTE = Color(r=1.0, g=0.8, b=0.2, a=1.0)
_INCLUSION = (0.2, 0.75, 0.4)
_EXCLUSION = (0.95, 0.25, 0.2)

Corners = Sequence[tuple[float, float]]


def quadrotor(stamp: Timestamp, frame_id: str, name: str) -> SceneUpdate:
    """A quadrotor in X, forward = x, up = z of `frame_id`; the front propellers are orange."""
    arms = [
        CubePrimitive(
            pose=Pose(
                position=Vector3(),
                orientation=Quaternion(z=sin(turn / 2), w=cos(turn / 2)),
            ),
            size=Vector3(x=2 * ARM_M, y=0.04, z=0.03),
            color=_DARK,
        )
        for turn in (pi / 4, -pi / 4)
    ]
    body = CubePrimitive(
        pose=Pose(position=Vector3(), orientation=NO_TURN),
        size=Vector3(x=0.24, y=0.16, z=0.09),
        color=_DARK,
    )
    reach = ARM_M / sqrt(2.0)
    propellers = [
        CylinderPrimitive(
            pose=Pose(position=Vector3(x=forward, y=left, z=0.05), orientation=NO_TURN),
            size=Vector3(x=0.3, y=0.3, z=0.012),
            bottom_scale=1.0,
            top_scale=1.0,
            color=_FRONT if forward > 0 else _REAR,
        )
        for forward in (reach, -reach)
        for left in (reach, -reach)
    ]
    entity = SceneEntity(
        timestamp=stamp,
        frame_id=frame_id,
        id=name,
        frame_locked=True,
        cubes=[body, *arms],
        cylinders=propellers,
    )
    return SceneUpdate(entities=[entity])


def fence(item: FenceItem, stamp: Timestamp) -> SceneUpdate:
    """Every zone as translucent walls with a rim: green keeps the vehicle in, red keeps it out."""
    return SceneUpdate(
        deletions=_clear(stamp), entities=[_zone(zone, stamp) for zone in item.zones]
    )


def mission(item: MissionItem, stamp: Timestamp) -> SceneUpdate:
    """The path as a line, every point as a numbered ball."""
    points = [enu_from_ned(at) for at in item.path_ned]
    entity = SceneEntity(
        timestamp=stamp,
        frame_id="map",
        id="mission",
        frame_locked=True,
        lines=[_line(points, _ROUTE, LinePrimitiveLineType.LineStrip)] if points else [],
        spheres=[
            SpherePrimitive(pose=_at(at), size=Vector3(x=0.4, y=0.4, z=0.4), color=_ROUTE)
            for at in points
        ],
        texts=[
            _label((east, north, up + 0.8), str(number))
            for number, (east, north, up) in enumerate(points, start=1)
        ],
    )
    return SceneUpdate(deletions=_clear(stamp), entities=[entity] if points else [])


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


def corners(zone: FenceShape) -> Corners:
    """The zone's outline, east and north in metres; a circle as a polygon for drawing."""
    if zone.centre_en is None:
        return zone.corners_en
    east, north = zone.centre_en
    turns = [2 * pi * i / CIRCLE_CORNERS for i in range(CIRCLE_CORNERS)]
    return [(east + zone.radius_m * sin(a), north + zone.radius_m * cos(a)) for a in turns]


def _zone(zone: FenceShape, stamp: Timestamp) -> SceneEntity:
    red, green, blue = _INCLUSION if zone.inclusion else _EXCLUSION
    floor = -NO_BOUND_M if zone.floor_up_m is None else max(zone.floor_up_m, -NO_BOUND_M)
    ceiling = NO_BOUND_M if zone.ceiling_up_m is None else min(zone.ceiling_up_m, NO_BOUND_M)
    outline = corners(zone)
    low = [(east, north, floor) for east, north in outline]
    high = [(east, north, ceiling) for east, north in outline]
    rim = Color(r=red, g=green, b=blue, a=0.9)
    drawn = bool(outline)
    return SceneEntity(
        timestamp=stamp,
        frame_id="map",
        id=f"zone {zone.name}",
        frame_locked=True,
        triangles=[_walls(low, high, Color(r=red, g=green, b=blue, a=0.12))] if drawn else [],
        lines=[_line(ring, rim, LinePrimitiveLineType.LineLoop) for ring in (low, high) if drawn],
        texts=[_label((*outline[0], ceiling + 1.0), zone.name)] if drawn else [],
    )


def _walls(low: Sequence[Vec3], high: Sequence[Vec3], color: Color) -> TriangleListPrimitive:
    count = len(low)
    indices = [
        corner
        for i in range(count)
        for j in [(i + 1) % count]
        for corner in (i, j, count + j, i, count + j, count + i)
    ]
    return TriangleListPrimitive(
        pose=Pose(position=Vector3(), orientation=NO_TURN),
        points=[Point3(x=x, y=y, z=z) for x, y, z in (*low, *high)],
        color=color,
        indices=indices,
    )


def _line(points: Sequence[Vec3], color: Color, kind: LinePrimitiveLineType) -> LinePrimitive:
    return LinePrimitive(
        type=kind,
        pose=Pose(position=Vector3(), orientation=NO_TURN),
        thickness=2.0,
        scale_invariant=True,
        points=[Point3(x=x, y=y, z=z) for x, y, z in points],
        color=color,
    )


def _label(at_enu: Vec3, text: str) -> TextPrimitive:
    return TextPrimitive(
        pose=_at(at_enu),
        billboard=True,
        font_size=14.0,
        scale_invariant=True,
        color=Color(r=1.0, g=1.0, b=1.0, a=1.0),
        text=text,
    )


def _at(at_enu: Vec3) -> Pose:
    east, north, up = at_enu
    return Pose(position=Vector3(x=east, y=north, z=up), orientation=NO_TURN)


def _clear(stamp: Timestamp) -> list[SceneEntityDeletion]:
    return [SceneEntityDeletion(timestamp=stamp, type=SceneEntityDeletionType.All)]


def _hex(rgb: tuple[float, float, float]) -> str:
    return "#" + "".join(f"{round(255 * part):02x}" for part in rgb)


def _ring(outline: Corners) -> Corners:
    """GeoJSON (RFC 7946, 3.1.6): a ring ends where it began."""
    return [*outline, outline[0]]


def _lon_lat(origin: tuple[float, float, float], at_en: tuple[float, float]) -> list[float]:
    """For drawing only: equirectangular about the origin, within 0.2 m at 1 km."""
    lat_deg, lon_deg, _ = origin
    east, north = at_en
    return [
        lon_deg + degrees(east / (EARTH_RADIUS_M * cos(radians(lat_deg)))),
        lat_deg + degrees(north / EARTH_RADIUS_M),
    ]
