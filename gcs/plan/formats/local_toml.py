"""Missions in metres from the take-off point: our own TOML, schema version 1.

schema = 1
name = "lab square"
frame = "home"            # metres north, east and up of the take-off point
speed_m_s = 2.0           # optional, of the whole flight
takeoff_up_m = 1.0        # optional: the height of the first waypoint
picture_s = 2.0           # optional: how long the vehicle stays for a picture
end = "land"              # optional: "land", "return" or "hold"

[[waypoint]]
north_m = 0.0
east_m = 2.0
up_m = 1.0
yaw_deg = 90.0            # optional, clockwise from north
hold_s = 1.0              # optional
picture = true            # optional
speed_m_s = 1.0           # optional, from here on

[fence]                   # optional: stay inside
north_m = [-5, 5]         # a box; or radius_m = 20, centred on north_m, east_m
east_m = [-5, 5]
up_m = [0, 2]             # optional

[[fence.exclude]]         # optional: stay out
radius_m = 1.0
north_m = 3.0
east_m = 3.0
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Literal, TypeAlias

from msgspec import Meta, Struct

from gcs import toml
from gcs.gate.policy.policy import Policy
from gcs.plan.errors import PlanError
from gcs.plan.model import (
    UNSET,
    Circle,
    EastNorth,
    Fence,
    Frame,
    Item,
    Local,
    Params,
    Place,
    Plain,
    Plan,
    Polygon,
    Zone,
)
from gcs.toml_lines import KeyPath
from gcs.wire.ids import Cmd

SCHEMA = 1
_NOTHING = Plain(0.0, 0.0, 0.0)

_Text: TypeAlias = Annotated[str, Meta(pattern=r"\S")]
_Reach: TypeAlias = Annotated[float, Meta(ge=-1.0e5, le=1.0e5)]
_Height: TypeAlias = Annotated[float, Meta(ge=-1.0e4, le=1.0e4)]
_Speed: TypeAlias = Annotated[float, Meta(ge=0.1, le=100.0)]
_Coordinate: TypeAlias = Annotated[float, Meta(ge=-1.0e6, le=1.0e6)]
_Span: TypeAlias = tuple[_Coordinate, _Coordinate]


class _Table(Struct, frozen=True, forbid_unknown_fields=True):
    """A table of the file; its fields are the keys, as the module's docstring shows them."""


class _Waypoint(_Table, frozen=True, kw_only=True):
    north_m: _Reach
    east_m: _Reach
    up_m: _Height
    yaw_deg: Annotated[float, Meta(ge=-360.0, le=360.0)] | None = None
    hold_s: Annotated[float, Meta(ge=0.0, le=3600.0)] = 0.0
    picture: bool = False
    speed_m_s: _Speed | None = None


class _Zone(_Table, frozen=True, kw_only=True):
    up_m: _Span | None = None
    name: _Text | None = None
    exclude: tuple[dict[str, object], ...] = ()


# A box and a circle, and not one table whose `north_m` is a number or a pair: msgspec 0.22
# crashes on a union of a limited number and a pair.


class _Box(_Zone, frozen=True, kw_only=True):
    north_m: _Span
    east_m: _Span


class _Circle(_Zone, frozen=True, kw_only=True):
    radius_m: Annotated[float, Meta(ge=0.1, le=1.0e5)]
    north_m: _Reach = 0.0
    east_m: _Reach = 0.0


class _Mission(_Table, frozen=True, kw_only=True):
    schema: float
    frame: Literal["home"]
    name: _Text | None = None
    speed_m_s: _Speed | None = None
    takeoff_up_m: Annotated[float, Meta(ge=0.1, le=1.0e4)] | None = None
    picture_s: Annotated[float, Meta(ge=0.0, le=600.0)] = 2.0
    end: Literal["land", "return", "hold"] = "land"
    waypoint: Annotated[tuple[_Waypoint, ...], Meta(min_length=1)]
    fence: dict[str, object] | None = None


def read_local(file: str, data: bytes, name: str) -> Plan:
    """`name` is the plan's if the file gives it none.  Raises PlanError with the line."""
    try:
        doc = toml.read(toml.decode(data, file), file)
        if _is_policy(doc.data):
            hint = "`gcs mission check MISSION --policy FILE` checks a mission by it"
            raise PlanError(file, "", "file", "is a policy and no mission", hint=hint)
        # First of all, as other schemas have other keys.
        if doc.data.get("schema", SCHEMA) != SCHEMA:
            what = f"{toml.shown(doc.data['schema'])} is not known"
            raise doc.error(("schema",), what, f"this reads schema {SCHEMA}")
        return _plan(doc, doc.convert(_Mission, doc.data), name)
    except toml.TomlError as error:
        line = str(error.line) if error.line else ""
        raise PlanError(file, line, error.key, error.what, hint=error.hint) from None


def _is_policy(data: Mapping[str, object]) -> bool:
    """Of a policy's keys a mission has only its name and one fence."""
    fences = isinstance(data.get("fence"), list)
    return fences or bool(set(Policy.__struct_fields__) & set(data) - {"name", "fence"})


