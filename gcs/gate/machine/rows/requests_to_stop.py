"""Rows of the table: requests that make it safer.

Disarming, landing, the return home, hold and abort.  But for the return, they are accepted
whether or not an operator is there.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

from gcs.gate.machine.actions import Action
from gcs.gate.machine.events import Event
from gcs.gate.machine.guards import Guard
from gcs.gate.machine.rows.cells import (
    STOPPED_BY_OPERATOR,
    cannot_happen,
    refuse,
    refuse_if_operator_lost,
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
from gcs.gate.machine.step_context import Reply
from gcs.gate.refusal import Code

complete_if_surely_on_ground: Final = Branch(when=(Guard.SURELY_ON_GROUND,), reply=Reply.DONE)
complete_if_disarmed_and_idle: Final = Branch(when=(Guard.DISARMED_AND_IDLE,), reply=Reply.DONE)

# ------------------------------------------------------------------------------- disarming

disarm: Final = Branch(reply=Reply.ACCEPTED, do=(Action.DISARM,))
disarm_if_on_ground: Final = Branch(
    when=(Guard.ON_GROUND,),
    reply=Reply.ACCEPTED,
    do=(Action.RELEASE_CONTROL, Action.DISARM),
    to=GROUNDED,
)
complete_if_on_ground_disarmed_and_idle: Final = Branch(
    when=(Guard.ON_GROUND, Guard.DISARMED_AND_IDLE), reply=Reply.DONE
)
disarm_in_stale_if_on_ground: Final = Branch(
    when=(Guard.ON_GROUND,),
    reply=Reply.ACCEPTED,
    do=(Action.FORGET_INTERRUPTED, Action.DISARM),
)

disarm_or_refuse_in_air: Final[Cell] = (disarm_if_on_ground, refuse(Code.IN_AIR))
force_disarm: Final[Cell] = (
    disarm_if_on_ground,
    refuse_if_operator_lost,
    Branch(when=(Guard.FORCE_DISARM_FORBIDDEN,), refuse=Code.POLICY),
    Branch(
        when=(Guard.FORCE_DISARM_UNCONFIRMED,),
        refuse=Code.IN_AIR,
        do=(Action.NOTE_FORCE_REQUEST,),
    ),
    Branch(
        reply=Reply.ACCEPTED,
        do=(Action.RELEASE_CONTROL, Action.FORCE_DISARM),
        to=EXTERNAL,
    ),
)

# ----------------------------------------------------------------------- landing and return

land: Final = Branch(reply=Reply.ACCEPTED, do=(Action.LAND,), to=LANDING)
land_mode_if_heard_before: Final = Branch(
    when=(Guard.HEARD_BEFORE,), reply=Reply.ACCEPTED, do=(Action.LAND_MODE_ONLY,)
)
return_if_path_clears: Final = Branch(
    when=(Guard.RETURN_PATH_CLEARS,), reply=Reply.ACCEPTED, do=(Action.RETURN,), to=RETURNING
)
return_if_policy_forwards_it: Final = Branch(
    when=(Guard.BLOCKED_RETURN_FORWARDED,),
    reply=Reply.ACCEPTED,
    do=(Action.RETURN,),
    to=RETURNING,
)
refuse_and_land_if_policy_lands: Final = Branch(
    when=(Guard.BLOCKED_RETURN_LANDS,),
    refuse=Code.RTL_BLOCKED,
    ends=STOPPED_BY_OPERATOR,
    do=(Action.LAND,),
    to=LANDING,
)
refuse_return_and_hold: Final = Branch(
    refuse=Code.RTL_BLOCKED, ends=STOPPED_BY_OPERATOR, do=(Action.HOLD,), to=HOLDING
)
refuse_return_and_stop_stream: Final = Branch(
    refuse=Code.RTL_BLOCKED, ends=STOPPED_BY_OPERATOR, do=(Action.STOP_STREAM, Action.HOLD)
)
return_home: Final[Cell] = (
    return_if_path_clears,
    return_if_policy_forwards_it,
    refuse_and_land_if_policy_lands,
    refuse_return_and_hold,
)

# --------------------------------------------------------------------------- hold and abort

hold: Final = Branch(reply=Reply.ACCEPTED, ends=STOPPED_BY_OPERATOR, do=(Action.HOLD,), to=HOLDING)
hold_mode_if_surely_on_ground: Final = Branch(
    when=(Guard.SURELY_ON_GROUND,),
    reply=Reply.ACCEPTED,
    ends=STOPPED_BY_OPERATOR,
    do=(Action.HOLD_MODE_ONLY,),
)
hold_mode_if_on_ground: Final = Branch(
    when=(Guard.ON_GROUND,),
    reply=Reply.ACCEPTED,
    ends=STOPPED_BY_OPERATOR,
    do=(Action.HOLD_MODE_ONLY,),
)
hold_and_disarm_if_on_ground: Final = Branch(
    when=(Guard.ON_GROUND,),
    reply=Reply.ACCEPTED,
    ends=STOPPED_BY_OPERATOR,
    do=(Action.RELEASE_CONTROL, Action.HOLD_MODE_ONLY, Action.DISARM),
    to=GROUNDED,
)
stop_stream_and_hold: Final = Branch(
    reply=Reply.ACCEPTED, ends=STOPPED_BY_OPERATOR, do=(Action.STOP_STREAM, Action.HOLD)
)
hold_mode_if_heard_before: Final = Branch(
    when=(Guard.HEARD_BEFORE,),
    reply=Reply.ACCEPTED,
    ends=STOPPED_BY_OPERATOR,
    do=(Action.HOLD_MODE_ONLY,),
)
disarm_if_surely_on_ground: Final = Branch(
    when=(Guard.SURELY_ON_GROUND,),
    reply=Reply.ACCEPTED,
    ends=STOPPED_BY_OPERATOR,
    do=(Action.DISARM,),
)
complete_if_surely_on_ground_and_disarmed: Final = Branch(
    when=(Guard.SURELY_ON_GROUND, Guard.DISARMED_AND_IDLE), reply=Reply.DONE
)
hold_and_disarm_in_stale_if_on_ground: Final = Branch(
    when=(Guard.ON_GROUND,),
    reply=Reply.ACCEPTED,
    ends=STOPPED_BY_OPERATOR,
    do=(Action.FORGET_INTERRUPTED, Action.HOLD_MODE_ONLY, Action.DISARM),
)

abort_in_stale: Final[Cell] = (
    complete_if_surely_on_ground_and_disarmed,
    disarm_if_surely_on_ground,
    hold_and_disarm_in_stale_if_on_ground,
    stop_stream_and_hold,
)
abort_on_ground: Final[Cell] = (
    complete_if_disarmed_and_idle,
    disarm_if_surely_on_ground,
    hold_and_disarm_if_on_ground,
    hold,
)

REQUEST_TO_STOP_ROWS: Final[Mapping[Event, Row]] = {
    Event.DISARM: row(
        during(NO_VEHICLE, then=refuse(Code.NO_VEHICLE)),
        during(
            STALE,
            then=(
                complete_if_on_ground_disarmed_and_idle,
                disarm_in_stale_if_on_ground,
                refuse(Code.IN_AIR),
            ),
        ),
        during(GROUNDED, then=(complete_if_disarmed_and_idle, disarm)),
        during(TAKING_OFF, HOVERING, then=disarm_or_refuse_in_air),
        during(VERIFYING, then=cannot_happen),
        during(MOVING, STREAMING, TAKING_PICTURE, then=disarm_or_refuse_in_air),
        during(FLYING_MISSION, RETURNING, LANDING, then=disarm_or_refuse_in_air),
        during(HOLDING, EXTERNAL, then=disarm_or_refuse_in_air),
    ),
    Event.FORCE_DISARM: row(
        during(NO_VEHICLE, then=refuse(Code.NO_VEHICLE)),
        during(STALE, then=force_disarm),
        during(GROUNDED, then=(complete_if_disarmed_and_idle, disarm)),
        during(TAKING_OFF, HOVERING, then=force_disarm),
        during(VERIFYING, then=cannot_happen),
        during(MOVING, STREAMING, TAKING_PICTURE, FLYING_MISSION, then=force_disarm),
        during(RETURNING, LANDING, HOLDING, EXTERNAL, then=force_disarm),
    ),
    Event.LAND: row(
        during(NO_VEHICLE, then=(land_mode_if_heard_before, refuse(Code.NO_VEHICLE))),
        during(STALE, GROUNDED, then=(complete_if_surely_on_ground, land)),
        during(TAKING_OFF, HOVERING, then=land),
        during(VERIFYING, then=cannot_happen),
        during(MOVING, STREAMING, TAKING_PICTURE, FLYING_MISSION, then=land),
        during(RETURNING, LANDING, HOLDING, EXTERNAL, then=land),
    ),
    Event.RETURN: row(
        during(NO_VEHICLE, then=refuse(Code.NO_VEHICLE)),
        during(STALE, then=(complete_if_surely_on_ground, refuse_return_and_stop_stream)),
        during(GROUNDED, then=(complete_if_surely_on_ground, *return_home)),
        during(TAKING_OFF, HOVERING, then=return_home),
        during(VERIFYING, then=cannot_happen),
        during(MOVING, STREAMING, TAKING_PICTURE, FLYING_MISSION, then=return_home),
        during(RETURNING, then=return_home),
        during(
            LANDING,
            then=(return_if_path_clears, return_if_policy_forwards_it, refuse(Code.RTL_BLOCKED)),
        ),
        during(HOLDING, EXTERNAL, then=return_home),
    ),
    Event.HOLD: row(
        during(NO_VEHICLE, then=(hold_mode_if_heard_before, refuse(Code.NO_VEHICLE))),
        during(STALE, then=(hold_mode_if_surely_on_ground, stop_stream_and_hold)),
        during(GROUNDED, then=(hold_mode_if_on_ground, hold)),
        during(TAKING_OFF, then=(hold_and_disarm_if_on_ground, hold)),
        during(HOVERING, then=hold),
        during(VERIFYING, then=cannot_happen),
        during(MOVING, STREAMING, TAKING_PICTURE, FLYING_MISSION, then=hold),
        during(RETURNING, LANDING, HOLDING, EXTERNAL, then=hold),
    ),
    Event.ABORT: row(
        during(NO_VEHICLE, then=(hold_mode_if_heard_before, refuse(Code.NO_VEHICLE))),
        during(STALE, then=abort_in_stale),
        during(GROUNDED, then=abort_on_ground),
        during(TAKING_OFF, then=(hold_and_disarm_if_on_ground, hold)),
        during(HOVERING, then=hold),
        during(VERIFYING, then=cannot_happen),
        during(MOVING, STREAMING, TAKING_PICTURE, FLYING_MISSION, then=hold),
        during(RETURNING, LANDING, HOLDING, EXTERNAL, then=hold),
    ),
}
