"""Missions in metres from the take-off point: our own TOML, schema version 1.

schema = 1
name = "lab square"
frame = "home"            # metres north, east and up of the take-off point
speed_m_s = 2.0           # optional, of the whole flight
takeoff_up_m = 1.0        # optional: the height of the first waypoint
picture_s = 2.0           # optional: how long the vehicle stays for a picture
end = "land"              # optional: "land", "return" or "hold"

[[waypoint]]
north_m = 0.0
east_m = 2.0
up_m = 1.0
yaw_deg = 90.0            # optional, clockwise from north
hold_s = 1.0              # optional
picture = true            # optional
speed_m_s = 1.0           # optional, from here on

[fence]                   # optional: stay inside
north_m = [-5, 5]         # a box; or radius_m = 20, centred on north_m, east_m
east_m = [-5, 5]
up_m = [0, 2]             # optional

[[fence.exclude]]         # optional: stay out
radius_m = 1.0
north_m = 3.0
east_m = 3.0
"""

from __future__ import annotations

import difflib
from collections.abc import Mapping

from gcs.gate.policy.tomlfile import Path, PolicyError, Table, find_lines
from gcs.gate.policy.tomlfile import read as read_table
from gcs.plan.errors import PlanError
from gcs.plan.model import (
    UNSET,
    Circle,
    EastNorth,
    Fence,
    Frame,
    Item,
    Local,
    Params,
    Place,
    Plain,
    Plan,
    Polygon,
    Zone,
)
from gcs.wire.ids import Cmd

SCHEMA = 1
_REACH_M = 1.0e5
_HEIGHT_MAX_M = 1.0e4
_SPEED_MIN_M_S = 0.1
_SPEED_MAX_M_S = 100.0
_ALIKE = 0.6
"""By difflib's measure `up` is like `up_m` by 0.67, `east_m` like `north_m` by 0.46."""
_NOTHING = Plain(0.0, 0.0, 0.0)


def read_local(file: str, data: bytes, name: str) -> Plan:
    """Raises PlanError with the line."""
    try:
        text = data.decode("utf-8-sig")
        top = read_table(text, file)
        return _read(top, _Lines(find_lines(text)), file, name)
    except UnicodeDecodeError as error:
        line = data[: error.start].count(b"\n") + 1
        raise PlanError(file, str(line), "text", "is not UTF-8") from None
    except PolicyError as error:
        line_text = str(error.line) if error.line else ""
        raise PlanError(file, line_text, error.key, error.what, hint=error.hint) from None
    except (ValueError, OverflowError, RecursionError) as error:
        raise PlanError(file, "", "TOML", str(error)) from None


class _Lines:
    """Where keys stand, as texts for messages."""

    def __init__(self, lines: Mapping[Path, int]) -> None:
        self._lines = lines

    def of(self, *path: str | int) -> str:
        """The line of the key, or of the nearest table around it."""
        while path and path not in self._lines:
            path = path[:-1]
        return str(self._lines.get(path, 1))


def _read(top: Table, lines: _Lines, file: str, name: str) -> Plan:
    schema = _required(top, "schema", 0.0, 1000.0)
    if schema != SCHEMA:
        top.fail("schema", f"{schema:g} is not known", f"this reads schema {SCHEMA}")
    if not top.has("frame"):
        top.fail("frame", "is missing", 'frame = "home"')
    top.word("frame", "home", ("home",))
    plan = Plan(
        top.text("name", name),
        None,
        None,
        _Flight(top, lines).items(),
        _read_fence(top.table("fence"), lines) if top.has("fence") else Fence(),
        hover_speed_m_s=_speed(top),
        source=file,
    )
    top.done()
    return plan


