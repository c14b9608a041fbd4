"""Rows of the table: the tick, deadlines, and what is due to be commanded again."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

from gcs.gate.effects import OutcomeKind
from gcs.gate.machine.actions import Action
from gcs.gate.machine.events import Event
from gcs.gate.machine.guards import Guard
from gcs.gate.machine.rows.cells import (
    COMPLETE,
    DEADLINE_PASSED,
    NO_ANSWER,
    NO_POSITION,
    VEHICLE_REFUSED,
    cannot_happen,
    disarm_if_on_ground,
    end,
    hold_and_end,
    hover_and_end,
    release_if_taking_control,
    stop_stream_if,
    unchanged,
)
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
from gcs.gate.machine.step_context import End
from gcs.gate.refusal import Code

TOO_HIGH: Final = End(OutcomeKind.ABORTED, Code.TOO_HIGH)
TOO_CLOSE: Final = End(OutcomeKind.ABORTED, Code.TOO_CLOSE)
STREAM_OVER: Final = End(OutcomeKind.TIMED_OUT, judged=True)

# ------------------------------------------------------------------------------------ tick

# A goal that came meanwhile waits, until the mode is shown or its time is over.
unchanged_while_taking_control: Final = Branch(when=(Guard.TAKING_CONTROL,))
verify_if_goal_pending: Final = Branch(
    when=(Guard.GOAL_PENDING,), do=(Action.VERIFY_GOAL,), to=VERIFYING
)
complete_if_arrived: Final = Branch(
    when=(Guard.ARRIVED,), ends=COMPLETE, do=(Action.HOLD_AT_GOAL,), to=HOVERING
)
climb: Final[Cell] = (
    Branch(
        when=(Guard.AT_HEIGHT, Guard.SEVERITY_PERMITS, Guard.TOP_CLEARS),
        do=(Action.TAKE_CONTROL_AT_TOP,),
        to=HOVERING,
    ),
    Branch(when=(Guard.AT_HEIGHT,), ends=TOO_CLOSE, do=(Action.HOLD,), to=HOLDING),
    Branch(
        when=(Guard.CLIMB_ENDED_ELSEWHERE,),
        ends=VEHICLE_REFUSED,
        do=(Action.HOLD,),
        to=HOLDING,
    ),
    Branch(when=(Guard.CLIMBS_TOO_HIGH,), ends=TOO_HIGH, do=(Action.HOLD,), to=HOLDING),
    unchanged,
)

stream: Final[Cell] = (
    Branch(when=(Guard.STREAM_OVER,), ends=STREAM_OVER, do=(Action.HOLD_IN_PLACE,), to=HOVERING),
    Branch(when=(Guard.STREAM_SILENT,), do=(Action.HOLD_IN_PLACE,)),
    Branch(when=(Guard.FLOWN_SAMPLE_CLEARS_NO_MORE,), do=(Action.HOLD_IN_PLACE,)),
    unchanged,
)

# -------------------------------------------------------------------------------- deadline

end_if_arm_waits_for_position: Final = Branch(
    when=(Guard.TASK_IS_ARM, Guard.TASK_WAITS), ends=NO_POSITION, do=(Action.CONFIRM_HOLD,)
)
end_if_task_waits: Final = Branch(
    when=(Guard.TASK_WAITS,), ends=NO_ANSWER, do=(Action.CONFIRM_HOLD,)
)
complete_if_task_ends_landed_and_it_stands: Final = Branch(
    when=(Guard.TASK_ENDS_LANDED, Guard.ON_GROUND), ends=COMPLETE
)
complete_if_task_ends_landed: Final = Branch(when=(Guard.TASK_ENDS_LANDED,), ends=COMPLETE)
complete_if_on_ground: Final = Branch(
    when=(Guard.ON_GROUND,), ends=COMPLETE, do=(Action.RELEASE_CONTROL,), to=GROUNDED
)
# The request is over and the hold is not: it is repeated until the heartbeat shows it.
repeat_hold_if_awaited: Final = Branch(
    when=(Guard.HOLD_AWAITED,), ends=NO_ANSWER, do=(Action.REPEAT_HOLD,)
)

# ------------------------------------------------------------------------ commanded again

ask_for_guided: Final = Branch(do=(Action.ASK_GUIDED,))
repeat_hold: Final = Branch(do=(Action.REPEAT_HOLD,))

TIME_ROWS: Final[Mapping[Event, Row]] = {
    Event.TICK: row(
        during(NO_VEHICLE, STALE, GROUNDED, then=unchanged),
        during(TAKING_OFF, then=climb),
        during(HOVERING, then=(unchanged_while_taking_control, verify_if_goal_pending, unchanged)),
        during(VERIFYING, then=cannot_happen),
        during(MOVING, then=(verify_if_goal_pending, complete_if_arrived, unchanged)),
        during(STREAMING, then=stream),
        during(TAKING_PICTURE, FLYING_MISSION, then=unchanged),
        during(RETURNING, LANDING, HOLDING, EXTERNAL, then=unchanged),
    ),
    Event.DEADLINE: row(
        during(NO_VEHICLE, then=end(NO_ANSWER)),
        during(
            STALE,
            then=(
                stop_stream_if(Guard.IN_GRACE, DEADLINE_PASSED),
                end_if_arm_waits_for_position,
                complete_if_task_ends_landed_and_it_stands,
                repeat_hold_if_awaited,
                end(NO_ANSWER),
            ),
        ),
        during(
            GROUNDED,
            then=(
                end_if_task_waits,
                complete_if_task_ends_landed,
                repeat_hold_if_awaited,
                end(NO_ANSWER),
            ),
        ),
        during(
            TAKING_OFF,
            then=(disarm_if_on_ground(DEADLINE_PASSED), hold_and_end(DEADLINE_PASSED)),
        ),
        during(HOVERING, then=(release_if_taking_control(NO_ANSWER), unchanged)),
        during(VERIFYING, then=cannot_happen),
        during(MOVING, STREAMING, then=hold_and_end(DEADLINE_PASSED)),
        during(TAKING_PICTURE, then=hover_and_end(DEADLINE_PASSED)),
        during(FLYING_MISSION, RETURNING, then=end(NO_ANSWER)),
        during(LANDING, then=(complete_if_on_ground, end(DEADLINE_PASSED))),
        during(HOLDING, EXTERNAL, then=(repeat_hold_if_awaited, end(NO_ANSWER))),
    ),
    Event.CONTROL_DUE: row(
        during(NO_VEHICLE, STALE, GROUNDED, TAKING_OFF, then=unchanged),
        during(HOVERING, then=ask_for_guided),
        during(VERIFYING, then=cannot_happen),
        during(MOVING, STREAMING, TAKING_PICTURE, FLYING_MISSION, then=unchanged),
        during(RETURNING, LANDING, HOLDING, EXTERNAL, then=unchanged),
    ),
    Event.HOLD_DUE: row(
        during(NO_VEHICLE, STALE, GROUNDED, then=repeat_hold),
        during(TAKING_OFF, HOVERING, then=unchanged),
        during(VERIFYING, then=cannot_happen),
        during(MOVING, STREAMING, TAKING_PICTURE, FLYING_MISSION, then=unchanged),
        during(RETURNING, LANDING, then=unchanged),
        during(HOLDING, EXTERNAL, then=repeat_hold),
    ),
}
