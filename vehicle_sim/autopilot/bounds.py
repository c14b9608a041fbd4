"""Where the vehicle may fly, and where it returns to: its fence and its rally points."""

from __future__ import annotations

from math import ceil

from vehicle_sim.autopilot.control.demands import Situation
from vehicle_sim.autopilot.fence import rally
from vehicle_sim.autopilot.fence import zones as fences
from vehicle_sim.autopilot.fence.geofence import BreachKind, Crossing, Geofence
from vehicle_sim.autopilot.flight_state import FlightState
from vehicle_sim.autopilot.interface import FenceState, PlanItem, Refusal, Result
from vehicle_sim.autopilot.modes import Behaviour
from vehicle_sim.numerics.vectors import Vec3

_ONLY_WATCHED = (0.0, 1.0)  # GF_ACTION: none, warning


class Bounds:
    """The stored fence and rally points outlive a reboot, as a mission does."""

    def __init__(self, state: FlightState) -> None:
        self._state = state
        self.geofence = Geofence(state.parameters)
        self._rally: tuple[rally.Point, ...] = ()

    def check_fence(self, items: tuple[PlanItem, ...]) -> Refusal | None:
        return fences.check(items, self._state.personality)

    def load_fence(self, items: tuple[PlanItem, ...]) -> None:
        state = self._state
        self.geofence.load(fences.build(items, state.projection))
        if state.rules.tells_uploads and items:
            state.say(7, "Fence Indexed OK")

    def enable_fence(self, choice: int) -> Result:
        """ArduCopter's DO_FENCE_ENABLE, command or mission item; PX4 does not know it."""
        if self._state.rules.fence_always_on:
            return Result.UNSUPPORTED
        if choice not in (0, 1, 2):
            return Result.FAILED
        self.geofence.bar_floor(choice == 2)
        if choice != 2:
            self._state.parameters.set("FENCE_ENABLE", choice)
        return Result.ACCEPTED

    def check_rally(self, items: tuple[PlanItem, ...]) -> Refusal | None:
        return rally.check(items)

    def load_rally(self, items: tuple[PlanItem, ...]) -> None:
        self._rally = rally.build(items, self._state.projection)

    @property
    def fence_state(self) -> FenceState:
        return self.geofence.state

    def crossing(self, s: Situation) -> Crossing:
        landing = not s.flying or self._state.mode.behaviour is Behaviour.LAND
        return self.geofence.check(s.pos_ned, s.stop_ned, s.home_ned, landing, s.time_ns)

    def fenced_off(self, goal_ned: Vec3) -> bool:
        """Whether a goal lies where the fence would stop the vehicle, and says so."""
        state = self._state
        if self.geofence.allows(goal_ned, state.home_ned or (0.0, 0.0, 0.0)):
            return False
        if state.rules.tells_goal_beyond_fence:
            if state.parameters.get("GF_ACTION") in _ONLY_WATCHED:
                return False
            beyond = self.geofence.beyond(goal_ned, state.home_ned or (0.0, 0.0, 0.0))
            if BreachKind.ALT_MAX in beyond:
                top_m = state.parameters.get("GF_MAX_VER_DIST")
                state.say(2, f"Maximum altitude above home reached ({top_m:.5f})")
            state.say(2, "Reposition is outside geofence")
        return True

    def landing_site(self, pos_ned: Vec3) -> rally.LandingSite:
        """Where a return from here would end."""
        state = self._state
        home_ned = state.home_ned or (0.0, 0.0, 0.0)
        return rally.landing_site(
            self._rally,
            pos_ned,
            home_ned,
            state.ground.alt_amsl_m,
            state.parameters,
            lambda north_m, east_m: self.geofence.allows_ground(north_m, east_m, home_ned),
        )

    def tell_return(self, leg: str, down_m: float, ground_d: float) -> None:
        """PX4's words for the legs of a return, in metres rounded up; disarmed only the first."""
        state = self._state
        if leg == "climb to":
            state.say(6, "RTL HOME activated")
            if not state.armed:
                return
            state.say(6, "RTL: landing at home position.")
        if leg == "land":
            state.say(6, "RTL: land at destination")
            return
        amsl_m, over_m = ceil(state.ground.alt_amsl_m - down_m), ceil(ground_d - down_m)
        state.say(6, f"RTL: {leg} {amsl_m} m ({over_m} m above destination)")
