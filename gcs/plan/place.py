"""A plan in metres from the take-off point -> the same plan on Earth, ready for the wire."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import TypeAlias

from gcs.plan.model import (
    Circle,
    EastNorth,
    Fence,
    Frame,
    Geodetic,
    Geographic,
    Item,
    LatLon,
    Local,
    Plan,
    Polygon,
    Zone,
)

LatLonOf: TypeAlias = Callable[[float, float], tuple[float, float]]
"""(north_m, east_m) of the vehicle's local origin -> (lat_deg, lon_deg): the vehicle's own
projection, so that the vehicle flies back to the metres that were meant."""

_DIGITS = 7
"""Decimal places of a degree that MISSION_ITEM_INT carries.  Rounded before it is verified, a
place is flown exactly as it was verified."""


def georeference(
    plan: Plan,
    lat_lon_of: LatLonOf,
    home_north_east: tuple[float, float] = (0.0, 0.0),
    home: Geodetic | None = None,
) -> Plan:
    """Every local item becomes one above home (frame 3); what is geographic stays as it is.

    `home_north_east` is home in metres from the local origin.  `home`, if given, becomes the
    plan's home.
    """
    home_north_m, home_east_m = home_north_east

    def placed(north_m: float, east_m: float) -> LatLon:
        lat_deg, lon_deg = lat_lon_of(home_north_m + north_m, home_east_m + east_m)
        return LatLon(round(lat_deg, _DIGITS), round(lon_deg, _DIGITS))

    def item_on_earth(item: Item) -> Item:
        if not isinstance(item.place, Local):
            return item
        place = Geographic(*placed(item.place.north_m, item.place.east_m), item.place.up_m)
        return replace(item, frame=Frame.HOME, place=place)

    def point_on_earth(point: LatLon | EastNorth) -> LatLon:
        return point if isinstance(point, LatLon) else placed(point.north_m, point.east_m)

    def zone_on_earth(zone: Zone) -> Zone:
        shape = zone.shape
        if isinstance(shape, Circle):
            return replace(zone, shape=Circle(point_on_earth(shape.centre), shape.radius_m))
        return replace(zone, shape=Polygon(tuple(point_on_earth(c) for c in shape.corners)))

    return replace(
        plan,
        home=home if home is not None else plan.home,
        items=tuple(item_on_earth(item) for item in plan.items),
        fence=Fence(tuple(map(zone_on_earth, plan.fence.zones)), plan.fence.breach_return),
    )
