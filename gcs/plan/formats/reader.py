"""Any mission file -> Plan; what is in the file decides which format it is."""

from __future__ import annotations

import re

from gcs.plan.errors import PlanError
from gcs.plan.formats.csv_table import COLUMNS, read_csv
from gcs.plan.formats.gpx import read_gpx
from gcs.plan.formats.kml import read_kml
from gcs.plan.formats.local_toml import read_local
from gcs.plan.formats.point_lists import (
    FENCE_START,
    RALLY_START,
    read_fence_list,
    read_rally_list,
)
from gcs.plan.formats.qgc_plan import read_plan
from gcs.plan.formats.wpl import read_wpl
from gcs.plan.formats.xml_tree import read_xml
from gcs.plan.model import AutopilotName, Plan
from gcs.steps import Steps, drained

SUPPORTED = (
    "a QGroundControl .plan, a QGC WPL 110 table, a mission in TOML, CSV, KML, GPX, fence.txt or "
    "rally.txt"
)
_TOML_START = re.compile(rb"\s*(?:#[^\n]*\n\s*)*\[{0,2}[A-Za-z_]+[\]\s]*(?:=|\n|$)")
_CSV_START = re.compile(
    rb"(?:#[^\n]*\n\s*)*(?:" + "|".join(COLUMNS).encode() + rb")[ \t]*[,;]", re.ASCII
)
SIZE_MAX = 16 * 1024 * 1024


def read(path_text: str, data: bytes, autopilot: AutopilotName | None = None) -> Plan:
    """As `read_in_steps`, at once."""
    return drained(read_in_steps(path_text, data, autopilot))


def read_in_steps(
    path_text: str, data: bytes, autopilot: AutopilotName | None = None
) -> Steps[Plan]:
    """The plan in `data`, the bytes of the file that users know as `path_text`.

    `autopilot` is the vehicle's, where it is known: whether a waypoint table begins with home
    depends on it.  Raises PlanError, and nothing else, whatever the bytes are.
    """
    name = re.split(r"[/\\]", path_text)[-1].rpartition(".")[0] or path_text
    if len(data) > SIZE_MAX:
        what = f"has {len(data)} bytes"
        raise PlanError(path_text, "", "file", what, f"at most {SIZE_MAX}")
    start = data.removeprefix(b"\xef\xbb\xbf").lstrip()
    if start.startswith(b"{"):
        return (yield from read_plan(path_text, data, name))
    suffix = path_text.lower().rpartition(".")[2]
    if suffix == "toml":
        return read_local(path_text, data, name)
    if re.match(rb"(?:#[^\n]*\n\s*)*QGC\s", start):
        return (yield from read_wpl(path_text, data, name, autopilot))
    if start.startswith(b"<") or suffix in ("kml", "gpx"):
        return (yield from _read_xml(path_text, data, name))
    if start.startswith(b"PK\x03\x04"):
        what, hint = "is a ZIP archive", "a .kmz is one: unpack it and name the .kml that is in it"
        raise PlanError(path_text, "1", "file", what, SUPPORTED, hint)
    if suffix == "csv" or _CSV_START.match(start):
        return (yield from read_csv(path_text, data, name))
    if suffix == "plan":
        return (yield from read_plan(path_text, data, name))
    if suffix in ("waypoints", "wpl"):
        return (yield from read_wpl(path_text, data, name, autopilot))
    if RALLY_START.match(start):
        return read_rally_list(path_text, data, name)
    if FENCE_START.match(start):
        return read_fence_list(path_text, data, name)
    if _TOML_START.match(start):
        return read_local(path_text, data, name)
    what = "is empty" if not start else "is none of the mission files that can be read"
    raise PlanError(path_text, "1", "file", what, SUPPORTED)


def _read_xml(path_text: str, data: bytes, name: str) -> Steps[Plan]:
    yield
    top = read_xml(path_text, data)
    match top.name:
        case "kml":
            return (yield from read_kml(top, name))
        case "gpx":
            return (yield from read_gpx(top, name))
        case _:
            raise top.error("is the outermost element", "<kml> or <gpx>")
