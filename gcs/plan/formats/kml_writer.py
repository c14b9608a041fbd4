"""Plan -> KML 2.2: the route as a line above mean sea level, zones as polygons, points.

What KML has no word for stands in `<ExtendedData>`; `kml.py` reads it back.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

from gcs.gate.airspace.projection import Origin, Projection
from gcs.plan.errors import PlanError
from gcs.plan.formats.losses import Losses, Written
from gcs.plan.formats.qgc_plan_writer import local_refused
from gcs.plan.formats.route_points import route_points
from gcs.plan.formats.xml_text import escaped
from gcs.plan.model import Circle, EastNorth, LatLon, Plan, Zone

_CORNERS = 72


def write_kml(plan: Plan) -> Written:
    """Raises PlanError for a plan in metres, or with heights above a home that is not known."""
    losses = Losses(plan)
    losses.settings(home=False, firmware=True)
    lines = [
        '<?xml version="1.0" encoding="UTF-8"?>',
        '<kml xmlns="http://www.opengis.net/kml/2.2">',
        "<Document>",
        f"  <name>{escaped(plan.name)}</name>",
        *_placemarks(plan, losses),
        "</Document>",
        "</kml>",
    ]
    return Written(("\n".join(lines) + "\n").encode(), losses.found())


def _placemarks(plan: Plan, losses: Losses) -> Iterator[str]:
    home = plan.home
    if home is not None:
        yield from _point("home", (home.lat_deg, home.lon_deg), home.alt_amsl_m, "home")
    places = list(route_points(plan, losses))
    if not (places or plan.fence.zones or plan.rally):
        raise PlanError(plan.source or plan.name, "", "plan", "has neither route nor fence to keep")
    if places:
        yield "  <Placemark>"
        yield "    <name>route</name>"
        yield "    <LineString>"
        if not any(math.isnan(place.alt_m) for place in places):
            yield "      <altitudeMode>absolute</altitudeMode>"
        elif not all(math.isnan(place.alt_m) for place in places):
            losses.of_plan("heights", "some places have none, and so none is kept")
        yield "      <coordinates>"
        for place in places:
            alt = "" if math.isnan(place.alt_m) else f",{place.alt_m!r}"
            yield f"        {place.lon_deg!r},{place.lat_deg!r}{alt}"
        yield "      </coordinates>"
        yield "    </LineString>"
        yield "  </Placemark>"
    for number, zone in enumerate(plan.fence.zones, start=1):
        yield from _zone(plan, zone, zone.name or f"zone {number}", losses)
    breach = plan.fence.breach_return
    if breach is not None:
        at = (breach.lat_deg, breach.lon_deg)
        up = {"alt_above_home_m": breach.alt_above_home_m}
        yield from _point("return point", at, None, "return_point", up)
    for number, point in enumerate(plan.rally, start=1):
        at = (point.lat_deg, point.lon_deg)
        up = {"alt_above_home_m": point.alt_above_home_m}
        yield from _point(f"rally point {number}", at, None, "rally", up)


def _point(
    name: str,
    at: tuple[float, float],
    alt_amsl_m: float | None,
    kind: str,
    numbers: dict[str, float] | None = None,
) -> Iterator[str]:
    yield "  <Placemark>"
    yield f"    <name>{escaped(name)}</name>"
    yield from _data(kind, numbers or {})
    mode = "" if alt_amsl_m is None else "<altitudeMode>absolute</altitudeMode>"
    alt = "" if alt_amsl_m is None else f",{alt_amsl_m!r}"
    yield f"    <Point>{mode}<coordinates>{at[1]!r},{at[0]!r}{alt}</coordinates></Point>"
    yield "  </Placemark>"


def _data(kind: str, numbers: dict[str, float]) -> Iterator[str]:
    yield "    <ExtendedData>"
    for name, value in {"mavgate": kind, **{key: repr(n) for key, n in numbers.items()}}.items():
        yield f'      <Data name="{name}"><value>{value}</value></Data>'
    yield "    </ExtendedData>"


def _zone(plan: Plan, zone: Zone, name: str, losses: Losses) -> Iterator[str]:
    heights = {
        "floor_above_home_m": zone.floor_above_home_m,
        "ceiling_above_home_m": zone.ceiling_above_home_m,
    }
    yield "  <Placemark>"
    yield f"    <name>{escaped(name)}</name>"
    kind = "inclusion" if zone.inclusion else "exclusion"
    yield from _data(kind, {key: value for key, value in heights.items() if value is not None})
    yield "    <Polygon><outerBoundaryIs><LinearRing><coordinates>"
    corners = _corners(plan, zone, losses)
    for corner in (*corners, corners[0]):
        yield f"      {corner.lon_deg!r},{corner.lat_deg!r}"
    yield "    </coordinates></LinearRing></outerBoundaryIs></Polygon>"
    yield "  </Placemark>"


def _corners(plan: Plan, zone: Zone, losses: Losses) -> Sequence[LatLon]:
    shape = zone.shape
    points = (shape.centre,) if isinstance(shape, Circle) else shape.corners
    corners = [point for point in points if isinstance(point, LatLon)]
    if any(isinstance(point, EastNorth) for point in points):
        raise local_refused(plan, zone.where, f"fence zone {zone.name}")
    if not isinstance(shape, Circle):
        return corners
    losses.of_plan(
        f"fence zone {zone.name}",
        f"its circle is kept as a polygon of {_CORNERS} corners, on the safe side",
        where=zone.where,
    )
    return _polygon_of(corners[0], shape.radius_m, inclusion=zone.inclusion)


def _polygon_of(centre: LatLon, radius_m: float, *, inclusion: bool) -> Sequence[LatLon]:
    """Inside the circle that is stayed inside, about the one that is stayed out of: what is allowed
    with it was allowed before."""
    reach_m = radius_m if inclusion else radius_m / math.cos(math.pi / _CORNERS)
    plane = Projection(Origin(centre.lat_deg, centre.lon_deg, 0.0), "px4")
    turns = (2.0 * math.pi * i / _CORNERS for i in range(_CORNERS))
    return [LatLon(*plane.lat_lon(reach_m * math.cos(a), reach_m * math.sin(a))) for a in turns]
