"""Every parameter that does something here, in literal tables: a file a subject.

Names, units and meanings are the autopilots' own.  Where the value shipped differs from the
firmware's default it is the one that their own simulations set (RTL_RETURN_ALT 30, NAV_ACC_RAD
2), or one that suits a small quadrotor (WPNAV_SPEED, PILOT_TKOFF_ALT) and its guidance
(MPC_JERK_AUTO, MPC_XY_ERR_MAX, whose lower bounds are what it can fly with; MOT_SPIN_ARM).
AUTO_OPTIONS 1 lets AUTO be armed in.  A parameter that would do nothing is not there.
"""

from __future__ import annotations

from vehicle_sim.autopilot.parameters.tables import (
    failsafes,
    fence,
    flight,
    loops,
    simulated,
    sticks,
    system,
)
from vehicle_sim.autopilot.parameters.tables.spec import ParameterSpec

_SUBJECTS = (failsafes, fence, flight, loops, simulated, sticks, system)


def _by_name(specs: list[ParameterSpec]) -> tuple[ParameterSpec, ...]:
    return tuple(sorted(specs, key=lambda spec: spec.name))


PX4 = _by_name([spec for subject in _SUBJECTS for spec in subject.PX4])
ARDUPILOT = _by_name([spec for subject in _SUBJECTS for spec in subject.ARDUPILOT])

__all__ = ["ARDUPILOT", "PX4", "ParameterSpec"]
