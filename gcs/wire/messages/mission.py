"""The mission protocol, for missions, fences and rally points alike."""

from __future__ import annotations

from typing import ClassVar

from gcs.wire.ids import MsgId
from gcs.wire.messages.base import Message


class MissionCount(Message, frozen=True, gc=False):
    """So many items are to come, or are there."""

    MSG_ID: ClassVar[MsgId] = MsgId.MISSION_COUNT
    count: int
    target_system: int
    target_component: int
    mission_type: int = 0  # MAV_MISSION_TYPE
    opaque_id: int = 0


class MissionRequestList(Message, frozen=True, gc=False):
    """How many items are there?"""

    MSG_ID: ClassVar[MsgId] = MsgId.MISSION_REQUEST_LIST
    target_system: int
    target_component: int
    mission_type: int = 0  # MAV_MISSION_TYPE


class MissionRequest(Message, frozen=True, gc=False):
    """The old way to ask for an item."""

    MSG_ID: ClassVar[MsgId] = MsgId.MISSION_REQUEST
    seq: int
    target_system: int
    target_component: int
    mission_type: int = 0  # MAV_MISSION_TYPE


class MissionRequestInt(Message, frozen=True, gc=False):
    """Send me this item."""

    MSG_ID: ClassVar[MsgId] = MsgId.MISSION_REQUEST_INT
    seq: int
    target_system: int
    target_component: int
    mission_type: int = 0  # MAV_MISSION_TYPE


class MissionItem(Message, frozen=True, gc=False):
    """An item with its position in floats."""

    MSG_ID: ClassVar[MsgId] = MsgId.MISSION_ITEM
    param1: float
    param2: float
    param3: float
    param4: float
    x: float
    y: float
    z: float
    seq: int
    command: int  # MAV_CMD
    target_system: int
    target_component: int
    frame: int  # MAV_FRAME
    current: int
    autocontinue: int
    mission_type: int = 0  # MAV_MISSION_TYPE


class MissionItemInt(Message, frozen=True, gc=False):
    """An item; x, y in 1e-7 degrees, or in 1e-4 m in local frames."""

    MSG_ID: ClassVar[MsgId] = MsgId.MISSION_ITEM_INT
    param1: float
    param2: float
    param3: float
    param4: float
    x: int
    y: int
    z: float
    seq: int
    command: int  # MAV_CMD
    target_system: int
    target_component: int
    frame: int  # MAV_FRAME
    current: int
    autocontinue: int
    mission_type: int = 0  # MAV_MISSION_TYPE


class MissionAck(Message, frozen=True, gc=False):
    """How a transfer ended."""

    MSG_ID: ClassVar[MsgId] = MsgId.MISSION_ACK
    target_system: int
    target_component: int
    type: int  # MAV_MISSION_RESULT
    mission_type: int = 0  # MAV_MISSION_TYPE
    opaque_id: int = 0


class MissionClearAll(Message, frozen=True, gc=False):
    """Forget the plan."""

    MSG_ID: ClassVar[MsgId] = MsgId.MISSION_CLEAR_ALL
    target_system: int
    target_component: int
    mission_type: int = 0  # MAV_MISSION_TYPE


class MissionCurrent(Message, frozen=True, gc=False):
    """Which item is flown."""

    MSG_ID: ClassVar[MsgId] = MsgId.MISSION_CURRENT
    seq: int
    total: int = 0
    mission_state: int = 0  # MISSION_STATE
    mission_mode: int = 0
    mission_id: int = 0
    fence_id: int = 0
    rally_points_id: int = 0


class MissionItemReached(Message, frozen=True, gc=False):
    """An item was reached; may repeat, may be skipped."""

    MSG_ID: ClassVar[MsgId] = MsgId.MISSION_ITEM_REACHED
    seq: int


class MissionSetCurrent(Message, frozen=True, gc=False):
    """Fly on from this item."""

    MSG_ID: ClassVar[MsgId] = MsgId.MISSION_SET_CURRENT
    seq: int
    target_system: int
    target_component: int
