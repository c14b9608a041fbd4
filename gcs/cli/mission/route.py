"""What is drawn of a plan, in metres about home: its way with lengths and times, its fence."""

from __future__ import annotations

import math
from dataclasses import dataclass

from gcs.cli.mission.check import Layout, choose_home, lay_out
from gcs.exit_codes import ExitCode
from gcs.flight_report.number_format import duration
from gcs.frames import Vec3, enu_from_ned
from gcs.gate.policy.policy import Policy
from gcs.operator.errors import ExitError
from gcs.plan.commands import KINDS, Kind
from gcs.plan.flight_time import FlightTime, TimeWalk
from gcs.plan.flown.path import flight_path
from gcs.plan.legs import FlightPath, LegKind
from gcs.plan.model import (
    AutopilotName,
    Circle,
    EastNorth,
    Frame,
    Geodetic,
    Geographic,
    LatLon,
    Plan,
    Zone,
)
from gcs.plan.verify import battery_refusal, lasts_s
from gcs.policy_file import PolicyFileError, load_policy
from gcs.report import FenceShape


@dataclass(frozen=True, slots=True)
class RouteLeg:
    """A straight piece of the way; `item` counts from 1, ENU metres about home."""

    item: int
    kind: LegKind
    from_enu: Vec3
    to_enu: Vec3

    @property
    def length_m(self) -> float:
        return math.dist(self.from_enu, self.to_enu)


@dataclass(frozen=True, slots=True)
class Route:
    """`ends_s` is when each item is over, by its number from 1; `flight` None: nothing flies."""

    legs: tuple[RouteLeg, ...]
    circles: tuple[tuple[Vec3, float], ...]
    zones: tuple[FenceShape, ...]
    rally_enu: tuple[Vec3, ...]
    problems: tuple[str, ...]
    flight: FlightTime | None
    ends_s: dict[int, float]
    battery: str

    @property
    def length_m(self) -> float:
        return sum(leg.length_m for leg in self.legs)

    @property
    def climb_m(self) -> float:
        return sum(max(0.0, leg.to_enu[2] - leg.from_enu[2]) for leg in self.legs)

    @property
    def highest_m(self) -> float:
        return max((leg.to_enu[2] for leg in self.legs), default=0.0)

    @property
    def farthest_m(self) -> float:
        return max((math.hypot(*leg.to_enu[:2]) for leg in self.legs), default=0.0)

    @property
    def places(self) -> dict[int, Vec3]:
        """Where each item that flies ends, by its number."""
        return {leg.item: leg.to_enu for leg in self.legs}

    def item_length_m(self, number: int) -> float:
        return sum(leg.length_m for leg in self.legs if leg.item == number)

    @property
    def facts(self) -> list[tuple[str, str]]:
        """Names and values, for people."""
        facts = []
        if self.legs:
            facts = [
                ("way", f"{self.length_m:.0f} m"),
                ("climbs", f"{self.climb_m:.0f} m"),
                ("highest above home", f"{self.highest_m:.1f} m"),
                ("farthest from home", f"{self.farthest_m:.0f} m"),
            ]
        if self.flight is not None:
            whole = duration(self.flight.time_s) if self.flight.whole else "longer than a day"
            facts += [("in the air, about", whole), ("battery", self.battery)]
        return facts


