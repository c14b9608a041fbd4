"""Outcomes, branches and cells that several rows of the table share.

The name of a branch says what it does; where it has a condition, the name ends with it
(`..._if_on_ground`).  A cell is read from the top: the first branch whose condition holds is
taken.
"""

from __future__ import annotations

from typing import Final

from gcs.gate.effects import OutcomeKind
from gcs.gate.machine.actions import Action
from gcs.gate.machine.guards import Guard
from gcs.gate.machine.rows.row import EXTERNAL, GROUNDED, HOLDING, HOVERING, Branch, Cell
from gcs.gate.machine.step_context import End, Reply
from gcs.gate.refusal import Code
from gcs.gate.states import State

COMPLETE: Final = End(OutcomeKind.COMPLETE)
STOPPED_BY_OPERATOR: Final = End(OutcomeKind.ABORTED, Code.OPERATOR)
DEADLINE_PASSED: Final = End(OutcomeKind.TIMED_OUT, Code.DEADLINE)
NO_ANSWER: Final = End(OutcomeKind.TIMED_OUT, Code.NO_ANSWER)
VEHICLE_REFUSED: Final = End(OutcomeKind.ABORTED, Code.VEHICLE_REFUSED)
SEVERITY: Final = End(OutcomeKind.ABORTED, Code.SEVERITY)
OPERATOR_LOST: Final = End(OutcomeKind.ABORTED, Code.OPERATOR_LOST)
AS_JUDGED: Final = End(OutcomeKind.ABORTED, judged=True)
LEFT_GOING_ON: Final = End(OutcomeKind.ABORTED, Code.OPERATOR_LOST, goes_on=True)
LIFTED_OFF: Final = End(OutcomeKind.TAKEN_OVER, Code.IN_AIR)
NO_POSITION: Final = End(OutcomeKind.TIMED_OUT, Code.NO_POSITION)
TAKEN_OVER: Final = End(OutcomeKind.TAKEN_OVER, Code.MODE_CHANGED)

CONTROL_REGAINABLE: Final = (Guard.AIRBORNE, Guard.SEVERITY_PERMITS, Guard.POSITION_CLEARS)
"""The conditions under which a mission ends in HOVERING, under our control."""

cannot_happen: Final[Cell] = ()
unchanged: Final = Branch()
complete_at_once: Final = Branch(reply=Reply.DONE)
refuse_if_operator_lost: Final = Branch(when=(Guard.OPERATOR_LOST,), refuse=Code.OPERATOR_LOST)


def refuse(code: Code) -> Branch:
    """Refuse the request."""
    return Branch(refuse=code)


def end(outcome: End) -> Branch:
    """End the request under way and do nothing else."""
    return Branch(ends=outcome)


hold_if_awaited: Final = Branch(when=(Guard.HOLD_AWAITED,), do=(Action.HOLD,), to=HOLDING)
"""HOLD was commanded and is not shown: what is found to fly is held."""


refuse_as_busy_if_in_control: Final = Branch(when=(Guard.IN_CONTROL,), refuse=Code.BUSY)
busy_or_not_ours: Final[Cell] = (refuse_as_busy_if_in_control, refuse(Code.NOT_IN_CONTROL))
"""In RETURNING and LANDING: whether we told the vehicle to, or it did by itself."""


def end_if_task_is_arm(outcome: End) -> Branch:
    """End a request to arm; the mode that it needed is asked for no more."""
    return Branch(when=(Guard.TASK_IS_ARM,), ends=outcome, do=(Action.CONFIRM_HOLD,))


def hold_and_end(outcome: End) -> Branch:
    """End the request, command HOLD, and stay in HOLDING until a `resume`."""
    return Branch(ends=outcome, do=(Action.HOLD,), to=HOLDING)


def hover_and_end(outcome: End) -> Branch:
    """End the request and go on hovering."""
    return Branch(ends=outcome, to=HOVERING)


def release_and_end(outcome: End, to: State) -> Branch:
    """End the request and release control: the vehicle does not do what we asked for."""
    return Branch(ends=outcome, do=(Action.RELEASE_CONTROL,), to=to)


def end_if_on_ground(outcome: End) -> Branch:
    """A take-off or a mission that has not left the ground: end it and release control."""
    return Branch(when=(Guard.ON_GROUND,), ends=outcome, do=(Action.RELEASE_CONTROL,), to=GROUNDED)


def disarm_if_on_ground(outcome: End) -> Branch:
    """As `end_if_on_ground`.  A command that was sent may still lift the vehicle off, so it is
    told to hold as well as to disarm."""
    do = (Action.RELEASE_CONTROL, Action.HOLD_MODE_ONLY, Action.DISARM)
    return Branch(when=(Guard.ON_GROUND,), ends=outcome, do=do, to=GROUNDED)


def stop_stream_if(guard: Guard, outcome: End) -> Branch:
    """In STALE: no verified position is left to stream.  End the request and command HOLD; a
    fresh position then leads to HOLDING."""
    return Branch(when=(guard,), ends=outcome, do=(Action.STOP_STREAM, Action.HOLD))


def release_if_taking_control(outcome: End) -> Branch:
    """Control could not be taken.  Our command for guided mode may still take effect, so the
    vehicle is told to hold, until it shows that mode or one that somebody else chose."""
    return Branch(
        when=(Guard.TAKING_CONTROL,),
        ends=outcome,
        do=(Action.RELEASE_CONTROL, Action.HOLD_UNASKED),
        to=EXTERNAL,
    )
