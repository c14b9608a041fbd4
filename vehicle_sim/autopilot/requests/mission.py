"""What can be asked about the mission."""

from __future__ import annotations

from dataclasses import dataclass

from vehicle_sim.autopilot.flight_state import FlightState
from vehicle_sim.autopilot.health.mission_checks import MissionChecks
from vehicle_sim.autopilot.interface import PlanItem, Result
from vehicle_sim.autopilot.mission import plan as plans
from vehicle_sim.autopilot.mission.mission import Mission
from vehicle_sim.autopilot.requests.arming import ArmingRequests
from vehicle_sim.autopilot.requests.mode_changes import ModeChanges
from vehicle_sim.autopilot.transitions import Transitions


@dataclass(slots=True, eq=False, repr=False)
class MissionRequests:
    """Swap it, start it, go to an item of it."""

    _state: FlightState
    _mission: Mission
    _mission_checks: MissionChecks
    _arming: ArmingRequests
    _mode_changes: ModeChanges
    _transitions: Transitions

    def check_plan(self, items: tuple[PlanItem, ...]) -> tuple[int, str] | None:
        return plans.check(items, self._state.personality)

    def load_plan(self, items: tuple[PlanItem, ...]) -> None:
        state = self._state
        self._mission.load(items)
        if state.rules.tells_uploads and items:
            state.say(6, "Flight plan received")
        self._mission_checks.judge()
        if state.task is self._mission:
            if not self._mission.empty:
                self._mission.begin(state.look_around(), state.control.heading)
            elif state.rules.no_mission_ends_mode or state.armed:
                self._transitions.enter_kind("hold")

    def mission_start(self, first: int, last: int) -> Result:
        state = self._state
        mission = self._mission
        if state.rules.mission_start_arms and not self._mission_checks.passed:
            state.say(2, "Mission start denied! No valid mission")
            return Result.DENIED
        if first > 0 and not mission.jump_to(first):
            return Result.DENIED
        mission.limit(last)
        begun = state.task is mission
        result = self._mode_changes.set_mode_kind("mission")
        if result is Result.ACCEPTED:
            if not begun:
                mission.announce_begin()  # by the command, after the mode has done so
            state.auto_armed = True
            if state.rules.mission_start_arms:
                result = self._arming.arm(False)
        return result

    def mission_set_current(self, seq: int) -> Result:
        if not self._mission.jump_to(seq):
            return Result.DENIED
        self._state.request_decision()
        return Result.ACCEPTED
