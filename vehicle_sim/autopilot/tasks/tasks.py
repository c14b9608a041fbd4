"""The flights of single modes: hold, level, take off, return, land."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from enum import Enum, auto
from math import atan2, sqrt

from vehicle_sim.autopilot.control.demands import (
    STILL,
    Demand,
    FlyLevel,
    FlyTo,
    FlyVelocity,
    Situation,
    Turner,
)
from vehicle_sim.autopilot.fence.rally import LandingSite
from vehicle_sim.autopilot.interface import Landed, Target
from vehicle_sim.autopilot.parameters.parameters import Parameters, Quantity
from vehicle_sim.autopilot.tasks.descent_rate import descent_m_s
from vehicle_sim.autopilot.tasks.return_height import return_up_m
from vehicle_sim.control_loops.trajectory import QUICK_M_S3, Law
from vehicle_sim.numerics.vectors import Vec3

_BELOW_GROUND_M = 1000.0
_REACHED_M = 0.3
_BRAKE_M_S2 = 7.5
_FACE_BEYOND_M = 2.0  # nearer than this the bearing of a goal means nothing


def distance(a: Vec3, b: Vec3) -> float:
    n, e, d = a[0] - b[0], a[1] - b[1], a[2] - b[2]
    return sqrt(n * n + e * e + d * d)


def face(goal_ned: Vec3, s: Situation, turner: Turner) -> None:
    """Turn towards a goal that is far enough away to have a bearing."""
    north = goal_ned[0] - s.pos_ned[0]
    east = goal_ned[1] - s.pos_ned[1]
    if north * north + east * east > _FACE_BEYOND_M * _FACE_BEYOND_M:
        turner.turn_to(atan2(east, north))


@dataclass(slots=True, eq=False, repr=False)
class Hold:
    """Brake and stay; or fly to `goal_ned` and stay there.

    `lifts`: from the ground, too, as PX4 does with a place that it was given there; a take-off
    that goes on so is still called one (`landed_word`).
    """

    done = True

    goal_ned: Vec3 | None = None
    _yaw_rad: float | None = None
    _speed_m_s: float | None = None
    lifts: bool = False
    landed_word: Landed = Landed.IN_AIR
    _stops: bool = field(init=False)

    def __post_init__(self) -> None:
        self._stops = self.goal_ned is None

    @property
    def target(self) -> Target:
        return Target(self.goal_ned, None, self._yaw_rad)

    def lifts_off(self, s: Situation) -> bool:
        return self.lifts

    def begin(self, s: Situation, turner: Turner) -> None:
        if self.goal_ned is None:
            self.goal_ned = s.stop_ned
        if self._yaw_rad is not None:
            turner.turn_to(self._yaw_rad)

    def update(self, s: Situation, turner: Turner) -> Demand:
        limits = s.limits
        if self._speed_m_s is not None:
            limits = replace(limits, speed_m_s=self._speed_m_s)
        if self._stops:  # where it comes to rest by itself; no such stop was recorded
            limits = replace(limits, jerk_m_s3=QUICK_M_S3, law=Law.STEADY)
        return FlyTo(self.goal_ned or s.stop_ned, limits)


class Brake(Hold):
    """ArduCopter's BRAKE: a velocity of 0, from 7.5 m/s^2 at the jerk of all its flights.

    So the velocity falls by 5 / 7.5 of itself in a second: recorded stops went on for 3.1 m from
    2 m/s, 9.0 m from 5 and 20.5 m from 10, and for 1.5 m from 1 m/s upwards.  It begins anew
    (mode_brake.cpp), so that one that still gained went on no farther: 9.0 m from 5 m/s.
    """

    __slots__ = ()

    def update(self, s: Situation, turner: Turner) -> Demand:
        most = _BRAKE_M_S2
        limits = replace(s.limits, accel_m_s2=most, accel_vertical_m_s2=most, accel_up_m_s2=most)
        return FlyVelocity(STILL, limits, anew=True)


class Level:
    """A manual mode without sticks: level, at the height where it began."""

    landed_word = Landed.IN_AIR
    done = True

    __slots__ = ("_down_m",)

    def __init__(self) -> None:
        self._down_m = 0.0

    @property
    def target(self) -> Target:
        return Target(None, None, None)

    def lifts_off(self, s: Situation) -> bool:
        return False

    def begin(self, s: Situation, turner: Turner) -> None:
        self._down_m = s.stop_ned[2]

    def update(self, s: Situation, turner: Turner) -> Demand:
        return FlyLevel(self._down_m, s.limits)


class TakeOff:
    """Straight up to `goal_d` [m, NED].

    PX4 climbs slower for its first MPC_TKO_RAMP_T, and calls it done within NAV_MC_ALT_RAD of the
    height (navigator, `MissionBlock::is_mission_item_reached`), where it then holds: up to that
    much too low.  ArduCopter opens its throttle within TKOFF_SLEW_TIME, so it leaves the ground
    when it has come to the thrust of hover.
    """

    __slots__ = ("_done", "_goal_d", "_ned", "_parameters", "_since_ns")

    def __init__(self, goal_d: float, parameters: Parameters) -> None:
        self._goal_d = goal_d
        self._parameters = parameters
        self._ned: Vec3 = (0.0, 0.0, goal_d)
        self._done = False
        self._since_ns: int | None = None  # ArduCopter's throttle opens, PX4 has left the ground

    @property
    def landed_word(self) -> Landed:
        return Landed.IN_AIR if self._done else Landed.TAKEOFF

    @property
    def done(self) -> bool:
        return self._done

    @property
    def target(self) -> Target:
        return Target(self._ned, None, None)

    def lifts_off(self, s: Situation) -> bool:
        get = self._parameters.get
        if self._parameters.rules.lifts_off_at_once:
            return True
        return self._run_s(s) >= get("TKOFF_SLEW_TIME") * get("MOT_THST_HOVER")

    def begin(self, s: Situation, turner: Turner) -> None:
        where = s.stop_ned if s.flying else s.pos_ned
        self._ned = (where[0], where[1], self._goal_d)

    def update(self, s: Situation, turner: Turner) -> Demand:
        near = self._parameters.rules.take_off_done_within
        near_m = _REACHED_M if near is None else self._parameters.get(near)
        if not self._done and abs(s.pos_ned[2] - self._goal_d) < near_m:
            self._done = True
        climb_m_s = self._parameters.si(Quantity.TAKEOFF_CLIMB_M_S)
        ramp = self._parameters.rules.take_off_ramp
        if ramp is not None:
            ramp_s = self._parameters.get(ramp)
            gone_s = self._run_s(s)
            climb_m_s *= gone_s / ramp_s if gone_s < ramp_s else 1.0
        limits = s.limits
        return FlyTo(self._ned, replace(limits, climb_m_s=min(limits.climb_m_s, climb_m_s)))

    def _run_s(self, s: Situation) -> float:
        """Since this was asked first."""
        if self._since_ns is None:
            self._since_ns = s.time_ns
        return 1e-9 * (s.time_ns - self._since_ns)


class Land:
    """Down, where the vehicle comes to rest when this begins (or at `where_ned`), slow near the
    ground.

    `rate` gives another rate of descent [m/s], the same at any height; `landed_word` is what is
    told meanwhile.
    """

    done = False

    __slots__ = ("_given_ned", "_parameters", "_rate", "_where_ned", "landed_word")

    def __init__(
        self,
        parameters: Parameters,
        where_ned: Vec3 | None = None,
        rate: Callable[[Parameters], float] | None = None,
        landed_word: Landed = Landed.LANDING,
    ) -> None:
        self._parameters = parameters
        self._given_ned = self._where_ned = where_ned
        self._rate = rate
        self.landed_word = landed_word

    @property
    def target(self) -> Target:
        return Target(self._where_ned, None, None)

    def lifts_off(self, s: Situation) -> bool:
        return False

    def begin(self, s: Situation, turner: Turner) -> None:
        self._where_ned = self._given_ned or s.stop_ned

    def update(self, s: Situation, turner: Turner) -> Demand:
        where = self._where_ned or s.stop_ned
        if self._rate is not None:
            descend_m_s = self._rate(self._parameters)
        else:
            up_m = s.home_ned[2] - s.pos_ned[2]
            descend_m_s = descent_m_s(self._parameters, up_m, s.limits.descend_m_s)
        limits = replace(s.limits, descend_m_s=descend_m_s)
        below = (where[0], where[1], s.pos_ned[2] + _BELOW_GROUND_M)
        free = self._parameters.rules.lands_by_velocity
        return FlyTo(below, limits, straight=False, height_free=free)


class _Leg(Enum):
    CLIMB = auto()
    HOME = auto()
    DESCEND = auto()
    WAIT = auto()
    LAND = auto()
    STAY = auto()


class Return:
    """Climb to the return height, home in a straight line, down, wait, land.

    `haven` finds another place than home, from where the return begins.  `tell` is given the words
    for each leg, and the heights [m, NED] where it goes and of the ground there.
    """

    done = False

    __slots__ = (
        "_find_landing_site",
        "_goal",
        "_land",
        "_landing_site",
        "_leg",
        "_parameters",
        "_tell",
        "_until_ns",
    )

    def __init__(
        self,
        parameters: Parameters,
        haven: Callable[[Vec3], LandingSite] | None = None,
        tell: Callable[[str, float, float], None] | None = None,
    ) -> None:
        self._parameters = parameters
        self._tell = tell
        self._find_landing_site = haven
        self._landing_site: LandingSite | None = None
        self._leg = _Leg.CLIMB
        self._goal: Vec3 | None = None
        self._land: Land | None = None
        self._until_ns = 0

    @property
    def landed_word(self) -> Landed:
        return Landed.LANDING if self._leg is _Leg.LAND else Landed.IN_AIR

    @property
    def target(self) -> Target:
        return Target(self._goal, None, None)

    def lifts_off(self, s: Situation) -> bool:
        return False

    def begin(self, s: Situation, turner: Turner) -> None:
        haven = (
            LandingSite(s.home_ned)
            if self._find_landing_site is None
            else self._find_landing_site(s.pos_ned)
        )
        down = haven.ground_ned[2] - return_up_m(self._parameters, haven.ground_ned, s.stop_ned)
        top = min(s.stop_ned[2], down, down if haven.over_d is None else haven.over_d)
        self._landing_site = haven
        self._leg = _Leg.CLIMB
        self._goal = (s.stop_ned[0], s.stop_ned[1], top)
        self._say("climb to", top)

    def _say(self, words: str, down_m: float) -> None:
        if self._tell is not None and self._landing_site is not None:
            self._tell(words, down_m, self._landing_site.ground_ned[2])

    def update(self, s: Situation, turner: Turner) -> Demand:
        goal = self._goal or s.stop_ned
        home = s.home_ned if self._landing_site is None else self._landing_site.ground_ned
        arrived = distance(s.pos_ned, goal) < _REACHED_M
        match self._leg:
            case _Leg.CLIMB:
                if s.pos_ned[2] < goal[2] + _REACHED_M:
                    self._leg = _Leg.HOME
                    goal = (home[0], home[1], goal[2])
                    self._say("return at", goal[2])
                    if self._faces_home:
                        face(goal, s, turner)
            case _Leg.HOME:
                if arrived:
                    self._leg = _Leg.DESCEND
                    wait_d = home[2] - self._parameters.si(Quantity.RETURN_WAIT_UP_M)
                    goal = (home[0], home[1], max(goal[2], wait_d))
                    self._say("descend to", goal[2])
            case _Leg.DESCEND:
                if arrived:
                    self._leg = _Leg.WAIT
                    wait_s = self._parameters.si(Quantity.RETURN_WAIT_S)
                    self._until_ns = s.time_ns + int(wait_s * 1e9)
            case _Leg.WAIT:
                if s.time_ns >= self._until_ns:
                    goal = self._finish(goal, home)
            case _Leg.LAND | _Leg.STAY:
                pass
        self._goal = goal
        if self._land is not None:
            return self._land.update(s, turner)
        limits = s.limits
        if self._leg is _Leg.HOME and "RTL_SPEED" in self._parameters:
            speed_m_s = 0.01 * self._parameters.get("RTL_SPEED")
            limits = replace(limits, speed_m_s=speed_m_s or limits.speed_m_s)
        return FlyTo(goal, limits)

    def _finish(self, goal: Vec3, home: Vec3) -> Vec3:
        final_up_m = 0.0
        if "RTL_ALT_FINAL" in self._parameters:
            final_up_m = 0.01 * self._parameters.get("RTL_ALT_FINAL")
        if final_up_m > 0.0:
            self._leg = _Leg.STAY
            return (home[0], home[1], home[2] - final_up_m)
        self._leg = _Leg.LAND
        self._land = Land(self._parameters, goal)
        self._say("land", goal[2])
        return goal

    @property
    def _faces_home(self) -> bool:
        nose = self._parameters.rules.nose_in_flight
        return nose is None or self._parameters.get(nose) in (1, 3)
