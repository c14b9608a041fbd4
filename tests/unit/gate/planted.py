"""Faults of the table, one after another, and how the explorer is to find each.

Every invariant has at least one: an invariant that nothing can break protects nothing.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

from gcs.gate.effects import OutcomeKind
from gcs.gate.machine.actions import Action
from gcs.gate.machine.checks import Check
from gcs.gate.machine.events import Event
from gcs.gate.machine.guards import Guard
from gcs.gate.machine.rows.row import Branch, Cell
from gcs.gate.machine.step_context import End, Reply
from gcs.gate.machine.table import TABLE
from gcs.gate.refusal import Code
from gcs.gate.states import State

NOTHING: Cell = (Branch(),)
FORCE_REFUSED_FIRST = Guard.FORCE_DISARM_UNCONFIRMED


@dataclass(frozen=True)
class Planted:
    """`cells` stand in place of the table's; `letter` is the last one of the shortest trace."""

    what: str
    cells: Mapping[tuple[State, Event], Cell]
    invariant: int
    letter: str
    world: str = "px4"


def planted(
    what: str,
    state: State,
    event: Event,
    cell: Cell,
    invariant: int,
    letter: str,
    world: str = "px4",
) -> Planted:
    return Planted(what, {(state, event): cell}, invariant, letter, world)


def without(state: State, event: Event, guard: Guard) -> Cell:
    """The cell without the branches that have this guard."""
    return tuple(branch for branch in TABLE[state, event] if guard not in branch.when)


def unguarded(state: State, event: Event, guard: Guard) -> Cell:
    """The cell whose branches no longer ask this guard."""
    return tuple(
        replace(branch, when=tuple(g for g in branch.when if g is not guard))
        for branch in TABLE[state, event]
    )


def unchecked(state: State, event: Event, check: Check) -> Cell:
    """The cell whose branches no longer ask this check."""
    return tuple(
        replace(branch, needs=tuple(c for c in branch.needs if c is not check))
        for branch in TABLE[state, event]
    )


def undone(state: State, event: Event, action: Action) -> Cell:
    """The cell whose branches no longer do this."""
    return tuple(
        replace(branch, do=tuple(a for a in branch.do if a is not action))
        for branch in TABLE[state, event]
    )


def forgetting_the_hold(state: State, event: Event) -> Cell:
    """The cell whose branches drop a hold that is not shown yet."""
    return tuple(
        replace(
            branch,
            when=tuple(g for g in branch.when if g is not Guard.HOLD_AWAITED),
            do=(Action.CONFIRM_HOLD,),
        )
        for branch in TABLE[state, event]
    )


