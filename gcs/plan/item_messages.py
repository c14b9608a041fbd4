"""A plan's item as MAVLink's messages carry it, and back: MISSION_ITEM_INT, and MISSION_ITEM.

MISSION_ITEM has latitude and longitude as degrees in float32, MISSION_ITEM_INT in 1e-7 degrees.
"""

from __future__ import annotations

from typing import Final

from gcs.plan import commands
from gcs.plan.wire import WireItem
from gcs.wire.ids import MavFrame
from gcs.wire.messages import MissionItem, MissionItemInt

_DEGREES: Final = 1e7
_INT32: Final = 2**31 - 1


def item_of(message: MissionItemInt) -> WireItem:
    """What the message says."""
    return _filled(message, message.x, message.y)


def item_of_degrees(message: MissionItem) -> WireItem | None:
    """As MISSION_ITEM_INT has it; None where no such item can hold its place.

    What float32 says to the nearest metre is what the integers say that it becomes here.
    """
    placed = commands.has_place(message.command, message.frame)
    scale = _DEGREES if placed and message.frame != MavFrame.MISSION else 1.0
    x, y = message.x * scale, message.y * scale
    if not (abs(x) <= _INT32 and abs(y) <= _INT32):  # NaN too
        return None
    return _filled(message, round(x), round(y))


def message_of(item: WireItem) -> MissionItemInt:
    """Target and type are the transfer's to set."""
    return MissionItemInt(
        param1=item.param1,
        param2=item.param2,
        param3=item.param3,
        param4=item.param4,
        x=item.x,
        y=item.y,
        z=item.z,
        seq=item.seq,
        command=item.command,
        target_system=0,
        target_component=0,
        frame=item.frame,
        current=item.current,
        autocontinue=item.autocontinue,
    )


def _filled(message: MissionItem | MissionItemInt, x: int, y: int) -> WireItem:
    return WireItem(
        seq=message.seq,
        frame=message.frame,
        command=message.command,
        current=message.current,
        autocontinue=message.autocontinue,
        param1=message.param1,
        param2=message.param2,
        param3=message.param3,
        param4=message.param4,
        x=x,
        y=y,
        z=message.z,
        mission_type=message.mission_type,
    )
