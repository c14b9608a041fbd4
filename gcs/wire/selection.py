"""What the ground station uses of the MAVLink dialect, by name.  `make messages` reads this.

`generate.py` takes all numbers, fields, types and units from the dialect and writes `messages.py`
and `ids.py`.  To use another message or enum entry, add its name here and run `make messages`.
"""

from __future__ import annotations

from typing import NamedTuple

MESSAGES = (
    "HEARTBEAT",
    "SYS_STATUS",
    "PARAM_REQUEST_READ",
    "PARAM_REQUEST_LIST",
    "PARAM_VALUE",
    "ATTITUDE",
    "LOCAL_POSITION_NED",
    "GLOBAL_POSITION_INT",
    "MISSION_REQUEST",
    "MISSION_CURRENT",
    "MISSION_REQUEST_LIST",
    "MISSION_COUNT",
    "MISSION_CLEAR_ALL",
    "MISSION_ITEM_REACHED",
    "MISSION_ACK",
    "GPS_GLOBAL_ORIGIN",
    "MISSION_REQUEST_INT",
    "MISSION_ITEM_INT",
    "COMMAND_INT",
    "COMMAND_LONG",
    "COMMAND_ACK",
    "SET_POSITION_TARGET_LOCAL_NED",
    "CAMERA_FEEDBACK",
    "HOME_POSITION",
    "EXTENDED_SYS_STATE",
    "STATUSTEXT",
    "CAMERA_IMAGE_CAPTURED",
    "PARAM_ERROR",
    "EVENT",
    "CURRENT_EVENT_SEQUENCE",
    "REQUEST_EVENT",
    "RESPONSE_EVENT_ERROR",
    "GPS_RAW_INT",
    "ESTIMATOR_STATUS",
    "EKF_STATUS_REPORT",
    "TIMESYNC",
    "AUTOPILOT_VERSION",
    # What other stations send, through the bridge.
    "SETUP_SIGNING",
    "REQUEST_DATA_STREAM",
    "SET_MODE",
    "CHANGE_OPERATOR_CONTROL",
    "CHANGE_OPERATOR_CONTROL_ACK",
    "CONTROL_STATUS",
    "PARAM_SET",
    "PARAM_EXT_SET",
    "MISSION_REQUEST_PARTIAL_LIST",
    "MISSION_WRITE_PARTIAL_LIST",
    "MISSION_ITEM",
    "MISSION_SET_CURRENT",
    "LOG_REQUEST_LIST",
    "LOG_ENTRY",
    "LOG_REQUEST_DATA",
    "LOG_DATA",
    "LOG_REQUEST_END",
    "REMOTE_LOG_BLOCK_STATUS",
    "SET_GPS_GLOBAL_ORIGIN",
    "SET_HOME_POSITION",
    "MANUAL_CONTROL",
    "RC_CHANNELS_OVERRIDE",
    "SET_ATTITUDE_TARGET",
    "SET_POSITION_TARGET_GLOBAL_INT",
    "FILE_TRANSFER_PROTOCOL",
    "FENCE_POINT",
    "RALLY_POINT",
    "BATTERY_STATUS",
    "RADIO_STATUS",
    "FENCE_STATUS",
    "GPS_RTCM_DATA",
    "PARAM_EXT_REQUEST_READ",
    "PARAM_EXT_ACK",
    "ORBIT_EXECUTION_STATUS",
    "LINK_NODE_STATUS",
)
"""Messages that are sent or interpreted: each gets a class in `messages.py` and an id."""

IDS_ONLY = (
    "POSITION_TARGET_LOCAL_NED",
    "ATTITUDE_TARGET",
    "SERVO_OUTPUT_RAW",
    "RC_CHANNELS",
    "VIBRATION",
    "WIND",
)
"""Messages that are requested for the record and not interpreted: each gets an id only."""

DEFAULTS = {("HEARTBEAT", "mavlink_version"): 3}
"""Base fields that the protocol itself fills in; all other base fields must be given.

3 is `<version>` in MAVLink's minimal.xml, which pymavlink writes into every heartbeat too.
"""


class EnumChoice(NamedTuple):
    """One enum of the dialect, as a class in `ids.py`."""

    class_name: str
    name: str
    """In the dialect, such as MAV_CMD."""
    prefix: str
    """What the members' names leave out: `Cmd.NAV_LAND` is MAV_CMD_NAV_LAND."""
    about: str
    """Docstring, behind the dialect's name."""
    entries: tuple[str, ...] = ()
    """The entries that are used, without the prefix; none listed: the whole enum."""


