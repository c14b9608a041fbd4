"""The words that the table is written in: guards, checks, actions, and the branch they make.

Nothing here decides or does anything.  `guards.py` says when a `Guard` holds and what a
`Check` objects, `actions.py` what a `Do` does; both are total over these enumerations, which
a test asserts.  The values are what the printed table says.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum, StrEnum
from typing import Final, TypeAlias

from gcs.gate.effects import OutcomeKind
from gcs.gate.refusal import Code
from gcs.gate.states import State


class Guard(StrEnum):
    """A question about the gate's memory, without side effects."""

    HEARD_ONCE = "a vehicle was heard before"
    AIRBORNE = "it flies"
    NOT_AIRBORNE = "it is not known to fly"
    ON_GROUND = "it stands on the ground"
    ARMED = "it is armed"
    DISARMED = "it is disarmed"
    STANDS = "it stands, and no take-off can be under way"
    SAFE = "it is disarmed and nothing is under way"
    LIFTED = "it had lifted off"
    LATE_TAKE_OFF = "our own take-off comes late"
    OURS = "we have control"
    TAKING = "control is being taken"
    TASK = "a request is under way"
    TASK_IS_ARM = "the request is to arm"
    TASK_WANTS_MODE = "the request waited for this mode"
    TASK_WANTS_HOLD = "the request is to hold or abort"
    TASK_HAS_LANDED = "the request is to come down, and it stands"
    TASK_ENDS_DISARMED = "the request ends when disarmed"
    MISSION_GOES_ON = "the mission lifts off again"
    PENDING = "a goal is pending"
    ACTIVE_GOAL = "a goal is being flown"
    ARRIVED = "it arrived"
    AT_HEIGHT = "it reached the height"
    CLIMB_SHORT = "the climb ended elsewhere"
    CLIMBS_ON = "it climbs above the height"
    FLIES_ON = "a position too old interrupted its flight"
    OPERATOR_GONE = "the operator is lost"
    HERE_CLEARS = "the present position clears"
    PATH_CLEARS = "the return path clears"
    RTL_FORWARD = "policy forwards blocked returns"
    RTL_LAND = "policy lands on blocked returns"
    RETARGET = "policy lets the goal's owner replace it"
    FENCE_SWITCHABLE = "policy lets the fence be switched"
    FORCE_FORBIDDEN = "policy forbids disarming in the air"
    FORCE_UNCONFIRMED = "it was asked for only once"
    SEVERITY_PERMITS = "severity permits motion"
    SEVERITY_RETURNS = "severity demands return or landing"
    HOLD_AWAITED = "hold is commanded and not shown yet"
    MODE_PENDING = "a commanded mode is not shown yet"
    MODE_NATURAL = "the mode belongs to the state"
    MODE_GUIDED = "the mode is guided"
    MODE_RETURN = "the mode is return"
    MODE_LAND = "the mode is land"
    GUIDED_LATE = "our own guided command comes late"
    MISSION_OVER = "the mission reached its last item"
    IN_GRACE = "a verified stream is in its grace"
    GRACE_OVER = "the grace is over"
    RETURNS_TO_STATE = "it was interrupted in flight"
    PHOTO_OK = "the picture was taken"


class Check(StrEnum):
    """A condition of acceptance; where it fails it says why, and that refuses the request."""

    SEVERITY = "severity permits motion"
    RECORDER = "the recorder runs where policy asks for it"
    ARMED = "it is armed"
    ON_GROUND = "it stands on the ground"
    HERE = "the present position clears"
    TAKE_OFF = "the climb clears"
    MISSION = "a verified mission is on board"
    VERIFIER = "home and fence are known"


