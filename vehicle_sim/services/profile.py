"""How each personality speaks MAVLink, as tables; how it flies is the autopilot's own."""
# ruff: noqa: RUF009  # `each` builds nothing that a later instance could change

from __future__ import annotations

from dataclasses import dataclass, replace
from math import nan
from typing import Final, TypeAlias

from vehicle_sim.autopilot.firmware import FLIGHT_SW_VERSION, Firmware
from vehicle_sim.autopilot.interface import Result
from vehicle_sim.autopilot.modes import MODES, Personality
from vehicle_sim.autopilot.personality_table import COPTER_ONLY, PX4_ONLY, each, tables
from vehicle_sim.numerics.vectors import Quat
from vehicle_sim.services.message_requests import ARDUPILOT_REQUESTS, PX4_REQUESTS, Requests
from vehicle_sim.wire import messages as m
from vehicle_sim.wire.ids import Capability, Cmd, DataStream, MissionResult, MissionType
from vehicle_sim.wire.signing import PX4_UNSIGNED, RADIOS

MESSAGE_INTERVAL_MIN_NS: Final = 5_000_000


def _hz(rates: dict[type[m.Message], float]) -> dict[int, int]:
    return {m.IDS[kind]: round(1e9 / rate) for kind, rate in rates.items()}


_COMMON: Final = (
    Capability.MISSION_FLOAT
    | Capability.PARAM_FLOAT
    | Capability.MISSION_INT
    | Capability.COMMAND_INT
    | Capability.FTP
    | Capability.SET_ATTITUDE_TARGET
    | Capability.SET_POSITION_TARGET_LOCAL_NED
    | Capability.FLIGHT_TERMINATION
    | Capability.MAVLINK2
    | Capability.MISSION_FENCE
    | Capability.MISSION_RALLY
)
_PX4_CAN: Final = Capability.PARAM_ENCODE_BYTEWISE | Capability.SET_ACTUATOR_TARGET
_COPTER_CAN: Final = (
    Capability.SET_POSITION_TARGET_GLOBAL_INT | Capability.TERRAIN | Capability.COMPASS_CALIBRATION
)
_PX4_SENDS: Final = _hz(
    {
        m.Heartbeat: 1,
        m.SysStatus: 2,
        m.ExtendedSysState: 5,
        m.LocalPositionNed: 50,
        m.Attitude: 50,
        m.AttitudeQuaternion: 20,
        m.GlobalPositionInt: 20,
        m.PositionTargetLocalNed: 10,
        m.PositionTargetGlobalInt: 10,
        m.AttitudeTarget: 50,
        m.OrbitExecutionStatus: 5,
        m.RcChannels: 5,
        m.ManualControl: 5,
        m.HighresImu: 10,
        m.ServoOutputRaw: 50,
        m.Altitude: 10,
        m.WindCov: 0.5,
        m.Vibration: 0.5,
        m.VfrHud: 5,
        m.GpsRawInt: 5,
        m.BatteryStatus: 1,
        m.EstimatorStatus: 1,
        m.ScaledPressure: 1,
        m.SystemTime: 1,
        m.MissionCurrent: 1,
        m.HomePosition: 0.5,
        m.CurrentMode: 0.5,
        m.CurrentEventSequence: 1 / 3,
    }
)
_PX4_FIXED: Final = frozenset({m.IDS[m.MissionCurrent], m.IDS[m.Heartbeat]})
_RATES: Final = {
    "SR0_RAW_SENS": DataStream.RAW_SENSORS,
    "SR0_EXT_STAT": DataStream.EXTENDED_STATUS,
    "SR0_RC_CHAN": DataStream.RC_CHANNELS,
    "SR0_POSITION": DataStream.POSITION,
    "SR0_EXTRA1": DataStream.EXTRA1,
    "SR0_EXTRA2": DataStream.EXTRA2,
    "SR0_EXTRA3": DataStream.EXTRA3,
}
_PX4_IGNORED: Final = frozenset(
    {
        Cmd.NAV_DELAY,
        Cmd.DO_DIGICAM_CONTROL,
        Cmd.DO_MOUNT_CONTROL,
        Cmd.DO_SET_CAM_TRIGG_DIST,
        Cmd.DO_GRIPPER,
        Cmd.DO_WINCH,  # by memory
        Cmd.DO_MOUNT_CONTROL_QUAT,
        Cmd.PREFLIGHT_SET_SENSOR_OFFSETS,
        Cmd.PREFLIGHT_UAVCAN,
        Cmd.DO_GIMBAL_MANAGER_PITCHYAW,
        Cmd.LOGGING_STOP,
        Cmd.DO_VTOL_TRANSITION,
    }
)
_BANNER: Final = ("ArduCopter V4.6.0", "vehicle-sim", "Frame: QUAD/X")
_PX4_UNSENT: Final[frozenset[type[m.Message]]] = frozenset(
    {m.RcChannelsRaw, m.FenceStatus, m.Wind, m.RelayStatus}
)
_COPTER_UNSENT: Final[frozenset[type[m.Message]]] = frozenset(
    {m.ManualControl, m.ActuatorOutputStatus, m.EscStatus, m.EscInfo, m.Ping}
)
_PX4_GOES: Final = frozenset(name for name in MODES["px4"] if name.startswith("AUTO."))
_COPTER_GOES: Final = frozenset({"AUTO", "RTL"})
_COMPASS_BY_YAW: Final = (
    (2, "Assuming vehicle is facing heading 0.0 degrees"),
    (6, "Mag quick calibration finished"),
)
Request: TypeAlias = type[m.MissionRequest] | type[m.MissionRequestInt]


