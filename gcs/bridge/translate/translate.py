"""What a client's MAVLink message asks the vehicle to do, in the operators' words.

Pure: the message and what is known of the vehicle decide, nothing is remembered.  Whether one may
ask for it, and whether it may be flown, is not decided here: a request goes to the gate, which
judges it as any operator's.  `target_system` and `target_component` are the bridge's to route by.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Final, TypeVar

from gcs.bridge.translate.attitudes import attitude_target
from gcs.bridge.translate.command import command_of
from gcs.bridge.translate.commands import meaning_of_command
from gcs.bridge.translate.guided_items import guided_item
from gcs.bridge.translate.meaning import Meaning, Seen
from gcs.bridge.translate.mission_commands import mission_set_current
from gcs.bridge.translate.modes import set_mode
from gcs.bridge.translate.says import refuse, unsupported
from gcs.bridge.translate.sticks import manual_control, rc_override
from gcs.bridge.translate.targets import global_target, local_target
from gcs.gate.refusal import Code
from gcs.wire import messages as m

M = TypeVar("M", bound=m.Message)


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
