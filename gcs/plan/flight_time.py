"""How long a mission is in the air: item after item, with every repetition of its jumps.

An estimate that is rather too long.  A vehicle stops at every place, flies its legs at its own
speed and slows down for a place gently (`_BRAKE_SHARE`), climbs and descends at
its own speeds, and stays for `ITEM_S` where it comes to.  Of five recorded missions
(`tests/unit/plan/test_flight_time.py`) the estimate is 1.00 to 1.27 times what four took; the fifth
is a return from over home, which an ArduCopter flies without the climb: 1.54 times.

A mission that does not land ends in the air, also with a loiter without end; then its time has the
return from there, as somebody has to bring the vehicle home with the same battery.

How often a jump is made is counted once for the whole flight, not anew for every time that the
mission comes by (from memory of PX4's Mission and of AP_Mission; vehicle-sim does so).
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Final

from gcs.frames import Vec3
from gcs.plan.change_speed import climb_and_descent_m_s, leg_speed_m_s
from gcs.plan.commands import KINDS, Kind
from gcs.plan.flown import returns
from gcs.plan.flown.circles import circle_ends, entries
from gcs.plan.item_places import ItemPlaces, PlaceUnknownError
from gcs.plan.items import Flown, flown_as
from gcs.plan.jumps import jump_target
from gcs.plan.legs import Ground, ProblemKind
from gcs.plan.model import AutopilotName, Item, Plan
from gcs.wire.ids import Cmd

ITEM_S: Final = 1.0
GROUND_S: Final = 5.0
"""From the motors' start to the lift-off, and from the ground to the motors' stop: 3.5 and 4.5 s of
the recorded PX4, 3.5 and 1 s of the ArduCopter."""
PAYLOAD_S: Final = 5.0
"""A PX4 waits so long for its gripper or winch (MIS_PD_TO as delivered)."""
LANDS_FROM_M: Final = 10.0
"""Below this the vehicle lands slowly (MPC_LAND_ALT1 and LAND_ALT_LOW_M as delivered)."""
FASTEST_M_S: Final = 12.0
"""No item makes a vehicle faster than this here (MPC_XY_VEL_MAX as delivered)."""
DAY_S: Final = 86_400.0
"""No time is counted beyond it; NAV_DELAY until a time of day is as long."""
MOST_ITEMS: Final = 100_000
"""So many items, those that are repeated counted again, are as long as a day."""
_ENDS: Final[dict[AutopilotName, tuple[Cmd, ...]]] = {
    "px4": (Cmd.NAV_LOITER_UNLIM,),
    "ardupilot": (Cmd.NAV_LOITER_UNLIM, Cmd.NAV_LAND),
}
"""Nothing follows these.  An ArduCopter that has landed disarms; a PX4 amid its mission does not,
and goes on.  Recorded of a landing as the last item alone; of one before others it is what
vehicle-sim does, and from memory of both (ArduCopter's MIS_OPTIONS may let it go on)."""
_CLIMB_M_S2: Final = 1.0
"""WP_ACC_Z as delivered; the recorded PX4 climbs no more gently."""
_BRAKE_SHARE: Final = 0.6
"""Of its acceleration that it brakes with (vehicle-sim; the real ones recorded here are faster)."""
_JERK_M_S3: Final[dict[AutopilotName, float]] = {"px4": 4.0, "ardupilot": 1.0}
"""MPC_JERK_AUTO, WP_JERK as delivered."""
_CIRCLE_RAD_S: Final = math.radians(20.0)
"""CIRCLE_RATE as delivered; the recorded circle of 8 m was flown at 2.8 m/s."""


@dataclass(frozen=True, slots=True)
class FlightTime:
    """`time_s` from where the vehicle is to the end of the mission and its landing, or to where it
    was no longer counted.

    No more than a day.  `item` is the last item that was counted, into `Plan.items`.  `whole`: the
    mission ends there, and its way home is counted too.  `endless` is the jump that repeats for
    ever by which it came there; None: none does.
    """

    time_s: float
    item: int
    whole: bool
    endless: int | None = None


class TimeWalk:
    """The walk along a plan as it is flown; it ends where the time is more than `most_s`."""

    def __init__(self, plan: Plan, ground: Ground, most_s: float = DAY_S) -> None:
        self._plan = plan
        self._ground = ground
        self._most_s = min(most_s, DAY_S)
        self._places = ItemPlaces(ground)
        self._pos_ned = ground.start_ned
        self._on_ground = ground.on_ground
        self._speed_m_s = ground.settings.speed_m_s
        self._climb_m_s = ground.settings.climb_m_s
        self._descend_m_s = ground.settings.descend_m_s
        self._jerk_m_s3 = _JERK_M_S3[ground.autopilot]
        self._jumps: dict[int, int] = {}
        self._endless: int | None = None
        self._time_s = 0.0
        self.result: FlightTime | None = None
        self.ends_s: dict[int, float] = {}
        """When each item is over for the first time, by its place in `Plan.items`."""

    def steps(self) -> Iterator[None]:
        """One item a step; after the last one there is a `result`."""
        for item in self._plan.items[: self._ground.begin_item]:
            self._change_speed(item, slower_only=True)
        index: int | None = self._ground.begin_item
        last = self._ground.begin_item
        for _ in range(MOST_ITEMS):
            if index is None or index >= len(self._plan.items):
                break
            yield
            last, index = index, self._fly(index)
            self.ends_s.setdefault(last, self._time_s)
            if self._time_s > self._most_s:
                return self._end(self._time_s, last, whole=False)
        else:
            return self._end(DAY_S, last, whole=False)
        if not self._on_ground:
            self._return()
        return self._end(self._time_s, last, whole=True)

    def _end(self, time_s: float, last: int, *, whole: bool) -> None:
        self.result = FlightTime(min(time_s, DAY_S), last, whole, self._endless)

    def _fly(self, index: int) -> int | None:
        """The item that follows; None: nothing does."""
        item = self._plan.items[index]
        try:
            match KINDS.get(item.command):
                case Kind.MOVE:
                    self._move(item)
                    self._time_s += ITEM_S
                case Kind.WAIT:
                    self._time_s += _delay_s(item)
                case Kind.RETURN:
                    self._return()
                    return None
                case Kind.JUMP:
                    return self._jump(index, item)
                case Kind.ACT:
                    self._change_speed(item)
                    if flown_as(item.command, self._ground.autopilot) is Flown.WAITS:
                        self._time_s += PAYLOAD_S
                case Kind.SET_HOME | Kind.FENCE | None:
                    return None
        except PlaceUnknownError:
            return None  # the path has it among its problems
        return None if item.command in _ENDS[self._ground.autopilot] else index + 1

    def _jump(self, index: int, item: Item) -> int | None:
        repeats = item.params[1]
        done = self._jumps.get(index, 0)
        if 0.0 <= repeats <= done:
            return index + 1
        self._jumps[index] = done + 1
        target = jump_target(self._plan, item)
        if repeats < 0.0 and target is not None and target <= index:
            self._endless = index
        return target

    def _change_speed(self, item: Item, *, slower_only: bool = False) -> None:
        """`slower_only`: of an item that was flown before, or was not: nobody knows which."""
        climb_m_s, descend_m_s = climb_and_descent_m_s(item, self._ground.autopilot)
        self._climb_m_s = min(self._climb_m_s, climb_m_s)
        self._descend_m_s = min(self._descend_m_s, descend_m_s)
        speed_m_s = leg_speed_m_s(item, self._ground.autopilot)
        if speed_m_s is None:
            return
        own_m_s = self._ground.settings.speed_m_s
        changed_m_s = min(speed_m_s, max(own_m_s, FASTEST_M_S)) if speed_m_s > 0.0 else own_m_s
        self._speed_m_s = min(self._speed_m_s, changed_m_s) if slower_only else changed_m_s

    # ---------------------------------------------------------------------------- ways

    def _move(self, item: Item) -> None:
        flown = flown_as(item.command, self._ground.autopilot)
        if flown in (Flown.TAKE_OFF, Flown.TAKE_OFF_THEN_PLACE):
            self._take_off(self._places.down(item, self._pos_ned))
            if flown is Flown.TAKE_OFF:
                return
            self._level(self._places.horizontal(item, self._pos_ned))
            return
        if flown is Flown.LAND:
            self._level(self._places.horizontal(item, self._pos_ned))
            self._land(self._ground.home_ned[2])
            return
        to_ned = self._places.place(item, self._pos_ned)
        if self._on_ground:
            least_down_m = self._ground.home_ned[2] - self._ground.settings.first_climb_m
            self._take_off(min(to_ned[2], least_down_m))
        if flown is Flown.CIRCLE:
            self._circle(item, to_ned)
            return
        self._straight(to_ned)
        if item.command in (Cmd.NAV_WAYPOINT, Cmd.NAV_LOITER_TIME):
            self._time_s += _positive(item.params[0])

    def _take_off(self, down_m: float) -> None:
        if self._on_ground:
            self._time_s += GROUND_S
        self._on_ground = False
        self._height(min(down_m, self._pos_ned[2]))

    def _height(self, down_m: float) -> None:
        """Straight up or down to it."""
        self._straight((*self._pos_ned[:2], down_m))

    def _level(self, north_east: tuple[float, float]) -> None:
        self._straight((*north_east, self._pos_ned[2]))

    def _straight(self, to_ned: Vec3) -> None:
        self._time_s += self._leg_s(to_ned)
        self._pos_ned = to_ned

    def _land(self, down_m: float) -> None:
        """Straight down to the ground at `down_m`, the last of it slowly."""
        settings, high_m = self._ground.settings, max(0.0, down_m - self._pos_ned[2])
        slow_m = min(high_m, LANDS_FROM_M)
        self._time_s += from_rest_s(
            high_m - slow_m, self._descend_m_s, _CLIMB_M_S2, self._jerk_m_s3
        )
        self._time_s += slow_m / settings.land_m_s + GROUND_S
        self._pos_ned, self._on_ground = (*self._pos_ned[:2], down_m), True

    def _return(self) -> None:
        """To the place that is the longest way, where it may be any of several."""
        ways = [
            returns.way_to(landing, self._ground, self._pos_ned)
            for landing in returns.landing_places(self._ground, (self._pos_ned,))
        ]
        self._speed_m_s = min(self._speed_m_s, self._ground.settings.speed_m_s)
        begun_s, from_ned, longest_s = self._time_s, self._pos_ned, 0.0
        for way in ways:
            self._time_s, self._pos_ned = 0.0, from_ned
            self._height(way.top_ned[2])
            self._level(way.over_ned[:2])
            self._land(way.ground_ned[2])
            longest_s = max(longest_s, self._time_s)
        self._time_s = begun_s + longest_s + self._ground.settings.return_waits_s

    def _circle(self, item: Item, centre_ned: Vec3) -> None:
        """To the nearest point of the ring, and so often round it."""
        turns, _, radius_m, _ = item.params
        reach_m, settings = abs(radius_m), self._ground.settings
        if not reach_m > 0.0 or math.isnan(turns):
            raise PlaceUnknownError(ProblemKind.NO_RADIUS)
        begun = entries((self._pos_ned,), centre_ned, reach_m)
        self._time_s += self._leg_s(begun[0])
        speed_m_s = min(
            self._speed_m_s,
            math.sqrt(0.5 * settings.accel_m_s2 * reach_m),
            _CIRCLE_RAD_S * reach_m,
        )
        self._time_s += abs(turns) * 2.0 * math.pi * reach_m / speed_m_s
        self._pos_ned = circle_ends(begun, centre_ned, radius_m, turns, 0.0)[0][0]

    def _leg_s(self, to_ned: Vec3) -> float:
        """Straight there: over the ground, and up or down meanwhile."""
        settings, flat_m = self._ground.settings, math.dist(self._pos_ned[:2], to_ned[:2])
        up_m = self._pos_ned[2] - to_ned[2]
        climb_m_s = self._climb_m_s if up_m > 0.0 else self._descend_m_s
        brake_m_s2 = _BRAKE_SHARE * settings.accel_m_s2
        return max(
            from_rest_s(flat_m, self._speed_m_s, brake_m_s2, self._jerk_m_s3),
            from_rest_s(abs(up_m), climb_m_s, _CLIMB_M_S2, self._jerk_m_s3),
        )


def from_rest_s(way_m: float, speed_m_s: float, accel_m_s2: float, jerk_m_s3: float) -> float:
    """From rest to rest, no faster and with no more acceleration than that, which changes no faster
    than by `jerk_m_s3`."""
    if way_m <= 0.0:
        return 0.0
    if speed_m_s <= 0.0:
        return math.inf
    gains_m = speed_m_s * speed_m_s / accel_m_s2
    if way_m < gains_m:
        return 2.0 * math.sqrt(way_m / accel_m_s2) + accel_m_s2 / jerk_m_s3
    return way_m / speed_m_s + speed_m_s / accel_m_s2 + accel_m_s2 / jerk_m_s3


def _delay_s(item: Item) -> float:
    """NAV_DELAY: so many seconds, or until a time of day."""
    seconds, *time_of_day = item.params
    if seconds > 0.0:
        return seconds
    return DAY_S if any(part >= 0.0 for part in time_of_day) else 0.0


def _positive(value: float) -> float:
    """A parameter that may be less than zero, or not a number."""
    return value if value > 0.0 else 0.0


def flight_time(plan: Plan, ground: Ground) -> FlightTime:
    """All of it, at once; up to a day."""
    walk = TimeWalk(plan, ground)
    for _ in walk.steps():
        pass
    assert walk.result is not None
    return walk.result
