"""Every parameter that does something here, one literal table per personality.

Names, units and meanings are the autopilots' own.  Where the value shipped differs from the
firmware's default it is the one that their own simulations set (RTL_RETURN_ALT 30, NAV_ACC_RAD
2), or one that suits a small quadrotor (WPNAV_SPEED, PILOT_TKOFF_ALT).  A safety function that
is not built reports 0, "off", and takes no other value.
"""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Spec:
    """One parameter: `integer` = int32, else float32; bounds inclusive; `reboot` = acts then."""

    name: str
    integer: bool
    default: float
    low: float
    high: float
    what: str
    reboot: bool = False


def _f(name: str, default: float, low: float, high: float, what: str) -> Spec:
    return Spec(name, False, default, low, high, what)


def _i(name: str, default: int, low: int, high: int, what: str, reboot: bool = False) -> Spec:
    return Spec(name, True, default, low, high, what, reboot)


# fmt: off
PX4 = (
    _f("BAT_CRIT_THR",     0.07, 0.05, 0.5,   "critical battery, part of the charge"),
    _f("BAT_EMERGEN_THR",  0.05, 0.03, 0.5,   "emergency battery, part of the charge"),
    _f("BAT_LOW_THR",      0.15, 0.12, 0.5,   "low battery, part of the charge"),
    _f("CAM_EXPOSURE_S",   2.0,  0.0,  60.0,  "time that one picture takes [s]"),
    _i("COM_ARM_WO_GPS",   0,    0,    0,     "arming without a position: not allowed"),
    _f("COM_DISARM_LAND",  2.0,  -1.0, 20.0,  "disarm after landing [s], negative = never"),
    _f("COM_DISARM_PRFLT", 10.0, -1.0, 60.0,  "disarm if not taken off [s], negative = never"),
    _i("COM_DL_LOSS_T",    10,   5,    300,   "ground station counts as lost after [s]"),
    _i("COM_LOW_BAT_ACT",  0,    0,    3,     "0 warn, 2 land when critical, 3 return, then land"),
    _i("COM_OBL_RC_ACT",   0,    0,    7,     "offboard loss: 0 position 1 altitude 2 manual "
                                              "3 return 4 land 5 hold 6 terminate 7 disarm"),
    _f("COM_OF_LOSS_T",    1.0,  0.0,  60.0,  "setpoints count as lost after [s]"),
    _i("GF_ACTION",        0,    0,    0,     "geofence: off"),
    _i("MAV_SYS_ID",       1,    1,    250,   "MAVLink system id", True),
    _f("MIS_TAKEOFF_ALT",  2.5,  0.5,  80.0,  "take-off height above home [m]"),
    _f("MPC_ACC_DOWN_MAX", 3.0,  2.0,  15.0,  "vertical acceleration down [m/s^2]"),
    _f("MPC_ACC_HOR",      3.0,  2.0,  15.0,  "horizontal acceleration [m/s^2]"),
    _f("MPC_ACC_UP_MAX",   4.0,  2.0,  15.0,  "vertical acceleration up [m/s^2]"),
    _f("MPC_LAND_ALT1",    10.0, 0.0,  122.0, "slow to MPC_LAND_SPEED below this height [m]"),
    _f("MPC_LAND_SPEED",   0.7,  0.6,  3.0,   "landing descent [m/s]"),
    _f("MPC_TKO_SPEED",    1.5,  1.0,  5.0,   "take-off climb [m/s]"),
    _f("MPC_XY_CRUISE",    5.0,  0.5,  20.0,  "horizontal speed of its own flights [m/s]"),
    _f("MPC_XY_VEL_MAX",   12.0, 0.5,  20.0,  "highest horizontal speed ever [m/s]"),
    _f("MPC_YAWRAUTO_MAX", 60.0, 5.0,  360.0, "turn rate of its own flights [deg/s]"),
    _f("MPC_Z_VEL_MAX_DN", 1.5,  0.5,  4.0,   "descent [m/s]"),
    _f("MPC_Z_VEL_MAX_UP", 3.0,  0.5,  8.0,   "climb [m/s]"),
    _f("NAV_ACC_RAD",      2.0,  0.05, 200.0, "a waypoint counts as reached within [m]"),
    _i("NAV_DLL_ACT",      0,    0,    6,     "station lost: 0 off 1 hold 2 return 3 land "
                                              "5 terminate 6 disarm"),
    _f("RTL_DESCEND_ALT",  5.0,  0.0,  100.0, "return: height at which it waits over home [m]"),
    _f("RTL_LAND_DELAY",   0.5,  0.0,  300.0, "return: how long it waits there [s]"),
    _f("RTL_RETURN_ALT",   30.0, 0.0,  150.0, "return: height of the way home [m]"),
)
ARDUPILOT = (
    _i("ARMING_CHECK",     1,    0,    1,     "checks before arming: 1 all, 0 none"),
    _f("BATT_CAPACITY",    5000, 0,    99999, "capacity [mAh]"),
    _f("BATT_CRT_MAH",     0.0,  0.0,  99999, "critical battery: charge left [mAh], 0 = off"),
    _f("BATT_CRT_VOLT",    0.0,  0.0,  30.0,  "critical battery: voltage [V], 0 = off"),
    _i("BATT_FS_CRT_ACT",  0,    0,    5,     "critical: 0 warn 1 land 2 return 5 terminate"),
    _i("BATT_FS_LOW_ACT",  0,    0,    5,     "low: 0 warn 1 land 2 return 5 terminate"),
    _f("BATT_LOW_MAH",     0.0,  0.0,  99999, "low battery: charge left [mAh], 0 = off"),
    _f("BATT_LOW_VOLT",    10.5, 0.0,  30.0,  "low battery: voltage [V], 0 = off"),
    _f("CAM_EXPOSURE_S",   2.0,  0.0,  60.0,  "time that one picture takes [s]"),
    _i("DISARM_DELAY",     10,   0,    127,   "disarm on the ground after [s], 0 = never"),
    _i("FENCE_ENABLE",     0,    0,    0,     "geofence: off"),
    _i("FS_GCS_ENABLE",    0,    0,    5,     "station lost: 0 off 1 return 5 land"),
    _f("FS_GCS_TIMEOUT",   5.0,  2.0,  120.0, "station counts as lost after [s]"),
    _f("GUID_TIMEOUT",     3.0,  0.1,  5.0,   "velocity and attitude setpoints are lost after [s]"),
    _f("LAND_ALT_LOW",     1000, 100,  10000, "slow to LAND_SPEED below this height [cm]"),
    _f("LAND_SPEED",       50.0, 30.0, 200.0, "landing descent [cm/s]"),
    _f("PILOT_TKOFF_ALT",  250,  0.0,  1000,  "take-off height without a given one [cm]"),
    _f("RTL_ALT",          1500, 30,   300000, "return: height of the way home [cm]"),
    _i("RTL_ALT_FINAL",    0,    0,    1000,  "return: stay at this height [cm], 0 = land"),
    _i("RTL_LOIT_TIME",    5000, 0,    60000, "return: wait over home [ms]"),
    _i("SYSID_THISMAV",    1,    1,    255,   "MAVLink system id", True),
    _i("WP_YAW_BEHAVIOR",  2,    0,    3,     "0 keep heading, else face the next waypoint "
                                              "(2: not on the return)"),
    _f("WPNAV_ACCEL",      250,  50,   500,   "horizontal acceleration [cm/s^2]"),
    _f("WPNAV_ACCEL_Z",    250,  50,   500,   "vertical acceleration [cm/s^2]"),
    _f("WPNAV_RADIUS",     200,  5,    1000,  "a waypoint counts as reached within [cm]"),
    _f("WPNAV_SPEED",      500,  20,   2000,  "horizontal speed of its own flights [cm/s]"),
    _f("WPNAV_SPEED_DN",   150,  10,   500,   "descent [cm/s]"),
    _f("WPNAV_SPEED_UP",   250,  10,   1000,  "climb [cm/s]"),
)
# fmt: on
