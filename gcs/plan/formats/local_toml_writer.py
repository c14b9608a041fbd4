"""Plan in metres -> our TOML of schema 1 (`local_toml.py`): a take-off, waypoints, an end.

The flight is put together from the items as the reader takes it apart: the speed before a waypoint,
a picture after it.  What has no key is named as lost.
"""

from __future__ import annotations

import json
import math
from collections.abc import Iterator
from dataclasses import dataclass, field

from gcs.plan import commands
from gcs.plan.commands import KINDS, Kind
from gcs.plan.errors import Level, PlanError
from gcs.plan.formats.local_toml import SCHEMA, read_local
from gcs.plan.formats.losses import Losses, Written
from gcs.plan.model import Circle, EastNorth, Item, LatLon, Local, Plan, Polygon, Zone
from gcs.wire.ids import Cmd

_DIGITS = 4
"""Tenths of a millimetre."""
_SAME_M = 0.01
_SLOWEST_M_S = 0.1
_ONE_PICTURE = (0.0, 0.0, 1.0)
_NOT_KEPT = "is not kept by this format"


@dataclass(slots=True)
class _Flight:
    """The keys of the file, in the making."""

    top: dict[str, object]
    waypoints: list[dict[str, object]] = field(default_factory=list)
    next_speed_m_s: float | None = None
    last: Local | None = None
    end: str = "hold"


def write_local(plan: Plan) -> Written:
    """Raises PlanError for a plan in degrees (`in_metres` of `place.py` comes first), for one
    without a waypoint, and for numbers that the schema does not take."""
    losses = Losses(plan)
    if plan.home is not None:
        losses.of_plan("home", "is not kept: metres count from where it takes off", Level.NOTE)
    losses.settings(home=False, firmware=True, speeds=False)
    flight = _Flight({"schema": SCHEMA, "name": plan.name, "frame": "home"})
    _fly(plan, flight, losses)
    if not flight.waypoints:
        what = "has no waypoint, and a mission in TOML needs one"
        raise PlanError(plan.source or plan.name, "", "mission", what)
    flight.top["end"] = flight.end
    lines = [
        *_keys(flight.top),
        *(line for waypoint in flight.waypoints for line in _table("[[waypoint]]", waypoint)),
        *_fence(plan, losses),
    ]
    data = ("\n".join(lines) + "\n").encode()
    read_local(plan.source or plan.name, data, plan.name)
    return Written(data, losses.found())


def _fly(plan: Plan, flight: _Flight, losses: Losses) -> None:
    items, skip = plan.items, False
    if not items or items[0].command != Cmd.NAV_TAKEOFF:
        losses.of_plan("take-off", "one to the height of the first waypoint is added", Level.NOTE)
    if _whole_speed(plan) is not None:
        flight.top["speed_m_s"] = _whole_speed(plan)
    elif plan.hover_speed_m_s is not None:
        losses.of_plan("hover speed", _NOT_KEPT, Level.NOTE)
    if plan.cruise_speed_m_s is not None:
        losses.of_plan("cruise speed", _NOT_KEPT, Level.NOTE)
    whole_speed = _whole_speed_index(plan)
    for index, item in enumerate(items):
        if skip or index == whole_speed:
            skip = False
        elif item.command == Cmd.NAV_TAKEOFF and index == 0:
            _take_off(plan, item, flight, losses)
        elif _is_speed(item):
            flight.next_speed_m_s = item.params[1]
        elif _is_picture(items, index) and flight.waypoints:
            skip = _picture(plan, index, flight, losses)
        elif index == len(items) - 1 and item.command == Cmd.NAV_RETURN_TO_LAUNCH:
            flight.end = "return"
        elif index == len(items) - 1 and item.command == Cmd.NAV_LAND and flight.last is not None:
            _land(plan, index, flight, losses)
        elif KINDS.get(item.command) is Kind.MOVE and item.command != Cmd.NAV_LAND:
            _waypoint(plan, index, flight, losses)
        else:
            losses.of_item(index, _NOT_KEPT)


def _whole_speed_index(plan: Plan) -> int | None:
    """The item that sets the speed of the whole flight, as the reader writes it."""
    for index, item in enumerate(plan.items[:2]):
        if item.command == Cmd.DO_CHANGE_SPEED and item.params[1] == plan.hover_speed_m_s:
            return index
    return None


def _whole_speed(plan: Plan) -> float | None:
    return None if _whole_speed_index(plan) is None else plan.hover_speed_m_s


def _is_speed(item: Item) -> bool:
    kind, speed_m_s, throttle, _ = item.params
    said = (kind, throttle) == (1.0, -1.0) and speed_m_s >= _SLOWEST_M_S
    return item.command == Cmd.DO_CHANGE_SPEED and said


def _local(plan: Plan, item: Item) -> Local:
    if isinstance(item.place, Local):
        return Local(*(round(value, _DIGITS) for value in item.place))
    what = "is in degrees, and metres from the take-off point are not known"
    hint = "give --home LAT,LON,ALT; heights above terrain cannot be told in metres above home"
    raise PlanError(
        plan.source or plan.name, item.where, commands.name(item.command), what, hint=hint
    )


def _take_off(plan: Plan, item: Item, flight: _Flight, losses: Losses) -> None:
    place = _local(plan, item)
    flight.top["takeoff_up_m"] = place.up_m
    if math.hypot(place.north_m, place.east_m) > _SAME_M:
        losses.of_item(0, "its place is not kept: it is straight up")
    if any(item.params[:3]) or not math.isnan(item.params[3]):
        losses.of_item(0, "its parameters are not kept by this format", Level.NOTE)


