"""Commands, parameters and missions.

One named tuple a message, fields in wire order, values as MAVLink has them (units and frames are
the dialect's).  `char[n]` and `uint8_t[n]` are `bytes`, shorter ones are padded with zeros.
"""

from __future__ import annotations

from typing import NamedTuple


class ParamRequestRead(NamedTuple):
    param_index: int
    target_system: int
    target_component: int
    param_id: bytes


class ParamRequestList(NamedTuple):
    target_system: int
    target_component: int


class ParamValue(NamedTuple):
    param_value: float
    param_count: int
    param_index: int
    param_id: bytes
    param_type: int


class ParamSet(NamedTuple):
    param_value: float
    target_system: int
    target_component: int
    param_id: bytes
    param_type: int


class ParamError(NamedTuple):
    param_index: int
    target_system: int
    target_component: int
    param_id: bytes
    error: int


class CommandInt(NamedTuple):
    param1: float
    param2: float
    param3: float
    param4: float
    x: int
    y: int
    z: float
    command: int
    target_system: int
    target_component: int
    frame: int
    current: int
    autocontinue: int


class CommandLong(NamedTuple):
    param1: float
    param2: float
    param3: float
    param4: float
    param5: float
    param6: float
    param7: float
    command: int
    target_system: int
    target_component: int
    confirmation: int


class CommandAck(NamedTuple):
    command: int
    result: int
    progress: int = 0
    result_param2: int = 0
    target_system: int = 0
    target_component: int = 0


class MissionWritePartialList(NamedTuple):
    start_index: int
    end_index: int
    target_system: int
    target_component: int
    mission_type: int = 0


class MissionItem(NamedTuple):
    param1: float
    param2: float
    param3: float
    param4: float
    x: float
    y: float
    z: float
    seq: int
    command: int
    target_system: int
    target_component: int
    frame: int
    current: int
    autocontinue: int
    mission_type: int = 0


class MissionRequest(NamedTuple):
    seq: int
    target_system: int
    target_component: int
    mission_type: int = 0


class MissionSetCurrent(NamedTuple):
    seq: int
    target_system: int
    target_component: int


class MissionCurrent(NamedTuple):
    seq: int
    total: int = 0
    mission_state: int = 0
    mission_mode: int = 0
    mission_id: int = 0
    fence_id: int = 0
    rally_points_id: int = 0


class MissionRequestList(NamedTuple):
    target_system: int
    target_component: int
    mission_type: int = 0


class MissionCount(NamedTuple):
    count_: int  # a tuple has a `count` already
    target_system: int
    target_component: int
    mission_type: int = 0
    opaque_id: int = 0


class MissionClearAll(NamedTuple):
    target_system: int
    target_component: int
    mission_type: int = 0


class MissionItemReached(NamedTuple):
    seq: int


class MissionAck(NamedTuple):
    target_system: int
    target_component: int
    type: int
    mission_type: int = 0
    opaque_id: int = 0


class MissionRequestInt(NamedTuple):
    seq: int
    target_system: int
    target_component: int
    mission_type: int = 0


class MissionItemInt(NamedTuple):
    param1: float
    param2: float
    param3: float
    param4: float
    x: int
    y: int
    z: float
    seq: int
    command: int
    target_system: int
    target_component: int
    frame: int
    current: int
    autocontinue: int
    mission_type: int = 0
