"""The messages that this vehicle speaks and understands, each with its number.

What is not in `TYPES` is checked for its CRC, counted and otherwise ignored.
"""

from __future__ import annotations

from typing import Final, TypeAlias

from vehicle_sim.wire.messages.camera import (
    CameraCaptureStatus,
    CameraFeedback,
    CameraImageCaptured,
    CameraInformation,
    CameraSettings,
    StorageInformation,
)
from vehicle_sim.wire.messages.fence import FenceStatus
from vehicle_sim.wire.messages.files import ComponentMetadata, FileTransferProtocol
from vehicle_sim.wire.messages.logs import (
    LogData,
    LogEntry,
    LogErase,
    LogRequestData,
    LogRequestEnd,
    LogRequestList,
)
from vehicle_sim.wire.messages.manual import (
    ManualControl,
    RcChannels,
    RcChannelsOverride,
    RcChannelsRaw,
)
from vehicle_sim.wire.messages.motion import (
    Attitude,
    AttitudeQuaternion,
    AttitudeTarget,
    FollowTarget,
    GlobalPositionInt,
    GpsGlobalOrigin,
    HomePosition,
    LocalPositionNed,
    OrbitExecutionStatus,
    PositionTargetGlobalInt,
    PositionTargetLocalNed,
    SetAttitudeTarget,
    SetPositionTargetGlobalInt,
    SetPositionTargetLocalNed,
    VfrHud,
)
from vehicle_sim.wire.messages.security import ControlStatus, SetupSigning
from vehicle_sim.wire.messages.sensors import (
    BatteryStatus,
    EkfStatusReport,
    EstimatorStatus,
    GpsRawInt,
    HighresImu,
    RawImu,
    ScaledImu,
    ScaledPressure,
    ServoOutputRaw,
)
from vehicle_sim.wire.messages.status import (
    Altitude,
    AvailableModesMonitor,
    Hwstatus,
    Meminfo,
    NavControllerOutput,
    PowerStatus,
    Vibration,
    Wind,
    WindCov,
)
from vehicle_sim.wire.messages.system import (
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
from vehicle_sim.wire.messages.tasks import (
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
    MissionWritePartialList,
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
    | ScaledImu
    | RawImu
    | ScaledPressure
    | Attitude
    | AttitudeQuaternion
    | LocalPositionNed
    | GlobalPositionInt
    | ServoOutputRaw
    | MissionWritePartialList
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
    | RcChannels
    | RequestDataStream
    | ManualControl
    | RcChannelsOverride
    | RcChannelsRaw
    | MissionItemInt
    | VfrHud
    | CommandInt
    | CommandLong
    | CommandAck
    | SetAttitudeTarget
    | AttitudeTarget
    | SetPositionTargetLocalNed
    | PositionTargetLocalNed
    | SetPositionTargetGlobalInt
    | PositionTargetGlobalInt
    | HighresImu
    | FileTransferProtocol
    | Timesync
    | LogRequestList
    | LogEntry
    | LogRequestData
    | LogData
    | LogErase
    | LogRequestEnd
    | FollowTarget
    | BatteryStatus
    | AutopilotVersion
    | FenceStatus
    | CameraFeedback
    | EkfStatusReport
    | EstimatorStatus
    | HomePosition
    | MessageInterval
    | ExtendedSysState
    | Statustext
    | SetupSigning
    | ControlStatus
    | CameraInformation
    | CameraSettings
    | StorageInformation
    | CameraCaptureStatus
    | CameraImageCaptured
    | ProtocolVersion
    | ParamError
    | OrbitExecutionStatus
    | ComponentMetadata
    | AvailableModes
    | CurrentMode
    | NavControllerOutput
    | PowerStatus
    | Altitude
    | Meminfo
    | Hwstatus
    | Wind
    | WindCov
    | Vibration
    | AvailableModesMonitor
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
    26: ScaledImu,
    27: RawImu,
    29: ScaledPressure,
    30: Attitude,
    31: AttitudeQuaternion,
    32: LocalPositionNed,
    33: GlobalPositionInt,
    35: RcChannelsRaw,
    36: ServoOutputRaw,
    38: MissionWritePartialList,
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
    62: NavControllerOutput,
    65: RcChannels,
    66: RequestDataStream,
    69: ManualControl,
    70: RcChannelsOverride,
    73: MissionItemInt,
    74: VfrHud,
    75: CommandInt,
    76: CommandLong,
    77: CommandAck,
    82: SetAttitudeTarget,
    83: AttitudeTarget,
    84: SetPositionTargetLocalNed,
    85: PositionTargetLocalNed,
    86: SetPositionTargetGlobalInt,
    87: PositionTargetGlobalInt,
    105: HighresImu,
    110: FileTransferProtocol,
    111: Timesync,
    117: LogRequestList,
    118: LogEntry,
    119: LogRequestData,
    120: LogData,
    121: LogErase,
    122: LogRequestEnd,
    125: PowerStatus,
    141: Altitude,
    144: FollowTarget,
    147: BatteryStatus,
    148: AutopilotVersion,
    152: Meminfo,
    162: FenceStatus,
    165: Hwstatus,
    168: Wind,
    180: CameraFeedback,
    193: EkfStatusReport,
    230: EstimatorStatus,
    231: WindCov,
    241: Vibration,
    242: HomePosition,
    244: MessageInterval,
    245: ExtendedSysState,
    253: Statustext,
    256: SetupSigning,
    512: ControlStatus,
    259: CameraInformation,
    260: CameraSettings,
    261: StorageInformation,
    262: CameraCaptureStatus,
    263: CameraImageCaptured,
    300: ProtocolVersion,
    345: ParamError,
    360: OrbitExecutionStatus,
    397: ComponentMetadata,
    435: AvailableModes,
    436: CurrentMode,
    437: AvailableModesMonitor,
}

IDS: Final[dict[type[Message], int]] = {kind: number for number, kind in TYPES.items()}

__all__ = [
    "IDS",
    "TYPES",
    "Altitude",
    "Attitude",
    "AttitudeQuaternion",
    "AttitudeTarget",
    "AutopilotVersion",
    "AvailableModes",
    "AvailableModesMonitor",
    "BatteryStatus",
    "CameraCaptureStatus",
    "CameraFeedback",
    "CameraImageCaptured",
    "CameraInformation",
    "CameraSettings",
    "CommandAck",
    "CommandInt",
    "CommandLong",
    "ComponentMetadata",
    "ControlStatus",
    "CurrentMode",
    "EkfStatusReport",
    "EstimatorStatus",
    "ExtendedSysState",
    "FenceStatus",
    "FileTransferProtocol",
    "FollowTarget",
    "GlobalPositionInt",
    "GpsGlobalOrigin",
    "GpsRawInt",
    "Heartbeat",
    "HighresImu",
    "HomePosition",
    "Hwstatus",
    "LocalPositionNed",
    "LogData",
    "LogEntry",
    "LogErase",
    "LogRequestData",
    "LogRequestEnd",
    "LogRequestList",
    "ManualControl",
    "Meminfo",
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
    "MissionWritePartialList",
    "NavControllerOutput",
    "OrbitExecutionStatus",
    "ParamError",
    "ParamRequestList",
    "ParamRequestRead",
    "ParamSet",
    "ParamValue",
    "Ping",
    "PositionTargetGlobalInt",
    "PositionTargetLocalNed",
    "PowerStatus",
    "ProtocolVersion",
    "RawImu",
    "RcChannels",
    "RcChannelsOverride",
    "RcChannelsRaw",
    "RequestDataStream",
    "ScaledImu",
    "ScaledPressure",
    "ServoOutputRaw",
    "SetAttitudeTarget",
    "SetMode",
    "SetPositionTargetGlobalInt",
    "SetPositionTargetLocalNed",
    "SetupSigning",
    "Statustext",
    "StorageInformation",
    "SysStatus",
    "SystemTime",
    "Timesync",
    "VfrHud",
    "Vibration",
    "Wind",
    "WindCov",
]
