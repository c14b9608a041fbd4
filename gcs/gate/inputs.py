"""The inputs of the gate, as a closed union of frozen dataclasses.

Positions are metres and velocities metres per second in the vehicle's local NED frame
(MAV_FRAME_LOCAL_NED).  The time of arrival is not part of an input: it is the `now_ns` that is
passed to `Gate.handle`.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeAlias

from gcs.frames import Vec3
from gcs.gate.airspace.mission_box import MissionBox
from gcs.gate.airspace.return_place import ReturnPlace
from gcs.gate.airspace.verifier import Verifier
from gcs.gate.attitude import Attitude
from gcs.gate.condition import Condition
from gcs.gate.effects import CommandKind
from gcs.gate.requests import Request
from gcs.gate.states import FlightMode, LandedState


@dataclass(frozen=True, slots=True)
class Requested:
    """A request by a client.  `request_id` is unique in a session; `source` names the client."""

    request_id: int
    source: str
    request: Request


@dataclass(frozen=True, slots=True)
class StreamSeen:
    """One sample of a client's setpoint stream; `source` names the client.

    Position, velocity (m/s) and acceleration (m/s^2) are local NED; None is what the sample does
    not ask for, and at least one of the three is asked for, or an attitude.
    """

    source: str
    pos_ned: Vec3 | None
    v_ned: Vec3 | None
    a_ned: Vec3 | None
    yaw_rad: float | None
    yaw_rate_rad_s: float | None
    attitude: Attitude | None = None


@dataclass(frozen=True, slots=True)
class HeartbeatSeen:
    """HEARTBEAT of the vehicle.  `mode_name` is the autopilot's own name of the mode; `failsafe`
    says that a failsafe of the vehicle's own is active (MAV_STATE CRITICAL or EMERGENCY)."""

    armed: bool
    mode: FlightMode
    mode_name: str
    failsafe: bool = False


@dataclass(frozen=True, slots=True)
class MessageSeen:
    """Any message of the vehicle's autopilot: a sign of life."""


@dataclass(frozen=True, slots=True)
class LandedSeen:
    """EXTENDED_SYS_STATE.landed_state."""

    landed: LandedState


@dataclass(frozen=True, slots=True)
class PositionSeen:
    """LOCAL_POSITION_NED.  `time_boot_ms` is the vehicle's own time stamp.

    `reset` says that the vehicle's clock went backwards or that one of its reset counters
    changed: the origin of the local frame may have moved.  `late_s` is how old the position was
    when it came: as late is what is sent now.  `yaw_rad` is where the nose pointed, clockwise from
    north, by the last ATTITUDE; None where the vehicle has told none of late.
    """

    pos_ned: Vec3
    v_ned: Vec3
    time_boot_ms: int
    reset: bool = False
    late_s: float = 0.0
    yaw_rad: float | None = None


@dataclass(frozen=True, slots=True)
class HomeSeen:
    """HOME_POSITION in the local frame: a return ends there, and the default fence surrounds it."""

    pos_ned: Vec3


@dataclass(frozen=True, slots=True)
class ReturnHeightSeen:
    """The vehicle's return height in metres above home (px4 RTL_RETURN_ALT, ardupilot RTL_ALT)."""

    up_m: float


@dataclass(frozen=True, slots=True)
class ReturnPlacesSeen:
    """Where else than at home the vehicle's own return may end, such as at its rally points; an
    empty tuple: nowhere else.  None where that is not known, or no straight way leads there:
    `unknown` says why.

    Until the first one no return is accepted.
    """

    places: tuple[ReturnPlace, ...] | None
    unknown: str = ""


@dataclass(frozen=True, slots=True)
class AccuracySeen:
    """How well the vehicle knows where it is, horizontally, and how near a waypoint it takes it as
    reached itself (px4 NAV_ACC_RAD, ardupilot WP_RADIUS_M); metres, None: it does not say."""

    accuracy_h_m: float | None
    acceptance_m: float | None


@dataclass(frozen=True, slots=True)
class ClimbEndSeen:
    """How near the height of its take-off, in metres, the vehicle itself takes the climb to be
    over (px4 NAV_MC_ALT_RAD): it may end that far below."""

    within_m: float


@dataclass(frozen=True, slots=True)
class VerifierChanged:
    """Home, origin, fence or autopilot became known or changed.

    Until the first one no request that moves the vehicle is accepted.
    """

    verifier: Verifier


@dataclass(frozen=True, slots=True)
class CommandEnded:
    """A command of ours was answered with `result` (MAV_RESULT); None: not answered in time."""

    request_id: int
    kind: CommandKind
    result: int | None
    text: str = ""


@dataclass(frozen=True, slots=True)
class PhotoSeen:
    """CAMERA_IMAGE_CAPTURED or CAMERA_FEEDBACK.  `index` is the vehicle's number of the picture."""

    index: int
    ok: bool


@dataclass(frozen=True, slots=True)
class MissionLoaded:
    """A mission was verified whole, uploaded, and read back equal; `items` 0: no such mission is
    on board, and one that is flown is held."""

    name: str
    items: int


@dataclass(frozen=True, slots=True)
class MissionPathVerified:
    """The mission on board was verified from where the vehicle is; its start may be asked for now.

    `within` is a box round all of that path.
    """

    within: MissionBox


@dataclass(frozen=True, slots=True)
class MissionSeen:
    """Progress of the mission: it is at item `seq` of `total`; `finished` after the last one."""

    seq: int
    total: int
    finished: bool


@dataclass(frozen=True, slots=True)
class ConditionChanged:
    """A condition became active, or is over; `text` has its details."""

    condition: Condition
    active: bool
    text: str = ""


@dataclass(frozen=True, slots=True)
class OperatorLost:
    """The operator left, or is not connected any more.  Where we control a flying vehicle, the
    gate holds it.

    `for_good`: nobody comes after it, and only what stops the vehicle is accepted from then on.
    """

    reason: str
    for_good: bool = True


@dataclass(frozen=True, slots=True)
class Tick:
    """The 20 Hz tick.  Ticks lie on an absolute grid; `lateness_ns` is how late this one came."""

    lateness_ns: int


Input: TypeAlias = (
    Requested
    | StreamSeen
    | HeartbeatSeen
    | MessageSeen
    | LandedSeen
    | PositionSeen
    | HomeSeen
    | ReturnHeightSeen
    | ReturnPlacesSeen
    | AccuracySeen
    | ClimbEndSeen
    | VerifierChanged
    | CommandEnded
    | PhotoSeen
    | MissionLoaded
    | MissionPathVerified
    | MissionSeen
    | ConditionChanged
    | OperatorLost
    | Tick
)
