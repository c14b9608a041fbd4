"""Where the vehicle may fly, and where it returns to: its fence and its rally points."""

from __future__ import annotations

from math import ceil, hypot

from vehicle_sim.autopilot.control.demands import Situation, Task
from vehicle_sim.autopilot.core import Core
from vehicle_sim.autopilot.fence import rally
from vehicle_sim.autopilot.fence import zones as fences
from vehicle_sim.autopilot.fence.geofence import BreachKind, Crossing
from vehicle_sim.autopilot.interface import FenceState, PlanItem, Refusal
from vehicle_sim.autopilot.mission.plan import (
    KINDS,
    ItemKind,
    first_of,
    has_place,
    infeasible,
    place_of,
)
from vehicle_sim.autopilot.modes import Behaviour, Mode
from vehicle_sim.autopilot.tasks.tasks import Return
from vehicle_sim.numerics.vectors import Vec3

_ONLY_WATCHED = (0.0, 1.0)  # GF_ACTION: none, warning
_PLACELESS = frozenset({0, 0x7FFFFFFF})


class Bounds(Core):
    """The stored fence and rally points outlive a reboot, as a mission does."""

    _mission_beyond_fence = False

    def check_fence(self, items: tuple[PlanItem, ...]) -> Refusal | None:
        return fences.check(items, self.personality)

    def load_fence(self, items: tuple[PlanItem, ...]) -> None:
        self._geofence.load(fences.build(items, self._projection))
        if self.personality == "ardupilot" and items:
            self._say(7, "Fence Indexed OK")

    def check_rally(self, items: tuple[PlanItem, ...]) -> Refusal | None:
        return rally.check(items)

    def load_rally(self, items: tuple[PlanItem, ...]) -> None:
        self._rally = rally.build(items, self._projection)

    @property
    def fence_state(self) -> FenceState:
        return self._geofence.state

    def _look_at_fence(self, s: Situation) -> Crossing:
        landing = not s.flying or self._mode.behaviour is Behaviour.LAND
        return self._geofence.check(s.pos_ned, s.stop_ned, s.home_ned, landing, s.time_ns)

    def _fenced_off(self, goal_ned: Vec3) -> bool:
        """Whether a goal lies where the fence would stop the vehicle, and says so."""
        if self._geofence.allows(goal_ned, self._home_ned or (0.0, 0.0, 0.0)):
            return False
        if self.personality == "px4":
            if self.parameters.get("GF_ACTION") in _ONLY_WATCHED:
                return False
            beyond = self._geofence.beyond(goal_ned, self._home_ned or (0.0, 0.0, 0.0))
            if BreachKind.ALT_MAX in beyond:
                top_m = self.parameters.get("GF_MAX_VER_DIST")
                self._say(2, f"Maximum altitude above home reached ({top_m:.5f})")
            self._say(2, "Reposition is outside geofence")
        return True

    def _landing_site(self, pos_ned: Vec3) -> rally.LandingSite:
        """Where a return from here would end."""
        home_ned = self._home_ned or (0.0, 0.0, 0.0)
        return rally.landing_site(
            self._rally,
            pos_ned,
            home_ned,
            self._field.alt_amsl_m,
            self.parameters,
            lambda north_m, east_m: self._geofence.allows_ground(north_m, east_m, home_ned),
        )

    def _task_of(self, mode: Mode) -> Task:
        if mode.behaviour is Behaviour.RETURN:
            tell = self._tell_return if self.personality == "px4" else None
            return Return(self.parameters, self._landing_site, tell)
        return super()._task_of(mode)

    def _tell_return(self, leg: str, down_m: float, ground_d: float) -> None:
        """PX4's words for the legs of a return, in metres rounded up."""
        if leg == "climb to":
            self._say(6, "RTL HOME activated")
            self._say(6, "RTL: landing at home position.")
        if leg == "land":
            self._say(6, "RTL: land at destination")
            return
        amsl_m, over_m = ceil(self._field.alt_amsl_m - down_m), ceil(ground_d - down_m)
        self._say(6, f"RTL: {leg} {amsl_m} m ({over_m} m above destination)")

    # ------------------------------------------------------------------- the mission in it

    @property
    def _mission_ok(self) -> bool:
        """There is one, and it may be flown."""
        if self._mission.empty or self._mission_beyond_fence:
            return False
        px4 = self.personality == "px4"
        return self._too_far_m() is None and not (px4 and infeasible(self._mission.items))

    def _judge_mission(self) -> None:
        """PX4's feasibility check: a mission out of bounds stays stored, and is not flown.

        It is made with the fence that is there when the mission comes, and not again.
        """
        seq = self._out_of_bounds()
        self._mission_beyond_fence = seq is not None
        if seq is not None:
            self._say(2, f"Geofence violation for waypoint {seq + 1}")
        too_far_m = self._too_far_m()
        if too_far_m is not None:
            most_m = self.parameters.get("MIS_DIST_1WP")
            self._say(2, f"First waypoint too far away: {too_far_m:.0f}m, {most_m:.0f} max")

    def _too_far_m(self) -> float | None:
        """From home to the first place of PX4's mission, if that is farther than it may be."""
        if self.personality != "px4" or self.parameters.get("MIS_DIST_1WP") <= 0.0:
            return None
        home_ned = self._home_ned or (0.0, 0.0, 0.0)
        for item in self._mission.items:
            if KINDS[item.command] is ItemKind.FLOWN and has_place(item):
                where = place_of(item, self.datum(), home_ned)
                away_m = hypot(where[0] - home_ned[0], where[1] - home_ned[1])
                return away_m if away_m > self.parameters.get("MIS_DIST_1WP") else None
        return None

    def _out_of_bounds(self) -> int | None:
        """The first item of PX4's mission that lies outside the fence."""
        if self.personality != "px4" or self._geofence.idle:
            return None
        home_ned = self._home_ned or (0.0, 0.0, 0.0)
        for item in self._mission.items[first_of(self.personality) :]:
            if KINDS[item.command] is not ItemKind.FLOWN or item.x in _PLACELESS:
                continue
            if not self._geofence.allows(place_of(item, self.datum(), home_ned), home_ned):
                return item.seq
        return None
