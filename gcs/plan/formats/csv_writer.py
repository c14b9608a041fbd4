"""Plan -> our own CSV, which keeps all of it; only the columns that say something."""

from __future__ import annotations

import csv
import io
import math
from collections.abc import Iterator, Mapping, Sequence

from gcs.plan import commands
from gcs.plan.commands import has_place
from gcs.plan.formats.csv_table import COLUMNS, DEGREES, METRES, NO_PLACE, PARAMS
from gcs.plan.formats.losses import Written
from gcs.plan.model import Circle, EastNorth, Frame, Geographic, Item, LatLon, Local, Plan, Zone


def write_csv(plan: Plan) -> Written:
    rows = list(_rows(plan))
    columns = [column for column in COLUMNS if any(row.get(column) for row in rows)]
    text = io.StringIO(newline="")
    table = csv.DictWriter(text, columns or ["what"], lineterminator="\n", extrasaction="ignore")
    table.writeheader()
    table.writerows(rows)
    return Written(text.getvalue().encode())


def _rows(plan: Plan) -> Iterator[Mapping[str, str]]:
    yield {"what": "name", "value": " ".join(plan.name.split())}
    if plan.firmware is not None:
        yield {"what": "firmware", "value": plan.firmware}
    for what, speed_m_s in (
        ("cruise_speed_m_s", plan.cruise_speed_m_s),
        ("hover_speed_m_s", plan.hover_speed_m_s),
    ):
        if speed_m_s is not None:
            yield {"what": what, "value": repr(speed_m_s)}
    if plan.home is not None:
        alt_m = math.nan if plan.home.alt_amsl_m is None else plan.home.alt_amsl_m
        yield {"what": "home"} | _numbers(DEGREES, (plan.home.lat_deg, plan.home.lon_deg, alt_m))
    for item in plan.items:
        yield _item(item)
    for number, zone in enumerate(plan.fence.zones, start=1):
        yield from _zone(number, zone)
    breach = plan.fence.breach_return
    if breach is not None:
        numbers = (breach.lat_deg, breach.lon_deg, breach.alt_above_home_m)
        yield {"what": "return_point"} | _numbers(DEGREES, numbers)
    for point in plan.rally:
        numbers = (point.lat_deg, point.lon_deg, point.alt_above_home_m)
        yield {"what": "rally"} | _numbers(DEGREES, numbers)


def _item(item: Item) -> dict[str, str]:
    """Parameters that are their default stay empty (`csv_table.py`)."""
    columns = {Geographic: DEGREES, Local: METRES}.get(type(item.place), NO_PLACE)
    defaults = (0.0, 0.0, 0.0, 0.0 if columns is NO_PLACE else math.nan)
    params = _numbers(PARAMS, item.params, defaults)
    place_default = 0.0 if columns is NO_PLACE else math.nan
    return {
        "what": "item",
        "id": str(item.do_jump_id),
        "command": commands.name(item.command).removeprefix("MAV_CMD "),
        "frame": _frame(item),
        "autocontinue": "" if item.autocontinue else "0",
        **params,
        **_numbers(columns, item.place, (place_default,) * 3),
    }


def _frame(item: Item) -> str:
    """Empty where it is what an empty cell means."""
    usual = Frame.HOME if has_place(item.command, int(Frame.HOME)) else Frame.MISSION
    return "" if item.frame is usual else item.frame.name


def _zone(number: int, zone: Zone) -> Iterator[dict[str, str]]:
    common = {
        "what": "inclusion" if zone.inclusion else "exclusion",
        "id": str(number),
        "floor_m": _text(zone.floor_above_home_m),
        "ceiling_m": _text(zone.ceiling_above_home_m),
        "name": " ".join(zone.name.split()),
    }
    if isinstance(zone.shape, Circle):
        yield common | {"radius_m": repr(zone.shape.radius_m)} | _point(zone.shape.centre)
        return
    for corner in zone.shape.corners:
        yield common | _point(corner)


def _point(point: LatLon | EastNorth) -> dict[str, str]:
    if isinstance(point, LatLon):
        return _numbers(DEGREES[:2], point)
    return _numbers(METRES[:2], (point.north_m, point.east_m))


def _numbers(
    columns: Sequence[str], values: Sequence[float], defaults: Sequence[float] = (math.nan,) * 4
) -> dict[str, str]:
    """The shortest text that reads back as the same number; empty for the default."""
    return {
        column: "" if _same(value, default) else ("nan" if math.isnan(value) else repr(value))
        for column, value, default in zip(columns, values, defaults, strict=False)
    }


def _same(value: float, default: float) -> bool:
    return value == default or (math.isnan(value) and math.isnan(default))


def _text(value: float | None) -> str:
    return "" if value is None else repr(value)
