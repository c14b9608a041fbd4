"""Parameters of the control loops: gains, and what the loops may ask for.

A gain acts by its ratio to the default: the default is the gain that was designed for the
airframe, because the autopilots' own units mix in their mixers and filters.
"""

from __future__ import annotations

from vehicle_sim.autopilot.parameters.tables.spec import real

# fmt: off
PX4 = (
    real("MC_PITCHRATE_MAX", 220., 0.0,  1800., "pitch rate of the attitude loop [deg/s]"),
    real("MC_PITCHRATE_P",   0.15, 0.01, 0.6,   "gain of the pitch rate loop"),
    real("MC_PITCH_P",       6.5,  0.0,  12.0,  "gain of the pitch loop"),
    real("MC_ROLLRATE_MAX",  220., 0.0,  1800., "roll rate of the attitude loop [deg/s]"),
    real("MC_ROLLRATE_P",    0.15, 0.01, 0.5,   "gain of the roll rate loop"),
    real("MC_ROLL_P",        6.5,  0.0,  12.0,  "gain of the roll loop"),
    real("MC_YAWRATE_MAX",   200., 0.0,  1800., "yaw rate of the attitude loop [deg/s]"),
    real("MC_YAWRATE_P",     0.2,  0.0,  0.6,   "gain of the yaw rate loop"),
    real("MC_YAW_P",         2.8,  0.0,  5.0,   "gain of the yaw loop"),
    real("MPC_JERK_AUTO",    4.0,  3.0,  80.0,  "change of acceleration [m/s^3]"),
    real("MPC_TILTMAX_AIR",  45.0, 20.0, 89.0,  "lean angle, also by hand [deg]"),
    real("MPC_XY_ERR_MAX",   2.0,  1.0,  10.0,  "a flight stands still and waits for a vehicle "
                                              "left behind by [m]"),
    real("MPC_XY_P",         0.95, 0.0,  2.0,   "gain of the horizontal position loop"),
    real("MPC_XY_VEL_I_ACC", 0.4,  0.0,  60.0,  "integral gain of the horizontal velocity loop"),
    real("MPC_XY_VEL_P_ACC", 1.8,  1.2,  5.0,   "gain of the horizontal velocity loop"),
    real("MPC_Z_P",          1.0,  0.1,  1.5,   "gain of the height loop"),
    real("MPC_Z_VEL_I_ACC",  2.0,  0.2,  3.0,   "integral gain of the climb loop"),
    real("MPC_Z_VEL_P_ACC",  4.0,  2.0,  15.0,  "gain of the climb loop"),
)
ARDUPILOT = (
    real("ATC_ANG_PIT_P",    4.5,  3.0,  12.0,  "gain of the pitch loop"),
    real("ATC_ANG_RLL_P",    4.5,  3.0,  12.0,  "gain of the roll loop"),
    real("ATC_ANG_YAW_P",    4.5,  3.0,  12.0,  "gain of the yaw loop"),
    real("ATC_RATE_P_MAX",   0.0,  0.0,  1080., "pitch rate of the attitude loop [deg/s], "
                                              "0 = as designed"),
    real("ATC_RATE_R_MAX",   0.0,  0.0,  1080., "roll rate of the attitude loop [deg/s], "
                                              "0 = as designed"),
    real("ATC_RATE_Y_MAX",   0.0,  0.0,  1080., "yaw rate of the attitude loop [deg/s], "
                                              "0 = as designed"),
    real("ATC_RAT_PIT_P",    0.135, 0.01, 0.5,  "gain of the pitch rate loop"),
    real("ATC_RAT_RLL_P",    0.135, 0.01, 0.5,  "gain of the roll rate loop"),
    real("ATC_RAT_YAW_P",    0.3,  0.1,  2.5,   "gain of the yaw rate loop"),
    real("ATC_SLEW_YAW",     6000, 500,  18000, "turn rate of its own flights [cdeg/s]"),
    real("PSC_ACCZ_I",       1.0,  0.0,  3.0,   "integral gain of the climb loop"),
    real("PSC_JERK_XY",      5.0,  1.0,  20.0,  "jerk of its own flights [m/s^3]"),
    real("PSC_POSXY_P",      1.0,  0.5,  2.0,   "gain of the horizontal position loop"),
    real("PSC_POSZ_P",       1.0,  0.5,  3.0,   "gain of the height loop"),
    real("PSC_VELXY_I",      1.0,  0.02, 1.0,   "integral gain of the horizontal velocity loop"),
    real("PSC_VELXY_P",      2.0,  0.1,  6.0,   "gain of the horizontal velocity loop"),
    real("PSC_VELZ_P",       5.0,  1.5,  8.0,   "gain of the climb loop"),
)
# fmt: on
