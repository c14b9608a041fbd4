"""The older lists of points of MAVProxy and Mission Planner: fence.txt and rally.txt.

fence.txt has a latitude and a longitude a line: the first is where a vehicle that left the fence
returns to, then come the corners, and the last line repeats the first corner.  rally.txt has
`RALLY lat lon alt break_alt land_dir flags` a line, `alt` in metres above home (RALLY_POINT).
"""

from __future__ import annotations

import re

from gcs.plan.errors import Finding, Level, PlanError
from gcs.plan.formats.text_lines import content_lines, decimal_hint, read_lat_lon, read_number
from gcs.plan.model import BreachReturn, Fence, LatLon, Plan, Polygon, RallyPoint, Zone

FENCE_START = re.compile(
    rb"(?:#[^\n]*\n\s*)*[+-]?\d+(?:[.,]\d*)?[ \t]+[+-]?\d+(?:[.,]\d*)?\s*(?:\n|$)"
)
RALLY_START = re.compile(rb"(?:#[^\n]*\n\s*)*RALLY\s", re.IGNORECASE)
_LEAST_LINES = 5
_RALLY_FIELDS = ("RALLY", "lat", "lon", "alt", "break_alt", "land_dir", "flags")


def read_fence_list(file: str, data: bytes, name: str) -> Plan:
    """One inclusion polygon and its return point.  Raises PlanError with the line."""
    points: list[tuple[str, LatLon]] = []
    for where, line in content_lines(file, data):
        fields = line.split()
        if len(fields) != 2:
            what = f"has {len(fields)} fields"
            raise PlanError(file, where, "line", what, "2: lat lon", decimal_hint(line))
        label = "corner" if points else "return point"
        points.append((where, LatLon(*read_lat_lon(file, where, label, *fields))))
    last_line, last = points[-1]
    if len(points) < _LEAST_LINES:
        what = f"the list ends after {len(points)} points"
        expected = "a return point, at least 3 corners, and the first corner again"
        raise PlanError(file, last_line, "fence", what, expected)
    (return_line, return_point), (first_line, first) = points[:2]
    if last != first:
        what = f"is {last.lat_deg:.6f} {last.lon_deg:.6f}, which does not close the polygon"
        expected = f"the point of line {first_line} again"
        hint = "the first line of such a file is the return point, the second the first corner"
        raise PlanError(file, last_line, "last point", what, expected, hint)
    corners = tuple(point for _, point in points[1:-1])
    zone = Zone(Polygon(corners), inclusion=True, name=f"at {first_line}", where=first_line)
    what = "this kind of file gives it no height: 0 m above home is taken"
    note = Finding(Level.NOTE, return_line, "return point", what)
    fence = Fence((zone,), BreachReturn(*return_point, 0.0))
    return Plan(name, None, None, fence=fence, source=file, notes=(note,))


def read_rally_list(file: str, data: bytes, name: str) -> Plan:
    """Rally points alone.  Raises PlanError with the line."""
    rally: list[RallyPoint] = []
    notes: list[Finding] = []
    for where, line in content_lines(file, data):
        fields = line.split()
        label = f"rally point {len(rally) + 1}"
        if len(fields) != len(_RALLY_FIELDS) or fields[0].upper() != "RALLY":
            what = f'is "{line[:40]}"'
            expected = " ".join(_RALLY_FIELDS)
            raise PlanError(file, where, label, what, expected, decimal_hint(line))
        place = read_lat_lon(file, where, label, fields[1], fields[2])
        numbers = [
            read_number(file, where, f"{label}: {column}", text)
            for column, text in zip(_RALLY_FIELDS[3:], fields[3:], strict=True)
        ]
        rally.append(RallyPoint(*place, numbers[0], where))
        if any(numbers[1:]):
            what = "its break altitude, landing direction and flags are for aeroplanes: left out"
            notes.append(Finding(Level.NOTE, where, label, what))
    return Plan(name, None, None, rally=tuple(rally), source=file, notes=tuple(notes))
