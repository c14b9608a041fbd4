"""The vehicle's own return: where it may end, and the way there.

PX4 (navigator/rtl.cpp): RTL_TYPE 0 goes to the nearest of home and the rally points, 1 and 5 to the
nearest rally point, 3 as 0 or to a mission landing, 2 and 4 along the mission.  The height of the
way counts from the place where it lands, and a rally point's own height is the ground there.
ArduCopter (ModeRTL::compute_return_target, AP_Rally): the nearest rally point that its fence
allows, but home where all are farther than RALLY_LIMIT_KM or home is nearer and RALLY_INCL_HOME is
set; a rally point's height is the least height of the way, and the landing goes down to the ground.

PX4 plans returns round its fence since PX4-Autopilot #27145 (after 1.17): where the straight way
is clear of the fence that is on board, as it is verified here, that way is the one it takes.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

from gcs.frames import Vec3
from gcs.plan.legs import Ground, LandingPlace
from gcs.plan.model import Plan
from gcs.wire.ids import Cmd

_STRAIGHT_TYPES = frozenset({0, 1, 3, 5})
_RALLY_ONLY = frozenset({1, 5})
_TO_MISSION_LANDING = frozenset({1, 3})
_NEARLY_M = 2.0
"""So much farther another place may be and still be taken for the nearest."""


@dataclass(frozen=True, slots=True)
class Way:
    """Up to `top_ned`, straight to `over_ned`, down to `ground_ned`."""

    top_ned: Vec3
    over_ned: Vec3
    ground_ned: Vec3


def home_place(ground: Ground) -> LandingPlace:
    return LandingPlace("home", ground.home_ned)


def straight(ground: Ground, plan: Plan) -> bool:
    """Whether the return is a straight way, and not one along the mission."""
    if ground.autopilot != "px4":
        return True
    kind = ground.settings.return_type
    lands = any(item.command == Cmd.DO_LAND_START for item in plan.items)
    return kind in _STRAIGHT_TYPES and not (lands and kind in _TO_MISSION_LANDING)


def landing_places(ground: Ground, places: tuple[Vec3, ...]) -> tuple[LandingPlace, ...]:
    """Where a return may end that begins at one of `places`, or between them."""
    home = home_place(ground)
    if not ground.rally:
        return (home,)
    near = _nearest_of(ground.rally, places)
    if ground.autopilot == "px4":
        if ground.settings.return_type in _RALLY_ONLY:
            return near
        return _nearest_of((home, *ground.rally), places)
    return (home, *near)


def _nearest_of(
    found: tuple[LandingPlace, ...], places: tuple[Vec3, ...]
) -> tuple[LandingPlace, ...]:
    """Those that may be the nearest to any point of the hull of `places`."""
    middle = tuple(sum(axis) / len(places) for axis in zip(*places, strict=True))
    spread_m = max(math.dist(place[:2], middle[:2]) for place in places)
    away = {place: math.dist(place.ground_ned[:2], middle[:2]) for place in found}
    nearest_m = min(away.values())
    most_m = nearest_m + 2.0 * spread_m + _NEARLY_M
    return tuple(place for place in found if away[place] <= most_m)


def way_to(landing: LandingPlace, ground: Ground, from_ned: Vec3) -> Way:
    """At the return height over `landing`, or higher where the vehicle is higher."""
    up_m = max(ground.return_up_m or 0.0, landing.over_up_m)
    climbed_m = from_ned[2] - ground.settings.return_climb_m
    down_m = min(climbed_m, landing.ground_ned[2] - up_m)
    over_ned = (*landing.ground_ned[:2], down_m)
    return Way((*from_ned[:2], down_m), over_ned, landing.ground_ned)


def regions(
    landing: LandingPlace, ground: Ground, places: tuple[Vec3, ...]
) -> Iterator[tuple[tuple[Vec3, ...], tuple[Vec3, ...]]]:
    """(starts, ends) of what the return may pass, from any of `places`."""
    ways = [way_to(landing, ground, place) for place in places]
    tops = tuple(way.top_ned for way in ways)
    overs = tuple(dict.fromkeys(way.over_ned for way in ways))
    yield places, tops
    yield tops, overs
    low_m = ground.settings.return_low_within_m
    if any(math.dist(place[:2], landing.ground_ned[:2]) <= low_m for place in places):
        levels = tuple((*landing.ground_ned[:2], place[2]) for place in places)
        yield (*places, *tops), (*overs, *levels)
