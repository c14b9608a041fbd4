"""A place that a person clicks in a viewer's 3D panel, as a goal in the operator's frame.

Foxglove and Lichtblick publish a point (`/clicked_point`) or a pose (`/move_base_simple/goal`) as
ROS messages, geometry_msgs/PointStamped and PoseStamped, in JSON or in ROS 1 encoding; programs may
use Foxglove's own PoseInFrame.  All three are read by what they hold.
"""

from __future__ import annotations

import math
import struct
from dataclasses import dataclass

import msgspec

from gcs.frames import Vec3, enu_from_ned

MAX_GOAL_BYTES = 4_096
FRAME_NAME_BYTES = 64
LEVEL_QUATERNION_SQUARED = 1e-6
POINT_KINDS = frozenset({"PointStamped"})
POSE_KINDS = frozenset({"PoseStamped", "PoseInFrame"})
KINDS = POINT_KINDS | POSE_KINDS
ENCODINGS = ("json", "ros1")

_HEADER = struct.Struct("<III")
_COUNT = struct.Struct("<I")
_POINT = struct.Struct("<3d")
_POSE = struct.Struct("<7d")


class BadMessageError(ValueError):
    """It is no goal: one sentence why."""


@dataclass(frozen=True, slots=True)
class ClickedGoal:
    """Where was clicked: metres east, north, up; the height is that of the panel's ground.

    `yaw_deg` is the heading of a pose, clockwise from north; None of a point.
    """

    at_enu: Vec3
    yaw_deg: float | None = None


class _Xyz(msgspec.Struct):
    x: float
    y: float
    z: float = 0.0


class _Quaternion(msgspec.Struct):
    x: float = 0.0
    y: float = 0.0
    z: float = 0.0
    w: float = 1.0


class _Pose(msgspec.Struct):
    position: _Xyz
    orientation: _Quaternion = msgspec.field(default_factory=_Quaternion)


class _Header(msgspec.Struct):
    frame_id: str = ""


class _Message(msgspec.Struct):
    """Of all three kinds; ROS has the frame in a header, Foxglove beside the pose."""

    header: _Header | None = None
    frame_id: str = ""
    point: _Xyz | None = None
    pose: _Pose | None = None


_decoder = msgspec.json.Decoder(_Message)


def kind_of(schema_name: str) -> str:
    """`geometry_msgs/msg/PoseStamped` and `foxglove.PoseStamped` are both a `PoseStamped`."""
    return schema_name.replace(".", "/").rpartition("/")[2]


def clicked_goal(encoding: str, schema_name: str, data: bytes) -> ClickedGoal:
    """Read a message that a viewer has published.  Raises BadMessageError."""
    kind = kind_of(schema_name)
    if kind not in KINDS:
        known = ", ".join(sorted(KINDS))
        raise BadMessageError(f"a goal is one of {known}, not {schema_name[:80]!r}")
    if len(data) > MAX_GOAL_BYTES:
        raise BadMessageError(f"a goal of {len(data)} bytes is none")
    match encoding:
        case "json":
            frame, position, orientation = _from_json(data)
        case "ros1":
            frame, position, orientation = _from_ros1(kind, data)
        case _:
            known = ", ".join(ENCODINGS)
            raise BadMessageError(f"the encoding of a goal is one of {known}, not {encoding!r}")
    return _in_map(frame, position, orientation if kind in POSE_KINDS else None)


def _from_json(data: bytes) -> tuple[str, Vec3, _Quaternion | None]:
    try:
        message = _decoder.decode(data)
    except (msgspec.DecodeError, RecursionError) as error:
        raise BadMessageError(f"the goal cannot be read: {error}") from error
    frame = message.header.frame_id if message.header else message.frame_id
    if message.pose is not None:
        at = message.pose.position
        return frame, (at.x, at.y, at.z), message.pose.orientation
    if message.point is not None:
        return frame, (message.point.x, message.point.y, message.point.z), None
    raise BadMessageError("the goal has neither a point nor a pose")


def _from_ros1(kind: str, data: bytes) -> tuple[str, Vec3, _Quaternion | None]:
    """std_msgs/Header is seq, secs, nsecs and a counted string; then come the float64."""
    try:
        (length,) = _COUNT.unpack_from(data, _HEADER.size)
        start = _HEADER.size + _COUNT.size
        frame = data[start : start + length].decode(errors="replace")
        rest = data[start + length :]
        if kind in POINT_KINDS:
            return frame, _POINT.unpack(rest), None
        x, y, z, *turn = _POSE.unpack(rest)
    except struct.error as error:
        raise BadMessageError(f"the goal cannot be read as ros1 {kind}: {error}") from error
    return frame, (x, y, z), _Quaternion(*turn)


def _in_map(frame: str, position: Vec3, turn: _Quaternion | None) -> ClickedGoal:
    """The frames of the record: `map` is east, north, up, `local_ned` north, east, down."""
    match frame.removeprefix("/"):
        case "map":
            turn_deg = None if turn is None else _turn_deg(turn)
            # Anticlockwise from east.
            return ClickedGoal(position, None if turn_deg is None else (90.0 - turn_deg) % 360.0)
        case "local_ned":
            turn_deg = None if turn is None else _turn_deg(turn)
            # About down, from north.
            at_enu = enu_from_ned(position)
            return ClickedGoal(at_enu, None if turn_deg is None else turn_deg % 360.0)
        case _:
            raise BadMessageError(
                f"a goal must be in the frame 'map', not in {frame[:FRAME_NAME_BYTES]!r}: "
                "choose it as the 3D panel's display frame"
            )


def _turn_deg(q: _Quaternion) -> float | None:
    """About the frame's z axis, from its x axis; None where it tells no direction."""
    values = (q.x, q.y, q.z, q.w)
    if not all(map(math.isfinite, values)):
        return None
    if sum(value * value for value in values) < LEVEL_QUATERNION_SQUARED:
        return None
    turn_rad = math.atan2(2.0 * (q.w * q.z + q.x * q.y), 1.0 - 2.0 * (q.y * q.y + q.z * q.z))
    return math.degrees(turn_rad)
