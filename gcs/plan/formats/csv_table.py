"""Our own CSV: a whole plan as a table that a spreadsheet can edit.

The first row names the columns; any of them may be absent, and they may stand in any order.  Each
other row says in `what` what it is:

item (or empty)       id, command, frame, p1 to p4, a place, autocontinue
home                  lat_deg, lon_deg, alt_m above mean sea level
inclusion, exclusion  a circle with radius_m, or one corner of a polygon: rows after each other that
                      have the same id are one; floor_m and ceiling_m above home, name
return_point, rally   lat_deg, lon_deg, alt_m above home
name, firmware, cruise_speed_m_s, hover_speed_m_s     value

`command` is the name or number of a MAV_CMD, NAV_WAYPOINT if empty.  `frame` is what the height
counts from: AMSL, HOME, TERRAIN; LOCAL is a place in north_m, east_m, up_m of the take-off point;
MISSION is an item without a place, whose last parameters are p5 to p7.  An empty cell is the
default: HOME for a place in degrees, 0 for a parameter, and "not set" for places and for the
heading p4 of an item that has a place; `nan` is "not set" anywhere.
"""

from __future__ import annotations

import csv
import io
import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Final

from gcs.plan import commands
from gcs.plan.build import check_lat_lon, item_from_numbers
from gcs.plan.errors import PlanError
from gcs.plan.formats.text_lines import decoded, read_number
from gcs.plan.model import (
    UNSET,
    AutopilotName,
    BreachReturn,
    Circle,
    EastNorth,
    Fence,
    Frame,
    Geodetic,
    Item,
    LatLon,
    Local,
    Plan,
    Polygon,
    RallyPoint,
    Zone,
)
from gcs.steps import Steps
from gcs.wire.ids import Cmd

PARAMS: Final = ("p1", "p2", "p3", "p4")
DEGREES: Final = ("lat_deg", "lon_deg", "alt_m")
METRES: Final = ("north_m", "east_m", "up_m")
NO_PLACE: Final = ("p5", "p6", "p7")
COLUMNS: Final = (
    *("what", "id", "command", "frame"),
    *PARAMS,
    *DEGREES,
    *METRES,
    *NO_PLACE,
    *("autocontinue", "radius_m", "floor_m", "ceiling_m", "name", "value"),
)
ROWS_MAX: Final = 10_000
ITEMS_A_STEP: Final = 50
_METRES_MAX: Final = 1.0e5
_ID_MAX: Final = 65535
_FIRMWARES: Final[dict[str, AutopilotName]] = {"px4": "px4", "ardupilot": "ardupilot"}
_YES: Final = {"": True, "1": True, "true": True, "0": False, "false": False}
_MIN_CORNERS: Final = 3


@dataclass(frozen=True, slots=True)
class Row:
    """One row; a column that is absent is empty."""

    file: str
    where: str
    cells: dict[str, str]

    def text(self, column: str) -> str:
        return self.cells.get(column, "")

    def number(self, column: str, default: float = UNSET) -> float:
        text = self.text(column)
        if not text:
            return default
        if text.lower() == "nan":
            return UNSET
        return read_number(self.file, self.where, column, text)

    def known(self, column: str) -> float:
        """A number that must be there."""
        value = self.number(column)
        if math.isnan(value):
            raise self.error(column, "is empty", "a number")
        return value

    def maybe(self, column: str) -> float | None:
        value = self.number(column)
        return None if math.isnan(value) else value

    def lat_lon(self, item: str) -> tuple[float, float]:
        lat_deg, lon_deg = self.known("lat_deg"), self.known("lon_deg")
        check_lat_lon(self.file, self.where, item, lat_deg, lon_deg)
        return lat_deg, lon_deg

    def error(self, item: str, what: str, expected: str = "", hint: str = "") -> PlanError:
        return PlanError(self.file, self.where, item, what, expected, hint)


