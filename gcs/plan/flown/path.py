"""The path that a plan flies: its legs and circles, and the regions beside them.

Geometry only: the gate decides what may be flown.  Every way through the jumps is walked, so
the legs are those of the whole mission, each once.  How each item is flown is in `items.py`, by
autopilot; this follows PX4's navigator and ArduCopter's AUTO mode:

- a take-off climbs straight up; px4 then flies level to the item's position, ardupilot ignores it;
- a mission without a take-off that is begun on the ground climbs first to its first item's height
  (PX4 does so by itself, an ArduCopter is flown there before);
- at a waypoint the vehicle turns before it is there (`turns.py`), and flies splines as curves
  (`curves.py`);
- a landing first flies level to its position, then descends to the height of home;
- a return climbs to the return height (or stays if higher), flies straight to where it lands
  (`returns.py`), and descends;
- LOITER_TURNS flies to the nearest point of its circle and leaves where its turns end; the
  other loiters hover.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

from gcs.frames import Vec3
from gcs.plan import commands
from gcs.plan.change_speed import leg_speed_m_s
from gcs.plan.commands import KINDS, Kind
from gcs.plan.feasibility import never_starts
from gcs.plan.flown import returns
from gcs.plan.flown.circles import circle_ends, entries, first_arc, way_on
from gcs.plan.flown.curves import Neighbours, pieces, splines, ways_on
from gcs.plan.flown.overshoot import overshoot_m, past
from gcs.plan.flown.turns import blend, fewer, turning_places
from gcs.plan.item_places import ItemPlaces, PlaceUnknownError, is_here
from gcs.plan.items import Flown, flown_as
from gcs.plan.jumps import jump_target
from gcs.plan.legs import (
    FlightPath,
    Ground,
    Leg,
    LegKind,
    LoiterCircle,
    Problem,
    ProblemKind,
    Region,
    RegionKind,
)
from gcs.plan.model import Item, Plan
from gcs.wire.ids import Cmd

_VISITS_MAX = 32
_UNFLYABLE: dict[Flown | None, ProblemKind] = {
    Flown.MOVES_HOME: ProblemKind.HOME_MOVES,
    Flown.FENCE_PART: ProblemKind.NOT_OF_A_MISSION,
    Flown.REFUSED: ProblemKind.REFUSED,
    Flown.DESCENDS: ProblemKind.OWN_DESCENT,
}
_CURVE_BESIDE_S2 = 0.6
"""Times its acceleration the vehicle may be beside the halves' hulls: 1.5 m as ArduCopter comes."""


@dataclass(frozen=True, slots=True)
class _Here:
    """Where the vehicle is when an item begins: at `pos_ned`, or at one of `also`; its speed may
    carry it on to `past`.

    `before_ned` is where the waypoint leg that ended at `pos_ned` began, `before_curved` whether
    it was a curve; None after anything else.  `rests`: a curve may begin at rest.
    """

    pos_ned: Vec3
    also: tuple[Vec3, ...] = ()
    past: tuple[Vec3, ...] = ()
    before_ned: Vec3 | None = None
    before_curved: bool = False
    rests: bool = True

    @property
    def places(self) -> tuple[Vec3, ...]:
        return (self.pos_ned, *self.also)


def flight_path(plan: Plan, ground: Ground) -> FlightPath:
    """Never raises: what cannot be known is among the `problems`."""
    walk = PathWalk(plan, ground)
    for _ in walk.steps():
        pass
    return walk.path


class _DeadEndError(Exception):
    """This way through the mission ends here, for a reason that is among the problems."""


