"""A plan: what every file format and the wire are read into and written from.

Whatever is not set is NaN, and always the one object `math.nan`, inside tuples only: so plans
compare equal as they should (a tuple compares its members by identity first).
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from enum import IntEnum
from typing import Literal, NamedTuple, TypeAlias

from gcs.plan.errors import Finding

AutopilotName: TypeAlias = Literal["px4", "ardupilot"]

UNSET = math.nan
"""MAVLink's "not given": null in a .plan, NaN on the wire."""


class Frame(IntEnum):
    """What an item's position counts from, by the MAV_FRAME that files write.

    The frame names the datum of the item's height: mean sea level, home, or the terrain below.
    """

    AMSL = 0
    LOCAL = 1  # metres north, east and up of the take-off point
    MISSION = 2  # no position: three more parameters
    HOME = 3
    TERRAIN = 10


class Geographic(NamedTuple):
    """Degrees; `alt_m` counts from the datum of the item's frame.  0, 0 or NaN means "here"."""

    lat_deg: float
    lon_deg: float
    alt_m: float

    @property
    def here(self) -> bool:
        """No position of its own: wherever the vehicle is then."""
        unset = math.isnan(self.lat_deg) or math.isnan(self.lon_deg)
        return unset or (self.lat_deg == 0.0 and self.lon_deg == 0.0)


class Local(NamedTuple):
    """Metres north, east and up of the take-off point."""

    north_m: float
    east_m: float
    up_m: float


class Plain(NamedTuple):
    """Parameters 5 to 7 of an item that has no position."""

    p5: float
    p6: float
    p7: float


Place: TypeAlias = Geographic | Local | Plain
Params: TypeAlias = tuple[float, float, float, float]


@dataclass(frozen=True, slots=True)
class Item:
    """One mission item.

    `command` is a MAV_CMD.  `do_jump_id` is the item's own name, unique in its plan, from 1;
    parameter 1 of a DO_JUMP is such a name, in every plan, whatever its file counted.
    """

    command: int
    frame: Frame
    params: Params
    place: Place
    do_jump_id: int
    autocontinue: bool = True
    where: str = field(default="", compare=False)


@dataclass(frozen=True, slots=True)
class Geodetic:
    """Degrees and metres above mean sea level; `alt_amsl_m` None is not known."""

    lat_deg: float
    lon_deg: float
    alt_amsl_m: float | None


class LatLon(NamedTuple):
    lat_deg: float
    lon_deg: float


class EastNorth(NamedTuple):
    """Metres from the take-off point."""

    east_m: float
    north_m: float


@dataclass(frozen=True, slots=True)
class Polygon:
    """Corners in order, either way round, all geographic or all local."""

    corners: tuple[LatLon, ...] | tuple[EastNorth, ...]


def open_ring(corners: tuple[LatLon, ...]) -> tuple[LatLon, ...]:
    """Without a last corner that only closes the ring, as GeoJSON and others write it."""
    closed = len(corners) > 3 and corners[0] == corners[-1]
    return corners[:-1] if closed else corners


@dataclass(frozen=True, slots=True)
class Circle:
    centre: LatLon | EastNorth
    radius_m: float


@dataclass(frozen=True, slots=True)
class Zone:
    """Stay in it (inclusion) or out of it (exclusion).  Heights None: open on that side."""

    shape: Polygon | Circle
    inclusion: bool
    floor_above_home_m: float | None = None
    ceiling_above_home_m: float | None = None
    name: str = field(default="", compare=False)
    where: str = field(default="", compare=False)


@dataclass(frozen=True, slots=True)
class BreachReturn:
    """Where a vehicle that left the fence should go, for autopilots that have such a point."""

    lat_deg: float
    lon_deg: float
    alt_above_home_m: float


@dataclass(frozen=True, slots=True)
class Fence:
    zones: tuple[Zone, ...] = ()
    breach_return: BreachReturn | None = None


@dataclass(frozen=True, slots=True)
class RallyPoint:
    lat_deg: float
    lon_deg: float
    alt_above_home_m: float
    where: str = field(default="", compare=False)


@dataclass(frozen=True, slots=True)
class Plan:
    """A mission with its fence and rally points.

    `firmware` is the autopilot that the file was written for, None where it does not say.
    `home` is the planned home, which is never an item.  `notes` tells what the reader decided or
    doubts.
    """

    name: str
    firmware: AutopilotName | None
    home: Geodetic | None
    items: tuple[Item, ...] = ()
    fence: Fence = Fence()
    rally: tuple[RallyPoint, ...] = ()
    cruise_speed_m_s: float | None = None
    hover_speed_m_s: float | None = None
    source: str = field(default="", compare=False)
    notes: tuple[Finding, ...] = field(default=(), compare=False)

    def index_of(self, do_jump_id: float) -> int | None:
        """Where the item of that name stands; None if there is none."""
        for index, item in enumerate(self.items):
            if item.do_jump_id == do_jump_id:
                return index
        return None
