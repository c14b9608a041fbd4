"""Messages that no client may send, because of what a vehicle would do with them.

Those that feed its estimator stand apart, in message_estimator.py.
"""

from __future__ import annotations

from gcs.bridge.catalog.row import Group, Kind

DANGERS: tuple[Group, ...] = (
    Group(
        Kind.DENIED,
        "It is a path for the vehicle that goes past its commands.",
        {
            332: "TRAJECTORY_REPRESENTATION_WAYPOINTS",
            333: "TRAJECTORY_REPRESENTATION_BEZIER",
        },
    ),
    Group(
        Kind.DENIED,
        "It is a pilot's sticks on a way that the gate does not read.",
        {
            81: "MANUAL_SETPOINT",
            420: "RADIO_RC_CHANNELS",
            50001: "CUBEPILOT_RAW_RC",
        },
    ),
    Group(
        Kind.DENIED,
        "It drives motors or servos past the controllers.",
        {
            139: "SET_ACTUATOR_CONTROL_TARGET",
        },
    ),
    Group(
        Kind.DENIED,
        "It drives a gimbal's motors past the gimbal's manager.",
        {
            201: "GIMBAL_CONTROL",
            284: "GIMBAL_DEVICE_SET_ATTITUDE",
        },
    ),
    Group(
        Kind.DENIED,
        "It hands a parameter to a knob of the remote control, where no rule is kept.",
        {
            50: "PARAM_MAP_RC",
        },
    ),
    Group(
        Kind.DENIED,
        "It puts a parameter on the pilot's screen, where the sticks can change it.",
        {
            11033: "OSD_PARAM_CONFIG",
        },
    ),
    Group(
        Kind.DENIED,
        "It is a shell or a tunnel: what is inside cannot be judged.",
        {
            126: "SERIAL_CONTROL",
            131: "ENCAPSULATED_DATA",
            169: "DATA16",
            170: "DATA32",
            171: "DATA64",
            172: "DATA96",
            248: "V2_EXTENSION",
            385: "TUNNEL",
            60040: "FRSKY_PASSTHROUGH_ARRAY",
        },
    ),
    Group(
        Kind.DENIED,
        "It goes straight to a bus of the vehicle: what is inside cannot be judged.",
        {
            386: "CAN_FRAME",
            387: "CANFD_FRAME",
            388: "CAN_FILTER_MODIFY",
            11000: "DEVICE_OP_READ",
            11002: "DEVICE_OP_WRITE",
        },
    ),
    Group(
        Kind.DENIED,
        "It carries a command with a time, and the gate judges commands only for now.",
        {
            223: "COMMAND_INT_STAMPED",
            224: "COMMAND_LONG_STAMPED",
        },
    ),
    Group(
        Kind.DENIED,
        "It ends a command that the gate sent; hold, land and abort do that under the gate.",
        {
            80: "COMMAND_CANCEL",
        },
    ),
    Group(
        Kind.DENIED,
        "It could answer the vehicle's request for leave to arm in the gate's place.",
        {
            77: "COMMAND_ACK",
        },
    ),
    Group(
        Kind.DENIED,
        "It changes keys or firmware, by which the vehicle is trusted.",
        {
            7: "AUTH_KEY",
            11004: "SECURE_COMMAND",
            50004: "CUBEPILOT_FIRMWARE_UPDATE_START",
            52000: "AIRLINK_AUTH",
        },
    ),
    Group(
        Kind.DENIED,
        "It changes the network that the link itself may run over.",
        {
            299: "WIFI_CONFIG_AP",
            336: "CELLULAR_CONFIG",
            60047: "MLRS_RADIO_LINK_FLOW_CONTROL",
        },
    ),
    Group(
        Kind.DENIED,
        "It changes the compass while the estimator runs on it.",
        {
            151: "SET_MAG_OFFSETS",
        },
    ),
    Group(
        Kind.DENIED,
        "It sets an old fence that the gate does not verify.",
        {
            54: "SAFETY_SET_ALLOWED_AREA",
        },
    ),
    Group(
        Kind.DENIED,
        "It erases the vehicle's logs, which show what happened in a flight.",
        {
            121: "LOG_ERASE",
        },
    ),
    Group(
        Kind.DENIED,
        "It changes what the vehicle's transponder tells other aircraft.",
        {
            10001: "UAVIONIX_ADSB_OUT_CFG",
            10002: "UAVIONIX_ADSB_OUT_DYNAMIC",
            10004: "UAVIONIX_ADSB_OUT_CFG_REGISTRATION",
            10005: "UAVIONIX_ADSB_OUT_CFG_FLIGHTID",
            10006: "UAVIONIX_ADSB_GET",
            10007: "UAVIONIX_ADSB_OUT_CONTROL",
        },
    ),
    Group(
        Kind.DENIED,
        "It changes who the vehicle says it is, or whether it may arm, in Remote ID.",
        {
            12900: "OPEN_DRONE_ID_BASIC_ID",
            12901: "OPEN_DRONE_ID_LOCATION",
            12902: "OPEN_DRONE_ID_AUTHENTICATION",
            12915: "OPEN_DRONE_ID_MESSAGE_PACK",
            12918: "OPEN_DRONE_ID_ARM_STATUS",
        },
    ),
    Group(
        Kind.DENIED,
        "A script on board may act on it, and what it does nobody here knows.",
        {
            249: "MEMORY_VECT",
            250: "DEBUG_VECT",
            251: "NAMED_VALUE_FLOAT",
            252: "NAMED_VALUE_INT",
            254: "DEBUG",
            350: "DEBUG_FLOAT_ARRAY",
            11060: "NAMED_VALUE_STRING",
        },
    ),
    Group(
        Kind.DENIED,
        "It is a battery's or generator's state: a low one starts a failsafe, a full one "
        "hides it (from memory).",
        {
            147: "BATTERY_STATUS",
            181: "BATTERY2",
            370: "SMART_BATTERY_INFO",
            371: "FUEL_STATUS",
            372: "BATTERY_INFO",
            373: "GENERATOR_STATUS",
        },
    ),
    Group(
        Kind.DENIED,
        "The vehicle would take its sender for its own gimbal, camera or companion.",
        {
            112: "CAMERA_TRIGGER",
            179: "CAMERA_STATUS",
            200: "GIMBAL_REPORT",
            214: "GIMBAL_TORQUE_CMD_REPORT",
            215: "GOPRO_HEARTBEAT",
            259: "CAMERA_INFORMATION",
            283: "GIMBAL_DEVICE_INFORMATION",
            285: "GIMBAL_DEVICE_ATTITUDE_STATUS",
            334: "CELLULAR_STATUS",
            390: "ONBOARD_COMPUTER_STATUS",
        },
    ),
    Group(
        Kind.DENIED,
        "It asks the receiver for a resource by a name that cannot be judged.",
        {
            130: "DATA_TRANSMISSION_HANDSHAKE",
            142: "RESOURCE_REQUEST",
        },
    ),
    Group(
        Kind.DENIED,
        "It calibrates or tunes an aircraft of a research group, and no autopilot here takes it.",
        {
            221: "RADIO_CALIBRATION",
            8008: "ASL_OBCTRL",
            11010: "ADAP_TUNING",
        },
    ),
    Group(
        Kind.DENIED,
        "It is only for tests of MAVLink libraries.",
        {
            17000: "TEST_TYPES",
            17150: "ARRAY_TEST_0",
            17151: "ARRAY_TEST_1",
            17153: "ARRAY_TEST_3",
            17154: "ARRAY_TEST_4",
            17155: "ARRAY_TEST_5",
            17156: "ARRAY_TEST_6",
            17157: "ARRAY_TEST_7",
            17158: "ARRAY_TEST_8",
        },
    ),
)
