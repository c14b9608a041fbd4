"""What a flight path is made of, in the vehicle's local frame: local NED, metres.

The *legs* are what the items ask for, for people to read.  A vehicle does not fly them exactly: it
turns before a waypoint, flies a curve, or goes on past its place.  Where it may be instead
is told by *regions*; a region is every point of the convex hull of a few points.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from enum import Enum
from itertools import pairwise
from typing import Final, TypeAlias

from gcs.frames import Vec3
from gcs.plan.model import AutopilotName

NorthEastOf: TypeAlias = Callable[[float, float], tuple[float, float]]
"""(lat_deg, lon_deg) -> (north_m, east_m) of the local origin: the vehicle's own projection."""
CIRCLE_SIDES: Final = 24
"""Of the polygon that stands for a circle; its corners are 0.9 % of the radius outside."""


class LegKind(Enum):
    CLIMB = "climb"
    STRAIGHT = "leg"
    RETURN = "return"
    DESCENT = "descent"


class RegionKind(Enum):
    """Why the vehicle may be beside its leg; the values are what sentences call the region."""

    TURN = "the turn towards"
    CURVE = "the curve to"
    ENTRY = "the way onto the circle about"
    LANDING = "the way down to"
    RETURN = "the return to"


class ProblemKind(Enum):
    """Why a path cannot be verified: something about it is not known, or cannot be flown."""

    NO_ORIGIN = "the vehicle's origin is not known"
    TERRAIN = "heights above terrain need a terrain model"
    NO_POSITION = "it has no position"
    NO_HEIGHT = "it has no height"
    NO_RADIUS = "the circle has no radius of its own"
    NO_RETURN_HEIGHT = "the vehicle's return height is not known"
    RETURN_ROUTE = "the vehicle's return follows its mission (RTL_TYPE), which is not verified"
    HOME_MOVES = "it moves home, and with it the return, later heights and the fence"
    OWN_DESCENT = "it descends by itself until it feels the ground, to a height that is not known"
    NOT_FLOWN = "it is no item that is verified here"
    REFUSED = "this autopilot refuses it at upload"
    NEVER_STARTS = "this autopilot stores it, and then does not start the mission"
    NOT_OF_A_MISSION = "it belongs to a fence or to rally points"
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
    """A straight leg.  `take_off` is True for the climb from the ground."""

    item: int
    kind: LegKind
    from_ned: Vec3
    to_ned: Vec3
    take_off: bool = False

    @property
    def floor_applies(self) -> bool:
        """Not to legs that leave or reach the ground."""
        return self.kind not in (LegKind.CLIMB, LegKind.DESCENT)


@dataclass(frozen=True, slots=True)
class Region:
    """The vehicle may be anywhere in the hull of `starts` and `ends`; it comes from `starts`,
    () where it was in another region before, and is on its way to `aim_ned`."""

    item: int
    kind: RegionKind
    starts: tuple[Vec3, ...]
    ends: tuple[Vec3, ...]
    aim_ned: Vec3

    @property
    def floor_applies(self) -> bool:
        """To curves alone.  All others are no lower than the legs that they lie between, but for
        what is left of a climb or of a landing."""
        return self.kind is RegionKind.CURVE

    @property
    def points(self) -> tuple[Vec3, ...]:
        return self.starts + self.ends


@dataclass(frozen=True, slots=True)
class LoiterCircle:
    item: int
    centre_ned: Vec3
    radius_m: float


@dataclass(frozen=True, slots=True)
class LandingPlace:
    """Where a return may end: home, or a rally point.

    `over_up_m` is how high above the ground there the way to it is at least, beside the vehicle's
    return height.
    """

    name: str
    ground_ned: Vec3
    over_up_m: float = 0.0


