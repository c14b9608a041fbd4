"""Parameters of the geofence."""

from __future__ import annotations

from vehicle_sim.autopilot.parameter_tables.spec import whole

# fmt: off
PX4 = (
    whole("GF_ACTION",       0,    0,    0,     "geofence: off"),
)
ARDUPILOT = (
    whole("FENCE_ENABLE",    0,    0,    0,     "geofence: off"),
)
# fmt: on
