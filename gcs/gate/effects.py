"""The effects: what `Gate.handle` returns, as a closed union of frozen dataclasses.

Code that matches effects does so exhaustively.  Only `SendSetpoint` and `SendCommand` reach the
vehicle, and those that move it carry a `Permit`.  Positions are metres in the vehicle's local NED
frame.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum, IntEnum, StrEnum
from typing import TypeAlias

from gcs.frames import Vec3
from gcs.gate.condition import Severity
from gcs.gate.permit import Permit
from gcs.gate.refusal import Code, Refusal
from gcs.gate.requests import Request
from gcs.gate.states import Control, State


class CommandKind(Enum):
    """The commands that the gate sends to the vehicle, apart from setpoints."""

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
    """Send SET_POSITION_TARGET_LOCAL_NED with what the permit has: position, velocity,
    acceleration, yaw, yaw rate; or SET_ATTITUDE_TARGET, where it has an attitude."""

    permit: Permit


@dataclass(frozen=True, slots=True)
class SendCommand:
    """Send a command.  Until it is answered it may be sent again, but never after `deadline_ns`.

    A command whose late effect is dangerous must not be sent after its deadline (invariant 9).
    The kinds that set the vehicle in motion (TAKE_OFF, LAND, RETURN, START_MISSION, GUIDED,
    SET_MODE, ARM) need a `permit`; the others go without.  `request_id` 0 is a command of the
    gate's own, without a request.
    """

    request_id: int
    kind: CommandKind
    deadline_ns: int
    permit: Permit | None = None
    up_m: float = 0.0  # TAKE_OFF: metres above the take-off point
    mode_name: str = ""  # SET_MODE
    seq: int | None = None  # START_MISSION: the item to begin at; None: the first


@dataclass(frozen=True, slots=True)
class CancelCommand:
    """Do not send that command again; its answer no longer matters."""

    request_id: int
    kind: CommandKind


@dataclass(frozen=True, slots=True)
class SwitchedFence:
    """The fence was switched on or off: a `VerifierChanged` with that fence must follow at once."""

    on: bool


class Ruling(StrEnum):
    """What a verdict says.  SUPERSEDED: a newer request replaced this one before its verdict."""

    ACCEPTED = "accepted"
    REFUSED = "refused"
    SUPERSEDED = "superseded"


@dataclass(frozen=True, slots=True)
class Verdict:
    """The gate's decision on a request: exactly one for each.

    `refusal` is None where the request is accepted.  `evidence` has the numbers that were decided
    on, in either case.  `active_goal_ned` is the position that is flown to or held meanwhile.
    """

    request_id: int
    source: str
    request: Request
    ruling: Ruling
    refusal: Refusal | None
    active_goal_ned: Vec3 | None
    evidence: tuple[tuple[str, float], ...] = ()


@dataclass(frozen=True, slots=True)
class StreamVerdict:
    """The samples of the setpoint stream of `source` are refused from now on, and why; None: they
    are flown from now on.  Not told of every sample, only where that changes."""

    source: str
    refusal: Refusal | None
    evidence: tuple[tuple[str, float], ...] = ()


class OutcomeKind(StrEnum):
    """How an accepted request ended.

    TAKEN_OVER: the vehicle, or somebody else, did something other than what was requested.
    """

    COMPLETE = "complete"
    ABORTED = "aborted"
    SUPERSEDED = "superseded"
    TIMED_OUT = "timed out"
    TAKEN_OVER = "taken over"


@dataclass(frozen=True, slots=True)
class Outcome:
    """How an accepted request ended, and why: exactly one for each.  `code` is None if COMPLETE;
    `numbers` are what it came to, such as a picture's number."""

    request_id: int
    kind: OutcomeKind
    code: Code | None
    sentence: str
    numbers: tuple[tuple[str, float], ...] = ()


@dataclass(frozen=True, slots=True)
class Transition:
    """The state changed from `before` to `after` because of `event`, as the table names it."""

    before: State
    after: State
    event: str
    control: Control
    severity: Severity


class Level(IntEnum):
    """How important a log line is, with the numbers of foxglove.Log and of the lab's levels."""

    DEBUG = 1
    INFO = 2
    WARNING = 3
    ERROR = 4
    FATAL = 5


@dataclass(frozen=True, slots=True)
class Say:
    """A line for the operator and the log."""

    level: Level
    text: str


Effect: TypeAlias = (
    SendSetpoint
    | SendCommand
    | CancelCommand
    | SwitchedFence
    | Verdict
    | StreamVerdict
    | Outcome
    | Transition
    | Say
)
