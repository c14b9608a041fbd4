"""Rows of the table: what each request gets in each state."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

from gcs.gate.machine.cells import (
    GONE,
    STOPPED,
    done,
    imposs,
    refuse,
)
from gcs.gate.machine.events import Event
from gcs.gate.machine.rules import Answer, Branch, Cell, Check, Do, Guard, Row
from gcs.gate.refusal import Code
from gcs.gate.states import State

no_veh: Final = refuse(Code.NO_VEHICLE)
stale: Final = refuse(Code.STALE)
no_fly: Final = refuse(Code.NOT_FLYING)
flying: Final = refuse(Code.ALREADY_FLYING)
busy: Final = refuse(Code.BUSY)
is_hld: Final = refuse(Code.HOLDING)
no_ctl: Final = refuse(Code.NOT_IN_CONTROL)
policy: Final = refuse(Code.POLICY)

_taking: Final = Branch(when=(Guard.TAKING,), refuse=Code.CONTROL_PENDING)
_goal_waits: Final = Branch(when=(Guard.PENDING,), refuse=Code.BUSY)
_task_busy: Final = Branch(when=(Guard.TASK,), refuse=Code.BUSY)

_pend: Final = Branch(needs=(Check.SEVERITY,), answer=Answer.PENDING)
goto_h: Final[Cell] = (_taking, _pend)
goto_m: Final[Cell] = (
    Branch(when=(Guard.RETARGET,), needs=_pend.needs, answer=Answer.PENDING),
    Branch(refuse=Code.BUSY),
)
take_h: Final[Cell] = (_taking, Branch(answer=Answer.DONE))
take: Final[Cell] = (
    Branch(when=(Guard.NOT_AIRBORNE,), refuse=Code.NOT_FLYING),
    Branch(
        needs=(Check.SEVERITY, Check.HERE),
        answer=Answer.TASK,
        do=(Do.TAKE_CONTROL,),
        to=State.HOVERING,
    ),
)

arm: Final[Cell] = (
    _task_busy,
    Branch(when=(Guard.ARMED,), answer=Answer.DONE),
    Branch(needs=(Check.SEVERITY, Check.RECORDER), answer=Answer.TASK, do=(Do.ARM,)),
)
_disarm: Final = Branch(answer=Answer.TASK, do=(Do.DISARM,))
_disarm_here: Final = Branch(
    when=(Guard.ON_GROUND,), answer=Answer.TASK, do=(Do.RELEASE, Do.DISARM), to=State.GROUNDED
)
_abort_here: Final = Branch(
    when=(Guard.ON_GROUND,),
    answer=Answer.TASK,
    ends=STOPPED,
    do=(Do.RELEASE, Do.HOLD_BLIND, Do.DISARM),
    to=State.GROUNDED,
)
disa_g: Final[Cell] = (Branch(when=(Guard.SAFE,), answer=Answer.DONE), _disarm)
disa_s: Final[Cell] = (
    Branch(when=(Guard.ON_GROUND, Guard.SAFE), answer=Answer.DONE),
    Branch(when=(Guard.ON_GROUND,), answer=Answer.TASK, do=(Do.FORGET_INTERRUPTED, Do.DISARM)),
    Branch(refuse=Code.IN_AIR),
)
disarm: Final[Cell] = (_disarm_here, Branch(refuse=Code.IN_AIR))
force: Final[Cell] = (
    _disarm_here,
    GONE,
    Branch(when=(Guard.FORCE_FORBIDDEN,), refuse=Code.POLICY),
    Branch(when=(Guard.FORCE_UNCONFIRMED,), refuse=Code.IN_AIR, do=(Do.NOTE_FORCE,)),
    Branch(answer=Answer.TASK, do=(Do.RELEASE, Do.FORCE_DISARM), to=State.EXTERNAL),
)
takeof: Final[Cell] = (
    _task_busy,
    Branch(
        needs=(Check.ARMED, Check.ON_GROUND, Check.SEVERITY, Check.TAKE_OFF),
        answer=Answer.TASK,
        do=(Do.TAKE_OFF,),
        to=State.TAKING_OFF,
    ),
)

_land: Final = Branch(answer=Answer.TASK, do=(Do.LAND,), to=State.LANDING)
_stands: Final = Branch(when=(Guard.STANDS,), answer=Answer.DONE)
land: Final[Cell] = (_land,)
land_s: Final[Cell] = (_stands, _land)

_return: Final = Branch(
    when=(Guard.PATH_CLEARS,), answer=Answer.TASK, do=(Do.RETURN,), to=State.RETURNING
)
_return_anyway: Final = Branch(
    when=(Guard.RTL_FORWARD,), answer=Answer.TASK, do=(Do.RETURN,), to=State.RETURNING
)
rtl: Final[Cell] = (
    _return,
    _return_anyway,
    Branch(
        when=(Guard.RTL_LAND,),
        refuse=Code.RTL_BLOCKED,
        ends=STOPPED,
        do=(Do.LAND,),
        to=State.LANDING,
    ),
    Branch(refuse=Code.RTL_BLOCKED, ends=STOPPED, do=(Do.HOLD,), to=State.HOLDING),
)
rtl_g: Final[Cell] = (_stands, *rtl)
rtl_l: Final[Cell] = (_return, _return_anyway, Branch(refuse=Code.RTL_BLOCKED))
rtl_s: Final[Cell] = (
    _stands,
    Branch(refuse=Code.RTL_BLOCKED, ends=STOPPED, do=(Do.LET_GO, Do.HOLD)),
)

_hold_now: Final = Branch(answer=Answer.TASK, ends=STOPPED, do=(Do.HOLD,), to=State.HOLDING)
hold: Final[Cell] = (_hold_now,)
hold_g: Final[Cell] = (
    _stands,
    Branch(when=(Guard.ON_GROUND,), answer=Answer.TASK, ends=STOPPED, do=(Do.HOLD_BLIND,)),
    _hold_now,
)
hold_t: Final[Cell] = (_abort_here, _hold_now)
hold_s: Final[Cell] = (
    _stands,
    Branch(answer=Answer.TASK, ends=STOPPED, do=(Do.LET_GO, Do.HOLD)),
)
abrt_g: Final[Cell] = (
    Branch(when=(Guard.SAFE,), answer=Answer.DONE),
    Branch(when=(Guard.STANDS,), answer=Answer.TASK, ends=STOPPED, do=(Do.DISARM,)),
    _abort_here,
    _hold_now,
)
abrt_s: Final[Cell] = (
    Branch(when=(Guard.STANDS, Guard.SAFE), answer=Answer.DONE),
    Branch(when=(Guard.STANDS,), answer=Answer.TASK, ends=STOPPED, do=(Do.DISARM,)),
    Branch(
        when=(Guard.ON_GROUND,),
        answer=Answer.TASK,
        ends=STOPPED,
        do=(Do.FORGET_INTERRUPTED, Do.HOLD_BLIND, Do.DISARM),
    ),
    hold_s[1],
)
abrt_n: Final[Cell] = (
    Branch(when=(Guard.HEARD_ONCE,), answer=Answer.TASK, ends=STOPPED, do=(Do.HOLD_BLIND,)),
    Branch(refuse=Code.NO_VEHICLE),
)

photo: Final[Cell] = (
    _taking,
    _goal_waits,
    Branch(answer=Answer.TASK, do=(Do.PHOTO,), to=State.TAKING_PICTURE),
)
_mission: Final = Branch(
    needs=(Check.SEVERITY, Check.VERIFIER, Check.MISSION),
    answer=Answer.TASK,
    do=(Do.START_MISSION,),
    to=State.FLYING_MISSION,
)
miss_h: Final[Cell] = (_taking, _goal_waits, _mission)
miss_g: Final[Cell] = (
    _task_busy,
    Branch(
        needs=(Check.ARMED, Check.ON_GROUND, *_mission.needs),
        answer=Answer.TASK,
        do=_mission.do,
        to=State.FLYING_MISSION,
    ),
)
fence: Final[Cell] = (
    Branch(when=(Guard.FENCE_SWITCHABLE,), answer=Answer.DONE, do=(Do.SWITCH_FENCE,)),
    Branch(refuse=Code.POLICY),
)

# fmt: off
# ruff: noqa: E501 - a table is read along its rows
REQUEST_ROWS: Final[Mapping[Event, Row]] = {
    #                    NO_VE   STALE   GROUN   TAKOF   HOVER   VERIF   MOVIN   STREA   PICTU   MISSI   RETUR   LANDI   HOLDI   EXTER
    Event.GOTO:          (no_veh, stale,  no_fly, busy,   goto_h, imposs, goto_m, busy,   busy,   busy,   busy,   busy,   is_hld, no_ctl),
    Event.CONTROL:       (no_veh, stale,  done,   busy,   take_h, imposs, done,   done,   done,   done,   busy,   busy,   is_hld, take),
    Event.RESUME:        (no_veh, stale,  no_fly, busy,   take_h, imposs, busy,   busy,   busy,   busy,   busy,   busy,   take,   take),
    Event.ARM:           (no_veh, stale,  arm,    flying, flying, imposs, flying, flying, flying, flying, flying, flying, flying, flying),
    Event.DISARM:        (no_veh, disa_s, disa_g, disarm, disarm, imposs, disarm, disarm, disarm, disarm, disarm, disarm, disarm, disarm),
    Event.FORCE_DISARM:  (no_veh, force,  disa_g, force,  force,  imposs, force,  force,  force,  force,  force,  force,  force,  force),
    Event.TAKE_OFF:      (no_veh, stale,  takeof, flying, flying, imposs, flying, flying, flying, flying, flying, flying, flying, flying),
    Event.LAND:          (no_veh, land_s, land_s, land,   land,   imposs, land,   land,   land,   land,   land,   land,   land,   land),
    Event.RETURN:        (no_veh, rtl_s,  rtl_g,  rtl,    rtl,    imposs, rtl,    rtl,    rtl,    rtl,    rtl,    rtl_l,  rtl,    rtl),
    Event.HOLD:          (no_veh, hold_s, hold_g, hold_t, hold,   imposs, hold,   hold,   hold,   hold,   hold,   hold,   hold,   hold),
    Event.ABORT:         (abrt_n, abrt_s, abrt_g, hold_t, hold,   imposs, hold,   hold,   hold,   hold,   hold,   hold,   hold,   hold),
    Event.PHOTO:         (no_veh, stale,  no_fly, busy,   photo,  imposs, busy,   busy,   busy,   busy,   busy,   busy,   is_hld, no_ctl),
    Event.MISSION:       (no_veh, stale,  miss_g, busy,   miss_h, imposs, busy,   busy,   busy,   busy,   busy,   busy,   is_hld, no_ctl),
    Event.OTHER_MODE:    (no_veh, policy, policy, policy, policy, imposs, policy, policy, policy, policy, policy, policy, policy, policy),
    Event.FENCE:         (fence,  fence,  fence,  fence,  fence,  imposs, fence,  fence,  fence,  fence,  fence,  fence,  fence,  fence),
}
# fmt: on
