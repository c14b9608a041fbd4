"""What mission items mean: which can be flown, where they are, and what of them is refused."""

from __future__ import annotations

from dataclasses import dataclass, replace
from enum import Enum, auto
from math import isfinite

from vehicle_sim.autopilot.geo import Projection
from vehicle_sim.autopilot.interface import Geodetic, PlanItem
from vehicle_sim.autopilot.modes import Personality
from vehicle_sim.autopilot.rules import RULES, AutopilotRules
from vehicle_sim.numerics.vectors import Vec3


class Cmd:
    """MAV_CMD of the items that are understood, with their numbers."""

    WAYPOINT = 16
    LOITER_UNLIM = 17
    LOITER_TURNS = 18
    LOITER_TIME = 19
    RETURN = 20
    LAND = 21
    TAKEOFF = 22
    LOITER_TO_ALT = 31
    SPLINE = 82
    GUIDED_ENABLE = 92
    DELAY = 93
    PAYLOAD_PLACE = 94
    CONDITION_DELAY = 112
    CONDITION_DISTANCE = 114
    CONDITION_YAW = 115
    JUMP = 177
    CHANGE_SPEED = 178
    SET_HOME = 179
    SET_RELAY = 181
    REPEAT_RELAY = 182
    SET_SERVO = 183
    REPEAT_SERVO = 184
    LAND_START = 189
    ROI_LOCATION = 195
    ROI_NONE = 197
    ROI = 201
    DIGICAM_CONTROL = 203
    MOUNT_CONTROL = 205
    CAM_TRIGG_DIST = 206
    FENCE_ENABLE = 207
    PARACHUTE = 208
    GRIPPER = 211
    AUX_FUNCTION = 218
    GUIDED_LIMITS = 222
    SET_CAMERA_MODE = 530
    JUMP_TAG = 600
    DO_JUMP_TAG = 601
    SET_CAMERA_ZOOM = 531
    SET_CAMERA_FOCUS = 532
    GIMBAL_PITCHYAW = 1000
    IMAGE_START = 2000
    IMAGE_STOP = 2001
    FENCE_RETURN_POINT = 5000
    WINCH = 42600


class ItemKind(Enum):
    """FLOWN: takes the vehicle somewhere, or lets it wait there.  WAITED: a condition for what
    follows it.  DONE: happens at once.  NOTHING: no such equipment."""

    FLOWN = auto()
    WAITED = auto()
    DONE = auto()
    NOTHING = auto()


KINDS: dict[int, ItemKind] = {
    Cmd.WAYPOINT: ItemKind.FLOWN,
    Cmd.LOITER_UNLIM: ItemKind.FLOWN,
    Cmd.LOITER_TURNS: ItemKind.FLOWN,
    Cmd.LOITER_TIME: ItemKind.FLOWN,
    Cmd.RETURN: ItemKind.FLOWN,
    Cmd.LAND: ItemKind.FLOWN,
    Cmd.TAKEOFF: ItemKind.FLOWN,
    Cmd.LOITER_TO_ALT: ItemKind.FLOWN,
    Cmd.SPLINE: ItemKind.FLOWN,
    Cmd.DELAY: ItemKind.FLOWN,
    Cmd.GUIDED_ENABLE: ItemKind.FLOWN,
    Cmd.PAYLOAD_PLACE: ItemKind.FLOWN,
    Cmd.CONDITION_DELAY: ItemKind.WAITED,
    Cmd.CONDITION_DISTANCE: ItemKind.WAITED,
    Cmd.CONDITION_YAW: ItemKind.WAITED,
    Cmd.JUMP: ItemKind.DONE,
    Cmd.CHANGE_SPEED: ItemKind.DONE,
    Cmd.SET_HOME: ItemKind.DONE,
    Cmd.LAND_START: ItemKind.DONE,
    Cmd.ROI_LOCATION: ItemKind.DONE,
    Cmd.ROI_NONE: ItemKind.DONE,
    Cmd.ROI: ItemKind.DONE,
    Cmd.DIGICAM_CONTROL: ItemKind.DONE,
    Cmd.CAM_TRIGG_DIST: ItemKind.DONE,
    Cmd.IMAGE_START: ItemKind.DONE,
    Cmd.IMAGE_STOP: ItemKind.DONE,
    Cmd.FENCE_ENABLE: ItemKind.DONE,
    Cmd.SET_RELAY: ItemKind.DONE,
    Cmd.REPEAT_RELAY: ItemKind.DONE,
    Cmd.SET_SERVO: ItemKind.DONE,
    Cmd.REPEAT_SERVO: ItemKind.DONE,
    Cmd.PARACHUTE: ItemKind.DONE,
    Cmd.GRIPPER: ItemKind.DONE,
    Cmd.AUX_FUNCTION: ItemKind.DONE,
    Cmd.GUIDED_LIMITS: ItemKind.DONE,
    Cmd.JUMP_TAG: ItemKind.DONE,
    Cmd.DO_JUMP_TAG: ItemKind.DONE,
    Cmd.WINCH: ItemKind.DONE,
    Cmd.MOUNT_CONTROL: ItemKind.NOTHING,
    Cmd.SET_CAMERA_MODE: ItemKind.NOTHING,
    Cmd.SET_CAMERA_ZOOM: ItemKind.NOTHING,
    Cmd.SET_CAMERA_FOCUS: ItemKind.NOTHING,
    Cmd.GIMBAL_PITCHYAW: ItemKind.NOTHING,
    Cmd.FENCE_RETURN_POINT: ItemKind.NOTHING,
}

