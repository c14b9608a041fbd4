"""Arming and disarming: what may be asked, when, and in which words it is refused."""

from __future__ import annotations

from vehicle_sim.autopilot.failsafes.arm_authorization import (
    ARM_AUTHORIZATION_REQUEST,
    ArmAuthorization,
    Permission,
)
from vehicle_sim.autopilot.failsafes.arming import AutoDisarm
from vehicle_sim.autopilot.flight_state import FlightState
from vehicle_sim.autopilot.health.health_checks import HealthChecks
from vehicle_sim.autopilot.health.mission_checks import MissionChecks
from vehicle_sim.autopilot.interface import CommandDone, Result
from vehicle_sim.autopilot.transitions import Transitions

_ARM_DISARM, _MISSION_START = 400, 300  # MAV_CMD that arm


class ArmingRequests:
    """Answered at once, but for an arming that waits to be authorized."""

    def __init__(
        self,
        state: FlightState,
        health_checks: HealthChecks,
        mission_checks: MissionChecks,
        transitions: Transitions,
        auto_disarm: AutoDisarm,
    ) -> None:
        self._state = state
        self._health_checks = health_checks
        self._mission_checks = mission_checks
        self._transitions = transitions
        self._auto_disarm = auto_disarm
        self._authorization = ArmAuthorization(state.parameters)

    def restart(self) -> None:
        """As after power-up."""
        self._authorization.restart()

    def arm(self, force: bool) -> Result:
        state = self._state
        if state.armed:
            return Result.ACCEPTED
        if state.terminated:
            state.say(2, "Preflight Fail: Flight termination active")
            return Result.TEMPORARILY_REJECTED
        if state.calibration.busy and state.rules.calibration_denies_arming:
            state.say(2, "Transition denied: Init to Armed")
            return Result.TEMPORARILY_REJECTED
        checks = self._health_checks
        if checks.held_by_boot(force) or (not force and checks.say_against_arming(True)):
            return self._state.rules.not_now
        if state.rules.arm_authorization and not force:
            permission = self._authorization.ask(state.sense().wall_ns)
            self._tell()
            if permission is not Permission.GRANTED:
                waits = permission is Permission.WAIT
                return Result.IN_PROGRESS if waits else self._state.rules.not_now
        self._start_motors()
        return Result.ACCEPTED

    def disarm(self, force: bool) -> Result:
        state = self._state
        if not state.armed:
            return Result.ACCEPTED
        if (state.control.flying or state.cut_off_in_air) and not force:
            if state.rules.disarming_denied_text is not None:
                state.say(2, state.rules.disarming_denied_text)
            return self._state.rules.not_now
        self._transitions.disarm(state.rules.disarmed_text)
        return Result.ACCEPTED

    def terminate(self, on: bool) -> Result:
        """Motors off; or that state ended, where it lasts."""
        state = self._state
        if on:
            self._transitions.terminate()
        elif not state.rules.termination_lasts:
            return Result.FAILED
        state.terminated = on and state.rules.termination_lasts
        return Result.ACCEPTED

    def _start_motors(self) -> None:
        state = self._state
        state.armed = True
        state.armed_ns = state.time_ns
        self._auto_disarm.on_ground(False, state.time_ns)
        if state.origin is not None:
            state.move_home(None)
        state.task.begin(state.look_around(), state.control.heading)
        state.control.rest()
        state.request_decision()
        state.say(6, state.rules.armed_text)
        self._mission_checks.say_take_off()

    # --------------------------------------------------------------- arm authorization

    def command_acked(self, command: int, result: int, param1: int, param2: int) -> None:
        if self._state.rules.arm_authorization and command == ARM_AUTHORIZATION_REQUEST:
            wall_ns = self._state.sense().wall_ns
            permission = self._authorization.answered(result, param1, param2, wall_ns)
            self._settle(permission)

    def settle_overdue(self) -> None:
        """An authorization that was not answered in time is a refusal."""
        authorization = self._authorization
        if authorization.waiting and authorization.timed_out(self._state.sense().wall_ns):
            self._settle(Permission.REFUSED)

    def _settle(self, permission: Permission) -> None:
        """The `arm` that waited is carried out, or refused."""
        state = self._state
        self._tell()
        if permission is Permission.WAIT or int(state.parameters.get("COM_ARM_AUTH_MET")) != 0:
            return
        granted = permission is Permission.GRANTED and not state.terminated
        if granted and not state.armed:
            self._start_motors()
        result = Result.ACCEPTED if granted else self._state.rules.not_now
        for command in (_ARM_DISARM, _MISSION_START):
            state.emit(CommandDone(command, result))
        state.request_decision()

    def _tell(self) -> None:
        events, self._authorization.events = self._authorization.events, []
        for event in events:
            self._state.emit(event)
