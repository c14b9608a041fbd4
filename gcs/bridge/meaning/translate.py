"""What a client's MAVLink message asks the vehicle to do, in the operators' words.

Pure: the message and what is known of the vehicle decide, nothing is remembered.  Whether one may
ask for it, and whether it may be flown, is not decided here: a request goes to the gate, which
judges it as any operator's.  `target_system` and `target_component` are the bridge's to route by.
"""

from __future__ import annotations

from gcs.bridge.meaning import mission_commands
from gcs.bridge.meaning.command import command_of
from gcs.bridge.meaning.commands import meaning_of_command
from gcs.bridge.meaning.guided_items import guided_item
from gcs.bridge.meaning.meaning import Meaning, Seen
from gcs.bridge.meaning.modes import set_mode
from gcs.bridge.meaning.says import refuse, unsupported
from gcs.bridge.meaning.sticks import attitude_target, manual_control, rc_override
from gcs.bridge.meaning.targets import global_target, local_target
from gcs.gate.refusal import Code
from gcs.wire import messages as m


def meaning_of(message: m.Message, seen: Seen) -> Meaning:
    """Of any message of the dialect; never raises for one that was decoded from a frame."""
    if not seen.autopilot.commanded:
        return refuse(
            Code.UNSUPPORTED_VEHICLE, "this station flies multirotors with PX4 or ArduPilot only"
        )
    match message:
        case m.CommandLong() | m.CommandInt():
            return meaning_of_command(command_of(message), seen)
        case m.SetMode():
            return set_mode(message, seen)
        case m.SetPositionTargetLocalNed():
            return local_target(message, seen)
        case m.SetPositionTargetGlobalInt():
            return global_target(message, seen)
        case m.MissionItem() | m.MissionItemInt():
            return guided_item(message, seen)
        case m.MissionSetCurrent():
            return mission_commands.mission_set_current(message, seen)
        case m.ManualControl():
            return manual_control(message, seen)
        case m.RcChannelsOverride():
            return rc_override(message, seen)
        case m.SetAttitudeTarget():
            return attitude_target(message, seen)
        case _:
            return unsupported(f"{type(message).__name__} has no meaning that moves a vehicle")
