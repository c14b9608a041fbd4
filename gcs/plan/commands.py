"""The mission commands (MAV_CMD) that a quadrotor flies, as one table."""

from __future__ import annotations

from enum import Enum

from gcs.wire.ids import Cmd


class Kind(Enum):
    """What an item does to the flight path."""

    MOVE = "flies to a place"
    WAIT = "stays where it is"
    RETURN = "returns to home"
    JUMP = "goes on elsewhere in the mission"
    ACT = "acts without moving"
    SET_HOME = "moves home"
    FENCE = "belongs to a fence or to rally points"


KINDS: dict[int, Kind] = {
    Cmd.NAV_WAYPOINT: Kind.MOVE,
    Cmd.NAV_LOITER_UNLIM: Kind.MOVE,
    Cmd.NAV_LOITER_TURNS: Kind.MOVE,
    Cmd.NAV_LOITER_TIME: Kind.MOVE,
    Cmd.NAV_RETURN_TO_LAUNCH: Kind.RETURN,
    Cmd.NAV_LAND: Kind.MOVE,
    Cmd.NAV_TAKEOFF: Kind.MOVE,
    Cmd.NAV_LOITER_TO_ALT: Kind.MOVE,
    Cmd.NAV_SPLINE_WAYPOINT: Kind.MOVE,
    Cmd.NAV_DELAY: Kind.WAIT,
    Cmd.CONDITION_DELAY: Kind.ACT,
    Cmd.CONDITION_DISTANCE: Kind.ACT,
    Cmd.CONDITION_YAW: Kind.ACT,
    Cmd.DO_JUMP: Kind.JUMP,
    Cmd.JUMP_TAG: Kind.ACT,
    Cmd.DO_JUMP_TAG: Kind.JUMP,
    Cmd.DO_CHANGE_SPEED: Kind.ACT,
    Cmd.DO_SET_HOME: Kind.SET_HOME,
    Cmd.DO_SET_RELAY: Kind.ACT,
    Cmd.DO_REPEAT_RELAY: Kind.ACT,
    Cmd.DO_SET_SERVO: Kind.ACT,
    Cmd.DO_REPEAT_SERVO: Kind.ACT,
    Cmd.DO_GRIPPER: Kind.ACT,
    Cmd.DO_WINCH: Kind.ACT,
    Cmd.DO_LAND_START: Kind.ACT,
    Cmd.DO_SET_ROI_LOCATION: Kind.ACT,
    Cmd.DO_SET_ROI_NONE: Kind.ACT,
    Cmd.DO_SET_ROI: Kind.ACT,
    Cmd.DO_DIGICAM_CONTROL: Kind.ACT,
    Cmd.DO_MOUNT_CONTROL: Kind.ACT,
    Cmd.DO_SET_CAM_TRIGG_DIST: Kind.ACT,
    Cmd.DO_FENCE_ENABLE: Kind.ACT,
    Cmd.SET_CAMERA_MODE: Kind.ACT,
    Cmd.DO_GIMBAL_MANAGER_PITCHYAW: Kind.ACT,
    Cmd.IMAGE_START_CAPTURE: Kind.ACT,
    Cmd.IMAGE_STOP_CAPTURE: Kind.ACT,
    Cmd.NAV_FENCE_RETURN_POINT: Kind.FENCE,
    Cmd.NAV_FENCE_POLYGON_VERTEX_INCLUSION: Kind.FENCE,
    Cmd.NAV_FENCE_POLYGON_VERTEX_EXCLUSION: Kind.FENCE,
    Cmd.NAV_FENCE_CIRCLE_INCLUSION: Kind.FENCE,
    Cmd.NAV_FENCE_CIRCLE_EXCLUSION: Kind.FENCE,
    Cmd.NAV_RALLY_POINT: Kind.FENCE,
}
"""Every item that is flown; what is not in it, a vehicle is expected to refuse."""

FLOWN = (Kind.MOVE, Kind.RETURN, Kind.WAIT)
"""What takes its time in the air."""

WITH_PLACE: frozenset[int] = frozenset(
    {
        *(command for command, kind in KINDS.items() if kind in (Kind.MOVE, Kind.FENCE)),
        Cmd.DO_SET_HOME,
        Cmd.DO_SET_ROI_LOCATION,
        Cmd.DO_SET_ROI,
        Cmd.DO_LAND_START,
        Cmd.NAV_PAYLOAD_PLACE,
    }
)
"""Known commands whose last three parameters are a place, unless their frame says MISSION."""

_KNOWN = frozenset(int(command) for command in Cmd)


def name(command: int) -> str:
    """`NAV_WAYPOINT`, or `MAV_CMD 30001` for a command that is not known here."""
    return Cmd(command).name if command in _KNOWN else f"MAV_CMD {command}"


def item_label(index: int, command: int) -> str:
    """How people are told of an item, which they count from 1: `item 3 (NAV_WAYPOINT)`."""
    return f"item {index + 1} ({name(command)})"


def has_place(command: int, frame_number: int) -> bool:
    """Whether parameters 5 to 7 are a position: the table says it of known commands, the frame of
    all others."""
    if command in _KNOWN:
        return command in WITH_PLACE
    return frame_number != 2
