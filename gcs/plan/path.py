"""The path that a plan flies, as straight legs and circles in the vehicle's local frame.

Geometry only: the gate decides what may be flown.  Every way through the DO_JUMPs is
walked, so the legs are those of the whole mission, each once.  Where a quadrotor's behaviour
depends on the autopilot, it follows PX4's navigator and ArduCopter's AUTO mode:

- a take-off climbs straight up; px4 then flies level to the item's position, ardupilot ignores it;
- a landing first flies level to its position, then descends to the height of home;
- a return climbs to the return height (or stays if higher), flies straight home, and descends;
- LOITER_TURNS flies to the nearest point of its circle and leaves where its turns end; the
  other loiters hover.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from enum import Enum
from typing import TypeAlias

from gcs.frames import Vec3
from gcs.plan import commands
from gcs.plan.commands import KINDS, Kind
from gcs.plan.model import AutopilotName, Frame, Geographic, Item, Local, Plan
from gcs.wire.ids import Cmd

NorthEastOf: TypeAlias = Callable[[float, float], tuple[float, float]]
"""(lat_deg, lon_deg) -> (north_m, east_m) of the local origin: the vehicle's own projection."""

_VISITS_MAX = 32


class LegKind(Enum):
    CLIMB = "climb"
    STRAIGHT = "leg"
    RETURN = "return"
    DESCENT = "descent"


class ProblemKind(Enum):
    """Why a path cannot be verified: something about it is not known, or cannot be flown."""

    NO_ORIGIN = "the vehicle's origin is not known"
    TERRAIN = "heights above terrain need a terrain model"
    NO_POSITION = "it has no position"
    NO_HEIGHT = "it has no height"
    NO_RADIUS = "the circle has no radius of its own"
    NO_RETURN_HEIGHT = "the vehicle's return height is not known"
    SPLINE = "a smooth curve is not checked"
    HOME_MOVES = "it moves home, and what follows counts from it"
    NOT_FLOWN = "it is no item that a quadrotor is known to fly"
    JUMP_NOWHERE = "it jumps to an item that is not there"
    TOO_MANY_WAYS = "there are too many ways through the jumps"


@dataclass(frozen=True, slots=True)
class Problem:
    """`item` counts into `Plan.items`."""

    item: int
    kind: ProblemKind
    sentence: str


@dataclass(frozen=True, slots=True)
class Leg:
    """A straight leg in local NED, metres."""

    item: int
    kind: LegKind
    from_ned: Vec3
    to_ned: Vec3

    @property
    def floor_applies(self) -> bool:
        """Not to legs that leave or reach the ground."""
        return self.kind not in (LegKind.CLIMB, LegKind.DESCENT)


@dataclass(frozen=True, slots=True)
class LoiterCircle:
    item: int
    centre_ned: Vec3
    radius_m: float


@dataclass(frozen=True, slots=True)
class Ground:
    """Where the vehicle's local frame lies, and what of the vehicle shapes a path.

    `north_east_of` and `origin_alt_amsl_m` are None while the origin is not known; then only
    plans in metres from the take-off point have a path.  `start_ned` is where it stands now.
    `return_up_m` is its return height above home.
    """

    autopilot: AutopilotName
    home_ned: Vec3
    start_ned: Vec3
    north_east_of: NorthEastOf | None = None
    origin_alt_amsl_m: float | None = None
    return_up_m: float | None = None


@dataclass(frozen=True, slots=True)
class FlightPath:
    """`problems` not empty means that the path is not the whole path."""

    legs: tuple[Leg, ...]
    circles: tuple[LoiterCircle, ...]
    problems: tuple[Problem, ...]

    @property
    def segments(self) -> tuple[tuple[Vec3, Vec3], ...]:
        return tuple((leg.from_ned, leg.to_ned) for leg in self.legs)

    @property
    def length_m(self) -> float:
        """Of the legs, without the circles."""
        return sum(math.dist(leg.from_ned, leg.to_ned) for leg in self.legs)


def flight_path(plan: Plan, ground: Ground) -> FlightPath:
    """Never raises: what cannot be known is among the `problems`."""
    return _Walk(plan, ground).walk()


