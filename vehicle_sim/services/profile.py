"""How each personality speaks MAVLink, as tables; how it flies is the autopilot's own."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

from vehicle_sim.autopilot.modes import Personality
from vehicle_sim.wire import messages as m
from vehicle_sim.wire.ids import Capability, MissionType, Stream

MESSAGE_INTERVAL_MIN_NS: Final = 5_000_000


def _hz(rates: dict[type[m.Message], float]) -> dict[int, int]:
    return {m.IDS[kind]: round(1e9 / rate) for kind, rate in rates.items()}


@dataclass(frozen=True, slots=True)
class Profile:
    name: Personality
    autopilot: int  # MAV_AUTOPILOT
    vendor: str
    flight_sw_version: int
    capabilities: Capability
    intervals_ns: dict[int, int]  # message number -> what is sent unasked
    fixed: frozenset[int]  # streams whose interval cannot be set
    bytewise_parameters: bool
    hash_check: bool  # a parameter list begins with _HASH_CHECK
    unknown_parameter_error: bool  # PARAM_ERROR instead of silence
    item_request: type[m.MissionRequest] | type[m.MissionRequestInt]
    first_item_request: type[m.MissionRequest] | type[m.MissionRequestInt]
    float_items: bool  # MISSION_REQUEST is answered with the float MISSION_ITEM
    home_is_item_0: bool
    mission_retry_ns: int
    mission_retries: int
    takeoff_amsl: bool  # NAV_TAKEOFF's height is AMSL, else above home
    acks_set_mode: bool
    reached_repeats: int  # MISSION_ITEM_REACHED, how often each
    camera_feedback: bool
    guided_items: bool  # MISSION_ITEM with current = 2 or 3
    offset_frames: bool  # LOCAL_OFFSET_NED, BODY_OFFSET_NED, position in BODY_NED
    whole_masks: bool  # any ignore bit of a vector ignores all three axes


_COMMON: Final = (
    Capability.MISSION_FLOAT
    | Capability.MISSION_INT
    | Capability.COMMAND_INT
    | Capability.SET_ATTITUDE_TARGET
    | Capability.SET_POSITION_TARGET_LOCAL_NED
    | Capability.SET_POSITION_TARGET_GLOBAL_INT
    | Capability.FLIGHT_TERMINATION
    | Capability.MAVLINK2
    | Capability.MISSION_FENCE
    | Capability.MISSION_RALLY
)

PX4: Final = Profile(
    name="px4",
    autopilot=12,
    vendor="PX4",
    flight_sw_version=0x010E00FF,  # 1.14.0, a release
    capabilities=_COMMON | Capability.PARAM_ENCODE_BYTEWISE,
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
            m.HighresImu: 10,
            m.ServoOutputRaw: 10,
            m.VfrHud: 5,
            m.GpsRawInt: 5,
            m.BatteryStatus: 1,
            m.EstimatorStatus: 1,
            m.ScaledPressure: 1,
            m.SystemTime: 1,
            m.MissionCurrent: 1,
            m.HomePosition: 0.5,
            m.CurrentMode: 0.5,
        }
    ),
    fixed=frozenset({m.IDS[m.MissionCurrent]}),
    bytewise_parameters=True,
    hash_check=True,
    unknown_parameter_error=False,
    item_request=m.MissionRequestInt,
    first_item_request=m.MissionRequest,
    float_items=False,
    home_is_item_0=False,
    mission_retry_ns=250_000_000,
    mission_retries=20,
    takeoff_amsl=True,
    acks_set_mode=False,
    reached_repeats=11,
    camera_feedback=False,
    guided_items=False,
    offset_frames=False,
    whole_masks=False,
)

ARDUPILOT: Final = Profile(
    name="ardupilot",
    autopilot=3,
    vendor="ArduPilot",
    flight_sw_version=0x040700FF,  # 4.7.0, a release
    capabilities=_COMMON | Capability.PARAM_ENCODE_C_CAST,
    intervals_ns=_hz({m.Heartbeat: 1, m.HomePosition: 0.5}),
    fixed=frozenset(),
    bytewise_parameters=False,
    hash_check=False,
    unknown_parameter_error=True,
    item_request=m.MissionRequest,
    first_item_request=m.MissionRequest,
    float_items=True,
    home_is_item_0=True,
    mission_retry_ns=1_000_000_000,
    mission_retries=8,
    takeoff_amsl=False,
    acks_set_mode=True,
    reached_repeats=1,
    camera_feedback=True,
    guided_items=True,
    offset_frames=True,
    whole_masks=True,
)

PROFILES: Final[dict[Personality, Profile]] = {"px4": PX4, "ardupilot": ARDUPILOT}

STANDARD_MODES: Final[dict[str, int]] = {
    "POSCTL": 1,
    "LOITER": 1,
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

DATA_STREAMS: Final[dict[Stream, tuple[type[m.Message], ...]]] = {
    Stream.RAW_SENSORS: (m.HighresImu, m.ScaledPressure),
    Stream.EXTENDED_STATUS: (m.SysStatus, m.GpsRawInt, m.MissionCurrent, m.ExtendedSysState),
    Stream.RC_CHANNELS: (m.ServoOutputRaw,),
    Stream.RAW_CONTROLLER: (),
    Stream.POSITION: (m.GlobalPositionInt, m.LocalPositionNed, m.PositionTargetLocalNed),
    Stream.EXTRA1: (m.Attitude, m.AttitudeQuaternion),
    Stream.EXTRA2: (m.VfrHud,),
    Stream.EXTRA3: (m.SystemTime, m.BatteryStatus, m.EkfStatusReport),
}
"""What REQUEST_DATA_STREAM asks for; ALL is all of them."""

PLAN_TYPES: Final = (MissionType.MISSION, MissionType.FENCE, MissionType.RALLY)