def read_csv(file: str, data: bytes, name: str) -> Steps[Plan]:
    """Raises PlanError with the line."""
    items: list[Item] = []
    zones: list[Zone] = []
    rally: list[RallyPoint] = []
    settings: dict[str, Row] = {}
    home, breach = None, None
    rows = list(_rows(file, data))
    at = 0
    while at < len(rows):
        if at % ITEMS_A_STEP == 0:
            yield
        row = rows[at]
        what = row.text("what") or "item"
        count = 1
        match what:
            case "item":
                items.append(_item(row, len(items) + 1))
            case "home":
                home = Geodetic(*row.lat_lon("home"), row.maybe("alt_m"))
            case "inclusion" | "exclusion":
                count = _rows_of_zone(rows, at)
                zones.append(_zone(rows[at : at + count], what == "inclusion"))
            case "return_point":
                breach = BreachReturn(*row.lat_lon("return point"), row.known("alt_m"))
            case "rally":
                place = row.lat_lon("rally point")
                rally.append(RallyPoint(*place, row.known("alt_m"), row.where))
            case "name" | "firmware" | "cruise_speed_m_s" | "hover_speed_m_s":
                settings[what] = row
            case _:
                known = "item, home, inclusion, exclusion, return_point, rally or a setting"
                raise row.error("what", f'is "{what[:40]}"', known)
        at += count
    _check_ids(items, file)
    return Plan(
        settings["name"].text("value") if "name" in settings else name,
        _firmware(settings.get("firmware")),
        home,
        tuple(items),
        Fence(tuple(zones), breach),
        tuple(rally),
        _speed(settings.get("cruise_speed_m_s")),
        _speed(settings.get("hover_speed_m_s")),
        source=file,
    )


def _rows(file: str, data: bytes) -> Iterator[Row]:
    """Every row below the names of the columns that is not empty, and no comment (#)."""
    reader = csv.reader(io.StringIO(decoded(file, data), newline=""), strict=True)
    columns: list[str] = []
    try:
        for number, fields in enumerate(reader):
            where = str(reader.line_num)
            cells = [cell.strip() for cell in fields]
            if not any(cells) or cells[0].startswith("#"):
                continue
            if not columns:
                columns = _columns(file, where, cells)
                continue
            if number > ROWS_MAX:
                raise PlanError(file, where, "row", "is one too many", f"at most {ROWS_MAX}")
            if any(cells[len(columns) :]):
                what = f"has {len(cells)} cells, and there are {len(columns)} columns"
                raise PlanError(file, where, "row", what)
            yield Row(file, where, dict(zip(columns, cells, strict=False)))
    except csv.Error as error:
        raise PlanError(file, str(reader.line_num), "row", f"is no CSV: {error}") from None
    if not columns:
        raise PlanError(file, "1", "file", "is empty", f"a row of column names: {names_told()}")


def names_told() -> str:
    return ", ".join(COLUMNS)


def _columns(file: str, where: str, cells: list[str]) -> list[str]:
    for cell in cells:
        if cell not in COLUMNS:
            hint = "the separator is a comma" if ";" in cell else ""
            raise PlanError(
                file, where, "column", f'"{cell[:40]}" is not known', names_told(), hint
            )
    if len(set(cells)) < len(cells):
        raise PlanError(file, where, "column", "one of them is there twice")
    return cells


def _item(row: Row, number: int) -> Item:
    command = _command(row)
    do_jump_id = int(_whole(row, "id", number))
    label = commands.name(command)
    autocontinue = row.text("autocontinue").lower()
    if autocontinue not in _YES:
        raise row.error("autocontinue", f'is "{autocontinue[:40]}"', "1 or 0")
    frame = _frame(row, command)
    has_place = frame is Frame.LOCAL or (
        commands.has_place(command, int(frame)) and frame is not Frame.MISSION
    )
    p1, p2, p3 = (row.number(name, 0.0) for name in PARAMS[:3])
    p4 = row.number("p4", UNSET if has_place else 0.0)
    if frame is Frame.LOCAL:
        place = Local(*(row.known(name) for name in METRES))
        if max(map(abs, place)) > _METRES_MAX:
            raise row.error(label, "is too far away", f"at most {_METRES_MAX:.0f} m")
        params = (p1, p2, p3, p4)
        going_on = _YES[autocontinue]
        return Item(command, frame, params, place, do_jump_id, going_on, row.where)
    last = [row.number(n) for n in DEGREES] if has_place else [row.number(n, 0.0) for n in NO_PLACE]
    numbers = (p1, p2, p3, p4, *last)
    return item_from_numbers(
        row.file, row.where, command, int(frame), numbers, do_jump_id, _YES[autocontinue]
    )


