"""How each personality speaks MAVLink, as tables; how it flies is the autopilot's own."""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import nan
from typing import Final

from vehicle_sim.autopilot.firmware import FLIGHT_SW_VERSION, Firmware
from vehicle_sim.autopilot.interface import Result
from vehicle_sim.autopilot.modes import MODES, Personality
from vehicle_sim.numerics.vectors import Quat
from vehicle_sim.services.message_requests import ARDUPILOT_REQUESTS, PX4_REQUESTS, Requests
from vehicle_sim.wire import messages as m
from vehicle_sim.wire.ids import Capability, Cmd, DataStream, MissionResult, MissionType
from vehicle_sim.wire.signing import PX4_UNSIGNED, RADIOS

MESSAGE_INTERVAL_MIN_NS: Final = 5_000_000


def _hz(rates: dict[type[m.Message], float]) -> dict[int, int]:
    return {m.IDS[kind]: round(1e9 / rate) for kind, rate in rates.items()}


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Profile:
    name: Personality
    autopilot: int  # MAV_AUTOPILOT
    flight_sw_version: int
    capabilities: Capability
    intervals_ns: dict[int, int]  # message number -> what is sent unasked
    rate_parameters: dict[str, DataStream]  # which parameters say what more is sent unasked
    fixed: frozenset[int]  # streams whose interval cannot be set
    bytewise_parameters: bool
    hash_check: bool  # a parameter list begins with _HASH_CHECK
    parameter_errors: bool  # PARAM_ERROR for what is not taken
    item_request: type[m.MissionRequest] | type[m.MissionRequestInt]
    first_item_request: type[m.MissionRequest] | type[m.MissionRequestInt]
    float_items: bool  # MISSION_REQUEST is answered with the float MISSION_ITEM
    home_is_item_0: bool
    mission_retry_ns: int
    mission_retries: int
    plan_max: dict[MissionType, int]  # items that there is room for
    partial_lists: bool  # MISSION_WRITE_PARTIAL_LIST
    takeoff_amsl: bool  # NAV_TAKEOFF's height is AMSL, else above home
    acks_set_mode: bool
    reached_repeats: int  # MISSION_ITEM_REACHED, how often each
    camera_feedback: bool
    guided_items: bool  # MISSION_ITEM with current = 2 or 3
    offset_frames: bool  # LOCAL_OFFSET_NED, BODY_OFFSET_NED, position in BODY_NED
    whole_masks: bool  # any ignore bit of a vector ignores all three axes
    first_log: int  # number of the oldest log in a LOG_ENTRY
    log_frame_ns: int  # between two LOG_DATA of 90 bytes
    logs_while_armed: bool  # logs are listed and sent in flight too
    component_metadata: bool  # COMPONENT_METADATA and its files; without it @PARAM/param.pck
    unheard: frozenset[Cmd]  # commands that nobody on board answers
    banner: tuple[str, ...]  # DO_SEND_BANNER, and to who asks for the list of parameters
    unsigned_allowed: frozenset[int]  # messages that are taken unsigned under a key
    camera: bool  # there is one
    absent: dict[Cmd, Result]  # answers to commands for equipment that there is not
    requests: Requests  # what REQUEST_MESSAGE is answered
    untold: frozenset[type[m.Message]]  # messages that it never sends
    vtol_state: int  # MAV_VTOL_STATE
    flies_to_places: frozenset[str]  # modes with a POSITION_TARGET_GLOBAL_INT
    flies_to_places_in_air: frozenset[str]  # modes that have one only after the take-off
    home_attitude: Quat  # HOME_POSITION.q
    targets_while_disarmed: bool  # the controllers run on the ground too, and tell their targets
    unused_channel_us: int  # RC_CHANNELS
    channels_without_radio: bool  # RC_CHANNELS is sent though nothing is heard
    events: bool  # the events interface; a text that is an event too ends with a TAB
    tells_log_path: bool  # a STATUSTEXT when a log begins
    no_such_item: MissionResult  # MISSION_REQUEST beyond the last
    numbers_plans: bool  # `opaque_id` and `mission_id`, not recorded of 4.7 and 1.14
    refuses_other_components: bool  # commands to one that there is not get an answer
    protocol_version_command: bool  # REQUEST_PROTOCOL_VERSION is known
    names_unknown_message: bool  # SET_MESSAGE_INTERVAL is DENIED with a text, else FAILED
    refuses_fast_streams: bool  # SET_MESSAGE_INTERVAL below FASTEST_US: DENIED with a text
    names_wrong_frame: bool  # DO_REPOSITION is DENIED with a text, else UNSUPPORTED
    names_command: bool  # a text for NAV_LAND and NAV_RETURN_TO_LAUNCH, not for the mode
    sub_modes: bool  # DO_SET_MODE has a main and a sub mode
    reposition_needs_change_flag: bool  # MAV_DO_REPOSITION_FLAGS_CHANGE_MODE
    reposition_by_long: bool  # DO_REPOSITION as COMMAND_LONG too
    speed_by_type: bool  # DO_CHANGE_SPEED looks at SPEED_TYPE, and refuses what is no speed
    reboot_nothing: Result  # PREFLIGHT_REBOOT_SHUTDOWN with 0 for the autopilot
    roi_is_location: bool  # DO_SET_ROI is taken for a location whatever its MAV_ROI says
    storage_resets_only: bool  # PREFLIGHT_STORAGE neither reads nor writes
    compass_by_yaw_texts: tuple[tuple[int, str], ...]  # FIXED_MAG_CAL_YAW: severity and text


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

