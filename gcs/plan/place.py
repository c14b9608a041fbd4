"""A plan in metres from the take-off point -> the same plan on Earth, and back."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from typing import TypeAlias

from gcs.plan.legs import NorthEastOf
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
from gcs.wire.ids import Cmd

LatLonOf: TypeAlias = Callable[[float, float], tuple[float, float]]
"""(north_m, east_m) of the vehicle's local origin -> (lat_deg, lon_deg): the vehicle's own
projection, so that the vehicle flies back to the metres that were meant."""

_DIGITS = 7
"""Decimal places of a degree that MISSION_ITEM_INT carries.  Rounded before it is verified, a
place is flown exactly as it was verified."""
_FINEST = 5
"""Digits of a metre that are more than these say nothing."""


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


def in_metres(plan: Plan, north_east_of: NorthEastOf, lat_lon_of: LatLonOf, home: Geodetic) -> Plan:
    """Every place in degrees becomes one in metres from `home`, which `north_east_of` counts from.

    They have so few digits as are needed to come back to the same seven digits of a degree.

    A take-off that is the first item and has no place of its own is at home.  Heights above
    terrain, heights above the sea where that of home is not known, and other items without a place
    stay as they are.
    """

    def metres(lat_deg: float, lon_deg: float) -> tuple[float, float]:
        exact = north_east_of(lat_deg, lon_deg)
        wanted = (round(lat_deg, _DIGITS), round(lon_deg, _DIGITS))
        for digits in range(1, _FINEST):
            north_m, east_m = (round(value, digits) for value in exact)
            lat_back, lon_back = lat_lon_of(north_m, east_m)
            if (round(lat_back, _DIGITS), round(lon_back, _DIGITS)) == wanted:
                return north_m, east_m
        return exact

    def local_item(index: int, item: Item) -> Item:
        place = item.place
        if not isinstance(place, Geographic) or item.frame is Frame.TERRAIN:
            return item
        up_m = place.alt_m
        if item.frame is Frame.AMSL:
            up_m -= math.nan if home.alt_amsl_m is None else home.alt_amsl_m
        at_home = index == 0 and item.command == Cmd.NAV_TAKEOFF and place.here
        if math.isnan(up_m) or (place.here and not at_home):
            return item
        north_east = (0.0, 0.0) if at_home else metres(place.lat_deg, place.lon_deg)
        return replace(item, frame=Frame.LOCAL, place=Local(*north_east, up_m))

    def local_point(point: LatLon | EastNorth) -> EastNorth:
        if isinstance(point, EastNorth):
            return point
        north_m, east_m = metres(*point)
        return EastNorth(east_m, north_m)

    def local_zone(zone: Zone) -> Zone:
        shape = zone.shape
        if isinstance(shape, Circle):
            return replace(zone, shape=Circle(local_point(shape.centre), shape.radius_m))
        return replace(zone, shape=Polygon(tuple(local_point(c) for c in shape.corners)))

    return replace(
        plan,
        items=tuple(local_item(index, item) for index, item in enumerate(plan.items)),
        fence=Fence(tuple(map(local_zone, plan.fence.zones)), plan.fence.breach_return),
    )
