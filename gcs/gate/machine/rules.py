"""The vocabulary of the table: guards, checks, actions, and the branch that is made of them.

These are names only.  `guards.py` evaluates each `Guard`, `checks.py` each `Check`, and
`actions.py` carries out each `Action`; a test asserts that none is missing there.  The values
are the texts of the printed table (`gcs fsa`).
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum, StrEnum
from typing import Final, TypeAlias

from gcs.gate.effects import OutcomeKind
from gcs.gate.refusal import Code
from gcs.gate.states import State


class Guard(StrEnum):
    """A condition of a branch.  Evaluating it does not change the gate's memory."""

    HEARD_BEFORE = "a vehicle was heard before"
    LOST_IN_FLIGHT = "we flew it when it was heard last"
    NO_POSITION_YET = "it has told no position yet"
    AIRBORNE = "it flies"
    NOT_AIRBORNE = "it is not known to fly"
    ON_GROUND = "it stands on the ground"
    ARMED = "it is armed"
    DISARMED = "it is disarmed"
    SURELY_ON_GROUND = "it stands, and no take-off can be under way"
    DISARMED_AND_IDLE = "it is disarmed and nothing is under way"
    LIFTED_OFF = "it had lifted off"
    TAKE_OFF_MAY_COME_LATE = "our own take-off comes late"
    IN_CONTROL = "we have control"
    TAKING_CONTROL = "control is being taken"
    TASK_UNDER_WAY = "a request is under way"
    TASK_IS_ARM = "the request is to arm"
    TASK_IS_TAKE_OFF = "the request is to take off"
    TASK_IS_CONTROL = "the request is for guided mode"
    TASK_WAITS = "the request's command waits for a mode or a position"
    TASK_ENDS_HELD = "the request is to hold or abort"
    TASK_ENDS_LANDED = "the request is to come down, and it stands"
    TASK_ENDS_DISARMED = "the request ends when disarmed"
    MISSION_GOES_ON = "the mission lifts off again"
    GOAL_PENDING = "a goal is pending"
    GOAL_ACTIVE = "a goal is being flown"
    ARRIVED = "it arrived"
    AT_HEIGHT = "it reached the height"
    NEARLY_AT_HEIGHT = "it has nearly reached the height"
    CLIMB_ENDED_ELSEWHERE = "the climb ended elsewhere"
    CLIMBS_TOO_HIGH = "it climbs above the height"
    RETURNS_TO_FLIGHT = "a position too old interrupted its flight"
    OPERATOR_LOST = "the operator is lost"
    POSITION_CLEARS = "the present position clears"
    WAY_BACK_CLEARS = "it is outside, and the way back inside clears"
    POSITION_TOO_OLD = "the position is too old"
    TOP_CLEARS = "the way to the top clears"
    RETURN_PATH_CLEARS = "the return path clears"
    BLOCKED_RETURN_FORWARDED = "policy forwards blocked returns"
    BLOCKED_RETURN_LANDS = "policy lands on blocked returns"
    RETARGET_ALLOWED = "policy lets the goal's owner replace it"
    FENCE_SWITCHABLE = "policy lets the fence be switched"
    FORCE_DISARM_FORBIDDEN = "policy forbids disarming in the air"
    FORCE_DISARM_UNCONFIRMED = "it was asked for only once"
    SEVERITY_PERMITS = "severity permits motion"
    HOLD_AWAITED = "hold is commanded and not shown yet"
    HELD_IN_PLACE = "a held point is its goal"
    HOLD_REQUESTED = "it was asked for"
    MODE_AWAITED = "a commanded mode is not shown yet"
    MODE_FITS_STATE = "the mode belongs to the state"
    MODE_GUIDED = "the mode is guided"
    STANDS_IN_GUIDED = "guided is asked for by its name, and it stands still in it"
    MODE_TAKE_OFF = "the mode is take-off"
    MODE_RETURN = "the mode is return"
    MODE_LAND = "the mode is land"
    GUIDED_MAY_COME_LATE = "our own guided command comes late"
    MISSION_AT_LAST_ITEM = "the mission reached its last item"
    IN_GRACE = "a verified stream is in its grace"
    GRACE_OVER = "the grace is over"
    RETURNS_TO_STATE = "it was interrupted in flight"
    PHOTO_TAKEN = "the picture was taken"
    OWN_STREAM = "it is the stream of this client"
    INTERRUPTED_STREAM = "it interrupted the stream of this client"
    SAMPLE_CLEARS = "the sample clears"
    SAMPLES_GOOD_AGAIN = "the samples are good, and have been long enough"
    FLOWN_SAMPLE_CLEARS_NO_MORE = "the sample that is flown clears no more"
    STREAM_SILENT = "no sample came for the dead-man's time"
    STREAM_OVER = "no sample came for too long"


