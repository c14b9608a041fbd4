"""Parameters of identity, arming, camera, logs and message rates."""

from __future__ import annotations

from vehicle_sim.autopilot.parameters.tables.spec import int8, int16, int32, real

# fmt: off
PX4 = (
    int32("CAL_ACC0_ID",     1310988, 0, 2147483647, "accelerometer; 0 = not calibrated"),
    int32("CAL_GYRO0_ID",    1310988, 0, 2147483647, "gyroscope; 0 = not calibrated"),
    int32("CAL_MAG0_ID",     197388, 0, 2147483647, "magnetometer; 0 = not calibrated"),
    int32("COM_ARM_AUTH_ID", 10,   0,    255,   "system that authorizes arming"),
    int32("COM_ARM_AUTH_MET", 0,   0,    1,     "arm authorization: 0 arm waits 1 arm twice"),
    int32("COM_ARM_AUTH_REQ", 0,   0,    1,     "1 arms only when authorized"),
    real("COM_ARM_AUTH_TO",  1.0,  0.0,  60.0,  "time for the authorizer's answer [s]"),
    int32("COM_ARM_MIS_REQ", 0,    0,    1,     "1 arms only with a mission"),
    int32("MAV_HASH_CHK_EN", 1,    0,    1,     "1 begins a parameter list with its hash"),
    int32("MAV_TYPE",        2,    0,    22,    "what HEARTBEAT says that it is (MAV_TYPE)"),
    int32("SDLOG_MODE",      1,    -1,   2,     "logs: 0 armed 1 from boot until disarmed 2 from "
                                              "boot, -1 = never"),
    real("CAM_EXPOSURE_S",   2.0,  0.0,  60.0,  "time that one picture takes [s]"),
    int32("COM_ARM_WO_GPS",  1,    0,    1,     "1 arms without GPS in modes that need none"),
    real("COM_DISARM_LAND",  2.0,  -1.0, 20.0,  "disarm after landing [s], negative = never"),
    real("COM_DISARM_PRFLT", 10.0, -1.0, 60.0,  "disarm if not taken off [s], negative = never"),
    int32("MAV_SYS_ID",      1,    1,    250,   "MAVLink system id", True),
    int32("SYS_FAILURE_EN",  1,    0,    1,     "1 takes INJECT_FAILURE"),
)
ARDUPILOT = (
    int32("AUTO_OPTIONS",    0,    0,    3,     "AUTO: 1 may be armed in 2 takes off as soon as "
                                              "armed; added up"),
    int8("FRAME_CLASS",      1,    0,    17,    "1: four motors, what it is; else it does not arm",
          True),
    int8("FRAME_TYPE",       0,    0,    19,    "1: motors on a cross, as they are; else it does "
                                              "not arm", True),
    int8("LOG_BACKEND_TYPE",  1,   0,    1,     "logs: 0 none 1 to a file"),
    int8("LOG_DISARMED",     0,    0,    1,     "logs: 0 armed 1 always"),
    int16("SR0_EXTRA1",      0,    0,    50,    "unasked: attitude [Hz]", True),
    int16("SR0_EXTRA2",      0,    0,    50,    "unasked: head-up display [Hz]", True),
    int16("SR0_EXTRA3",      0,    0,    50,    "unasked: battery, clock, estimator [Hz]", True),
    int16("SR0_EXT_STAT",    0,    0,    50,    "unasked: status, GPS, mission [Hz]", True),
    int16("SR0_POSITION",    0,    0,    50,    "unasked: position [Hz]", True),
    int16("SR0_RAW_SENS",    0,    0,    50,    "unasked: sensors [Hz]", True),
    int16("SR0_RC_CHAN",     0,    0,    50,    "unasked: motors and sticks [Hz]", True),
    real("ARMING_ACCTHRESH", 0.75, 0.25, 3.0,   "accelerometer error that prevents arming [m/s^2]"),
    int32("ARMING_CHECK",    1,    0,    2097151, "checks before arming: 1 all, 0 none, or of: "
                                              "2 baro 4 compass 8 GPS 16 inertial 64 sticks "
                                              "128 voltage 256 battery; added up"),
    real("CAM_EXPOSURE_S",   2.0,  0.0,  60.0,  "time that one picture takes [s]"),
    int8("DISARM_DELAY",     10,   0,    127,   "disarm on the ground after [s], 0 = never"),
    int16("SYSID_THISMAV",   1,    1,    255,   "MAVLink system id", True),
)
# fmt: on
