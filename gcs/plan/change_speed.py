"""Which speed an item of a mission changes (DO_CHANGE_SPEED), by autopilot.

PX4 1.14 ignores the type: every speed is that of the legs (H1b_change_speed_type_ignored of
`scenarios_px4.json`, as a command).  ArduCopter 4.7 has one over ground, one to climb and one to
descend (H1_change_speed of `scenarios_arducopter.json`, as a command).  That a mission's item does
as the command does is from memory of both.
"""

from __future__ import annotations

import math
from typing import Final

from gcs.plan.model import AutopilotName, Item
from gcs.wire.ids import Cmd

_OVER_GROUND: Final = (0.0, 1.0)
_CLIMB, _DESCENT = 2.0, 3.0


def leg_speed_m_s(item: Item, autopilot: AutopilotName) -> float | None:
    """The speed of the legs from here on, zero and less for the vehicle's own; None: no change."""
    kind, speed_m_s, *_ = item.params
    if item.command != Cmd.DO_CHANGE_SPEED or math.isnan(speed_m_s):
        return None
    return speed_m_s if autopilot == "px4" or kind in _OVER_GROUND else None


def climb_and_descent_m_s(item: Item, autopilot: AutopilotName) -> tuple[float, float]:
    """No faster than that it climbs and descends from here on; infinite: no change."""
    kind, speed_m_s, *_ = item.params
    if item.command != Cmd.DO_CHANGE_SPEED or autopilot == "px4" or not speed_m_s > 0.0:
        return math.inf, math.inf
    return (
        speed_m_s if kind == _CLIMB else math.inf,
        speed_m_s if kind == _DESCENT else math.inf,
    )
