"""KML -> Plan: a line string is the route, polygons are the fence.

A polygon is stayed inside, and its inner rings are stayed out of.  What KML has no word for stands
in `<ExtendedData>`, as `kml_writer.py` writes it: `mavgate` says what a placemark is (`exclusion`,
`home`, `rally`, `return_point`), `floor_above_home_m` and the like give its heights.

`altitudeMode` says what a route's heights count from: absolute is mean sea level,
relativeToGround the terrain below, clampToGround (the default) means that it has none.
"""

from __future__ import annotations

import re
from collections.abc import Iterator

from gcs.plan.errors import Finding, Level
from gcs.plan.formats.text_lines import read_lat_lon, read_number
from gcs.plan.formats.xml_tree import Element
from gcs.plan.model import (
    UNSET,
    BreachReturn,
    Fence,
    Frame,
    Geodetic,
    Geographic,
    Item,
    LatLon,
    Plan,
    Polygon,
    RallyPoint,
    Zone,
    open_ring,
)
from gcs.steps import Steps
from gcs.wire.ids import Cmd

ITEMS_MAX = 10_000
ITEMS_A_STEP = 50
_FRAMES = {"absolute": Frame.AMSL, "relativeToGround": Frame.TERRAIN, "clampToGround": None}
_MIN_CORNERS = 3


def read_kml(top: Element, name: str) -> Steps[Plan]:
    """Raises PlanError with the line."""
    notes: list[Finding] = []
    zones: list[Zone] = []
    rally: list[RallyPoint] = []
    lines: list[Element] = []
    home, breach, unused = None, None, list[Element]()
    for placemark in top.every("Placemark"):
        yield
        data = _extended(placemark)
        kind = data.get("mavgate", "")
        for shape in placemark.every("Point", "LineString", "Track", "Polygon", "LinearRing"):
            if shape.name == "Polygon":
                zones += _zones(placemark, shape, data, inclusion=kind != "exclusion")
            elif shape.name == "LineString":
                lines.append(shape)
            elif shape.name == "Track":
                what = "is a recorded track (gx:Track), which is not read"
                raise shape.error(what, "a <LineString>")
            elif shape.name == "Point" and kind == "home":
                (place,) = _points(shape)
                home = Geodetic(place.lat_deg, place.lon_deg, _none_if_nan(place.alt_m))
            elif shape.name == "Point" and kind in ("rally", "return_point"):
                (place,) = _points(shape)
                up_m = _number(placemark, data, "alt_above_home_m") or 0.0
                if kind == "rally":
                    rally.append(RallyPoint(place.lat_deg, place.lon_deg, up_m, shape.where))
                else:
                    breach = BreachReturn(place.lat_deg, place.lon_deg, up_m)
            elif shape.name == "Point":
                unused.append(shape)
    if unused:
        what = f"{len(unused)} single points are neither route nor fence: left out"
        notes.append(Finding(Level.NOTE, unused[0].where, "<Point>", what))
    items = yield from _route(lines, notes)
    if not (items or zones or rally):
        hint = "draw the route as a path, the fence as a polygon"
        raise top.error("has no line string and no polygon", "a route or a fence", hint)
    document = top.find("Document")
    title = "" if document is None else document.text_of("name")
    fence = Fence(tuple(zones), breach)
    return Plan(
        title or name,
        None,
        home,
        items,
        fence,
        tuple(rally),
        source=top.file,
        notes=tuple(notes),
    )


def _extended(placemark: Element) -> dict[str, str]:
    return {
        data.attributes.get("name", ""): data.text_of("value")
        for extended in placemark.children
        if extended.name == "ExtendedData"
        for data in extended.every("Data")
    }


def _number(placemark: Element, data: dict[str, str], key: str) -> float | None:
    text = data.get(key)
    return None if text is None else read_number(placemark.file, placemark.where, key, text)


def _none_if_nan(value: float) -> float | None:
    return None if value != value else value


