"""Rows of the table: whether the vehicle is heard, and what its position says.

A position that is too old or that jumps, a home or a fence that moves, a predicted breach.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

from gcs.gate.effects import OutcomeKind
from gcs.gate.machine.actions import Action
from gcs.gate.machine.events import Event
from gcs.gate.machine.guards import Guard
from gcs.gate.machine.rows.cells import (
    AS_JUDGED,
    cannot_happen,
    disarm_if_on_ground,
    hold_and_end,
    hold_if_awaited,
    stop_stream_if,
    unchanged,
)
from gcs.gate.machine.rows.row import (
    BACK,
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

LINK_LOST: Final = End(OutcomeKind.ABORTED, Code.LINK_LOST)
POSITION_TOO_OLD: Final = End(OutcomeKind.ABORTED, Code.STALE)
POSITION_JUMPED: Final = End(OutcomeKind.ABORTED, Code.ESTIMATOR_RESET)
HOME_MOVED: Final = End(OutcomeKind.ABORTED, Code.HOME_MOVED)
FENCE_BREACH: Final = End(OutcomeKind.ABORTED, Code.FENCE_BREACH)

to_stale: Final = Branch(to=STALE)
forget_vehicle: Final = Branch(
    ends=LINK_LOST,
    do=(Action.RELEASE_CONTROL, Action.FORGET_VEHICLE),
    to=NO_VEHICLE,
)
# A hold that was asked for is commanded on, whether or not the vehicle is heard.
forget_vehicle_and_repeat_hold_if_awaited: Final = Branch(
    when=(Guard.HOLD_AWAITED, Guard.HOLD_REQUESTED),
    ends=LINK_LOST,
    do=(Action.RELEASE_CONTROL, Action.FORGET_VEHICLE, Action.REPEAT_HOLD),
    to=NO_VEHICLE,
)
lose_vehicle: Final[Cell] = (forget_vehicle_and_repeat_hold_if_awaited, forget_vehicle)
arm_if_it_waited_for_the_position: Final = Branch(
    when=(
        Guard.TASK_IS_ARM,
        Guard.TASK_WAITS,
        Guard.ON_GROUND,
        Guard.SEVERITY_PERMITS,
    ),
    do=(Action.ARM,),
    to=GROUNDED,
)
leave_stale: Final[Cell] = (
    Branch(when=(Guard.RETURNS_TO_STATE,), to=BACK),
    arm_if_it_waited_for_the_position,
    Branch(when=(Guard.ON_GROUND,), to=GROUNDED),
    hold_if_awaited,
    Branch(when=(Guard.DISARMED,), to=GROUNDED),
    Branch(when=(Guard.MODE_RETURN,), to=RETURNING),
    Branch(when=(Guard.MODE_LAND,), to=LANDING),
    Branch(to=EXTERNAL),
)
start_grace: Final = Branch(do=(Action.START_GRACE,), to=STALE)
# A client's sample cannot be verified without a position: the hold in its place is what goes on.
hold_in_place_and_start_grace: Final = Branch(
    do=(Action.HOLD_IN_PLACE, Action.START_GRACE), to=STALE
)
stop_stream_if_grace_over_and_hold_awaited: Final = Branch(
    when=(Guard.IN_GRACE, Guard.GRACE_OVER, Guard.HOLD_AWAITED, Guard.TASK_ENDS_HELD),
    do=(Action.STOP_STREAM,),
)
hold_if_grace_over: Final = Branch(
    when=(Guard.IN_GRACE, Guard.GRACE_OVER),
    ends=POSITION_TOO_OLD,
    do=(Action.STOP_STREAM, Action.HOLD),
)
verify_held_point: Final = Branch(do=(Action.VERIFY_HELD_POINT,))
# Until the vehicle shows the mode in which it lands or returns, it is held in its place.
verify_held_point_if_held: Final = Branch(
    when=(Guard.HELD_IN_PLACE,), do=(Action.VERIFY_HELD_POINT,)
)
brake: Final = Branch(ends=FENCE_BREACH, do=(Action.BRAKE, Action.HOLD), to=HOLDING)
# A late sample is predicted too; only a vehicle that is held already is not braked.
brake_if_it_returns_to_flight: Final = Branch(
    when=(Guard.RETURNS_TO_FLIGHT,),
    ends=FENCE_BREACH,
    do=(Action.BRAKE, Action.HOLD),
    to=HOLDING,
)


def hold_if_in_control(outcome: End) -> Branch:
    """A return that we commanded is held; one that the vehicle began by itself is not."""
    return Branch(when=(Guard.IN_CONTROL,), ends=outcome, do=(Action.HOLD,), to=HOLDING)


POSITION_ROWS: Final[Mapping[Event, Row]] = {
    Event.VEHICLE_HEARD: row(
        during(NO_VEHICLE, then=to_stale),
        during(STALE, GROUNDED, TAKING_OFF, HOVERING, VERIFYING, then=cannot_happen),
        during(MOVING, STREAMING, TAKING_PICTURE, FLYING_MISSION, then=cannot_happen),
        during(RETURNING, LANDING, HOLDING, EXTERNAL, then=cannot_happen),
    ),
    Event.VEHICLE_LOST: row(
        during(NO_VEHICLE, then=unchanged),
        during(GROUNDED, then=forget_vehicle),
        during(STALE, TAKING_OFF, HOVERING, then=lose_vehicle),
        during(VERIFYING, then=cannot_happen),
        during(MOVING, STREAMING, TAKING_PICTURE, FLYING_MISSION, then=lose_vehicle),
        during(RETURNING, LANDING, HOLDING, EXTERNAL, then=lose_vehicle),
    ),
    Event.POSITION: row(
        during(NO_VEHICLE, then=unchanged),
        during(STALE, then=leave_stale),
        during(GROUNDED, TAKING_OFF, HOVERING, then=unchanged),
        during(VERIFYING, then=cannot_happen),
        during(MOVING, STREAMING, TAKING_PICTURE, FLYING_MISSION, then=unchanged),
        during(RETURNING, LANDING, HOLDING, EXTERNAL, then=unchanged),
    ),
    Event.POSITION_AGED: row(
        during(NO_VEHICLE, then=unchanged),
        during(
            STALE,
            then=(stop_stream_if_grace_over_and_hold_awaited, hold_if_grace_over, unchanged),
        ),
        during(GROUNDED, then=to_stale),
        during(TAKING_OFF, HOVERING, then=start_grace),
        during(VERIFYING, then=cannot_happen),
        during(MOVING, TAKING_PICTURE, FLYING_MISSION, then=start_grace),
        during(STREAMING, then=hold_in_place_and_start_grace),
        during(RETURNING, LANDING, then=unchanged),
        during(HOLDING, then=start_grace),
        during(EXTERNAL, then=to_stale),
    ),
    Event.POSITION_JUMPED: row(
        during(NO_VEHICLE, then=unchanged),
        during(STALE, then=(stop_stream_if(Guard.IN_GRACE, POSITION_JUMPED), unchanged)),
        during(GROUNDED, then=unchanged),
        during(TAKING_OFF, HOVERING, then=hold_and_end(POSITION_JUMPED)),
        during(VERIFYING, then=cannot_happen),
        during(MOVING, STREAMING, TAKING_PICTURE, then=hold_and_end(POSITION_JUMPED)),
        during(FLYING_MISSION, then=hold_and_end(POSITION_JUMPED)),
        during(RETURNING, then=(hold_if_in_control(POSITION_JUMPED), unchanged)),
        during(LANDING, then=(verify_held_point_if_held, unchanged)),
        during(HOLDING, then=verify_held_point),
        during(EXTERNAL, then=unchanged),
    ),
    Event.HOME_MOVED: row(
        during(NO_VEHICLE, then=unchanged),
        during(STALE, then=(stop_stream_if(Guard.IN_GRACE, HOME_MOVED), unchanged)),
        during(GROUNDED, then=unchanged),
        during(TAKING_OFF, HOVERING, then=hold_and_end(HOME_MOVED)),
        during(VERIFYING, then=cannot_happen),
        during(MOVING, STREAMING, TAKING_PICTURE, then=hold_and_end(HOME_MOVED)),
        during(FLYING_MISSION, then=hold_and_end(HOME_MOVED)),
        during(RETURNING, then=(hold_if_in_control(HOME_MOVED), unchanged)),
        during(LANDING, then=(verify_held_point_if_held, unchanged)),
        during(HOLDING, then=verify_held_point),
        during(EXTERNAL, then=unchanged),
    ),
    Event.CLEARS_NO_MORE: row(
        during(NO_VEHICLE, then=unchanged),
        during(STALE, then=(stop_stream_if(Guard.IN_GRACE, AS_JUDGED), unchanged)),
        during(GROUNDED, then=unchanged),
        during(TAKING_OFF, then=(disarm_if_on_ground(AS_JUDGED), hold_and_end(AS_JUDGED))),
        during(HOVERING, then=hold_and_end(AS_JUDGED)),
        during(VERIFYING, then=cannot_happen),
        during(MOVING, STREAMING, TAKING_PICTURE, then=hold_and_end(AS_JUDGED)),
        during(FLYING_MISSION, then=hold_and_end(AS_JUDGED)),
        during(RETURNING, LANDING, then=(verify_held_point_if_held, unchanged)),
        during(HOLDING, then=verify_held_point),
        during(EXTERNAL, then=unchanged),
    ),
    Event.BREACH: row(
        during(NO_VEHICLE, then=unchanged),
        during(STALE, then=(brake_if_it_returns_to_flight, unchanged)),
        during(GROUNDED, then=unchanged),
        during(TAKING_OFF, HOVERING, then=brake),
        during(VERIFYING, then=cannot_happen),
        during(MOVING, STREAMING, TAKING_PICTURE, FLYING_MISSION, then=brake),
        during(RETURNING, then=brake),
        during(LANDING, HOLDING, EXTERNAL, then=unchanged),
    ),
}
