"""What a session reports: one struct a fact, made once, for the record and for the operator.

The session makes these, `gcs/record` writes them into the MCAP.  `LogEvent` and `FenceShape` go
to the operator as they are; for the other facts that the operator is told, `gcs/ipc.py` has the
shorter line that goes through the pipe, and `gcs/session/announcements.py` makes that line.

Positions that come from the vehicle or go to it are as MAVLink has them (NED, metres, radians);
what a person reads is in the operator's frame (ENU, metres).  The messages and JSON schemas of
`/gate/decision`, `/vehicle/N/fsa` and `/vehicle/N/param` are the fields of their struct, in their
order (`gcs/record/derived/json_topic.py`): renaming a field renames it in every new record.
"""

from __future__ import annotations

from enum import IntEnum
from pathlib import PurePath
from typing import Literal, TypeAlias

import msgspec

from gcs.frames import Vec3, enu_from_ned

MEDIA_TYPES = {
    ".toml": "application/toml",
    ".json": "application/json",
    ".plan": "application/json",
    ".waypoints": "text/plain",
    ".txt": "text/plain",
}
"""Of the files that belong to a flight, by their suffix."""

Quat = tuple[float, float, float, float]
"""w, x, y, z as MAVLink orders it."""


# --------------------------------------------------------------------------- what came and went


class Direction(IntEnum):
    """What happened to a frame at one crossing of one link."""

    RECEIVED = 0
    SENT = 1
    REFUSED = 2


class FrameItem(msgspec.Struct, frozen=True, gc=False):
    """One whole MAVLink 1 or 2 frame, magic to signature, as it was on the wire."""

    link: int
    direction: Direction
    raw: bytes


class FramesItem(msgspec.Struct, frozen=True, gc=False):
    """Frames that came together and were only passed on, in their order: recorded as so many
    `FrameItem`s, at a fraction of the cost."""

    link: int
    direction: Direction
    raws: tuple[bytes, ...]


class GarbageItem(msgspec.Struct, frozen=True):
    """Bytes that were no frame (`reason` says why: crc, garbage, oversize, truncated, text)."""

    link: int
    raw: bytes
    reason: str


class InputItem(msgspec.Struct, frozen=True):
    """Any other input of the session, as JSON: ticks, commands, link events, policy, seed."""

    kind: str
    data: msgspec.Raw

    @classmethod
    def of(cls, kind: str, value: object) -> InputItem:
        """Raises TypeError where `value` has no JSON."""
        return cls(kind, msgspec.Raw(msgspec.json.encode(value)))


# --------------------------------------------------------------------------------- the vehicle


class PoseItem(msgspec.Struct, frozen=True):
    """Attitude and position of vehicle `sysid`: `q_ned_from_frd` rotates body FRD to local NED."""

    sysid: int
    pos_ned: Vec3
    v_ned: Vec3
    q_ned_from_frd: Quat


class GeodeticItem(msgspec.Struct, frozen=True):
    """GLOBAL_POSITION_INT: degrees, metres above mean sea level and above home."""

    sysid: int
    lat_deg: float
    lon_deg: float
    alt_amsl_m: float
    alt_rel_m: float


class OriginItem(msgspec.Struct, frozen=True):
    """GPS_GLOBAL_ORIGIN: where the local frame of vehicle `sysid` begins; degrees, metres."""

    sysid: int
    lat_deg: float
    lon_deg: float
    alt_amsl_m: float


class StatusItem(msgspec.Struct, frozen=True):
    """Battery, mode, landed state and link quality: once a second, and when a state changes."""

    sysid: int
    armed: bool
    mode: str
    landed: str
    battery_pct: float | None
    battery_v: float | None
    rx_hz: float
    lost_pct: float


class SetpointItem(msgspec.Struct, frozen=True):
    """The position setpoint that was just put on the wire."""

    sysid: int
    pos_ned: Vec3
    yaw_rad: float | None


class StopItem(msgspec.Struct, frozen=True):
    """Where the vehicle would come to rest if it were told to stop now, as the gate predicts it.

    `allowed_m_s`: so fast the law of pace lets it fly on its way to a goal; None: on no such way.
    """

    sysid: int
    pos_ned: Vec3
    stop_ned: Vec3
    allowed_m_s: float | None = None


class LegItem(msgspec.Struct, frozen=True):
    """The leg that is flown, from where the vehicle was to its goal, and so fast the law of pace
    lets it fly at each of the places; without places: no leg is flown any more."""

    sysid: int
    places_ned: tuple[Vec3, ...]
    speeds_m_s: tuple[float, ...]


