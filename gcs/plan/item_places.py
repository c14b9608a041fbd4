"""Where an item lies in the vehicle's local frame, as its autopilot reads it."""

from __future__ import annotations

import math
from dataclasses import dataclass

from gcs.frames import Vec3
from gcs.plan.legs import Ground, ProblemKind
from gcs.plan.model import Frame, Geographic, Item, Local
from gcs.wire.ids import Cmd


class PlaceUnknownError(Exception):
    """The item says no place, or what it counts from is not known."""

    def __init__(self, kind: ProblemKind) -> None:
        super().__init__(kind.value)
        self.kind = kind


def is_here(item: Item) -> bool:
    """Whether it has no place of its own: wherever the vehicle is then."""
    return isinstance(item.place, Geographic) and item.place.here


@dataclass(frozen=True, slots=True)
class ItemPlaces:
    """Local NED, metres; `pos_ned` is where the vehicle is when the item begins."""

    ground: Ground

    def place(self, item: Item, pos_ned: Vec3) -> Vec3:
        """Raises PlaceUnknownError, as do the others."""
        return (*self.horizontal(item, pos_ned), self.down(item, pos_ned))

    def horizontal(self, item: Item, pos_ned: Vec3) -> tuple[float, float]:
        place = item.place
        if isinstance(place, Local):
            home_ned = self.ground.home_ned
            return (home_ned[0] + place.north_m, home_ned[1] + place.east_m)
        if not isinstance(place, Geographic):
            raise PlaceUnknownError(ProblemKind.NO_POSITION)
        if place.here:
            if item.command == Cmd.NAV_WAYPOINT and self.ground.autopilot == "px4":
                raise PlaceUnknownError(ProblemKind.NO_POSITION)
            return pos_ned[:2]
        if self.ground.north_east_of is None:
            raise PlaceUnknownError(ProblemKind.NO_ORIGIN)
        return self.ground.north_east_of(place.lat_deg, place.lon_deg)

    def down(self, item: Item, pos_ned: Vec3) -> float:
        place, home_down_m = item.place, self.ground.home_ned[2]
        if isinstance(place, Local):
            return home_down_m - place.up_m
        if not isinstance(place, Geographic) or math.isnan(place.alt_m):
            raise PlaceUnknownError(ProblemKind.NO_HEIGHT)
        if item.frame is Frame.TERRAIN:
            raise PlaceUnknownError(ProblemKind.TERRAIN)
        keeps_height = self.ground.autopilot == "ardupilot" and place.alt_m == 0.0
        if keeps_height and item.command != Cmd.NAV_TAKEOFF:
            return pos_ned[2]
        if item.frame is Frame.HOME:
            return home_down_m - place.alt_m
        if self.ground.origin_alt_amsl_m is None:
            raise PlaceUnknownError(ProblemKind.NO_ORIGIN)
        return self.ground.origin_alt_amsl_m - place.alt_m
