"""Everything that can happen to the gate, by name: the rows of the table.

An input becomes facts in the gate's memory and, from what changed, events.  What a request is
called here follows from the request alone; a mode that is asked for by name is the request that
the mode means.
"""

from __future__ import annotations

from enum import StrEnum
from typing import Final, assert_never

from gcs.gate.requests import (
    Abort,
    Arm,
    Disarm,
    GoTo,
    Hold,
    Land,
    Request,
    Resume,
    ReturnHome,
    SetMode,
    StartMission,
    SwitchFence,
    TakeControl,
    TakeOff,
    TakePhoto,
)
from gcs.gate.states import FlightMode


class Event(StrEnum):
    """The value is the name in records, transitions and drawings."""

    GOTO = "goto"
    CONTROL = "control"
    RESUME = "resume"
    ARM = "arm"
    DISARM = "disarm"
    FORCE_DISARM = "force disarm"
    TAKE_OFF = "take off"
    LAND = "land"
    RETURN = "return"
    HOLD = "hold"
    ABORT = "abort"
    PHOTO = "photo"
    MISSION = "mission"
    OTHER_MODE = "other mode"
    FENCE = "fence switch"

    GOAL_CLEARED = "goal cleared"
    GOAL_REFUSED = "goal refused"

    HEARD = "heard"
    LOST = "lost"
    POSITION = "position"
    AGED = "position aged"
    JUMPED = "position jumped"
    BREACH = "breach predicted"
    HOME_MOVED = "home moved"
    UNVERIFIED = "clears no more"
    ARMED = "armed"
    DISARMED = "disarmed"
    AIRBORNE = "airborne"
    LANDED = "landed"

    MODE_CONFIRMED = "mode confirmed"
    MODE_OVERDUE = "mode overdue"
    SAW_GUIDED = "guided mode"
    SAW_HOLD = "hold mode"
    SAW_TAKE_OFF = "take-off mode"
    SAW_MISSION = "mission mode"
    SAW_RETURN = "return mode"
    SAW_LAND = "land mode"
    SAW_OTHER = "another mode"

    COMMAND_DONE = "command accepted"
    COMMAND_REFUSED = "command refused"
    COMMAND_SILENT = "command unanswered"
    DISARM_REFUSED = "disarm refused"
    HOLD_REFUSED = "hold refused"
    HOLD_SILENT = "hold unanswered"
    COMMAND_LATE = "late answer"
    PHOTO_SEEN = "photo seen"
    MISSION_ITEM = "mission item"
    MISSION_FINISHED = "mission finished"

    TICK = "tick"
    DEADLINE = "deadline"
    CONTROL_DUE = "control due"
    HOLD_DUE = "hold due"

    MUST_HOLD = "must hold"
    MUST_RETURN = "must return"
    MUST_LAND = "must land"
    EASED = "eased"
    OPERATOR_LOST = "operator lost"


REQUESTS: Final = frozenset(
    {
        Event.GOTO,
        Event.CONTROL,
        Event.RESUME,
        Event.ARM,
        Event.DISARM,
        Event.FORCE_DISARM,
        Event.TAKE_OFF,
        Event.LAND,
        Event.RETURN,
        Event.HOLD,
        Event.ABORT,
        Event.PHOTO,
        Event.MISSION,
        Event.OTHER_MODE,
        Event.FENCE,
    }
)
"""Events that are somebody's request: each is owed one verdict."""

ATTENDED: Final = REQUESTS - {
    Event.ABORT,
    Event.HOLD,
    Event.LAND,
    Event.DISARM,
    Event.FORCE_DISARM,
}
"""Requests that want an operator who is there; the others make it safer whoever asks."""

ASKED: Final = {
    FlightMode.GUIDED: Event.CONTROL,
    FlightMode.HOLD: Event.HOLD,
    FlightMode.TAKEOFF: Event.OTHER_MODE,
    FlightMode.MISSION: Event.MISSION,
    FlightMode.RETURN: Event.RETURN,
    FlightMode.LAND: Event.LAND,
    FlightMode.OTHER: Event.OTHER_MODE,
}
"""What asking for a mode by its name means."""

SAW: Final = {
    FlightMode.GUIDED: Event.SAW_GUIDED,
    FlightMode.HOLD: Event.SAW_HOLD,
    FlightMode.TAKEOFF: Event.SAW_TAKE_OFF,
    FlightMode.MISSION: Event.SAW_MISSION,
    FlightMode.RETURN: Event.SAW_RETURN,
    FlightMode.LAND: Event.SAW_LAND,
    FlightMode.OTHER: Event.SAW_OTHER,
}
"""A mode that the heartbeat shows and that was not the one last asked for."""


def event_of(request: Request) -> Event:
    """The row of the table that decides on `request`."""
    match request:
        case GoTo():
            return Event.GOTO
        case TakeControl():
            return Event.CONTROL
        case Resume():
            return Event.RESUME
        case Arm():
            return Event.ARM
        case Disarm(force=force):
            return Event.FORCE_DISARM if force else Event.DISARM
        case TakeOff():
            return Event.TAKE_OFF
        case Land():
            return Event.LAND
        case ReturnHome():
            return Event.RETURN
        case Hold():
            return Event.HOLD
        case Abort():
            return Event.ABORT
        case TakePhoto():
            return Event.PHOTO
        case StartMission():
            return Event.MISSION
        case SetMode(meaning=meaning):
            return ASKED[meaning]
        case SwitchFence():
            return Event.FENCE
    assert_never(request)
