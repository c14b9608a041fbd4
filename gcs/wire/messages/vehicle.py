"""What a vehicle reports of itself: power, position, attitude, estimator, camera."""

from __future__ import annotations

from typing import ClassVar

from gcs.wire.ids import MsgId
from gcs.wire.messages.base import Message


class SysStatus(Message, frozen=True, gc=False):
    """Sensors present, enabled and healthy; load; battery."""

    MSG_ID: ClassVar[MsgId] = MsgId.SYS_STATUS
    onboard_control_sensors_present: int  # MAV_SYS_STATUS_SENSOR
    onboard_control_sensors_enabled: int  # MAV_SYS_STATUS_SENSOR
    onboard_control_sensors_health: int  # MAV_SYS_STATUS_SENSOR
    load: int  # d%
    voltage_battery: int  # mV
    current_battery: int  # cA
    drop_rate_comm: int  # c%
    errors_comm: int
    errors_count1: int
    errors_count2: int
    errors_count3: int
    errors_count4: int
    battery_remaining: int  # %
    onboard_control_sensors_present_extended: int = 0  # MAV_SYS_STATUS_SENSOR_EXTENDED
    onboard_control_sensors_enabled_extended: int = 0  # MAV_SYS_STATUS_SENSOR_EXTENDED
    onboard_control_sensors_health_extended: int = 0  # MAV_SYS_STATUS_SENSOR_EXTENDED


class BatteryStatus(Message, frozen=True, gc=False):
    """One battery, cell by cell."""

    MSG_ID: ClassVar[MsgId] = MsgId.BATTERY_STATUS
    current_consumed: int  # mAh
    energy_consumed: int  # hJ
    temperature: int  # cdegC
    voltages: tuple[int, ...]  # 10 × mV
    current_battery: int  # cA
    id: int
    battery_function: int  # MAV_BATTERY_FUNCTION
    type: int  # MAV_BATTERY_TYPE
    battery_remaining: int  # %
    time_remaining: int = 0  # s
    charge_state: int = 0  # MAV_BATTERY_CHARGE_STATE
    voltages_ext: tuple[int, ...] = (0,) * 4  # 4 × mV
    mode: int = 0  # MAV_BATTERY_MODE
    fault_bitmask: int = 0  # MAV_BATTERY_FAULT


class ExtendedSysState(Message, frozen=True, gc=False):
    """Landed or flying."""

    MSG_ID: ClassVar[MsgId] = MsgId.EXTENDED_SYS_STATE
    vtol_state: int  # MAV_VTOL_STATE
    landed_state: int  # MAV_LANDED_STATE


class GpsRawInt(Message, frozen=True, gc=False):
    """What the receiver says, not the estimator."""

    MSG_ID: ClassVar[MsgId] = MsgId.GPS_RAW_INT
    time_usec: int  # us
    lat: int  # degE7
    lon: int  # degE7
    alt: int  # mm
    eph: int
    epv: int
    vel: int  # cm/s
    cog: int  # cdeg
    fix_type: int  # GPS_FIX_TYPE
    satellites_visible: int
    alt_ellipsoid: int = 0  # mm
    h_acc: int = 0  # mm
    v_acc: int = 0  # mm
    vel_acc: int = 0  # mm/s
    hdg_acc: int = 0  # degE5
    yaw: int = 0  # cdeg


class Attitude(Message, frozen=True, gc=False):
    """Euler angles of the body in NED."""

    MSG_ID: ClassVar[MsgId] = MsgId.ATTITUDE
    time_boot_ms: int  # ms
    roll: float  # rad
    pitch: float  # rad
    yaw: float  # rad
    rollspeed: float  # rad/s
    pitchspeed: float  # rad/s
    yawspeed: float  # rad/s


class AttitudeQuaternion(Message, frozen=True, gc=False):
    """w, x, y, z that rotates body FRD to NED."""

    MSG_ID: ClassVar[MsgId] = MsgId.ATTITUDE_QUATERNION
    time_boot_ms: int  # ms
    q1: float
    q2: float
    q3: float
    q4: float
    rollspeed: float  # rad/s
    pitchspeed: float  # rad/s
    yawspeed: float  # rad/s
    repr_offset_q: tuple[float, ...] = (0.0,) * 4  # 4


