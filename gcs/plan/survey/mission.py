"""Runs in metres about home -> a plan: take off, fly each run with the camera on, return."""

from __future__ import annotations

import math
from dataclasses import dataclass

from gcs.plan.model import (
    UNSET,
    AutopilotName,
    Fence,
    Frame,
    Geodetic,
    Geographic,
    Item,
    Params,
    Place,
    Plain,
    Plan,
)
from gcs.plan.place import LatLonOf
from gcs.plan.survey.lines import Point, Run, length_m
from gcs.wire.ids import Cmd

_DIGITS = 7
_NOTHING = Plain(0.0, 0.0, 0.0)
ITEMS_MAX = 2000


class TooManyItemsError(Exception):
    """The mission would have more items than an autopilot stores."""


@dataclass(frozen=True, slots=True)
class Flight:
    """How the runs are flown: metres above home, metres a second; pictures each `trigger_m`, 0 for
    none; `look_at` is a point that the vehicle looks at all the time."""

    height_m: float
    speed_m_s: float
    trigger_m: float
    look_at: Point | None = None


def picture_count(runs: list[Run], trigger_m: float) -> int:
    """One where a run begins, and one each `trigger_m` from there."""
    return sum(1 + math.floor(length_m(run) / trigger_m + 1e-9) for run in runs)


class _Items:
    """The items, in the making."""

    def __init__(self, lat_lon_of: LatLonOf) -> None:
        self._lat_lon_of = lat_lon_of
        self.items: list[Item] = []

    def act(self, command: Cmd, p1: float, p2: float, p3: float) -> None:
        self._add(command, Frame.MISSION, (p1, p2, p3, 0.0), _NOTHING)

    def fly(self, command: Cmd, point: Point, up_m: float, yaw_deg: float = UNSET) -> None:
        lat_deg, lon_deg = self._lat_lon_of(point[1], point[0])
        place = Geographic(round(lat_deg, _DIGITS), round(lon_deg, _DIGITS), up_m)
        self._add(command, Frame.HOME, (0.0, 0.0, 0.0, yaw_deg), place)

    def _add(self, command: Cmd, frame: Frame, params: Params, place: Place) -> None:
        if len(self.items) == ITEMS_MAX:
            raise TooManyItemsError(f"more than {ITEMS_MAX} items")
        self.items.append(Item(command, frame, params, place, len(self.items) + 1))


def mission_of(
    name: str,
    runs: list[Run],
    flight: Flight,
    home: Geodetic,
    autopilot: AutopilotName,
    lat_lon_of: LatLonOf,
    fence: Fence,
) -> Plan:
    """`lat_lon_of` counts from home.  The camera is off on the ways between runs.

    Raises TooManyItemsError.
    """
    made = _Items(lat_lon_of)
    made.fly(Cmd.NAV_TAKEOFF, (0.0, 0.0), flight.height_m)
    made.act(Cmd.DO_CHANGE_SPEED, 1.0, flight.speed_m_s, -1.0)
    if flight.look_at is not None:
        made.fly(Cmd.DO_SET_ROI_LOCATION, flight.look_at, 0.0, 0.0)
    for run in runs:
        for number, point in enumerate(run):
            yaw_deg = UNSET if flight.look_at is None else _towards_deg(point, flight.look_at)
            made.fly(Cmd.NAV_WAYPOINT, point, flight.height_m, yaw_deg)
            if number == 0 and flight.trigger_m > 0.0:
                made.act(Cmd.DO_SET_CAM_TRIGG_DIST, flight.trigger_m, 0.0, 1.0)
        if flight.trigger_m > 0.0:
            made.act(Cmd.DO_SET_CAM_TRIGG_DIST, 0.0, 0.0, 0.0)
    if flight.look_at is not None:
        made.act(Cmd.DO_SET_ROI_NONE, 0.0, 0.0, 0.0)
    made.act(Cmd.NAV_RETURN_TO_LAUNCH, 0.0, 0.0, 0.0)
    return Plan(
        name,
        autopilot,
        home,
        tuple(made.items),
        fence,
        cruise_speed_m_s=flight.speed_m_s,
        hover_speed_m_s=flight.speed_m_s,
    )


def _towards_deg(point: Point, aim: Point) -> float:
    """Clockwise from north, 0 to 360."""
    return round(math.degrees(math.atan2(aim[0] - point[0], aim[1] - point[1])), 3) % 360.0
