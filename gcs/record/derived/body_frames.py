"""Where each vehicle is and what it looks like: /tf_static, /vehicle/N/{tf,model,odometry}.

Frames: `map` (ENU) -> `local_ned` static, `local_ned` -> `base_link_frd` dynamic with MAVLink's
values unchanged, `base_link_frd` -> `base_link` static.  A second vehicle's frames carry its
number: `map_2` is where its own local frame begins, as far from `map` as the two origins are
(GPS_GLOBAL_ORIGIN), and what it says of places is drawn there.  The transforms of each vehicle
have a topic of their own, because after a seek a viewer reads only the last message of a topic.
Quaternions are (w, x, y, z).
"""

from __future__ import annotations

from dataclasses import dataclass, field
from math import cos, isfinite, pi, sin, sqrt
from typing import ClassVar

from foxglove.messages import (
    CubePrimitive,
    CylinderPrimitive,
    FrameTransform,
    FrameTransforms,
    Odometry,
    Pose,
    Quaternion,
    SceneEntity,
    SceneUpdate,
    Timestamp,
    Vector3,
)

from gcs.frames import Vec3, enu_from_ned
from gcs.mcap_file.writer import Channel
from gcs.record.derived.drawing import NO_TURN, channel, color, east_north, stamp
from gcs.record.topics import Deriver, Grid, Out
from gcs.report import FsaItem, GeodeticItem, OriginItem, PoseItem, Quat, RecordItem, SetpointItem

TF_HZ = 25.0
ODOMETRY_HZ = 5.0

NED_IN_MAP: Quat = (0.0, sqrt(0.5), sqrt(0.5), 0.0)
"""Swaps x and y and turns z round: a half turn about the diagonal of north and east."""

FLU_IN_FRD: Quat = (0.0, 1.0, 0.0, 0.0)
"""A half turn about the forward axis."""

ARM_M = 0.45
"""Centre to motor: larger than life, so that it is seen from a hundred metres."""

_DARK = color((0.12, 0.13, 0.16))
_FRONT = color((1.0, 0.45, 0.1), 0.9)
_REAR = color((0.85, 0.87, 0.9), 0.9)


@dataclass(frozen=True, slots=True)
class VehicleFrames:
    """The frames of one vehicle, without a suffix or with `_N`."""

    suffix: str = ""

    @property
    def enu(self) -> str:
        """East, north, up of its local origin."""
        return f"map{self.suffix}"

    @property
    def ned(self) -> str:
        """North, east, down of its local origin."""
        return f"local_ned{self.suffix}"

    @property
    def frd(self) -> str:
        """Of the body: x forward, y right, z down."""
        return f"base_link_frd{self.suffix}"

    @property
    def flu(self) -> str:
        """Of the body: x forward, y left, z up."""
        return f"base_link{self.suffix}"


class FrameNames:
    """The frames of every vehicle: the first one that is heard of has the plain names."""

    def __init__(self) -> None:
        self._names: dict[int, VehicleFrames] = {}

    def __contains__(self, sysid: int) -> bool:
        return sysid in self._names

    def of(self, sysid: int) -> VehicleFrames:
        """Given when first asked for."""
        known = self._names.get(sysid)
        if known is None:
            suffix = f"_{sysid}" if self._names else ""
            known = self._names[sysid] = VehicleFrames(suffix)
        return known

    def all(self) -> dict[int, VehicleFrames]:
        """Of every vehicle; before one is heard of, the names that the first will have."""
        return self._names or {0: VehicleFrames()}


@dataclass(slots=True)
class _Vehicle:
    names: VehicleFrames
    tf: Channel
    odometry: Channel
    tf_grid: Grid = field(default_factory=lambda: Grid(TF_HZ))
    odometry_grid: Grid = field(default_factory=lambda: Grid(ODOMETRY_HZ))


class BodyFrames(Deriver):
    """Transforms at 25 Hz, odometry at 5 Hz; the static ones and the model once, at the start."""

    takes: ClassVar = frozenset({FsaItem, PoseItem, GeodeticItem, SetpointItem, OriginItem})

    def __init__(self, names: FrameNames) -> None:
        self._names = names
        self._vehicles: dict[int, _Vehicle] = {}
        self._origins: dict[int, OriginItem] = {}
        self._static = channel("/tf_static", FrameTransforms.get_schema())

    def start(self, now_ns: int) -> list[Out]:
        return [self._statics(now_ns)]

    def handle(self, item: RecordItem, now_ns: int) -> list[Out]:
        match item:
            case PoseItem(sysid):
                outs, vehicle = self._vehicle(sysid, now_ns)
                if all(map(isfinite, (*item.pos_ned, *item.v_ned, *item.q_ned_from_frd))):
                    outs += _pose(vehicle, item, now_ns)
                return outs
            case OriginItem(sysid) if self._origins.get(sysid) != item:
                outs, _ = self._vehicle(sysid, now_ns)
                self._origins[sysid] = item
                return [*outs, self._statics(now_ns)]
            case FsaItem(sysid) | GeodeticItem(sysid) | SetpointItem(sysid):
                return self._vehicle(sysid, now_ns)[0]
            case _:
                return []

    def _vehicle(self, sysid: int, now_ns: int) -> tuple[list[Out], _Vehicle]:
        """The vehicle, and what must be said when it is new: its model and all static frames."""
        known = self._vehicles.get(sysid)
        if known is not None:
            return [], known
        before = len(self._names.all())
        names = self._names.of(sysid)
        outs = [self._statics(now_ns)] if len(self._names.all()) > before else []
        base = f"/vehicle/{sysid}"
        known = self._vehicles[sysid] = _Vehicle(
            names,
            tf=channel(f"{base}/tf", FrameTransforms.get_schema()),
            odometry=channel(f"{base}/odometry", Odometry.get_schema()),
        )
        model = quadrotor(stamp(now_ns), names.flu, f"vehicle {sysid}")
        model_channel = channel(f"{base}/model", SceneUpdate.get_schema())
        return [*outs, Out(model_channel, model.encode(), latch="model")], known

    def _statics(self, now_ns: int) -> Out:
        """All static transforms in one message: only the last one is read after a seek."""
        transforms = []
        first = next(iter(self._names.all()))
        for sysid, names in self._names.all().items():
            if sysid != first:
                offset_enu = self._offset_enu(sysid, first)
                transforms.append(_static("map", names.enu, NO_TURN, now_ns, offset_enu))
            transforms += [
                _static(names.enu, names.ned, _quaternion(NED_IN_MAP), now_ns),
                _static(names.frd, names.flu, _quaternion(FLU_IN_FRD), now_ns),
            ]
        message = FrameTransforms(transforms=transforms).encode()
        return Out(self._static, message, latch="static")

    def _offset_enu(self, sysid: int, first: int) -> Vec3:
        """From the first one's origin to this one's; none while one of them is not known."""
        here, there = self._origins.get(first), self._origins.get(sysid)
        if here is None or there is None:
            return (0.0, 0.0, 0.0)
        east, north = east_north((here.lat_deg, here.lon_deg), (there.lat_deg, there.lon_deg))
        return (east, north, there.alt_amsl_m - here.alt_amsl_m)


