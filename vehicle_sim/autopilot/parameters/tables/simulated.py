"""Parameters of the autopilots' own simulations, by which their users make things fail."""

from __future__ import annotations

from vehicle_sim.autopilot.parameters.tables.spec import int8, int32, real

# fmt: off
PX4 = (
    real("SIM_BARO_OFF_P",   0.0,  -5000., 5000., "barometer is off by [Pa]"),
    real("SIM_BAT_DRAIN",    60.0, 1.0,  86400., "simulated battery: full to empty in [s]; once "
                                                "it or the next one is changed"),
    real("SIM_BAT_MIN_PCT",  50.0, 0.0,  100.,  "simulated battery: goes no lower than [%]"),
    int32("SIM_GPS_USED",    10,   0,    50,    "satellites; with less than 4 there is no fix"),
    real("SIM_MAG_OFFSET_X", 0.0,  -5.0, 5.0,   "magnetometer is off forwards by [gauss]"),
    real("SIM_MAG_OFFSET_Y", 0.0,  -5.0, 5.0,   "magnetometer is off to the right by [gauss]"),
    real("SIM_MAG_OFFSET_Z", 0.0,  -5.0, 5.0,   "magnetometer is off downwards by [gauss]"),
)
ARDUPILOT = (
    real("SIM_ACC1_BIAS_X",  0.0,  -20., 20.0,  "accelerometer is off forwards by [m/s^2]"),
    real("SIM_ACC1_BIAS_Y",  0.0,  -20., 20.0,  "accelerometer is off to the right by [m/s^2]"),
    real("SIM_ACC1_BIAS_Z",  0.0,  -20., 20.0,  "accelerometer is off downwards by [m/s^2]"),
    int8("SIM_BARO_DISABLE",  0,   0,    1,     "1: no barometer"),
    real("SIM_BARO_GLITCH",  0.0,  -1000., 1000., "barometer is off upwards by [m]"),
    real("SIM_BATT_VOLTAGE", 12.6, 0.0,  16.8,  "voltage of the full battery [V]"),
    int32("SIM_ENGINE_FAIL", 0,    0,    15,    "motors that fail: 1 first 2 second 4 third "
                                              "8 fourth; added up"),
    real("SIM_ENGINE_MUL",   0.0,  0.0,  1.0,   "what is left of the thrust of motors that fail"),
    int8("SIM_GPS_DISABLE",  0,    0,    1,     "1: no GPS"),
    real("SIM_GPS_GLITCH_X", 0.0,  -1.0, 1.0,   "GPS is off to the north by [deg]"),
    real("SIM_GPS_GLITCH_Y", 0.0,  -1.0, 1.0,   "GPS is off to the east by [deg]"),
    real("SIM_GPS_GLITCH_Z", 0.0,  -1000., 1000., "GPS is off upwards by [m]"),
    real("SIM_GYR1_BIAS_X",  0.0,  -3.0, 3.0,   "gyroscope is off in roll by [rad/s]"),
    real("SIM_GYR1_BIAS_Y",  0.0,  -3.0, 3.0,   "gyroscope is off in pitch by [rad/s]"),
    real("SIM_GYR1_BIAS_Z",  0.0,  -3.0, 3.0,   "gyroscope is off in yaw by [rad/s]"),
    int8("SIM_MAG1_FAIL",    0,    0,    1,     "1: no compass"),
    int8("SIM_RC_FAIL",      0,    0,    2,     "radio: 0 one with its throttle at the "
                                              "bottom, after overrides; 1, 2 none"),
    real("SIM_WIND_DIR",     180., 0.0,  360.,  "wind comes from [deg]"),
    real("SIM_WIND_SPD",     0.0,  0.0,  60.0,  "wind [m/s]"),
    real("SIM_WIND_TURB",    0.0,  0.0,  20.0,  "standard deviation of the gusts [m/s]"),
)
# fmt: on
