"""Plan <-> the items of the MAVLink mission protocol (MISSION_ITEM_INT, field by field).

px4 counts the plan's items from 0.  ardupilot has home at index 0, so the plan begins at 1.
DO_JUMP names a do_jump_id in a `Plan` and a seq on the wire; a tag is the same in both.

Files give items without a place any frame (Mission Planner and MAVProxy: 3).  PX4 1.14.3 takes them
in frame 2 alone and answers UNSUPPORTED to all other frames (seen of a return, of DO_LAND_START and
of 15 more commands; `behaviour.json` has the return).  So px4 is sent frame 2.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

from gcs.plan import commands
from gcs.plan.build import item_from_numbers
from gcs.plan.commands import KINDS, Kind
from gcs.plan.errors import PlanError
from gcs.plan.jumps import jump_target
from gcs.plan.model import (
    AutopilotName,
    Frame,
    Geodetic,
    Geographic,
    Item,
    Local,
    Params,
    Plain,
    Plan,
)
from gcs.wire.ids import Cmd, MavFrame, MissionType

_WIRE_FRAME = {
    Frame.AMSL: MavFrame.GLOBAL_INT,
    Frame.HOME: MavFrame.GLOBAL_RELATIVE_ALT_INT,
    Frame.TERRAIN: MavFrame.GLOBAL_TERRAIN_ALT_INT,
    Frame.MISSION: MavFrame.MISSION,
}
_SCALE = 1e7
_PLACE_IGNORED = frozenset({Cmd.NAV_RETURN_TO_LAUNCH, Cmd.DO_LAND_START})
"""px4 makes nothing of parameters 5 to 7 of these, whatever a file says: they are sent as 0."""


class WireItem(NamedTuple):
    """One MISSION_ITEM_INT; a tuple, in which NaN equals itself.

    `x`, `y`: 1e-7 degrees, or plain parameters 5 and 6; `z`: metres.
    """

    seq: int
    frame: int
    command: int
    current: int
    autocontinue: int
    param1: float
    param2: float
    param3: float
    param4: float
    x: int
    y: int
    z: float
    mission_type: int = MissionType.MISSION


def to_wire(
    plan: Plan, autopilot: AutopilotName, home: Geodetic | None = None
) -> tuple[WireItem, ...]:
    """`home` (or the plan's own) is what ardupilot is sent as item 0; it puts its own there.

    ardupilot refuses NaN, so what is not set is sent as 0; px4 takes NaN.  Raises PlanError for
    a plan that is not on Earth yet (`georeference`) and for what an autopilot cannot be told.
    """
    if not plan.items:
        return ()
    first: tuple[WireItem, ...] = ()
    if autopilot == "ardupilot":
        first = (_home_item(home or plan.home or Geodetic(0.0, 0.0, 0.0)),)
    return first + tuple(
        _to_wire(plan, index, item, autopilot, index + len(first))
        for index, item in enumerate(plan.items)
    )


def _home_item(home: Geodetic) -> WireItem:
    return WireItem(
        seq=0,
        frame=MavFrame.GLOBAL_INT,
        command=Cmd.NAV_WAYPOINT,
        current=0,
        autocontinue=1,
        param1=0.0,
        param2=0.0,
        param3=0.0,
        param4=0.0,
        x=round(home.lat_deg * _SCALE),
        y=round(home.lon_deg * _SCALE),
        z=home.alt_amsl_m or 0.0,
    )


def _to_wire(plan: Plan, index: int, item: Item, autopilot: AutopilotName, seq: int) -> WireItem:
    def refused(what: str, hint: str = "") -> PlanError:
        label = f"item {index + 1} ({commands.name(item.command)})"
        return PlanError(plan.source or plan.name, item.where, label, what, hint=hint)

    if isinstance(item.place, Local):
        raise refused("is in metres from the take-off point", "it must be placed on Earth first")
    params = item.params
    if KINDS.get(item.command) is Kind.JUMP:
        target = jump_target(plan, item)
        if target is None:
            raise refused(f"jumps to {params[0]:g}, which is no item")
        if item.command == Cmd.DO_JUMP:
            params = (float(target + seq - index), *params[1:])
    x, y, z = item.place
    if autopilot == "ardupilot":
        if isinstance(item.place, Geographic) and math.isnan(z):
            raise refused("has no altitude, which ardupilot needs")
        params = _without_nan(params)
        z = 0.0 if math.isnan(z) else z
    scale = _SCALE if isinstance(item.place, Geographic) else 1.0
    frame = item.frame
    if autopilot == "px4":
        if item.command in _PLACE_IGNORED:
            x, y, z, frame = 0.0, 0.0, 0.0, Frame.MISSION
        elif isinstance(item.place, Plain):
            frame = Frame.MISSION
    return WireItem(
        seq=seq,
        frame=_WIRE_FRAME[frame],
        command=item.command,
        current=int(index == 0),
        autocontinue=int(item.autocontinue),
        param1=params[0],
        param2=params[1],
        param3=params[2],
        param4=params[3],
        x=_whole(x, scale),
        y=_whole(y, scale),
        z=z,
    )


def _whole(value: float, scale: float) -> int:
    """Integers have no NaN; 0, 0 says "here" to both autopilots where a place may be missing."""
    return 0 if math.isnan(value) else round(value * scale)


def _without_nan(params: Params) -> Params:
    p1, p2, p3, p4 = (0.0 if math.isnan(p) else p for p in params)
    return (p1, p2, p3, p4)


def from_wire(items: Sequence[WireItem], autopilot: AutopilotName, name: str = "on board") -> Plan:
    """What was downloaded, as a plan; `name` stands for the file in errors.

    Raises PlanError for items out of order or without meaning.
    """
    _check_order(items, name)
    home: Geodetic | None = None
    shift = 0
    if autopilot == "ardupilot" and items:
        shift = 1
        at = items[0]
        home = Geodetic(at.x / _SCALE, at.y / _SCALE, at.z)
    plan_items = tuple(_from_wire(name, item, item.seq - shift + 1) for item in items[shift:])
    for read in plan_items:
        if read.command == Cmd.DO_JUMP and not 1 <= read.params[0] <= len(plan_items):
            what = f"jumps to seq {read.params[0] + shift - 1:g}, which is no item that is flown"
            raise PlanError(name, read.where, "DO_JUMP", what)
    return Plan(name, autopilot, home, plan_items, source=name)


def items_from_wire(items: Sequence[WireItem], name: str) -> tuple[Item, ...]:
    """A fence's or rally points' items, one by one.  Raises PlanError as `from_wire`."""
    _check_order(items, name)
    return tuple(_from_wire(name, item, item.seq + 1) for item in items)


def _check_order(items: Sequence[WireItem], name: str) -> None:
    for position, item in enumerate(items):
        if item.seq != position:
            raise PlanError(name, f"seq {item.seq}", "seq", f"{item.seq}", str(position))


def _from_wire(name: str, item: WireItem, do_jump_id: int) -> Item:
    scale = 1.0
    if commands.has_place(item.command, item.frame) and item.frame != MavFrame.MISSION:
        scale = _SCALE
    p1 = item.param1
    if item.command == Cmd.DO_JUMP:
        p1 = item.param1 + do_jump_id - item.seq
    numbers = (p1, item.param2, item.param3, item.param4, item.x / scale, item.y / scale, item.z)
    return item_from_numbers(
        name,
        f"seq {item.seq}",
        item.command,
        item.frame,
        numbers,
        do_jump_id,
        bool(item.autocontinue),
    )