def _room(mission: int, fence: int, rally: int) -> dict[MissionType, int]:
    return {MissionType.MISSION: mission, MissionType.FENCE: fence, MissionType.RALLY: rally}


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Profile:
    name: Personality = each("px4", "ardupilot")
    autopilot: int = each(12, 3)  # MAV_AUTOPILOT
    flight_sw_version: int = each(FLIGHT_SW_VERSION["1.14"], FLIGHT_SW_VERSION["4.5"])
    capabilities: Capability = each(_COMMON | _PX4_CAN, _COMMON | _COPTER_CAN)
    intervals_ns: dict[int, int] = each(_PX4_SENDS, _hz({m.Heartbeat: 1}))  # those sent unasked
    rate_parameters: dict[str, DataStream] = each({}, _RATES)  # what more is sent unasked
    fixed: frozenset[int] = each(_PX4_FIXED, frozenset())  # streams whose interval cannot be set
    bytewise_parameters: bool = PX4_ONLY
    hash_check: bool = PX4_ONLY  # a parameter list begins with _HASH_CHECK
    parameter_errors: bool = False  # PARAM_ERROR for what is not taken
    item_request: Request = each(m.MissionRequestInt, m.MissionRequest)
    first_item_request: Request = m.MissionRequest
    float_items: bool = COPTER_ONLY  # MISSION_REQUEST is answered with the float MISSION_ITEM
    home_is_item_0: bool = COPTER_ONLY
    mission_retry_ns: int = each(250_000_000, 1_000_000_000)
    mission_retries: int = 20
    plan_max: dict[MissionType, int] = each(_room(2000, 64, 32), _room(724, 100, 100))  # items
    partial_lists: bool = COPTER_ONLY  # MISSION_WRITE_PARTIAL_LIST
    takeoff_amsl: bool = PX4_ONLY  # NAV_TAKEOFF's height is AMSL, else above home
    acks_set_mode: bool = COPTER_ONLY
    reached_repeats: int = each(11, 1)  # MISSION_ITEM_REACHED, how often each
    camera_feedback: bool = COPTER_ONLY
    guided_items: bool = COPTER_ONLY  # MISSION_ITEM with current = 2 or 3
    offset_frames: bool = COPTER_ONLY  # LOCAL_OFFSET_NED, BODY_OFFSET_NED, position in BODY_NED
    whole_masks: bool = COPTER_ONLY  # any ignore bit of a vector ignores all three axes
    first_log: int = each(0, 1)  # number of the oldest log in a LOG_ENTRY
    log_frame_ns: int = each(250_000, 612_000)  # between two LOG_DATA of 90 bytes
    logs_while_armed: bool = PX4_ONLY  # logs are listed and sent in flight too
    component_metadata: bool = PX4_ONLY  # and its files; without it @PARAM/param.pck
    ignored_commands: frozenset[Cmd] = each(_PX4_IGNORED, frozenset())  # without an answer
    banner: tuple[str, ...] = each((), _BANNER)  # DO_SEND_BANNER, and before all parameters
    unsigned_allowed: frozenset[int] = each(PX4_UNSIGNED, RADIOS)  # messages, under a key
    camera: bool = True  # there is one
    absent: dict[Cmd, Result] = each({}, {})  # answers to commands for equipment that is not there
    requests: Requests = each(PX4_REQUESTS, ARDUPILOT_REQUESTS)  # what REQUEST_MESSAGE is answered
    unsent_messages: frozenset[type[m.Message]] = each(_PX4_UNSENT, _COPTER_UNSENT)
    vtol_state: int = each(0, 3)  # MAV_VTOL_STATE: UNDEFINED; a multicopter
    flies_to_places: frozenset[str] = each(_PX4_GOES, _COPTER_GOES)  # POSITION_TARGET_GLOBAL_INT
    flies_to_places_in_air: frozenset[str] = each(frozenset(), frozenset({"GUIDED"}))
    home_attitude: Quat = each((1.0, 0.0, 0.0, 0.0), (nan, nan, nan, nan))  # HOME_POSITION.q
    targets_while_disarmed: bool = PX4_ONLY  # the controllers run on the ground too
    unused_channel_us: int = each(65535, 0)  # RC_CHANNELS
    channels_without_radio: bool = COPTER_ONLY  # RC_CHANNELS is sent though nothing is heard
    events: bool = PX4_ONLY  # the events interface; a text that is an event too ends with a TAB
    tells_log_path: bool = PX4_ONLY  # a STATUSTEXT when a log begins
    no_such_item: MissionResult = each(MissionResult.ERROR, MissionResult.INVALID_SEQUENCE)
    numbers_plans: bool = False  # `opaque_id` and `mission_id`, not recorded of 4.7 and 1.14
    tells_mission_whole: bool = True  # else its item alone, and only with a mission: 1.14.3
    refuses_other_components: bool = PX4_ONLY  # commands to one that there is not get an answer
    protocol_version_command: bool = PX4_ONLY  # REQUEST_PROTOCOL_VERSION is known
    names_unknown_message: bool = COPTER_ONLY  # SET_MESSAGE_INTERVAL: DENIED, else FAILED
    refuses_fast_streams: bool = False  # SET_MESSAGE_INTERVAL below FASTEST_US: DENIED with a text
    names_wrong_frame: bool = COPTER_ONLY  # DO_REPOSITION is DENIED with a text, else UNSUPPORTED
    names_command: bool = PX4_ONLY  # a text for NAV_LAND and NAV_RETURN_TO_LAUNCH, not for the mode
    sub_modes: bool = PX4_ONLY  # DO_SET_MODE has a main and a sub mode
    reposition_needs_change_flag: bool = PX4_ONLY  # MAV_DO_REPOSITION_FLAGS_CHANGE_MODE
    reposition_by_long: bool = PX4_ONLY  # DO_REPOSITION as COMMAND_LONG too
    speed_by_type: bool = COPTER_ONLY  # DO_CHANGE_SPEED refuses what is no SPEED_TYPE or speed
    reboot_nothing: Result = each(Result.ACCEPTED, Result.UNSUPPORTED)  # with 0 for the autopilot
    roi_is_location: bool = COPTER_ONLY  # DO_SET_ROI is, whatever its MAV_ROI says
    storage_resets_only: bool = COPTER_ONLY  # PREFLIGHT_STORAGE neither reads nor writes
    compass_by_yaw_texts: tuple[tuple[int, str], ...] = each(_COMPASS_BY_YAW, ())


