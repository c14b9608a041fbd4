"""Plan -> GPX 1.1: one route, heights above mean sea level; home as a single waypoint."""

from __future__ import annotations

import math
from collections.abc import Iterator

from gcs.plan.errors import PlanError
from gcs.plan.formats.losses import Losses, Written
from gcs.plan.formats.route_points import route_points
from gcs.plan.formats.xml_text import escaped
from gcs.plan.model import Plan


def write_gpx(plan: Plan) -> Written:
    """Raises PlanError for a plan in metres, or with heights above a home that is not known."""
    losses = Losses(plan)
    losses.settings(home=False, firmware=True)
    losses.fence_and_rally()
    lines = [
        '<?xml version="1.0" encoding="UTF-8"?>',
        '<gpx version="1.1" creator="mavgate" xmlns="http://www.topografix.com/GPX/1/1">',
        *_lines(plan, losses),
        "</gpx>",
    ]
    return Written(("\n".join(lines) + "\n").encode(), losses.found())


def _lines(plan: Plan, losses: Losses) -> Iterator[str]:
    home = plan.home
    if home is not None:
        ele = "" if home.alt_amsl_m is None else _ele(home.alt_amsl_m)
        yield (
            f'  <wpt lat="{home.lat_deg!r}" lon="{home.lon_deg!r}">{ele}'
            "<name>home</name><type>home</type></wpt>"
        )
    yield "  <rte>"
    yield f"    <name>{escaped(plan.name)}</name>"
    places = list(route_points(plan, losses))
    if not places:
        raise PlanError(
            plan.source or plan.name, "", "route", "is empty, and GPX holds nothing else"
        )
    for place in places:
        yield (
            f'    <rtept lat="{place.lat_deg!r}" lon="{place.lon_deg!r}">'
            f"{_ele(place.alt_m)}</rtept>"
        )
    yield "  </rte>"


def _ele(alt_amsl_m: float) -> str:
    return "" if math.isnan(alt_amsl_m) else f"<ele>{alt_amsl_m!r}</ele>"
