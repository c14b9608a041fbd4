"""How each mission item is flown, by autopilot and version: one row a MAV_CMD, none missing.

Sources: C8_upload_item_kinds, C9 and C11 of `scenarios_px4.json` (PX4 1.14.3) and C8, C1 and C2 of
`scenarios_arducopter.json` (ArduCopter 4.7) for what is taken at upload and how it was flown.  What
PX4 1.15 and ArduCopter 4.5 do was not recorded: those columns are from memory of their sources, and
differ from the recorded ones nowhere that is known.  From memory, too: that a PX4 waits for its
gripper or winch (MIS_PD_TO), and what NAV_PAYLOAD_PLACE does.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from enum import Enum
from types import MappingProxyType

from gcs.plan.model import AutopilotName
from gcs.wire.ids import Cmd


class Flown(Enum):
    """What the vehicle does; the values are for people."""

    STRAIGHT = "straight to the place, and turns before it by the acceptance radius"
    STAYS = "straight to the place, and stays there"
    TAKE_OFF = "straight up to the height; its place is ignored"
    TAKE_OFF_THEN_PLACE = "straight up to the height, then level to its place"
    LAND = "level to over the place, then down to the ground"
    CIRCLE = "to the nearest point of the circle, then round it"
    CURVE = "a curve: cubic Hermite, with the tangents of the neighbours"
    LEVEL_THEN_HEIGHT = "level to over the place, then up or down"
    RETURN = "up to the return height, straight to home or the nearest rally point, down"
    WAITS = "stays where it is"
    JUMPS = "goes on elsewhere in the mission"
    NO_MOVE = "does not move"
    DESCENDS = (
        "descends by itself until it feels the ground: refused here, as nobody knows the height"
    )
    MOVES_HOME = "moves home: refused here, as return, heights and fence move too"
    SWITCHES_FENCE = "switches the vehicle's own fence"
    FENCE_PART = "is no mission item: a fence or rally points"
    REFUSED = "refused by the vehicle at upload"
    NEVER_STARTS = "stored, and then the mission is not started"


@dataclass(frozen=True, slots=True)
class Row:
    """One MAV_CMD in four firmwares."""

    command: Cmd
    px4_1_14: Flown
    px4_1_15: Flown
    copter_4_5: Flown
    copter_4_7: Flown


VERSIONS = ("PX4 1.14", "PX4 1.15", "ArduCopter 4.5", "ArduCopter 4.7")

_F = Flown


def _both(command: Cmd, px4: Flown, copter: Flown) -> Row:
    return Row(command, px4, px4, copter, copter)


def _all(command: Cmd, flown: Flown) -> Row:
    return _both(command, flown, flown)


ROWS: tuple[Row, ...] = (
    _all(Cmd.NAV_WAYPOINT, _F.STRAIGHT),
    _all(Cmd.NAV_LOITER_UNLIM, _F.STAYS),
    _both(Cmd.NAV_LOITER_TURNS, _F.REFUSED, _F.CIRCLE),
    _all(Cmd.NAV_LOITER_TIME, _F.STAYS),
    _all(Cmd.NAV_RETURN_TO_LAUNCH, _F.RETURN),
    _all(Cmd.NAV_LAND, _F.LAND),
    _both(Cmd.NAV_TAKEOFF, _F.TAKE_OFF_THEN_PLACE, _F.TAKE_OFF),
    _all(Cmd.NAV_LOITER_TO_ALT, _F.LEVEL_THEN_HEIGHT),
    _both(Cmd.NAV_SPLINE_WAYPOINT, _F.REFUSED, _F.CURVE),
    _all(Cmd.NAV_DELAY, _F.WAITS),
    _both(Cmd.CONDITION_DELAY, _F.NEVER_STARTS, _F.NO_MOVE),
    _both(Cmd.CONDITION_DISTANCE, _F.NEVER_STARTS, _F.NO_MOVE),
    _both(Cmd.CONDITION_YAW, _F.REFUSED, _F.NO_MOVE),
    _all(Cmd.DO_JUMP, _F.JUMPS),
    _both(Cmd.JUMP_TAG, _F.REFUSED, _F.NO_MOVE),
    _both(Cmd.DO_JUMP_TAG, _F.REFUSED, _F.JUMPS),
    _all(Cmd.DO_CHANGE_SPEED, _F.NO_MOVE),
    _all(Cmd.DO_SET_HOME, _F.MOVES_HOME),
    _both(Cmd.DO_SET_RELAY, _F.REFUSED, _F.NO_MOVE),
    _both(Cmd.DO_REPEAT_RELAY, _F.REFUSED, _F.NO_MOVE),
    _both(Cmd.DO_SET_SERVO, _F.REFUSED, _F.NO_MOVE),
    _both(Cmd.DO_REPEAT_SERVO, _F.REFUSED, _F.NO_MOVE),
    _both(Cmd.DO_GRIPPER, _F.WAITS, _F.NO_MOVE),
    _both(Cmd.DO_WINCH, _F.WAITS, _F.NO_MOVE),
    _both(Cmd.NAV_PAYLOAD_PLACE, _F.REFUSED, _F.DESCENDS),
    _all(Cmd.DO_LAND_START, _F.NO_MOVE),
    _all(Cmd.DO_SET_ROI_LOCATION, _F.NO_MOVE),
    _all(Cmd.DO_SET_ROI_NONE, _F.NO_MOVE),
    _all(Cmd.DO_SET_ROI, _F.NO_MOVE),
    _all(Cmd.DO_DIGICAM_CONTROL, _F.NO_MOVE),
    _all(Cmd.DO_MOUNT_CONTROL, _F.NO_MOVE),
    _all(Cmd.DO_SET_CAM_TRIGG_DIST, _F.NO_MOVE),
    _both(Cmd.DO_FENCE_ENABLE, _F.REFUSED, _F.SWITCHES_FENCE),
    _both(Cmd.SET_CAMERA_MODE, _F.NO_MOVE, _F.REFUSED),
    _all(Cmd.DO_GIMBAL_MANAGER_PITCHYAW, _F.NO_MOVE),
    _all(Cmd.IMAGE_START_CAPTURE, _F.NO_MOVE),
    _all(Cmd.IMAGE_STOP_CAPTURE, _F.NO_MOVE),
    _all(Cmd.NAV_FENCE_RETURN_POINT, _F.FENCE_PART),
    _all(Cmd.NAV_FENCE_POLYGON_VERTEX_INCLUSION, _F.FENCE_PART),
    _all(Cmd.NAV_FENCE_POLYGON_VERTEX_EXCLUSION, _F.FENCE_PART),
    _all(Cmd.NAV_FENCE_CIRCLE_INCLUSION, _F.FENCE_PART),
    _all(Cmd.NAV_FENCE_CIRCLE_EXCLUSION, _F.FENCE_PART),
    _all(Cmd.NAV_RALLY_POINT, _F.FENCE_PART),
)

_BY_AUTOPILOT: Mapping[AutopilotName, Mapping[int, Flown]] = MappingProxyType(
    {
        "px4": MappingProxyType({int(row.command): row.px4_1_14 for row in ROWS}),
        "ardupilot": MappingProxyType({int(row.command): row.copter_4_7 for row in ROWS}),
    }
)
"""By the recorded version: the others do the same, as far as is known."""


def flown_as(command: int, autopilot: AutopilotName) -> Flown | None:
    """What the autopilot does with the item; None for one that is not in the table."""
    return _BY_AUTOPILOT[autopilot].get(command)