COMMANDS = (
    "NAV_WAYPOINT",
    "NAV_LOITER_UNLIM",
    "NAV_LOITER_TURNS",
    "NAV_LOITER_TIME",
    "NAV_RETURN_TO_LAUNCH",
    "NAV_LAND",
    "NAV_TAKEOFF",
    "NAV_LOITER_TO_ALT",
    "DO_ORBIT",
    "NAV_ROI",
    "NAV_SPLINE_WAYPOINT",
    "NAV_GUIDED_ENABLE",
    "NAV_DELAY",
    "CONDITION_DELAY",
    "CONDITION_DISTANCE",
    "CONDITION_YAW",
    "DO_SET_MODE",
    "NAV_PAYLOAD_PLACE",
    "DO_JUMP",
    "JUMP_TAG",
    "DO_JUMP_TAG",
    "DO_CHANGE_SPEED",
    "DO_SET_HOME",
    "DO_FLIGHTTERMINATION",
    "DO_CHANGE_ALTITUDE",
    "DO_LAND_START",
    "DO_REPOSITION",
    "DO_PAUSE_CONTINUE",
    "DO_SET_ROI_LOCATION",
    "DO_SET_ROI_WPNEXT_OFFSET",
    "DO_SET_ROI_NONE",
    "DO_SET_ROI_SYSID",
    "DO_SET_ROI",
    "DO_DIGICAM_CONFIGURE",
    "DO_DIGICAM_CONTROL",
    "DO_MOUNT_CONFIGURE",
    "DO_MOUNT_CONTROL",
    "DO_SET_CAM_TRIGG_DIST",
    "DO_FENCE_ENABLE",
    "DO_SET_CAM_TRIGG_INTERVAL",
    "DO_SET_MISSION_CURRENT",
    "DO_SET_STANDARD_MODE",
    "PREFLIGHT_CALIBRATION",
    "PREFLIGHT_STORAGE",
    "PREFLIGHT_REBOOT_SHUTDOWN",
    "MISSION_START",
    "COMPONENT_ARM_DISARM",
    "RUN_PREARM_CHECKS",
    "LOGGING_START",
    "LOGGING_STOP",
    "ARM_AUTHORIZATION_REQUEST",
    "DO_SET_ACTUATOR",
    "DO_MOTOR_TEST",
    "DO_SET_SERVO",
    "DO_SET_RELAY",
    "DO_REPEAT_RELAY",
    "DO_REPEAT_SERVO",
    "DO_GRIPPER",
    "DO_WINCH",
    "DO_PARACHUTE",
    "DO_FOLLOW",
    "DO_RALLY_LAND",
    "DO_GO_AROUND",
    "OVERRIDE_GOTO",
    "GET_HOME_POSITION",
    "INJECT_FAILURE",
    "GET_MESSAGE_INTERVAL",
    "SET_MESSAGE_INTERVAL",
    "REQUEST_MESSAGE",
    "REQUEST_PROTOCOL_VERSION",
    "REQUEST_AUTOPILOT_CAPABILITIES",
    "REQUEST_CAMERA_INFORMATION",
    "SET_CAMERA_MODE",
    "DO_SET_GLOBAL_ORIGIN",
    "DO_GIMBAL_MANAGER_PITCHYAW",
    "DO_GIMBAL_MANAGER_CONFIGURE",
    "IMAGE_START_CAPTURE",
    "IMAGE_STOP_CAPTURE",
    "DO_TRIGGER_CONTROL",
    "VIDEO_START_CAPTURE",
    "VIDEO_STOP_CAPTURE",
    "NAV_FENCE_RETURN_POINT",
    "NAV_FENCE_POLYGON_VERTEX_INCLUSION",
    "NAV_FENCE_POLYGON_VERTEX_EXCLUSION",
    "NAV_FENCE_CIRCLE_INCLUSION",
    "NAV_FENCE_CIRCLE_EXCLUSION",
    "NAV_RALLY_POINT",
    "REQUEST_OPERATOR_CONTROL",
)
"""Sent, flown in missions, or called by name when a mission file has them."""