class ParamItem(msgspec.Struct, frozen=True):
    """A parameter of the vehicle, when it becomes known and when it changes."""

    sysid: int
    name: str
    value: float


# -------------------------------------------------------------------------------- the decisions


class PointEnu(msgspec.Struct, frozen=True):
    """A place in the operator's frame: metres from the local origin."""

    east_m: float
    north_m: float
    up_m: float

    @classmethod
    def of(cls, pos_ned: Vec3) -> PointEnu:
        return cls(*enu_from_ned(pos_ned))

    @property
    def enu(self) -> Vec3:
        return (self.east_m, self.north_m, self.up_m)


class ConditionItem(msgspec.Struct, frozen=True):
    """Something that is wrong: its name, how severe the policy says it is, the reason in words."""

    name: str
    severity: str
    text: str


class FsaItem(msgspec.Struct, frozen=True):
    """The gate's state machine after a transition; `event` "reminder" repeats where it stands.

    `conditions` are what makes up `severity`: of all that is wrong, the worst counts.
    """

    sysid: int
    state: str
    state_id: int
    before: str
    event: str
    control: str
    severity: str
    goal: PointEnu | None
    conditions: tuple[ConditionItem, ...] = ()


class DecisionItem(msgspec.Struct, frozen=True):
    """A verdict on a request, the ending of an accepted one, or a verdict on samples of a stream.

    `outcome` of a verdict: accepted, refused, superseded; of an ending: complete, aborted,
    superseded, timed out, taken over.  `numbers` are what a verdict was decided on.  A stream's
    samples have no request (0); their verdict, accepted or refused, is told where it changes, with
    what the sample asked for, and "ended" where refused ones stop without being flown again.
    """

    vehicle: int
    request_id: int
    source: str
    word: str
    phase: Literal["verdict", "ending", "stream"]
    outcome: str
    code: str
    sentence: str
    zone: str
    goal: PointEnu | None
    numbers: dict[str, float | None]


# ------------------------------------------------------------------------ the fence, the mission


class FenceShape(msgspec.Struct, frozen=True):
    """One zone for drawing: a polygon's corners or a circle, ENU metres; None = no bound."""

    name: str
    inclusion: bool
    corners_en: list[tuple[float, float]] = []
    centre_en: tuple[float, float] | None = None
    radius_m: float = 0.0
    floor_up_m: float | None = None
    ceiling_up_m: float | None = None


class FenceItem(msgspec.Struct, frozen=True):
    """The whole fence as the verifier sees it, and the local origin that it stands on.

    `origin` is latitude and longitude in degrees and metres above mean sea level; None: not known.
    Goals and legs keep the margins, beside and above or below, from every boundary.
    """

    zones: list[FenceShape]
    origin: tuple[float, float, float] | None
    margin_h_m: float = 0.0
    margin_v_m: float = 0.0


class MissionItem(msgspec.Struct, frozen=True):
    """The path of the mission on board of vehicle `sysid`, local NED; none: without a path."""

    sysid: int
    name: str
    path_ned: tuple[Vec3, ...]


# ---------------------------------------------------------------------------- words and files


class LogEvent(msgspec.Struct, frozen=True, tag="log", tag_field="type"):
    """One line of the log: `node` is the part that says it."""

    time_ns: int
    level: int  # 1 debug .. 5 fatal
    node: str
    text: str


class AttachmentItem(msgspec.Struct, frozen=True):
    """A file that belongs to the flight: mission, fence, policy, parameters."""

    name: str
    media_type: str
    data: bytes

    @classmethod
    def of_file(cls, path: str, data: bytes) -> AttachmentItem:
        """Named without its folder, which says more of the machine than of the flight."""
        name = PurePath(path).name
        suffix = PurePath(path).suffix.lower()
        return cls(name, MEDIA_TYPES.get(suffix, "application/octet-stream"), data)

    @classmethod
    def of_json(cls, name: str, value: object) -> AttachmentItem:
        """Raises TypeError where `value` has no JSON."""
        return cls(name, MEDIA_TYPES[".json"], msgspec.json.encode(value))


class MetadataItem(msgspec.Struct, frozen=True):
    """Versions, endpoints, policy, seed."""

    name: str
    values: tuple[tuple[str, str], ...]


RecordItem: TypeAlias = (
    FrameItem
    | FramesItem
    | GarbageItem
    | InputItem
    | PoseItem
    | GeodeticItem
    | OriginItem
    | StatusItem
    | SetpointItem
    | StopItem
    | LegItem
    | ParamItem
    | FsaItem
    | DecisionItem
    | FenceItem
    | MissionItem
    | LogEvent
    | AttachmentItem
    | MetadataItem
)
"""Everything that can be recorded."""
