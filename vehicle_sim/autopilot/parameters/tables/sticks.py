"""Parameters of flying by hand, of circles and of following."""

from __future__ import annotations

from vehicle_sim.autopilot.parameters.tables.spec import int8, int16, int32, real

# fmt: off
PX4 = (
    real("COM_RC_LOSS_T",    0.5,  0.0,  35.0,  "sticks count as lost after [s]"),
    int32("COM_RC_IN_MODE",  1,    0,    4,     "sticks from: 0 radio 1 joystick 2 either, radio "
                                              "first 3 either, first heard 4 none"),
    int32("COM_RC_OVERRIDE", 1,    0,    3,     "sticks take over: bit 0 from auto modes, "
                                              "bit 1 from offboard"),
    real("COM_RC_STICK_OV",  30.0, 5.0,  80.0,  "stick deflection that takes over [%]"),
    real("FLW_TGT_DST",      8.0,  1.0,  100.0, "follow: horizontal distance [m]"),
    real("FLW_TGT_FA",       180., -180., 180., "follow: angle from the leader's course [deg]"),
    real("FLW_TGT_HT",       8.0,  8.0,  100.0, "follow: height above home or leader [m]"),
    int32("FLW_TGT_ALT_M",   0,    0,    2,     "follow: height 0 above home 2 above the leader"),
    real("FLW_TGT_MAX_VEL",  5.0,  0.0,  20.0,  "follow: speed round the leader [m/s]"),
    real("FLW_TGT_RS",       0.1,  0.0,  1.0,   "follow: smoothing of the leader's motion"),
    int32("MAN_ARM_GESTURE", 1,    0,    1,     "arm and disarm by the throttle stick's corners"),
    real("MC_ACRO_P_MAX",    720.0, 0.0,  1800., "acro: pitch rate at full stick [deg/s]"),
    real("MC_ACRO_R_MAX",    720.0, 0.0,  1800., "acro: roll rate at full stick [deg/s]"),
    real("MC_ACRO_Y_MAX",    540.0, 0.0,  1800., "acro: yaw rate at full stick [deg/s]"),
    real("MC_ORBIT_RAD_MAX", 1000., 1.0, 10000., "largest orbit radius [m]"),
    real("MPC_HOLD_DZ",      0.1,  0.0,  1.0,   "dead zone of the centred sticks"),
    real("MPC_MANTHR_MIN",   0.08, 0.0,  1.0,   "thrust at the lowest throttle stick"),
    real("MPC_MAN_TILT_MAX", 35.0, 1.0,  70.0,  "lean angle at full stick [deg]"),
    real("MPC_MAN_Y_MAX",    150., 0.0,  400.,  "yaw rate at full stick [deg/s]"),
    real("MPC_THR_HOVER",    0.5,  0.1,  0.8,   "thrust in the middle of the throttle stick"),
    real("MPC_THR_MAX",      1.0,  0.0,  1.0,   "thrust at the highest throttle stick"),
    real("MPC_VEL_MANUAL",   10.0, 3.0,  20.0,  "horizontal speed at full stick [m/s]"),
    real("MPC_XY_MAN_EXPO",  0.6,  0.0,  1.0,   "curve of the horizontal sticks, 0 = straight"),
    real("MPC_YAW_EXPO",     0.6,  0.0,  1.0,   "curve of the yaw stick, 0 = straight"),
    real("MPC_Z_MAN_EXPO",   0.6,  0.0,  1.0,   "curve of the climb stick, 0 = straight"),
    int32("RC_MAP_PITCH",    0,    0,    18,    "radio channel of pitch, 0 = none"),
    int32("RC_MAP_ROLL",     0,    0,    18,    "radio channel of roll, 0 = none"),
    int32("RC_MAP_THROTTLE", 0,    0,    18,    "radio channel of throttle, 0 = none"),
    int32("RC_MAP_YAW",      0,    0,    18,    "radio channel of yaw, 0 = none"),
)
ARDUPILOT = (
    real("ACRO_RP_RATE",     360., 1.0,  1080., "acro: roll and pitch rate at full stick [deg/s]"),
    real("ACRO_Y_RATE",      202.5, 1.0, 360.,  "acro: yaw rate at full stick [deg/s]"),
    int16("ANGLE_MAX",       3000, 1000, 8000,  "lean angle at full stick [cdeg]"),
    int8("ARMING_RUDDER",    2,    0,    2,     "yaw stick 0 does nothing 1 arms 2 and disarms"),
    real("CIRCLE_RADIUS",    1000., 0.0, 200000., "circle: radius [cm]"),
    real("CIRCLE_RATE",      20.0, -90.0, 90.0, "circle: turn rate [deg/s], positive clockwise"),
    int8("FLTMODE1",         7,    0,    28,    "mode of the mode channel up to 1230 us"),
    int8("FLTMODE2",         9,    0,    28,    "mode of the mode channel up to 1360 us"),
    int8("FLTMODE3",         6,    0,    28,    "mode of the mode channel up to 1490 us"),
    int8("FLTMODE4",         3,    0,    28,    "mode of the mode channel up to 1620 us"),
    int8("FLTMODE5",         5,    0,    28,    "mode of the mode channel up to 1749 us"),
    int8("FLTMODE6",         0,    0,    28,    "mode of the mode channel above that"),
    int8("FLTMODE_CH",       5,    0,    16,    "mode channel, 0 = none"),
    int8("FOLL_ALT_TYPE",    1,    0,    1,     "follow: leader's height 0 AMSL 1 above home"),
    real("FOLL_DIST_MAX",    100., 1.0,  1000., "follow: a leader farther than this is none [m]"),
    int8("FOLL_ENABLE",      0,    0,    1,     "follow: 1 allows FOLLOW mode"),
    int8("FOLL_OFS_TYPE",    0,    0,    1,     "follow: offset 0 north, east 1 leader's heading"),
    real("FOLL_OFS_X",       0.0,  -100., 100., "follow: offset north or ahead [m]"),
    real("FOLL_OFS_Y",       0.0,  -100., 100., "follow: offset east or right [m]"),
    real("FOLL_OFS_Z",       0.0,  -100., 100., "follow: offset down [m]"),
    int16("FOLL_SYSID",      0,    0,    255,   "follow: leader's system id, 0 = the first heard"),
    int8("FOLL_YAW_BEHAVE",  1,    0,    3,     "follow: 0 keep heading 1 face the leader 2 as the "
                                              "leader 3 along the flight"),
    int16("CIRCLE_OPTIONS",  1,    0,    7,     "circle: 2 nose along the flight 4 round where it "
                                              "is; added up"),
    real("LOIT_ACC_MAX",     500., 100., 981.,  "loiter: acceleration [cm/s^2]"),
    real("LOIT_SPEED",       1250., 20.0, 3500., "loiter: speed at full stick [cm/s]"),
    real("MOT_THST_HOVER",   0.39, 0.125, 0.6875, "thrust in the middle of the throttle stick"),
    int16("PILOT_ACCEL_Z",   250,  50,   500,   "vertical acceleration by hand [cm/s^2]"),
    int16("PILOT_SPEED_DN",  0,    0,    500,   "descent at full stick [cm/s], 0 = PILOT_SPEED_UP"),
    int16("PILOT_SPEED_UP",  250,  50,   500,   "climb at full stick [cm/s]"),
    real("PILOT_Y_RATE",     202.5, 1.0, 360.,  "yaw rate at full stick [deg/s]"),
    int8("RCMAP_PITCH",      2,    1,    16,    "radio channel of pitch"),
    int8("RCMAP_ROLL",       1,    1,    16,    "radio channel of roll"),
    int8("RCMAP_THROTTLE",   3,    1,    16,    "radio channel of throttle"),
    int8("RCMAP_YAW",        4,    1,    16,    "radio channel of yaw"),
    real("RC_FS_TIMEOUT",    1.0,  0.5,  10.0,  "sticks count as lost after [s] without any"),
    real("RC_OVERRIDE_TIME", 3.0,  -1.0, 120.0, "overridden channels last [s], -1 ever, 0 never"),
    int8("SYSID_ENFORCE",    0,    0,    1,     "1 obeys the station of SYSID_MYGCS alone"),
    int16("SYSID_MYGCS",     255,  1,    255,   "system id of the station whose sticks count"),
    int16("THR_DZ",          100,  0,    300,   "dead zone of the climb stick [us] each way"),
)
# fmt: on
