"""The messages that this vehicle speaks and understands, each with its number.

What is not in `TYPES` is checked for its CRC, counted and otherwise ignored.
"""

from __future__ import annotations

from typing import Final, TypeAlias

from .camera import (
    CameraCaptureStatus,
    CameraFeedback,
    CameraImageCaptured,
    CameraInformation,
    CameraSettings,
    StorageInformation,
)
from .motion import (
    Attitude,
    AttitudeQuaternion,
    GlobalPositionInt,
    GpsGlobalOrigin,
    HomePosition,
    LocalPositionNed,
    PositionTargetLocalNed,
    SetAttitudeTarget,
    SetPositionTargetGlobalInt,
    SetPositionTargetLocalNed,
    VfrHud,
)
from .sensors import (
    BatteryStatus,
    EkfStatusReport,
    EstimatorStatus,
    GpsRawInt,
    HighresImu,
    ScaledPressure,
    ServoOutputRaw,
)
from .system import (
    AutopilotVersion,
    AvailableModes,
    CurrentMode,
    ExtendedSysState,
    Heartbeat,
    MessageInterval,
    Ping,
    ProtocolVersion,
    RequestDataStream,
    SetMode,
    Statustext,
    SysStatus,
    SystemTime,
    Timesync,
)
from .tasks import (
    CommandAck,
    CommandInt,
    CommandLong,
    MissionAck,
    MissionClearAll,
    MissionCount,
    MissionCurrent,
    MissionItem,
    MissionItemInt,
    MissionItemReached,
    MissionRequest,
    MissionRequestInt,
    MissionRequestList,
    MissionSetCurrent,
    ParamError,
    ParamRequestList,
    ParamRequestRead,
    ParamSet,
    ParamValue,
)

Message: TypeAlias = (
    Heartbeat
    | SysStatus
    | SystemTime
    | Ping
    | SetMode
    | ParamRequestRead
    | ParamRequestList
    | ParamValue
    | ParamSet
    | GpsRawInt
    | ScaledPressure
    | Attitude
    | AttitudeQuaternion
    | LocalPositionNed
    | GlobalPositionInt
    | ServoOutputRaw
    | MissionItem
    | MissionRequest
    | MissionSetCurrent
    | MissionCurrent
    | MissionRequestList
    | MissionCount
    | MissionClearAll
    | MissionItemReached
    | MissionAck
    | GpsGlobalOrigin
    | MissionRequestInt
    | RequestDataStream
    | MissionItemInt
    | VfrHud
    | CommandInt
    | CommandLong
    | CommandAck
    | SetAttitudeTarget
    | SetPositionTargetLocalNed
    | PositionTargetLocalNed
    | SetPositionTargetGlobalInt
    | HighresImu
    | Timesync
    | BatteryStatus
    | AutopilotVersion
    | CameraFeedback
    | EkfStatusReport
    | EstimatorStatus
    | HomePosition
    | MessageInterval
    | ExtendedSysState
    | Statustext
    | CameraInformation
    | CameraSettings
    | StorageInformation
    | CameraCaptureStatus
    | CameraImageCaptured
    | ProtocolVersion
    | ParamError
    | AvailableModes
    | CurrentMode
)

TYPES: Final[dict[int, type[Message]]] = {
    0: Heartbeat,
    1: SysStatus,
    2: SystemTime,
    4: Ping,
    11: SetMode,
    20: ParamRequestRead,
    21: ParamRequestList,
    22: ParamValue,
    23: ParamSet,
    24: GpsRawInt,
    29: ScaledPressure,
    30: Attitude,
    31: AttitudeQuaternion,
    32: LocalPositionNed,
    33: GlobalPositionInt,
    36: ServoOutputRaw,
    39: MissionItem,
    40: MissionRequest,
    41: MissionSetCurrent,
    42: MissionCurrent,
    43: MissionRequestList,
    44: MissionCount,
    45: MissionClearAll,
    46: MissionItemReached,
    47: MissionAck,
    49: GpsGlobalOrigin,
    51: MissionRequestInt,
    66: RequestDataStream,
    73: MissionItemInt,
    74: VfrHud,
    75: CommandInt,
    76: CommandLong,
    77: CommandAck,
    82: SetAttitudeTarget,
    84: SetPositionTargetLocalNed,
    85: PositionTargetLocalNed,
    86: SetPositionTargetGlobalInt,
    105: HighresImu,
    111: Timesync,
    147: BatteryStatus,
    148: AutopilotVersion,
    180: CameraFeedback,
    193: EkfStatusReport,
    230: EstimatorStatus,
    242: HomePosition,
    244: MessageInterval,
    245: ExtendedSysState,
    253: Statustext,
    259: CameraInformation,
    260: CameraSettings,
    261: StorageInformation,
    262: CameraCaptureStatus,
    263: CameraImageCaptured,
    300: ProtocolVersion,
    345: ParamError,
    435: AvailableModes,
    436: CurrentMode,
}

IDS: Final[dict[type[Message], int]] = {kind: number for number, kind in TYPES.items()}

__all__ = [
    "IDS",
    "TYPES",
    "Attitude",
    "AttitudeQuaternion",
    "AutopilotVersion",
    "AvailableModes",
    "BatteryStatus",
    "CameraCaptureStatus",
    "CameraFeedback",
    "CameraImageCaptured",
    "CameraInformation",
    "CameraSettings",
    "CommandAck",
    "CommandInt",
    "CommandLong",
    "CurrentMode",
    "EkfStatusReport",
    "EstimatorStatus",
    "ExtendedSysState",
    "GlobalPositionInt",
    "GpsGlobalOrigin",
    "GpsRawInt",
    "Heartbeat",
    "HighresImu",
    "HomePosition",
    "LocalPositionNed",
    "Message",
    "MessageInterval",
    "MissionAck",
    "MissionClearAll",
    "MissionCount",
    "MissionCurrent",
    "MissionItem",
    "MissionItemInt",
    "MissionItemReached",
    "MissionRequest",
    "MissionRequestInt",
    "MissionRequestList",
    "MissionSetCurrent",
    "ParamError",
    "ParamRequestList",
    "ParamRequestRead",
    "ParamSet",
    "ParamValue",
    "Ping",
    "PositionTargetLocalNed",
    "ProtocolVersion",
    "RequestDataStream",
    "ScaledPressure",
    "ServoOutputRaw",
    "SetAttitudeTarget",
    "SetMode",
    "SetPositionTargetGlobalInt",
    "SetPositionTargetLocalNed",
    "Statustext",
    "StorageInformation",
    "SysStatus",
    "SystemTime",
    "Timesync",
    "VfrHud",
]