ENUMS = (
    EnumChoice(
        "Cmd",
        "MAV_CMD",
        "MAV_CMD_",
        "what this program sends, or knows in a mission",
        COMMANDS,
    ),
    EnumChoice("Result", "MAV_RESULT", "MAV_RESULT_", "COMMAND_ACK.result"),
    EnumChoice(
        "MavFrame",
        "MAV_FRAME",
        "MAV_FRAME_",
        "what a position is counted from",
        (
            "GLOBAL",
            "LOCAL_NED",
            "MISSION",
            "GLOBAL_RELATIVE_ALT",
            "GLOBAL_INT",
            "GLOBAL_RELATIVE_ALT_INT",
            "GLOBAL_TERRAIN_ALT",
            "GLOBAL_TERRAIN_ALT_INT",
            "LOCAL_OFFSET_NED",
            "BODY_NED",
            "BODY_OFFSET_NED",
            "BODY_FRD",
            "LOCAL_FRD",
        ),
    ),
    EnumChoice(
        "MissionType", "MAV_MISSION_TYPE", "MAV_MISSION_TYPE_", "which plan a message is about"
    ),
    EnumChoice("MissionResult", "MAV_MISSION_RESULT", "MAV_MISSION_", "MISSION_ACK.type"),
    EnumChoice("MissionState", "MISSION_STATE", "MISSION_STATE_", "MISSION_CURRENT.mission_state"),
    EnumChoice("ModeFlag", "MAV_MODE_FLAG", "MAV_MODE_FLAG_", "bits of HEARTBEAT.base_mode"),
    EnumChoice("MavState", "MAV_STATE", "MAV_STATE_", "HEARTBEAT.system_status"),
    EnumChoice(
        "MavAutopilot",
        "MAV_AUTOPILOT",
        "MAV_AUTOPILOT_",
        "HEARTBEAT.autopilot",
        ("GENERIC", "ARDUPILOTMEGA", "INVALID", "PX4"),
    ),
    EnumChoice("MavType", "MAV_TYPE", "MAV_TYPE_", "HEARTBEAT.type"),
    EnumChoice(
        "ChargeState",
        "MAV_BATTERY_CHARGE_STATE",
        "MAV_BATTERY_CHARGE_STATE_",
        "BATTERY_STATUS.charge_state",
    ),
    EnumChoice(
        "BatteryFunction",
        "MAV_BATTERY_FUNCTION",
        "MAV_BATTERY_FUNCTION_",
        "BATTERY_STATUS.battery_function",
    ),
    EnumChoice("FenceBreach", "FENCE_BREACH", "FENCE_BREACH_", "FENCE_STATUS.breach_type"),
    EnumChoice("GpsFix", "GPS_FIX_TYPE", "GPS_", "GPS_RAW_INT.fix_type"),
    EnumChoice(
        "EstimatorFlag",
        "ESTIMATOR_STATUS_FLAGS",
        "ESTIMATOR_",
        "bits of ESTIMATOR_STATUS.flags",
    ),
    EnumChoice(
        "EkfFlag",
        "EKF_STATUS_FLAGS",
        "EKF_",
        "bits of EKF_STATUS_REPORT.flags",
        ("UNINITIALIZED", "GPS_GLITCHING"),
    ),
    EnumChoice(
        "Sensor",
        "MAV_SYS_STATUS_SENSOR",
        "MAV_SYS_STATUS_",
        "bits of SYS_STATUS.onboard_control_sensors_*",
        ("SENSOR_GPS", "AHRS", "PREARM_CHECK"),
    ),
    EnumChoice("Severity", "MAV_SEVERITY", "MAV_SEVERITY_", "STATUSTEXT.severity"),
    EnumChoice("ParamType", "MAV_PARAM_TYPE", "MAV_PARAM_TYPE_", "PARAM_VALUE.param_type"),
    EnumChoice("ParamFault", "MAV_PARAM_ERROR", "MAV_PARAM_ERROR_", "PARAM_ERROR.error"),
    EnumChoice("ParamExtResult", "PARAM_ACK", "PARAM_ACK_", "PARAM_EXT_ACK.param_result"),
    EnumChoice(
        "FtpOpcode",
        "MAV_FTP_OPCODE",
        "MAV_FTP_OPCODE_",
        "byte 3 of FILE_TRANSFER_PROTOCOL.payload",
    ),
    EnumChoice(
        "FtpError", "MAV_FTP_ERR", "MAV_FTP_ERR_", "first byte of data of an FTP negative answer"
    ),
    EnumChoice("Component", "MAV_COMPONENT", "MAV_COMP_ID_", "component ids", ("AUTOPILOT1",)),
    EnumChoice(
        "TypeMask",
        "POSITION_TARGET_TYPEMASK",
        "POSITION_TARGET_TYPEMASK_",
        "a set bit means that the field is ignored",
    ),
    EnumChoice(
        "AttitudeMask",
        "ATTITUDE_TARGET_TYPEMASK",
        "ATTITUDE_TARGET_TYPEMASK_",
        "a set bit means that the field is ignored",
    ),
)
"""The classes in `ids.py`, in their order there."""