def _static(
    parent: str, child: str, turn: Quaternion, now_ns: int, offset: Vec3 = (0.0, 0.0, 0.0)
) -> FrameTransform:
    x, y, z = offset
    return FrameTransform(
        timestamp=stamp(now_ns),
        parent_frame_id=parent,
        child_frame_id=child,
        translation=Vector3(x=x, y=y, z=z),
        rotation=turn,
    )


def _pose(vehicle: _Vehicle, item: PoseItem, now_ns: int) -> list[Out]:
    outs = []
    if vehicle.tf_grid.due(now_ns):
        north, east, down = item.pos_ned
        body = FrameTransform(
            timestamp=stamp(now_ns),
            parent_frame_id=vehicle.names.ned,
            child_frame_id=vehicle.names.frd,
            translation=Vector3(x=north, y=east, z=down),
            rotation=_quaternion(item.q_ned_from_frd),
        )
        outs.append(Out(vehicle.tf, FrameTransforms(transforms=[body]).encode()))
    if vehicle.odometry_grid.due(now_ns):
        outs.append(Out(vehicle.odometry, _odometry(vehicle.names, item, now_ns).encode()))
    return outs


def _odometry(names: VehicleFrames, item: PoseItem, now_ns: int) -> Odometry:
    """The pose from its own origin, and the velocity along the body's axes; no turn rates."""
    east, north, up = enu_from_ned(item.pos_ned)
    forward, right, down = turned(conjugate(item.q_ned_from_frd), item.v_ned)
    return Odometry(
        timestamp=stamp(now_ns),
        frame_id=names.enu,
        body_frame_id=names.flu,
        pose=Pose(
            position=Vector3(x=east, y=north, z=up),
            orientation=_quaternion(map_from_flu(item.q_ned_from_frd)),
        ),
        linear_velocity=Vector3(x=forward, y=-right, z=-down),
    )


def _quaternion(q: Quat) -> Quaternion:
    w, x, y, z = q
    return Quaternion(x=x, y=y, z=z, w=w)


# ------------------------------------------------------------------------------------- turns


def product(a: Quat, b: Quat) -> Quat:
    """First `b`, then `a` (Hamilton's product)."""
    aw, ax, ay, az = a
    bw, bx, by, bz = b
    return (
        aw * bw - ax * bx - ay * by - az * bz,
        aw * bx + ax * bw + ay * bz - az * by,
        aw * by - ax * bz + ay * bw + az * bx,
        aw * bz + ax * by - ay * bx + az * bw,
    )


def conjugate(q: Quat) -> Quat:
    """The turn back."""
    w, x, y, z = q
    return (w, -x, -y, -z)


def turned(q: Quat, v: Vec3) -> Vec3:
    """`v` rotated by `q`."""
    _, x, y, z = product(product(q, (0.0, *v)), conjugate(q))
    return (x, y, z)


def map_from_flu(q_ned_from_frd: Quat) -> Quat:
    """The attitude as a pose in `map` (ENU) of a body with x forward, y left, z up."""
    return product(product(NED_IN_MAP, q_ned_from_frd), FLU_IN_FRD)


# --------------------------------------------------------------------------------- the model


def quadrotor(stamp: Timestamp, frame_id: str, name: str) -> SceneUpdate:
    """A quadrotor in X, forward = x, up = z of `frame_id`; the front propellers are orange."""
    arms = [
        CubePrimitive(
            pose=Pose(
                position=Vector3(),
                orientation=Quaternion(z=sin(turn / 2), w=cos(turn / 2)),
            ),
            size=Vector3(x=2 * ARM_M, y=0.05, z=0.04),
            color=_DARK,
        )
        for turn in (pi / 4, -pi / 4)
    ]
    body = CubePrimitive(
        pose=Pose(position=Vector3(), orientation=NO_TURN),
        size=Vector3(x=0.3, y=0.2, z=0.12),
        color=_DARK,
    )
    reach = ARM_M / sqrt(2.0)
    propellers = [
        CylinderPrimitive(
            pose=Pose(position=Vector3(x=forward, y=left, z=0.06), orientation=NO_TURN),
            size=Vector3(x=0.4, y=0.4, z=0.015),
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