_UNKNOWN: dict[Personality, frozenset[int]] = {
    "px4": frozenset(
        {
            Cmd.GUIDED_ENABLE,
            Cmd.PAYLOAD_PLACE,
            Cmd.SET_RELAY,
            Cmd.REPEAT_RELAY,
            Cmd.SET_SERVO,
            Cmd.REPEAT_SERVO,
            Cmd.PARACHUTE,
            Cmd.AUX_FUNCTION,
            Cmd.GUIDED_LIMITS,
            Cmd.JUMP_TAG,
            Cmd.DO_JUMP_TAG,
        }
    ),
    "ardupilot": frozenset(),
}
"""Items of `KINDS` that one of the two refuses at upload, as recorded (C8_upload_item_kinds)."""

_PLACED = frozenset(
    {
        Cmd.WAYPOINT,
        Cmd.LOITER_UNLIM,
        Cmd.LOITER_TURNS,
        Cmd.LOITER_TIME,
        Cmd.LOITER_TO_ALT,
        Cmd.LAND,
        Cmd.TAKEOFF,
        Cmd.SPLINE,
        Cmd.PAYLOAD_PLACE,
        Cmd.ROI_LOCATION,
    }
)
_HERE_IF_ZERO = frozenset(
    {Cmd.LAND, Cmd.TAKEOFF, Cmd.LOITER_UNLIM, Cmd.LOITER_TIME, Cmd.LOITER_TO_ALT}
)
_HERE_IF_ZERO_COPTER = _HERE_IF_ZERO | {
    Cmd.WAYPOINT,
    Cmd.LOITER_TURNS,
    Cmd.SPLINE,
    Cmd.PAYLOAD_PLACE,
}
# Recorded of waypoints and splines; LOITER_TO_ALT goes to the height 0 (from memory).
_KEEPS_HEIGHT = _HERE_IF_ZERO_COPTER - {Cmd.TAKEOFF, Cmd.LAND, Cmd.LOITER_TO_ALT}
_SPEED_TYPES = frozenset({0.0, 1.0, 2.0, 3.0})  # SPEED_TYPE: air, ground, climb, descent

_GLOBAL = frozenset({0, 5})  # MAV_FRAME_GLOBAL, _INT: metres above mean sea level
_RELATIVE = frozenset({3, 6})  # MAV_FRAME_GLOBAL_RELATIVE_ALT, _INT: metres above home
_TERRAIN = frozenset({10, 11})  # MAV_FRAME_GLOBAL_TERRAIN_ALT, _INT: metres above the terrain
_LOCAL_NED = 1
_MISSION = 2  # without coordinates
_NO_PLACE = 0x7FFFFFFF
_LONGEST_S = 1e6
_MOST_TURNS = 1e4