def _waypoint(plan: Plan, index: int, flight: _Flight, losses: Losses) -> None:
    item = plan.items[index]
    place = _local(plan, item)
    hold_s, accept_m, pass_m, yaw_deg = item.params
    waypoint: dict[str, object] = dict(place._asdict())
    if item.command != Cmd.NAV_WAYPOINT:
        losses.of_item(index, "is kept as a plain waypoint")
    else:
        if hold_s > 0.0:
            waypoint["hold_s"] = hold_s
        if not math.isnan(yaw_deg):
            waypoint["yaw_deg"] = yaw_deg
        if any(value and not math.isnan(value) for value in (accept_m, pass_m)):
            what = "its acceptance radius or passing distance is not kept by this format"
            losses.of_item(index, what, Level.NOTE)
    if flight.next_speed_m_s is not None:
        waypoint["speed_m_s"] = flight.next_speed_m_s
        flight.next_speed_m_s = None
    flight.waypoints.append(waypoint)
    flight.last = place


def _is_picture(items: tuple[Item, ...], index: int) -> bool:
    item = items[index]
    return item.command == Cmd.IMAGE_START_CAPTURE and item.params[:3] == _ONE_PICTURE


def _picture(plan: Plan, index: int, flight: _Flight, losses: Losses) -> bool:
    """Whether the next item, the wait for the picture, is a part of it."""
    flight.waypoints[-1]["picture"] = True
    follower = plan.items[index + 1] if index + 1 < len(plan.items) else None
    if follower is None or follower.command != Cmd.NAV_DELAY:
        losses.of_item(index, "a wait for the picture is added", Level.NOTE)
        return False
    wait_s = follower.params[0]
    if flight.top.setdefault("picture_s", wait_s) != wait_s:
        losses.of_item(index + 1, f"waits {flight.top['picture_s']} s, as for the first picture")
    return True


def _land(plan: Plan, index: int, flight: _Flight, losses: Losses) -> None:
    """A landing elsewhere than under the last waypoint has a waypoint over it."""
    place, last = _local(plan, plan.items[index]), flight.last
    assert last is not None
    flight.end = "land"
    if math.hypot(place.north_m - last.north_m, place.east_m - last.east_m) > _SAME_M:
        over = place._replace(up_m=last.up_m)
        flight.waypoints.append(dict(over._asdict()))
        losses.of_item(index, "has a waypoint over it, at the height before", Level.NOTE)


# ------------------------------------------------------------------------------ fence


def _fence(plan: Plan, losses: Losses) -> Iterator[str]:
    if plan.rally:
        losses.of_plan("rally points", f"{len(plan.rally)} are not kept by this format")
    if plan.fence.breach_return is not None:
        losses.of_plan("fence", "its return point is not kept by this format", Level.NOTE)
    zones = [(zone, _zone(zone)) for zone in plan.fence.zones]
    inside = next((zone for zone, keys in zones if zone.inclusion and keys is not None), None)
    outside: list[dict[str, object]] = []
    for zone, keys in zones:
        label = f"fence zone {zone.name}"
        if keys is None:
            what = "is not kept: it is neither a circle nor a box along north and east, in metres, "
            losses.of_plan(label, what + "with both heights or none", where=zone.where)
        elif inside is None:
            what = "is not kept: a fence in TOML has a zone to stay inside"
            losses.of_plan(label, what, where=zone.where)
        elif zone is inside:
            yield from _table("[fence]", keys)
        elif zone.inclusion:
            what = "is not kept: a fence in TOML has one zone to stay inside"
            losses.of_plan(label, what, where=zone.where)
        else:
            outside.append(keys)
    for keys in outside:
        yield from _table("[[fence.exclude]]", keys)


def _zone(zone: Zone) -> dict[str, object] | None:
    heights = (zone.floor_above_home_m, zone.ceiling_above_home_m)
    keys: dict[str, object] = {"name": zone.name} if zone.name.strip() else {}
    if isinstance(zone.shape, Circle):
        centre = zone.shape.centre
        if isinstance(centre, LatLon):
            return None
        keys |= {"radius_m": zone.shape.radius_m}
        keys |= {name: round(getattr(centre, name), _DIGITS) for name in ("north_m", "east_m")}
    else:
        spans = _box(zone.shape)
        if spans is None:
            return None
        keys |= spans
    if heights == (None, None):
        return keys
    return None if None in heights else keys | {"up_m": list(heights)}


def _box(polygon: Polygon) -> dict[str, object] | None:
    """Its spans, where each of four edges runs along north or east; the smaller box of those that
    differ by `_SAME_M` at most."""
    corners = [corner for corner in polygon.corners if isinstance(corner, EastNorth)]
    if len(corners) != 4 or len(polygon.corners) != 4:
        return None
    easts, norths = sorted(c.east_m for c in corners), sorted(c.north_m for c in corners)
    for low, same_low, same_high, high in (easts, norths):
        if same_low - low > _SAME_M or high - same_high > _SAME_M or same_high - low <= _SAME_M:
            return None
    sides = [(c.east_m > easts[1], c.north_m > norths[1]) for c in corners]
    opposite = all(a[0] != b[0] and a[1] != b[1] for a, b in zip(sides[:2], sides[2:], strict=True))
    if not opposite:
        return None
    return {
        "north_m": [round(norths[1], _DIGITS), round(norths[2], _DIGITS)],
        "east_m": [round(easts[1], _DIGITS), round(easts[2], _DIGITS)],
    }


# ------------------------------------------------------------------------------- text


def _table(head: str, keys: dict[str, object]) -> Iterator[str]:
    yield ""
    yield head
    yield from _keys(keys)


def _keys(keys: dict[str, object]) -> Iterator[str]:
    """A string, a number, a bool or a list of numbers is in JSON what it is in TOML."""
    for key, value in keys.items():
        yield f"{key} = {json.dumps(value)}"
