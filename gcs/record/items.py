"""Everything that can be recorded, as a closed union; what each becomes is `derived.py`'s affair.

The session hands these out as effects, with values as MAVLink has them (NED, radians, metres);
turning them into Foxglove's schemas and limiting their rates happens behind this line.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import IntEnum
from typing import TypeAlias

from gcs.frames import Vec3

Quat = tuple[float, float, float, float]
"""w, x, y, z as MAVLink orders it."""


class Direction(IntEnum):
    """What happened to a frame at one crossing of one link."""

    RECEIVED = 0
    SENT = 1
    REFUSED = 2


@dataclass(frozen=True, slots=True)
class FrameItem:
    """One whole MAVLink 1 or 2 frame, magic to signature, as it was on the wire."""

    link: int
    direction: Direction
    raw: bytes


@dataclass(frozen=True, slots=True)
class GarbageItem:
    """Bytes that were no frame (`reason` says why: crc, garbage, oversize, truncated, text)."""

    link: int
    raw: bytes
    reason: str


@dataclass(frozen=True, slots=True)
class InputItem:
    """Whatever else reached `handle`, as JSON: ticks, commands, link events, policy, seed."""

    kind: str
    json: bytes


@dataclass(frozen=True, slots=True)
class PoseItem:
    """Attitude and position of vehicle `sysid`: `q_ned_from_frd` rotates body FRD to local NED."""

    sysid: int
    pos_ned: Vec3
    v_ned: Vec3
    q_ned_from_frd: Quat


@dataclass(frozen=True, slots=True)
class GeodeticItem:
    """GLOBAL_POSITION_INT: degrees, metres above mean sea level and above home."""

    sysid: int
    lat_deg: float
    lon_deg: float
    alt_amsl_m: float
    alt_rel_m: float


@dataclass(frozen=True, slots=True)
class StatusItem:
    """What a state plot wants: battery, mode, landed state, link quality."""

    sysid: int
    armed: bool
    mode: str
    landed: str
    battery_pct: float | None
    battery_v: float | None
    rx_hz: float
    lost_pct: float


@dataclass(frozen=True, slots=True)
class SetpointItem:
    """The position setpoint that was just put on the wire."""

    sysid: int
    pos_ned: Vec3
    yaw_rad: float | None


@dataclass(frozen=True, slots=True)
class FsaItem:
    """The gate's state, after a transition or as a reminder."""

    sysid: int
    state: int
    state_name: str
    before_name: str
    event: str
    control: str
    severity: str
    active_goal_ned: Vec3 | None


@dataclass(frozen=True, slots=True)
class DecisionItem:
    """A verdict or an ending of one request; `phase` is "verdict" or "ending"."""

    sysid: int
    request_id: int
    source: str
    word: str
    phase: str
    outcome: str
    code: str
    sentence: str
    zone: str
    goal_ned: Vec3 | None
    numbers: tuple[tuple[str, float], ...]


@dataclass(frozen=True, slots=True)
class ZoneItem:
    """One zone of the fence in the local tangent plane; heights in metres up of the origin."""

    name: str
    inclusion: bool
    corners_en: tuple[tuple[float, float], ...]
    centre_en: tuple[float, float] | None
    radius_m: float
    floor_up_m: float
    ceiling_up_m: float


@dataclass(frozen=True, slots=True)
class FenceItem:
    """The whole fence as the verifier sees it, and the origin it stands on (None: not known)."""

    zones: tuple[ZoneItem, ...]
    origin: tuple[float, float, float] | None


@dataclass(frozen=True, slots=True)
class MissionItem:
    """The path of the mission on board, local NED."""

    name: str
    path_ned: tuple[Vec3, ...]


@dataclass(frozen=True, slots=True)
class ParamItem:
    """A parameter of the vehicle, when it becomes known and when it changes."""

    sysid: int
    name: str
    value: float


@dataclass(frozen=True, slots=True)
class LogItem:
    """A line of anybody's: `node` is the part's name, `level` 1 debug .. 5 fatal."""

    level: int
    node: str
    text: str


@dataclass(frozen=True, slots=True)
class AttachmentItem:
    """A file that belongs to the flight: mission, fence, policy, parameters."""

    name: str
    media_type: str
    data: bytes


@dataclass(frozen=True, slots=True)
class MetadataItem:
    """Versions, endpoints, policy, seed."""

    name: str
    values: tuple[tuple[str, str], ...]


RecordItem: TypeAlias = (
    FrameItem
    | GarbageItem
    | InputItem
    | PoseItem
    | GeodeticItem
    | StatusItem
    | SetpointItem
    | FsaItem
    | DecisionItem
    | FenceItem
    | MissionItem
    | ParamItem
    | LogItem
    | AttachmentItem
    | MetadataItem
)