@dataclass(frozen=True, slots=True)
class FlightSettings:
    """What of the vehicle's parameters shapes its path; metres.

    The defaults describe a vehicle that flies its legs exactly and returns home alone.
    """

    accept_m: float = 0.0
    """A waypoint counts as reached so near to it: NAV_ACC_RAD, WPNAV_RADIUS or WP_RADIUS_M."""
    accept_up_m: float | None = None
    """PX4 asks for this height too (NAV_MC_ALT_RAD); None: the distance alone counts."""
    first_climb_m: float = 0.0
    """PX4 climbs so high at least, above home, before a mission without a take-off
    (MIS_TAKEOFF_ALT)."""
    return_low_within_m: float = 0.0
    """Nearer than this to where it lands, a return may be lower than the return height."""
    return_type: int = 0
    """PX4's RTL_TYPE."""
    speed_m_s: float = 0.0
    """How fast it flies its legs at most (WPNAV_SPEED, MPC_XY_CRUISE), where no item says
    otherwise."""
    accel_m_s2: float = 2.5
    """Its acceleration on legs (WPNAV_ACCEL, MPC_ACC_HOR)."""
    return_climb_m: float = 0.0
    """A return climbs so much at least (RTL_CLIMB_MIN)."""
    climb_m_s: float = 1.5
    """How fast it climbs (MPC_TKO_SPEED or MPC_Z_V_AUTO_UP, the slower one; WP_SPD_UP)."""
    descend_m_s: float = 1.5
    """How fast it descends (MPC_Z_V_AUTO_DN, WP_SPD_DN)."""
    land_m_s: float = 0.5
    """How fast it comes down to the ground (MPC_LAND_SPEED, LAND_SPD_MS)."""
    return_waits_s: float = 5.0
    """How long a return hovers before it lands (RTL_LAND_DELAY, RTL_LOIT_TIME); inf: it does not
    land."""


@dataclass(frozen=True, slots=True)
class Ground:
    """Where the vehicle's local frame lies, and what of the vehicle shapes a path.

    `north_east_of` and `origin_alt_amsl_m` are None while the origin is not known; then only
    plans in metres from the take-off point have a path.  `start_ned` is where it is now, and
    `on_ground` whether it stands there.  `return_up_m` is its return height above home.
    `rally` are the rally points that it will have on board.
    """

    autopilot: AutopilotName
    home_ned: Vec3
    start_ned: Vec3
    north_east_of: NorthEastOf | None = None
    origin_alt_amsl_m: float | None = None
    return_up_m: float | None = None
    settings: FlightSettings = FlightSettings()
    rally: tuple[LandingPlace, ...] = ()
    on_ground: bool = False
    begin_item: int = 0
    """Where the mission begins, counting into `Plan.items`: in the air it need not be the first."""
    battery_pct: float | None = None
    """How much charge the vehicle says is left; None: it has not said."""


@dataclass(frozen=True, slots=True)
class FlightPath:
    """`problems` not empty means that the path is not the whole path."""

    legs: tuple[Leg, ...]
    circles: tuple[LoiterCircle, ...]
    problems: tuple[Problem, ...]
    regions: tuple[Region, ...] = field(default=())

    @property
    def segments(self) -> tuple[tuple[Vec3, Vec3], ...]:
        return tuple((leg.from_ned, leg.to_ned) for leg in self.legs)

    @property
    def flown(self) -> Iterator[tuple[Vec3, Vec3]]:
        """The legs, and the circles as polygons about them."""
        yield from self.segments
        for circle in self.circles:
            north_m, east_m, down_m = circle.centre_ned
            reach_m = circle.radius_m / math.cos(math.pi / CIRCLE_SIDES)
            turns = [math.tau * side / CIRCLE_SIDES for side in range(CIRCLE_SIDES + 1)]
            yield from pairwise(
                (north_m + reach_m * math.cos(turn), east_m + reach_m * math.sin(turn), down_m)
                for turn in turns
            )

    @property
    def corners(self) -> Iterator[Vec3]:
        """Points of which the hull has all that may be flown."""
        for leg in self.legs:
            yield from (leg.from_ned, leg.to_ned)
        for region in self.regions:
            yield from region.points
        for circle in self.circles:
            north, east, down = circle.centre_ned
            for away_m in (-circle.radius_m, circle.radius_m):
                yield from ((north + away_m, east, down), (north, east + away_m, down))

    @property
    def length_m(self) -> float:
        """Of the legs, without the circles."""
        return sum(math.dist(leg.from_ned, leg.to_ned) for leg in self.legs)
