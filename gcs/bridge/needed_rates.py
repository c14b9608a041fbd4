"""The gate's own eyes: a client may have a stream faster than the gate needs it, and never slower.

A vehicle sends one set of streams on a link, whoever asks.  So a client's SET_MESSAGE_INTERVAL of
a message that the gate flies by goes on with the gate's interval at the most; and after a
REQUEST_DATA_STREAM, which on ArduPilot sets whole groups of messages, the gate asks anew for what
it needs faster than the client does.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import TypeAlias

import msgspec

from gcs.wire.ids import Cmd
from gcs.wire.messages import CommandInt, CommandLong, RequestDataStream

Command: TypeAlias = CommandLong | CommandInt
Rates: TypeAlias = Mapping[int, float]
"""Message id -> Hz."""


def not_slower(command: Command, needed_hz: Rates) -> Command | None:
    """The command with an interval that is short enough; None where it may stay as it is.

    param1 is a message id, param2 the interval in microseconds: -1 none, 0 the vehicle's default.
    """
    if command.command != Cmd.SET_MESSAGE_INTERVAL:
        return None
    asked_us, wanted_hz = command.param2, needed_hz.get(_message_id(command.param1))
    if wanted_hz is None:
        return None
    most_us = round(1e6 / wanted_hz)
    if 0.0 < asked_us <= most_us:
        return None
    return msgspec.structs.replace(command, param2=float(most_us))


def _message_id(value: float) -> int:
    return int(value) if abs(value) < 1e8 else -1


def asked_anew(request: RequestDataStream, needed_hz: Rates) -> list[int]:
    """The messages that the gate asks for once more after this request."""
    hz = float(request.req_message_rate) if request.start_stop else 0.0
    return [msgid for msgid, wanted_hz in needed_hz.items() if wanted_hz > hz]