FAULTS = [
    planted(
        "moving while stale",
        State.MOVING,
        Event.POSITION_AGED,
        NOTHING,
        7,
        "wait: position too old",
    ),
    planted(
        "hovering while stale",
        State.HOVERING,
        Event.POSITION_AGED,
        NOTHING,
        7,
        "wait: position too old",
    ),
    planted(
        "a busy goal is taken",
        State.MOVING,
        Event.GOTO,
        (Branch(reply=Reply.PENDING),),
        4,
        "ask: goto inside",
    ),
    planted(
        "anybody may replace a goal",
        State.MOVING,
        Event.GOTO,
        unguarded(State.MOVING, Event.GOTO, Guard.RETARGET_ALLOWED),
        4,
        "another asks: goto inside",
        "ardupilot",
    ),
    planted(
        "a goal is taken while severity forbids it",
        State.EXTERNAL,
        Event.CONTROL,
        unchecked(State.EXTERNAL, Event.CONTROL, Check.SEVERITY),
        7,
        "ask: control",
    ),
    planted(
        "abort is refused while a picture is taken",
        State.TAKING_PICTURE,
        Event.ABORT,
        (Branch(refuse=Code.BUSY),),
        5,
        "ask: abort",
    ),
    planted(
        "hold is refused while somebody else flies",
        State.EXTERNAL,
        Event.HOLD,
        (Branch(refuse=Code.NOT_IN_CONTROL),),
        10,
        "ask: hold",
    ),
    planted(
        "a breach is not braked",
        State.MOVING,
        Event.BREACH,
        NOTHING,
        6,
        "position dashing for the fence",
    ),
    planted(
        "a breach is not braked while control is being taken",
        State.HOVERING,
        Event.BREACH,
        (Branch(when=(Guard.TAKING_CONTROL,)), *TABLE[State.HOVERING, Event.BREACH]),
        6,
        "position dashing for the fence",
    ),
    planted(
        "a breach is held but not braked",
        State.TAKING_OFF,
        Event.BREACH,
        undone(State.TAKING_OFF, Event.BREACH, Action.BRAKE),
        6,
        "position dashing for the fence",
    ),
    planted(
        "a breach that setpoints stop is not held later",
        State.MOVING,
        Event.BREACH,
        (Branch(ends=End(OutcomeKind.ABORTED), do=(Action.BRAKE,), to=State.HOLDING),),
        6,
        "position dashing for the fence",
    ),
    planted(
        "a breach predicted by a late sample is swallowed",
        State.STALE,
        Event.BREACH,
        NOTHING,
        6,
        "position dashing for the fence",
    ),
    planted(
        "holding is left without resume",
        State.HOLDING,
        Event.MODE_CONFIRMED,
        (Branch(ends=End(OutcomeKind.COMPLETE), do=(Action.CONFIRM_HOLD,), to=State.HOVERING),),
        5,
        "hold mode",
    ),
    planted(
        "the end of a request is forgotten",
        State.TAKING_PICTURE,
        Event.PHOTO_SEEN,
        (Branch(to=State.HOVERING),),
        0,
        "picture",
    ),
    planted(
        "a refused goal is flown",
        State.VERIFYING,
        Event.GOAL_REFUSED,
        (Branch(do=(Action.FLY_GOAL,), to=State.MOVING),),
        1,
        "wait: deadline",
    ),
    planted(
        "a goal is flown on in a fence that refuses it",
        State.MOVING,
        Event.CLEARS_NO_MORE,
        NOTHING,
        2,
        "fence moves, and back",
    ),
    planted(
        "a goal is over wherever the nose points",
        State.MOVING,
        Event.TICK,
        unguarded(State.MOVING, Event.TICK, Guard.ARRIVED),
        2,
        "tick",
    ),
    planted(
        "home moves and nobody holds",
        State.HOVERING,
        Event.HOME_MOVED,
        NOTHING,
        2,
        "home moves, and back",
    ),
    planted(
        "a hold is over at once though the vehicle may fly",
        State.GROUNDED,
        Event.HOLD,
        (Branch(reply=Reply.DONE),),
        10,
        "ask: hold",
    ),
    planted(
        "a hold is withdrawn after the operator is lost",
        State.HOLDING,
        Event.RESUME,
        without(State.HOLDING, Event.RESUME, Guard.OPERATOR_LOST),
        7,
        "ask: resume",
    ),
    planted(
        "a climb is over wherever the vehicle holds",
        State.TAKING_OFF,
        Event.TICK,
        (
            Branch(when=(Guard.LIFTED_OFF,), do=(Action.TAKE_CONTROL,), to=State.HOVERING),
            Branch(),
        ),
        2,
        "tick",
    ),
    planted(
        "a cell that cannot be entered",
        State.GROUNDED,
        Event.ARMED,
        (),
        0,
        "armed or disarmed",
    ),
    # ---------------------------------------------------------------------- forced disarm
    planted(
        "the first forced disarm cuts the motors in the air",
        State.HOVERING,
        Event.FORCE_DISARM,
        without(State.HOVERING, Event.FORCE_DISARM, FORCE_REFUSED_FIRST),
        0,
        "ask: force disarm",
    ),
    planted(
        "the first forced disarm cuts the motors of what somebody else flies",
        State.EXTERNAL,
        Event.FORCE_DISARM,
        without(State.EXTERNAL, Event.FORCE_DISARM, FORCE_REFUSED_FIRST),
        0,
        "ask: force disarm",
    ),
    planted(
        "a disarm in the air is a first request for a forced one",
        State.EXTERNAL,
        Event.DISARM,
        tuple(
            branch if branch.refuse is None else replace(branch, do=(Action.NOTE_FORCE_REQUEST,))
            for branch in TABLE[State.EXTERNAL, Event.DISARM]
        ),
        0,
        "ask: disarm",
    ),
    planted(
        "motors are cut though the policy forbids it",
        State.EXTERNAL,
        Event.FORCE_DISARM,
        without(State.EXTERNAL, Event.FORCE_DISARM, Guard.FORCE_DISARM_FORBIDDEN),
        0,
        "ask: force disarm",
        "ardupilot",
    ),
    # ------------------------------------------------------------------------------- hold
    planted(
        "a refused hold is not commanded again",
        State.HOLDING,
        Event.HOLD_REFUSED,
        (Branch(do=(Action.CONFIRM_HOLD,)),),
        0,
        "answer: refused",
    ),
    planted(
        "a refused hold is not commanded again in STALE",
        State.STALE,
        Event.HOLD_REFUSED,
        (Branch(do=(Action.CONFIRM_HOLD,)),),
        0,
        "answer: refused",
    ),
    planted(
        "a hold that is due in HOLDING is not commanded",
        State.HOLDING,
        Event.HOLD_DUE,
        NOTHING,
        0,
        "wait: mode overdue",
    ),
    planted(
        "a hold that is due in STALE is not commanded",
        State.STALE,
        Event.HOLD_DUE,
        NOTHING,
        0,
        "wait: hold due",
    ),
    planted(
        "a hold ends with the deadline of its request",
        State.HOLDING,
        Event.DEADLINE,
        forgetting_the_hold(State.HOLDING, Event.DEADLINE),
        0,
        "wait: deadline",
    ),
    planted(
        "a hold ends with its deadline where the vehicle is not heard",
        State.NO_VEHICLE,
        Event.DEADLINE,
        forgetting_the_hold(State.NO_VEHICLE, Event.DEADLINE),
        0,
        "wait: deadline",
    ),
    planted(
        "a hold ends with an unanswered disarm",
        State.GROUNDED,
        Event.COMMAND_UNANSWERED,
        forgetting_the_hold(State.GROUNDED, Event.COMMAND_UNANSWERED),
        0,
        "answer: none",
    ),
    planted(
        "a hold ends with the lift-off that it should prevent",
        State.GROUNDED,
        Event.AIRBORNE,
        forgetting_the_hold(State.GROUNDED, Event.AIRBORNE),
        0,
        "in the air",
    ),
    planted(
        "a hold on the ground ends with the operator",
        State.GROUNDED,
        Event.OPERATOR_LOST,
        forgetting_the_hold(State.GROUNDED, Event.OPERATOR_LOST),
        0,
        "operator lost",
    ),
    # --------------------------------------------------------------------------- severity
    planted(
        "severity is HOLD and nobody holds",
        State.HOVERING,
        Event.MUST_HOLD,
        NOTHING,
        7,
        "condition: HOLD",
    ),
    planted(
        "severity is RETURN and the vehicle is held",
        State.HOVERING,
        Event.MUST_RETURN,
        TABLE[State.HOVERING, Event.MUST_HOLD],
        0,
        "condition: RETURN",
    ),
    planted(
        "severity is LAND and HOLDING goes on",
        State.HOLDING,
        Event.MUST_LAND,
        NOTHING,
        0,
        "condition: LAND",
    ),
    # ---------------------------------------------------------------------------- unknown
    planted(
        "a mission starts in a fence that is not known",
        State.GROUNDED,
        Event.MISSION,
        unchecked(State.GROUNDED, Event.MISSION, Check.HOME_AND_FENCE),
        7,
        "ask: mission without a fence",
    ),
    planted(
        "a mission starts that was not verified",
        State.HOVERING,
        Event.MISSION,
        unchecked(State.HOVERING, Event.MISSION, Check.MISSION),
        7,
        "ask: mission with none on board",
    ),
    planted(
        "control is taken in a fence that is not known",
        State.EXTERNAL,
        Event.CONTROL,
        unchecked(State.EXTERNAL, Event.CONTROL, Check.POSITION),
        7,
        "ask: control",
    ),
    planted(
        "a goal does not wait for control that is being taken",
        State.HOVERING,
        Event.TICK,
        without(State.HOVERING, Event.TICK, Guard.TAKING_CONTROL),
        4,
        "tick",
    ),
    # --------------------------------------------------------------------------- take-off
    planted(
        "a take-off is complete where the vehicle ends its climb",
        State.HOVERING,
        Event.MODE_CONFIRMED,
        without(State.HOVERING, Event.MODE_CONFIRMED, Guard.TASK_IS_TAKE_OFF),
        2,
        "wait: position too old",
    ),
    planted(
        "the place where the climb ended is held, and not its top",
        State.TAKING_OFF,
        Event.TICK,
        tuple(
            replace(branch, do=(Action.TAKE_CONTROL,))
            if Action.TAKE_CONTROL_AT_TOP in branch.do
            else branch
            for branch in TABLE[State.TAKING_OFF, Event.TICK]
        ),
        2,
        "wait: mode overdue",
    ),
    # ----------------------------------------------------------- who is not heard, who leaves
    planted(
        "arming does not wait for a position",
        State.STALE,
        Event.ARM,
        (Branch(reply=Reply.ACCEPTED, do=(Action.ARM,)),),
        7,
        "ask: arm",
    ),
    planted(
        "a vehicle is lost with its position",
        State.GROUNDED,
        Event.POSITION_AGED,
        (Branch(do=(Action.RELEASE_CONTROL, Action.FORGET_VEHICLE), to=State.NO_VEHICLE),),
        7,
        "wait: position too old",
    ),
    planted(
        "a landing is not asked of a vehicle that is not heard any more",
        State.NO_VEHICLE,
        Event.LAND,
        (Branch(refuse=Code.NO_VEHICLE),),
        10,
        "ask: land",
    ),
    planted(
        "a hold that was asked for ends with the link",
        State.HOLDING,
        Event.VEHICLE_LOST,
        without(State.HOLDING, Event.VEHICLE_LOST, Guard.HOLD_AWAITED),
        0,
        "wait: vehicle lost",
    ),
    planted(
        "whoever leaves cancels a return",
        State.RETURNING,
        Event.OPERATOR_LOST,
        TABLE[State.HOVERING, Event.OPERATOR_LOST],
        0,
        "operator lost",
    ),
    planted(
        "a landing that is not shown yet is asked for no more when the operator leaves",
        State.LANDING,
        Event.OPERATOR_LOST,
        (Branch(ends=End(OutcomeKind.ABORTED, Code.OPERATOR_LOST)),),
        0,
        "operator lost",
    ),
    *(
        planted(
            f"what is under way in {state.name} is left without its ending",
            state,
            Event.OPERATOR_LOST,
            NOTHING,
            3,
            "operator lost",
        )
        for state in (State.STALE, State.GROUNDED, State.LANDING, State.HOLDING, State.EXTERNAL)
    ),
    # ---------------------------------------------------------------------------- streams
    planted(
        "a refused stream is flown on",
        State.STREAMING,
        Event.STREAM_SAMPLE,
        undone(State.STREAMING, Event.STREAM_SAMPLE, Action.HOLD_IN_PLACE),
        1,
        "sample: too fast",
    ),
    planted(
        "a sample of a source that has gone silent is sent on",
        State.STREAMING,
        Event.TICK,
        without(State.STREAMING, Event.TICK, Guard.STREAM_SILENT),
        8,
        "wait: sample too old",
    ),
    planted(
        "a sample is sent on by a position too old",
        State.STREAMING,
        Event.TICK,
        without(State.STREAMING, Event.TICK, Guard.FLOWN_SAMPLE_CLEARS_NO_MORE),
        8,
        "wait: position too old for a sample",
    ),
    planted(
        "samples of another client are flown",
        State.STREAMING,
        Event.STREAM_SAMPLE,
        unguarded(State.STREAMING, Event.STREAM_SAMPLE, Guard.OWN_STREAM),
        8,
        "another's sample",
    ),
    planted(
        "a stream begins with a sample that does not clear",
        State.HOVERING,
        Event.STREAM_SAMPLE,
        unguarded(State.HOVERING, Event.STREAM_SAMPLE, Guard.SAMPLE_CLEARS),
        8,
        "sample: too fast",
    ),
    planted(
        "a stream begins while control is being taken",
        State.HOVERING,
        Event.STREAM_SAMPLE,
        without(State.HOVERING, Event.STREAM_SAMPLE, Guard.TAKING_CONTROL),
        8,
        "sample: velocity",
    ),
    planted(
        "anybody may end a stream by a goal",
        State.STREAMING,
        Event.GOTO,
        unguarded(State.STREAMING, Event.GOTO, Guard.OWN_STREAM),
        4,
        "another asks: goto inside",
    ),
    planted(
        "a sample ends a hold",
        State.HOLDING,
        Event.STREAM_SAMPLE,
        TABLE[State.HOVERING, Event.STREAM_SAMPLE],
        5,
        "sample: velocity",
    ),
    planted(
        "the end of a stream leaves its request under way",
        State.STREAMING,
        Event.STREAM_END,
        (Branch(reply=Reply.DONE, to=State.HOVERING),),
        0,
        "ask: stream end",
    ),
]
