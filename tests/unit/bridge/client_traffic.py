"""What other ground stations were seen to send to vehicle-sim in either personality.

Recorded between client and vehicle in November 2026, by the scripts of tests/clients: connecting,
parameters, plans, arming, flying, offboard, logs, files, camera.  Names only.
"""

MESSAGES: dict[str, frozenset[str]] = {
    "mavsdk-grpc 4.0.5": frozenset(
        [
            "FILE_TRANSFER_PROTOCOL",
            "FOLLOW_TARGET",
            "HEARTBEAT",
            "LOG_REQUEST_DATA",
            "LOG_REQUEST_END",
            "LOG_REQUEST_LIST",
            "MISSION_ACK",
            "MISSION_CLEAR_ALL",
            "MISSION_COUNT",
            "MISSION_ITEM_INT",
            "MISSION_REQUEST_INT",
            "MISSION_REQUEST_LIST",
            "PARAM_REQUEST_LIST",
            "PARAM_REQUEST_READ",
            "PARAM_SET",
            "PING",
            "PLAY_TUNE_V2",
            "SET_ATTITUDE_TARGET",
            "SET_POSITION_TARGET_LOCAL_NED",
        ]
    ),
    "MAVProxy 1.8.75": frozenset(
        [
            "FILE_TRANSFER_PROTOCOL",
            "HEARTBEAT",
            "LOG_REQUEST_DATA",
            "LOG_REQUEST_END",
            "LOG_REQUEST_LIST",
            "MISSION_COUNT",
            "MISSION_ITEM_INT",
            "MISSION_REQUEST_INT",
            "MISSION_REQUEST_LIST",
            "PARAM_REQUEST_LIST",
            "PARAM_REQUEST_READ",
            "PARAM_SET",
            "RC_CHANNELS_OVERRIDE",
            "REQUEST_DATA_STREAM",
        ]
    ),
    "MAVSDK 4.1.0": frozenset(
        [
            "FILE_TRANSFER_PROTOCOL",
            "HEARTBEAT",
            "LOG_REQUEST_DATA",
            "LOG_REQUEST_END",
            "LOG_REQUEST_LIST",
            "MISSION_ACK",
            "MISSION_CLEAR_ALL",
            "MISSION_COUNT",
            "MISSION_ITEM_INT",
            "MISSION_REQUEST_INT",
            "MISSION_REQUEST_LIST",
            "PARAM_REQUEST_LIST",
            "PARAM_REQUEST_READ",
            "PARAM_SET",
            "PING",
            "SET_ATTITUDE_TARGET",
            "SET_POSITION_TARGET_GLOBAL_INT",
            "SET_POSITION_TARGET_LOCAL_NED",
            "TIMESYNC",
        ]
    ),
    "pymavlink 2.4.50": frozenset(
        [
            "HEARTBEAT",
            "LOG_REQUEST_DATA",
            "LOG_REQUEST_END",
            "LOG_REQUEST_LIST",
            "MANUAL_CONTROL",
            "MISSION_CLEAR_ALL",
            "MISSION_COUNT",
            "MISSION_ITEM",
            "MISSION_ITEM_INT",
            "MISSION_REQUEST_INT",
            "MISSION_REQUEST_LIST",
            "MISSION_SET_CURRENT",
            "PARAM_SET",
            "RC_CHANNELS_OVERRIDE",
            "REQUEST_DATA_STREAM",
            "SET_POSITION_TARGET_LOCAL_NED",
        ]
    ),
}

COMMANDS: dict[str, frozenset[str]] = {
    "mavsdk-grpc 4.0.5": frozenset(
        [
            "COMPONENT_ARM_DISARM",
            "DO_CHANGE_SPEED",
            "DO_ORBIT",
            "DO_REPOSITION",
            "DO_SET_MODE",
            "DO_SET_SERVO",
            "IMAGE_START_CAPTURE",
            "NAV_LAND",
            "NAV_TAKEOFF",
            "REQUEST_MESSAGE",
            "SET_CAMERA_MODE",
            "SET_MESSAGE_INTERVAL",
        ]
    ),
    "MAVProxy 1.8.75": frozenset(
        [
            "COMPONENT_ARM_DISARM",
            "DO_FENCE_ENABLE",
            "DO_REPOSITION",
            "DO_SET_MISSION_CURRENT",
            "DO_SET_MODE",
            "GET_HOME_POSITION",
            "NAV_LAND",
            "NAV_TAKEOFF",
            "PREFLIGHT_REBOOT_SHUTDOWN",
            "REQUEST_MESSAGE",
        ]
    ),
    "MAVSDK 4.1.0": frozenset(
        [
            "COMPONENT_ARM_DISARM",
            "DO_CHANGE_SPEED",
            "DO_ORBIT",
            "DO_REPOSITION",
            "DO_SET_ACTUATOR",
            "DO_SET_MODE",
            "DO_SET_RELAY",
            "DO_SET_SERVO",
            "DO_VTOL_TRANSITION",
            "IMAGE_START_CAPTURE",
            "IMAGE_STOP_CAPTURE",
            "MISSION_START",
            "NAV_LAND",
            "NAV_TAKEOFF",
            "PREFLIGHT_CALIBRATION",
            "REQUEST_MESSAGE",
            "REQUEST_VIDEO_STREAM_STATUS",
            "SET_CAMERA_MODE",
            "SET_MESSAGE_INTERVAL",
        ]
    ),
    "pymavlink 2.4.50": frozenset(
        [
            "COMPONENT_ARM_DISARM",
            "DO_REPOSITION",
            "DO_SET_MODE",
            "NAV_RETURN_TO_LAUNCH",
            "NAV_TAKEOFF",
        ]
    ),
}
