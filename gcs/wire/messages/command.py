"""Commands, their answers, and setpoints."""

from __future__ import annotations

from typing import ClassVar

from gcs.wire.ids import MsgId
from gcs.wire.messages.base import Message


class CommandLong(Message, frozen=True, gc=False):
    """A command with seven floats."""

    MSG_ID: ClassVar[MsgId] = MsgId.COMMAND_LONG
    param1: float
    param2: float
    param3: float
    param4: float
    param5: float
    param6: float
    param7: float
    command: int  # MAV_CMD
    target_system: int
    target_component: int
    confirmation: int


class CommandInt(Message, frozen=True, gc=False):
    """A command whose position is in integers, with a frame."""

    MSG_ID: ClassVar[MsgId] = MsgId.COMMAND_INT
    param1: float
    param2: float
    param3: float
    param4: float
    x: int
    y: int
    z: float
    command: int  # MAV_CMD
    target_system: int
    target_component: int
    frame: int  # MAV_FRAME
    current: int
    autocontinue: int


class CommandAck(Message, frozen=True, gc=False):
    """What became of a command."""

    MSG_ID: ClassVar[MsgId] = MsgId.COMMAND_ACK
    command: int  # MAV_CMD
    result: int  # MAV_RESULT
    progress: int = 0
    result_param2: int = 0
    target_system: int = 0
    target_component: int = 0


class CommandCancel(Message, frozen=True, gc=False):
    """Stop a long-running command."""

    MSG_ID: ClassVar[MsgId] = MsgId.COMMAND_CANCEL
    command: int
    target_system: int
    target_component: int


class SetMode(Message, frozen=True, gc=False):
    """The old way to change mode."""

    MSG_ID: ClassVar[MsgId] = MsgId.SET_MODE
    custom_mode: int
    target_system: int
    base_mode: int  # MAV_MODE


class SetPositionTargetLocalNed(Message, frozen=True, gc=False):
    """Fly there: set bits of `type_mask` are fields to ignore."""

    MSG_ID: ClassVar[MsgId] = MsgId.SET_POSITION_TARGET_LOCAL_NED
    time_boot_ms: int  # ms
    x: float  # m
    y: float  # m
    z: float  # m
    vx: float  # m/s
    vy: float  # m/s
    vz: float  # m/s
    afx: float  # m/s/s
    afy: float  # m/s/s
    afz: float  # m/s/s
    yaw: float  # rad
    yaw_rate: float  # rad/s
    type_mask: int  # POSITION_TARGET_TYPEMASK
    target_system: int
    target_component: int
    coordinate_frame: int  # MAV_FRAME


class PositionTargetLocalNed(Message, frozen=True, gc=False):
    """What the vehicle flies to, the only echo a setpoint has."""

    MSG_ID: ClassVar[MsgId] = MsgId.POSITION_TARGET_LOCAL_NED
    time_boot_ms: int  # ms
    x: float  # m
    y: float  # m
    z: float  # m
    vx: float  # m/s
    vy: float  # m/s
    vz: float  # m/s
    afx: float  # m/s/s
    afy: float  # m/s/s
    afz: float  # m/s/s
    yaw: float  # rad
    yaw_rate: float  # rad/s
    type_mask: int  # POSITION_TARGET_TYPEMASK
    coordinate_frame: int  # MAV_FRAME


class SetPositionTargetGlobalInt(Message, frozen=True, gc=False):
    """Fly there, over the ground."""

    MSG_ID: ClassVar[MsgId] = MsgId.SET_POSITION_TARGET_GLOBAL_INT
    time_boot_ms: int  # ms
    lat_int: int  # degE7
    lon_int: int  # degE7
    alt: float  # m
    vx: float  # m/s
    vy: float  # m/s
    vz: float  # m/s
    afx: float  # m/s/s
    afy: float  # m/s/s
    afz: float  # m/s/s
    yaw: float  # rad
    yaw_rate: float  # rad/s
    type_mask: int  # POSITION_TARGET_TYPEMASK
    target_system: int
    target_component: int
    coordinate_frame: int  # MAV_FRAME


class PositionTargetGlobalInt(Message, frozen=True, gc=False):
    """What the vehicle flies to, over the ground."""

    MSG_ID: ClassVar[MsgId] = MsgId.POSITION_TARGET_GLOBAL_INT
    time_boot_ms: int  # ms
    lat_int: int  # degE7
    lon_int: int  # degE7
    alt: float  # m
    vx: float  # m/s
    vy: float  # m/s
    vz: float  # m/s
    afx: float  # m/s/s
    afy: float  # m/s/s
    afz: float  # m/s/s
    yaw: float  # rad
    yaw_rate: float  # rad/s
    type_mask: int  # POSITION_TARGET_TYPEMASK
    coordinate_frame: int  # MAV_FRAME
