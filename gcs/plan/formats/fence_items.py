"""A fence as mission items 5000 to 5004 and rally points as 5100, as WPL files hold them."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from gcs.plan import commands
from gcs.plan.errors import PlanError
from gcs.plan.model import (
    BreachReturn,
    Circle,
    EastNorth,
    Fence,
    Geographic,
    Item,
    LatLon,
    Polygon,
    RallyPoint,
    Zone,
    open_ring,
)
from gcs.wire.ids import Cmd

_VERTEX = {
    True: Cmd.NAV_FENCE_POLYGON_VERTEX_INCLUSION,
    False: Cmd.NAV_FENCE_POLYGON_VERTEX_EXCLUSION,
}
_CIRCLE = {True: Cmd.NAV_FENCE_CIRCLE_INCLUSION, False: Cmd.NAV_FENCE_CIRCLE_EXCLUSION}
_INCLUDES = {Cmd.NAV_FENCE_POLYGON_VERTEX_INCLUSION, Cmd.NAV_FENCE_CIRCLE_INCLUSION}
_MIN_CORNERS = 3
_OTHER_KINDS = frozenset({*range(5000, 5200)} - {*range(5000, 5005), 5100})
"""Numbers that MAVLink sets aside for fences and rally points, such as 5005; none is flown."""


@dataclass(frozen=True, slots=True)
class FenceRow:
    """One item of a fence: `p1` is a polygon's corner count, or a circle's radius in metres."""

    command: int
    p1: float
    lat_deg: float
    lon_deg: float
    alt_m: float = 0.0


def fence_rows(source: str, fence: Fence) -> Iterator[FenceRow]:
    """Corners in order, every one with the count of its polygon.

    Raises PlanError for a zone in metres.  Floors and ceilings have no place in these items.
    """
    if fence.breach_return is not None:
        to = fence.breach_return
        yield FenceRow(Cmd.NAV_FENCE_RETURN_POINT, 0.0, to.lat_deg, to.lon_deg, to.alt_above_home_m)
    for zone in fence.zones:
        if isinstance(zone.shape, Circle):
            centre = _geographic(source, zone, zone.shape.centre)
            yield FenceRow(_CIRCLE[zone.inclusion], zone.shape.radius_m, *centre)
        else:
            corners = zone.shape.corners
            for corner in corners:
                place = _geographic(source, zone, corner)
                yield FenceRow(_VERTEX[zone.inclusion], float(len(corners)), *place)


def _geographic(source: str, zone: Zone, point: LatLon | EastNorth) -> LatLon:
    if isinstance(point, EastNorth):
        raise PlanError(
            source,
            zone.where,
            f"fence zone {zone.name}",
            "is in metres from the take-off point, which fence items cannot say",
            hint="give the place of home, so that it can be placed on Earth",
        )
    return point


def split_fence(
    file: str, items: Sequence[Item]
) -> tuple[tuple[Item, ...], Fence, tuple[RallyPoint, ...]]:
    """The mission, the fence and the rally points among `items`.

    Raises PlanError for a polygon whose corner count does not hold, or a circle without radius.
    """
    flown: list[Item] = []
    zones: list[Zone] = []
    rally: list[RallyPoint] = []
    breach: BreachReturn | None = None
    index = 0
    while index < len(items):
        item = items[index]
        index += 1
        if item.command in _VERTEX.values():
            zones.append(_polygon(file, items[index - 1 :]))
            index += int(item.params[0]) - 1
        elif item.command in _CIRCLE.values():
            zones.append(_circle(file, item))
        elif item.command == Cmd.NAV_FENCE_RETURN_POINT:
            to = _position(file, item)
            breach = BreachReturn(to.lat_deg, to.lon_deg, to.alt_m)
        elif item.command == Cmd.NAV_RALLY_POINT:
            to = _position(file, item)
            rally.append(RallyPoint(to.lat_deg, to.lon_deg, to.alt_m, item.where))
        elif item.command in _OTHER_KINDS:
            raise PlanError(
                file,
                item.where,
                commands.name(item.command),
                "is a part of a fence or of rally points of a kind that is not known here",
                "5000 to 5004, or 5100",
                hint="what is left out of a fence is not guarded: take it out of the file",
            )
        else:
            flown.append(item)
    return tuple(flown), Fence(tuple(zones), breach), tuple(rally)


def _position(file: str, item: Item) -> Geographic:
    if isinstance(item.place, Geographic) and not any(n != n for n in item.place):
        return item.place
    raise PlanError(file, item.where, commands.name(item.command), "has no position")


def _polygon(file: str, items: Sequence[Item]) -> Zone:
    """The polygon that starts with the first of `items`."""
    first = items[0]
    label = commands.name(first.command)
    count = first.params[0]
    if not (count >= _MIN_CORNERS and count == int(count)):
        raise PlanError(
            file, first.where, label, f"corner count {count:g}", f"at least {_MIN_CORNERS}, whole"
        )
    corners = items[: int(count)]
    for corner in corners:
        if corner.command != first.command or corner.params[0] != count:
            raise PlanError(
                file,
                corner.where,
                commands.name(corner.command),
                "stands inside a polygon that began before it",
                f"{label} with param1 = {count:g}",
            )
    if len(corners) < count:
        raise PlanError(
            file,
            first.where,
            label,
            f"the polygon has {len(corners)} corners of {count:g}",
            hint="is the file whole?",
        )
    places = tuple(LatLon(*_position(file, corner)[:2]) for corner in corners)
    return _zone(Polygon(open_ring(places)), first)


def _circle(file: str, item: Item) -> Zone:
    radius_m = item.params[0]
    if not radius_m > 0.0:
        label = commands.name(item.command)
        raise PlanError(file, item.where, label, f"radius {radius_m:g}", "metres in param1")
    return _zone(Circle(LatLon(*_position(file, item)[:2]), radius_m), item)


def _zone(shape: Polygon | Circle, item: Item) -> Zone:
    return Zone(shape, item.command in _INCLUDES, name=f"at {item.where}", where=item.where)
