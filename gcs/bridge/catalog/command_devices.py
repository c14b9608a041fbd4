"""Commands to what a vehicle carries: cameras, gimbals, lights, servos, payloads."""

from __future__ import annotations

from gcs.bridge.catalog.row import Group, Kind

DEVICES: tuple[Group, ...] = (
    Group(
        Kind.HARMLESS,
        "It works a camera.",
        {
            200: "DO_CONTROL_VIDEO",
            202: "DO_DIGICAM_CONFIGURE",
            203: "DO_DIGICAM_CONTROL",
            206: "DO_SET_CAM_TRIGG_DIST",
            214: "DO_SET_CAM_TRIGG_INTERVAL",
            529: "RESET_CAMERA_SETTINGS",
            530: "SET_CAMERA_MODE",
            531: "SET_CAMERA_ZOOM",
            532: "SET_CAMERA_FOCUS",
            533: "SET_STORAGE_USAGE",
            534: "SET_CAMERA_SOURCE",
            2000: "IMAGE_START_CAPTURE",
            2001: "IMAGE_STOP_CAPTURE",
            2003: "DO_TRIGGER_CONTROL",
            2010: "CAMERA_STOP_TRACKING",
            2020: "CAMERA_START_MTI",
            2021: "CAMERA_STOP_MTI",
            2500: "VIDEO_START_CAPTURE",
            2501: "VIDEO_STOP_CAPTURE",
            2502: "VIDEO_START_STREAMING",
            2503: "VIDEO_STOP_STREAMING",
        },
    ),
    Group(
        Kind.POINTING,
        "It points a camera; a copter whose mount cannot turn sideways turns its nose (from "
        "memory), which moves it nowhere.",
        {
            204: "DO_MOUNT_CONFIGURE",
            205: "DO_MOUNT_CONTROL",
            220: "DO_MOUNT_CONTROL_QUAT",
            260: "OBLIQUE_SURVEY",
            1000: "DO_GIMBAL_MANAGER_PITCHYAW",
            1001: "DO_GIMBAL_MANAGER_CONFIGURE",
            2004: "CAMERA_TRACK_POINT",
            2005: "CAMERA_TRACK_RECTANGLE",
            42501: "GIMBAL_RESET",
            60002: "STORM32_DO_GIMBAL_MANAGER_CONTROL_PITCHYAW",
            60010: "STORM32_DO_GIMBAL_MANAGER_SETUP",
        },
    ),
    Group(
        Kind.HARMLESS,
        "It switches lights.",
        {
            405: "ILLUMINATOR_ON_OFF",
            406: "DO_ILLUMINATOR_CONFIGURE",
        },
    ),
    Group(
        Kind.DENIED,
        "It drives motors, servos or relays past the controllers.",
        {
            181: "DO_SET_RELAY",
            182: "DO_REPEAT_RELAY",
            183: "DO_SET_SERVO",
            184: "DO_REPEAT_SERVO",
            187: "DO_SET_ACTUATOR",
            209: "DO_MOTOR_TEST",
            223: "DO_ENGINE_CONTROL",
            310: "ACTUATOR_TEST",
            311: "CONFIGURE_ACTUATOR",
            2520: "AIRFRAME_CONFIGURATION",
            10151: "LOWEHEISER_SET_STATE",
        },
    ),
    Group(
        Kind.DENIED,
        "It presses a switch of the remote control, and there is one for almost everything, "
        "disarming included.",
        {
            218: "DO_AUX_FUNCTION",
        },
    ),
    Group(
        Kind.DENIED,
        "It lets something fall, or changes the vehicle's mass in flight.",
        {
            94: "NAV_PAYLOAD_PLACE",
            211: "DO_GRIPPER",
            216: "DO_SPRAYER",
            30001: "PAYLOAD_PREPARE_DEPLOY",
            30002: "PAYLOAD_CONTROL_DEPLOY",
            42600: "DO_WINCH",
        },
    ),
    Group(
        Kind.DENIED,
        "It works the parachute, which ends the flight and cannot be undone.",
        {
            208: "DO_PARACHUTE",
            60050: "PRS_SET_ARM",
            60070: "PRS_SET_ARM_ALTI",
            60072: "PRS_SHUTDOWN",
        },
    ),
    Group(
        Kind.HARMLESS,
        "It asks what the parachute's state is.",
        {
            60051: "PRS_GET_ARM",
            60052: "PRS_GET_BATTERY",
            60053: "PRS_GET_ERR",
            60071: "PRS_GET_ARM_ALTI",
        },
    ),
    Group(
        Kind.DENIED,
        "It switches the power of something on board.",
        {
            40001: "RESET_MPPT",
            40002: "PAYLOAD_CONTROL",
            42000: "POWER_OFF_INITIATED",
        },
    ),
    Group(
        Kind.DENIED,
        "It erases what the camera stored.",
        {
            526: "STORAGE_FORMAT",
        },
    ),
    Group(
        Kind.DENIED,
        "It calibrates or erases the gimbal's own settings.",
        {
            42503: "GIMBAL_REQUEST_AXIS_CALIBRATION",
            42505: "GIMBAL_FULL_RESET",
        },
    ),
    Group(
        Kind.DENIED,
        "A gimbal sends it, and no station does.",
        {
            42502: "GIMBAL_AXIS_CALIBRATION_STATUS",
        },
    ),
    Group(
        Kind.DENIED,
        "It speaks to other aircraft and to air traffic control in the vehicle's name.",
        {
            10001: "DO_ADSB_OUT_IDENT",
        },
    ),
)
