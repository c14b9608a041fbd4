"""Topics in Foxglove's own schemas (protobuf): transforms, trail, setpoint, map, scenes, log.

Frames: `map` (ENU) -> `local_ned` static, `local_ned` -> `base_link_frd` dynamic with MAVLink's
values unchanged, `base_link_frd` -> `base_link` static.  A second vehicle's body frames carry
its number.  The transforms of each vehicle have a topic of their own, because after a seek a
viewer reads only the last message of a topic.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from math import cos, dist, isfinite, pi, sin, sqrt

from foxglove import Schema
from foxglove.messages import (
    FrameTransform,
    FrameTransforms,
    GeoJson,
    LocationFix,
    LocationFixPositionCovarianceType,
    Log,
    LogLevel,
    Pose,
    PoseInFrame,
    PosesInFrame,
    Quaternion,
    SceneUpdate,
    Timestamp,
    Vector3,
)

from gcs.frames import Vec3, enu_from_ned
from gcs.record import scenes
from gcs.record.backend import Channel
from gcs.record.topics import Grid, Out
from gcs.report import (
    FenceItem,
    GeodeticItem,
    LogEvent,
    MissionItem,
    PoseItem,
    RecordItem,
    SetpointItem,
)

TF_HZ = 25.0
PATH_HZ = 1.0
LOCATION_HZ = 5.0
PATH_SPACING_M = 0.2
PATH_POINTS = 400

NED_IN_MAP = Quaternion(x=sqrt(0.5), y=sqrt(0.5), z=0.0, w=0.0)
"""Swaps x and y and turns z round: a half turn about the diagonal of north and east."""

FLU_IN_FRD = Quaternion(x=1.0, y=0.0, z=0.0, w=0.0)
"""A half turn about the forward axis."""

_LEVELS = {
    1: LogLevel.Debug,
    2: LogLevel.Info,
    3: LogLevel.Warning,
    4: LogLevel.Error,
    5: LogLevel.Fatal,
}


def _channel(topic: str, schema: Schema) -> Channel:
    return Channel(topic, "protobuf", schema.name, schema.encoding, schema.data)


def stamp(now_ns: int) -> Timestamp:
    seconds, nanoseconds = divmod(now_ns, 1_000_000_000)
    return Timestamp(seconds, nanoseconds)


@dataclass(slots=True)
class Trail:
    """Where a vehicle has been, ENU: thinned out by half whenever it grows too long to repeat."""

    points_enu: list[Vec3] = field(default_factory=list)
    spacing_m: float = PATH_SPACING_M

    def add(self, at_enu: Vec3) -> bool:
        """Whether the point was far enough from the last to be kept."""
        if self.points_enu and dist(self.points_enu[-1], at_enu) < self.spacing_m:
            return False
        if len(self.points_enu) >= PATH_POINTS:
            self.points_enu = self.points_enu[::2]
            self.spacing_m *= 2
        self.points_enu.append(at_enu)
        return True


@dataclass(slots=True)
class _Vehicle:
    frd: str
    flu: str
    tf: Channel
    path: Channel
    setpoint: Channel
    location: Channel
    trail: Trail = field(default_factory=Trail)
    trail_changed: bool = False
    tf_grid: Grid = field(default_factory=lambda: Grid(TF_HZ))
    path_grid: Grid = field(default_factory=lambda: Grid(PATH_HZ))
    location_grid: Grid = field(default_factory=lambda: Grid(LOCATION_HZ))


class FoxgloveTopics:
    """/tf_static, /vehicle/N/{tf,model,path,setpoint,location}, /mission, /geofence and /log."""

    def __init__(self) -> None:
        self._vehicles: dict[int, _Vehicle] = {}
        self._tf_static = _channel("/tf_static", FrameTransforms.get_schema())
        self._mission = _channel("/mission", SceneUpdate.get_schema())
        self._fence = _channel("/geofence", SceneUpdate.get_schema())
        self._fence_map = _channel("/geofence/geojson", GeoJson.get_schema())
        self._log = _channel("/log", Log.get_schema())

    def handle(self, item: RecordItem, now_ns: int) -> list[Out]:
        match item:
            case PoseItem():
                return self._pose(item, now_ns)
            case SetpointItem(sysid, pos_ned, yaw_rad):
                before, vehicle = self._vehicle(sysid, now_ns)
                pose = PoseInFrame(
                    timestamp=stamp(now_ns), frame_id="map", pose=_pose_enu(pos_ned, yaw_rad)
                )
                return [*before, Out(vehicle.setpoint, pose.encode())]
            case GeodeticItem():
                return self._location(item, now_ns)
            case LogEvent(_, level, node, text):
                line = Log(
                    timestamp=stamp(now_ns),
                    level=_LEVELS.get(level, LogLevel.Unknown),
                    name=node,
                    message=text,
                )
                return [Out(self._log, line.encode())]
            case FenceItem():
                walls = scenes.fence(item, stamp(now_ns))
                on_map = scenes.fence_geojson(item)
                outs = [Out(self._fence, walls.encode(), latch="fence")]
                return outs + [Out(self._fence_map, m.encode(), "fence") for m in [on_map] if m]
            case MissionItem():
                route = scenes.mission(item, stamp(now_ns))
                return [Out(self._mission, route.encode(), latch="mission")]
            case _:
                return []

    def tick(self, now_ns: int) -> list[Out]:
        return []

    def close(self, now_ns: int) -> list[Out]:
        return [_path(v, now_ns) for v in self._vehicles.values() if v.trail_changed]

    def _pose(self, item: PoseItem, now_ns: int) -> list[Out]:
        outs, vehicle = self._vehicle(item.sysid, now_ns)
        if not all(map(isfinite, (*item.pos_ned, *item.q_ned_from_frd))):
            return outs
        vehicle.trail_changed |= vehicle.trail.add(enu_from_ned(item.pos_ned))
        if vehicle.tf_grid.due(now_ns):
            w, x, y, z = item.q_ned_from_frd
            north, east, down = item.pos_ned
            body = FrameTransform(
                timestamp=stamp(now_ns),
                parent_frame_id="local_ned",
                child_frame_id=vehicle.frd,
                translation=Vector3(x=north, y=east, z=down),
                rotation=Quaternion(x=x, y=y, z=z, w=w),
            )
            outs.append(Out(vehicle.tf, FrameTransforms(transforms=[body]).encode()))
        if vehicle.trail_changed and vehicle.path_grid.due(now_ns):
            outs.append(_path(vehicle, now_ns))
        return outs

    def _location(self, item: GeodeticItem, now_ns: int) -> list[Out]:
        outs, vehicle = self._vehicle(item.sysid, now_ns)
        if vehicle.location_grid.due(now_ns):
            fix = LocationFix(
                timestamp=stamp(now_ns),
                frame_id="map",
                latitude=item.lat_deg,
                longitude=item.lon_deg,
                altitude=item.alt_amsl_m,
                position_covariance_type=LocationFixPositionCovarianceType.Unknown,
            )
            outs.append(Out(vehicle.location, fix.encode()))
        return outs

    def _vehicle(self, sysid: int, now_ns: int) -> tuple[list[Out], _Vehicle]:
        """The vehicle, and what must be said when it is new: its model and all static frames."""
        known = self._vehicles.get(sysid)
        if known is not None:
            return [], known
        suffix = f"_{sysid}" if self._vehicles else ""
        base = f"/vehicle/{sysid}"
        known = self._vehicles[sysid] = _Vehicle(
            frd=f"base_link_frd{suffix}",
            flu=f"base_link{suffix}",
            tf=_channel(f"{base}/tf", FrameTransforms.get_schema()),
            path=_channel(f"{base}/path", PosesInFrame.get_schema()),
            setpoint=_channel(f"{base}/setpoint", PoseInFrame.get_schema()),
            location=_channel(f"{base}/location", LocationFix.get_schema()),
        )
        model = scenes.quadrotor(stamp(now_ns), known.flu, f"vehicle {sysid}")
        model_channel = _channel(f"{base}/model", SceneUpdate.get_schema())
        return [self._statics(now_ns), Out(model_channel, model.encode(), latch="model")], known

    def _statics(self, now_ns: int) -> Out:
        """All static transforms in one message: only the last one is read after a seek."""
        turns = [("map", "local_ned", NED_IN_MAP)]
        turns += [(v.frd, v.flu, FLU_IN_FRD) for v in self._vehicles.values()]
        transforms = [
            FrameTransform(
                timestamp=stamp(now_ns),
                parent_frame_id=parent,
                child_frame_id=child,
                translation=Vector3(),
                rotation=rotation,
            )
            for parent, child, rotation in turns
        ]
        message = FrameTransforms(transforms=transforms).encode()
        return Out(self._tf_static, message, latch="static")


def _path(vehicle: _Vehicle, now_ns: int) -> Out:
    vehicle.trail_changed = False
    poses = [
        Pose(position=Vector3(x=east, y=north, z=up), orientation=scenes.NO_TURN)
        for east, north, up in vehicle.trail.points_enu
    ]
    path = PosesInFrame(timestamp=stamp(now_ns), frame_id="map", poses=poses)
    return Out(vehicle.path, path.encode())


def _pose_enu(pos_ned: Vec3, yaw_rad: float | None) -> Pose:
    """A heading, clockwise from north, turns anticlockwise from east in `map`; None faces east."""
    east, north, up = enu_from_ned(pos_ned)
    turn = pi / 2 - yaw_rad if yaw_rad is not None and isfinite(yaw_rad) else 0.0
    return Pose(
        position=Vector3(x=east, y=north, z=up),
        orientation=Quaternion(z=sin(turn / 2), w=cos(turn / 2)),
    )