def _command(row: Row) -> int:
    text = row.text("command").upper().removeprefix("MAV_CMD_")
    if not text:
        return Cmd.NAV_WAYPOINT
    if text.isascii() and text.isdigit():
        return int(_whole(row, "command", 0))
    if text in Cmd.__members__:
        return Cmd[text]
    raise row.error("command", f'is "{text[:40]}"', "the name or number of a MAV_CMD")


def _frame(row: Row, command: int) -> Frame:
    text = row.text("frame").upper()
    if text in Frame.__members__:
        return Frame[text]
    if text:
        raise row.error("frame", f'is "{text[:40]}"', ", ".join(Frame.__members__))
    if row.text("north_m") or row.text("east_m"):
        return Frame.LOCAL
    return Frame.HOME if commands.has_place(command, int(Frame.HOME)) else Frame.MISSION


def _whole(row: Row, column: str, default: int) -> float:
    value = row.number(column, default)
    if not (0 <= value <= _ID_MAX and value == int(value)):
        raise row.error(column, f'is "{row.text(column)[:40]}"', "a whole number")
    return value


def _rows_of_zone(rows: list[Row], at: int) -> int:
    """How many rows from `at` are one zone."""
    first = rows[at]
    if first.text("radius_m"):
        return 1
    count = 1
    for row in rows[at + 1 :]:
        same = all(row.text(column) == first.text(column) for column in ("what", "id"))
        if not same or row.text("radius_m"):
            break
        count += 1
    return count


def _zone(rows: list[Row], inclusion: bool) -> Zone:
    first = rows[0]
    points = [_point(row) for row in rows]
    shape: Polygon | Circle
    if first.text("radius_m"):
        radius_m = first.known("radius_m")
        if not radius_m > 0.0:
            raise first.error("radius_m", f"is {radius_m:g}", "more than 0")
        shape = Circle(points[0], radius_m)
    elif len(points) < _MIN_CORNERS:
        what = f"a polygon of {len(points)} corners"
        hint = "the corners of one polygon stand after each other and have one id"
        raise first.error("zone", what, f"at least {_MIN_CORNERS}", hint)
    else:
        in_degrees = tuple(point for point in points if isinstance(point, LatLon))
        in_metres = tuple(point for point in points if isinstance(point, EastNorth))
        if in_degrees and in_metres:
            raise first.error("zone", "has corners in degrees and in metres", "one of them")
        shape = Polygon(in_degrees or in_metres)
    name = first.text("name") or f"at {first.where}"
    heights = (first.maybe("floor_m"), first.maybe("ceiling_m"))
    return Zone(shape, inclusion, *heights, name, first.where)


def _point(row: Row) -> LatLon | EastNorth:
    if row.text("north_m") or row.text("east_m"):
        return EastNorth(row.known("east_m"), row.known("north_m"))
    return LatLon(*row.lat_lon("zone"))


def _firmware(row: Row | None) -> AutopilotName | None:
    if row is None or not row.text("value"):
        return None
    if row.text("value") not in _FIRMWARES:
        raise row.error("firmware", f'is "{row.text("value")[:40]}"', "px4 or ardupilot")
    return _FIRMWARES[row.text("value")]


def _speed(row: Row | None) -> float | None:
    if row is None:
        return None
    speed_m_s = row.maybe("value")
    if speed_m_s is not None and not 0.0 <= speed_m_s <= 1000.0:
        raise row.error("value", f"is {speed_m_s:g}", "0..1000 m/s")
    return speed_m_s


def _check_ids(items: list[Item], file: str) -> None:
    seen: dict[int, str] = {}
    for item in items:
        if item.do_jump_id in seen:
            what = f"{item.do_jump_id} is also that of line {seen[item.do_jump_id]}"
            raise PlanError(file, item.where, "id", what, "every item its own")
        seen[item.do_jump_id] = item.where
