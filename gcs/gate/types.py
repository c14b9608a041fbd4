"""What goes into the gate, what comes out of it, and the words that both are told in.

The gate is `handle(input, now_ns) -> list[Effect]`.  Inputs and effects are closed unions of
frozen dataclasses (`Input`, `Effect` at the end of each section); whoever matches them does
so exhaustively.  Positions are metres and velocities metres per second in the vehicle's local
NED frame (MAV_FRAME_LOCAL_NED), times integer nanoseconds of the one clock that is passed in.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum, IntEnum, StrEnum
from typing import TYPE_CHECKING, TypeAlias

from gcs.frames import Vec3
from gcs.gate.permit import Permit

if TYPE_CHECKING:
    from gcs.gate.verifier import Verifier


class State(IntEnum):
    """Where the machine is.  The lab's three keep the lab's names and numbers."""

    HOVERING = 1
    VERIFYING = 2
    MOVING = 3
    NO_VEHICLE = 4
    STALE = 5
    GROUNDED = 6
    TAKING_OFF = 7
    STREAMING = 8
    TAKING_PICTURE = 9
    FLYING_MISSION = 10
    RETURNING = 11
    LANDING = 12
    HOLDING = 13
    EXTERNAL = 14


class Severity(IntEnum):
    """How bad it is.  Ordered: of all active conditions the worst wins."""

    NOMINAL = 0
    CAUTION = 1
    HOLD = 2
    RETURN = 3
    LAND = 4
    TERMINATE = 5


class Control(IntEnum):
    """Who flies.  TAKING: we stream the hold goal and wait for the heartbeat to confirm."""

    NONE = 0
    TAKING = 1
    OURS = 2


class Condition(StrEnum):
    """What can be wrong, each mapped to a severity by the policy."""

    RECORDER_FAILED = "recorder_failed"
    BATTERY_LOW = "battery_low"
    BATTERY_CRITICAL = "battery_critical"
    ORIGIN_MISMATCH = "origin_mismatch"
    ORIGIN_MISSING = "origin_missing"
    OTHER_STATION = "other_station"
    VEHICLE_FAILSAFE_WEAK = "vehicle_failsafe_weak"
    VEHICLE_FAILSAFE_ACTIVE = "vehicle_failsafe_active"
    TICK_LATE = "tick_late"


class FlightMode(StrEnum):
    """What the vehicle's mode means to the gate, whatever the autopilot calls it."""

    GUIDED = "guided"  # px4 OFFBOARD, ardupilot GUIDED
    HOLD = "hold"  # px4 AUTO.LOITER, ardupilot BRAKE or LOITER
    TAKEOFF = "takeoff"  # px4 AUTO.TAKEOFF
    MISSION = "mission"  # px4 AUTO.MISSION, ardupilot AUTO
    RETURN = "return"  # px4 AUTO.RTL, ardupilot RTL or SMART_RTL
    LAND = "land"  # px4 AUTO.LAND or AUTO.PRECLAND, ardupilot LAND
    OTHER = "other"  # flown by somebody else


class LandedState(IntEnum):
    """MAV_LANDED_STATE, with the same numbers."""

    UNDEFINED = 0
    ON_GROUND = 1
    IN_AIR = 2
    TAKEOFF = 3
    LANDING = 4


