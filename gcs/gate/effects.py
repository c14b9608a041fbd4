"""Everything that the gate answers with, as a closed union of frozen dataclasses.

Whoever matches effects does so exhaustively.  Only `SendSetpoint` and `SendCommand` reach the
vehicle, and what moves it carries a `Permit`.
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


class Ruling(StrEnum):
    ACCEPTED = "accepted"
    REFUSED = "refused"
    SUPERSEDED = "superseded"


@dataclass(frozen=True, slots=True)
class Verdict:
    """Exactly one for every request.  `evidence` holds the numbers, accepted or not."""

    request_id: int
    source: str
    request: Request
    ruling: Ruling
    refusal: Refusal | None
    active_goal_ned: Vec3 | None
    evidence: tuple[tuple[str, float], ...] = ()


class OutcomeKind(StrEnum):
    COMPLETE = "complete"
    ABORTED = "aborted"
    SUPERSEDED = "superseded"
    TIMED_OUT = "timed out"
    TAKEN_OVER = "taken over"


@dataclass(frozen=True, slots=True)
class Outcome:
    """Exactly one for every accepted request."""

    request_id: int
    kind: OutcomeKind
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
    SendSetpoint
    | SendCommand
    | CancelCommand
    | SwitchedFence
    | Verdict
    | Outcome
    | Transition
    | Say
)
