"""The events: everything that can happen to the gate, by name.  Each is a row of the table.

`observe.py` makes events from inputs.  The event of a request follows from the request alone; a
request for a mode by its name is the event of the request that means the same.
"""

from __future__ import annotations

from collections.abc import Mapping
from enum import StrEnum
from types import MappingProxyType
from typing import Final

from gcs.gate.requests import (
    Abort,
    Arm,
    BeginStream,
    Disarm,
    EndStream,
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
    """The values are the names in records, transitions and the printed table."""

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
    STREAM_BEGIN = "stream begin"
    STREAM_END = "stream end"
    OTHER_MODE = "other mode"
    FENCE = "fence switch"

    GOAL_CLEARED = "goal cleared"
    GOAL_REFUSED = "goal refused"
    STREAM_SAMPLE = "stream sample"

    VEHICLE_HEARD = "heard"
    VEHICLE_LOST = "lost"
    POSITION = "position"
    POSITION_AGED = "position aged"
    POSITION_JUMPED = "position jumped"
    BREACH = "breach predicted"
    HOME_MOVED = "home moved"
    CLEARS_NO_MORE = "clears no more"
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

    COMMAND_ACCEPTED = "command accepted"
    COMMAND_REFUSED = "command refused"
    COMMAND_UNANSWERED = "command unanswered"
    DISARM_REFUSED = "disarm refused"
    HOLD_REFUSED = "hold refused"
    HOLD_UNANSWERED = "hold unanswered"
    LATE_ANSWER = "late answer"
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
    SEVERITY_EASED = "eased"
    OPERATOR_LOST = "operator lost"


OF_REQUEST: Final[Mapping[type[Request], Event]] = MappingProxyType(
    {
        GoTo: Event.GOTO,
        TakeControl: Event.CONTROL,
        Resume: Event.RESUME,
        Arm: Event.ARM,
        Disarm: Event.DISARM,
        TakeOff: Event.TAKE_OFF,
        Land: Event.LAND,
        ReturnHome: Event.RETURN,
        Hold: Event.HOLD,
        Abort: Event.ABORT,
        TakePhoto: Event.PHOTO,
        StartMission: Event.MISSION,
        BeginStream: Event.STREAM_BEGIN,
        EndStream: Event.STREAM_END,
        SetMode: Event.OTHER_MODE,
        SwitchFence: Event.FENCE,
    }
)
"""The event of a request; a mode by its name may mean another, and a disarming may be forced."""

REQUESTS: Final = frozenset({*OF_REQUEST.values(), Event.FORCE_DISARM})
"""The events that are requests: each gets exactly one verdict."""

NEEDS_OPERATOR: Final = REQUESTS - {
    Event.ABORT,
    Event.HOLD,
    Event.LAND,
    Event.DISARM,
    Event.FORCE_DISARM,
}
"""Requests that are refused once the operator is lost.  The others make it safer, and are heard
without an operator too."""

ASKED: Final = {
    FlightMode.GUIDED: Event.CONTROL,
    FlightMode.HOLD: Event.HOLD,
    FlightMode.TAKEOFF: Event.OTHER_MODE,
    FlightMode.MISSION: Event.MISSION,
    FlightMode.RETURN: Event.RETURN,
    FlightMode.LAND: Event.LAND,
    FlightMode.OTHER: Event.OTHER_MODE,
}
"""The event of a request for a mode by its name."""

SAW: Final = {
    FlightMode.GUIDED: Event.SAW_GUIDED,
    FlightMode.HOLD: Event.SAW_HOLD,
    FlightMode.TAKEOFF: Event.SAW_TAKE_OFF,
    FlightMode.MISSION: Event.SAW_MISSION,
    FlightMode.RETURN: Event.SAW_RETURN,
    FlightMode.LAND: Event.SAW_LAND,
    FlightMode.OTHER: Event.SAW_OTHER,
}
"""The event of a mode that the heartbeat newly shows and that we did not command."""


def event_of(request: Request) -> Event:
    """The event, and so the row of the table, that decides on `request`."""
    if isinstance(request, SetMode):
        return ASKED[request.meaning]
    if isinstance(request, Disarm) and request.force:
        return Event.FORCE_DISARM
    return OF_REQUEST[type(request)]
