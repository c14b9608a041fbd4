"""Lines, balls, labels and surfaces of a 3D scene, in `map` (ENU, metres)."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

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

NO_TURN = Quaternion(x=0.0, y=0.0, z=0.0, w=1.0)
WHITE = (1.0, 1.0, 1.0)
Rgb = tuple[float, float, float]


def color(rgb: Rgb, alpha: float = 1.0) -> Color:
    """Of red, green and blue from 0 to 1; `alpha` 1 hides what is behind."""
    red, green, blue = rgb
    return Color(r=red, g=green, b=blue, a=alpha)


def line(
    points: Sequence[Vec3],
    of: Color,
    *,
    closed: bool = False,
    pairs: bool = False,
    pixels: float = 2.0,
) -> LinePrimitive:
    """Through the points; `closed` back to the first; `pairs`: every two points are a line."""
    kind = LinePrimitiveLineType.LineLoop if closed else LinePrimitiveLineType.LineStrip
    return LinePrimitive(
        type=LinePrimitiveLineType.LineList if pairs else kind,
        pose=Pose(position=Vector3(), orientation=NO_TURN),
        thickness=pixels,
        scale_invariant=True,
        points=[Point3(x=x, y=y, z=z) for x, y, z in points],
        color=of,
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
    lines: list[LinePrimitive] | None = None,
    spheres: list[SpherePrimitive] | None = None,
    texts: list[TextPrimitive] | None = None,
    triangles: list[TriangleListPrimitive] | None = None,
) -> SceneEntity:
    """Things in `map` that appear and vanish together; lifetime 0: until they are replaced."""
    return SceneEntity(
        timestamp=stamp,
        frame_id="map",
        id=name,
        frame_locked=True,
        lifetime=Duration(*divmod(lifetime_ns, 1_000_000_000)),
        lines=lines or [],
        spheres=spheres or [],
        texts=texts or [],
        triangles=triangles or [],
    )


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
