"""Messages that a station sends to a vehicle: what it asks, flies and sets up."""

from __future__ import annotations

from gcs.bridge.catalog.row import Group, Kind

REQUESTS: tuple[Group, ...] = (
    Group(
        Kind.LOCAL,
        "A client's sign of life ends at the gate, which sends the vehicle one of its own.",
        {
            0: "HEARTBEAT",
        },
    ),
    Group(
        Kind.LOCAL,
        "It is about the link between client and gate, and autopilots slow their telemetry "
        "down by it (from memory).",
        {
            8: "LINK_NODE_STATUS",
            109: "RADIO_STATUS",
            166: "RADIO",
        },
    ),
    Group(
        Kind.LOCAL,
        "A client's clock stays at the gate: autopilots set theirs by it, and judge "
        "signatures by theirs (from memory).",
        {
            2: "SYSTEM_TIME",
        },
    ),
    Group(
        Kind.LOCAL,
        "The gate decides who is in control, so a client asks the gate.",
        {
            5: "CHANGE_OPERATOR_CONTROL",
        },
    ),
    Group(
        Kind.CARRIER,
        "The command that it carries decides.",
        {
            75: "COMMAND_INT",
            76: "COMMAND_LONG",
        },
    ),
    Group(
        Kind.HARMLESS,
        "It measures the link and changes nothing.",
        {
            4: "PING",
            111: "TIMESYNC",
        },
    ),
    Group(
        Kind.HARMLESS,
        "It asks for parameters and changes none.",
        {
            20: "PARAM_REQUEST_READ",
            21: "PARAM_REQUEST_LIST",
            320: "PARAM_EXT_REQUEST_READ",
            321: "PARAM_EXT_REQUEST_LIST",
            11035: "OSD_PARAM_SHOW_CONFIG",
        },
    ),
    Group(
        Kind.HARMLESS,
        "It reads the plan on board and changes nothing.",
        {
            37: "MISSION_REQUEST_PARTIAL_LIST",
            40: "MISSION_REQUEST",
            43: "MISSION_REQUEST_LIST",
            51: "MISSION_REQUEST_INT",
            161: "FENCE_FETCH_POINT",
            176: "RALLY_FETCH_POINT",
        },
    ),
    Group(
        Kind.HARMLESS,
        "It tells the vehicle that a plan was read; as the end of an upload the gate sends "
        "its own.",
        {
            47: "MISSION_ACK",
        },
    ),
    Group(
        Kind.HARMLESS,
        "It asks for messages and for how often they come.",
        {
            66: "REQUEST_DATA_STREAM",
            135: "TERRAIN_CHECK",
            183: "AUTOPILOT_VERSION_REQUEST",
            412: "REQUEST_EVENT",
        },
    ),
    Group(
        Kind.HARMLESS,
        "It lists the vehicle's logs, or ends the reading of one.",
        {
            117: "LOG_REQUEST_LIST",
            122: "LOG_REQUEST_END",
        },
    ),
    Group(
        Kind.CONFIGURATION,
        "It reads a log, which fills the link that flying needs: on the ground, unless the policy "
        "allows it.",
        {
            119: "LOG_REQUEST_DATA",
            185: "REMOTE_LOG_BLOCK_STATUS",
        },
    ),
    Group(
        Kind.HARMLESS,
        "It tells the vehicle that a part of a log has come.",
        {
            268: "LOGGING_ACK",
        },
    ),
    Group(
        Kind.HARMLESS,
        "It is a text for the vehicle's log.",
        {
            253: "STATUSTEXT",
        },
    ),
    Group(
        Kind.HARMLESS,
        "It makes a sound or a light.",
        {
            186: "LED_CONTROL",
            258: "PLAY_TUNE",
            400: "PLAY_TUNE_V2",
        },
    ),
    Group(
        Kind.HARMLESS,
        "It works a camera.",
        {
            154: "DIGICAM_CONFIGURE",
            155: "DIGICAM_CONTROL",
            216: "GOPRO_GET_REQUEST",
            218: "GOPRO_SET_REQUEST",
        },
    ),
    Group(
        Kind.POINTING,
        "It points a camera; a copter whose mount cannot turn sideways turns its nose (from "
        "memory), which moves it nowhere.",
        {
            156: "MOUNT_CONFIGURE",
            157: "MOUNT_CONTROL",
            282: "GIMBAL_MANAGER_SET_ATTITUDE",
            287: "GIMBAL_MANAGER_SET_PITCHYAW",
            288: "GIMBAL_MANAGER_SET_MANUAL_CONTROL",
            60012: "STORM32_GIMBAL_MANAGER_CONTROL",
            60013: "STORM32_GIMBAL_MANAGER_CONTROL_PITCHYAW",
            60014: "STORM32_GIMBAL_MANAGER_CORRECT_ROLL",
        },
    ),
    Group(
        Kind.HARMLESS,
        "It tells what the law wants a vehicle to broadcast about its operator.",
        {
            12903: "OPEN_DRONE_ID_SELF_ID",
            12904: "OPEN_DRONE_ID_SYSTEM",
            12905: "OPEN_DRONE_ID_OPERATOR_ID",
            12919: "OPEN_DRONE_ID_SYSTEM_UPDATE",
        },
    ),
    Group(
        Kind.MOTION,
        "It is a setpoint, which moves the vehicle at once.",
        {
            82: "SET_ATTITUDE_TARGET",
            84: "SET_POSITION_TARGET_LOCAL_NED",
            86: "SET_POSITION_TARGET_GLOBAL_INT",
        },
    ),
    Group(
        Kind.MOTION,
        "It is a pilot's sticks, which move the vehicle at once.",
        {
            69: "MANUAL_CONTROL",
            70: "RC_CHANNELS_OVERRIDE",
        },
    ),
    Group(
        Kind.MOTION,
        "It changes the flight mode, and with it what the vehicle flies.",
        {
            11: "SET_MODE",
        },
    ),
    Group(
        Kind.MOTION,
        "It sends a vehicle in a mission to another item.",
        {
            41: "MISSION_SET_CURRENT",
        },
    ),
    Group(
        Kind.CONFIGURATION,
        "It is part of a plan's upload, which is verified whole; with current = 2 or 3 it is "
        "a goal of its own, which is motion.",
        {
            39: "MISSION_ITEM",
            73: "MISSION_ITEM_INT",
        },
    ),
    Group(
        Kind.CONFIGURATION,
        "It begins a plan's upload, which is verified whole.",
        {
            44: "MISSION_COUNT",
        },
    ),
    Group(
        Kind.CONFIGURATION,
        "It changes items of the plan on board, of which the gate verifies only the whole.",
        {
            38: "MISSION_WRITE_PARTIAL_LIST",
        },
    ),
    Group(
        Kind.CONFIGURATION,
        "It deletes the plan on board.",
        {
            45: "MISSION_CLEAR_ALL",
        },
    ),
    Group(
        Kind.CONFIGURATION,
        "It changes the fence or the rally points on board.",
        {
            160: "FENCE_POINT",
            175: "RALLY_POINT",
        },
    ),
    Group(
        Kind.CONFIGURATION,
        "It changes a parameter; its name decides.",
        {
            23: "PARAM_SET",
            323: "PARAM_EXT_SET",
        },
    ),
    Group(
        Kind.CONFIGURATION,
        "It reads or writes files on board; its opcode decides.",
        {
            110: "FILE_TRANSFER_PROTOCOL",
        },
    ),
    Group(
        Kind.CONFIGURATION,
        "It moves the point that the vehicle returns to.",
        {
            243: "SET_HOME_POSITION",
        },
    ),
    Group(
        Kind.CONFIGURATION,
        "It moves the point that local positions count from; refused unless the policy allows it.",
        {
            48: "SET_GPS_GLOBAL_ORIGIN",
        },
    ),
    Group(
        Kind.CONFIGURATION,
        "It sets the key by which the vehicle knows whom to obey.",
        {
            256: "SETUP_SIGNING",
        },
    ),
    Group(
        Kind.CONFIGURATION,
        "RTK corrections shift the position that the vehicle believes; refused unless the "
        "policy allows them.",
        {
            233: "GPS_RTCM_DATA",
        },
    ),
)
