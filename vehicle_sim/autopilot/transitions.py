"""Entering a mode, disarming and cutting off the motors, and what each of these ends."""

from __future__ import annotations

from dataclasses import dataclass

from vehicle_sim.autopilot.acting_failsafe import ActingFailsafe
from vehicle_sim.autopilot.control.demands import Task
from vehicle_sim.autopilot.failsafes.failsafe import Cause
from vehicle_sim.autopilot.failsafes.failsafe_checks import FailsafeChecks
from vehicle_sim.autopilot.failsafes.failure_detector import FailureDetector
from vehicle_sim.autopilot.fence.geofence import Geofence
from vehicle_sim.autopilot.flight_state import FlightState
from vehicle_sim.autopilot.mode_tasks import ModeTasks
from vehicle_sim.autopilot.modes import KINDS, MODES, Behaviour, Mode


@dataclass(slots=True, eq=False, repr=False)
class Transitions:
    """Carries out what was decided elsewhere; refuses nothing."""

    _state: FlightState
    _mode_tasks: ModeTasks
    _acting: ActingFailsafe
    _geofence: Geofence
    _failsafe_checks: FailsafeChecks
    _failure_detector: FailureDetector

    def restart(self) -> None:
        """The task of the mode after power-up."""
        self._state.task = self._mode_tasks.task_of(self._state.mode)

    def enter(self, mode: Mode, task: Task | None = None) -> None:
        """Change the mode; `task` instead of the one that the mode has of its own.

        Unless a failsafe changes it, it ends what was being done about one.
        """
        state, acting = self._state, self._acting
        state.mode = mode
        state.failsafe_active = False
        state.offboard_wanted = False
        state.paused = None
        if state.rules.mode_ends_roi:
            state.roi_ned = None
        state.task = task if task is not None else self._mode_tasks.task_of(mode)
        state.task.begin(state.look_around(), state.control.heading)
        state.request_decision()
        if state.rules.tells_manual_recovery and self._geofence.breached:
            state.say(6, "Manual recovery started")
        if acting.on_its_own:
            return
        if mode.may_arm:
            # PX4 goes back to it with the disarming (UserModeIntention).
            state.mode_after_disarming = mode
        if acting.failsafe is not None and acting.failsafe.cause is Cause.FENCE:
            self._geofence.taken_over(state.time_ns)
        acting.stand_down(state.time_ns)

    def enter_kind(self, kind: str, task: Task | None = None) -> None:
        """By the mode's meaning: a key of `KINDS`."""
        personality = self._state.personality
        self.enter(MODES[personality][KINDS[personality][kind]], task)

    def disarm(self, text: str) -> None:
        """Motors off, saying `text`; failsafes strike anew from the next arming on."""
        state = self._state
        state.armed = False
        state.control.stop()
        state.limits.reset()
        state.failsafe_active = False
        state.auto_armed = False
        state.cut_off_in_air = False
        state.yaw_aligned = False
        state.say(6, text)
        if state.rules.mode_back_after_disarming:
            before = state.mode_after_disarming
            if before is not state.mode or before.behaviour is Behaviour.HOLD:
                # HOLD begins anew: what it was to fly to ends with the flight.
                self.enter(before)
        self._acting.stand_down(state.time_ns)
        self._failsafe_checks.reset()
        self._failure_detector.reset()

    def terminate(self) -> None:
        """Motors off.  ArduCopter's is no more than a disarming: nothing of it stays.

        PX4 stays armed and in its mode.  As the mode's demands go on, its land detector does not
        notice the fall: it says IN_AIR until it is told to land.
        """
        state = self._state
        if not state.rules.termination_lasts:
            if state.armed:
                self.disarm(state.rules.disarmed_text)
            else:
                state.say(6, state.rules.disarmed_text)
            return
        state.terminated = True
        state.cut_off_in_air = state.cut_off_in_air or state.control.flying
        state.control.stop()
        state.say(2, "Preflight Fail: Flight termination active")
