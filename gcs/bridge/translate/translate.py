"""What a client's MAVLink message asks the vehicle to do, in the operators' words.

Pure: the message and what is known of the vehicle decide, nothing is remembered.  Whether one may
ask for it, and whether it may be flown, is not decided here: a request goes to the gate, which
judges it as any operator's.  `target_system` and `target_component` are the bridge's to route by.

A MISSION_ITEM or MISSION_ITEM_INT that is no part of a plan is translated here: `current` 2 is a
go-to, 3 a height.  These are ArduPilot's (`GCS_Common.cpp`, `mode_auto.cpp`): MAVProxy's `guided`,
DroneKit's `simple_goto`, and QGroundControl's go-to of older versions.  PX4 knows neither.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Final, TypeVar

from gcs.bridge.translate.attitudes import attitude_target
from gcs.bridge.translate.command import command_of
from gcs.bridge.translate.commands import meaning_of_command
from gcs.bridge.translate.meaning import Meaning, Reject, Seen
from gcs.bridge.translate.mission_commands import mission_set_current
from gcs.bridge.translate.modes import set_mode
from gcs.bridge.translate.places import DEGREES_PER_UNIT, datum_of, place_of
from gcs.bridge.translate.says import go_to, refuse, unsupported
from gcs.bridge.translate.sticks import manual_control, rc_override
from gcs.bridge.translate.targets import global_target, local_target
from gcs.gate.refusal import Code, Refusal
from gcs.wire import messages as m
from gcs.wire.ids import Cmd
from gcs.wire.messages import MissionItem, MissionItemInt

M = TypeVar("M", bound=m.Message)

GO_TO: Final = 2
CHANGE_HEIGHT: Final = 3


def guided_item(message: MissionItem | MissionItemInt, seen: Seen) -> Meaning:
    """A go-to there, or to another height where it is or flies to."""
    if message.current not in (GO_TO, CHANGE_HEIGHT):
        return refuse(Code.BAD_MISSION, "a mission item that belongs to no upload")
    if seen.autopilot.mode_in_two_parts:
        return unsupported("px4 takes no single mission item: use DO_REPOSITION")
    if message.command != Cmd.NAV_WAYPOINT:
        return unsupported(
            f"command {message.command} as a single item: only NAV_WAYPOINT is flown"
        )
    datum = datum_of(message.frame)
    if isinstance(datum, Refusal):
        return Reject(datum)
    unit = DEGREES_PER_UNIT if isinstance(message, MissionItemInt) else 1.0
    lat_deg, lon_deg = message.x * unit, message.y * unit
    if message.current == CHANGE_HEIGHT:
        lat_deg = lon_deg = math.nan
    elif math.isnan(lat_deg) or math.isnan(lon_deg) or math.isnan(message.z):
        return refuse(Code.NON_FINITE, "a go-to with a coordinate that is no number")
    place_ned = place_of(seen, lat_deg, lon_deg, message.z, datum)
    if isinstance(place_ned, Refusal):
        return Reject(place_ned)
    if message.current == CHANGE_HEIGHT and seen.goal_ned is not None:
        place_ned = (seen.goal_ned[0], seen.goal_ned[1], place_ned[2])
    return go_to(seen, place_ned, None)


@dataclass(frozen=True, slots=True)
class MessageRow:
    """What one message means, and the same in words for `docs/bridge.md`."""

    name: str
    translate: Callable[[m.Message, Seen], Meaning]
    says: str


def _row(of: type[M], translate: Callable[[M, Seen], Meaning], says: str) -> tuple[int, MessageRow]:
    def checked(message: m.Message, seen: Seen) -> Meaning:
        assert isinstance(message, of)
        return translate(message, seen)

    return of.MSG_ID, MessageRow(of.MSG_ID.name, checked, says)


def _command(message: m.CommandLong | m.CommandInt, seen: Seen) -> Meaning:
    return meaning_of_command(command_of(message), seen)


_COMMAND: Final = "its command decides"
_ITEM: Final = (
    "ArduPilot: `current` 2 is a goto, 3 a goto to another height, with a MISSION_ACK (ACCEPTED, "
    "DENIED). PX4: refused; "
    "with `current` 0 or 1 it is part of a plan"
)

MESSAGES: Final[Mapping[int, MessageRow]] = dict(
    (
        _row(m.CommandLong, _command, _COMMAND),
        _row(m.CommandInt, _command, _COMMAND),
        _row(m.SetMode, set_mode, "as DO_SET_MODE"),
        _row(
            m.SetPositionTargetLocalNed,
            local_target,
            "a sample of a stream, or a goto: see setpoints",
        ),
        _row(
            m.SetPositionTargetGlobalInt,
            global_target,
            "a sample of a stream, or a goto: see setpoints",
        ),
        _row(m.MissionItem, guided_item, _ITEM),
        _row(m.MissionItemInt, guided_item, _ITEM),
        _row(m.MissionSetCurrent, mission_set_current, "as DO_SET_MISSION_CURRENT"),
        _row(
            m.ManualControl,
            manual_control,
            "sticks: samples of a velocity stream, in the middle nothing. Buttons are ignored, and "
            "nothing of it is forwarded",
        ),
        _row(
            m.RcChannelsOverride,
            rc_override,
            "ArduPilot: channels 1 to 4 are sticks, if all others are released or left alone. PX4: "
            "refused. Released channels ask for nothing. Never forwarded",
        ),
        _row(
            m.SetAttitudeTarget,
            attitude_target,
            "a sample of a stream, where the policy allows a tilt (`[stream] tilt_deg`) and the "
            "mask leaves an attitude and a thrust; body rates alone are refused: see attitudes",
        ),
    )
)
"""By message id."""


def meaning_of(message: m.Message, seen: Seen) -> Meaning:
    """Of any message of the dialect; never raises for one that was decoded from a frame."""
    if not seen.autopilot.commanded:
        return refuse(
            Code.UNSUPPORTED_VEHICLE, "this station flies multirotors with PX4 or ArduPilot only"
        )
    row = MESSAGES.get(message.MSG_ID)
    if row is None:
        return unsupported(f"{message.MSG_ID.name} has no meaning that moves a vehicle")
    return row.translate(message, seen)
