"""Rows of the table: the verdict on a goal, and how commands, pictures and missions end."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

from gcs.gate.machine.cells import (
    COMPLETE,
    DENIED,
    RETAKE,
    SILENT,
    grounded,
    hold_then,
    imposs,
    lose_control,
    sile,
    sile_ho,
    stay,
)
from gcs.gate.machine.events import Event
from gcs.gate.machine.rules import Branch, Cell, Do, Guard, Row
from gcs.gate.states import State

clears: Final[Cell] = (Branch(do=(Do.FLY_GOAL,), to=State.MOVING),)
drops: Final[Cell] = (
    Branch(when=(Guard.ACTIVE_GOAL,), do=(Do.DROP_GOAL,), to=State.MOVING),
    Branch(do=(Do.DROP_GOAL,), to=State.HOVERING),
)

deni: Final[Cell] = (Branch(ends=DENIED),)
deni_to: Final[Cell] = (grounded(DENIED), hold_then(DENIED))
deni_ho: Final[Cell] = (lose_control(DENIED), Branch())
deni_ph: Final[Cell] = (Branch(ends=DENIED, to=State.HOVERING),)
deni_fl: Final[Cell] = (hold_then(DENIED),)
deni_st: Final[Cell] = (
    Branch(when=(Guard.IN_GRACE,), ends=DENIED, do=(Do.LET_GO, Do.HOLD)),
    *deni,
)
# It may fly, or begin to, and would not be disarmed: hold it.
dsno_gr: Final[Cell] = (
    Branch(when=(Guard.STANDS,), ends=DENIED),
    Branch(when=(Guard.ON_GROUND,), ends=DENIED, do=(Do.HOLD_BLIND,)),
    hold_then(DENIED),
)
dsno_st: Final[Cell] = (
    Branch(when=(Guard.STANDS,), ends=DENIED),
    Branch(ends=DENIED, do=(Do.HOLD_BLIND,)),
)
sile_to: Final[Cell] = (grounded(SILENT), hold_then(SILENT))
sile_ph: Final[Cell] = (Branch(ends=SILENT, to=State.HOVERING),)
sile_fl: Final[Cell] = (hold_then(SILENT),)
sile_st: Final[Cell] = (
    Branch(when=(Guard.IN_GRACE,), ends=SILENT, do=(Do.LET_GO, Do.HOLD)),
    *sile,
)
noho: Final[Cell] = (Branch(when=(Guard.TASK_WANTS_HOLD,), ends=DENIED), Branch())
shot: Final[Cell] = (
    Branch(when=(Guard.PHOTO_OK,), ends=COMPLETE, to=State.HOVERING),
    *deni_ph,
)
fini: Final[Cell] = (
    Branch(when=RETAKE, do=(Do.TAKE_CONTROL,), to=State.HOVERING),
    Branch(when=(Guard.ON_GROUND,)),
    hold_then(COMPLETE),
)

# fmt: off
# ruff: noqa: E501 - a table is read along its rows
ANSWER_ROWS: Final[Mapping[Event, Row]] = {
    #                        NO_VE   STALE    GROUN   TAKOF    HOVER    VERIF   MOVIN   STREA   PICTU    MISSI    RETUR    LANDI    HOLDI   EXTER
    Event.GOAL_CLEARED:      (imposs, imposs,  imposs, imposs,  imposs,  clears, imposs, imposs, imposs,  imposs,  imposs,  imposs,  imposs, imposs),
    Event.GOAL_REFUSED:      (imposs, imposs,  imposs, imposs,  imposs,  drops,  imposs, imposs, imposs,  imposs,  imposs,  imposs,  imposs, imposs),
    Event.COMMAND_DONE:      (stay,   stay,    stay,   stay,    stay,    imposs, stay,   stay,   stay,    stay,    stay,    stay,    stay,   stay),
    Event.COMMAND_REFUSED:   (stay,   deni_st, deni,   deni_to, deni_ho, imposs, stay,   stay,   deni_ph, deni_to, deni_fl, deni_fl, stay,   deni),
    Event.COMMAND_SILENT:    (stay,   sile_st, sile,   sile_to, sile_ho, imposs, stay,   stay,   sile_ph, sile_to, sile_fl, sile_fl, stay,   sile),
    Event.DISARM_REFUSED:    (stay,   dsno_st, dsno_gr, stay,   stay,    imposs, stay,   stay,   stay,    stay,    stay,    stay,    stay,   deni),
    Event.COMMAND_LATE:      (stay,   stay,    stay,   stay,    stay,    imposs, stay,   stay,   stay,    stay,    stay,    stay,    stay,   stay),
    Event.HOLD_REFUSED:      (noho,   noho,    noho,   stay,    stay,    imposs, stay,   stay,   stay,    stay,    stay,    stay,    noho,   noho),
    Event.HOLD_SILENT:       (stay,   stay,    stay,   stay,    stay,    imposs, stay,   stay,   stay,    stay,    stay,    stay,    stay,   stay),
    Event.PHOTO_SEEN:        (stay,   stay,    stay,   stay,    stay,    imposs, stay,   stay,   shot,    stay,    stay,    stay,    stay,   stay),
    Event.MISSION_ITEM:      (stay,   stay,    stay,   stay,    stay,    imposs, stay,   stay,   stay,    stay,    stay,    stay,    stay,   stay),
    Event.MISSION_FINISHED:  (stay,   stay,    stay,   stay,    stay,    imposs, stay,   stay,   stay,    fini,    stay,    stay,    stay,   stay),
}
# fmt: on
