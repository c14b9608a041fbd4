"""How often the gate needs which message: a client may have it faster, and never slower.

A vehicle sends one set of streams on a link, whoever asks.  So a client's SET_MESSAGE_INTERVAL of
a message that the gate flies by goes on with the gate's interval at the most; and after a
REQUEST_DATA_STREAM, which on ArduPilot sets whole groups of messages, the gate asks anew for what
it needs faster than the client does.

What the gate takes as the vehicle sends it (`KEPT_HZ`) a client may not stop either: an ArduPilot
would stop its HEARTBEAT (`GCS_MAVLINK::set_ap_message_interval`), and with it its mode and whether
it is armed.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final, TypeAlias

import msgspec

from gcs.wire.ids import Cmd, MsgId
from gcs.wire.messages import CommandInt, CommandLong, RequestDataStream

Command: TypeAlias = CommandLong | CommandInt
Rates: TypeAlias = Mapping[int, float]
"""Message id -> Hz."""


KEPT_HZ: Final[Rates] = {
    MsgId.HEARTBEAT: 1.0,
    MsgId.HOME_POSITION: 0.5,  # as PX4 sends it unasked
    MsgId.GPS_GLOBAL_ORIGIN: 0.5,
    MsgId.STATUSTEXT: 1.0,
    MsgId.EVENT: 1.0,
    MsgId.CURRENT_EVENT_SEQUENCE: 0.5,
    MsgId.COMMAND_LONG: 1.0,  # a PX4's request for leave to arm
    MsgId.TIMESYNC: 1.0,
    MsgId.RADIO_STATUS: 1.0,
    MsgId.MISSION_ITEM_REACHED: 1.0,
}
"""What the gate does not ask for and reads all the same; the vehicle's default is good enough."""


def not_slower(command: Command, needed_hz: Rates) -> Command | None:
    """The command with an interval that is short enough; None where it may stay as it is.

    param1 is a message id, param2 the interval in microseconds: -1 none, 0 the vehicle's default.
    param3 is left out: it was the whole link's bytes a second to PX4 up to 1.15
    (`MavlinkReceiver::set_message_interval`), and slows every stream.
    """
    if command.command != Cmd.SET_MESSAGE_INTERVAL:
        return None
    asked_us, rate = command.param2, 0.0 if command.param3 > 0.0 else command.param3
    wanted_hz = max(_kept_hz(each, asked_us, needed_hz) for each in _ids(command.param1))
    if wanted_hz > 0.0 and not 0.0 < asked_us <= round(1e6 / wanted_hz):
        asked_us = float(round(1e6 / wanted_hz))
    elif rate is command.param3:
        return None
    return msgspec.structs.replace(command, param2=asked_us, param3=rate)


def _kept_hz(msgid: int, asked_us: float, needed_hz: Rates) -> float:
    """0: the gate does without."""
    if msgid in needed_hz:
        return needed_hz[msgid]
    return 0.0 if asked_us == 0.0 else KEPT_HZ.get(msgid, 0.0)


def _ids(value: float) -> tuple[int, ...]:
    """What a vehicle may read the number as: PX4 rounds it, ArduPilot cuts it, and what is negative
    or no number becomes 0 where it is made unsigned (of ARM processors, from memory)."""
    return (int(value), int(value + 0.5)) if 0.0 <= value < 1e8 else (0,)


def asked_anew(request: RequestDataStream, needed_hz: Rates) -> list[int]:
    """The messages that the gate asks for once more after this request."""
    hz = float(request.req_message_rate) if request.start_stop else 0.0
    return [msgid for msgid, wanted_hz in needed_hz.items() if wanted_hz > hz]