class Code(StrEnum):
    """Why a request was refused or ended otherwise than complete."""

    BUSY = "BUSY"
    NO_VEHICLE = "NO_VEHICLE"
    STALE = "STALE"
    NOT_IN_CONTROL = "NOT_IN_CONTROL"
    CONTROL_PENDING = "CONTROL_PENDING"
    NOT_ARMED = "NOT_ARMED"
    NOT_FLYING = "NOT_FLYING"
    ALREADY_FLYING = "ALREADY_FLYING"
    HOLDING = "HOLDING"
    NON_FINITE = "NON_FINITE"
    OUTSIDE_FENCE = "OUTSIDE_FENCE"
    INSIDE_EXCLUSION = "INSIDE_EXCLUSION"
    TOO_CLOSE = "TOO_CLOSE"
    TOO_HIGH = "TOO_HIGH"
    TOO_LOW = "TOO_LOW"
    TOO_FAR = "TOO_FAR"
    LEG_LEAVES_FENCE = "LEG_LEAVES_FENCE"
    CANNOT_STOP = "CANNOT_STOP"
    NO_ORIGIN = "NO_ORIGIN"
    RTL_BLOCKED = "RTL_BLOCKED"
    NO_MISSION = "NO_MISSION"
    BAD_MISSION = "BAD_MISSION"
    SEVERITY = "SEVERITY"
    RECORDER_DOWN = "RECORDER_DOWN"
    POLICY = "POLICY"
    IN_AIR = "IN_AIR"
    VEHICLE_REFUSED = "VEHICLE_REFUSED"
    NO_ANSWER = "NO_ANSWER"
    DEADLINE = "DEADLINE"
    OPERATOR = "OPERATOR"
    OPERATOR_LOST = "OPERATOR_LOST"
    FENCE_BREACH = "FENCE_BREACH"
    ESTIMATOR_RESET = "ESTIMATOR_RESET"
    HOME_MOVED = "HOME_MOVED"
    MODE_CHANGED = "MODE_CHANGED"
    SUPERSEDED = "SUPERSEDED"
    LINK_LOST = "LINK_LOST"


@dataclass(frozen=True, slots=True)
class Refusal:
    """Why not: a code for programs, a sentence for people, the numbers it was decided on."""

    code: Code
    sentence: str
    numbers: tuple[tuple[str, float], ...] = ()
    zone: str = ""


# --------------------------------------------------------------------------- requests


@dataclass(frozen=True, slots=True)
class GoTo:
    """Fly straight to `goal_ned` and hover; `yaw_rad` None leaves heading to the autopilot."""

    goal_ned: Vec3
    yaw_rad: float | None = None


@dataclass(frozen=True, slots=True)
class TakeControl:
    """Verify the present position as the hold goal, stream it, ask for OFFBOARD / GUIDED."""


@dataclass(frozen=True, slots=True)
class Arm:
    pass


@dataclass(frozen=True, slots=True)
class Disarm:
    force: bool = False


@dataclass(frozen=True, slots=True)
class TakeOff:
    """Climb to `up_m` metres above the take-off point, then take control and hover."""

    up_m: float


@dataclass(frozen=True, slots=True)
class Land:
    pass


@dataclass(frozen=True, slots=True)
class ReturnHome:
    pass


@dataclass(frozen=True, slots=True)
class Hold:
    pass


@dataclass(frozen=True, slots=True)
class Abort:
    """Hold now, forget the goal; on the ground: disarm if armed."""


@dataclass(frozen=True, slots=True)
class Resume:
    """Leave HOLDING (or EXTERNAL) for HOVERING at the present position."""


@dataclass(frozen=True, slots=True)
class TakePhoto:
    pass


@dataclass(frozen=True, slots=True)
class StartMission:
    pass


@dataclass(frozen=True, slots=True)
class SetMode:
    """A mode by the autopilot's own name; motion modes map to the request they mean."""

    name: str
    meaning: FlightMode


@dataclass(frozen=True, slots=True)
class SwitchFence:
    """The lab's cage switch; refused under any policy that does not allow it."""

    on: bool


Wish: TypeAlias = (
    GoTo
    | TakeControl
    | Arm
    | Disarm
    | TakeOff
    | Land
    | ReturnHome
    | Hold
    | Abort
    | Resume
    | TakePhoto
    | StartMission
    | SetMode
    | SwitchFence
)


# ----------------------------------------------------------------------------- inputs