def _plan(doc: toml.Document, mission: _Mission, name: str) -> Plan:
    return Plan(
        mission.name or name,
        None,
        None,
        _Flight(doc, mission).items(),
        Fence() if mission.fence is None else _fence(doc, mission.fence),
        hover_speed_m_s=mission.speed_m_s,
        source=doc.file,
    )


class _Flight:
    """The items of the flight, in the making."""

    def __init__(self, doc: toml.Document, mission: _Mission) -> None:
        self._doc = doc
        self._mission = mission
        self._items: list[Item] = []

    def items(self) -> tuple[Item, ...]:
        mission = self._mission
        first, last = mission.waypoint[0], mission.waypoint[-1]
        up_m = first.up_m if mission.takeoff_up_m is None else mission.takeoff_up_m
        self._add(("takeoff_up_m",), Cmd.NAV_TAKEOFF, Local(0.0, 0.0, up_m))
        self._change_speed(("speed_m_s",), mission.speed_m_s)
        for number, waypoint in enumerate(mission.waypoint):
            self._fly(("waypoint", number), waypoint)
        if mission.end == "land":
            self._add(("end",), Cmd.NAV_LAND, Local(last.north_m, last.east_m, 0.0))
        elif mission.end == "return":
            nothing = (0.0, 0.0, 0.0, 0.0)
            self._add(("end",), Cmd.NAV_RETURN_TO_LAUNCH, params=nothing)
        return tuple(self._items)

    def _fly(self, at: KeyPath, waypoint: _Waypoint) -> None:
        self._change_speed((*at, "speed_m_s"), waypoint.speed_m_s)
        here = Local(waypoint.north_m, waypoint.east_m, waypoint.up_m)
        yaw_deg = UNSET if waypoint.yaw_deg is None else waypoint.yaw_deg
        self._add(at, Cmd.NAV_WAYPOINT, here, (waypoint.hold_s, 0.0, 0.0, yaw_deg))
        if waypoint.picture:
            at = (*at, "picture")
            self._add(at, Cmd.IMAGE_START_CAPTURE, params=(0.0, 0.0, 1.0, 0.0))
            # Autopilots do not wait for a camera, and a picture wants a vehicle that stands still.
            wait = (self._mission.picture_s, -1.0, -1.0, -1.0)
            self._add(at, Cmd.NAV_DELAY, params=wait)

    def _change_speed(self, at: KeyPath, speed_m_s: float | None) -> None:
        if speed_m_s is not None:
            self._add(at, Cmd.DO_CHANGE_SPEED, params=(1.0, speed_m_s, -1.0, 0.0))

    def _add(
        self,
        at: KeyPath,
        command: Cmd,
        place: Place = _NOTHING,
        params: Params = (0.0, 0.0, 0.0, UNSET),
    ) -> None:
        frame = Frame.LOCAL if isinstance(place, Local) else Frame.MISSION
        number = len(self._items) + 1
        where = str(self._doc.line(at))
        self._items.append(Item(command, frame, params, place, number, where=where))


def _fence(doc: toml.Document, table: dict[str, object]) -> Fence:
    fence = _read_zone(doc, table, ("fence",))
    zones = [_zone(doc, fence, ("fence",), "fence", inclusion=True)]
    for number, inner in enumerate(fence.exclude):
        at = ("fence", "exclude", number)
        if "exclude" in inner:
            raise doc.error((*at, "exclude"), "unknown key", "an exclusion has no exclusions")
        exclusion = _read_zone(doc, inner, at)
        zones.append(_zone(doc, exclusion, at, f"exclusion {number + 1}", inclusion=False))
    return Fence(tuple(zones))


def _read_zone(doc: toml.Document, table: dict[str, object], at: KeyPath) -> _Box | _Circle:
    if "radius_m" in table:
        return doc.convert(_Circle, table, at)
    return doc.convert(_Box, table, at)


def _zone(
    doc: toml.Document, zone: _Box | _Circle, at: KeyPath, name: str, *, inclusion: bool
) -> Zone:
    shape: Polygon | Circle
    if isinstance(zone, _Circle):
        shape = Circle(EastNorth(zone.east_m, zone.north_m), zone.radius_m)
    else:
        west, east = _rising(doc, zone.east_m, (*at, "east_m"))
        south, north = _rising(doc, zone.north_m, (*at, "north_m"))
        corners = ((west, south), (east, south), (east, north), (west, north))
        shape = Polygon(tuple(EastNorth(*corner) for corner in corners))
    floor_m, ceiling_m = (None, None)
    if zone.up_m is not None:
        floor_m, ceiling_m = _rising(doc, zone.up_m, (*at, "up_m"))
    return Zone(shape, inclusion, floor_m, ceiling_m, zone.name or name, str(doc.line(at)))


def _rising(doc: toml.Document, span: _Span, at: KeyPath) -> _Span:
    low, high = span
    if not low < high:
        raise doc.error(at, f"[{low:g}, {high:g}] is empty", "[from, to] with from below to")
    return span
