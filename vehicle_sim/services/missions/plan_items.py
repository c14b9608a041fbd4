"""Plan items as they travel, and as they are stored."""

from __future__ import annotations

import struct
import zlib
from dataclasses import replace
from math import isfinite
from typing import Final

from vehicle_sim.autopilot.interface import Geodetic, PlanItem
from vehicle_sim.effects import Client
from vehicle_sim.services.units import degrees_e7
from vehicle_sim.wire import messages as m
from vehicle_sim.wire.ids import ABSOLUTE, RELATIVE, TERRAIN, Cmd, MavFrame

_GLOBAL: Final = ABSOLUTE | RELATIVE | TERRAIN
_LOCAL_SCALE: Final = 1e4
_GLOBAL_SCALE: Final = 1e7
_LAST_NAV: Final = 95  # MAV_CMD_NAV_LAST
INT32_MAX: Final = 0x7FFFFFFF

_DIGICAM: Final = frozenset({202, 203})  # DO_DIGICAM_CONFIGURE, _CONTROL: x and y are numbers
_PLACELESS_NAVS: Final = frozenset({20, 92, 93})
"""NAV_RETURN_TO_LAUNCH, NAV_GUIDED_ENABLE, NAV_DELAY."""
_PLACED_DOS: Final = frozenset({179, 189, 195, 201})
"""DO_SET_HOME, DO_LAND_START, DO_SET_ROI_LOCATION, DO_SET_ROI: all others have no place."""

_KEPT: Final[dict[int, tuple[bool, bool, bool, bool]]] = {
    16: (True, False, False, False),
    17: (False, False, True, False),
    18: (True, False, True, True),
    19: (True, False, True, True),
    20: (False, False, False, False),
    21: (True, False, False, True),
    22: (True, False, False, False),
    31: (False, True, False, True),
    82: (True, False, False, False),
    177: (True, True, False, False),
    92: (True, False, False, False),
    94: (True, False, False, False),
    181: (True, True, False, False),
    182: (True, True, True, False),
    183: (True, True, False, False),
    206: (True, False, True, False),
    208: (True, False, False, False),
    211: (True, True, False, False),
    218: (True, True, False, False),
    600: (True, False, False, False),
    601: (True, True, False, False),
}
"""The parameters that ArduCopter stores, where it does not store all four; of those that it was
sent in C8_upload_item_kinds all came back, what is left out is from memory."""

_TURNED: Final = frozenset({16, 17, 21, 22, 84, 85})
"""NAV_WAYPOINT, _LOITER_UNLIM, _LAND, _TAKEOFF and those of VTOLs: PX4 stores a heading of them."""
_PI: Final = 3.1415927410125732
_RAD_PER_DEG: Final = 0.01745329238474369
_DEG_PER_RAD: Final = 57.295776367187500
"""Float32 numbers, as PX4 works them out: pi / 180 and 180 / pi."""

_PLAIN: Final = {
    MavFrame.GLOBAL_INT: MavFrame.GLOBAL,
    MavFrame.GLOBAL_RELATIVE_ALT_INT: MavFrame.GLOBAL_RELATIVE_ALT,
    MavFrame.GLOBAL_TERRAIN_ALT_INT: MavFrame.GLOBAL_TERRAIN_ALT,
}
_INT: Final = {plain: whole for whole, plain in _PLAIN.items()}


def _scale(command: int, frame: int) -> float:
    """How x and y of MISSION_ITEM become those of MISSION_ITEM_INT; not everything is a place."""
    if frame == MavFrame.MISSION or command in _DIGICAM:
        return 1.0
    return _LOCAL_SCALE if frame == MavFrame.LOCAL_NED else _GLOBAL_SCALE


def from_int(item: m.MissionItemInt) -> PlanItem:
    return PlanItem(
        item.seq, item.frame, item.command, *item[:4], item.x, item.y, item.z, item.autocontinue
    )


def from_float(item: m.MissionItem) -> PlanItem | None:
    """None if a coordinate is no number, or beyond what an item can hold."""
    scale = _scale(item.command, item.frame)
    if not (abs(item.x) * scale <= INT32_MAX and abs(item.y) * scale <= INT32_MAX):
        return None
    x, y = round(item.x * scale), round(item.y * scale)
    return PlanItem(item.seq, item.frame, item.command, *item[:4], x, y, item.z, item.autocontinue)


