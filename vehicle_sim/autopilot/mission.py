"""The mission runner: one item after another, over the plan that was loaded.

One `Mission` lives as long as its vehicle; leaving the mission mode and coming back goes on at
the current item.  At most one item begins in an update, so a plan that only jumps cannot hang.
"""

from __future__ import annotations

from math import isfinite, radians

from vehicle_sim.autopilot.circle import Circle
from vehicle_sim.autopilot.demands import Demand, FlyTo, Situation, Task, Turner
from vehicle_sim.autopilot.errands import Crew, Errands
from vehicle_sim.autopilot.interface import (
    Landed,
    MissionReached,
    PlanItem,
    StatusText,
    Target,
    Vec3,
)
from vehicle_sim.autopilot.parameters import Parameters, Quantity
from vehicle_sim.autopilot.plan import KINDS, Cmd, Kind, first_of, place_of
from vehicle_sim.autopilot.tasks import Land, Return, TakeOff, distance, face

_OVER_M = 1.0  # "over the landing place"


class Mission:
    """The plan, where it stands, and the task of the mission mode."""

    __slots__ = (
        "_begun",
        "_crew",
        "_errands",
        "_first_task",
        "_goal",
        "_last",
        "_parameters",
        "_repeats",
        "_sub",
        "_until_ns",
        "current",
        "finished",
        "items",
        "started",
    )

    def __init__(self, parameters: Parameters, crew: Crew) -> None:
        self._parameters = parameters
        self._crew = crew
        self._errands = Errands(crew)
        self._begun = False
        self.load(())

    # ------------------------------------------------------------------------- the plan

    def load(self, items: tuple[PlanItem, ...]) -> None:
        self.items: tuple[PlanItem, ...] = items
        self.rewind()

    def rewind(self) -> None:
        """Back to the start, as if never flown."""
        self.current = 0
        self.finished = False
        self.started = False
        self._last = len(self.items) - 1
        self._repeats: dict[int, int] = {}
        self._errands.forget()
        self._goal: Vec3 | None = None
        self._first_task: TakeOff | None = None
        self._forget_item()

    @property
    def empty(self) -> bool:
        return len(self.items) <= first_of(self._parameters.personality)

    def jump_to(self, seq: int) -> bool:
        """Make `seq` the current item; False where there is none."""
        if not 0 <= seq < len(self.items):
            return False
        self.current = max(seq, first_of(self._parameters.personality))
        self.finished = False
        self._forget_item()
        return True

    def limit(self, last: int) -> None:
        """Finish after item `last`; 0 = after the plan's own last."""
        self._last = last if 0 < last < len(self.items) else len(self.items) - 1

    @property
    def takes_off(self) -> bool:
        """Whether the next flown item is a take-off."""
        item = self._next_flown()
        return item is not None and item.command == Cmd.TAKEOFF

    def _next_flown(self) -> PlanItem | None:
        start = max(self.current, first_of(self._parameters.personality))
        for item in self.items[start : self._last + 1]:
            if KINDS[item.command] is Kind.FLOWN:
                return item
        return None

    # ------------------------------------------------------------------------- the task

    @property
    def landed_word(self) -> Landed:
        if self._first_task is not None:
            return self._first_task.landed_word
        return Landed.IN_AIR if self._sub is None else self._sub.landed_word

    @property
    def done(self) -> bool:
        return self.finished

    @property
    def target(self) -> Target:
        if self._first_task is not None:
            return self._first_task.target
        return Target(self._goal, None, None) if self._sub is None else self._sub.target

    def lifts_off(self, s: Situation) -> bool:
        if self.finished:
            return False
        item = self._next_flown()
        return item is not None and item.command not in (Cmd.LAND, Cmd.RETURN)

    def begin(self, s: Situation, turner: Turner) -> None:
        first = first_of(self._parameters.personality)
        if self.finished:
            self.rewind()
        if self.current < first:
            self.current = first
        self.started = True
        self._forget_item()
        self._goal = s.stop_ned
        if not s.flying and not self.takes_off:
            goal_d = s.home_ned[2] - self._parameters.si(Quantity.TAKEOFF_UP_M)
            self._first_task = self._take_off(goal_d)
            self._first_task.begin(s, turner)

    def update(self, s: Situation, turner: Turner) -> Demand:
        if self._first_task is not None:
            demand = self._first_task.update(s, turner)
            if self._first_task.done:
                self._first_task = None
            return demand
        if not self.finished:
            item = self.items[self.current]
            if not self._begun:
                self._begun = True
                self._start(item, s, turner)
            if not self.finished and self._begun and self._over(item, s):
                self._reached(item)
        if not self.finished:
            self._errands.attend(s, turner)
        return self._fly(s, turner)

    def touched_down(self) -> None:
        """The land detector struck: the item that landed is over."""
        if not self.finished and self.items and self._sub is not None:
            if self.items[self.current].command == Cmd.RETURN:
                self.current = self._last
            self._reached(self.items[self.current])

    # ------------------------------------------------------------------------ the items

    def _forget_item(self) -> None:
        self._begun = False
        self._sub: Task | None = None
        self._until_ns: int | None = None

    def _take_off(self, goal_d: float) -> TakeOff:
        return TakeOff(goal_d, self._parameters.si(Quantity.TAKEOFF_CLIMB_M_S))

    def _reached(self, item: PlanItem) -> None:
        if KINDS[item.command] is Kind.FLOWN:
            self._crew.emit(MissionReached(item.seq))
        self._advance()

    def _advance(self) -> None:
        self._forget_item()
        if self.current >= self._last:
            self.finished = True
        else:
            self.current += 1

    def _start(self, item: PlanItem, s: Situation, turner: Turner) -> None:
        kind = KINDS[item.command]
        if kind is Kind.FLOWN:
            self._start_flown(item, s, turner)
        elif kind is Kind.WAITED:
            self._start_waited(item, s)
        elif kind is Kind.DONE:
            if item.command == Cmd.JUMP:
                self._jump(item)
            else:
                self._errands.do(item, s)
                self._advance()
        else:
            text = f"Mission item {item.seq}: no such equipment, passed over"
            self._crew.emit(StatusText(6, text))
            self._advance()

    def _start_flown(self, item: PlanItem, s: Situation, turner: Turner) -> None:
        if item.command == Cmd.RETURN:
            if not self._crew.leave_for_return():
                self._sub = Return(self._parameters)
                self._sub.begin(s, turner)
            return
        place = place_of(item, self._crew.datum(), s.stop_ned)
        if item.command == Cmd.TAKEOFF:
            self._sub = self._take_off(place[2])
            self._sub.begin(s, turner)
            self._goal = self._sub.target.pos_ned
            return
        if item.command == Cmd.LOITER_TURNS:
            self._sub = Circle(place, _radius(item), item.p1, not item.p3 < 0.0)
            self._sub.begin(s, turner)
        if item.command == Cmd.LAND:
            place = (place[0], place[1], s.stop_ned[2])
        self._goal = place
        self._set_heading(item, place, s, turner)

    def _set_heading(self, item: PlanItem, place: Vec3, s: Situation, turner: Turner) -> None:
        if self._parameters.personality == "px4":
            if isfinite(item.p4):
                turner.turn_to(radians(item.p4))
                return
        elif self._parameters.get("WP_YAW_BEHAVIOR") == 0:
            return
        face(place, s, turner)

    def _start_waited(self, item: PlanItem, s: Situation) -> None:
        if item.command == Cmd.CONDITION_YAW:
            yaw_rad = radians(item.p1)
            if item.p4 == 1.0:
                yaw_rad = s.heading_rad + (yaw_rad if item.p3 >= 0.0 else -yaw_rad)
            rate_rad_s = radians(item.p2) if isfinite(item.p2) else 0.0
            self._crew.turn_nose(yaw_rad, rate_rad_s, int(item.p3) if isfinite(item.p3) else 0)
        else:
            self._wait(item.p1, s)

    def _wait(self, seconds: float, s: Situation) -> None:
        self._until_ns = s.time_ns + (int(seconds * 1e9) if isfinite(seconds) else 0)

    def _jump(self, item: PlanItem) -> None:
        done = self._repeats.get(item.seq, 0)
        if item.p2 < 0 or done < item.p2:
            self._repeats[item.seq] = done + 1
            self.current = int(item.p1)
            self._forget_item()
        else:
            self._advance()

    def _over(self, item: PlanItem, s: Situation) -> bool:
        """Whether the current item has come to its end."""
        if KINDS[item.command] is Kind.WAITED:
            if item.command == Cmd.CONDITION_YAW:
                return not self._crew.nose_turns()
            return self._until_ns is not None and s.time_ns >= self._until_ns
        goal = self._goal or s.pos_ned
        match item.command:
            case Cmd.TAKEOFF | Cmd.LOITER_TURNS:
                return self._sub is not None and self._sub.done
            case Cmd.WAYPOINT | Cmd.LOITER_TIME:
                if self._until_ns is None:
                    if distance(s.pos_ned, goal) >= self._accept_m(item):
                        return False
                    self._wait(item.p1, s)
                return self._until_ns is not None and s.time_ns >= self._until_ns
            case Cmd.LAND:
                if self._sub is None and distance(s.pos_ned, goal) < _OVER_M:
                    self._sub = Land(self._parameters, goal)
                return False
            case _:
                return False

    def _accept_m(self, item: PlanItem) -> float:
        px4_waypoint = self._parameters.personality == "px4" and item.command == Cmd.WAYPOINT
        if px4_waypoint and isfinite(item.p2) and item.p2 > 0.0:
            return item.p2
        return self._parameters.si(Quantity.ACCEPT_M)

    # ----------------------------------------------------------------------- the flying

    def _fly(self, s: Situation, turner: Turner) -> Demand:
        if self._sub is not None:
            return self._sub.update(s, turner)
        return FlyTo(self._goal or s.stop_ned, s.limits)


def _radius(item: PlanItem) -> float:
    """Metres; of LOITER_TURNS' param 3, whose sign is the direction."""
    radius = abs(item.p3) if isfinite(item.p3) else 0.0
    return radius if radius >= 1.0 else 10.0
