"""/vehicle/N/path: where each vehicle has been, the whole way in every message."""

from __future__ import annotations

from dataclasses import dataclass, field
from math import isfinite
from typing import ClassVar

from foxglove.messages import Pose, PosesInFrame, Vector3

from gcs.frames import enu_from_ned
from gcs.mcap_file.writer import Channel
from gcs.record.derived.body_frames import FrameNames
from gcs.record.derived.drawing import NO_TURN, channel, stamp
from gcs.record.derived.trail import Trail
from gcs.record.topics import Deriver, Out
from gcs.report import PoseItem, RecordItem

PERIOD_NS = 1_000_000_000
POINTS_A_PERIOD = 200
"""A longer way is written less often, so that the record grows by no more points a second."""


@dataclass(slots=True)
class _Vehicle:
    frame_id: str
    path: Channel
    trail: Trail = field(default_factory=Trail)
    changed: bool = False
    due_ns: int = 0


class Paths(Deriver):
    """At most once a second, a long way less often, and only where the vehicle moved."""

    takes: ClassVar = frozenset({PoseItem})

    def __init__(self, names: FrameNames) -> None:
        self._names = names
        self._vehicles: dict[int, _Vehicle] = {}

    def handle(self, item: RecordItem, now_ns: int) -> list[Out]:
        if not isinstance(item, PoseItem) or not all(map(isfinite, item.pos_ned)):
            return []
        vehicle = self._vehicles.get(item.sysid)
        if vehicle is None:
            path = channel(f"/vehicle/{item.sysid}/path", PosesInFrame.get_schema())
            vehicle = self._vehicles[item.sysid] = _Vehicle(self._names.of(item.sysid).enu, path)
        vehicle.changed |= vehicle.trail.add(enu_from_ned(item.pos_ned))
        if vehicle.changed and now_ns >= vehicle.due_ns:
            return [_path(vehicle, now_ns)]
        return []

    def close(self, now_ns: int) -> list[Out]:
        return [_path(vehicle, now_ns) for vehicle in self._vehicles.values() if vehicle.changed]


def _path(vehicle: _Vehicle, now_ns: int) -> Out:
    points = vehicle.trail.points_enu
    vehicle.changed = False
    vehicle.due_ns = now_ns + PERIOD_NS * max(1, len(points) // POINTS_A_PERIOD)
    poses = [
        Pose(position=Vector3(x=east, y=north, z=up), orientation=NO_TURN)
        for east, north, up in points
    ]
    path = PosesInFrame(timestamp=stamp(now_ns), frame_id=vehicle.frame_id, poses=poses)
    return Out(vehicle.path, path.encode(), latch="path")
