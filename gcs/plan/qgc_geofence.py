"""The geoFence section of a .plan: polygons and circles, inclusion and exclusion."""

from __future__ import annotations

from gcs.plan.errors import Finding, Level
from gcs.plan.json_cursor import Node
from gcs.plan.model import BreachReturn, Circle, Fence, LatLon, Polygon, Zone, open_ring

_MIN_CORNERS = 3
_RADIUS_MAX_M = 1.0e6


def read_fence(node: Node, notes: list[Finding]) -> Fence:
    """`inclusion: false` is an exclusion zone.  Raises PlanError with the JSON path.

    A fence of version 1 or lower is an error, as other programs drop it silently; an empty one
    has nothing to drop and goes into `notes`.
    """
    if node.get("version").integer(0, 1000) < 2:
        corners = node.find("polygon")
        if corners is not None and corners.items():
            raise node.get("version").error(
                "the fence is of an old version, which is ignored elsewhere",
                "2",
                "open the plan in QGroundControl, check the fence, and save again",
            )
        what = "an empty fence of an old version: there is no fence in this file"
        notes.append(Finding(Level.WARNING, node.path, "geoFence", what))
        return Fence()
    node.version(2)
    polygons, circles = node.find("polygons"), node.find("circles")
    zones = [
        *(_read_polygon(entry) for entry in (polygons.items() if polygons else [])),
        *(_read_circle(entry) for entry in (circles.items() if circles else [])),
    ]
    breach = node.find("breachReturn")
    if breach is None:
        return Fence(tuple(zones))
    lat, lon, alt = breach.items(3)
    return Fence(
        tuple(zones),
        BreachReturn(*read_lat_lon(lat, lon), alt.number(-1000.0, 100_000.0)),
    )


def read_lat_lon(lat: Node, lon: Node) -> LatLon:
    return LatLon(lat.number(-90.0, 90.0), lon.number(-180.0, 180.0))


def _read_polygon(entry: Node) -> Zone:
    entry.version(1)
    node = entry.get("polygon")
    corners = tuple(read_lat_lon(*corner.items(2)) for corner in node.items())
    if len(corners) < _MIN_CORNERS:
        raise node.error(f"has {len(corners)} corners", f"at least {_MIN_CORNERS}")
    return _zone(Polygon(open_ring(corners)), entry)


def _read_circle(entry: Node) -> Zone:
    entry.version(1)
    circle = entry.get("circle")
    centre = read_lat_lon(*circle.get("center").items(2))
    radius = circle.get("radius")
    radius_m = radius.number(0.0, _RADIUS_MAX_M)
    if radius_m == 0.0:
        raise radius.error("is 0", "a radius in metres")
    return _zone(Circle(centre, radius_m), entry)


def _zone(shape: Polygon | Circle, entry: Node) -> Zone:
    return Zone(shape, entry.get("inclusion").boolean(), name=entry.path, where=entry.path)
