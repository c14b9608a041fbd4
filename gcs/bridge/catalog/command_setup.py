"""Commands that ask a vehicle for something, or change how it is set up."""

from __future__ import annotations

from gcs.bridge.catalog.row import Group, Kind

SETUP: tuple[Group, ...] = (
    Group(
        Kind.LOCAL,
        "The gate decides who is in control, so a client asks the gate.",
        {
            32100: "REQUEST_OPERATOR_CONTROL",
        },
    ),
    Group(
        Kind.HARMLESS,
        "It asks for messages and for how often they come.",
        {
            410: "GET_HOME_POSITION",
            510: "GET_MESSAGE_INTERVAL",
            511: "SET_MESSAGE_INTERVAL",
            512: "REQUEST_MESSAGE",
            519: "REQUEST_PROTOCOL_VERSION",
            520: "REQUEST_AUTOPILOT_CAPABILITIES",
            521: "REQUEST_CAMERA_INFORMATION",
            522: "REQUEST_CAMERA_SETTINGS",
            525: "REQUEST_STORAGE_INFORMATION",
            527: "REQUEST_CAMERA_CAPTURE_STATUS",
            528: "REQUEST_FLIGHT_INFORMATION",
            2002: "REQUEST_CAMERA_IMAGE_CAPTURE",
            2504: "REQUEST_VIDEO_STREAM_INFORMATION",
            2505: "REQUEST_VIDEO_STREAM_STATUS",
            5200: "UAVCAN_GET_NODE_INFO",
            42428: "DO_SEND_BANNER",
        },
    ),
    Group(
        Kind.CONFIGURATION,
        "It lets the vehicle send its log as it is written, which fills the link that flying "
        "needs: on the ground, unless the policy allows it.",
        {
            2510: "LOGGING_START",
        },
    ),
    Group(
        Kind.HARMLESS,
        "It ends the sending of the log.",
        {
            2511: "LOGGING_STOP",
        },
    ),
    Group(
        Kind.HARMLESS,
        "It lets the vehicle check whether it could arm.",
        {
            401: "RUN_PREARM_CHECKS",
        },
    ),
    Group(
        Kind.CONFIGURATION,
        "It moves the point that the vehicle returns to.",
        {
            179: "DO_SET_HOME",
        },
    ),
    Group(
        Kind.CONFIGURATION,
        "It moves the point that local positions count from; refused unless the policy allows it.",
        {
            611: "DO_SET_GLOBAL_ORIGIN",
        },
    ),
    Group(
        Kind.CONFIGURATION,
        "It switches the vehicle's own fence on or off.",
        {
            207: "DO_FENCE_ENABLE",
        },
    ),
    Group(
        Kind.CONFIGURATION,
        "It stops the motors or the whole autopilot.",
        {
            185: "DO_FLIGHTTERMINATION",
            246: "PREFLIGHT_REBOOT_SHUTDOWN",
        },
    ),
    Group(
        Kind.CONFIGURATION,
        "It makes a sensor or a motor fail for a test.",
        {
            420: "INJECT_FAILURE",
        },
    ),
    Group(
        Kind.CONFIGURATION,
        "It calibrates a sensor, on which the estimator runs.",
        {
            241: "PREFLIGHT_CALIBRATION",
            242: "PREFLIGHT_SET_SENSOR_OFFSETS",
            42004: "FIXED_MAG_CAL",
            42005: "FIXED_MAG_CAL_FIELD",
            42006: "FIXED_MAG_CAL_YAW",
            42424: "DO_START_MAG_CAL",
            42425: "DO_ACCEPT_MAG_CAL",
            42426: "DO_CANCEL_MAG_CAL",
            42429: "ACCELCAL_VEHICLE_POS",
        },
    ),
    Group(
        Kind.CONFIGURATION,
        "It writes, reads or resets all parameters, or sets up what hangs on the CAN bus.",
        {
            243: "PREFLIGHT_UAVCAN",
            245: "PREFLIGHT_STORAGE",
        },
    ),
    Group(
        Kind.DENIED,
        "It feeds the estimator: who sends it decides where the vehicle believes to be.",
        {
            42007: "SET_EKF_SOURCE_SET",
            43003: "EXTERNAL_POSITION_ESTIMATE",
            43004: "EXTERNAL_WIND_ESTIMATE",
            43005: "SET_HAGL",
        },
    ),
    Group(
        Kind.DENIED,
        "It changes a parameter by its number, and a rule needs its name.",
        {
            180: "DO_SET_PARAMETER",
        },
    ),
    Group(
        Kind.DENIED,
        "It changes the vehicle's id, and takes it away from the gate that knows it by this one.",
        {
            610: "DO_SET_SYS_CMP_ID",
        },
    ),
    Group(
        Kind.DENIED,
        "It switches the safety switch, without which no motor turns.",
        {
            5300: "DO_SET_SAFETY_SWITCH_STATE",
        },
    ),
    Group(
        Kind.DENIED,
        "It makes the battery look full, and its failsafes come too late.",
        {
            42651: "BATTERY_RESET",
        },
    ),
    Group(
        Kind.DENIED,
        "It changes the link or the remote control's link, which flying needs.",
        {
            500: "START_RX_PAIR",
            2600: "CONTROL_HIGH_LATENCY",
        },
    ),
    Group(
        Kind.DENIED,
        "It runs or feeds a script on board, and what that does nobody here knows.",
        {
            217: "DO_SEND_SCRIPT_MESSAGE",
            42701: "SCRIPTING",
        },
    ),
    Group(
        Kind.DENIED,
        "It opens a tunnel to a bus of the vehicle: what is inside cannot be judged.",
        {
            32000: "CAN_FORWARD",
        },
    ),
    Group(
        Kind.DENIED,
        "It is for the factory or a debugger, and stops a flying autopilot.",
        {
            42427: "SET_FACTORY_TEST_MODE",
            42650: "FLASH_BOOTLOADER",
            42700: "DEBUG_TRAP",
        },
    ),
    Group(
        Kind.DENIED,
        "A vehicle sends it to the one that may let it arm, and no station sends it.",
        {
            3001: "ARM_AUTHORIZATION_REQUEST",
        },
    ),
    Group(
        Kind.DENIED,
        "What it does is up to whoever wrote the vehicle's program.",
        {
            31010: "USER_1",
            31011: "USER_2",
            31012: "USER_3",
            31013: "USER_4",
            31014: "USER_5",
        },
    ),
)
