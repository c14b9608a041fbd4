"""Rows of the table: whether the vehicle is armed, and whether it flies or stands."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

from gcs.gate.effects import OutcomeKind
from gcs.gate.machine.actions import Action
from gcs.gate.machine.events import Event
from gcs.gate.machine.guards import Guard
from gcs.gate.machine.rows.cells import (
    COMPLETE,
    LIFTED_OFF,
    OPERATOR_LOST,
    SEVERITY,
    STOPPED_BY_OPERATOR,
    TAKEN_OVER,
    cannot_happen,
    hold_if_awaited,
    release_and_end,
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

DISARMED: Final = End(OutcomeKind.TAKEN_OVER, Code.NOT_ARMED)
ON_GROUND: Final = End(OutcomeKind.TAKEN_OVER, Code.NOT_FLYING)

# ---------------------------------------------------------------------- armed and disarmed

complete_if_task_is_arm: Final = Branch(when=(Guard.TASK_IS_ARM,), ends=COMPLETE)
complete_if_task_ends_disarmed: Final = Branch(
    when=(Guard.TASK_ENDS_DISARMED,), ends=COMPLETE, do=(Action.CONFIRM_HOLD,)
)
confirm_hold_if_awaited: Final = Branch(when=(Guard.HOLD_AWAITED,), do=(Action.CONFIRM_HOLD,))
complete_in_stale_if_task_ends_disarmed: Final = Branch(
    when=(Guard.TASK_ENDS_DISARMED,), ends=COMPLETE, do=(Action.FORGET_INTERRUPTED,)
)
end_if_it_returns_to_state: Final = Branch(
    when=(Guard.RETURNS_TO_STATE,), ends=DISARMED, do=(Action.FORGET_INTERRUPTED,)
)
disarmed: Final[Cell] = (
    Branch(
        when=(Guard.TASK_ENDS_DISARMED,),
        ends=COMPLETE,
        do=(Action.RELEASE_CONTROL,),
        to=GROUNDED,
    ),
    release_and_end(DISARMED, GROUNDED),
)

# ------------------------------------------------------------------- in the air, on ground

lifted_off_from_ground: Final[Cell] = (
    Branch(
        when=(Guard.TAKE_OFF_MAY_COME_LATE,),
        ends=STOPPED_BY_OPERATOR,
        do=(Action.HOLD,),
        to=HOLDING,
    ),
    hold_if_awaited,
    Branch(
        when=(Guard.MISSION_GOES_ON, Guard.OPERATOR_LOST),
        ends=OPERATOR_LOST,
        do=(Action.HOLD,),
        to=HOLDING,
    ),
    Branch(
        when=(Guard.MISSION_GOES_ON, Guard.SEVERITY_PERMITS),
        do=(Action.DROP_DEADLINE, Action.GAIN_CONTROL),
        to=FLYING_MISSION,
    ),
    Branch(when=(Guard.MISSION_GOES_ON,), ends=SEVERITY, do=(Action.HOLD,), to=HOLDING),
    Branch(when=(Guard.MODE_LAND, Guard.TASK_ENDS_LANDED), do=(Action.AWAIT_LANDING,), to=LANDING),
    Branch(when=(Guard.MODE_LAND,), ends=LIFTED_OFF, to=LANDING),
    Branch(
        when=(Guard.MODE_RETURN, Guard.TASK_ENDS_LANDED), do=(Action.DROP_DEADLINE,), to=RETURNING
    ),
    Branch(when=(Guard.MODE_RETURN,), ends=LIFTED_OFF, to=RETURNING),
    release_and_end(TAKEN_OVER, EXTERNAL),
)
note_lift_off: Final = Branch(do=(Action.NOTE_LIFT_OFF,))

end_on_ground: Final = release_and_end(ON_GROUND, GROUNDED)
end_on_ground_if_it_returns_to_state: Final = Branch(
    when=(Guard.RETURNS_TO_STATE,), ends=ON_GROUND, do=(Action.FORGET_INTERRUPTED,)
)
end_on_ground_if_lifted_off: Final = Branch(
    when=(Guard.LIFTED_OFF,), ends=ON_GROUND, do=(Action.RELEASE_CONTROL,), to=GROUNDED
)
complete_if_task_ends_held: Final = Branch(
    when=(Guard.TASK_ENDS_HELD,), ends=COMPLETE, do=(Action.RELEASE_CONTROL,), to=GROUNDED
)
complete_if_disarmed: Final = Branch(
    when=(Guard.DISARMED,), ends=COMPLETE, do=(Action.RELEASE_CONTROL,), to=GROUNDED
)
wait_for_disarm: Final = Branch(do=(Action.RELEASE_CONTROL, Action.AWAIT_DISARM), to=GROUNDED)
complete_if_lifted_off_and_disarmed: Final = Branch(
    when=(Guard.LIFTED_OFF, Guard.DISARMED),
    ends=COMPLETE,
    do=(Action.RELEASE_CONTROL,),
    to=GROUNDED,
)
wait_for_disarm_if_lifted_off: Final = Branch(
    when=(Guard.LIFTED_OFF,), do=(Action.RELEASE_CONTROL, Action.AWAIT_DISARM), to=GROUNDED
)

FLIGHT_ROWS: Final[Mapping[Event, Row]] = {
    Event.ARMED: row(
        during(NO_VEHICLE, then=unchanged),
        during(STALE, GROUNDED, then=(complete_if_task_is_arm, unchanged)),
        during(TAKING_OFF, HOVERING, then=unchanged),
        during(VERIFYING, then=cannot_happen),
        during(MOVING, STREAMING, TAKING_PICTURE, FLYING_MISSION, then=unchanged),
        during(RETURNING, LANDING, HOLDING, EXTERNAL, then=unchanged),
    ),
    Event.DISARMED: row(
        during(NO_VEHICLE, then=unchanged),
        during(
            STALE,
            then=(complete_in_stale_if_task_ends_disarmed, end_if_it_returns_to_state, unchanged),
        ),
        during(GROUNDED, then=(complete_if_task_ends_disarmed, confirm_hold_if_awaited, unchanged)),
        during(TAKING_OFF, HOVERING, then=disarmed),
        during(VERIFYING, then=cannot_happen),
        during(MOVING, STREAMING, TAKING_PICTURE, FLYING_MISSION, then=disarmed),
        during(RETURNING, LANDING, HOLDING, EXTERNAL, then=disarmed),
    ),
    Event.AIRBORNE: row(
        during(NO_VEHICLE, STALE, then=unchanged),
        during(GROUNDED, then=lifted_off_from_ground),
        during(TAKING_OFF, then=note_lift_off),
        during(HOVERING, then=unchanged),
        during(VERIFYING, then=cannot_happen),
        during(MOVING, STREAMING, TAKING_PICTURE, then=unchanged),
        during(FLYING_MISSION, then=note_lift_off),
        during(RETURNING, LANDING, HOLDING, EXTERNAL, then=unchanged),
    ),
    Event.LANDED: row(
        during(NO_VEHICLE, then=unchanged),
        during(STALE, then=(end_on_ground_if_it_returns_to_state, unchanged)),
        during(GROUNDED, then=unchanged),
        during(TAKING_OFF, then=(end_on_ground_if_lifted_off, unchanged)),
        during(HOVERING, then=end_on_ground),
        during(VERIFYING, then=cannot_happen),
        during(MOVING, STREAMING, TAKING_PICTURE, then=end_on_ground),
        during(
            FLYING_MISSION,
            then=(complete_if_lifted_off_and_disarmed, wait_for_disarm_if_lifted_off, unchanged),
        ),
        during(RETURNING, LANDING, then=(complete_if_disarmed, wait_for_disarm)),
        during(HOLDING, then=(complete_if_task_ends_held, end_on_ground)),
        during(EXTERNAL, then=end_on_ground),
    ),
}