class PathWalk:
    """The walk along a plan, item by item: 2,000 of them take half a second."""

    def __init__(self, plan: Plan, ground: Ground) -> None:
        self._plan = plan
        self._ground = ground
        self._places = ItemPlaces(ground)
        settings = ground.settings
        self._speed_m_s = settings.speed_m_s
        self._legs: dict[Leg, None] = {}
        self._circles: dict[LoiterCircle, None] = {}
        self._regions: dict[Region, None] = {}
        self._problems: dict[Problem, None] = {}
        self._seen: set[tuple[int, _Here, float]] = set()
        self._visits: dict[int, int] = {}
        self._branches: list[tuple[int, _Here, float]] = []

    def steps(self) -> Iterator[None]:
        """One item a step; after the last one `path` is whole."""
        for index, why in never_starts(self._plan, self._ground.autopilot):
            self._problem(index, ProblemKind.NEVER_STARTS, why)
        begin = self._ground.begin_item
        for item in self._plan.items[:begin]:
            self._change_speed(item, faster_only=True)
        self._branches.append((begin, self._begin(), self._speed_m_s))
        while self._branches:
            index, here, self._speed_m_s = self._branches.pop()
            try:
                yield from self._follow(index, here)
            except _DeadEndError:
                continue

    @property
    def path(self) -> FlightPath:
        parts = tuple(self._legs), tuple(self._circles), tuple(self._problems)
        return FlightPath(*parts, tuple(self._regions))

    def _begin(self) -> _Here:
        """From the ground up, where the mission has no take-off of its own."""
        start_ned = self._ground.start_ned
        first = next(
            (i for i, item in enumerate(self._plan.items) if KINDS.get(item.command) is Kind.MOVE),
            None,
        )
        if first is None or not self._ground.on_ground:
            return _Here(start_ned)
        item = self._plan.items[first]
        if item.command in (Cmd.NAV_TAKEOFF, Cmd.NAV_LAND):
            return _Here(start_ned)
        try:
            wanted_down_m = self._places.down(item, start_ned)
        except PlaceUnknownError:
            return _Here(start_ned)
        least_down_m = self._ground.home_ned[2] - self._ground.settings.first_climb_m
        return self._climb(first, start_ned, min(wanted_down_m, least_down_m))

    def _follow(self, index: int, here: _Here) -> Iterator[None]:
        """Walk from item `index`, entered at `here`, to the end of the mission or to where this
        walk was before."""
        while index < len(self._plan.items) and (index, here, self._speed_m_s) not in self._seen:
            yield
            self._seen.add((index, here, self._speed_m_s))
            self._visits[index] = self._visits.get(index, 0) + 1
            if self._visits[index] > _VISITS_MAX:
                raise self._problem(index, ProblemKind.TOO_MANY_WAYS)
            item = self._plan.items[index]
            unflyable = _UNFLYABLE.get(flown_as(item.command, self._ground.autopilot))
            if unflyable is not None:
                raise self._problem(index, unflyable)
            match KINDS.get(item.command):
                case Kind.MOVE:
                    try:
                        here = self._move(index, item, here)
                    except PlaceUnknownError as error:
                        raise self._problem(index, error.kind) from None
                case Kind.RETURN:
                    self._return(index, here)
                    return
                case Kind.JUMP:
                    self._jump(index, item, here)
                case Kind.WAIT | Kind.ACT:
                    self._change_speed(item)
                case Kind.SET_HOME | Kind.FENCE | None:
                    raise self._problem(index, ProblemKind.NOT_FLOWN)
            index += 1
        if index == len(self._plan.items):
            self._starts(index - 1, here, here.pos_ned)

    def _problem(self, index: int, kind: ProblemKind, why: str = "") -> _DeadEndError:
        label = commands.item_label(index, self._plan.items[index].command)
        sentence = f"{label}: {kind.value}"
        if why:
            sentence += f": {why}"
        self._problems[Problem(index, kind, sentence)] = None
        return _DeadEndError()

    def _leg(self, index: int, kind: LegKind, from_ned: Vec3, to_ned: Vec3) -> Vec3:
        if from_ned != to_ned:
            self._legs[Leg(index, kind, from_ned, to_ned)] = None
        return to_ned

    def _region(
        self,
        index: int,
        kind: RegionKind,
        starts: tuple[Vec3, ...],
        ends: tuple[Vec3, ...],
        aim_ned: Vec3 | None = None,
    ) -> None:
        """What is no more than its own straight leg is judged as the leg."""
        if len(set(starts) | set(ends)) > 2:
            aim_ned = ends[0] if aim_ned is None else aim_ned
            self._regions[Region(index, kind, starts, ends, aim_ned)] = None

    def _starts(self, index: int, here: _Here, aim_ned: Vec3) -> tuple[Vec3, ...]:
        """Where it is, and where its speed may carry it.  That is judged at once: what begins at a
        place may be as near to a boundary as the place is, and it was at none of these yet."""
        also = fewer((*here.also, *here.past), without=here.pos_ned)
        self._region(index, RegionKind.TURN, here.places, also, aim_ned)
        return (here.pos_ned, *also)

    def _past(self, starts: tuple[Vec3, ...], to_ned: Vec3) -> tuple[Vec3, ...]:
        """Where a vehicle that comes from `starts` is carried to past `to_ned`."""
        reach_m = self._overshoot_m
        return fewer(tuple(past(start, to_ned, reach_m) for start in starts), without=to_ned)

    @property
    def _overshoot_m(self) -> float:
        return overshoot_m(self._ground.autopilot, self._speed_m_s)

    # ---------------------------------------------------------------------------- items

    def _jump(self, index: int, item: Item, here: _Here) -> None:
        """The jump is a branch of its own; going on after it is always possible too."""
        if item.params[1] == 0.0:
            return
        target = jump_target(self._plan, item)
        if target is None:
            raise self._problem(index, ProblemKind.JUMP_NOWHERE)
        self._branches.append((target, here, self._speed_m_s))

    def _change_speed(self, item: Item, *, faster_only: bool = False) -> None:
        """DO_CHANGE_SPEED of the legs; below zero: its own speed again.

        `faster_only`: of an item that was flown before, or was not: nobody knows which.
        """
        speed_m_s = leg_speed_m_s(item, self._ground.autopilot)
        if speed_m_s is not None:
            own_m_s = self._ground.settings.speed_m_s
            least_m_s = self._speed_m_s if faster_only else 0.0
            changed_m_s = max(speed_m_s, least_m_s)
            if speed_m_s <= 0.0:
                changed_m_s = max(own_m_s, self._speed_m_s)
            self._speed_m_s = changed_m_s

    def _move(self, index: int, item: Item, here: _Here) -> _Here:
        match flown_as(item.command, self._ground.autopilot):
            case Flown.TAKE_OFF | Flown.TAKE_OFF_THEN_PLACE:
                return self._take_off(index, item, here)
            case Flown.LAND:
                return self._land(index, item, here)
            case Flown.CIRCLE:
                return self._turns(index, item, here)
            case Flown.CURVE:
                return self._curve(index, item, here)
            case Flown.LEVEL_THEN_HEIGHT:
                return self._level_then_height(index, item, here)
            case _:
                return self._straight(index, item, here)

    def _straight(self, index: int, item: Item, here: _Here) -> _Here:
        aims = self._aims(item, here)
        to_ned = self._leg(index, LegKind.STRAIGHT, here.pos_ned, aims[0])
        starts = self._starts(index, here, to_ned)
        self._region(index, RegionKind.TURN, starts, aims)
        if here.before_ned is not None and self._ground.autopilot == "ardupilot":
            accept_m = self._ground.settings.accept_m
            ends = blend(here.before_ned, here.pos_ned, to_ned, accept_m)
            self._region(index, RegionKind.TURN, (ends[0], here.pos_ned), (ends[1],))
        fast = item.command in (Cmd.NAV_WAYPOINT, Cmd.NAV_SPLINE_WAYPOINT)
        also = fewer((*self._turning(item, starts, to_ned), *aims[1:]), without=to_ned)
        past_it = self._past(starts, to_ned)
        return _Here(to_ned, also, past_it, before_ned=here.pos_ned if fast else None)

    def _turning(self, item: Item, starts: tuple[Vec3, ...], to_ned: Vec3) -> tuple[Vec3, ...]:
        """Where it may be when it turns at `to_ned`, beside that."""
        settings = self._ground.settings
        accept_m = settings.accept_m
        own_m = item.params[1]
        if self._ground.autopilot == "px4" and item.command == Cmd.NAV_WAYPOINT and own_m > 0.0:
            accept_m = own_m
        return turning_places(starts, to_ned, accept_m, settings.accept_up_m)

    def _climb(self, index: int, from_ned: Vec3, down_m: float) -> _Here:
        """Straight up; px4 counts a climb as done while something of it is left."""
        top_ned = (*from_ned[:2], min(down_m, from_ned[2]))
        if top_ned != from_ned:
            self._legs[Leg(index, LegKind.CLIMB, from_ned, top_ned, take_off=True)] = None
        short_m = self._ground.settings.accept_up_m
        if self._ground.autopilot != "px4" or not short_m:
            return _Here(top_ned)
        low_ned = (*top_ned[:2], min(from_ned[2], top_ned[2] + short_m))
        return _Here(top_ned, (low_ned,) if low_ned != top_ned else ())

    def _take_off(self, index: int, item: Item, here: _Here) -> _Here:
        top = self._climb(index, here.pos_ned, self._places.down(item, here.pos_ned))
        if flown_as(item.command, self._ground.autopilot) is Flown.TAKE_OFF:
            return top
        over_ned = (*self._places.horizontal(item, top.pos_ned), top.pos_ned[2])
        self._leg(index, LegKind.STRAIGHT, top.pos_ned, over_ned)
        self._region(index, RegionKind.TURN, top.places, (over_ned,))
        also = self._turning(item, top.places, over_ned)
        return _Here(over_ned, also, self._past(top.places, over_ned))

    def _land(self, index: int, item: Item, here: _Here) -> _Here:
        down_m = self._ground.home_ned[2]
        starts = self._starts(index, here, here.pos_ned)
        nominal = self._places.horizontal(item, here.pos_ned)
        spots = [place[:2] if is_here(item) else nominal for place in starts]
        overs = tuple((*at, place[2]) for at, place in zip(spots, starts, strict=True))
        self._leg(index, LegKind.STRAIGHT, here.pos_ned, overs[0])
        self._region(index, RegionKind.TURN, starts, overs)
        grounds = tuple((*at, down_m) for at in dict.fromkeys(spots))
        self._leg(index, LegKind.DESCENT, overs[0], grounds[0])
        near = self._turning(item, (*starts, *overs), overs[0])
        beside = self._past(starts, overs[0])
        self._region(index, RegionKind.TURN, overs, beside)
        self._region(index, RegionKind.LANDING, (*overs, *near, *beside), grounds)
        return _Here(grounds[0], grounds[1:])

    def _level_then_height(self, index: int, item: Item, here: _Here) -> _Here:
        """LOITER_TO_ALT: over the place at the height it has, then up or down; or straight."""
        to_ned = self._places.place(item, here.pos_ned)
        starts = self._starts(index, here, to_ned)
        overs = tuple((*to_ned[:2], place[2]) for place in starts)
        self._leg(index, LegKind.STRAIGHT, here.pos_ned, overs[0])
        self._leg(index, LegKind.STRAIGHT, overs[0], to_ned)
        self._region(index, RegionKind.TURN, starts, (*overs, to_ned))
        also = self._turning(item, (*starts, *overs), to_ned)
        return _Here(to_ned, also, self._past(starts, to_ned))

    def _return(self, index: int, here: _Here) -> None:
        ground = self._ground
        if ground.return_up_m is None:
            raise self._problem(index, ProblemKind.NO_RETURN_HEIGHT)
        if not returns.straight(ground, self._plan):
            raise self._problem(index, ProblemKind.RETURN_ROUTE)
        starts = self._starts(index, here, here.pos_ned)
        for landing in returns.landing_places(ground, starts):
            way = returns.way_to(landing, ground, here.pos_ned)
            self._leg(index, LegKind.CLIMB, here.pos_ned, way.top_ned)
            self._leg(index, LegKind.RETURN, way.top_ned, way.over_ned)
            self._leg(index, LegKind.DESCENT, way.over_ned, way.ground_ned)
            for region in returns.regions(landing, ground, starts):
                self._region(index, RegionKind.RETURN, *region)
            beside = self._past(starts, way.over_ned)
            self._region(index, RegionKind.RETURN, (way.over_ned,), (*beside, way.ground_ned))

    def _turns(self, index: int, item: Item, here: _Here) -> _Here:
        centres = self._aims(item, here)
        centre_ned = centres[0]
        turns, _, radius_m, _ = item.params
        if not abs(radius_m) > 0.0 or math.isnan(turns):
            raise self._problem(index, ProblemKind.NO_RADIUS)
        for centre in centres:
            self._circles[LoiterCircle(index, centre, abs(radius_m))] = None
        starts = self._starts(index, here, centre_ned)
        begun = entries(starts, centre_ned, abs(radius_m))
        self._leg(index, LegKind.STRAIGHT, here.pos_ned, begun[0])
        around = way_on(starts, begun, centre_ned, abs(radius_m))
        self._region(index, RegionKind.ENTRY, starts, around)
        arc = first_arc(begun, centre_ned, radius_m)
        self._region(index, RegionKind.ENTRY, begun, arc, begun[0])
        leaves, on = circle_ends(begun, centre_ned, radius_m, turns, self._overshoot_m)
        return _Here(leaves[0], fewer(leaves, without=leaves[0]), fewer(on, without=leaves[0]))

    def _curve(self, index: int, item: Item, here: _Here) -> _Here:
        to_ned = self._places.place(item, here.pos_ned)
        self._leg(index, LegKind.STRAIGHT, here.pos_ned, to_ned)
        onward, may_stop = ways_on(self._plan, index, self._places, self._ground.autopilot, to_ned)
        neighbours = Neighbours(here.before_ned, here.before_curved, here.rests, onward, may_stop)
        starts = self._starts(index, here, to_ned)
        begins = starts if here.rests else (here.pos_ned,)
        found = splines(begins, to_ned, neighbours)
        first, *others = pieces(found, _CURVE_BESIDE_S2 * self._ground.settings.accel_m_s2)
        self._region(index, RegionKind.CURVE, starts, first, to_ned)
        for piece in others:
            self._region(index, RegionKind.CURVE, (), piece, to_ned)
        accept_m = self._ground.settings.accept_m
        ends = [way.ends(accept_m, self._overshoot_m) for way in found]
        behind = fewer(tuple(place for place, _ in ends), without=to_ned)
        on = fewer(tuple(place for _, both in ends for place in both), without=to_ned)
        return _Here(to_ned, behind, on, here.pos_ned, before_curved=True, rests=may_stop)

    def _aims(self, item: Item, here: _Here) -> tuple[Vec3, ...]:
        """Where the item leads; one without a place of its own may lead to any of `here`."""
        aims = [self._places.place(item, here.pos_ned)]
        if is_here(item):
            aims += [self._places.place(item, place) for place in here.also]
        return tuple(dict.fromkeys(aims))