@dataclass(frozen=True, slots=True)
class Request:
    """Somebody wants something.  `request_id` is unique in a session; `source` names who."""

    request_id: int
    source: str
    wish: Wish


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
class GeodeticSeen:
    """GPS_GLOBAL_ORIGIN, once known: lets geographic fences and goals be judged."""

    lat_deg: float
    lon_deg: float
    alt_amsl_m: float


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
    """Home, origin, fence or personality became known or changed.

    Without a verifier nothing that moves is accepted.  It also tells the personality.
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
    Request
    | HeartbeatSeen
    | LandedSeen
    | PositionSeen
    | GeodeticSeen
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


# ---------------------------------------------------------------------------- effects


class CommandKind(Enum):
    """What the gate may ask the vehicle to do, apart from setpoints."""

    HOLD = "hold"
    GUIDED = "guided"
    ARM = "arm"
    DISARM = "disarm"
    FORCE_DISARM = "force_disarm"
    TAKE_OFF = "take_off"
    LAND = "land"
    RETURN = "return"
    PHOTO = "photo"
    START_MISSION = "start_mission"
    SET_MODE = "set_mode"


@dataclass(frozen=True, slots=True)
class SendSetpoint:
    """SET_POSITION_TARGET_LOCAL_NED, position (and yaw) only.  The permit carries the values."""

    permit: Permit


@dataclass(frozen=True, slots=True)
class SendCommand:
    """Ask the vehicle.  No try may leave after `deadline_ns` (invariant 9).

    `permit` is required for the kinds that set the vehicle in motion (TAKE_OFF, LAND, RETURN,
    START_MISSION, GUIDED, SET_MODE, ARM); HOLD, DISARM and PHOTO go without.
    `request_id` 0 is the gate's own: nobody asked for it.
    """

    request_id: int
    kind: CommandKind
    deadline_ns: int
    permit: Permit | None = None
    up_m: float = 0.0  # TAKE_OFF: metres above the take-off point
    mode_name: str = ""  # SET_MODE


@dataclass(frozen=True, slots=True)
class CancelCommand:
    """No further try of that command may leave, and its answer no longer matters."""

    request_id: int
    kind: CommandKind


@dataclass(frozen=True, slots=True)
class SwitchedFence:
    """The fence is now on or off; a `VerifierChanged` that knows so is due at once."""

    on: bool


class Outcome(StrEnum):
    ACCEPTED = "accepted"
    REFUSED = "refused"
    SUPERSEDED = "superseded"


@dataclass(frozen=True, slots=True)
class Verdict:
    """Exactly one for every request.  `evidence` holds the numbers, accepted or not."""

    request_id: int
    source: str
    wish: Wish
    outcome: Outcome
    refusal: Refusal | None
    active_goal_ned: Vec3 | None
    evidence: tuple[tuple[str, float], ...] = ()


class Ended(StrEnum):
    COMPLETE = "complete"
    ABORTED = "aborted"
    SUPERSEDED = "superseded"
    TIMED_OUT = "timed out"
    TAKEN_OVER = "taken over"


@dataclass(frozen=True, slots=True)
class Ending:
    """Exactly one for every accepted request."""

    request_id: int
    ended: Ended
    code: Code | None
    sentence: str


@dataclass(frozen=True, slots=True)
class Transition:
    """The machine went from `before` to `after` because of `event` (a name of the table)."""

    before: State
    after: State
    event: str
    control: Control
    severity: Severity


class Level(IntEnum):
    """foxglove.Log levels, and the lab's five."""

    DEBUG = 1
    INFO = 2
    WARNING = 3
    ERROR = 4
    FATAL = 5


@dataclass(frozen=True, slots=True)
class Say:
    """A line for the operator and the log; the node name is the gate's."""

    level: Level
    text: str


Effect: TypeAlias = (
    SendSetpoint | SendCommand | CancelCommand | SwitchedFence | Verdict | Ending | Transition | Say
)
