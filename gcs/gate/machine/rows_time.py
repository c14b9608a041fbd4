"""Rows of the table: ticks and deadlines, severity, and a lost operator."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

from gcs.gate.effects import OutcomeKind
from gcs.gate.machine.cells import (
    COMPLETE,
    DENIED,
    DESERTED,
    MISSED,
    RETAKE,
    SEVERE,
    SILENT,
    give_up,
    grounded,
    hold_then,
    imposs,
    let_go,
    sile,
    sile_ho,
    stay,
)
from gcs.gate.machine.events import Event
from gcs.gate.machine.rules import Branch, Cell, Do, End, Guard, Row
from gcs.gate.refusal import Code
from gcs.gate.states import State

# ------------------------------------------------------------------------------------ time

tick_ho: Final[Cell] = (
    Branch(when=(Guard.PENDING,), do=(Do.VERIFY,), to=State.VERIFYING),
    Branch(),
)
tick_mo: Final[Cell] = (
    tick_ho[0],
    Branch(when=(Guard.ARRIVED,), ends=COMPLETE, do=(Do.KEEP_GOAL,), to=State.HOVERING),
    Branch(),
)
tick_to: Final[Cell] = (
    Branch(when=(Guard.AT_HEIGHT, *RETAKE), do=(Do.TAKE_CONTROL,), to=State.HOVERING),
    Branch(
        when=(Guard.AT_HEIGHT,),
        ends=End(OutcomeKind.ABORTED, Code.TOO_CLOSE),
        do=(Do.HOLD,),
        to=State.HOLDING,
    ),
    Branch(when=(Guard.CLIMB_SHORT,), ends=DENIED, do=(Do.HOLD,), to=State.HOLDING),
    Branch(
        when=(Guard.CLIMBS_ON,),
        ends=End(OutcomeKind.ABORTED, Code.TOO_HIGH),
        do=(Do.HOLD,),
        to=State.HOLDING,
    ),
    Branch(),
)
_came_down: Final = Branch(when=(Guard.TASK_HAS_LANDED,), ends=COMPLETE)
# The request is over, the hold is not: it is repeated until it is shown.
sile_hd: Final[Cell] = (
    Branch(when=(Guard.HOLD_AWAITED,), ends=SILENT, do=(Do.REPEAT_HOLD,)),
    *sile,
)
late_gr: Final[Cell] = (_came_down, *sile_hd)
late_to: Final[Cell] = (grounded(MISSED), hold_then(MISSED))
late_mo: Final[Cell] = (hold_then(MISSED),)
late_ph: Final[Cell] = (Branch(ends=MISSED, to=State.HOVERING),)
late_la: Final[Cell] = (
    Branch(when=(Guard.ON_GROUND,), ends=COMPLETE, do=(Do.RELEASE,), to=State.GROUNDED),
    Branch(ends=MISSED),
)
late_st: Final[Cell] = (
    Branch(when=(Guard.IN_GRACE,), ends=MISSED, do=(Do.LET_GO, Do.HOLD)),
    *late_gr,
)
asks: Final[Cell] = (Branch(do=(Do.ASK_GUIDED,)),)
again: Final[Cell] = (Branch(do=(Do.REPEAT_HOLD,)),)

# -------------------------------------------------------------------------------- severity

sev_gr: Final[Cell] = (Branch(when=(Guard.TASK_IS_ARM,), ends=SEVERE), Branch())
sevh: Final[Cell] = (hold_then(SEVERE),)
sevh_to: Final[Cell] = (give_up(SEVERE), *sevh)
sevh_st: Final[Cell] = let_go(SEVERE, Guard.IN_GRACE)
sevr_hd: Final[Cell] = (
    Branch(when=(Guard.PATH_CLEARS,), ends=SEVERE, do=(Do.RETURN,), to=State.RETURNING),
    Branch(when=(Guard.RTL_FORWARD,), ends=SEVERE, do=(Do.RETURN,), to=State.RETURNING),
    Branch(when=(Guard.RTL_LAND,), ends=SEVERE, do=(Do.LAND,), to=State.LANDING),
    Branch(),
)
sevr: Final[Cell] = (*sevr_hd[:-1], *sevh)
sevr_to: Final[Cell] = (give_up(SEVERE), *sevr)
sevl: Final[Cell] = (Branch(ends=SEVERE, do=(Do.LAND,), to=State.LANDING),)
sevl_to: Final[Cell] = (give_up(SEVERE), *sevl)
sevl_re: Final[Cell] = (
    Branch(when=(Guard.OURS,), ends=SEVERE, do=(Do.LAND,), to=State.LANDING),
    Branch(),
)
sevl_st: Final[Cell] = (
    Branch(when=(Guard.RETURNS_TO_STATE,), ends=SEVERE, do=(Do.LAND,), to=State.LANDING),
    Branch(),
)

# ------------------------------------------------------------------------- a lost operator

lost_gr: Final[Cell] = (
    Branch(when=(Guard.ARMED, Guard.LATE_TAKE_OFF), ends=DESERTED, do=(Do.HOLD_BLIND,)),
    Branch(ends=DESERTED),
)
lost_to: Final[Cell] = (give_up(DESERTED), hold_then(DESERTED))
lost_fl: Final[Cell] = (hold_then(DESERTED),)
lost_dn: Final[Cell] = (
    Branch(when=(Guard.SEVERITY_RETURNS,)),
    Branch(when=(Guard.OURS,), ends=DESERTED, do=(Do.HOLD,), to=State.HOLDING),
    Branch(),
)
lost_st: Final[Cell] = let_go(DESERTED, Guard.RETURNS_TO_STATE)

# fmt: off
# ruff: noqa: E501 - a table is read along its rows
TIME_ROWS: Final[Mapping[Event, Row]] = {
    #                     NO_VE  STALE    GROUN    TAKOF    HOVER    VERIF   MOVIN    STREA    PICTU    MISSI    RETUR    LANDI    HOLDI    EXTER
    Event.TICK:           (stay,  stay,    stay,    tick_to, tick_ho, imposs, tick_mo, stay,    stay,    stay,    stay,    stay,    stay,    stay),
    Event.DEADLINE:       (sile,  late_st, late_gr, late_to, sile_ho, imposs, late_mo, late_mo, late_ph, sile,    sile,    late_la, sile_hd, sile_hd),
    Event.CONTROL_DUE:    (stay,  stay,    stay,    stay,    asks,    imposs, stay,    stay,    stay,    stay,    stay,    stay,    stay,    stay),
    Event.HOLD_DUE:       (again, again,   again,   stay,    stay,    imposs, stay,    stay,    stay,    stay,    stay,    stay,    again,   again),
    Event.MUST_HOLD:      (stay,  sevh_st, sev_gr,  sevh_to, sevh,    imposs, sevh,    sevh,    sevh,    sevh,    stay,    stay,    stay,    stay),
    Event.MUST_RETURN:    (stay,  sevh_st, sev_gr,  sevr_to, sevr,    imposs, sevr,    sevr,    sevr,    sevr,    stay,    stay,    sevr_hd, stay),
    Event.MUST_LAND:      (stay,  sevl_st, sev_gr,  sevl_to, sevl,    imposs, sevl,    sevl,    sevl,    sevl,    sevl_re, stay,    sevl,    stay),
    Event.EASED:          (stay,  stay,    stay,    stay,    stay,    imposs, stay,    stay,    stay,    stay,    stay,    stay,    stay,    stay),
    Event.OPERATOR_LOST:  (stay,  lost_st, lost_gr, lost_to, lost_fl, imposs, lost_fl, lost_fl, lost_fl, lost_fl, lost_dn, lost_dn, stay,    stay),
}
# fmt: on