class Do(StrEnum):
    """An action: effects, and what the gate remembers."""

    VERIFY = "verify the pending goal"
    FLY_GOAL = "accept the goal and fly it"
    DROP_GOAL = "refuse the goal"
    KEEP_GOAL = "hold at the goal"
    TAKE_CONTROL = "stream the present position"
    ASK_GUIDED = "command guided"
    GAIN_CONTROL = "control is ours"
    RELEASE = "let control go"
    ARM = "command arm"
    DISARM = "command disarm"
    FORCE_DISARM = "command forced disarm"
    TAKE_OFF = "command take-off"
    CONTINUE = "send the command that waited"
    LAND = "command land"
    RETURN = "command return"
    HOLD = "command hold"
    HOLD_ONCE = "command hold once"
    HOLD_BLIND = "command hold unseen"
    REPEAT_HOLD = "command hold again"
    HOLD_SHOWN = "hold is confirmed"
    MODE_SETTLED = "no mode is awaited any more"
    HOLD_ANEW = "verify the held point anew"
    BRAKE = "send the brake setpoint"
    PHOTO = "command photo"
    START_MISSION = "command mission start"
    SWITCH_FENCE = "switch the fence"
    START_GRACE = "keep the verified stream for its grace"
    LET_GO = "stop the stream"
    FORGET_VEHICLE = "forget the vehicle"
    FORGET_INTERRUPTED = "forget what was interrupted"
    AWAIT_DISARM = "wait shortly for disarm"
    NOTE_LIFTED = "note the lift-off"
    NOTE_FORCE = "note the first asking"


class Answer(Enum):
    """What a request gets when it is not refused."""

    NONE = "none"
    TASK = "accepted"
    DONE = "accepted, complete at once"
    PENDING = "pending until the tick"


class Elsewhere(Enum):
    """Next states that are not one state by name."""

    STAY = "stay"
    BACK = "back"


STAY: Final = Elsewhere.STAY
BACK: Final = Elsewhere.BACK

BACK_STATES: Final = (
    State.TAKING_OFF,
    State.HOVERING,
    State.MOVING,
    State.STREAMING,
    State.TAKING_PICTURE,
    State.FLYING_MISSION,
    State.HOLDING,
)
"""Where STALE may lead back to: the states that a position too old interrupts in flight."""

Next: TypeAlias = State | Elsewhere


@dataclass(frozen=True, slots=True)
class End:
    """How the request under way ends; a goal still pending is refused with the same code.

    `judged`: the code is that of the refusal which led here.
    """

    kind: OutcomeKind
    code: Code | None = None
    judged: bool = False


@dataclass(frozen=True, slots=True)
class Branch:
    """One line of a cell.  The first branch whose guards all hold is taken.

    Its checks are then asked in order; the first that objects refuses the request and nothing
    else of the branch happens.  `refuse` refuses outright (`do` and `to` still happen: a
    blocked return holds).  Otherwise the request is answered, the task ends as `ends` says
    (an accepted request that displaces one, and says nothing, supersedes it), the actions run
    in order, and the state becomes `to`.
    """

    when: tuple[Guard, ...] = ()
    needs: tuple[Check, ...] = ()
    refuse: Code | None = None
    answer: Answer = Answer.NONE
    ends: End | None = None
    do: tuple[Do, ...] = ()
    to: Next = STAY


Cell: TypeAlias = tuple[Branch, ...]
"""Branches in order; the last one has no guard.  An empty cell cannot happen: entering it is
a bug of the gate's own."""

Row: TypeAlias = tuple[
    Cell, Cell, Cell, Cell, Cell, Cell, Cell, Cell, Cell, Cell, Cell, Cell, Cell, Cell
]
"""One event's cells, in the order of `COLUMNS`."""

COLUMNS: Final = (
    State.NO_VEHICLE,
    State.STALE,
    State.GROUNDED,
    State.TAKING_OFF,
    State.HOVERING,
    State.VERIFYING,
    State.MOVING,
    State.STREAMING,
    State.TAKING_PICTURE,
    State.FLYING_MISSION,
    State.RETURNING,
    State.LANDING,
    State.HOLDING,
    State.EXTERNAL,
)