def route_of(
    plan: Plan, autopilot: AutopilotName | None, policy_name: str, home: Geodetic | None
) -> Route:
    """As `gcs mission check` lays it out, but not judged.  Raises ExitError for a bad policy."""
    try:
        policy, _ = load_policy(policy_name)
    except PolicyFileError as error:
        raise ExitError(ExitCode.BAD_FILE, str(error), error.hint) from None
    autopilot = autopilot or plan.firmware or "px4"
    at_home, _ = choose_home(plan, autopilot, home)
    laid = lay_out(plan, autopilot, at_home or _somewhere_in(plan))
    zones = tuple(_shape(laid, number, zone) for number, zone in enumerate(laid.placed.fence.zones))
    rally = tuple(
        (*_east_north(laid, LatLon(point.lat_deg, point.lon_deg)), point.alt_above_home_m)
        for point in plan.rally
    )
    if not plan.items:
        return Route((), (), zones, rally, (), None, {}, "")
    path = flight_path(laid.placed, laid.ground)
    walk = TimeWalk(laid.placed, laid.ground)
    for _ in walk.steps():
        pass
    assert walk.result is not None
    flight = None if path.problems else walk.result
    return Route(
        _plain_legs(laid) if path.problems else _legs(path),
        tuple((enu_from_ned(circle.centre_ned), circle.radius_m) for circle in path.circles),
        zones,
        rally,
        tuple(problem.sentence for problem in path.problems),
        flight,
        {index + 1: time_s for index, time_s in walk.ends_s.items()},
        "" if flight is None else _battery(flight, plan, policy),
    )


def _legs(path: FlightPath) -> tuple[RouteLeg, ...]:
    return tuple(
        RouteLeg(leg.item + 1, leg.kind, enu_from_ned(leg.from_ned), enu_from_ned(leg.to_ned))
        for leg in path.legs
    )


def _plain_legs(laid: Layout) -> tuple[RouteLeg, ...]:
    """From place to place, of a mission that is not flown as it is; a height that is not known is
    drawn as that of home."""
    legs: list[RouteLeg] = []
    here: Vec3 = (0.0, 0.0, 0.0)
    for number, item in enumerate(laid.placed.items, start=1):
        place = item.place
        if KINDS.get(item.command) is not Kind.MOVE or not isinstance(place, Geographic):
            continue
        if place.here:
            continue
        base_m = laid.projection.origin.alt_amsl_m if item.frame is Frame.AMSL else 0.0
        up_m = 0.0 if math.isnan(place.alt_m) else place.alt_m - base_m
        there = (*_east_north(laid, LatLon(place.lat_deg, place.lon_deg)), up_m)
        legs.append(RouteLeg(number, LegKind.STRAIGHT, here if legs else there, there))
        here = there
    return tuple(legs)


def _battery(flight: FlightTime, plan: Plan, policy: Policy) -> str:
    """Of a full one, by what the policy says."""
    limits = policy.battery
    if limits.endurance_s is None:
        return "not judged, as the policy has no battery.endurance_s"
    refusal = battery_refusal(flight, plan, limits, 100.0)
    if refusal is not None:
        return refusal.sentence
    share = 100.0 * flight.time_s / lasts_s(limits.endurance_s, limits, 100.0)
    return f"{share:.0f} % of what a full one gives until it is low at {limits.low_pct:g} %"


def _somewhere_in(plan: Plan) -> Geodetic:
    """An origin for what has no home: its first place."""
    for zone in plan.fence.zones:
        point = zone.shape.centre if isinstance(zone.shape, Circle) else zone.shape.corners[0]
        if isinstance(point, LatLon):
            return Geodetic(*point, None)
    for rally in plan.rally:
        return Geodetic(rally.lat_deg, rally.lon_deg, None)
    return Geodetic(0.0, 0.0, None)


def _shape(laid: Layout, number: int, zone: Zone) -> FenceShape:
    name = zone.name or f"zone {number + 1}"
    heights = (zone.floor_above_home_m, zone.ceiling_above_home_m)
    if isinstance(zone.shape, Circle):
        centre = _east_north(laid, zone.shape.centre)
        return FenceShape(name, zone.inclusion, [], centre, zone.shape.radius_m, *heights)
    corners = [_east_north(laid, corner) for corner in zone.shape.corners]
    return FenceShape(name, zone.inclusion, corners, None, 0.0, *heights)


def _east_north(laid: Layout, point: LatLon | EastNorth) -> tuple[float, float]:
    if isinstance(point, EastNorth):
        return (point.east_m, point.north_m)
    north_m, east_m = laid.projection.north_east(point.lat_deg, point.lon_deg)
    return (east_m, north_m)
