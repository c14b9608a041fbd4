"""Rows of the table: what the vehicle reports about position, arming and flight."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

from gcs.gate.effects import OutcomeKind
from gcs.gate.machine.cells import (
    COMPLETE,
    JUDGED,
    MOVED,
    STOPPED,
    TAKEN,
    give_up,
    hold_then,
    imposs,
    let_go,
    release_then,
    stay,
)
from gcs.gate.machine.events import Event
from gcs.gate.machine.rules import BACK, Branch, Cell, Do, End, Guard, Row
from gcs.gate.refusal import Code
from gcs.gate.states import State

heard: Final[Cell] = (Branch(to=State.STALE),)
lost: Final[Cell] = (
    Branch(
        ends=End(OutcomeKind.ABORTED, Code.LINK_LOST),
        do=(Do.RELEASE, Do.FORGET_VEHICLE),
        to=State.NO_VEHICLE,
    ),
)
posi_st: Final[Cell] = (
    Branch(when=(Guard.RETURNS_TO_STATE,), to=BACK),
    Branch(when=(Guard.ON_GROUND,), to=State.GROUNDED),
    Branch(when=(Guard.HOLD_AWAITED,), do=(Do.HOLD,), to=State.HOLDING),
    Branch(when=(Guard.DISARMED,), to=State.GROUNDED),
    Branch(when=(Guard.MODE_RETURN,), to=State.RETURNING),
    Branch(when=(Guard.MODE_LAND,), to=State.LANDING),
    Branch(to=State.EXTERNAL),
)
age: Final[Cell] = (Branch(do=(Do.START_GRACE,), to=State.STALE),)
age_id: Final[Cell] = (Branch(to=State.STALE),)
age_st: Final[Cell] = (
    Branch(
        when=(Guard.IN_GRACE, Guard.GRACE_OVER),
        ends=End(OutcomeKind.ABORTED, Code.STALE),
        do=(Do.LET_GO, Do.HOLD),
    ),
    Branch(),
)
_JUMP: Final = End(OutcomeKind.ABORTED, Code.ESTIMATOR_RESET)
jump: Final[Cell] = (hold_then(_JUMP),)
jump_st: Final[Cell] = let_go(_JUMP, Guard.IN_GRACE)
jump_re: Final[Cell] = (
    Branch(when=(Guard.OURS,), ends=_JUMP, do=(Do.HOLD,), to=State.HOLDING),
    Branch(),
)
anew: Final[Cell] = (Branch(do=(Do.HOLD_ANEW,)),)
move: Final[Cell] = (hold_then(MOVED),)
move_st: Final[Cell] = let_go(MOVED, Guard.IN_GRACE)
move_re: Final[Cell] = (
    Branch(when=(Guard.OURS,), ends=MOVED, do=(Do.HOLD,), to=State.HOLDING),
    Branch(),
)
unve: Final[Cell] = (hold_then(JUDGED),)
unve_st: Final[Cell] = let_go(JUDGED, Guard.IN_GRACE)
unve_to: Final[Cell] = (give_up(JUDGED), *unve)
brake: Final[Cell] = (
    Branch(
        ends=End(OutcomeKind.ABORTED, Code.FENCE_BREACH),
        do=(Do.BRAKE, Do.HOLD),
        to=State.HOLDING,
    ),
)
# A sample that comes late is a sample: only what is held already is not braked.
brak_st: Final[Cell] = (
    Branch(when=(Guard.FLIES_ON,), ends=brake[0].ends, do=brake[0].do, to=State.HOLDING),
    Branch(),
)

# ------------------------------------------------------------------------ armed and landed

arms: Final[Cell] = (Branch(when=(Guard.TASK_IS_ARM,), ends=COMPLETE), Branch())
dsrm_gr: Final[Cell] = (
    Branch(when=(Guard.TASK_ENDS_DISARMED,), ends=COMPLETE),
    Branch(when=(Guard.HOLD_AWAITED,), do=(Do.HOLD_SHOWN,)),
    Branch(),
)
dsrm_st: Final[Cell] = (
    Branch(when=(Guard.TASK_ENDS_DISARMED,), ends=COMPLETE, do=(Do.FORGET_INTERRUPTED,)),
    Branch(
        when=(Guard.RETURNS_TO_STATE,),
        ends=End(OutcomeKind.TAKEN_OVER, Code.NOT_ARMED),
        do=(Do.FORGET_INTERRUPTED,),
    ),
    Branch(),
)
dsrm: Final[Cell] = (
    Branch(when=(Guard.TASK_ENDS_DISARMED,), ends=COMPLETE, do=(Do.RELEASE,), to=State.GROUNDED),
    release_then(End(OutcomeKind.TAKEN_OVER, Code.NOT_ARMED), State.GROUNDED),
)
air_gr: Final[Cell] = (
    Branch(when=(Guard.LATE_TAKE_OFF,), ends=STOPPED, do=(Do.HOLD,), to=State.HOLDING),
    Branch(when=(Guard.MISSION_GOES_ON,), to=State.FLYING_MISSION),
    Branch(when=(Guard.MODE_LAND,), to=State.LANDING),
    Branch(when=(Guard.MODE_RETURN,), to=State.RETURNING),
    release_then(TAKEN, State.EXTERNAL),
)
lifts: Final[Cell] = (Branch(do=(Do.NOTE_LIFTED,)),)
_down: Final = release_then(End(OutcomeKind.TAKEN_OVER, Code.NOT_FLYING), State.GROUNDED)
settle: Final[Cell] = (
    Branch(when=(Guard.DISARMED,), ends=COMPLETE, do=(Do.RELEASE,), to=State.GROUNDED),
    Branch(do=(Do.RELEASE, Do.AWAIT_DISARM), to=State.GROUNDED),
)
lands: Final[Cell] = (_down,)
land_to: Final[Cell] = (
    Branch(when=(Guard.LIFTED,), ends=_down.ends, do=_down.do, to=State.GROUNDED),
    Branch(),
)
land_mi: Final[Cell] = (
    Branch(when=(Guard.LIFTED, Guard.DISARMED), ends=COMPLETE, do=_down.do, to=State.GROUNDED),
    Branch(when=(Guard.LIFTED,), do=settle[1].do, to=State.GROUNDED),
    Branch(),
)
land_hd: Final[Cell] = (
    Branch(when=(Guard.TASK_WANTS_HOLD,), ends=COMPLETE, do=_down.do, to=State.GROUNDED),
    _down,
)
down_st: Final[Cell] = (
    Branch(when=(Guard.RETURNS_TO_STATE,), ends=_down.ends, do=(Do.FORGET_INTERRUPTED,)),
    Branch(),
)

# fmt: off
# ruff: noqa: E501 - a table is read along its rows
VEHICLE_ROWS: Final[Mapping[Event, Row]] = {
    #                NO_VE  STALE    GROUN    TAKOF    HOVER   VERIF   MOVIN   STREA   PICTU   MISSI    RETUR    LANDI   HOLDI    EXTER
    Event.HEARD:     (heard, imposs,  imposs,  imposs,  imposs, imposs, imposs, imposs, imposs, imposs,  imposs,  imposs, imposs,  imposs),
    Event.LOST:      (stay,  lost,    lost,    lost,    lost,   imposs, lost,   lost,   lost,   lost,    lost,    lost,   lost,    lost),
    Event.POSITION:  (stay,  posi_st, stay,    stay,    stay,   imposs, stay,   stay,   stay,   stay,    stay,    stay,   stay,    stay),
    Event.AGED:      (stay,  age_st,  age_id,  age,     age,    imposs, age,    age,    age,    age,     stay,    stay,   age,     age_id),
    Event.JUMPED:    (stay,  jump_st, stay,    jump,    jump,   imposs, jump,   jump,   jump,   jump,    jump_re, stay,   anew,    stay),
    Event.HOME_MOVED:(stay,  move_st, stay,    move,    move,   imposs, move,   move,   move,   move,    move_re, stay,   anew,    stay),
    Event.UNVERIFIED:(stay,  unve_st, stay,    unve_to, unve,   imposs, unve,   unve,   unve,   unve,    stay,    stay,   anew,    stay),
    Event.BREACH:    (stay,  brak_st, stay,    brake,   brake,  imposs, brake,  brake,  brake,  brake,   brake,   stay,   stay,    stay),
    Event.ARMED:     (stay,  arms,    arms,    stay,    stay,   imposs, stay,   stay,   stay,   stay,    stay,    stay,   stay,    stay),
    Event.DISARMED:  (stay,  dsrm_st, dsrm_gr, dsrm,    dsrm,   imposs, dsrm,   dsrm,   dsrm,   dsrm,    dsrm,    dsrm,   dsrm,    dsrm),
    Event.AIRBORNE:  (stay,  stay,    air_gr,  lifts,   stay,   imposs, stay,   stay,   stay,   lifts,   stay,    stay,   stay,    stay),
    Event.LANDED:    (stay,  down_st, stay,    land_to, lands,  imposs, lands,  lands,  lands,  land_mi, settle,  settle, land_hd, lands),
}
# fmt: on
