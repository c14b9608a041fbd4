"""Where each vehicle is and what it looks like: /tf_static, /vehicle/N/{tf,model,odometry}.

Frames: `map` (ENU) -> `local_ned` static, `local_ned` -> `base_link_frd` dynamic with MAVLink's
values unchanged, `base_link_frd` -> `base_link` static.  A second vehicle's body frames carry
its number.  The transforms of each vehicle have a topic of their own, because after a seek a
viewer reads only the last message of a topic.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from math import isfinite
from typing import ClassVar

from foxglove.messages import (
    FrameTransform,
    FrameTransforms,
    Odometry,
    Pose,
    Quaternion,
    SceneUpdate,
    Vector3,
)

from gcs.frames import enu_from_ned
from gcs.record.backend import Channel
from gcs.record.derived.foxglove_channel import channel, stamp
from gcs.record.derived.model import quadrotor
from gcs.record.derived.rotation import (
    FLU_IN_FRD,
    NED_IN_MAP,
    conjugate,
    map_from_flu,
    turned,
)
from gcs.record.topics import Deriver, Grid, Out
from gcs.report import FsaItem, GeodeticItem, PoseItem, Quat, RecordItem, SetpointItem

TF_HZ = 25.0
ODOMETRY_HZ = 5.0


@dataclass(frozen=True, slots=True)
class BodyNames:
    """The frames of one vehicle: x forward, y right, z down; and x forward, y left, z up."""

    frd: str
    flu: str


class FrameNames:
    """The frames of every vehicle: the first one that is heard of has the plain names."""

    def __init__(self) -> None:
        self._names: dict[int, BodyNames] = {}

    def __contains__(self, sysid: int) -> bool:
        return sysid in self._names

    def of(self, sysid: int) -> BodyNames:
        """Given when first asked for."""
        known = self._names.get(sysid)
        if known is None:
            suffix = f"_{sysid}" if self._names else ""
            known = self._names[sysid] = BodyNames(f"base_link_frd{suffix}", f"base_link{suffix}")
        return known

    def all(self) -> list[BodyNames]:
        """Of every vehicle; before one is heard of, the names that the first will have."""
        return list(self._names.values()) or [BodyNames("base_link_frd", "base_link")]


@dataclass(slots=True)
class _Vehicle:
    names: BodyNames
    tf: Channel
    odometry: Channel
    tf_grid: Grid = field(default_factory=lambda: Grid(TF_HZ))
    odometry_grid: Grid = field(default_factory=lambda: Grid(ODOMETRY_HZ))


class BodyFrames(Deriver):
    """Transforms at 25 Hz, odometry at 5 Hz; the static ones and the model once, at the start."""

    takes: ClassVar = frozenset({FsaItem, PoseItem, GeodeticItem, SetpointItem})

    def __init__(self, names: FrameNames) -> None:
        self._names = names
        self._vehicles: dict[int, _Vehicle] = {}
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
            case FsaItem(sysid) | GeodeticItem(sysid) | SetpointItem(sysid):
                return self._vehicle(sysid, now_ns)[0]
            case _:
                return []

    def _vehicle(self, sysid: int, now_ns: int) -> tuple[list[Out], _Vehicle]:
        """The vehicle, and what must be said when it is new: its model and all static frames."""
        known = self._vehicles.get(sysid)
        if known is not None:
            return [], known
        before = self._names.all()
        names = self._names.of(sysid)
        outs = [] if names in before else [self._statics(now_ns)]
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
        turns = [("map", "local_ned", NED_IN_MAP)]
        turns += [(body.frd, body.flu, FLU_IN_FRD) for body in self._names.all()]
        transforms = [
            FrameTransform(
                timestamp=stamp(now_ns),
                parent_frame_id=parent,
                child_frame_id=child,
                translation=Vector3(),
                rotation=_quaternion(rotation),
            )
            for parent, child, rotation in turns
        ]
        message = FrameTransforms(transforms=transforms).encode()
        return Out(self._static, message, latch="static")


def _pose(vehicle: _Vehicle, item: PoseItem, now_ns: int) -> list[Out]:
    outs = []
    if vehicle.tf_grid.due(now_ns):
        north, east, down = item.pos_ned
        body = FrameTransform(
            timestamp=stamp(now_ns),
            parent_frame_id="local_ned",
            child_frame_id=vehicle.names.frd,
            translation=Vector3(x=north, y=east, z=down),
            rotation=_quaternion(item.q_ned_from_frd),
        )
        outs.append(Out(vehicle.tf, FrameTransforms(transforms=[body]).encode()))
    if vehicle.odometry_grid.due(now_ns):
        outs.append(Out(vehicle.odometry, _odometry(vehicle.names, item, now_ns).encode()))
    return outs


def _odometry(names: BodyNames, item: PoseItem, now_ns: int) -> Odometry:
    """The pose in `map`, and the velocity along the body's axes; the turn rates are not known."""
    east, north, up = enu_from_ned(item.pos_ned)
    forward, right, down = turned(conjugate(item.q_ned_from_frd), item.v_ned)
    return Odometry(
        timestamp=stamp(now_ns),
        frame_id="map",
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
