"""Mode changes: what may be asked, when, and in which words it is refused."""

from __future__ import annotations

from dataclasses import dataclass

from vehicle_sim.autopilot.failsafe_actions import FailsafeActions
from vehicle_sim.autopilot.flight_state import FlightState
from vehicle_sim.autopilot.health.mission_checks import MissionChecks
from vehicle_sim.autopilot.interface import Landed, Result
from vehicle_sim.autopilot.manual.sticks import Radio
from vehicle_sim.autopilot.modes import (
    AUTO_MAIN_MODE,
    KINDS,
    MODES,
    Behaviour,
    Flag,
    Mode,
    by_number,
    main_mode,
    refusal_words,
    unknown_mode_words,
)
from vehicle_sim.autopilot.tasks.guided import SetpointStream
from vehicle_sim.autopilot.tasks.tasks import Hold, TakeOff
from vehicle_sim.autopilot.transitions import Transitions

_CLEAR_M = 0.5  # less than this above home, and a take-off has not left the ground


@dataclass(slots=True, eq=False, repr=False)
class ModeChanges:
    """Each request is answered at once."""

    _state: FlightState
    _mission_checks: MissionChecks
    _failsafe_actions: FailsafeActions
    _transitions: Transitions
    _radio: Radio
    _stream: SetpointStream

    def set_mode(self, base_mode: int, custom_mode: int) -> Result:
        state = self._state
        if not base_mode & Flag.CUSTOM_MODE_ENABLED:
            return Result.UNSUPPORTED
        mode = by_number(state.personality, custom_mode)
        takes_unknown = state.rules.takes_unknown_main_modes
        if mode is None and takes_unknown and main_mode(custom_mode) != AUTO_MAIN_MODE:
            return Result.ACCEPTED  # as recorded: of main modes it looks at none that it lacks
        if mode is None:
            state.say(*unknown_mode_words(state.personality, custom_mode))
            return self._state.rules.not_now
        return self.change_mode(mode)

    def set_mode_kind(self, kind: str) -> Result:
        name = KINDS[self._state.personality].get(kind)
        if name is None:
            return Result.UNSUPPORTED
        return self.change_mode(MODES[self._state.personality][name])

    def change_mode(self, mode: Mode) -> Result:
        # Asked to hold while it holds it stops anew: it may be on its way to a reposition goal.
        state = self._state
        same = mode is state.mode and state.paused is None
        if same and (mode.behaviour is not Behaviour.HOLD or self._leaves_the_ground):
            return Result.ACCEPTED
        if self._failsafe_actions.held_by_fence(mode):
            return self._state.rules.not_now
        starting = not state.armed and not state.boot_stage.position
        if mode.needs_position and not state.position_ok and not starting:
            return self._refuse(mode, "requires position")
        if self._lacks_sticks(mode):
            return self._refuse(mode, "no manual control")
        if self._mission_checks.has_flown(mode):
            state.say(2, "No valid mission available, loitering")
            self._transitions.enter_kind("hold")
            return Result.ACCEPTED
        if mode.behaviour is Behaviour.MISSION and not self._mission_checks.may_start():
            return self._refuse(mode, "init failed")
        if mode.enabled_by is not None and not state.parameters.get(mode.enabled_by):
            state.say(4, f"Set {mode.enabled_by} = 1")
            return self._refuse(mode, "init failed")
        if mode.needs_stream and state.armed:
            return self._ask_offboard(mode)
        self._transitions.enter(mode, self._goes_on_up(mode))
        self._mission_checks.say_take_off()
        return Result.ACCEPTED

    def _lacks_sticks(self, mode: Mode) -> bool:
        """Armed, PX4 enters no mode that is flown by hand while there are no sticks."""
        state = self._state
        needed = state.rules.manual_modes_need_sticks and state.armed and mode.law is not None
        return needed and self._radio.sticks(state.sense().wall_ns) is None

    def _goes_on_up(self, mode: Mode) -> Hold | None:
        """PX4's HOLD, asked for before the take-off has left the ground: up to its height.

        Armed, that is recorded (A5_takeoff_hold_only); disarmed it stays where it stands (from
        memory of Loiter::set_loiter_position).
        """
        state = self._state
        task = state.task
        if state.rules.hold_ends_take_off or not isinstance(task, TakeOff) or not state.armed:
            return None
        home_d = state.home_ned[2] if state.home_ned is not None else 0.0
        if state.control.flying and home_d - state.est.pos_d > _CLEAR_M:
            return None
        if mode.behaviour is not Behaviour.HOLD:
            return None
        return Hold(task.target.pos_ned, lifts=True, landed_word=Landed.TAKEOFF)

    @property
    def _leaves_the_ground(self) -> bool:
        """It stands, and its HOLD has a place to fly to."""
        task = self._state.task
        return isinstance(task, Hold) and task.lifts and not self._state.control.flying

    def _refuse(self, mode: Mode, why: str) -> Result:
        self._state.say(*refusal_words(self._state.personality, mode.name, why))
        return self._state.rules.not_now

    def _ask_offboard(self, mode: Mode) -> Result:
        """A stream of more than 2 Hz is a must; the mode follows when it has lasted a second."""
        wall_ns = self._state.sense().wall_ns
        if not self._stream.alive(wall_ns):
            return self._refuse(mode, "no setpoint stream")
        if self._stream.proven(wall_ns):
            self._transitions.enter(mode)
        else:
            self._state.offboard_wanted = True
        return Result.ACCEPTED

    def try_offboard(self) -> None:
        """OFFBOARD was asked for: enter once the stream has proven itself."""
        state = self._state
        wall_ns = state.sense().wall_ns
        if self._stream.proven(wall_ns):
            self._transitions.enter_kind("guided")
        elif not self._stream.alive(wall_ns):
            state.offboard_wanted = False
            state.say(2, "Switching to OFFBOARD is currently not available")
