"""Rows of the table: what a mode that the heartbeat shows means in each state.

The mode that we commanded is confirmed, or is overdue.  Any other change of mode was made by
somebody else or by the vehicle itself: we release control, and the state follows the mode.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

from gcs.gate.machine.actions import Action
from gcs.gate.machine.events import Event
from gcs.gate.machine.guards import Guard
from gcs.gate.machine.rows.cells import (
    AS_JUDGED,
    COMPLETE,
    CONTROL_REGAINABLE,
    NO_ANSWER,
    TAKEN_OVER,
    cannot_happen,
    end_if_on_ground,
    release_and_end,
    release_if_taking_control,
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

unchanged_while_mode_awaited: Final = Branch(when=(Guard.MODE_AWAITED,))
unchanged_while_hold_awaited: Final = Branch(when=(Guard.HOLD_AWAITED,))
unchanged_while_taking_control: Final = Branch(when=(Guard.TAKING_CONTROL,))
unchanged_unless_airborne: Final = Branch(when=(Guard.NOT_AIRBORNE,))
unchanged_if_mode_fits_state: Final = Branch(when=(Guard.MODE_FITS_STATE,))

# -------------------------------------------------------------- the mode that we commanded

stop_awaiting_mode: Final = Branch(do=(Action.STOP_AWAITING_MODE,))
complete_if_task_ends_held: Final = Branch(
    when=(Guard.HOLD_AWAITED, Guard.TASK_ENDS_HELD), ends=COMPLETE, do=(Action.CONFIRM_HOLD,)
)
confirm_hold_if_awaited: Final = Branch(when=(Guard.HOLD_AWAITED,), do=(Action.CONFIRM_HOLD,))
send_command_that_waited_for_mode: Final = Branch(
    when=(Guard.TASK_WAITS,), do=(Action.CONFIRM_HOLD, Action.SEND_WAITING)
)
gain_control_if_taking_it: Final = Branch(
    when=(Guard.TAKING_CONTROL,), ends=COMPLETE, do=(Action.GAIN_CONTROL,)
)
fly_to_top_if_taking_off: Final = Branch(
    when=(Guard.TAKING_CONTROL, Guard.TASK_IS_TAKE_OFF, Guard.TOP_CLEARS),
    do=(Action.GAIN_CONTROL, Action.FLY_TO_TOP),
    to=MOVING,
)
# The next heartbeat confirms the mode again, with a position that can be judged.
unchanged_if_position_too_old: Final = Branch(
    when=(Guard.TAKING_CONTROL, Guard.TASK_IS_TAKE_OFF, Guard.POSITION_TOO_OLD)
)
hold_if_taking_off: Final = Branch(
    when=(Guard.TAKING_CONTROL, Guard.TASK_IS_TAKE_OFF),
    ends=AS_JUDGED,
    do=(Action.HOLD,),
    to=HOLDING,
)
stop_awaiting_if_mode_fits_state: Final = Branch(
    when=(Guard.MODE_FITS_STATE,), do=(Action.STOP_AWAITING_MODE,)
)
hold_if_guided: Final = Branch(
    when=(Guard.MODE_GUIDED,), ends=NO_ANSWER, do=(Action.HOLD,), to=HOLDING
)

complete_if_task_is_control: Final = Branch(
    when=(Guard.TASK_IS_CONTROL,), ends=COMPLETE, do=(Action.STOP_AWAITING_MODE,)
)
mode_confirmed: Final[Cell] = (
    complete_if_task_ends_held,
    send_command_that_waited_for_mode,
    confirm_hold_if_awaited,
    stop_awaiting_mode,
)
mode_overdue_on_the_way_up: Final[Cell] = (
    stop_awaiting_if_mode_fits_state,
    end_if_on_ground(NO_ANSWER),
    hold_if_guided,
    release_and_end(NO_ANSWER, EXTERNAL),
)
mode_overdue_on_the_way_down: Final[Cell] = (
    stop_awaiting_if_mode_fits_state,
    hold_if_guided,
    release_and_end(NO_ANSWER, EXTERNAL),
)

# -------------------------------------------------------- a mode that we did not command

to_external: Final = release_and_end(TAKEN_OVER, EXTERNAL)
to_returning: Final = release_and_end(TAKEN_OVER, RETURNING)
to_landing: Final = release_and_end(TAKEN_OVER, LANDING)
mission_returns: Final = Branch(to=RETURNING)
mission_lands: Final = Branch(to=LANDING)

taken_over_if_it_returns_to_state: Final = Branch(
    when=(Guard.RETURNS_TO_STATE,),
    ends=TAKEN_OVER,
    do=(Action.RELEASE_CONTROL, Action.FORGET_INTERRUPTED),
)
hold_again_if_guided_may_come_late: Final = Branch(
    when=(Guard.GUIDED_MAY_COME_LATE,), do=(Action.HOLD,)
)
hold_unasked_if_guided_may_come_late: Final = Branch(
    when=(Guard.GUIDED_MAY_COME_LATE,), do=(Action.HOLD_UNASKED,)
)
unchanged_if_hold_requested: Final = Branch(when=(Guard.HOLD_AWAITED, Guard.HOLD_REQUESTED))
# Somebody else has chosen a mode: a hold that nobody asked for gives way to it.
drop_hold_if_awaited: Final = Branch(when=(Guard.HOLD_AWAITED,), do=(Action.CONFIRM_HOLD,))
take_control_if_mission_over: Final = Branch(
    when=(Guard.MISSION_AT_LAST_ITEM, *CONTROL_REGAINABLE),
    do=(Action.TAKE_CONTROL,),
    to=HOVERING,
)
hold_if_mission_over: Final = Branch(
    when=(Guard.MISSION_AT_LAST_ITEM,), ends=COMPLETE, do=(Action.HOLD,), to=HOLDING
)

mode_of_others: Final[Cell] = (unchanged_if_hold_requested, drop_hold_if_awaited, unchanged)
mode_seen_in_stale: Final[Cell] = (
    unchanged_while_hold_awaited,
    unchanged_while_mode_awaited,
    unchanged_if_mode_fits_state,
    taken_over_if_it_returns_to_state,
    unchanged,
)

MODE_ROWS: Final[Mapping[Event, Row]] = {
    Event.MODE_CONFIRMED: row(
        during(NO_VEHICLE, then=unchanged),
        during(STALE, then=(complete_if_task_ends_held, confirm_hold_if_awaited, unchanged)),
        during(GROUNDED, then=(complete_if_task_is_control, *mode_confirmed)),
        during(TAKING_OFF, then=mode_confirmed),
        during(
            HOVERING,
            then=(
                fly_to_top_if_taking_off,
                unchanged_if_position_too_old,
                hold_if_taking_off,
                gain_control_if_taking_it,
                stop_awaiting_mode,
            ),
        ),
        during(VERIFYING, then=cannot_happen),
        during(MOVING, STREAMING, TAKING_PICTURE, then=stop_awaiting_mode),
        during(FLYING_MISSION, RETURNING, LANDING, then=stop_awaiting_mode),
        during(HOLDING, EXTERNAL, then=mode_confirmed),
    ),
    Event.MODE_OVERDUE: row(
        during(NO_VEHICLE, STALE, GROUNDED, then=stop_awaiting_mode),
        during(TAKING_OFF, then=mode_overdue_on_the_way_up),
        during(HOVERING, then=(release_if_taking_control(NO_ANSWER), stop_awaiting_mode)),
        during(VERIFYING, then=cannot_happen),
        during(MOVING, STREAMING, TAKING_PICTURE, then=stop_awaiting_mode),
        during(FLYING_MISSION, then=mode_overdue_on_the_way_up),
        during(RETURNING, LANDING, then=mode_overdue_on_the_way_down),
        during(HOLDING, EXTERNAL, then=stop_awaiting_mode),
    ),
    Event.SAW_GUIDED: row(
        during(NO_VEHICLE, then=unchanged),
        during(STALE, then=mode_seen_in_stale),
        during(GROUNDED, TAKING_OFF, HOVERING, then=unchanged),
        during(VERIFYING, then=cannot_happen),
        during(MOVING, STREAMING, TAKING_PICTURE, then=unchanged),
        during(
            FLYING_MISSION, RETURNING, LANDING, then=(unchanged_while_mode_awaited, to_external)
        ),
        during(
            HOLDING,
            then=(unchanged_while_hold_awaited, hold_again_if_guided_may_come_late, to_external),
        ),
        during(EXTERNAL, then=(hold_unasked_if_guided_may_come_late, *mode_of_others)),
    ),
    Event.SAW_HOLD: row(
        during(NO_VEHICLE, then=unchanged),
        during(STALE, then=mode_seen_in_stale),
        during(GROUNDED, TAKING_OFF, then=unchanged),
        during(HOVERING, then=(unchanged_while_taking_control, to_external)),
        during(VERIFYING, then=cannot_happen),
        during(MOVING, STREAMING, TAKING_PICTURE, then=to_external),
        during(
            FLYING_MISSION,
            then=(
                unchanged_while_mode_awaited,
                take_control_if_mission_over,
                hold_if_mission_over,
                to_external,
            ),
        ),
        during(RETURNING, LANDING, then=(unchanged_while_mode_awaited, to_external)),
        during(HOLDING, EXTERNAL, then=unchanged),
    ),
    Event.SAW_TAKE_OFF: row(
        during(NO_VEHICLE, then=unchanged),
        during(STALE, then=mode_seen_in_stale),
        during(GROUNDED, TAKING_OFF, then=unchanged),
        during(HOVERING, then=to_external),
        during(VERIFYING, then=cannot_happen),
        during(MOVING, STREAMING, TAKING_PICTURE, then=to_external),
        during(
            FLYING_MISSION, RETURNING, LANDING, then=(unchanged_while_mode_awaited, to_external)
        ),
        during(HOLDING, then=(unchanged_while_hold_awaited, to_external)),
        during(EXTERNAL, then=mode_of_others),
    ),
    Event.SAW_MISSION: row(
        during(NO_VEHICLE, then=unchanged),
        during(STALE, then=mode_seen_in_stale),
        during(GROUNDED, then=unchanged),
        during(
            TAKING_OFF,
            then=(unchanged_while_mode_awaited, end_if_on_ground(TAKEN_OVER), to_external),
        ),
        during(HOVERING, then=to_external),
        during(VERIFYING, then=cannot_happen),
        during(MOVING, STREAMING, TAKING_PICTURE, then=to_external),
        during(FLYING_MISSION, then=unchanged),
        during(RETURNING, LANDING, then=(unchanged_while_mode_awaited, to_external)),
        during(HOLDING, then=(unchanged_while_hold_awaited, to_external)),
        during(EXTERNAL, then=mode_of_others),
    ),
    Event.SAW_OTHER: row(
        during(NO_VEHICLE, then=unchanged),
        during(STALE, then=mode_seen_in_stale),
        during(GROUNDED, then=unchanged),
        during(
            TAKING_OFF,
            then=(unchanged_while_mode_awaited, end_if_on_ground(TAKEN_OVER), to_external),
        ),
        during(HOVERING, then=to_external),
        during(VERIFYING, then=cannot_happen),
        during(MOVING, STREAMING, TAKING_PICTURE, then=to_external),
        during(
            FLYING_MISSION, RETURNING, LANDING, then=(unchanged_while_mode_awaited, to_external)
        ),
        during(HOLDING, then=(unchanged_while_hold_awaited, to_external)),
        during(EXTERNAL, then=mode_of_others),
    ),
    Event.SAW_RETURN: row(
        during(NO_VEHICLE, then=unchanged),
        during(
            STALE,
            then=(
                unchanged_unless_airborne,
                unchanged_while_hold_awaited,
                unchanged_while_mode_awaited,
                to_returning,
            ),
        ),
        during(GROUNDED, then=unchanged),
        during(TAKING_OFF, HOVERING, then=to_returning),
        during(VERIFYING, then=cannot_happen),
        during(MOVING, STREAMING, TAKING_PICTURE, then=to_returning),
        during(FLYING_MISSION, then=mission_returns),
        during(RETURNING, then=unchanged),
        during(LANDING, then=(unchanged_while_mode_awaited, to_returning)),
        during(HOLDING, then=(unchanged_while_hold_awaited, to_returning)),
        during(EXTERNAL, then=(unchanged_if_hold_requested, to_returning)),
    ),
    Event.SAW_LAND: row(
        during(NO_VEHICLE, then=unchanged),
        during(
            STALE,
            then=(
                unchanged_unless_airborne,
                unchanged_while_hold_awaited,
                unchanged_while_mode_awaited,
                to_landing,
            ),
        ),
        during(GROUNDED, then=unchanged),
        during(TAKING_OFF, HOVERING, then=to_landing),
        during(VERIFYING, then=cannot_happen),
        during(MOVING, STREAMING, TAKING_PICTURE, then=to_landing),
        during(FLYING_MISSION, RETURNING, then=mission_lands),
        during(LANDING, then=unchanged),
        during(HOLDING, then=(unchanged_while_hold_awaited, to_landing)),
        during(EXTERNAL, then=(unchanged_if_hold_requested, to_landing)),
    ),
}