@dataclass(frozen=True, slots=True)
class Datum:
    """What positions are relative to; `zero_keeps_height`: an item's altitude of 0 says none."""

    projection: Projection
    origin: Geodetic
    home_ned: Vec3
    zero_keeps_height: bool


_HERE: dict[Personality, frozenset[int]] = {
    "px4": _HERE_IF_ZERO,
    "ardupilot": _HERE_IF_ZERO_COPTER,
}
"""Items that are flown where the vehicle is, if they say 0, 0."""


def check(items: tuple[PlanItem, ...], personality: Personality) -> tuple[int, str] | None:
    """(seq, why) of the first item that cannot be flown, None when all can."""
    for index, item in enumerate(items):
        if index < RULES[personality].first_mission_item:
            continue
        why = _why_not(item, len(items), personality)
        if why is not None:
            return (item.seq, why)
    return None


def by_terrain(item: PlanItem) -> bool:
    """Its height counts from the terrain below it."""
    return item.command in _PLACED and item.frame in _TERRAIN


def infeasible(items: tuple[PlanItem, ...]) -> bool:
    """PX4 stores it, and does not fly it: it waits for a condition, takes off in between, or
    begins with a landing."""
    flown = [item.command for item in items if KINDS[item.command] is ItemKind.FLOWN]
    waits = any(KINDS[item.command] is ItemKind.WAITED for item in items)
    return waits or Cmd.TAKEOFF in flown[1:] or Cmd.LAND in flown[:1]


def _why_not(item: PlanItem, count: int, personality: Personality) -> str | None:
    rules = RULES[personality]
    frames = _GLOBAL | _RELATIVE | {_LOCAL_NED} | (_TERRAIN if rules.terrain_items else frozenset())
    unknown = item.command not in KINDS or item.command in _UNKNOWN[personality]
    if unknown or (item.command == Cmd.SPLINE and not rules.flies_splines):
        return f"command {item.command} is not supported"
    if item.command in _PLACED:
        if item.frame not in frames:
            return f"frame {item.frame} is not supported"
        if rules.items_need_sound_place and not isfinite(item.z):
            return "the altitude is not a number"
        somewhere = item.frame != _LOCAL_NED and has_place(item)
        if rules.items_need_sound_place and somewhere and not _on_earth(item):
            return "the position is not on Earth"
        if not has_place(item) and item.command not in _HERE[personality]:
            return "the position is missing"
    elif item.frame not in frames | {_MISSION}:
        return f"frame {item.frame} is not supported"
    elif _needs_mission_frame(item, rules) and item.frame not in (_MISSION, _LOCAL_NED):
        return f"frame {item.frame} is not supported for an item without a place"
    return _why_not_values(item, count, rules)


def _needs_mission_frame(item: PlanItem, rules: AutopilotRules) -> bool:
    """PX4 takes DO_SET_ROI in global frames alone, and all else that has no place in frame 2.

    Frame 1 is vehicle-sim's own.
    """
    return rules.placeless_in_mission_frame and item.command != Cmd.ROI


