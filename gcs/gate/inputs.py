"""Everything that reaches the gate, as a closed union of frozen dataclasses.

Positions are metres and velocities metres per second in the vehicle's local NED frame
(MAV_FRAME_LOCAL_NED), times integer nanoseconds of the one clock that is passed in.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeAlias

from gcs.frames import Vec3
from gcs.gate.airspace.verifier import Verifier
from gcs.gate.condition import Condition
from gcs.gate.effects import CommandKind
from gcs.gate.requests import Request
from gcs.gate.states import FlightMode, LandedState


@dataclass(frozen=True, slots=True)
class Requested:
    """Somebody wants something.  `request_id` is unique in a session; `source` names who."""

    request_id: int
    source: str
    request: Request


@dataclass(frozen=True, slots=True)
class HeartbeatSeen:
    """HEARTBEAT of the vehicle."""

    armed: bool
    mode: FlightMode
    mode_name: str


@dataclass(frozen=True, slots=True)
class LandedSeen:
    """EXTENDED_SYS_STATE.landed_state."""

    landed: LandedState


@dataclass(frozen=True, slots=True)
class PositionSeen:
    """LOCAL_POSITION_NED.  `time_boot_ms` is the vehicle's own stamp; arrival is `now_ns`.

    `reset` is set by the session when the vehicle's clock went backwards or a reset counter
    jumped: the frame may have moved under us.
    """

    pos_ned: Vec3
    v_ned: Vec3
    time_boot_ms: int
    reset: bool = False


@dataclass(frozen=True, slots=True)
class HomeSeen:
    """HOME_POSITION in the local frame: where returns end and where the default fence stands."""

    pos_ned: Vec3


@dataclass(frozen=True, slots=True)
class ReturnHeightSeen:
    """The vehicle's own return height (px4 RTL_RETURN_ALT, ardupilot RTL_ALT), above home."""

    up_m: float


@dataclass(frozen=True, slots=True)
class VerifierChanged:
    """Home, origin, fence or autopilot became known or changed.

    Without a verifier nothing that moves is accepted.  It also tells the autopilot.
    """

    verifier: Verifier


@dataclass(frozen=True, slots=True)
class CommandEnded:
    """A command of ours was answered for good (`result` = MAV_RESULT), or never (`result` None)."""

    request_id: int
    kind: CommandKind
    result: int | None
    text: str = ""


@dataclass(frozen=True, slots=True)
class PhotoSeen:
    """CAMERA_IMAGE_CAPTURED (263) or CAMERA_FEEDBACK (180)."""

    index: int
    ok: bool


@dataclass(frozen=True, slots=True)
class MissionLoaded:
    """A mission was verified whole, uploaded and read back equal (or `items` = 0: none is)."""

    name: str
    items: int


@dataclass(frozen=True, slots=True)
class MissionSeen:
    """Progress of the mission that flies: item `seq` of `total`; `finished` after the last."""

    seq: int
    total: int
    finished: bool


@dataclass(frozen=True, slots=True)
class ConditionChanged:
    condition: Condition
    active: bool
    text: str = ""


@dataclass(frozen=True, slots=True)
class OperatorLost:
    """The command stream ended, or the operator leaves: hold where we control a flying vehicle."""

    reason: str


@dataclass(frozen=True, slots=True)
class Tick:
    """The 20 Hz tick, on the absolute grid.  `lateness_ns` is how late the shell was."""

    lateness_ns: int


Input: TypeAlias = (
    Requested
    | HeartbeatSeen
    | LandedSeen
    | PositionSeen
    | HomeSeen
    | ReturnHeightSeen
    | VerifierChanged
    | CommandEnded
    | PhotoSeen
    | MissionLoaded
    | MissionSeen
    | ConditionChanged
    | OperatorLost
    | Tick
)
