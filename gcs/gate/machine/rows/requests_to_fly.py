"""Rows of the table: requests to fly, and what prepares for it.

Goals, control, arming, take-off, pictures, missions, and the switch of the fence.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

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
from gcs.gate.machine.step_context import Reply
from gcs.gate.refusal import Code

refuse_while_taking_control: Final = Branch(
    when=(Guard.TAKING_CONTROL,), refuse=Code.CONTROL_PENDING
)
refuse_while_goal_pending: Final = Branch(when=(Guard.GOAL_PENDING,), refuse=Code.BUSY)
refuse_while_task_under_way: Final = Branch(when=(Guard.TASK_UNDER_WAY,), refuse=Code.BUSY)
refuse_unless_airborne: Final = Branch(when=(Guard.NOT_AIRBORNE,), refuse=Code.NOT_FLYING)

resume_first: Final[Cell] = (
    Branch(when=(Guard.POSITION_CLEARS,), refuse=Code.HOLDING),
    refuse(Code.HOLDING),
)
"""Where the held position clears, and where it does not: the guard leaves the reason."""

# While control is being taken, the tick waits for it too (`rows/time.py`).
wait_for_tick: Final = Branch(needs=(Check.SEVERITY,), reply=Reply.PENDING)
replace_goal_if_policy_allows: Final = Branch(
    when=(Guard.RETARGET_ALLOWED,), needs=(Check.SEVERITY,), reply=Reply.PENDING
)
wait_for_top_if_near: Final = Branch(
    when=(Guard.RETARGET_ALLOWED, Guard.NEARLY_AT_HEIGHT),
    needs=(Check.SEVERITY,),
    reply=Reply.PENDING,
)
end_own_stream_and_wait_for_tick: Final = Branch(
    when=(Guard.OWN_STREAM,),
    needs=(Check.SEVERITY,),
    reply=Reply.PENDING,
    do=(Action.END_STREAM,),
    to=HOVERING,
)
take_control: Final = Branch(
    # Outside the fence both refuse; the position says what is possible there.
    needs=(Check.POSITION, Check.SEVERITY),
    reply=Reply.ACCEPTED,
    do=(Action.TAKE_CONTROL,),
    to=HOVERING,
)
come_back_inside: Final = Branch(
    when=(Guard.WAY_BACK_CLEARS,),
    needs=(Check.SEVERITY_BUT_FENCE,),
    reply=Reply.ACCEPTED,
    do=(Action.TAKE_CONTROL_ON_WAY_BACK,),
    to=HOVERING,
)
guided_on_ground: Final[Cell] = (
    Branch(when=(Guard.STANDS_IN_GUIDED, Guard.TASK_UNDER_WAY), refuse=Code.BUSY),
    Branch(when=(Guard.STANDS_IN_GUIDED, Guard.MODE_GUIDED), reply=Reply.DONE),
    Branch(when=(Guard.STANDS_IN_GUIDED,), reply=Reply.ACCEPTED, do=(Action.SET_GUIDED,)),
    refuse(Code.NOT_FLYING),
)
complete_if_armed: Final = Branch(when=(Guard.ARMED,), reply=Reply.DONE)
refuse_while_something_waits_for_a_position: Final = Branch(
    when=(Guard.NO_POSITION_YET, Guard.TASK_UNDER_WAY), refuse=Code.BUSY
)
arm_when_there_is_a_position: Final = Branch(
    when=(Guard.NO_POSITION_YET, Guard.ON_GROUND, Guard.DISARMED),
    needs=(Check.SEVERITY, Check.RECORDER, Check.PREFLIGHT),
    reply=Reply.ACCEPTED,
    do=(Action.AWAIT_POSITION,),
)
arm: Final = Branch(
    needs=(Check.SEVERITY, Check.RECORDER, Check.PREFLIGHT),
    reply=Reply.ACCEPTED,
    do=(Action.ARM,),
)
take_off: Final = Branch(
    needs=(Check.ARMED, Check.ON_GROUND, Check.SEVERITY, Check.CLIMB),
    reply=Reply.ACCEPTED,
    do=(Action.TAKE_OFF,),
    to=TAKING_OFF,
)
take_photo: Final = Branch(reply=Reply.ACCEPTED, do=(Action.TAKE_PHOTO,), to=TAKING_PICTURE)
start_mission_in_flight: Final = Branch(
    needs=(Check.SEVERITY, Check.HOME_AND_FENCE, Check.MISSION),
    reply=Reply.ACCEPTED,
    do=(Action.START_MISSION,),
    to=FLYING_MISSION,
)
start_mission_on_ground: Final = Branch(
    needs=(
        Check.ARMED,
        Check.ON_GROUND,
        Check.SEVERITY,
        Check.HOME_AND_FENCE,
        Check.MISSION,
    ),
    reply=Reply.ACCEPTED,
    do=(Action.START_MISSION,),
    to=FLYING_MISSION,
)
switch_fence: Final[Cell] = (
    Branch(when=(Guard.FENCE_SWITCHABLE,), reply=Reply.DONE, do=(Action.SWITCH_FENCE,)),
    refuse(Code.POLICY),
)

REQUEST_TO_FLY_ROWS: Final[Mapping[Event, Row]] = {
    Event.GOTO: row(
        during(NO_VEHICLE, then=refuse(Code.NO_VEHICLE)),
        during(STALE, then=refuse(Code.STALE)),
        during(GROUNDED, then=refuse(Code.NOT_FLYING)),
        during(TAKING_OFF, then=(wait_for_top_if_near, refuse(Code.BUSY))),
        during(HOVERING, then=wait_for_tick),
        during(VERIFYING, then=cannot_happen),
        during(MOVING, then=(replace_goal_if_policy_allows, refuse(Code.BUSY))),
        during(STREAMING, then=(end_own_stream_and_wait_for_tick, refuse(Code.BUSY))),
        during(TAKING_PICTURE, FLYING_MISSION, then=refuse(Code.BUSY)),
        during(RETURNING, LANDING, then=busy_or_not_ours),
        during(HOLDING, then=resume_first),
        during(EXTERNAL, then=refuse(Code.NOT_IN_CONTROL)),
    ),
    Event.CONTROL: row(
        during(NO_VEHICLE, then=refuse(Code.NO_VEHICLE)),
        during(STALE, then=refuse(Code.STALE)),
        during(GROUNDED, then=guided_on_ground),
        during(TAKING_OFF, then=refuse(Code.BUSY)),
        during(HOVERING, then=(refuse_while_taking_control, complete_at_once)),
        during(VERIFYING, then=cannot_happen),
        during(MOVING, STREAMING, TAKING_PICTURE, FLYING_MISSION, then=complete_at_once),
        during(RETURNING, LANDING, then=busy_or_not_ours),
        during(HOLDING, then=refuse(Code.HOLDING)),
        during(EXTERNAL, then=(refuse_unless_airborne, come_back_inside, take_control)),
    ),
    Event.RESUME: row(
        during(NO_VEHICLE, then=refuse(Code.NO_VEHICLE)),
        during(STALE, then=refuse(Code.STALE)),
        during(GROUNDED, then=refuse(Code.NOT_FLYING)),
        during(TAKING_OFF, then=refuse(Code.BUSY)),
        during(HOVERING, then=(refuse_while_taking_control, complete_at_once)),
        during(VERIFYING, then=cannot_happen),
        during(MOVING, STREAMING, TAKING_PICTURE, FLYING_MISSION, then=refuse(Code.BUSY)),
        during(RETURNING, LANDING, then=busy_or_not_ours),
        during(HOLDING, EXTERNAL, then=(refuse_unless_airborne, come_back_inside, take_control)),
    ),
    Event.ARM: row(
        during(NO_VEHICLE, then=refuse(Code.NO_VEHICLE)),
        during(
            STALE,
            then=(
                refuse_while_something_waits_for_a_position,
                arm_when_there_is_a_position,
                refuse(Code.STALE),
            ),
        ),
        during(GROUNDED, then=(refuse_while_task_under_way, complete_if_armed, arm)),
        during(TAKING_OFF, HOVERING, then=refuse(Code.ALREADY_FLYING)),
        during(VERIFYING, then=cannot_happen),
        during(MOVING, STREAMING, TAKING_PICTURE, then=refuse(Code.ALREADY_FLYING)),
        during(FLYING_MISSION, RETURNING, LANDING, then=refuse(Code.ALREADY_FLYING)),
        during(HOLDING, EXTERNAL, then=refuse(Code.ALREADY_FLYING)),
    ),
    Event.TAKE_OFF: row(
        during(NO_VEHICLE, then=refuse(Code.NO_VEHICLE)),
        during(STALE, then=refuse(Code.STALE)),
        during(GROUNDED, then=(refuse_while_task_under_way, take_off)),
        during(TAKING_OFF, HOVERING, then=refuse(Code.ALREADY_FLYING)),
        during(VERIFYING, then=cannot_happen),
        during(MOVING, STREAMING, TAKING_PICTURE, then=refuse(Code.ALREADY_FLYING)),
        during(FLYING_MISSION, RETURNING, LANDING, then=refuse(Code.ALREADY_FLYING)),
        during(HOLDING, EXTERNAL, then=refuse(Code.ALREADY_FLYING)),
    ),
    Event.PHOTO: row(
        during(NO_VEHICLE, then=refuse(Code.NO_VEHICLE)),
        during(STALE, then=refuse(Code.STALE)),
        during(GROUNDED, then=refuse(Code.NOT_FLYING)),
        during(TAKING_OFF, then=refuse(Code.BUSY)),
        during(HOVERING, then=(refuse_while_taking_control, refuse_while_goal_pending, take_photo)),
        during(VERIFYING, then=cannot_happen),
        during(MOVING, STREAMING, TAKING_PICTURE, FLYING_MISSION, then=refuse(Code.BUSY)),
        during(RETURNING, LANDING, then=busy_or_not_ours),
        during(HOLDING, then=refuse(Code.HOLDING)),
        during(EXTERNAL, then=refuse(Code.NOT_IN_CONTROL)),
    ),
    Event.MISSION: row(
        during(NO_VEHICLE, then=refuse(Code.NO_VEHICLE)),
        during(STALE, then=refuse(Code.STALE)),
        during(GROUNDED, then=(refuse_while_task_under_way, start_mission_on_ground)),
        during(TAKING_OFF, then=refuse(Code.BUSY)),
        during(
            HOVERING,
            then=(refuse_while_taking_control, refuse_while_goal_pending, start_mission_in_flight),
        ),
        during(VERIFYING, then=cannot_happen),
        during(MOVING, STREAMING, TAKING_PICTURE, FLYING_MISSION, then=refuse(Code.BUSY)),
        during(RETURNING, LANDING, then=busy_or_not_ours),
        during(HOLDING, then=refuse(Code.HOLDING)),
        during(EXTERNAL, then=refuse(Code.NOT_IN_CONTROL)),
    ),
    Event.OTHER_MODE: row(
        during(NO_VEHICLE, then=refuse(Code.NO_VEHICLE)),
        during(STALE, GROUNDED, TAKING_OFF, HOVERING, then=refuse(Code.UNSUPPORTED)),
        during(VERIFYING, then=cannot_happen),
        during(MOVING, STREAMING, TAKING_PICTURE, FLYING_MISSION, then=refuse(Code.UNSUPPORTED)),
        during(RETURNING, LANDING, HOLDING, EXTERNAL, then=refuse(Code.UNSUPPORTED)),
    ),
    Event.FENCE: row(
        during(NO_VEHICLE, STALE, GROUNDED, then=switch_fence),
        during(TAKING_OFF, HOVERING, then=switch_fence),
        during(VERIFYING, then=cannot_happen),
        during(MOVING, STREAMING, TAKING_PICTURE, FLYING_MISSION, then=switch_fence),
        during(RETURNING, LANDING, HOLDING, EXTERNAL, then=switch_fence),
    ),
}