class Check(StrEnum):
    """A condition for accepting a request.  Where it fails it gives the refusal with its reason."""

    SEVERITY = "severity permits motion"
    RECORDER = "the recorder runs where policy asks for it"
    ARMED = "it is armed"
    ON_GROUND = "it stands on the ground"
    SEVERITY_BUT_FENCE = "nothing but the fence forbids motion"
    POSITION = "the present position clears"
    CLIMB = "the climb clears"
    MISSION = "a verified mission is on board"
    HOME_AND_FENCE = "home and fence are known"


class Action(StrEnum):
    """What a branch does: it emits effects and changes the gate's memory."""

    VERIFY_GOAL = "verify the pending goal"
    FLY_GOAL = "accept the goal and fly it"
    REFUSE_GOAL = "refuse the goal"
    HOLD_AT_GOAL = "hold at the goal"
    TAKE_CONTROL = "stream the present position"
    TAKE_CONTROL_ON_WAY_BACK = "stream the way back inside"
    TAKE_CONTROL_AT_TOP = "stream the top of the climb"
    FLY_TO_TOP = "fly to the top of the climb"
    ASK_GUIDED = "command guided"
    SET_GUIDED = "command guided on the ground"
    GAIN_CONTROL = "control is ours"
    RELEASE_CONTROL = "let control go"
    ARM = "command arm"
    DISARM = "command disarm"
    FORCE_DISARM = "command forced disarm"
    TAKE_OFF = "command take-off"
    SEND_WAITING = "send the command that waited"
    LAND = "command land"
    LAND_MODE_ONLY = "command land unseen"
    RETURN = "command return"
    HOLD = "command hold"
    HOLD_UNASKED = "command hold unasked"
    HOLD_MODE_ONLY = "command hold unseen"
    REPEAT_HOLD = "command hold again"
    CONFIRM_HOLD = "hold is confirmed"
    STOP_AWAITING_MODE = "no mode is awaited any more"
    VERIFY_HELD_POINT = "verify the held point anew"
    BRAKE = "send the brake setpoint"
    TAKE_PHOTO = "command photo"
    START_MISSION = "command mission start"
    SWITCH_FENCE = "switch the fence"
    START_GRACE = "keep the verified stream for its grace"
    STOP_STREAM = "stop the stream"
    FORGET_VEHICLE = "forget the vehicle"
    FORGET_INTERRUPTED = "forget what was interrupted"
    AWAIT_DISARM = "wait shortly for disarm"
    AWAIT_LANDING = "wait for the landing again"
    AWAIT_POSITION = "wait for a position"
    DROP_DEADLINE = "let it take as long as it takes"
    NOTE_LIFT_OFF = "note the lift-off"
    NOTE_FORCE_REQUEST = "note the first asking"
    BEGIN_STREAM = "the stream begins"
    FLY_SAMPLE = "fly the sample"
    NOTE_SAMPLE = "note that it came"
    NOTE_GOOD_SAMPLE = "note that it is good again"
    HOLD_IN_PLACE = "hold in place of the stream"
    END_STREAM = "end the stream and hold in place"


class Reply(Enum):
    """What a branch replies to a request that it does not refuse.

    NONE is for events that are not requests.  PENDING gives no verdict yet: the request waits
    for the next tick.
    """

    NONE = "none"
    ACCEPTED = "accepted"
    DONE = "accepted, complete at once"
    PENDING = "pending until the tick"


class Elsewhere(Enum):
    """Next states that are not given by their name.

    STAY is the present state; BACK, in STALE, the state that `Memory.back_to` remembers.
    """

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
"""The states that BACK may stand for: those in which a position too old leads to STALE, and from
which the flight may go on when a fresh position arrives."""

Next: TypeAlias = State | Elsewhere


@dataclass(frozen=True, slots=True)
class End:
    """The outcome of the request under way; a goal that is still pending is refused with the code.

    `judged` True: the code and the sentence are those of the refusal that caused the event.
    `goes_on` True: nobody waits for it any more, and what it commanded goes on all the same.
    """

    kind: OutcomeKind
    code: Code | None = None
    judged: bool = False
    goes_on: bool = False


@dataclass(frozen=True, slots=True)
class Branch:
    """One alternative of a cell: the first whose guards (`when`) all hold is taken.

    What a branch that was taken does, in this order:

    1. `needs`: its checks are made.  The first that fails refuses the request, and nothing else
       of the branch happens.
    2. `refuse`: the request is refused with this code.  The rest of the branch still happens: a
       return whose path is blocked is refused, and the vehicle is held.
    3. `reply`: the request is accepted, or kept until the tick.
    4. `ends`: the outcome of the request that was under way before.  Where it is None and the
       reply is ACCEPTED, that request is superseded by the new one.
    5. `do`: the actions, in order.
    6. `to`: the next state.
    """

    when: tuple[Guard, ...] = ()
    needs: tuple[Check, ...] = ()
    refuse: Code | None = None
    reply: Reply = Reply.NONE
    ends: End | None = None
    do: tuple[Action, ...] = ()
    to: Next = STAY


Cell: TypeAlias = tuple[Branch, ...]
"""The branches of one state and one event, in order; the last one has no guard.  An empty cell
says that the event cannot happen in the state: if it does, the gate has a bug."""
