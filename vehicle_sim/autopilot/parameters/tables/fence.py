"""Parameters of the geofence and of rally points."""

from __future__ import annotations

from vehicle_sim.autopilot.parameters.tables.spec import int8, int16, int32, real

# fmt: off
PX4 = (
    int32("GF_ACTION",       2,    0,    5,     "geofence breach: 0 nothing 1 warn 2 hold 3 return "
                                              "4 terminate 5 land"),
    real("GF_MAX_HOR_DIST",  0.0,  0.0,  10000, "geofence: farthest from home [m], 0 = no limit"),
    real("GF_MAX_VER_DIST",  0.0,  0.0,  10000, "geofence: highest above home [m], 0 = no limit"),
    int32("GF_PREDICT",      0,    0,    1,     "geofence: breached if it cannot stop inside"),
    int32("RTL_TYPE",        0,    0,    1,     "return to: 0 the nearest of home and rally points "
                                              "1 the nearest rally point"),
)
ARDUPILOT = (
    int8("FENCE_ACTION",     1,    0,    5,     "fence breach: 0 report 1 return 2 land "
                                              "3 return 4 brake 5 land"),
    real("FENCE_ALT_MAX",    100,  10,   1000,  "fence: highest above home [m]"),
    real("FENCE_ALT_MIN",    -10,  -100, 100,   "fence: lowest above home [m]"),
    int8("FENCE_ENABLE",     0,    0,    1,     "fence: 0 off 1 on"),
    real("FENCE_MARGIN",     2.0,  1.0,  10.0,  "fence: the floor counts from this far above [m]"),
    int16("FENCE_OPTIONS",   0,    0,    3,     "fence: 1 no mode change in a breach, 2 one "
                                              "inclusion zone of several is enough; added up"),
    real("FENCE_RADIUS",     150.0, 30,   10000, "fence: farthest from home [m]"),
    int8("FENCE_TYPE",       7,    0,    15,    "fence: 1 highest 2 circle about home 4 uploaded "
                                              "zones 8 lowest; added up"),
    int8("RALLY_INCL_HOME",  1,    0,    1,     "return to home where it is nearer than any rally "
                                              "point"),
    real("RALLY_LIMIT_KM",   0.3,  0.0,  50.0,  "return to home where no rally point is as near as "
                                              "this [km], 0 = no limit"),
)
# fmt: on
