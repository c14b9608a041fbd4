"""What the autopilots keep of an item's four parameters: one row a command that is not kept whole.

Source: read back from PX4 1.14.3 and ArduCopter 4.7 (`scenarios_*.json`, C8_upload_item_kinds and
C1_items_at_zero_position; `behaviour.json`, "MISSION_ITEM with yaw", "NAV_TAKEOFF param1" and
"NAV_LOITER_TIME param3").  Parameters that were not recorded and that the autopilot has no field
for are from memory of PX4's `mavlink_mission.cpp` and ArduPilot's `AP_Mission.cpp`.
"""

from __future__ import annotations

import math
from enum import Enum
from typing import TypeAlias, assert_never

from gcs.float32 import float32
from gcs.plan.model import AutopilotName
from gcs.wire.ids import Cmd

YAW_TOLERANCE_DEG = 1e-3
"""PX4 keeps a heading as float32 radians: 225 degrees come back as 224.99998."""


class Kept(Enum):
    """What is left of a parameter once it was stored."""

    WHOLE = "as it was sent, in float32"
    HEADING = "as a heading: degrees of any number of turns, NaN = not set"
    SIGN = "only its sign; 0 counts as positive"
    NOTHING = "nothing: the autopilot has no use for it"

    def same(self, sent: float, back: float) -> bool:
        """Whether `back` means what `sent` meant."""
        if sent == back:  # most of them
            return True
        match self:
            case Kept.NOTHING:
                return True
            case Kept.SIGN:
                return (sent < 0.0) == (back < 0.0)
            case Kept.HEADING if math.isfinite(sent) and math.isfinite(back):
                return abs(math.remainder(sent - back, 360.0)) <= YAW_TOLERANCE_DEG
            case Kept.WHOLE | Kept.HEADING:
                return (math.isnan(sent) and math.isnan(back)) or float32(sent) == float32(back)
            case _:
                assert_never(self)


Params: TypeAlias = tuple[Kept, Kept, Kept, Kept]

_W, _H, _S, _N = Kept.WHOLE, Kept.HEADING, Kept.SIGN, Kept.NOTHING
_ALL: Params = (_W, _W, _W, _W)

_PX4: dict[int, Params] = {
    Cmd.NAV_WAYPOINT: (_W, _W, _N, _H),
    Cmd.NAV_LOITER_UNLIM: (_N, _N, _W, _H),
    Cmd.NAV_LOITER_TIME: (_W, _W, _W, _N),
    Cmd.NAV_RETURN_TO_LAUNCH: (_N, _N, _N, _N),
    Cmd.NAV_LAND: (_N, _W, _N, _H),
    Cmd.NAV_TAKEOFF: (_N, _N, _N, _H),
    Cmd.NAV_LOITER_TO_ALT: (_W, _W, _N, _W),
}
"""As recorded: the heading through radians, negative ones + 360; the take-off's pitch as 0, and so
the fourth parameter of NAV_LOITER_TIME that was not set."""

_ARDUPILOT: dict[int, Params] = {
    Cmd.NAV_WAYPOINT: (_W, _N, _N, _N),
    Cmd.NAV_LOITER_UNLIM: (_N, _N, _W, _N),
    Cmd.NAV_LOITER_TURNS: (_W, _N, _W, _N),
    Cmd.NAV_LOITER_TIME: (_W, _N, _S, _N),
    Cmd.NAV_RETURN_TO_LAUNCH: (_N, _N, _N, _N),
    Cmd.NAV_LAND: (_W, _N, _N, _N),
    Cmd.NAV_TAKEOFF: (_W, _N, _N, _N),
    Cmd.NAV_LOITER_TO_ALT: (_N, _W, _N, _N),
    Cmd.NAV_SPLINE_WAYPOINT: (_W, _N, _N, _N),
    Cmd.CONDITION_DELAY: (_W, _N, _N, _N),
    Cmd.DO_JUMP: (_W, _W, _N, _N),
    Cmd.DO_CHANGE_SPEED: (_W, _W, _N, _N),
    Cmd.DO_SET_HOME: (_W, _N, _N, _N),
    Cmd.DO_SET_RELAY: (_W, _W, _N, _N),
    Cmd.DO_REPEAT_RELAY: (_W, _W, _W, _N),
    Cmd.DO_SET_SERVO: (_W, _W, _N, _N),
    Cmd.DO_SET_CAM_TRIGG_DIST: (_W, _N, _W, _N),
    Cmd.DO_GRIPPER: (_W, _W, _N, _N),
    Cmd.JUMP_TAG: (_W, _N, _N, _N),
    Cmd.DO_JUMP_TAG: (_W, _W, _N, _N),
    Cmd.IMAGE_START_CAPTURE: (_N, _W, _W, _N),
}
"""As recorded: NAV_LOITER_TIME's radius as 1 or -1, NAV_LAND's fourth parameter as 1.
Those of relays, servos, grippers and tags were asked of the same ArduCopter with other values than
C8 has; DO_REPEAT_SERVO and DO_WINCH keep all four."""

_KEPT: dict[AutopilotName, dict[int, Params]] = {"px4": _PX4, "ardupilot": _ARDUPILOT}


def kept(command: int, autopilot: AutopilotName) -> Params:
    """What the autopilot keeps of parameters 1 to 4; of commands that have no row, all."""
    return _KEPT[autopilot].get(command, _ALL)