def to_int(item: PlanItem, client: Client, kind: int) -> m.MissionItemInt:
    return m.MissionItemInt(
        param1=item.p1,
        param2=item.p2,
        param3=item.p3,
        param4=item.p4,
        x=item.x,
        y=item.y,
        z=item.z,
        seq=item.seq,
        command=item.command,
        target_system=client.system,
        target_component=client.component,
        frame=item.frame,
        current=0,
        autocontinue=item.autocontinue,
        mission_type=kind,
    )


def to_float(item: PlanItem, client: Client, kind: int) -> m.MissionItem:
    scale = _scale(item.command, item.frame)
    whole = to_int(item, client, kind)
    x, y = item.x / scale, item.y / scale
    return m.MissionItem._make((*whole[:4], x, y, *whole[6:]))


def as_px4_gives_back(item: PlanItem) -> PlanItem:
    """Global frames in their integer form; a heading as it comes back from float radians in 0 to
    2 pi; a take-off without its pitch."""
    if item.command in _TURNED and isfinite(item.p4):
        item = replace(item, p4=_through_radians(item.p4))
    if item.command == Cmd.NAV_TAKEOFF:
        item = replace(item, p1=0.0)
    return replace(item, frame=_INT.get(MavFrame(item.frame), item.frame)) if _known(item) else item


def place_as_px4_gives_back(item: PlanItem) -> PlanItem:
    """Of a fence or of rally points (recorded, 1.14.3): whatever it was sent in, as if its height
    were above the sea, and without autocontinue."""
    return replace(item, frame=MavFrame.GLOBAL_INT, autocontinue=0)


def _through_radians(yaw_deg: float) -> float:
    """In float32, as PX4 keeps it: 225 becomes 224.99998, and -90 becomes 270."""
    yaw_rad = _float32(_float32(yaw_deg) * _RAD_PER_DEG)
    if yaw_rad < 0.0:
        yaw_rad = _float32(yaw_rad + 2.0 * _PI)
    return _float32(yaw_rad * _DEG_PER_RAD)


def _float32(value: float) -> float:
    kept: float = struct.unpack("<f", struct.pack("<f", value))[0]
    return kept


def as_ardupilot_gives_back(item: PlanItem, home: Geodetic | None) -> PlanItem:
    """Item 0 is home; frames in their plain form, 0 for what has no place; only what was kept."""
    if item.seq == 0 and home is not None:
        return PlanItem(
            seq=0,
            frame=MavFrame.GLOBAL,
            command=Cmd.NAV_WAYPOINT,
            p1=0.0,
            p2=0.0,
            p3=0.0,
            p4=0.0,
            x=degrees_e7(home.lat_deg),
            y=degrees_e7(home.lon_deg),
            z=home.alt_amsl_m,
            autocontinue=1,
        )
    k1, k2, k3, k4 = _KEPT.get(item.command, (True, True, True, True))
    item = replace(
        item,
        p1=_kept(item.p1, k1),
        p2=_kept(item.p2, k2),
        p3=_kept(item.p3, k3),
        p4=_kept(item.p4, k4),
    )
    if item.command == Cmd.NAV_LOITER_TIME:
        item = replace(item, p3=-1.0 if item.p3 < 0.0 else 1.0)  # of the radius only the sign
    if item.command == Cmd.NAV_LAND:
        item = replace(item, p4=-1.0 if item.p4 < 0.0 else 1.0)  # recorded: 0, 1, NaN become 1
    goes_somewhere = item.command <= _LAST_NAV and item.command not in _PLACELESS_NAVS
    if not (goes_somewhere or item.command in _PLACED_DOS):
        return replace(item, frame=MavFrame.GLOBAL)
    return (
        replace(item, frame=_PLAIN.get(MavFrame(item.frame), item.frame)) if _known(item) else item
    )


def _kept(value: float, kept: bool) -> float:
    """ArduPilot stores no NaN."""
    return value if kept and isfinite(value) else 0.0


def _known(item: PlanItem) -> bool:
    return item.frame in _GLOBAL


def opaque_id(items: tuple[PlanItem, ...]) -> int:
    """Equal for equal plans, 0 for none."""
    return zlib.crc32(repr(items).encode()) if items else 0