PX4: Final = Profile(
    name="px4",
    autopilot=12,
    flight_sw_version=FLIGHT_SW_VERSION["1.14"],
    capabilities=_COMMON | Capability.PARAM_ENCODE_BYTEWISE | Capability.SET_ACTUATOR_TARGET,
    intervals_ns=_hz(
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
    ),
    rate_parameters={},
    fixed=frozenset({m.IDS[m.MissionCurrent], m.IDS[m.Heartbeat]}),
    bytewise_parameters=True,
    hash_check=True,
    parameter_errors=False,
    item_request=m.MissionRequestInt,
    first_item_request=m.MissionRequest,
    float_items=False,
    home_is_item_0=False,
    mission_retry_ns=250_000_000,
    mission_retries=20,
    plan_max={MissionType.MISSION: 2000, MissionType.FENCE: 64, MissionType.RALLY: 32},
    partial_lists=False,
    takeoff_amsl=True,
    acks_set_mode=False,
    reached_repeats=11,
    camera_feedback=False,
    guided_items=False,
    offset_frames=False,
    whole_masks=False,
    first_log=0,
    log_frame_ns=250_000,
    logs_while_armed=True,
    component_metadata=True,
    unheard=frozenset(
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
    ),
    banner=(),
    unsigned_allowed=PX4_UNSIGNED,
    camera=True,
    absent={},
    requests=PX4_REQUESTS,
    untold=frozenset({m.RcChannelsRaw, m.FenceStatus, m.Wind, m.RelayStatus}),
    vtol_state=0,  # UNDEFINED
    flies_to_places=frozenset(name for name in MODES["px4"] if name.startswith("AUTO.")),
    flies_to_places_in_air=frozenset(),
    home_attitude=(1.0, 0.0, 0.0, 0.0),
    targets_while_disarmed=True,
    unused_channel_us=65535,
    channels_without_radio=False,
    events=True,
    tells_log_path=True,
    no_such_item=MissionResult.ERROR,
    numbers_plans=False,
    refuses_other_components=True,
    protocol_version_command=True,
    names_unknown_message=False,
    refuses_fast_streams=False,
    names_wrong_frame=False,
    names_command=True,
    sub_modes=True,
    reposition_needs_change_flag=True,
    reposition_by_long=True,
    speed_by_type=False,
    reboot_nothing=Result.ACCEPTED,
    roi_is_location=False,
    storage_resets_only=False,
    compass_by_yaw_texts=(
        (2, "Assuming vehicle is facing heading 0.0 degrees"),
        (6, "Mag quick calibration finished"),
    ),
)

ARDUPILOT: Final = Profile(
    name="ardupilot",
    autopilot=3,
    flight_sw_version=FLIGHT_SW_VERSION["4.5"],
    capabilities=_COMMON
    | Capability.SET_POSITION_TARGET_GLOBAL_INT
    | Capability.TERRAIN
    | Capability.COMPASS_CALIBRATION,
    intervals_ns=_hz({m.Heartbeat: 1}),
    rate_parameters={
        "SR0_RAW_SENS": DataStream.RAW_SENSORS,
        "SR0_EXT_STAT": DataStream.EXTENDED_STATUS,
        "SR0_RC_CHAN": DataStream.RC_CHANNELS,
        "SR0_POSITION": DataStream.POSITION,
        "SR0_EXTRA1": DataStream.EXTRA1,
        "SR0_EXTRA2": DataStream.EXTRA2,
        "SR0_EXTRA3": DataStream.EXTRA3,
    },
    fixed=frozenset(),
    bytewise_parameters=False,
    hash_check=False,
    parameter_errors=False,
    item_request=m.MissionRequest,
    first_item_request=m.MissionRequest,
    float_items=True,
    home_is_item_0=True,
    mission_retry_ns=1_000_000_000,
    mission_retries=20,
    plan_max={MissionType.MISSION: 724, MissionType.FENCE: 100, MissionType.RALLY: 100},
    partial_lists=True,
    takeoff_amsl=False,
    acks_set_mode=True,
    reached_repeats=1,
    camera_feedback=True,
    guided_items=True,
    offset_frames=True,
    whole_masks=True,
    first_log=1,
    log_frame_ns=612_000,
    logs_while_armed=False,
    component_metadata=False,
    unheard=frozenset(),
    banner=("ArduCopter V4.6.0", "vehicle-sim", "Frame: QUAD/X"),
    unsigned_allowed=RADIOS,
    camera=True,
    absent={},
    requests=ARDUPILOT_REQUESTS,
    untold=frozenset({m.ManualControl, m.ActuatorOutputStatus, m.EscStatus, m.EscInfo, m.Ping}),
    vtol_state=3,  # MC: a copter is a VTOL that flies as a multicopter
    flies_to_places=frozenset({"AUTO", "RTL"}),
    flies_to_places_in_air=frozenset({"GUIDED"}),
    home_attitude=(nan, nan, nan, nan),
    targets_while_disarmed=False,
    unused_channel_us=0,
    channels_without_radio=True,
    events=False,
    tells_log_path=False,
    no_such_item=MissionResult.INVALID_SEQUENCE,
    numbers_plans=False,
    refuses_other_components=False,
    protocol_version_command=False,
    names_unknown_message=True,
    refuses_fast_streams=False,
    names_wrong_frame=True,
    names_command=False,
    sub_modes=False,
    reposition_needs_change_flag=False,
    reposition_by_long=False,
    speed_by_type=True,
    reboot_nothing=Result.UNSUPPORTED,
    roi_is_location=True,
    storage_resets_only=True,
    compass_by_yaw_texts=(),
)

PROFILES: Final[dict[Personality, Profile]] = {"px4": PX4, "ardupilot": ARDUPILOT}
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
_NO_CAMERA_UNHEARD: Final[dict[Personality, frozenset[Cmd]]] = {
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
        unheard=profile.unheard | _NO_CAMERA_UNHEARD[profile.name],
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
