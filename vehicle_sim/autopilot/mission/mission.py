"""The mission runner: one flown item after another, over the plan that was loaded.

One `Mission` lives as long as its vehicle; leaving the mission mode and coming back goes on at
the current item.  Flown items are legs; what lies between them goes on the list of `Errands`
and is done while the next leg is flown.  A plan that only jumps cannot hang: the search for the
next leg is cut off, and goes on with the next update.
"""

from __future__ import annotations

from math import isfinite, radians

from vehicle_sim.autopilot.control.demands import Demand, FlyTo, Situation, Turner
from vehicle_sim.autopilot.interface import (
    Landed,
    MissionReached,
    PlanItem,
    StatusText,
    Target,
)
from vehicle_sim.autopilot.mission.item_legs import PLACELESS, leg_of, seconds, waits_for_payload
from vehicle_sim.autopilot.mission.item_texts import ItemTexts
from vehicle_sim.autopilot.mission.jumps import JUMPS, Jumps
from vehicle_sim.autopilot.mission.mission_commands import MissionCommands, MissionVehicle
from vehicle_sim.autopilot.mission.plan import (
    KINDS,
    Cmd,
    ItemKind,
    by_terrain,
    has_height,
    has_place,
    place_of,
)
from vehicle_sim.autopilot.parameters.parameters import Parameters, Quantity
from vehicle_sim.autopilot.tasks.circle import CircleTask
from vehicle_sim.autopilot.tasks.guided_limits import GuidedLimits
from vehicle_sim.autopilot.tasks.legs import Go, GoToHeight, Leg, Rise, Whole
from vehicle_sim.autopilot.tasks.spline import Spline, curve
from vehicle_sim.autopilot.tasks.tasks import Return, TakeOff, face
from vehicle_sim.numerics.vectors import Vec3

_SEARCHED_MAX = 64  # items in one update
_BY_HOME = {1: 1.0, 2: -1.0}  # MPC_YAW_MODE: towards it, away from it
_RADIUS_M = 10.0  # of LOITER_TURNS without one
_THROUGH = frozenset({Cmd.WAYPOINT, Cmd.SPLINE, Cmd.LOITER_UNLIM, Cmd.LOITER_TIME})


