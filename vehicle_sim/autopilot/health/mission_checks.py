"""Whether the stored mission may be flown, and what PX4 says of it."""

from __future__ import annotations

from math import hypot

from vehicle_sim.autopilot.fence.geofence import Geofence
from vehicle_sim.autopilot.flight_state import FlightState
from vehicle_sim.autopilot.mission.mission import Mission
from vehicle_sim.autopilot.mission.plan import (
    KINDS,
    ItemKind,
    by_terrain,
    has_place,
    infeasible,
    place_of,
)
from vehicle_sim.autopilot.modes import Behaviour, Mode

_PLACELESS = frozenset({0, 0x7FFFFFFF})


class MissionChecks:
    """The mission within its bounds."""

    def __init__(self, state: FlightState, geofence: Geofence, mission: Mission) -> None:
        self._state = state
        self._geofence = geofence
        self._mission = mission
        self._beyond_fence = False

    @property
    def passed(self) -> bool:
        """There is one, and it may be flown."""
        if self._mission.empty or self._beyond_fence:
            return False
        if not self._state.rules.checks_mission_feasible:
            return True
        return self._too_far_m() is None and not infeasible(self._mission.items)

    @property
    def needs_terrain(self) -> bool:
        """An item's height counts from the terrain; there are no terrain data on board."""
        return any(by_terrain(item) for item in self._mission.items)

    def judge(self) -> None:
        """PX4's feasibility check: a mission out of bounds stays stored, and is not flown.

        It is made with the fence that is there when the mission comes, and not again.
        """
        state = self._state
        seq = self._out_of_bounds()
        self._beyond_fence = seq is not None
        if seq is not None:
            state.say(2, f"Geofence violation for waypoint {seq + 1}")
        too_far_m = self._too_far_m()
        if too_far_m is not None:
            most_m = state.parameters.get("MIS_DIST_1WP")
            state.say(2, f"First waypoint too far away: {too_far_m:.0f}m, {most_m:.0f} max")

    def _too_far_m(self) -> float | None:
        """From home to the first place of PX4's mission, if that is farther than it may be."""
        state = self._state
        feasibility = state.rules.checks_mission_feasible
        if not feasibility or state.parameters.get("MIS_DIST_1WP") <= 0.0:
            return None
        home_ned = state.home_ned or (0.0, 0.0, 0.0)
        for item in self._mission.items:
            if KINDS[item.command] is ItemKind.FLOWN and has_place(item):
                where = place_of(item, state.datum(), home_ned)
                away_m = hypot(where[0] - home_ned[0], where[1] - home_ned[1])
                return away_m if away_m > state.parameters.get("MIS_DIST_1WP") else None
        return None

    def _out_of_bounds(self) -> int | None:
        """The first item of PX4's mission that lies outside the fence."""
        state = self._state
        if not state.rules.checks_mission_feasible or self._geofence.idle:
            return None
        home_ned = state.home_ned or (0.0, 0.0, 0.0)
        for item in self._mission.items[state.rules.first_mission_item :]:
            if KINDS[item.command] is not ItemKind.FLOWN or item.x in _PLACELESS:
                continue
            if not self._geofence.allows(place_of(item, state.datum(), home_ned), home_ned):
                return item.seq
        return None

    def may_start(self) -> bool:
        """A disarmed vehicle takes the mission mode with any mission, and with none."""
        state = self._state
        if not state.armed:
            return True
        if not self.passed:
            return False
        needs_take_off = state.rules.mission_needs_take_off and not state.control.flying
        if not needs_take_off or self._mission.takes_off:
            return True
        state.say(2, "Auto: Missing Takeoff Cmd")
        return False

    def has_flown(self, mode: Mode) -> bool:
        """In the air PX4 does not begin a mission that is over from the start."""
        flown = self._mission.finished and self._state.control.flying
        becomes_hold = self._state.rules.flown_mission_becomes_hold
        return becomes_hold and mode.behaviour is Behaviour.MISSION and flown

    def say_take_off(self) -> None:
        """What PX4 says when its mission is going to leave the ground."""
        state = self._state
        mission = self._mission
        grounded = state.armed and not state.control.flying
        tells = state.rules.tells_mission_take_off
        if not tells or state.task is not mission or not grounded:
            return
        beyond = mission.jump_beyond
        if beyond is not None:
            count = len(mission.items)
            state.say(2, f"Mission item index out of bound, index: {beyond}, max: {count}.")
        up_m = mission.take_off_up_m(state.home_ned or (0.0, 0.0, 0.0))
        state.say(6, f"Takeoff to {up_m:.1f} meters above home")
