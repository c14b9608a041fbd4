"""Plan -> `QGC WPL 110`, with home as item 0 for ArduPilot and without it for PX4."""

from __future__ import annotations

import math

from gcs.plan import commands
from gcs.plan.errors import Level, PlanError
from gcs.plan.formats.fence_items import fence_rows
from gcs.plan.formats.losses import Losses, Written
from gcs.plan.formats.qgc_plan_writer import local_refused
from gcs.plan.formats.wpl import HEADER
from gcs.plan.model import AutopilotName, Item, Local, Plan
from gcs.wire.ids import Cmd


def write_wpl(plan: Plan, autopilot: AutopilotName) -> Written:
    """What a table of waypoints cannot keep is named; ArduPilot's has no NaN either.

    A mission, then its fence, then its rally points.  Raises PlanError for a plan in a local
    frame, and for an ArduPilot file without a home to put first.
    """
    losses = Losses(plan)
    lines = [HEADER]

    def add(frame: int, command: int, numbers: tuple[float, ...], autocontinue: bool) -> None:
        seq = len(lines) - 1
        fields = [seq, int(seq == 0), frame, command, *map(_shown, numbers), int(autocontinue)]
        lines.append("\t".join(str(field) for field in fields))

    shift = 0
    if autopilot == "ardupilot" and plan.items:
        shift = 1
        add(0, Cmd.NAV_WAYPOINT, _home_numbers(plan), True)
    for index, item in enumerate(plan.items):
        add(
            int(item.frame),
            item.command,
            _numbers(plan, index, item, autopilot, shift, losses),
            item.autocontinue,
        )
    for row in fence_rows(plan.source, plan.fence):
        add(3, row.command, (row.p1, 0.0, 0.0, 0.0, row.lat_deg, row.lon_deg, row.alt_m), True)
    for point in plan.rally:
        place = (point.lat_deg, point.lon_deg, point.alt_above_home_m)
        add(3, Cmd.NAV_RALLY_POINT, (0.0, 0.0, 0.0, 0.0, *place), True)
    without_home = shift == 0
    losses.settings(home=without_home, firmware=without_home)
    losses.numbering()
    losses.heights_of_zones()
    return Written(("\n".join(lines) + "\n").encode(), losses.found())


def _home_numbers(plan: Plan) -> tuple[float, ...]:
    home = plan.home
    if home is None or home.alt_amsl_m is None:
        raise PlanError(
            plan.source or plan.name,
            "",
            "home",
            "is not known, and an ArduPilot file begins with it",
            hint="give --home LAT,LON,ALT",
        )
    return (0.0, 0.0, 0.0, 0.0, home.lat_deg, home.lon_deg, home.alt_amsl_m)


def _numbers(
    plan: Plan,
    index: int,
    item: Item,
    autopilot: AutopilotName,
    shift: int,
    losses: Losses,
) -> tuple[float, ...]:
    label = commands.name(item.command)
    if isinstance(item.place, Local):
        raise local_refused(plan, item.where, label)
    numbers = (*item.params, *item.place)
    if item.command == Cmd.DO_JUMP:
        target = plan.index_of(item.params[0])
        if target is None:
            what = f"jumps to {item.params[0]:g}, which is no item"
            raise PlanError(plan.source or plan.name, item.where, label, what)
        numbers = (float(target + shift), *numbers[1:])
    if autopilot == "ardupilot" and any(math.isnan(n) for n in numbers):
        losses.of_item(index, "a value that is not set is written as 0", Level.NOTE)
        numbers = tuple(0.0 if math.isnan(n) else n for n in numbers)
    return numbers


def _shown(value: float) -> str:
    """The shortest text that reads back as the same number."""
    return "nan" if math.isnan(value) else repr(float(value))
