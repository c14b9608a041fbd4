"""MISSION_ITEM and MISSION_ITEM_INT that are no part of a plan: `current` 2 is a go-to, 3 a height.

ArduPilot's (`GCS_Common.cpp`, `mode_auto.cpp`): MAVProxy's `guided`, DroneKit's `simple_goto`, and
QGroundControl's go-to of older versions.  PX4 knows neither.
"""

from __future__ import annotations

import math
from typing import Final

from gcs.bridge.translate.meaning import Meaning, Reject, Seen
from gcs.bridge.translate.places import DEGREES_PER_UNIT, datum_of, place_of
from gcs.bridge.translate.says import go_to, refuse, unsupported
from gcs.gate.refusal import Code, Refusal
from gcs.wire.ids import Cmd
from gcs.wire.messages import MissionItem, MissionItemInt

GO_TO: Final = 2
CHANGE_HEIGHT: Final = 3


def guided_item(message: MissionItem | MissionItemInt, seen: Seen) -> Meaning:
    """A go-to there, or to another height where it is or flies to."""
    if message.current not in (GO_TO, CHANGE_HEIGHT):
        return refuse(Code.BAD_MISSION, "a mission item that belongs to no upload")
    if seen.autopilot.mode_in_two_parts:
        return unsupported("px4 takes no single mission item: use DO_REPOSITION")
    if message.command != Cmd.NAV_WAYPOINT:
        return unsupported(
            f"command {message.command} as a single item: only NAV_WAYPOINT is flown"
        )
    datum = datum_of(message.frame)
    if isinstance(datum, Refusal):
        return Reject(datum)
    unit = DEGREES_PER_UNIT if isinstance(message, MissionItemInt) else 1.0
    lat_deg, lon_deg = message.x * unit, message.y * unit
    if message.current == CHANGE_HEIGHT:
        lat_deg = lon_deg = math.nan
    elif math.isnan(lat_deg) or math.isnan(lon_deg) or math.isnan(message.z):
        return refuse(Code.NON_FINITE, "a go-to with a coordinate that is no number")
    place_ned = place_of(seen, lat_deg, lon_deg, message.z, datum)
    if isinstance(place_ned, Refusal):
        return Reject(place_ned)
    if message.current == CHANGE_HEIGHT and seen.goal_ned is not None:
        place_ned = (seen.goal_ned[0], seen.goal_ned[1], place_ned[2])
    return go_to(seen, place_ned, None)
