"""Parameters of speeds, accelerations, heights and ways."""

from __future__ import annotations

from vehicle_sim.autopilot.parameters.tables.spec import int8, int16, int32, real

# fmt: off
PX4 = (
    int32("COM_TAKEOFF_ACT", 0,    0,    1,     "after a take-off: 0 hold 1 mission"),
    real("COM_SPOOLUP_TIME", 1.0,  0.0,  30.0,  "from arming to lift-off at least [s]"),
    real("MIS_DIST_1WP",     900., -1.0, 10000., "a mission's first waypoint farther from home is "
                                              "refused [m], 0 = any"),
    real("MIS_PD_TO",        5.0,  0.0,  1e6,   "DO_GRIPPER and DO_WINCH in a mission are waited "
                                                "for [s]"),
    real("MIS_TAKEOFF_ALT",  2.5,  0.5,  80.0,  "take-off height above home [m]"),
    real("MPC_ACC_DOWN_MAX", 3.0,  2.0,  15.0,  "vertical acceleration down [m/s^2]"),
    real("MPC_ACC_HOR",      3.0,  2.0,  15.0,  "horizontal acceleration [m/s^2]"),
    real("MPC_ACC_UP_MAX",   4.0,  2.0,  15.0,  "vertical acceleration up [m/s^2]"),
    real("MPC_LAND_ALT1",    10.0, 0.0,  122.0, "a landing slows down from this height [m]"),
    real("MPC_LAND_ALT2",    5.0,  0.0,  122.0, "a landing has slowed down at this height [m]"),
    real("MPC_LAND_SPEED",   0.7,  0.6,  3.0,   "landing descent [m/s]"),
    real("MPC_TKO_RAMP_T",   3.0,  0.0,  5.0,   "until a take-off climbs at MPC_TKO_SPEED [s]"),
    real("MPC_TKO_SPEED",    1.5,  1.0,  5.0,   "take-off climb [m/s]"),
    real("MPC_XY_CRUISE",    5.0,  0.5,  20.0,  "horizontal speed of its own flights [m/s]"),
    real("MPC_XY_VEL_MAX",   12.0, 0.5,  20.0,  "highest horizontal speed ever [m/s]"),
    int32("MPC_YAW_MODE",    0,    0,    4,     "mission's heading: 0 next waypoint 1 home "
                                              "2 away from home 3 flight 4 next waypoint"),
    real("MPC_YAWRAUTO_MAX", 45.0, 5.0,  360.0, "turn rate of its own flights [deg/s]"),
    real("MPC_Z_VEL_MAX_DN", 1.5,  0.5,  4.0,   "fastest descent ever, also by hand [m/s]"),
    real("MPC_Z_VEL_MAX_UP", 3.0,  0.5,  8.0,   "fastest climb ever, also by hand [m/s]"),
    real("MPC_Z_V_AUTO_DN",  1.5,  0.5,  4.0,   "descent of its own flights [m/s]"),
    real("MPC_Z_V_AUTO_UP",  3.0,  0.5,  8.0,   "climb of its own flights [m/s]"),
    real("NAV_MC_ALT_RAD",   0.8,  0.05, 200.0, "a take-off ends so near its height [m]"),
    real("NAV_ACC_RAD",      2.0,  0.05, 200.0, "a waypoint counts as reached within [m]"),
    int32("RTL_CONE_ANG",    45,   0,    90,    "return from near: climb into a cone of this half "
                                              "angle [deg], 0 = to RTL_RETURN_ALT"),
    real("RTL_DESCEND_ALT",  10.0, 0.0,  100.0, "return: height at which it waits over home [m]"),
    real("RTL_LAND_DELAY",   0.0,  0.0,  300.0, "return: how long it waits there [s]"),
    real("RTL_MIN_DIST",     10.0, 0.5,  100.0, "return: nearer than this is near [m]"),
    real("RTL_RETURN_ALT",   30.0, 0.0,  150.0, "return: height of the way home [m]"),
)
ARDUPILOT = (
    int16("LAND_ALT_LOW",    1000, 100,  10000, "slow to LAND_SPEED below this height [cm]"),
    int16("LAND_SPEED",      50,   30,   200,   "landing descent [cm/s]"),
    int16("LAND_SPEED_HIGH", 0,    0,    500,   "landing descent above LAND_ALT_LOW [cm/s], "
                                              "0 = WPNAV_SPEED_DN"),
    int8("MIS_RESTART",      0,    0,    1,     "AUTO entered again: 0 goes on 1 starts anew"),
    real("MOT_SPIN_ARM",     0.1,  0.0,  0.2,   "speed of armed motors on the ground"),
    real("MOT_SPOOL_TIME",   0.5,  0.05, 2.0,   "from arming to lift-off at least [s]"),
    real("TKOFF_SLEW_TIME",  2.0,  0.25, 5.0,   "take-off: until the throttle is open [s]"),
    real("PILOT_TKOFF_ALT",  0.0,  0.0,  1000,  "take-off height without a given one [cm]"),
    int32("RTL_ALT",         1500, 30,   300000, "return: height of the way home [cm]"),
    int16("RTL_CLIMB_MIN",   0,    0,    3000,  "return: climb at least [cm]"),
    real("RTL_CONE_SLOPE",   3.0,  0.0,  10.0,  "return from near: climb into a cone so steep, "
                                              "0 = to RTL_ALT"),
    int16("RTL_SPEED",       0,    0,    2000,  "return: speed [cm/s], 0 = WPNAV_SPEED"),
    int16("RTL_ALT_FINAL",   0,    0,    1000,  "return: stay at this height [cm], 0 = land"),
    int32("RTL_LOIT_TIME",   5000, 0,    60000, "return: wait over home [ms]"),
    int8("WP_YAW_BEHAVIOR",  2,    0,    3,     "0 keep heading, else face the next waypoint "
                                              "(2: not on the return)"),
    real("WPNAV_ACCEL",      250,  50,   500,   "horizontal acceleration [cm/s^2]"),
    real("WPNAV_ACCEL_Z",    100.0, 50,   500,   "vertical acceleration [cm/s^2]"),
    real("WPNAV_RADIUS",     200,  5,    1000,  "a waypoint counts as reached within [cm]"),
    real("WPNAV_SPEED",      1000.0, 20,   2000,  "horizontal speed of its own flights [cm/s]"),
    real("WPNAV_SPEED_DN",   150,  10,   500,   "descent [cm/s]"),
    real("WPNAV_SPEED_UP",   250,  10,   1000,  "climb [cm/s]"),
)
# fmt: on
