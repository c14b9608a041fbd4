"""Parameters of what it does by itself: battery, silence, lost position, loss of control."""

from __future__ import annotations

from vehicle_sim.autopilot.parameters.tables.spec import int8, int32, real

# fmt: off
PX4 = (
    real("BAT_CRIT_THR",     0.07, 0.05, 1.0,   "critical battery, part of the charge"),
    real("BAT_EMERGEN_THR",  0.05, 0.03, 1.0,   "emergency battery, part of the charge"),
    real("BAT_LOW_THR",      0.15, 0.12, 1.0,   "low battery, part of the charge"),
    real("BAT1_CAPACITY",    -1.0, -1.0, 100000, "capacity [mAh], -1 = the battery tells it"),
    int32("CBRK_FLIGHTTERM", 121212, 0,  121212, "121212: an upset is told, else it terminates"),
    int32("COM_ACT_FAIL_ACT", 0,   0,    4,     "motor failure: 0 warn 1 hold 2 land 3 return "
                                              "4 terminate"),
    int32("COM_DL_LOSS_T",   10,   5,    300,   "ground station counts as lost after [s]"),
    real("COM_FAIL_ACT_T",   5.0,  0.0,  25.0,  "hold for [s] before a failsafe acts"),
    int32("COM_LOW_BAT_ACT", 2,    0,    3,     "0 warn 1 return 2 land when critical 3 return, "
                                              "then land"),
    int32("COM_OBL_RC_ACT",  0,    0,    7,     "offboard loss: 0 position 1 altitude 2 manual "
                                              "3 return 4 land 5 hold 6 terminate 7 disarm"),
    real("COM_OF_LOSS_T",    1.0,  0.0,  60.0,  "setpoints count as lost after [s]"),
    int32("COM_POSCTL_NAVL", 0,    0,    1,     "position lost in position mode: 0 altitude mode "
                                              "1 descend"),
    real("COM_POS_FS_EPH",   5.0,  -1.0, 400.0, "position counts as lost if it may be further off "
                                              "[m], -1 = never"),
    int32("COM_RCL_EXCEPT",  0,    0,    7,     "sticks may be lost in: 1 mission 2 other auto "
                                              "modes 4 offboard; added up"),
    int32("EKF2_NOAID_TOUT", 5000000, 500000, 10000000, "a position is good for so long without "
                                              "a fix [us]"),
    real("EKF2_GYR_B_LIM",   0.15, 0.0,  0.4,   "gyroscope bias: three quarters of it prevent "
                                              "arming [rad/s]"),
    real("EKF2_ABL_LIM",     0.4,  0.0,  0.8,   "accelerometer bias: three quarters of it prevent "
                                              "arming [m/s^2]"),
    int32("FD_ACT_EN",       1,    0,    1,     "1 looks for dead motors"),
    real("FD_ACT_MOT_THR",   0.2,  0.0,  1.0,   "dead motors are looked for above this throttle"),
    int32("FD_ACT_MOT_TOUT", 100,  10,   10000, "a motor counts as dead after [ms]"),
    int32("FD_FAIL_P",       60,   0,    180,   "upset: pitch beyond this [deg], 0 = off"),
    real("FD_FAIL_P_TTRI",   0.3,  0.02, 5.0,   "upset: for so long [s]"),
    int32("FD_FAIL_R",       60,   0,    180,   "upset: roll beyond this [deg], 0 = off"),
    real("FD_FAIL_R_TTRI",   0.3,  0.02, 5.0,   "upset: for so long [s]"),
    int32("NAV_DLL_ACT",     0,    0,    6,     "station lost: 0 off 1 hold 2 return 3 land "
                                              "5 terminate 6 disarm"),
    int32("NAV_RCL_ACT",     2,    1,    6,     "sticks lost: 1 hold 2 return 3 land 5 terminate "
                                              "6 disarm"),
)
ARDUPILOT = (
    int32("BATT_ARM_MAH",    0,    0,    99999, "charge that arming takes [mAh], 0 = any"),
    real("BATT_ARM_VOLT",    0.0,  0.0,  30.0,  "voltage that arming takes [V], 0 = any"),
    int32("BATT_CAPACITY",   3300, 0,    99999, "capacity [mAh]"),
    real("BATT_CRT_MAH",     0.0,  0.0,  99999, "critical battery: charge left [mAh], 0 = off"),
    real("BATT_CRT_VOLT",    0.0,  0.0,  30.0,  "critical battery: voltage [V], 0 = off"),
    int8("BATT_FS_CRT_ACT",  0,    0,    7,     "critical: 0 warn 1 land 2 return 3 return 4 land "
                                              "5 terminate 6 return 7 brake"),
    int8("BATT_FS_LOW_ACT",  0,    0,    7,     "low: 0 warn 1 land 2 return 3 return 4 land "
                                              "5 terminate 6 return 7 brake"),
    real("BATT_LOW_MAH",     0.0,  0.0,  99999, "low battery: charge left [mAh], 0 = off"),
    int8("BATT_MONITOR",     4,    0,    4,     "battery: 0 not measured 3 measured 4 measured"),
    int8("BATT_LOW_TIMER",   10,   0,    120,   "a low voltage counts after [s]"),
    real("BATT_LOW_VOLT",    10.5, 0.0,  30.0,  "low battery: voltage [V], 0 = off"),
    int8("FS_CRASH_CHECK",   1,    0,    1,     "1 disarms after a crash"),
    int8("FS_EKF_ACTION",    1,    0,    3,     "position lost: 0 told 1 land 2 altitude hold "
                                              "3 land from every mode"),
    real("FS_EKF_THRESH",    0.8,  0.0,  1.0,   "estimate is bad from this part of the gates, "
                                              "0 = never"),
    int8("FS_GCS_ENABLE",    0,    0,    7,     "station lost: 0 off 1 return 3 return 4 land "
                                              "5 land 6 return 7 brake"),
    real("FS_GCS_TIMEOUT",   5.0,  2.0,  120.0, "station counts as lost after [s]"),
    int32("FS_OPTIONS",      16,   0,    31,    "goes on: sticks lost 1 in AUTO 4 in GUIDED, "
                                              "station lost 2 in AUTO 16 by hand, 8 landing"),
    int8("FS_THR_ENABLE",    1,    0,    7,     "sticks lost: 0 off 1 return 3 land 4 return "
                                              "5 land 6 return 7 brake"),
    int32("GUID_OPTIONS",    0,    0,    8,     "8: attitude setpoints give thrust, else climb"),
    real("GUID_TIMEOUT",     3.0,  0.1,  5.0,   "velocity, attitude setpoints are lost after [s]"),
)
# fmt: on