class _Flight:
    """The items of the flight, in the making."""

    def __init__(self, top: Table, lines: _Lines) -> None:
        self._top = top
        self._lines = lines
        self._items: list[Item] = []

    def items(self) -> tuple[Item, ...]:
        top = self._top
        end = top.word("end", "land", ("land", "return", "hold"))
        picture_s = top.number("picture_s", 2.0, least=0.0, most=600.0)
        waypoints = top.tables("waypoint")
        if not waypoints:
            hint = _mistyped(top, "waypoint") or "write at least one [[waypoint]]"
            top.fail("waypoint", "there is none", hint)
        here = _place(waypoints[0])
        up_m = top.number("takeoff_up_m", here.up_m, least=0.1, most=_HEIGHT_MAX_M)
        self._add(self._lines.of("takeoff_up_m"), Cmd.NAV_TAKEOFF, Local(0.0, 0.0, up_m))
        self._change_speed(self._lines.of("speed_m_s"), top)
        for number, waypoint in enumerate(waypoints):
            here = self._fly(number, waypoint, picture_s)
        if end == "land":
            self._add(self._lines.of("end"), Cmd.NAV_LAND, here._replace(up_m=0.0))
        elif end == "return":
            nothing = (0.0, 0.0, 0.0, 0.0)
            self._add(self._lines.of("end"), Cmd.NAV_RETURN_TO_LAUNCH, params=nothing)
        return tuple(self._items)

    def _fly(self, number: int, waypoint: Table, picture_s: float) -> Local:
        self._change_speed(self._lines.of("waypoint", number, "speed_m_s"), waypoint)
        here = _place(waypoint)
        hold_s = waypoint.number("hold_s", 0.0, least=0.0, most=3600.0)
        yaw_deg = waypoint.number("yaw_deg", UNSET, least=-360.0, most=360.0)
        line = self._lines.of("waypoint", number)
        self._add(line, Cmd.NAV_WAYPOINT, here, (hold_s, 0.0, 0.0, yaw_deg))
        if waypoint.flag("picture", False):
            line = self._lines.of("waypoint", number, "picture")
            self._add(line, Cmd.IMAGE_START_CAPTURE, params=(0.0, 0.0, 1.0, 0.0))
            # Autopilots do not wait for a camera, and a picture wants a vehicle that stands still.
            self._add(line, Cmd.NAV_DELAY, params=(picture_s, -1.0, -1.0, -1.0))
        waypoint.done()
        return here

    def _change_speed(self, line: str, table: Table) -> None:
        speed_m_s = _speed(table)
        if speed_m_s is not None:
            self._add(line, Cmd.DO_CHANGE_SPEED, params=(1.0, speed_m_s, -1.0, 0.0))

    def _add(
        self,
        line: str,
        command: Cmd,
        place: Place = _NOTHING,
        params: Params = (0.0, 0.0, 0.0, UNSET),
    ) -> None:
        frame = Frame.LOCAL if isinstance(place, Local) else Frame.MISSION
        number = len(self._items) + 1
        self._items.append(Item(command, frame, params, place, number, where=line))


def _required(table: Table, key: str, least: float, most: float) -> float:
    if not table.has(key):
        table.fail(key, "is missing", _mistyped(table, key) or f"{key} = a number")
    return table.number(key, 0.0, least=least, most=most)


def _mistyped(table: Table, key: str) -> str:
    """A hint where a key that is there looks like the one that is missing."""
    near = difflib.get_close_matches(key, table.keys(), n=1, cutoff=_ALIKE)
    return f"`{near[0]}` is unknown here: did you mean {key}?" if near else ""


def _place(waypoint: Table) -> Local:
    return Local(
        _required(waypoint, "north_m", -_REACH_M, _REACH_M),
        _required(waypoint, "east_m", -_REACH_M, _REACH_M),
        _required(waypoint, "up_m", -_HEIGHT_MAX_M, _HEIGHT_MAX_M),
    )


def _speed(table: Table) -> float | None:
    if not table.has("speed_m_s"):
        return None
    return table.number("speed_m_s", 0.0, least=_SPEED_MIN_M_S, most=_SPEED_MAX_M_S)


def _read_fence(fence: Table, lines: _Lines) -> Fence:
    zones = [_read_zone(fence, "fence", lines.of("fence"), inclusion=True)]
    for number, table in enumerate(fence.tables("exclude")):
        where = lines.of("fence", "exclude", number)
        zones.append(_read_zone(table, f"exclusion {number + 1}", where, inclusion=False))
        table.done()
    fence.done()
    return Fence(tuple(zones))


def _read_zone(table: Table, name: str, where: str, *, inclusion: bool) -> Zone:
    shape: Polygon | Circle
    if table.has("radius_m"):
        radius_m = table.number("radius_m", 0.0, least=0.1, most=_REACH_M)
        east_m = table.number("east_m", 0.0, least=-_REACH_M, most=_REACH_M)
        north_m = table.number("north_m", 0.0, least=-_REACH_M, most=_REACH_M)
        shape = Circle(EastNorth(east_m, north_m), radius_m)
    else:
        (west, east), (south, north) = _span(table, "east_m"), _span(table, "north_m")
        corners = ((west, south), (east, south), (east, north), (west, north))
        shape = Polygon(tuple(EastNorth(*corner) for corner in corners))
    floor_m, ceiling_m = _span(table, "up_m") if table.has("up_m") else (None, None)
    return Zone(shape, inclusion, floor_m, ceiling_m, table.text("name", name), where)


def _span(table: Table, key: str) -> tuple[float, float]:
    low, high = table.pair(key, None)
    if not low < high:
        table.fail(key, f"[{low:g}, {high:g}] is empty", "[from, to] with from below to")
    return (low, high)