def _route(lines: list[Element], notes: list[Finding]) -> Steps[tuple[Item, ...]]:
    if not lines:
        return ()
    if len(lines) > 1:
        raise lines[1].error(
            f"is one of {len(lines)} line strings, and which of them is flown nobody knows",
            "one route a file",
            f"the first one is in line {lines[0].line}: leave one in the file",
        )
    (line,) = lines
    mode = line.text_of("altitudeMode") or "clampToGround"
    if mode not in _FRAMES:
        told = ", ".join(_FRAMES)
        raise line.error(f'has altitudeMode "{mode}"', told)
    frame = _FRAMES[mode]
    if frame is None:
        what = "lies on the ground (clampToGround): its points have no height"
        hint = "`gcs mission convert --height M` gives them one above home"
        notes.append(Finding(Level.WARNING, line.where, "<LineString>", what, hint))
    if frame is Frame.TERRAIN:
        what = "has heights above the ground, for which a flight needs a model of the terrain"
        hint = "`gcs mission convert --height M` gives them one above home"
        notes.append(Finding(Level.WARNING, line.where, "<LineString>", what, hint))
    places = _points(line)
    if frame is None:
        places = (place._replace(alt_m=UNSET) for place in places)
    return (yield from route_items(line, Frame.HOME if frame is None else frame, places))


def route_items(at: Element, frame: Frame, places: Iterator[Geographic]) -> Steps[tuple[Item, ...]]:
    """A plain waypoint a place.  Raises PlanError where there are too many."""
    items: list[Item] = []
    for number, place in enumerate(places, start=1):
        if number % ITEMS_A_STEP == 0:
            yield
        if number > ITEMS_MAX:
            raise at.error("has too many points", f"at most {ITEMS_MAX}")
        params = (0.0, 0.0, 0.0, UNSET)
        items.append(Item(Cmd.NAV_WAYPOINT, frame, params, place, number, where=at.where))
    return tuple(items)


def _zones(
    placemark: Element, polygon: Element, data: dict[str, str], *, inclusion: bool
) -> Iterator[Zone]:
    """The outer ring, and each inner ring the other way."""
    floor_m = _number(placemark, data, "floor_above_home_m")
    ceiling_m = _number(placemark, data, "ceiling_above_home_m")
    name = placemark.text_of("name") or f"at {polygon.where}"
    for ring in polygon.every("outerBoundaryIs"):
        yield Zone(_ring(ring), inclusion, floor_m, ceiling_m, name, ring.where)
    for ring in polygon.every("innerBoundaryIs"):
        if not inclusion:
            raise ring.error("is a hole in a zone to stay out of, which no fence can say")
        yield Zone(
            _ring(ring), False, floor_m, ceiling_m, f"{name}, hole at {ring.where}", ring.where
        )


def _ring(boundary: Element) -> Polygon:
    corners = tuple(LatLon(p.lat_deg, p.lon_deg) for p in _points(boundary))
    ring = open_ring(corners)
    if len(ring) < _MIN_CORNERS:
        raise boundary.error(f"has {len(ring)} corners", f"at least {_MIN_CORNERS}")
    return Polygon(ring)


def _points(shape: Element) -> Iterator[Geographic]:
    """`lon,lat,alt` after `lon,lat,alt`; NaN where one has no height.

    Raises PlanError with the line of the coordinate, for none at all too.
    """
    coordinates = next(shape.every("coordinates"), None)
    if coordinates is None or not coordinates.text:
        raise shape.error("has no <coordinates>")
    raw = "".join(coordinates.pieces)
    for found in re.finditer(r"\S+", raw):
        where = str(coordinates.line + raw.count("\n", 0, found.start()))
        parts = found[0].split(",")
        if len(parts) not in (2, 3) or not all(parts[:2]):
            raise Element(shape.file, int(where), "coordinates", {}).error(
                f'has "{found[0][:40]}"', "lon,lat or lon,lat,alt without blanks"
            )
        place = read_lat_lon(shape.file, where, "<coordinates>", parts[1], parts[0])
        alt = parts[2] if len(parts) == 3 and parts[2] else None
        alt_m = UNSET if alt is None else read_number(shape.file, where, "altitude", alt)
        yield Geographic(*place, alt_m)