class Mission:
    """The plan, where it stands, and the task of the mission mode."""

    __slots__ = (
        "_before_ned",
        "_by_home",
        "_circle",
        "_commands",
        "_first_task",
        "_goal",
        "_jumps",
        "_last",
        "_leg",
        "_next",
        "_parameters",
        "_rules",
        "_texts",
        "_until_ns",
        "_vehicle",
        "current",
        "finished",
        "items",
        "started",
    )

    def __init__(self, parameters: Parameters, vehicle: MissionVehicle) -> None:
        self._parameters = parameters
        self._vehicle = vehicle
        self._rules = parameters.rules
        self._texts = ItemTexts(vehicle, tells=self._rules.names_mission_items)
        self._commands = MissionCommands(vehicle, reports=self._rules.commands_are_reached)
        self._jumps = Jumps()
        self.load(())

    # ------------------------------------------------------------------------- the plan

    def load(self, items: tuple[PlanItem, ...]) -> None:
        self.items: tuple[PlanItem, ...] = items
        self.rewind()

    def rewind(self) -> None:
        """Back to the start, as if never flown."""
        self.current = self._next = 0
        self.finished = False
        self.started = False
        self._last = len(self.items) - 1
        self._jumps.forget()
        self._commands.forget()
        self._by_home = False
        self._goal: Vec3 | None = None
        self._before_ned: Vec3 | None = None
        self._first_task: TakeOff | None = None
        self._until_ns: int | None = None
        self._leg: Leg | None = None
        self._circle: CircleTask | None = None

    @property
    def empty(self) -> bool:
        return len(self.items) <= self._rules.first_mission_item

    def jump_to(self, seq: int) -> bool:
        """Make `seq` the current item; False where there is none."""
        if not 0 <= seq < len(self.items):
            return False
        self.current = self._next = max(seq, self._rules.first_mission_item)
        self.finished = False
        self._leg = None
        self._commands.drop()
        return True

    def limit(self, last: int) -> None:
        """Finish after item `last`; 0 = after the plan's own last."""
        self._last = last if 0 < last < len(self.items) else len(self.items) - 1

    @property
    def takes_off(self) -> bool:
        """Whether the next flown item is a take-off; ArduCopter looks past delays for it."""
        delays = self._rules.delays_before_take_off
        first = max(self.current, self._rules.first_mission_item)
        for item in self.items[first : self._last + 1]:
            if KINDS[item.command] is ItemKind.FLOWN and not (delays and item.command == Cmd.DELAY):
                return item.command == Cmd.TAKEOFF
        return False

    @property
    def jump_beyond(self) -> int | None:
        """Where a DO_JUMP of the plan leads to that is no item; None = nowhere."""
        goals = (int(item.p1) for item in self.items if item.command == Cmd.JUMP)
        return next((goal for goal in goals if not 0 <= goal < len(self.items)), None)

    def take_off_up_m(self, home_ned: Vec3) -> float:
        """PX4's first climb: to the first item's height above home, and not less than its own."""
        least_m = self._parameters.si(Quantity.TAKEOFF_UP_M)
        item = self._flown_from(self._next)
        if item is None or not has_height(item):
            return least_m
        up_m = home_ned[2] - place_of(item, self._vehicle.datum(), home_ned)[2]
        return up_m if item.command == Cmd.TAKEOFF else max(up_m, least_m)

    def _flown_from(self, index: int) -> PlanItem | None:
        first = max(index, self._rules.first_mission_item)
        for item in self.items[first : self._last + 1]:
            if KINDS[item.command] is ItemKind.FLOWN:
                return item
        return None

    # ------------------------------------------------------------------------- the task

    @property
    def landed_word(self) -> Landed:
        if self._first_task is not None:
            return self._first_task.landed_word
        return Landed.IN_AIR if self._leg is None else self._leg.landed_word

    @property
    def done(self) -> bool:
        return self.finished

    @property
    def target(self) -> Target:
        if self._first_task is not None:
            return self._first_task.target
        return Target(self._goal, None, None) if self._leg is None else self._leg.target

    def lifts_off(self, s: Situation) -> bool:
        if self.finished:
            return False
        item = self._flown_from(self._next)
        if item is not None and item.command == Cmd.DELAY and self._first_task is None:
            return self._delayed(item, s)
        return item is not None and item.command not in (Cmd.LAND, Cmd.RETURN)

    def _delayed(self, item: PlanItem, s: Situation) -> bool:
        """NAV_DELAY before the take-off: waited for on the ground; always False."""
        index = self.items.index(item, self._next)
        self.current = index
        if self._until_ns is None:
            self._until_ns = s.time_ns + int(item.p1 * 1e9)
        if s.time_ns >= self._until_ns:
            self._until_ns = None
            self._vehicle.emit(MissionReached(item.seq))
            for passed in self.items[self._next : index]:
                self._commands.put(passed)
            self.current = self._next = index + 1
        return False

    def begin(self, s: Situation, turner: Turner) -> None:
        restart = self._rules.mission_restart
        if self.finished or (restart is not None and self._parameters.get(restart)):
            self.rewind()
        self.started = True
        self._until_ns = None
        # The item that was left begins anew; what was to be done on the way is not done twice.
        if self._leg is not None:
            self._next = self.current
        self._next = max(self._next, self._rules.first_mission_item)
        self.current = max(self.current, self._rules.first_mission_item)
        self._leg = None
        self._commands.guided_limits = GuidedLimits()
        self.announce_begin()
        self._goal = s.stop_ned
        self._before_ned = None
        if not s.flying and not self.takes_off:
            goal_d = s.home_ned[2] - self.take_off_up_m(s.home_ned)
            self._first_task = self._take_off(goal_d)
            self._first_task.begin(s, turner)

    def update(self, s: Situation, turner: Turner) -> Demand:
        if self._first_task is not None:
            demand = self._first_task.update(s, turner)
            if self._first_task.done:
                self._first_task = None
            return demand
        if not self.finished:
            self._go_on(s, turner)
        if not self.finished:
            self._commands.run_commands(s, self._goal)
        if self._by_home:
            self._mind_home(s, turner)
        demand = self._fly(s, turner)
        if not self.finished:
            self._commands.update_payload(s, turner)
        return demand

    def touched_down(self) -> None:
        """The land detector struck: the item that landed is over."""
        if not self.finished and self._leg is not None:
            if self.items[self.current].command == Cmd.RETURN:
                self.current = self._last
                self._next = self._last + 1
            self._reached()
            self.finished = self._next > self._last

    # ------------------------------------------------------------------------ the items

    def _go_on(self, s: Situation, turner: Turner) -> None:
        """To the next leg, if this one is over."""
        entry_m_s = 0.0
        if self._leg is not None:
            if self._circle is not None:
                self._texts.circling(self.items[self.current], self._circle.completed)
            if not self._leg.done(s):
                return
            if isinstance(self._leg, Spline) and not self._leg.stops:
                entry_m_s = self._leg.speed
            if self._circle is not None:
                self._goal = s.stop_ned
            self._reached()
        for _ in range(_SEARCHED_MAX):
            if self._next > self._last:
                self.finished = self._commands.idle
                return
            item = self.items[self._next]
            self.current = self._next
            if KINDS[item.command] is ItemKind.FLOWN or waits_for_payload(item, self._rules):
                self._next += 1
                self._start(item, s, turner, entry_m_s)
                return
            if item.command in JUMPS:
                self._jump(item)
            else:
                self._commands.put(item)
                self._next += 1
                self._texts.start(item)

    def _reached(self) -> None:
        item = self.items[self.current]
        self._vehicle.emit(MissionReached(item.seq))
        self._texts.reached(item)
        self._leg = None
        self._commands.drop()

    def _jump(self, item: PlanItem) -> None:
        there = self._jumps.leads_to(item, self.items)
        self._next = self._next + 1 if there is None else there
        if there is None and self._rules.tells_end_of_jumps:
            self._vehicle.emit(StatusText(6, "DO JUMP repetitions completed."))

    def announce_begin(self) -> None:
        self._texts.begin(self.items[self._next : self._last + 1])

    def _start(self, item: PlanItem, s: Situation, turner: Turner, entry_m_s: float) -> None:
        self._texts.start(item)
        self._circle = None
        if item.command == Cmd.RETURN:
            self._commands.run_commands(s, self._goal)
            if self._vehicle.leave_for_return():
                # As in PX4 since 1.16: the return mode takes over, the mission is complete.
                self.current = self._last
                self._next = self._last + 1
                self._reached()
                self.finished = True
                return
            home = Return(self._parameters)
            home.begin(s, turner)
            self._leg = Whole(home)
            return
        if by_terrain(item) and self._vehicle.leave_without_terrain():
            self._next = self.current
            return
        here = self._goal if entry_m_s > 0.0 and self._goal is not None else s.stop_ned
        place = place_of(item, self._vehicle.datum(), here)
        self._leg = self._leg_of(item, place, here, s, turner, entry_m_s)
        self._before_ned, self._goal = here, self._leg.target.pos_ned
        if item.command not in PLACELESS:
            self._set_heading(item, place, s, turner)

    def _leg_of(
        self,
        item: PlanItem,
        place: Vec3,
        here: Vec3,
        s: Situation,
        turner: Turner,
        entry_m_s: float,
    ) -> Leg:
        accept_m = self._accept_m(item)
        match item.command:
            case Cmd.TAKEOFF:
                take_off = self._take_off(place[2])
                take_off.begin(s, turner)
                goes = self._rules.take_off_goes_to_place and has_place(item)
                return Rise(take_off, Go(place, accept_m, 0.0) if goes else None)
            case Cmd.LOITER_TURNS:
                circle = CircleTask(place, _radius(item), item.p1, not item.p3 < 0.0)
                circle.begin(s, turner)
                self._circle = circle
                return Whole(circle)
            case Cmd.LOITER_TO_ALT:
                return GoToHeight(place, here[2])
            case Cmd.SPLINE:
                after, by_spline = self._after(item, place)
                before = self._before_ned if entry_m_s > 0.0 else None
                along = curve(here, place, before, after, after_is_spline=by_spline)
                return Spline(along, entry_m_s, after is None, accept_m, seconds(item))
            case _:
                goal = self._goal or s.stop_ned
                own = self._parameters
                return leg_of(item, place, goal, s, own, accept_m, self._guided_limits)

    def _guided_limits(self) -> GuidedLimits:
        return self._commands.guided_limits

    def _after(self, item: PlanItem, place: Vec3) -> tuple[Vec3 | None, bool]:
        """Where a spline goes on to without a stop, and whether as a spline; None = it ends at
        rest."""
        if seconds(item) > 0.0 or self._next > self._last:
            return None, False
        follower = self._flown_from(self._next)
        if follower is None or follower.command not in _THROUGH:
            return None, False
        if any(each.command in JUMPS for each in self.items[self._next : follower.seq]):
            return None, False
        onward = place_of(follower, self._vehicle.datum(), place)
        return onward, follower.command == Cmd.SPLINE

    def _take_off(self, goal_d: float) -> TakeOff:
        return TakeOff(goal_d, self._parameters)

    def _set_heading(self, item: PlanItem, place: Vec3, s: Situation, turner: Turner) -> None:
        self._by_home = False
        nose = self._rules.nose_in_flight
        if nose is not None and self._parameters.get(nose) == 0:
            return
        if self._rules.items_have_heading:
            if isfinite(item.p4):
                turner.turn_to(radians(item.p4))
                return
            if self._parameters.get("MPC_YAW_MODE") in _BY_HOME:
                self._by_home = True
                return
        face(place, s, turner)

    def _mind_home(self, s: Situation, turner: Turner) -> None:
        """MPC_YAW_MODE 1 and 2: the nose to home, or the tail."""
        there = _BY_HOME.get(int(self._parameters.get("MPC_YAW_MODE")), 0.0)
        (n, e, d), (home_n, home_e, _) = s.pos_ned, s.home_ned
        face((n + there * (home_n - n), e + there * (home_e - e), d), s, turner)

    def _accept_m(self, item: PlanItem) -> float:
        own = self._rules.waypoints_have_radius and item.command == Cmd.WAYPOINT
        if own and isfinite(item.p2) and item.p2 > 0.0:
            return item.p2
        return self._parameters.si(Quantity.ACCEPT_M)

    # ----------------------------------------------------------------------- the flying

    def _fly(self, s: Situation, turner: Turner) -> Demand:
        if self._leg is not None:
            return self._leg.update(s, turner)
        return FlyTo(self._goal or s.stop_ned, s.limits)


def _radius(item: PlanItem) -> float:
    """Metres; of LOITER_TURNS' param 3, whose sign is the direction."""
    radius = abs(item.p3) if isfinite(item.p3) else 0.0
    return radius if radius >= 1.0 else _RADIUS_M
