"""`QGC WPL 110`: the text table of waypoints that Mission Planner and MAVProxy write.

ArduPilot files carry home as item 0, PX4 files do not.  In this table DO_JUMP names a seq; in a
`Plan` it names a do_jump_id, which counts from 1 over the items that are flown.

Two older forms are read too, as pymavlink's `mavwp.py` does: `QGC WPL 100` has other columns and
other numbers of commands, `QGC WPL PB 110` has the rows as protobuf text (`wpl_pb.py`).
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

from gcs.plan.build import item_from_numbers
from gcs.plan.errors import Finding, Level, PlanError
from gcs.plan.formats.fence_items import split_fence
from gcs.plan.formats.text_lines import content_lines, decimal_hint, read_number
from gcs.plan.formats.wpl_pb import waypoint_blocks
from gcs.plan.model import AutopilotName, Frame, Geodetic, Geographic, Item, Plan
from gcs.steps import Steps
from gcs.wire.ids import Cmd

HEADER = "QGC WPL 110"
_HEADER_100 = "QGC WPL 100"
_HEADER_PB = "QGC WPL PB 110"
_WHOLE = ("seq", "current", "frame", "command", "autocontinue")
_NUMBERS = ("p1", "p2", "p3", "p4", "lat", "lon", "alt")
_COLUMNS = {
    HEADER: (*_WHOLE[:4], *_NUMBERS, "autocontinue"),
    _HEADER_100: (
        *("seq", "frame", "command", "p3", "p4", "p1", "p2", "current"),
        *("lon", "lat", "alt", "unused", "autocontinue"),
    ),
}
_COMMANDS_100 = {
    2: Cmd.NAV_TAKEOFF,
    3: Cmd.NAV_RETURN_TO_LAUNCH,
    4: Cmd.NAV_LAND,
    24: Cmd.NAV_TAKEOFF,
    25: Cmd.NAV_WAYPOINT,
    26: Cmd.NAV_LAND,
    27: Cmd.NAV_LOITER_UNLIM,
}
_RELATIVE = (Frame.HOME, Frame.TERRAIN)
_SEQ_MAX = 65535
ROWS_MAX = 10_000
"""No autopilot stores so many, and who verifies more is busy for minutes."""
ITEMS_A_STEP = 50


@dataclass(frozen=True, slots=True)
class _Row:
    seq: int
    line: str
    item: Item


def read_wpl(file: str, data: bytes, name: str, autopilot: AutopilotName | None) -> Steps[Plan]:
    """Raises PlanError with the line.  `notes` says what was decided about home."""
    notes: list[Finding] = []
    rows = yield from _read_rows(file, data, notes)
    _check_sequence(file, rows, notes)
    items, fence, rally = split_fence(file, [row.item for row in rows])
    kept = {item.do_jump_id for item in items}
    rows = [row for row in rows if row.item.do_jump_id in kept]
    home, flown = _decide_home(rows, autopilot, notes) if rows else (None, rows)
    return Plan(
        name,
        autopilot if autopilot is not None else ("ardupilot" if len(flown) < len(rows) else None),
        home,
        _named(file, flown),
        fence,
        rally,
        source=file,
        notes=tuple(notes),
    )


def _read_rows(file: str, data: bytes, notes: list[Finding]) -> Steps[list[_Row]]:
    lines = content_lines(file, data)
    where, first = next(lines, ("1", ""))
    header = " ".join(first.split())
    if header == _HEADER_PB:
        rows_of_text = waypoint_blocks(file, lines)
    elif header in _COLUMNS:
        rows_of_text = (_cells(file, *line, _COLUMNS[header]) for line in lines)
    else:
        told = " or ".join(f'"{known}"' for known in (HEADER, _HEADER_100, _HEADER_PB))
        raise PlanError(file, where, "header", f'is "{header[:40]}"', told)
    rows: list[_Row] = []
    for where, cells in rows_of_text:
        if len(rows) % ITEMS_A_STEP == 0:
            yield
        if len(rows) == ROWS_MAX:
            raise PlanError(file, where, "line", "is one too many", f"at most {ROWS_MAX} items")
        rows.append(_read_row(file, where, cells, header, notes))
    return rows


def _cells(
    file: str, where: str, line: str, columns: tuple[str, ...]
) -> tuple[str, dict[str, str]]:
    fields = line.split()
    if len(fields) != len(columns):
        expected = f"{len(columns)}: {' '.join(columns)}"
        raise PlanError(
            file, where, "line", f"has {len(fields)} fields", expected, decimal_hint(line)
        )
    return where, dict(zip(columns, fields, strict=True))


def _read_row(
    file: str, where: str, cells: dict[str, str], header: str, notes: list[Finding]
) -> _Row:
    whole = {name: _read_whole(file, where, name, cells[name]) for name in _WHOLE}
    command = whole["command"]
    if header == _HEADER_100:
        if command not in _COMMANDS_100:
            told = ", ".join(map(str, sorted(_COMMANDS_100)))
            raise PlanError(file, where, "command", f"{command} is no action of {header}", told)
        command = _COMMANDS_100[command]
    item = item_from_numbers(
        file,
        where,
        command,
        whole["frame"],
        [_read_field(file, where, name, cells[name], notes) for name in _NUMBERS],
        whole["seq"] + 1,
        whole["autocontinue"] != 0,
    )
    return _Row(whole["seq"], where, item)


def _read_whole(file: str, where: str, name: str, text: str) -> int:
    value = read_number(file, where, name, text)
    if not (0 <= value <= _SEQ_MAX and value == int(value)):
        raise PlanError(file, where, name, f"is {value:g}", "a whole number")
    return int(value)


def _read_field(file: str, where: str, name: str, text: str, notes: list[Finding]) -> float:
    if text.lower() == "nan":
        what = "is NaN as text, read as not set"
        notes.append(Finding(Level.WARNING, where, name, what, "not every program reads this"))
        return math.nan
    return read_number(file, where, name, text)


def _check_sequence(file: str, rows: list[_Row], notes: list[Finding]) -> None:
    """Gaps are renumbered and told; repeats and steps back have no safe meaning."""
    for position, row in enumerate(rows):
        before = rows[position - 1].seq if position else -1
        if row.seq <= before:
            what = f"{row.seq} follows {before}: it " + (
                "repeats" if row.seq == before else "steps back"
            )
            raise PlanError(file, row.line, "seq", what, str(before + 1))
        if row.seq != before + 1:
            what = f"{row.seq} follows {before}: it jumps" if position else f"starts at {row.seq}"
            hint = "items are renumbered in their order"
            notes.append(Finding(Level.WARNING, row.line, "seq", what, hint))


def _decide_home(
    rows: list[_Row], autopilot: AutopilotName | None, notes: list[Finding]
) -> tuple[Geodetic | None, list[_Row]]:
    """Home, and the rows that are flown."""
    first = rows[0]
    place = first.item.place
    told = f"item {first.seq}"
    if not (isinstance(place, Geographic) and _looks_like_home(first)):
        if autopilot == "ardupilot":
            what = "is not home, so it is flown; home goes before it at upload"
            hint = "ArduPilot's own files carry home as item 0"
            notes.append(Finding(Level.WARNING, first.line, told, what, hint))
        return None, rows
    if autopilot == "px4" and not _first_must_be_home(rows):
        what = "could be home, but PX4 files carry none: it is flown as the first waypoint"
        hint = "read it with --autopilot ardupilot if it is home"
        notes.append(Finding(Level.WARNING, first.line, told, what, hint))
        return None, rows
    if place.here:
        what = "is where home goes, and is 0, 0: no home was given"
        notes.append(Finding(Level.NOTE, first.line, told, what))
        return None, rows[1:]
    notes.append(Finding(Level.NOTE, first.line, told, "is home, so it is not flown"))
    return Geodetic(place.lat_deg, place.lon_deg, place.alt_m), rows[1:]


def _looks_like_home(row: _Row) -> bool:
    """A bare waypoint above mean sea level, with every parameter zero."""
    item = row.item
    return (
        item.command == Cmd.NAV_WAYPOINT
        and item.frame is Frame.AMSL
        and not any(item.params)
        and isinstance(item.place, Geographic)
        and not any(math.isnan(n) for n in item.place)
    )


def _first_must_be_home(rows: list[_Row]) -> bool:
    """Whether the second item shows that the first is home: it is a take-off, or its height counts
    from home or terrain."""
    if len(rows) == 1:
        return False
    follower = rows[1].item
    return follower.command == Cmd.NAV_TAKEOFF or follower.frame in _RELATIVE


def _named(file: str, rows: list[_Row]) -> tuple[Item, ...]:
    """Give every flown item its do_jump_id, from 1, and point the DO_JUMPs at them."""
    ids = {row.seq: index for index, row in enumerate(rows, start=1)}
    return tuple(
        replace(row.item, do_jump_id=ids[row.seq], params=_jump_params(file, row, ids))
        for row in rows
    )


def _jump_params(file: str, row: _Row, ids: dict[int, int]) -> tuple[float, float, float, float]:
    params = row.item.params
    if row.item.command != Cmd.DO_JUMP:
        return params
    target = ids.get(int(params[0])) if params[0] == params[0] // 1 else None
    if target is None:
        raise PlanError(
            file,
            row.line,
            "DO_JUMP",
            f"jumps to seq {params[0]:g}",
            "the seq of an item that is flown",
        )
    return (float(target), *params[1:])
