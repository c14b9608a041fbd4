"""Rows of the table: the verdict on a goal, and what the vehicle answers.

Its answers to commands, the picture that it took, and how far its mission is.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

from gcs.gate.machine.actions import Action
from gcs.gate.machine.events import Event
from gcs.gate.machine.guards import Guard
from gcs.gate.machine.rows.cells import (
    COMPLETE,
    CONTROL_REGAINABLE,
    NO_ANSWER,
    VEHICLE_REFUSED,
    cannot_happen,
    disarm_if_on_ground,
    end,
    end_if_on_ground,
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

fly_goal: Final = Branch(do=(Action.FLY_GOAL,), to=MOVING)
refuse_goal_and_move_on_if_goal_active: Final = Branch(
    when=(Guard.GOAL_ACTIVE,), do=(Action.REFUSE_GOAL,), to=MOVING
)
refuse_goal_and_hover: Final = Branch(do=(Action.REFUSE_GOAL,), to=HOVERING)

# A vehicle that refuses to disarm may be flying, or about to: it is told to hold.
end_if_surely_on_ground: Final = Branch(
    when=(Guard.SURELY_ON_GROUND,), ends=VEHICLE_REFUSED, do=(Action.CONFIRM_HOLD,)
)
hold_mode_if_on_ground: Final = Branch(
    when=(Guard.ON_GROUND,), ends=VEHICLE_REFUSED, do=(Action.HOLD_MODE_ONLY,)
)
hold_mode: Final = Branch(ends=VEHICLE_REFUSED, do=(Action.HOLD_MODE_ONLY,))

end_if_task_ends_held: Final = Branch(when=(Guard.TASK_ENDS_HELD,), ends=VEHICLE_REFUSED)
end_if_task_waits: Final = Branch(
    when=(Guard.TASK_WAITS,), ends=VEHICLE_REFUSED, do=(Action.CONFIRM_HOLD,)
)
end_if_task_ends_held_on_ground: Final = Branch(
    when=(Guard.SURELY_ON_GROUND, Guard.TASK_ENDS_HELD),
    ends=VEHICLE_REFUSED,
    do=(Action.CONFIRM_HOLD,),
)
hold_refused_on_ground: Final[Cell] = (
    end_if_task_waits,
    end_if_task_ends_held_on_ground,
    end_if_task_ends_held,
    unchanged,
)
complete_if_photo_taken: Final = Branch(when=(Guard.PHOTO_TAKEN,), ends=COMPLETE, to=HOVERING)
take_control_if_regainable: Final = Branch(
    when=CONTROL_REGAINABLE, do=(Action.TAKE_CONTROL,), to=HOVERING
)
unchanged_if_on_ground: Final = Branch(when=(Guard.ON_GROUND,))
# The answer was lost, not the command.
unchanged_if_mode_fits_state: Final = Branch(when=(Guard.MODE_FITS_STATE,))
unchanged_if_mode_is_take_off: Final = Branch(when=(Guard.MODE_TAKE_OFF,))

ANSWER_ROWS: Final[Mapping[Event, Row]] = {
    Event.GOAL_CLEARED: row(
        during(NO_VEHICLE, STALE, GROUNDED, TAKING_OFF, HOVERING, then=cannot_happen),
        during(VERIFYING, then=fly_goal),
        during(MOVING, STREAMING, TAKING_PICTURE, FLYING_MISSION, then=cannot_happen),
        during(RETURNING, LANDING, HOLDING, EXTERNAL, then=cannot_happen),
    ),
    Event.GOAL_REFUSED: row(
        during(NO_VEHICLE, STALE, GROUNDED, TAKING_OFF, HOVERING, then=cannot_happen),
        during(VERIFYING, then=(refuse_goal_and_move_on_if_goal_active, refuse_goal_and_hover)),
        during(MOVING, STREAMING, TAKING_PICTURE, FLYING_MISSION, then=cannot_happen),
        during(RETURNING, LANDING, HOLDING, EXTERNAL, then=cannot_happen),
    ),
    Event.COMMAND_ACCEPTED: row(
        during(NO_VEHICLE, STALE, GROUNDED, TAKING_OFF, HOVERING, then=unchanged),
        during(VERIFYING, then=cannot_happen),
        during(MOVING, STREAMING, TAKING_PICTURE, FLYING_MISSION, then=unchanged),
        during(RETURNING, LANDING, HOLDING, EXTERNAL, then=unchanged),
    ),
    Event.COMMAND_REFUSED: row(
        during(NO_VEHICLE, then=end(VEHICLE_REFUSED)),
        during(STALE, then=(stop_stream_if(Guard.IN_GRACE, VEHICLE_REFUSED), end(VEHICLE_REFUSED))),
        during(GROUNDED, then=end(VEHICLE_REFUSED)),
        during(TAKING_OFF, then=(end_if_on_ground(VEHICLE_REFUSED), hold_and_end(VEHICLE_REFUSED))),
        during(HOVERING, then=(release_if_taking_control(VEHICLE_REFUSED), unchanged)),
        during(VERIFYING, then=cannot_happen),
        during(MOVING, STREAMING, then=unchanged),
        during(TAKING_PICTURE, then=hover_and_end(VEHICLE_REFUSED)),
        during(
            FLYING_MISSION,
            then=(end_if_on_ground(VEHICLE_REFUSED), hold_and_end(VEHICLE_REFUSED)),
        ),
        during(RETURNING, LANDING, then=hold_and_end(VEHICLE_REFUSED)),
        during(HOLDING, then=unchanged),
        during(EXTERNAL, then=end(VEHICLE_REFUSED)),
    ),
    Event.COMMAND_UNANSWERED: row(
        during(NO_VEHICLE, then=end(NO_ANSWER)),
        during(STALE, then=(stop_stream_if(Guard.IN_GRACE, NO_ANSWER), end(NO_ANSWER))),
        during(GROUNDED, then=end(NO_ANSWER)),
        during(
            TAKING_OFF,
            then=(
                unchanged_if_mode_is_take_off,
                disarm_if_on_ground(NO_ANSWER),
                hold_and_end(NO_ANSWER),
            ),
        ),
        during(HOVERING, then=(release_if_taking_control(NO_ANSWER), unchanged)),
        during(VERIFYING, then=cannot_happen),
        during(MOVING, STREAMING, then=unchanged),
        during(TAKING_PICTURE, then=hover_and_end(NO_ANSWER)),
        during(
            FLYING_MISSION,
            then=(
                unchanged_if_mode_fits_state,
                disarm_if_on_ground(NO_ANSWER),
                hold_and_end(NO_ANSWER),
            ),
        ),
        during(RETURNING, LANDING, then=(unchanged_if_mode_fits_state, hold_and_end(NO_ANSWER))),
        during(HOLDING, then=unchanged),
        during(EXTERNAL, then=end(NO_ANSWER)),
    ),
    Event.DISARM_REFUSED: row(
        during(NO_VEHICLE, then=unchanged),
        during(STALE, then=(end_if_surely_on_ground, hold_mode)),
        during(
            GROUNDED,
            then=(end_if_surely_on_ground, hold_mode_if_on_ground, hold_and_end(VEHICLE_REFUSED)),
        ),
        during(TAKING_OFF, HOVERING, then=unchanged),
        during(VERIFYING, then=cannot_happen),
        during(MOVING, STREAMING, TAKING_PICTURE, FLYING_MISSION, then=unchanged),
        during(RETURNING, LANDING, HOLDING, then=unchanged),
        during(EXTERNAL, then=end(VEHICLE_REFUSED)),
    ),
    Event.LATE_ANSWER: row(
        during(NO_VEHICLE, STALE, GROUNDED, TAKING_OFF, HOVERING, then=unchanged),
        during(VERIFYING, then=cannot_happen),
        during(MOVING, STREAMING, TAKING_PICTURE, FLYING_MISSION, then=unchanged),
        during(RETURNING, LANDING, HOLDING, EXTERNAL, then=unchanged),
    ),
    Event.HOLD_REFUSED: row(
        during(NO_VEHICLE, then=(end_if_task_ends_held, unchanged)),
        during(STALE, GROUNDED, then=hold_refused_on_ground),
        during(TAKING_OFF, HOVERING, then=unchanged),
        during(VERIFYING, then=cannot_happen),
        during(MOVING, STREAMING, TAKING_PICTURE, FLYING_MISSION, then=unchanged),
        during(RETURNING, LANDING, then=unchanged),
        during(HOLDING, EXTERNAL, then=(end_if_task_ends_held, unchanged)),
    ),
    Event.HOLD_UNANSWERED: row(
        during(NO_VEHICLE, STALE, GROUNDED, TAKING_OFF, HOVERING, then=unchanged),
        during(VERIFYING, then=cannot_happen),
        during(MOVING, STREAMING, TAKING_PICTURE, FLYING_MISSION, then=unchanged),
        during(RETURNING, LANDING, HOLDING, EXTERNAL, then=unchanged),
    ),
    Event.PHOTO_SEEN: row(
        during(NO_VEHICLE, STALE, GROUNDED, TAKING_OFF, HOVERING, then=unchanged),
        during(VERIFYING, then=cannot_happen),
        during(MOVING, STREAMING, then=unchanged),
        during(TAKING_PICTURE, then=(complete_if_photo_taken, hover_and_end(VEHICLE_REFUSED))),
        during(FLYING_MISSION, RETURNING, LANDING, HOLDING, EXTERNAL, then=unchanged),
    ),
    Event.MISSION_ITEM: row(
        during(NO_VEHICLE, STALE, GROUNDED, TAKING_OFF, HOVERING, then=unchanged),
        during(VERIFYING, then=cannot_happen),
        during(MOVING, STREAMING, TAKING_PICTURE, FLYING_MISSION, then=unchanged),
        during(RETURNING, LANDING, HOLDING, EXTERNAL, then=unchanged),
    ),
    Event.MISSION_FINISHED: row(
        during(NO_VEHICLE, STALE, GROUNDED, TAKING_OFF, HOVERING, then=unchanged),
        during(VERIFYING, then=cannot_happen),
        during(MOVING, STREAMING, TAKING_PICTURE, then=unchanged),
        during(
            FLYING_MISSION,
            then=(take_control_if_regainable, unchanged_if_on_ground, hold_and_end(COMPLETE)),
        ),
        during(RETURNING, LANDING, HOLDING, EXTERNAL, then=unchanged),
    ),
}
