"""Messages that decide where a vehicle believes to be and what it sees around it."""

from __future__ import annotations

from gcs.bridge.catalog.row import Group, Kind

ESTIMATOR: tuple[Group, ...] = (
    Group(
        Kind.DENIED,
        "It feeds the estimator: who sends it decides where the vehicle believes to be.",
        {
            100: "OPTICAL_FLOW",
            101: "GLOBAL_VISION_POSITION_ESTIMATE",
            102: "VISION_POSITION_ESTIMATE",
            103: "VISION_SPEED_ESTIMATE",
            104: "VICON_POSITION_ESTIMATE",
            106: "OPTICAL_FLOW_RAD",
            123: "GPS_INJECT_DATA",
            138: "ATT_POS_MOCAP",
            232: "GPS_INPUT",
            295: "AIRSPEED",
            296: "GLOBAL_POSITION_SENSOR",
            331: "ODOMETRY",
            513: "RANGING_BEACON",
            9000: "WHEEL_DISTANCE",
            11011: "VISION_POSITION_DELTA",
        },
    ),
    Group(
        Kind.DENIED,
        "It stands for the world in a simulation with hardware: who sends it decides what the "
        "vehicle senses.",
        {
            90: "HIL_STATE",
            91: "HIL_CONTROLS",
            92: "HIL_RC_INPUTS_RAW",
            93: "HIL_ACTUATOR_CONTROLS",
            107: "HIL_SENSOR",
            108: "SIM_STATE",
            113: "HIL_GPS",
            114: "HIL_OPTICAL_FLOW",
            115: "HIL_STATE_QUATERNION",
            164: "SIMSTATE",
        },
    ),
    Group(
        Kind.DENIED,
        "It is a distance or an obstacle: avoidance and height keeping fly by it (from memory).",
        {
            132: "DISTANCE_SENSOR",
            173: "RANGEFINDER",
            330: "OBSTACLE_DISTANCE",
            11037: "OBSTACLE_DISTANCE_3D",
        },
    ),
    Group(
        Kind.DENIED,
        "It is a height of the ground, which terrain following and returns fly by (from memory).",
        {
            134: "TERRAIN_DATA",
        },
    ),
    Group(
        Kind.DENIED,
        "The vehicle would fly to it or with it, and where it will be nobody knows.",
        {
            144: "FOLLOW_TARGET",
            149: "LANDING_TARGET",
        },
    ),
    Group(
        Kind.DENIED,
        "It is another aircraft's or ship's position: follow modes and avoidance fly by it "
        "(from memory).",
        {
            33: "GLOBAL_POSITION_INT",
            246: "ADSB_VEHICLE",
            247: "COLLISION",
            301: "AIS_VESSEL",
            340: "UTM_GLOBAL_POSITION",
        },
    ),
)
