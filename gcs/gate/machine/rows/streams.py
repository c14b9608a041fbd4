"""Rows of the table: a client's setpoint stream, which begins, is flown sample by sample, and ends.

A stream is flown from HOVERING, and from MOVING where the policy lets the owner of a goal replace
it.  It begins by a request or by its first sample that clears.  In every other state its samples
are refused, as a goal would be, and never kept.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

from gcs.gate.effects import OutcomeKind
from gcs.gate.machine.actions import Action
from gcs.gate.machine.checks import Check
from gcs.gate.machine.events import Event
from gcs.gate.machine.guards import Guard
from gcs.gate.machine.rows.cells import busy_or_not_ours, cannot_happen, complete_at_once, refuse
from gcs.gate.machine.rows.row import (
    EXTERNAL,
    FLYING_MISSION,
    GROUNDED,
    HOLDING,
    HOVERING,
    LANDING,
    MOVING,
    NO_VEHICLE,
    RETURNING,
    STALE,
    STREAMING,
    TAKING_OFF,
    TAKING_PICTURE,
    VERIFYING,
    Branch,
    Cell,
    Row,
    during,
    row,
)
from gcs.gate.machine.step_context import End, Reply
from gcs.gate.refusal import Code

SUPERSEDED: Final = End(OutcomeKind.SUPERSEDED, Code.SUPERSEDED)

# -------------------------------------------------------------------------------- requests

refuse_while_taking_control: Final = Branch(
    when=(Guard.TAKING_CONTROL,), refuse=Code.CONTROL_PENDING
)
refuse_while_goal_pending: Final = Branch(when=(Guard.GOAL_PENDING,), refuse=Code.BUSY)
begin_stream: Final = Branch(
    needs=(Check.SEVERITY, Check.POSITION),
    reply=Reply.ACCEPTED,
    do=(Action.BEGIN_STREAM,),
    to=STREAMING,
)
begin_stream_if_policy_allows: Final = Branch(
    when=(Guard.RETARGET_ALLOWED,),
    needs=(Check.SEVERITY, Check.POSITION),
    reply=Reply.ACCEPTED,
    do=(Action.BEGIN_STREAM,),
    to=STREAMING,
)
complete_if_own_stream_was_asked_for: Final = Branch(
    when=(Guard.OWN_STREAM, Guard.TASK_UNDER_WAY), reply=Reply.DONE
)
accept_if_own_stream: Final = Branch(
    when=(Guard.OWN_STREAM,), reply=Reply.ACCEPTED, do=(Action.NOTE_SAMPLE,)
)
end_stream: Final = Branch(reply=Reply.DONE, do=(Action.END_STREAM,), to=HOVERING)

# --------------------------------------------------------------------------------- samples

fly_first_sample_if_it_clears: Final = Branch(
    when=(Guard.SAMPLE_CLEARS,), do=(Action.BEGIN_STREAM, Action.FLY_SAMPLE), to=STREAMING
)
replace_goal_if_policy_allows_and_sample_clears: Final = Branch(
    when=(Guard.RETARGET_ALLOWED, Guard.SAMPLE_CLEARS),
    ends=SUPERSEDED,
    do=(Action.BEGIN_STREAM, Action.FLY_SAMPLE),
    to=STREAMING,
)
# The guard that the sample clears has left the reason why it does not.
refuse_as_judged_if_policy_allows: Final = Branch(
    when=(Guard.RETARGET_ALLOWED,), refuse=Code.CANNOT_STOP
)
refuse_as_judged: Final = refuse(Code.CANNOT_STOP)
samples_of_stream: Final[Cell] = (
    Branch(when=(Guard.OWN_STREAM, Guard.SAMPLES_GOOD_AGAIN), do=(Action.FLY_SAMPLE,)),
    Branch(when=(Guard.OWN_STREAM, Guard.SAMPLE_CLEARS), do=(Action.NOTE_GOOD_SAMPLE,)),
    Branch(
        when=(Guard.OWN_STREAM,),
        refuse=Code.CANNOT_STOP,
        do=(Action.NOTE_SAMPLE, Action.HOLD_IN_PLACE),
    ),
    refuse(Code.OTHER_OPERATOR),
)
note_sample_if_it_was_interrupted: Final = Branch(
    when=(Guard.INTERRUPTED_STREAM,), do=(Action.NOTE_SAMPLE,)
)

STREAM_ROWS: Final[Mapping[Event, Row]] = {
    Event.STREAM_BEGIN: row(
        during(NO_VEHICLE, then=refuse(Code.NO_VEHICLE)),
        during(STALE, then=refuse(Code.STALE)),
        during(GROUNDED, then=refuse(Code.NOT_FLYING)),
        during(TAKING_OFF, then=refuse(Code.BUSY)),
        during(
            HOVERING, then=(refuse_while_taking_control, refuse_while_goal_pending, begin_stream)
        ),
        during(VERIFYING, then=cannot_happen),
        during(
            MOVING,
            then=(refuse_while_goal_pending, begin_stream_if_policy_allows, refuse(Code.BUSY)),
        ),
        during(
            STREAMING,
            then=(
                complete_if_own_stream_was_asked_for,
                accept_if_own_stream,
                refuse(Code.OTHER_OPERATOR),
            ),
        ),
        during(TAKING_PICTURE, FLYING_MISSION, then=refuse(Code.BUSY)),
        during(RETURNING, LANDING, then=busy_or_not_ours),
        during(HOLDING, then=refuse(Code.HOLDING)),
        during(EXTERNAL, then=refuse(Code.NOT_IN_CONTROL)),
    ),
    Event.STREAM_END: row(
        during(NO_VEHICLE, then=complete_at_once),
        during(STALE, then=refuse(Code.STALE)),
        during(GROUNDED, TAKING_OFF, HOVERING, then=complete_at_once),
        during(VERIFYING, then=cannot_happen),
        during(MOVING, then=complete_at_once),
        during(STREAMING, then=end_stream),
        during(TAKING_PICTURE, FLYING_MISSION, then=complete_at_once),
        during(RETURNING, LANDING, HOLDING, EXTERNAL, then=complete_at_once),
    ),
    Event.STREAM_SAMPLE: row(
        during(NO_VEHICLE, then=refuse(Code.NO_VEHICLE)),
        during(STALE, then=(note_sample_if_it_was_interrupted, refuse(Code.STALE))),
        during(GROUNDED, then=refuse(Code.NOT_FLYING)),
        during(TAKING_OFF, then=refuse(Code.BUSY)),
        during(
            HOVERING,
            then=(
                refuse_while_taking_control,
                refuse_while_goal_pending,
                fly_first_sample_if_it_clears,
                refuse_as_judged,
            ),
        ),
        during(VERIFYING, then=cannot_happen),
        during(
            MOVING,
            then=(
                refuse_while_goal_pending,
                replace_goal_if_policy_allows_and_sample_clears,
                refuse_as_judged_if_policy_allows,
                refuse(Code.BUSY),
            ),
        ),
        during(STREAMING, then=samples_of_stream),
        during(TAKING_PICTURE, FLYING_MISSION, then=refuse(Code.BUSY)),
        during(RETURNING, LANDING, then=busy_or_not_ours),
        during(HOLDING, then=refuse(Code.HOLDING)),
        during(EXTERNAL, then=refuse(Code.NOT_IN_CONTROL)),
    ),
}
