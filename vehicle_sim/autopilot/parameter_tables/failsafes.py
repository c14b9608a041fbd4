"""Parameters of what it does by itself about battery, silence and lost setpoints."""

from __future__ import annotations

from vehicle_sim.autopilot.parameter_tables.spec import real, whole

# fmt: off
PX4 = (
    real("BAT_CRIT_THR",     0.07, 0.05, 0.5,   "critical battery, part of the charge"),
    real("BAT_EMERGEN_THR",  0.05, 0.03, 0.5,   "emergency battery, part of the charge"),
    real("BAT_LOW_THR",      0.15, 0.12, 0.5,   "low battery, part of the charge"),
    whole("COM_DL_LOSS_T",   10,   5,    300,   "ground station counts as lost after [s]"),
    whole("COM_LOW_BAT_ACT", 0,    0,    3,     "0 warn 2 land when critical 3 return, then land"),
    whole("COM_OBL_RC_ACT",  0,    0,    7,     "offboard loss: 0 position 1 altitude 2 manual "
                                              "3 return 4 land 5 hold 6 terminate 7 disarm"),
    real("COM_OF_LOSS_T",    1.0,  0.0,  60.0,  "setpoints count as lost after [s]"),
    whole("NAV_DLL_ACT",     0,    0,    6,     "station lost: 0 off 1 hold 2 return 3 land "
                                              "5 terminate 6 disarm"),
)
ARDUPILOT = (
    real("BATT_CAPACITY",    5000, 0,    99999, "capacity [mAh]"),
    real("BATT_CRT_MAH",     0.0,  0.0,  99999, "critical battery: charge left [mAh], 0 = off"),
    real("BATT_CRT_VOLT",    0.0,  0.0,  30.0,  "critical battery: voltage [V], 0 = off"),
    whole("BATT_FS_CRT_ACT", 0,    0,    5,     "critical: 0 warn 1 land 2 return 5 terminate"),
    whole("BATT_FS_LOW_ACT", 0,    0,    5,     "low: 0 warn 1 land 2 return 5 terminate"),
    real("BATT_LOW_MAH",     0.0,  0.0,  99999, "low battery: charge left [mAh], 0 = off"),
    real("BATT_LOW_VOLT",    10.5, 0.0,  30.0,  "low battery: voltage [V], 0 = off"),
    whole("FS_GCS_ENABLE",   0,    0,    5,     "station lost: 0 off 1 return 5 land"),
    real("FS_GCS_TIMEOUT",   5.0,  2.0,  120.0, "station counts as lost after [s]"),
    real("GUID_TIMEOUT",     3.0,  0.1,  5.0,   "velocity, attitude setpoints are lost after [s]"),
)
# fmt: on
