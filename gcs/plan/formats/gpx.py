"""GPX 1.0 and 1.1 -> Plan: the route, or else the track, as waypoints above mean sea level.

`<ele>` is the height above mean sea level.  Single `<wpt>` have no order and are no route; one of
`<type>` home, as `gpx_writer.py` writes it, is the planned home.
"""

from __future__ import annotations

from gcs.plan.errors import Finding, Level
from gcs.plan.formats.kml import route_items
from gcs.plan.formats.text_lines import read_lat_lon, read_number
from gcs.plan.formats.xml_tree import Element
from gcs.plan.model import UNSET, Frame, Geodetic, Geographic, Plan
from gcs.steps import Steps


def read_gpx(top: Element, name: str) -> Steps[Plan]:
    """Raises PlanError with the line."""
    notes: list[Finding] = []
    home: Geodetic | None = None
    loose = [point for point in top.children if point.name == "wpt"]
    for point in loose:
        if point.text_of("type") == "home":
            place = _place(point)
            alt_m = None if place.alt_m != place.alt_m else place.alt_m
            home = Geodetic(place.lat_deg, place.lon_deg, alt_m)
            loose.remove(point)
            break
    line = _line(top, loose)
    if loose:
        what = f"{len(loose)} single waypoints have no order and are no part of the route: left out"
        notes.append(Finding(Level.NOTE, loose[0].where, "<wpt>", what))
    segments = [part for part in line.children if part.name == "trkseg"]
    if len(segments) > 1:
        what = f"has {len(segments)} segments: the gaps between them are flown straight"
        notes.append(Finding(Level.WARNING, segments[1].where, "<trkseg>", what))
    points = list(line.every("rtept", "trkpt"))
    if not points:
        raise line.error("has no points")
    without = [point for point in points if not point.text_of("ele")]
    if without:
        what = f"{len(without)} of {len(points)} points have no height (<ele>)"
        hint = "`gcs mission convert --height M` gives them one above home"
        notes.append(Finding(Level.WARNING, without[0].where, f"<{points[0].name}>", what, hint))
    items = yield from route_items(line, Frame.AMSL, map(_place, points))
    title = line.text_of("name") or name
    return Plan(title, None, home, items, source=top.file, notes=tuple(notes))


def _line(top: Element, loose: list[Element]) -> Element:
    lines = [part for part in top.children if part.name in ("rte", "trk")]
    if not lines:
        hint = f"its {len(loose)} single waypoints have no order" if loose else ""
        raise top.error("has no route and no track", "one <rte> or <trk>", hint)
    if len(lines) > 1:
        raise lines[1].error(
            f"is one of {len(lines)} routes and tracks, and which of them is flown nobody knows",
            "one a file",
            f"the first one is in line {lines[0].line}: leave one in the file",
        )
    return lines[0]


def _place(point: Element) -> Geographic:
    label = f"<{point.name}>"
    texts = (point.attributes.get("lat", ""), point.attributes.get("lon", ""))
    place = read_lat_lon(point.file, point.where, label, *texts)
    ele = point.text_of("ele")
    alt_m = read_number(point.file, point.where, f"{label}: ele", ele) if ele else UNSET
    return Geographic(*place, alt_m)