def _why_not_values(item: PlanItem, count: int, rules: AutopilotRules) -> str | None:
    match item.command:
        case Cmd.JUMP:
            there = rules.jumps_may_lead_beyond or 1 <= item.p1 < count
            if not isfinite(item.p1) or not there:
                return f"jump to item {item.p1:g}, which is not there"
            if not isfinite(item.p2) or item.p2 < -1:
                return f"{item.p2:g} repetitions"
        case Cmd.CHANGE_SPEED:
            # PX4 ignores the type (H1b_change_speed_type_ignored, as a command) and looks at none
            # at upload (C8); ArduPilot knows these four (H1_change_speed, its AUTO from memory).
            if rules.mission_speeds_have_type and item.p1 not in _SPEED_TYPES:
                return f"speed of type {item.p1:g}"
            if not isfinite(item.p2) or (item.p2 <= 0.0 and item.p2 not in (-1.0, -2.0)):
                return f"speed {item.p2:g} m/s"
        case Cmd.WAYPOINT | Cmd.LOITER_TIME | Cmd.SPLINE:
            if isfinite(item.p1) and not 0.0 <= item.p1 <= _LONGEST_S:
                return f"time {item.p1:g} s"
        case Cmd.DELAY:
            if item.p1 == -1.0:
                return "a delay until a time of day"
            if not 0.0 <= item.p1 <= _LONGEST_S:
                return f"time {item.p1:g} s"
        case Cmd.CONDITION_DELAY:
            if not 0.0 <= item.p1 <= _LONGEST_S:
                return f"time {item.p1:g} s"
        case Cmd.CONDITION_DISTANCE:
            if not isfinite(item.p1) or item.p1 < 0.0:
                return f"distance {item.p1:g} m"
        case Cmd.SET_HOME:
            return _why_not_home(item)
        case Cmd.LOITER_TURNS:
            if not 0.0 < item.p1 <= _MOST_TURNS:
                return f"{item.p1:g} turns"
        case Cmd.CONDITION_YAW:
            if not isfinite(item.p1):
                return "the heading is not a number"
        case Cmd.FENCE_ENABLE:
            if rules.fence_always_on and item.p1 != 0.0:
                return "this vehicle's geofence is always on"
            if item.p1 not in (0.0, 1.0, 2.0):
                return f"fence enable {item.p1:g}"
        case Cmd.ROI:
            if item.p1 not in (0.0, 3.0):
                return f"region of interest of mode {item.p1:g}"
        case Cmd.IMAGE_START:
            if isfinite(item.p3) and item.p3 < 0.0:
                return f"{item.p3:g} pictures"
        case _:
            pass
    return None


def _why_not_home(item: PlanItem) -> str | None:
    """DO_SET_HOME: 1 = here, 0 = at the item's place."""
    if item.p1 == 1.0:
        return None
    if item.p1 != 0.0:
        return f"home of kind {item.p1:g}"
    if item.frame == _MISSION or not has_place(item):
        return "the position is missing"
    return None if item.frame == _LOCAL_NED or _on_earth(item) else "the position is not on Earth"


def has_place(item: PlanItem) -> bool:
    """Whether the item says where, horizontally."""
    if item.frame == _LOCAL_NED:
        return True
    return (item.x != 0 or item.y != 0) and item.x != _NO_PLACE and item.y != _NO_PLACE


def has_height(item: PlanItem) -> bool:
    """Whether the item has a place and says how high it is."""
    return item.command in _PLACED and isfinite(item.z)


def _on_earth(item: PlanItem) -> bool:
    return abs(item.x) <= 900_000_000 and abs(item.y) <= 1_800_000_000


def place_of(item: PlanItem, datum: Datum, here_ned: Vec3) -> Vec3:
    """Where the item is [m, NED]; without coordinates: over `here_ned`, at its height.

    Without a height, which a height of 0 is to ArduCopter in every global frame: as high as
    `here_ned`.
    """
    zero = datum.zero_keeps_height and item.z == 0.0 and item.command in _KEEPS_HEIGHT
    if not isfinite(item.z) or (zero and item.frame != _LOCAL_NED):
        level_m = datum.origin.alt_amsl_m - here_ned[2]
        return place_of(replace(item, frame=0, z=level_m), datum, here_ned)
    if item.frame == _LOCAL_NED:
        return (item.x * 1e-4, item.y * 1e-4, item.z)
    if item.frame in _GLOBAL:
        alt_amsl_m = item.z
        down = datum.origin.alt_amsl_m - item.z
    else:
        down = datum.home_ned[2] - item.z
        alt_amsl_m = datum.origin.alt_amsl_m - down
    if not has_place(item):
        return (here_ned[0], here_ned[1], down)
    north, east, _ = datum.projection.to_local(Geodetic(item.x * 1e-7, item.y * 1e-7, alt_amsl_m))
    return (north, east, down)