class LocalPositionNed(Message, frozen=True, gc=False):
    """The estimate in the local frame, north-east-down."""

    MSG_ID: ClassVar[MsgId] = MsgId.LOCAL_POSITION_NED
    time_boot_ms: int  # ms
    x: float  # m
    y: float  # m
    z: float  # m
    vx: float  # m/s
    vy: float  # m/s
    vz: float  # m/s


class GlobalPositionInt(Message, frozen=True, gc=False):
    """The estimate over the ground; `alt` above mean sea level, `relative_alt` above home."""

    MSG_ID: ClassVar[MsgId] = MsgId.GLOBAL_POSITION_INT
    time_boot_ms: int  # ms
    lat: int  # degE7
    lon: int  # degE7
    alt: int  # mm
    relative_alt: int  # mm
    vx: int  # cm/s
    vy: int  # cm/s
    vz: int  # cm/s
    hdg: int  # cdeg


class VfrHud(Message, frozen=True, gc=False):
    """What a pilot looks at."""

    MSG_ID: ClassVar[MsgId] = MsgId.VFR_HUD
    airspeed: float  # m/s
    groundspeed: float  # m/s
    alt: float  # m
    climb: float  # m/s
    heading: int  # deg
    throttle: int  # %


class GpsGlobalOrigin(Message, frozen=True, gc=False):
    """Where the local frame has its origin; altitude above mean sea level."""

    MSG_ID: ClassVar[MsgId] = MsgId.GPS_GLOBAL_ORIGIN
    latitude: int  # degE7
    longitude: int  # degE7
    altitude: int  # mm
    time_usec: int = 0  # us


class HomePosition(Message, frozen=True, gc=False):
    """Where returns end, global and in the local frame."""

    MSG_ID: ClassVar[MsgId] = MsgId.HOME_POSITION
    latitude: int  # degE7
    longitude: int  # degE7
    altitude: int  # mm
    x: float  # m
    y: float  # m
    z: float  # m
    q: tuple[float, ...]  # 4
    approach_x: float  # m
    approach_y: float  # m
    approach_z: float  # m
    time_usec: int = 0  # us


class EstimatorStatus(Message, frozen=True, gc=False):
    """PX4's estimator: what it knows and how well."""

    MSG_ID: ClassVar[MsgId] = MsgId.ESTIMATOR_STATUS
    time_usec: int  # us
    vel_ratio: float
    pos_horiz_ratio: float
    pos_vert_ratio: float
    mag_ratio: float
    hagl_ratio: float
    tas_ratio: float
    pos_horiz_accuracy: float  # m
    pos_vert_accuracy: float  # m
    flags: int  # ESTIMATOR_STATUS_FLAGS


class EkfStatusReport(Message, frozen=True, gc=False):
    """ArduPilot's estimator: what it knows and how well."""

    MSG_ID: ClassVar[MsgId] = MsgId.EKF_STATUS_REPORT
    velocity_variance: float
    pos_horiz_variance: float
    pos_vert_variance: float
    compass_variance: float
    terrain_alt_variance: float
    flags: int  # EKF_STATUS_FLAGS
    airspeed_variance: float = 0.0


class CameraImageCaptured(Message, frozen=True, gc=False):
    """A picture was taken (or `capture_result` says that it was not)."""

    MSG_ID: ClassVar[MsgId] = MsgId.CAMERA_IMAGE_CAPTURED
    time_utc: int  # us
    time_boot_ms: int  # ms
    lat: int  # degE7
    lon: int  # degE7
    alt: int  # mm
    relative_alt: int  # mm
    q: tuple[float, ...]  # 4
    image_index: int
    camera_id: int
    capture_result: int  # MAV_BOOL
    file_url: str


class CameraFeedback(Message, frozen=True, gc=False):
    """ArduPilot's word for a picture taken."""

    MSG_ID: ClassVar[MsgId] = MsgId.CAMERA_FEEDBACK
    time_usec: int  # us
    lat: int  # degE7
    lng: int  # degE7
    alt_msl: float  # m
    alt_rel: float  # m
    roll: float  # deg
    pitch: float  # deg
    yaw: float  # deg
    foc_len: float  # mm
    img_idx: int
    target_system: int
    cam_idx: int
    flags: int  # CAMERA_FEEDBACK_FLAGS
    completed_captures: int = 0


class CurrentMode(Message, frozen=True, gc=False):
    """The mode in standard and in custom terms."""

    MSG_ID: ClassVar[MsgId] = MsgId.CURRENT_MODE
    custom_mode: int
    intended_custom_mode: int
    standard_mode: int  # MAV_STANDARD_MODE
