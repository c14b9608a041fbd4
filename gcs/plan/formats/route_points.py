"""The line that a plan flies along, for formats that hold places alone: KML and GPX."""

from __future__ import annotations

import math
from collections.abc import Iterator

from gcs.plan import commands
from gcs.plan.commands import KINDS, Kind
from gcs.plan.errors import Level, PlanError
from gcs.plan.formats.losses import Losses, parameters_told
from gcs.plan.formats.qgc_plan_writer import local_refused
from gcs.plan.model import Frame, Geographic, Item, Local, Plan
from gcs.wire.ids import Cmd


def route_points(plan: Plan, losses: Losses) -> Iterator[Geographic]:
    """Each place that is flown to, with heights above mean sea level, NaN for none.

    A landing is no place of the line: whoever flew there as to a waypoint would fly into the
    ground.  Raises PlanError for metres, and where a height counts from a home that is not known.
    """
    for index, item in enumerate(plan.items):
        if isinstance(item.place, Local):
            raise local_refused(plan, item.where, commands.name(item.command))
        flown = KINDS.get(item.command) is Kind.MOVE and item.command != Cmd.NAV_LAND
        if not (flown and isinstance(item.place, Geographic)) or item.place.here:
            losses.of_item(index, "is not kept by this format")
            continue
        told = parameters_told(item)
        if item.command == Cmd.NAV_TAKEOFF:
            losses.of_item(index, "is kept as a point of the route", Level.NOTE)
        elif item.command != Cmd.NAV_WAYPOINT:
            losses.of_item(index, "is kept as a point of the route")
        elif told:
            level = Level.WARNING if item.params[0] > 0.0 else Level.NOTE
            losses.of_item(index, f"its {told} is not kept by this format", level)
        yield item.place._replace(alt_m=_alt_amsl_m(plan, item, item.place.alt_m))


def _alt_amsl_m(plan: Plan, item: Item, alt_m: float) -> float:
    if item.frame is Frame.AMSL or math.isnan(alt_m):
        return alt_m
    file, label = plan.source or plan.name, commands.name(item.command)
    if item.frame is not Frame.HOME:
        what = "has a height above terrain, which this format can only say above sea level"
        raise PlanError(file, item.where, label, what, hint="--height M flies it M above home")
    if plan.home is None or plan.home.alt_amsl_m is None:
        what = "has a height above home, and the height of home is not known"
        raise PlanError(file, item.where, label, what, hint="give --home LAT,LON,ALT")
    return plan.home.alt_amsl_m + alt_m
