"""What makes a client's message the same request as another one: a repetition."""

from __future__ import annotations

from typing import Final

import msgspec

from gcs.wire.codec import encode
from gcs.wire.messages import (
    CommandInt,
    CommandLong,
    Message,
    MissionClearAll,
    MissionCount,
    MissionItem,
    MissionItemInt,
)

KEYED: Final = (
    CommandLong,
    CommandInt,
    MissionItem,
    MissionItemInt,
    MissionCount,
    MissionClearAll,
)
GUIDED_ITEM: Final = -1
"""In the place of a command: a mission item to be flown to at once, which has a MISSION_ACK."""


def command_of(message: Message | None) -> int:
    """MAV_CMD; GUIDED_ITEM for an item that is flown to at once; 0 for a message that is not
    acknowledged."""
    if isinstance(message, MissionItem | MissionItemInt):
        return GUIDED_ITEM
    return message.command if isinstance(message, CommandLong | CommandInt) else 0


def key_of(message: Message | None) -> bytes:
    """Equal for the same command, all but the number of its repetition, for the same item, and for
    the same first message of a plan.

    As bytes, because NaN is a value of its own on the wire and equals nothing here.  Empty for what
    is not acknowledged, which repeats nothing: a text in such a message may be any bytes, and
    cannot be written again.
    """
    if isinstance(message, CommandLong):
        message = msgspec.structs.replace(message, confirmation=0)
    return encode(message) if isinstance(message, KEYED) else b""