class _DeadEndError(Exception):
    """This way through the mission ends here, for a reason that is among the problems."""


class _Walk:
    def __init__(self, plan: Plan, ground: Ground) -> None:
        self._plan = plan
        self._ground = ground
        self._legs: dict[Leg, None] = {}
        self._circles: dict[LoiterCircle, None] = {}
        self._problems: dict[Problem, None] = {}
        self._seen: set[tuple[int, Vec3]] = set()
        self._visits: dict[int, int] = {}
        self._branches: list[tuple[int, Vec3]] = [(0, ground.start_ned)]

    def walk(self) -> FlightPath:
        while self._branches:
            index, pos_ned = self._branches.pop()
            try:
                self._follow(index, pos_ned)
            except _DeadEndError:
                continue
        return FlightPath(tuple(self._legs), tuple(self._circles), tuple(self._problems))

    def _follow(self, index: int, pos_ned: Vec3) -> None:
        """Walk from item `index`, entered at `pos_ned`, to the end of the mission or to where this
        walk was before."""
        while index < len(self._plan.items) and (index, pos_ned) not in self._seen:
            self._seen.add((index, pos_ned))
            self._visits[index] = self._visits.get(index, 0) + 1
            if self._visits[index] > _VISITS_MAX:
                raise self._problem(index, ProblemKind.TOO_MANY_WAYS)
            item = self._plan.items[index]
            match KINDS.get(item.command):
                case Kind.MOVE:
                    pos_ned = self._move(index, item, pos_ned)
                case Kind.RETURN:
                    self._return(index, pos_ned)
                    return
                case Kind.JUMP:
                    self._jump(index, item, pos_ned)
                case Kind.WAIT | Kind.ACT:
                    pass
                case Kind.SET_HOME:
                    raise self._problem(index, ProblemKind.HOME_MOVES)
                case Kind.FENCE | None:
                    raise self._problem(index, ProblemKind.NOT_FLOWN)
            index += 1

    def _problem(self, index: int, kind: ProblemKind) -> _DeadEndError:
        label = commands.name(self._plan.items[index].command)
        sentence = f"item {index + 1} ({label}): {kind.value}"
        self._problems[Problem(index, kind, sentence)] = None
        return _DeadEndError()

    def _leg(self, index: int, kind: LegKind, from_ned: Vec3, to_ned: Vec3) -> Vec3:
        if from_ned != to_ned:
            self._legs[Leg(index, kind, from_ned, to_ned)] = None
        return to_ned

    # ---------------------------------------------------------------------------- items

    def _jump(self, index: int, item: Item, pos_ned: Vec3) -> None:
        """The jump is a branch of its own; going on after it is always possible too."""
        if item.params[1] == 0.0:
            return
        target = self._plan.index_of(item.params[0])
        if target is None:
            raise self._problem(index, ProblemKind.JUMP_NOWHERE)
        self._branches.append((target, pos_ned))

    def _move(self, index: int, item: Item, pos_ned: Vec3) -> Vec3:
        match item.command:
            case Cmd.NAV_TAKEOFF:
                return self._take_off(index, item, pos_ned)
            case Cmd.NAV_LAND:
                return self._land(index, item, pos_ned)
            case Cmd.NAV_LOITER_TURNS:
                return self._turns(index, item, pos_ned)
            case Cmd.NAV_SPLINE_WAYPOINT:
                raise self._problem(index, ProblemKind.SPLINE)
            case _:
                to_ned = (*self._horizontal(index, item, pos_ned), self._down(index, item, pos_ned))
                return self._leg(index, LegKind.STRAIGHT, pos_ned, to_ned)

    def _take_off(self, index: int, item: Item, pos_ned: Vec3) -> Vec3:
        down_m = min(self._down(index, item, pos_ned), pos_ned[2])
        top_ned = self._leg(index, LegKind.CLIMB, pos_ned, (*pos_ned[:2], down_m))
        if self._ground.autopilot == "ardupilot":
            return top_ned
        over_ned = (*self._horizontal(index, item, top_ned), down_m)
        return self._leg(index, LegKind.STRAIGHT, top_ned, over_ned)

    def _land(self, index: int, item: Item, pos_ned: Vec3) -> Vec3:
        horizontal = self._horizontal(index, item, pos_ned)
        over_ned = self._leg(index, LegKind.STRAIGHT, pos_ned, (*horizontal, pos_ned[2]))
        ground_ned = (*horizontal, self._ground.home_ned[2])
        return self._leg(index, LegKind.DESCENT, over_ned, ground_ned)

    def _return(self, index: int, pos_ned: Vec3) -> None:
        home_ned, up_m = self._ground.home_ned, self._ground.return_up_m
        if up_m is None:
            raise self._problem(index, ProblemKind.NO_RETURN_HEIGHT)
        down_m = min(home_ned[2] - up_m, pos_ned[2])
        top_ned = self._leg(index, LegKind.CLIMB, pos_ned, (*pos_ned[:2], down_m))
        over_ned = self._leg(index, LegKind.RETURN, top_ned, (*home_ned[:2], down_m))
        self._leg(index, LegKind.DESCENT, over_ned, home_ned)

    def _turns(self, index: int, item: Item, pos_ned: Vec3) -> Vec3:
        north_m, east_m = self._horizontal(index, item, pos_ned)
        down_m = self._down(index, item, pos_ned)
        turns, _, radius_m, _ = item.params
        if not abs(radius_m) > 0.0 or math.isnan(turns):
            raise self._problem(index, ProblemKind.NO_RADIUS)
        self._circles[LoiterCircle(index, (north_m, east_m, down_m), abs(radius_m))] = None
        entry_rad = math.atan2(pos_ned[1] - east_m, pos_ned[0] - north_m)

        def on_circle(angle_rad: float) -> Vec3:
            return (
                north_m + abs(radius_m) * math.cos(angle_rad),
                east_m + abs(radius_m) * math.sin(angle_rad),
                down_m,
            )

        entry_ned = self._leg(index, LegKind.STRAIGHT, pos_ned, on_circle(entry_rad))
        part = math.fmod(turns, 1.0)
        if part == 0.0:
            return entry_ned
        # Positive radius is clockwise seen from above: north to east, which is this angle's way.
        return on_circle(entry_rad + math.copysign(2.0 * math.pi * part, radius_m))

    # --------------------------------------------------------------------------- places

    def _horizontal(self, index: int, item: Item, pos_ned: Vec3) -> tuple[float, float]:
        place = item.place
        if isinstance(place, Local):
            home_ned = self._ground.home_ned
            return (home_ned[0] + place.north_m, home_ned[1] + place.east_m)
        if not isinstance(place, Geographic):
            raise self._problem(index, ProblemKind.NO_POSITION)
        if place.here:
            if item.command == Cmd.NAV_WAYPOINT and self._ground.autopilot == "px4":
                raise self._problem(index, ProblemKind.NO_POSITION)
            return pos_ned[:2]
        if self._ground.north_east_of is None:
            raise self._problem(index, ProblemKind.NO_ORIGIN)
        return self._ground.north_east_of(place.lat_deg, place.lon_deg)

    def _down(self, index: int, item: Item, pos_ned: Vec3) -> float:
        place, home_down_m = item.place, self._ground.home_ned[2]
        if isinstance(place, Local):
            return home_down_m - place.up_m
        if not isinstance(place, Geographic) or math.isnan(place.alt_m):
            raise self._problem(index, ProblemKind.NO_HEIGHT)
        if item.frame is Frame.TERRAIN:
            raise self._problem(index, ProblemKind.TERRAIN)
        keeps_height = self._ground.autopilot == "ardupilot" and place.alt_m == 0.0
        if keeps_height and item.command != Cmd.NAV_TAKEOFF:
            return pos_ned[2]
        if item.frame is Frame.HOME:
            return home_down_m - place.alt_m
        if self._ground.origin_alt_amsl_m is None:
            raise self._problem(index, ProblemKind.NO_ORIGIN)
        return self._ground.origin_alt_amsl_m - place.alt_m