PROFILES: Final[dict[Personality, Profile]] = tables(Profile)
"""Of the firmware that is played unless another is asked for."""


_RELEASE: Final[dict[Firmware, str]] = {
    "4.5": "ArduCopter V4.5.7",
    "4.7": "ArduCopter V4.7.0-dev (4165a6fb)",
}
"""The banner's first line; 4.7-dev's as recorded."""


def profile_of(personality: Personality, firmware: Firmware) -> Profile:
    """ArduPilot has PARAM_ERROR since 4.7 (MAVLink has it since September 2025), and refuses
    streams that are too fast; 4.5 slows them down (the latter by memory)."""
    profile = PROFILES[personality]
    return replace(
        profile,
        banner=(_RELEASE[firmware], *profile.banner[1:]) if profile.banner else (),
        flight_sw_version=FLIGHT_SW_VERSION[firmware],
        numbers_plans=firmware == "1.15",  # from memory
        tells_mission_whole=firmware != "1.14",
        parameter_errors=firmware == "4.7",
        refuses_fast_streams=firmware == "4.7",
    )


_OF_CAMERA: Final = frozenset(
    m.IDS[kind] for kind in (m.CameraInformation, m.CameraSettings, m.CameraCaptureStatus)
)
CAMERA_MESSAGES: Final[dict[Personality, frozenset[int]]] = {
    "px4": _OF_CAMERA,
    "ardupilot": _OF_CAMERA | {m.IDS[m.StorageInformation]},
}
"""What only a vehicle with a camera tells; PX4 has a storage of its own."""

