"""Rows of the table: the gate's own failsafes, severity and a lost operator."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

from gcs.gate.machine.actions import Action
from gcs.gate.machine.events import Event
from gcs.gate.machine.guards import Guard
from gcs.gate.machine.rows.cells import (
    LEFT_GOING_ON,
    OPERATOR_LOST,
    SEVERITY,
    cannot_happen,
    disarm_if_on_ground,
    end,
    end_if_task_is_arm,
    hold_and_end,
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

# -------------------------------------------------------------------------------- severity

return_if_path_clears: Final = Branch(
    when=(Guard.RETURN_PATH_CLEARS,), ends=SEVERITY, do=(Action.RETURN,), to=RETURNING
)
return_if_policy_forwards_it: Final = Branch(
    when=(Guard.BLOCKED_RETURN_FORWARDED,), ends=SEVERITY, do=(Action.RETURN,), to=RETURNING
)
land_if_policy_lands: Final = Branch(
    when=(Guard.BLOCKED_RETURN_LANDS,), ends=SEVERITY, do=(Action.LAND,), to=LANDING
)
land: Final = Branch(ends=SEVERITY, do=(Action.LAND,), to=LANDING)
land_if_in_control: Final = Branch(
    when=(Guard.IN_CONTROL,), ends=SEVERITY, do=(Action.LAND,), to=LANDING
)
land_if_it_returns_to_state: Final = Branch(
    when=(Guard.RETURNS_TO_STATE,), ends=SEVERITY, do=(Action.LAND,), to=LANDING
)

stop_stream_or_end_arm: Final[Cell] = (
    stop_stream_if(Guard.IN_GRACE, SEVERITY),
    end_if_task_is_arm(SEVERITY),
    unchanged,
)

return_or_hold: Final[Cell] = (
    return_if_path_clears,
    return_if_policy_forwards_it,
    land_if_policy_lands,
    hold_and_end(SEVERITY),
)

# --------------------------------------------------------------------------- lost operator

hold_mode_if_take_off_may_come_late: Final = Branch(
    when=(Guard.ARMED, Guard.TAKE_OFF_MAY_COME_LATE),
    ends=OPERATOR_LOST,
    do=(Action.HOLD_MODE_ONLY,),
)
# Whoever leaves does not cancel what comes down: it is the safer state.
end_and_let_it_go_on: Final = end(LEFT_GOING_ON)
unchanged_if_hold_awaited: Final = Branch(when=(Guard.HOLD_AWAITED,))
end_and_let_it_go_on_if_task_ends_landed: Final = Branch(
    when=(Guard.TASK_ENDS_LANDED,), ends=LEFT_GOING_ON
)
hold_mode_if_lost_in_flight: Final = Branch(
    when=(Guard.LOST_IN_FLIGHT,), ends=OPERATOR_LOST, do=(Action.HOLD_MODE_ONLY,)
)

FAILSAFE_ROWS: Final[Mapping[Event, Row]] = {
    Event.MUST_HOLD: row(
        during(NO_VEHICLE, then=unchanged),
        during(STALE, then=stop_stream_or_end_arm),
        during(GROUNDED, then=(end_if_task_is_arm(SEVERITY), unchanged)),
        during(TAKING_OFF, then=(disarm_if_on_ground(SEVERITY), hold_and_end(SEVERITY))),
        during(HOVERING, then=hold_and_end(SEVERITY)),
        during(VERIFYING, then=cannot_happen),
        during(MOVING, STREAMING, TAKING_PICTURE, then=hold_and_end(SEVERITY)),
        during(FLYING_MISSION, then=hold_and_end(SEVERITY)),
        during(RETURNING, LANDING, HOLDING, EXTERNAL, then=unchanged),
    ),
    Event.MUST_RETURN: row(
        during(NO_VEHICLE, then=unchanged),
        during(STALE, then=stop_stream_or_end_arm),
        during(GROUNDED, then=(end_if_task_is_arm(SEVERITY), unchanged)),
        during(TAKING_OFF, then=(disarm_if_on_ground(SEVERITY), *return_or_hold)),
        during(HOVERING, then=return_or_hold),
        during(VERIFYING, then=cannot_happen),
        during(MOVING, STREAMING, TAKING_PICTURE, FLYING_MISSION, then=return_or_hold),
        during(RETURNING, LANDING, then=unchanged),
        during(
            HOLDING,
            then=(
                return_if_path_clears,
                return_if_policy_forwards_it,
                land_if_policy_lands,
                unchanged,
            ),
        ),
        during(EXTERNAL, then=unchanged),
    ),
    Event.MUST_LAND: row(
        during(NO_VEHICLE, then=unchanged),
        during(STALE, then=(land_if_it_returns_to_state, end_if_task_is_arm(SEVERITY), unchanged)),
        during(GROUNDED, then=(end_if_task_is_arm(SEVERITY), unchanged)),
        during(TAKING_OFF, then=(disarm_if_on_ground(SEVERITY), land)),
        during(HOVERING, then=land),
        during(VERIFYING, then=cannot_happen),
        during(MOVING, STREAMING, TAKING_PICTURE, FLYING_MISSION, then=land),
        during(RETURNING, then=(land_if_in_control, unchanged)),
        during(LANDING, then=unchanged),
        during(HOLDING, then=land),
        during(EXTERNAL, then=unchanged),
    ),
    Event.SEVERITY_EASED: row(
        during(NO_VEHICLE, STALE, GROUNDED, TAKING_OFF, HOVERING, then=unchanged),
        during(VERIFYING, then=cannot_happen),
        during(MOVING, STREAMING, TAKING_PICTURE, FLYING_MISSION, then=unchanged),
        during(RETURNING, LANDING, HOLDING, EXTERNAL, then=unchanged),
    ),
    Event.OPERATOR_LOST: row(
        during(
            NO_VEHICLE,
            then=(
                unchanged_if_hold_awaited,
                end_and_let_it_go_on_if_task_ends_landed,
                hold_mode_if_lost_in_flight,
                unchanged,
            ),
        ),
        during(
            STALE,
            then=(
                stop_stream_if(Guard.RETURNS_TO_STATE, OPERATOR_LOST),
                end_if_task_is_arm(OPERATOR_LOST),
                end_and_let_it_go_on_if_task_ends_landed,
                unchanged_if_hold_awaited,
                end(OPERATOR_LOST),
            ),
        ),
        during(GROUNDED, then=(hold_mode_if_take_off_may_come_late, end(OPERATOR_LOST))),
        during(TAKING_OFF, then=(disarm_if_on_ground(OPERATOR_LOST), hold_and_end(OPERATOR_LOST))),
        during(HOVERING, then=hold_and_end(OPERATOR_LOST)),
        during(VERIFYING, then=cannot_happen),
        during(MOVING, STREAMING, TAKING_PICTURE, then=hold_and_end(OPERATOR_LOST)),
        during(FLYING_MISSION, then=hold_and_end(OPERATOR_LOST)),
        during(RETURNING, LANDING, then=end_and_let_it_go_on),
        during(
            HOLDING,
            EXTERNAL,
            then=(
                end_and_let_it_go_on_if_task_ends_landed,
                unchanged_if_hold_awaited,
                end(OPERATOR_LOST),
            ),
        ),
    ),
}
