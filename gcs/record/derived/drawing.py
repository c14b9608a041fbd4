"""Lines, balls, labels and surfaces of a 3D scene, in `map` (ENU, metres)."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from math import cos, radians

from foxglove import Schema
from foxglove.messages import (
    Color,
    Duration,
    LinePrimitive,
    LinePrimitiveLineType,
    Point3,
    Pose,
    Quaternion,
    SceneEntity,
    SceneEntityDeletion,
    SceneEntityDeletionType,
    SpherePrimitive,
    TextPrimitive,
    Timestamp,
    TriangleListPrimitive,
    Vector3,
)

from gcs.frames import Vec3
from gcs.mcap_file.writer import Channel

EARTH_RADIUS_M = 6_371_000.0
NO_TURN = Quaternion(x=0.0, y=0.0, z=0.0, w=1.0)
WHITE = (1.0, 1.0, 1.0)
Rgb = tuple[float, float, float]


def color(rgb: Rgb, alpha: float = 1.0) -> Color:
    """Of red, green and blue from 0 to 1; `alpha` 1 hides what is behind."""
    red, green, blue = rgb
    return Color(r=red, g=green, b=blue, a=alpha)


def line(
    points: Sequence[Vec3],
    of: Color | list[Color],
    *,
    closed: bool = False,
    pairs: bool = False,
    pixels: float = 2.0,
) -> LinePrimitive:
    """Through the points; `closed` back to the first; `pairs`: every two points are a line.
    `of`: one colour, or one for each point."""
    kind = LinePrimitiveLineType.LineLoop if closed else LinePrimitiveLineType.LineStrip
    return LinePrimitive(
        type=LinePrimitiveLineType.LineList if pairs else kind,
        pose=Pose(position=Vector3(), orientation=NO_TURN),
        thickness=pixels,
        scale_invariant=True,
        points=[Point3(x=x, y=y, z=z) for x, y, z in points],
        color=None if isinstance(of, list) else of,
        colors=of if isinstance(of, list) else [],
    )


def ball(at_enu: Vec3, diameter_m: float, of: Color) -> SpherePrimitive:
    """A sphere."""
    size = Vector3(x=diameter_m, y=diameter_m, z=diameter_m)
    return SpherePrimitive(pose=place(at_enu), size=size, color=of)


def label(at_enu: Vec3, text: str, rgb: Rgb = WHITE) -> TextPrimitive:
    """A text that faces the viewer, of the same size at any distance."""
    return TextPrimitive(
        pose=place(at_enu),
        billboard=True,
        font_size=14.0,
        scale_invariant=True,
        color=color(rgb),
        text=text,
    )


def surface(
    points: Sequence[Vec3], triangles: Iterable[tuple[int, int, int]], of: Color
) -> TriangleListPrimitive:
    """Triangles, each as three numbers of points."""
    return TriangleListPrimitive(
        pose=Pose(position=Vector3(), orientation=NO_TURN),
        points=[Point3(x=x, y=y, z=z) for x, y, z in points],
        color=of,
        indices=[corner for triangle in triangles for corner in triangle],
    )


def entity(
    name: str,
    stamp: Timestamp,
    lifetime_ns: int = 0,
    *,
    frame_id: str = "map",
    lines: list[LinePrimitive] | None = None,
    spheres: list[SpherePrimitive] | None = None,
    texts: list[TextPrimitive] | None = None,
    triangles: list[TriangleListPrimitive] | None = None,
) -> SceneEntity:
    """Things in `frame_id` that appear and vanish together; lifetime 0: until they are replaced."""
    return SceneEntity(
        timestamp=stamp,
        frame_id=frame_id,
        id=name,
        frame_locked=True,
        lifetime=Duration(*divmod(lifetime_ns, 1_000_000_000)),
        lines=lines or [],
        spheres=spheres or [],
        texts=texts or [],
        triangles=triangles or [],
    )


def east_north(origin_deg: tuple[float, float], at_deg: tuple[float, float]) -> tuple[float, float]:
    """Metres from `origin_deg` to `at_deg`, both latitude and longitude; for drawing only:
    equirectangular, within 0.2 m at 1 km."""
    (lat0_deg, lon0_deg), (lat_deg, lon_deg) = origin_deg, at_deg
    east = EARTH_RADIUS_M * cos(radians(lat0_deg)) * radians(lon_deg - lon0_deg)
    return east, EARTH_RADIUS_M * radians(lat_deg - lat0_deg)


def clear(stamp: Timestamp) -> list[SceneEntityDeletion]:
    """Everything of the topic goes."""
    return [SceneEntityDeletion(timestamp=stamp, type=SceneEntityDeletionType.All)]


def place(at_enu: Vec3) -> Pose:
    """A pose without a turn."""
    east, north, up = at_enu
    return Pose(position=Vector3(x=east, y=north, z=up), orientation=NO_TURN)


def channel(topic: str, schema: Schema) -> Channel:
    """A protobuf channel."""
    return Channel(topic, "protobuf", schema.name, schema.encoding, schema.data)


def stamp(now_ns: int) -> Timestamp:
    """Of log_time: ns since 1970."""
    seconds, nanoseconds = divmod(now_ns, 1_000_000_000)
    return Timestamp(seconds, nanoseconds)
