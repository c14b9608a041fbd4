"""Parameters of identity, arming and camera."""

from __future__ import annotations

from vehicle_sim.autopilot.parameter_tables.spec import real, whole

# fmt: off
PX4 = (
    real("CAM_EXPOSURE_S",   2.0,  0.0,  60.0,  "time that one picture takes [s]"),
    whole("COM_ARM_WO_GPS",  0,    0,    0,     "arming without a position: not allowed"),
    real("COM_DISARM_LAND",  2.0,  -1.0, 20.0,  "disarm after landing [s], negative = never"),
    real("COM_DISARM_PRFLT", 10.0, -1.0, 60.0,  "disarm if not taken off [s], negative = never"),
    whole("MAV_SYS_ID",      1,    1,    250,   "MAVLink system id", True),
)
ARDUPILOT = (
    whole("ARMING_CHECK",    1,    0,    1,     "checks before arming: 1 all, 0 none"),
    real("CAM_EXPOSURE_S",   2.0,  0.0,  60.0,  "time that one picture takes [s]"),
    whole("DISARM_DELAY",    10,   0,    127,   "disarm on the ground after [s], 0 = never"),
    whole("SYSID_THISMAV",   1,    1,    255,   "MAVLink system id", True),
)
# fmt: on
