"""A plan -> a file of another format: placed on Earth, or in metres, as that format needs it."""

from __future__ import annotations

from dataclasses import replace

from gcs.gate.airspace.projection import Origin, Projection
from gcs.plan.commands import KINDS, Kind
from gcs.plan.formats.losses import Written
from gcs.plan.formats.writer import Format, write
from gcs.plan.model import (
    AutopilotName,
    Circle,
    EastNorth,
    Frame,
    Geodetic,
    Geographic,
    Local,
    Plan,
)
from gcs.plan.place import georeference, in_metres
from gcs.wire.ids import Cmd


def convert(
    path_text: str,
    plan: Plan,
    kind: Format,
    autopilot: AutopilotName | None = None,
    home: Geodetic | None = None,
) -> Written:
    """Written for `autopilot`, which also says how metres are laid on Earth; by default that of the
    plan, or else px4.

    `home` becomes the plan's.  Raises PlanError where the format cannot hold the plan at all.
    """
    autopilot = autopilot or plan.firmware or "px4"
    plan = replace(plan, home=home or plan.home)
    if plan.home is not None:
        origin = Origin(plan.home.lat_deg, plan.home.lon_deg, plan.home.alt_amsl_m or 0.0)
        projection = Projection(origin, autopilot)
        if kind == "toml":
            plan = in_metres(plan, projection.north_east, projection.lat_lon, plan.home)
        elif kind != "csv" or (home is not None and has_metres(plan)):
            plan = georeference(plan, projection.lat_lon)
    return write(path_text, plan, autopilot, kind)


def has_metres(plan: Plan) -> bool:
    """Whether a place of it counts from the take-off point."""
    shapes = [zone.shape for zone in plan.fence.zones]
    points = [s.centre if isinstance(s, Circle) else s.corners[0] for s in shapes]
    in_items = any(isinstance(item.place, Local) for item in plan.items)
    return in_items or any(isinstance(point, EastNorth) for point in points)


def at_height(plan: Plan, up_m: float) -> Plan:
    """Each place of the route at that height above home, but for a landing."""

    def moves(command: int) -> bool:
        return KINDS.get(command) is Kind.MOVE and command != Cmd.NAV_LAND

    return replace(
        plan,
        items=tuple(
            replace(item, frame=Frame.HOME, place=item.place._replace(alt_m=up_m))
            if isinstance(item.place, Geographic) and moves(item.command)
            else item
            for item in plan.items
        ),
    )
