"""Where this vehicle's parameters differ from those of the real autopilots, and why.

The other tables have the defaults that PX4 1.14.3 and ArduCopter 4.7.0-dev (with copter.parm)
listed in their own simulations.  These few defaults are replaced, because this vehicle has
another airframe and battery, or because its guidance and loops are others.
"""

from __future__ import annotations

from vehicle_sim.autopilot.modes import Personality

DELIBERATE: dict[Personality, dict[str, tuple[float, str]]] = {
    "px4": {
        "MPC_THR_HOVER": (0.43, "the thrust at which the simulated airframe hovers"),
        "MPC_XY_ERR_MAX": (4.0, "guidance waits for a vehicle left behind by so much, in a wind"),
        "SDLOG_MODE": (0.0, "logs from arming on: a log of every vehicle from boot fills memories"),
    },
    "ardupilot": {
        "BATT_CAPACITY": (5000.0, "the simulated battery's"),
        "FRAME_TYPE": (1.0, "the simulated airframe's motors are on a cross, not on a plus"),
        "MOT_THST_HOVER": (0.43, "the thrust at which the simulated airframe hovers"),
        "SIM_BATT_VOLTAGE": (16.8, "the simulated battery has four cells, not three"),
    },
}
"""By name: the default here, and the reason."""

_FOLLOW = "listed by the real one only when FOLL_ENABLE is 1"

NOT_LISTED: dict[Personality, dict[str, str]] = {
    "px4": {
        "CAM_EXPOSURE_S": "of the simulated camera, which is a device of its own in life",
    },
    "ardupilot": {
        "CAM_EXPOSURE_S": "of the simulated camera, which is a device of its own in life",
        "FOLL_ALT_TYPE": _FOLLOW,
        "FOLL_DIST_MAX": _FOLLOW,
        "FOLL_OFS_TYPE": _FOLLOW,
        "FOLL_OFS_X": _FOLLOW,
        "FOLL_OFS_Y": _FOLLOW,
        "FOLL_OFS_Z": _FOLLOW,
        "FOLL_SYSID": _FOLLOW,
        "FOLL_YAW_BEHAVE": _FOLLOW,
    },
}
"""Parameters that the real ones did not list, and why."""
