"""Parameters of flying by hand, of circles and of following."""

from __future__ import annotations

from vehicle_sim.autopilot.parameters.tables.spec import real, whole

# fmt: off
PX4 = (
    real("COM_RC_LOSS_T",    0.5,  0.0,  35.0,  "sticks count as lost after [s]"),
    whole("COM_RC_IN_MODE",  3,    0,    4,     "sticks from: 0 radio 1 joystick 2 either, radio "
                                              "first 3 either, first heard 4 none"),
    whole("COM_RC_OVERRIDE", 1,    0,    3,     "sticks take over: bit 0 from auto modes, "
                                              "bit 1 from offboard"),
    real("COM_RC_STICK_OV",  30.0, 5.0,  80.0,  "stick deflection that takes over [%]"),
    real("FLW_TGT_DST",      8.0,  1.0,  100.0, "follow: horizontal distance [m]"),
    real("FLW_TGT_FA",       180., -180., 180., "follow: angle from the leader's course [deg]"),
    real("FLW_TGT_HT",       8.0,  8.0,  100.0, "follow: height above home or leader [m]"),
    whole("FLW_TGT_ALT_M",   0,    0,    2,     "follow: height 0 above home 2 above the leader"),
    real("FLW_TGT_MAX_VEL",  5.0,  0.0,  20.0,  "follow: speed round the leader [m/s]"),
    real("FLW_TGT_RS",       0.1,  0.0,  1.0,   "follow: smoothing of the leader's motion"),
    whole("MAN_ARM_GESTURE", 1,    0,    1,     "arm and disarm by the throttle stick's corners"),
    real("MC_ACRO_P_MAX",    100., 0.0,  1800., "acro: pitch rate at full stick [deg/s]"),
    real("MC_ACRO_R_MAX",    100., 0.0,  1800., "acro: roll rate at full stick [deg/s]"),
    real("MC_ACRO_Y_MAX",    100., 0.0,  1800., "acro: yaw rate at full stick [deg/s]"),
    real("MC_ORBIT_RAD_MAX", 1000., 1.0, 10000., "largest orbit radius [m]"),
    real("MPC_HOLD_DZ",      0.1,  0.0,  1.0,   "dead zone of the centred sticks"),
    real("MPC_MANTHR_MIN",   0.08, 0.0,  1.0,   "thrust at the lowest throttle stick"),
    real("MPC_MAN_TILT_MAX", 35.0, 1.0,  70.0,  "lean angle at full stick [deg]"),
    real("MPC_MAN_Y_MAX",    150., 0.0,  400.,  "yaw rate at full stick [deg/s]"),
    real("MPC_THR_HOVER",    0.43, 0.1,  0.8,   "thrust in the middle of the throttle stick"),
    real("MPC_THR_MAX",      1.0,  0.0,  1.0,   "thrust at the highest throttle stick"),
    real("MPC_VEL_MANUAL",   10.0, 3.0,  20.0,  "horizontal speed at full stick [m/s]"),
    real("MPC_XY_MAN_EXPO",  0.6,  0.0,  1.0,   "curve of the horizontal sticks, 0 = straight"),
    real("MPC_YAW_EXPO",     0.6,  0.0,  1.0,   "curve of the yaw stick, 0 = straight"),
    real("MPC_Z_MAN_EXPO",   0.6,  0.0,  1.0,   "curve of the climb stick, 0 = straight"),
    whole("RC_MAP_PITCH",    0,    0,    18,    "radio channel of pitch, 0 = none"),
    whole("RC_MAP_ROLL",     0,    0,    18,    "radio channel of roll, 0 = none"),
    whole("RC_MAP_THROTTLE", 0,    0,    18,    "radio channel of throttle, 0 = none"),
    whole("RC_MAP_YAW",      0,    0,    18,    "radio channel of yaw, 0 = none"),
)
ARDUPILOT = (
    real("ACRO_RP_RATE",     360., 1.0,  1080., "acro: roll and pitch rate at full stick [deg/s]"),
    real("ACRO_Y_RATE",      202.5, 1.0, 360.,  "acro: yaw rate at full stick [deg/s]"),
    whole("ANGLE_MAX",       3000, 1000, 8000,  "lean angle at full stick [cdeg]"),
    whole("ARMING_RUDDER",   2,    0,    2,     "yaw stick 0 does nothing 1 arms 2 and disarms"),
    real("CIRCLE_RADIUS",    1000., 0.0, 200000., "circle: radius [cm]"),
    real("CIRCLE_RATE",      20.0, -90.0, 90.0, "circle: turn rate [deg/s], positive clockwise"),
    whole("FLTMODE1",        7,    0,    28,    "mode of the mode channel up to 1230 us"),
    whole("FLTMODE2",        9,    0,    28,    "mode of the mode channel up to 1360 us"),
    whole("FLTMODE3",        6,    0,    28,    "mode of the mode channel up to 1490 us"),
    whole("FLTMODE4",        3,    0,    28,    "mode of the mode channel up to 1620 us"),
    whole("FLTMODE5",        5,    0,    28,    "mode of the mode channel up to 1749 us"),
    whole("FLTMODE6",        0,    0,    28,    "mode of the mode channel above that"),
    whole("FLTMODE_CH",      5,    0,    16,    "mode channel, 0 = none"),
    whole("FOLL_ALT_TYPE",   1,    0,    1,     "follow: leader's height 0 AMSL 1 above home"),
    real("FOLL_DIST_MAX",    100., 1.0,  1000., "follow: a leader farther than this is none [m]"),
    whole("FOLL_ENABLE",     0,    0,    1,     "follow: 1 allows FOLLOW mode"),
    whole("FOLL_OFS_TYPE",   0,    0,    1,     "follow: offset 0 north, east 1 leader's heading"),
    real("FOLL_OFS_X",       0.0,  -100., 100., "follow: offset north or ahead [m]"),
    real("FOLL_OFS_Y",       0.0,  -100., 100., "follow: offset east or right [m]"),
    real("FOLL_OFS_Z",       0.0,  -100., 100., "follow: offset down [m]"),
    whole("FOLL_SYSID",      0,    0,    255,   "follow: leader's system id, 0 = the first heard"),
    whole("FOLL_YAW_BEHAVE", 1,    0,    3,     "follow: 0 keep heading 1 face the leader 2 as the "
                                              "leader 3 along the flight"),
    whole("CIRCLE_OPTIONS",  1,    0,    7,     "circle: 2 nose along the flight 4 round where it "
                                              "is; added up"),
    real("LOIT_ACC_MAX",     500., 100., 981.,  "loiter: acceleration [cm/s^2]"),
    real("LOIT_SPEED",       1250., 20.0, 3500., "loiter: speed at full stick [cm/s]"),
    real("MOT_THST_HOVER",   0.43, 0.125, 0.6875, "thrust in the middle of the throttle stick"),
    real("PILOT_ACCEL_Z",    250,  50,   500,   "vertical acceleration by hand [cm/s^2]"),
    whole("PILOT_SPEED_DN",  0,    0,    500,   "descent at full stick [cm/s], 0 = PILOT_SPEED_UP"),
    whole("PILOT_SPEED_UP",  250,  50,   500,   "climb at full stick [cm/s]"),
    real("PILOT_Y_RATE",     202.5, 1.0, 360.,  "yaw rate at full stick [deg/s]"),
    whole("RCMAP_PITCH",     2,    1,    16,    "radio channel of pitch"),
    whole("RCMAP_ROLL",      1,    1,    16,    "radio channel of roll"),
    whole("RCMAP_THROTTLE",  3,    1,    16,    "radio channel of throttle"),
    whole("RCMAP_YAW",       4,    1,    16,    "radio channel of yaw"),
    real("RC_FS_TIMEOUT",    1.0,  0.5,  10.0,  "sticks count as lost after [s] without any"),
    real("RC_OVERRIDE_TIME", 3.0,  -1.0, 120.0, "overridden channels last [s], -1 ever, 0 never"),
    whole("SYSID_ENFORCE",   0,    0,    1,     "1 obeys the station of SYSID_MYGCS alone"),
    whole("SYSID_MYGCS",     255,  1,    255,   "system id of the station whose sticks count"),
    whole("THR_DZ",          100,  0,    300,   "dead zone of the climb stick [us] each way"),
)
# fmt: on
