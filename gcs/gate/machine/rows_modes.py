"""Rows of the table: what a mode shown by the heartbeat means in each state."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

from gcs.gate.machine.cells import (
    COMPLETE,
    RETAKE,
    SILENT,
    TAKEN,
    grounded,
    imposs,
    lose_control,
    release_then,
    stay,
)
from gcs.gate.machine.events import Event
from gcs.gate.machine.rules import Branch, Cell, Do, Guard, Row
from gcs.gate.states import State

conf: Final[Cell] = (
    Branch(when=(Guard.HOLD_AWAITED, Guard.TASK_WANTS_HOLD), ends=COMPLETE, do=(Do.HOLD_SHOWN,)),
    Branch(when=(Guard.HOLD_AWAITED,), do=(Do.HOLD_SHOWN,)),
    Branch(when=(Guard.TASK_WANTS_MODE,), do=(Do.MODE_SETTLED, Do.CONTINUE)),
    Branch(do=(Do.MODE_SETTLED,)),
)
conf_st: Final[Cell] = (*conf[:2], Branch())
conf_ho: Final[Cell] = (
    Branch(when=(Guard.TAKING,), ends=COMPLETE, do=(Do.GAIN_CONTROL,)),
    Branch(do=(Do.MODE_SETTLED,)),
)
_natural: Final = Branch(when=(Guard.MODE_NATURAL,), do=(Do.MODE_SETTLED,))
_guided: Final = Branch(when=(Guard.MODE_GUIDED,), ends=SILENT, do=(Do.HOLD,), to=State.HOLDING)
_pending: Final = Branch(when=(Guard.MODE_PENDING,))
_awaited: Final = Branch(when=(Guard.HOLD_AWAITED,))

settl: Final[Cell] = (Branch(do=(Do.MODE_SETTLED,)),)
over: Final[Cell] = (_natural, _guided, release_then(SILENT, State.EXTERNAL))
over_to: Final[Cell] = (_natural, grounded(SILENT), *over[1:])
over_ho: Final[Cell] = (lose_control(SILENT), *settl)

gone: Final[Cell] = (release_then(TAKEN, State.EXTERNAL),)
gone_ho: Final[Cell] = (Branch(when=(Guard.TAKING,)), *gone)
gone_pe: Final[Cell] = (_pending, *gone)
gone_to: Final[Cell] = (_pending, grounded(TAKEN), *gone)
gone_hd: Final[Cell] = (_awaited, *gone)
gone_st: Final[Cell] = (
    _awaited,
    _pending,
    Branch(when=(Guard.MODE_NATURAL,)),
    Branch(when=(Guard.RETURNS_TO_STATE,), ends=TAKEN, do=(Do.RELEASE, Do.FORGET_INTERRUPTED)),
    Branch(),
)
late_hd: Final[Cell] = (
    _awaited,
    Branch(when=(Guard.GUIDED_LATE,), do=(Do.HOLD,)),
    *gone,
)
late_ex: Final[Cell] = (Branch(when=(Guard.GUIDED_LATE,), do=(Do.HOLD_ONCE,)), Branch())
hold_mi: Final[Cell] = (
    _pending,
    Branch(when=(Guard.MISSION_OVER, *RETAKE), do=(Do.TAKE_CONTROL,), to=State.HOVERING),
    Branch(when=(Guard.MISSION_OVER,), ends=COMPLETE, do=(Do.HOLD,), to=State.HOLDING),
    *gone,
)

homes: Final[Cell] = (release_then(TAKEN, State.RETURNING),)
home_pe: Final[Cell] = (_pending, *homes)
home_mi: Final[Cell] = (Branch(to=State.RETURNING),)
home_hd: Final[Cell] = (_awaited, *homes)
home_st: Final[Cell] = (Branch(when=(Guard.NOT_AIRBORNE,)), _awaited, _pending, *homes)
falls: Final[Cell] = (release_then(TAKEN, State.LANDING),)
fall_pe: Final[Cell] = (_pending, *falls)
fall_mi: Final[Cell] = (Branch(to=State.LANDING),)
fall_hd: Final[Cell] = (_awaited, *falls)
fall_st: Final[Cell] = (Branch(when=(Guard.NOT_AIRBORNE,)), _awaited, _pending, *falls)

# fmt: off
# ruff: noqa: E501 - a table is read along its rows
MODE_ROWS: Final[Mapping[Event, Row]] = {
    #                      NO_VE  STALE    GROUN  TAKOF    HOVER    VERIF   MOVIN  STREA  PICTU  MISSI    RETUR    LANDI    HOLDI    EXTER
    Event.MODE_CONFIRMED:  (stay,  conf_st, conf,  conf,    conf_ho, imposs, settl, settl, settl, settl,   settl,   settl,   conf,    conf),
    Event.MODE_OVERDUE:    (settl, settl,   settl, over_to, over_ho, imposs, settl, settl, settl, over_to, over,    over,    settl,   settl),
    Event.SAW_GUIDED:      (stay,  gone_st, stay,  stay,    stay,    imposs, stay,  stay,  stay,  gone_pe, gone_pe, gone_pe, late_hd, late_ex),
    Event.SAW_HOLD:        (stay,  gone_st, stay,  stay,    gone_ho, imposs, gone,  gone,  gone,  hold_mi, gone_pe, gone_pe, stay,    stay),
    Event.SAW_TAKE_OFF:    (stay,  gone_st, stay,  stay,    gone,    imposs, gone,  gone,  gone,  gone_pe, gone_pe, gone_pe, gone_hd, stay),
    Event.SAW_MISSION:     (stay,  gone_st, stay,  gone_to, gone,    imposs, gone,  gone,  gone,  stay,    gone_pe, gone_pe, gone_hd, stay),
    Event.SAW_OTHER:       (stay,  gone_st, stay,  gone_to, gone,    imposs, gone,  gone,  gone,  gone_pe, gone_pe, gone_pe, gone_hd, stay),
    Event.SAW_RETURN:      (stay,  home_st, stay,  homes,   homes,   imposs, homes, homes, homes, home_mi, stay,    home_pe, home_hd, homes),
    Event.SAW_LAND:        (stay,  fall_st, stay,  falls,   falls,   imposs, falls, falls, falls, fall_mi, fall_mi, stay,    fall_hd, falls),
}
# fmt: on