_NO_CAMERA: Final[dict[Personality, dict[Cmd, Result]]] = {
    "px4": {
        Cmd.IMAGE_START_CAPTURE: Result.UNSUPPORTED,
        Cmd.IMAGE_STOP_CAPTURE: Result.UNSUPPORTED,
        Cmd.REQUEST_CAMERA_INFORMATION: Result.UNSUPPORTED,
        Cmd.REQUEST_CAMERA_CAPTURE_STATUS: Result.UNSUPPORTED,  # from memory
    },
    "ardupilot": {
        Cmd.IMAGE_START_CAPTURE: Result.FAILED,
        Cmd.IMAGE_STOP_CAPTURE: Result.ACCEPTED,
        Cmd.SET_CAMERA_MODE: Result.UNSUPPORTED,
        Cmd.REQUEST_CAMERA_INFORMATION: Result.UNSUPPORTED,
        Cmd.REQUEST_CAMERA_CAPTURE_STATUS: Result.UNSUPPORTED,  # from memory
        Cmd.REQUEST_STORAGE_INFORMATION: Result.UNSUPPORTED,  # from memory
    },
}
"""As the recorded autopilots, which had no camera, answered."""
_NO_CAMERA_IGNORED: Final[dict[Personality, frozenset[Cmd]]] = {
    "px4": frozenset({Cmd.SET_CAMERA_MODE}),
    "ardupilot": frozenset(),
}
_NO_CAMERA_ACCEPTED: Final[dict[Personality, frozenset[int]]] = {
    "px4": frozenset(),
    "ardupilot": _OF_CAMERA,
}


def without_camera(profile: Profile) -> Profile:
    """The same autopilot with no camera on board; PX4 does not even answer SET_CAMERA_MODE."""
    requests = profile.requests
    image = m.IDS[m.CameraImageCaptured]
    return replace(
        profile,
        camera=False,
        absent=_NO_CAMERA[profile.name],
        ignored_commands=profile.ignored_commands | _NO_CAMERA_IGNORED[profile.name],
        requests=replace(
            requests,
            never=requests.never | {image} | CAMERA_MESSAGES[profile.name],
            accepted=requests.accepted | _NO_CAMERA_ACCEPTED[profile.name],
        ),
    )


STANDARD_MODES: Final[dict[str, int]] = {
    "POSCTL": 1,
    "LOITER": 1,
    "POSCTL.ORBIT": 2,
    "ALTCTL": 4,
    "ALT_HOLD": 4,
    "AUTO.RTL": 5,
    "RTL": 5,
    "AUTO.MISSION": 6,
    "AUTO": 6,
    "AUTO.LAND": 7,
    "LAND": 7,
    "AUTO.TAKEOFF": 8,
}
"""MAV_STANDARD_MODE of the modes that have one."""

DATA_STREAMS: Final[dict[DataStream, tuple[type[m.Message], ...]]] = {
    DataStream.RAW_SENSORS: (m.RawImu, m.ScaledPressure),
    DataStream.EXTENDED_STATUS: (
        m.SysStatus,
        m.PowerStatus,
        m.Meminfo,
        m.NavControllerOutput,
        m.MissionCurrent,
        m.GpsRawInt,
        m.FenceStatus,
        m.PositionTargetGlobalInt,
        m.ExtendedSysState,
    ),
    DataStream.RC_CHANNELS: (m.ServoOutputRaw, m.RcChannels, m.RcChannelsRaw),
    DataStream.RAW_CONTROLLER: (),
    DataStream.POSITION: (m.GlobalPositionInt, m.LocalPositionNed, m.PositionTargetLocalNed),
    DataStream.EXTRA1: (m.Attitude, m.AttitudeQuaternion),
    DataStream.EXTRA2: (m.VfrHud,),
    DataStream.EXTRA3: (
        m.SystemTime,
        m.Hwstatus,
        m.Wind,
        m.BatteryStatus,
        m.EkfStatusReport,
        m.Vibration,
    ),
}
"""What REQUEST_DATA_STREAM asks for; ALL is all of them.

ArduCopter's own groups, without what the vehicle has no sensor for, and with what else MAVSDK's
health and this project's ground station look at.
"""

PLAN_TYPES: Final = (MissionType.MISSION, MissionType.FENCE, MissionType.RALLY)
