"""Plan items as they travel, and as they are stored."""

from __future__ import annotations

import zlib
from dataclasses import replace
from typing import Final

from vehicle_sim.autopilot.interface import Geodetic, PlanItem
from vehicle_sim.wire import messages as m
from vehicle_sim.wire.ids import ABSOLUTE, RELATIVE, Cmd, Frame

from .effects import Client
from .units import degrees_e7

_GLOBAL: Final = ABSOLUTE | RELATIVE
_LOCAL_SCALE: Final = 1e4
_GLOBAL_SCALE: Final = 1e7
_FIRST_DO: Final = 176  # MAV_CMD_DO_SET_MODE: DO commands have no place of their own
INT32_MAX: Final = 0x7FFFFFFF

_PLAIN: Final = {
    Frame.GLOBAL_INT: Frame.GLOBAL,
    Frame.GLOBAL_RELATIVE_ALT_INT: Frame.GLOBAL_RELATIVE_ALT,
}
_INT: Final = {plain: whole for whole, plain in _PLAIN.items()}


def _scale(frame: int) -> float:
    return _LOCAL_SCALE if frame == Frame.LOCAL_NED else _GLOBAL_SCALE


def from_int(item: m.MissionItemInt) -> PlanItem:
    return PlanItem(
        item.seq, item.frame, item.command, *item[:4], item.x, item.y, item.z, item.autocontinue
    )


def from_float(item: m.MissionItem) -> PlanItem | None:
    """None if a coordinate is no number, or beyond what an item can hold."""
    scale = _scale(item.frame)
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
    scale = _scale(item.frame)
    whole = to_int(item, client, kind)
    x, y = item.x / scale, item.y / scale
    return m.MissionItem._make((*whole[:4], x, y, *whole[6:]))


def as_px4_gives_back(item: PlanItem) -> PlanItem:
    """Global frames in their integer form."""
    return replace(item, frame=_INT.get(Frame(item.frame), item.frame)) if _known(item) else item


def as_ardupilot_gives_back(item: PlanItem, home: Geodetic | None) -> PlanItem:
    """Item 0 is home; frames in their plain form; DO and RTL items have frame 0."""
    if item.seq == 0 and home is not None:
        return PlanItem(
            seq=0,
            frame=Frame.GLOBAL,
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
    if item.command == Cmd.NAV_RETURN_TO_LAUNCH or item.command >= _FIRST_DO:
        return replace(item, frame=Frame.GLOBAL)
    return replace(item, frame=_PLAIN.get(Frame(item.frame), item.frame)) if _known(item) else item


def _known(item: PlanItem) -> bool:
    return item.frame in _GLOBAL


def opaque_id(items: tuple[PlanItem, ...]) -> int:
    """Equal for equal plans, 0 for none."""
    return zlib.crc32(repr(items).encode()) if items else 0
