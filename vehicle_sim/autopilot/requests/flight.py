"""What the vehicle can be asked to fly.

Requests answer at once; what they lead to is seen in the state.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import isfinite

from vehicle_sim.autopilot.bounds import Bounds
from vehicle_sim.autopilot.failsafe_actions import FailsafeActions
from vehicle_sim.autopilot.flight_state import FlightState
from vehicle_sim.autopilot.interface import (
    AttitudeSetpoint,
    Geodetic,
    Result,
    Setpoint,
    SpeedType,
)
from vehicle_sim.autopilot.mode_tasks import ModeTasks
from vehicle_sim.autopilot.modes import KINDS, MODES, Behaviour
from vehicle_sim.autopilot.parameters.parameters import Quantity
from vehicle_sim.autopilot.requests.mode_changes import ModeChanges
from vehicle_sim.autopilot.tasks.guided import AnySetpoint, Guided, SetpointStream, is_sound
from vehicle_sim.autopilot.tasks.tasks import Hold
from vehicle_sim.autopilot.transitions import Transitions
from vehicle_sim.numerics.vectors import Vec3

_LOWEST_GOAL_UP_M = 0.5


@dataclass(slots=True, eq=False, repr=False)
class FlightRequests:
    """Take-off, goals, speeds, setpoints, home."""

    _state: FlightState
    _bounds: Bounds
    _failsafe_actions: FailsafeActions
    _mode_tasks: ModeTasks
    _mode_changes: ModeChanges
    _transitions: Transitions
    _stream: SetpointStream

    def take_off(self, up_above_home_m: float | None) -> Result:
        state = self._state
        up_m = up_above_home_m
        if up_m is None:
            up_m = state.parameters.si(Quantity.TAKEOFF_UP_M)
        if not isfinite(up_m) or up_m < _LOWEST_GOAL_UP_M:
            return Result.DENIED
        if state.armed and state.control.flying:
            return state.rules.take_off_in_flight
        if not state.position_ok:
            return self._state.rules.not_now
        if state.rules.take_off_mode is not None:
            mode = MODES[state.personality][state.rules.take_off_mode]
            self._transitions.enter(mode, self._mode_tasks.take_off(up_m))
            return Result.ACCEPTED
        if not state.armed or not isinstance(state.task, Guided):
            return Result.FAILED
        home_d = state.home_ned[2] if state.home_ned is not None else 0.0
        state.task.take_off(home_d - up_m, state.look_around(), state.control.heading)
        state.request_decision()
        return Result.ACCEPTED

    def land(self) -> Result:
        return self._mode_changes.set_mode_kind("land")

    def return_home(self) -> Result:
        return self._mode_changes.set_mode_kind("return")

    def reposition(
        self,
        pos_ned: Vec3 | None,
        yaw_rad: float | None,
        speed_m_s: float | None,
        changes_mode: bool = True,
    ) -> Result:
        """PX4 takes it on the ground, too, and flies there once it is armed."""
        state = self._state
        if pos_ned is not None and not all(map(isfinite, pos_ned)):
            return Result.DENIED
        if not state.position_ok:
            return self._state.rules.not_now
        by_hold = state.rules.repositions_by_hold
        if not by_hold and state.mode.behaviour is not Behaviour.GUIDED and not changes_mode:
            return Result.DENIED
        if pos_ned is not None and self._bounds.fenced_off(pos_ned):
            return state.rules.goal_beyond_fence
        goal = pos_ned if pos_ned is not None else state.look_around().stop_ned
        wanted = speed_m_s if speed_m_s is not None and speed_m_s > 0.0 else None
        if by_hold:
            return self._hold_at(goal, yaw_rad, wanted)
        return self._guide_to(goal, yaw_rad, wanted)

    def _hold_at(self, goal_ned: Vec3, yaw_rad: float | None, speed_m_s: float | None) -> Result:
        """The speed is that of this way alone: DO_CHANGE_SPEED's holds again after it."""
        state = self._state
        if speed_m_s is not None:
            speed_m_s = min(speed_m_s, state.parameters.si(Quantity.FASTEST_M_S))
        task = Hold(goal_ned, yaw_rad, speed_m_s, lifts=not state.control.flying)
        self._transitions.enter_kind("hold", task)
        return Result.ACCEPTED

    def _guide_to(self, goal_ned: Vec3, yaw_rad: float | None, speed_m_s: float | None) -> Result:
        state = self._state
        guided = state.mode.behaviour is Behaviour.GUIDED
        if speed_m_s is not None:
            state.change_speed(speed_m_s)
        mode = MODES[state.personality][KINDS[state.personality]["guided"]]
        if not guided and self._failsafe_actions.held_by_fence(mode):
            return Result.FAILED
        if not guided or not state.control.flying or not isinstance(state.task, Guided):
            # On the ground it drops a take-off that was asked for, and stays there.
            self._transitions.enter(mode)
        if not state.control.flying:
            return Result.ACCEPTED
        goal = Setpoint(pos_ned=goal_ned, yaw_rad=yaw_rad)
        self._stream.heard(goal, state.sense().wall_ns, state.time_ns)
        state.request_decision()
        return Result.ACCEPTED

    def pause(self) -> Result:
        """ArduCopter stops within AUTO or GUIDED; PX4 1.14 does not know the command."""
        state = self._state
        if not state.rules.pauses:
            return Result.UNSUPPORTED
        if state.paused is not None:
            return Result.ACCEPTED
        task = state.task
        stoppable = state.mode.behaviour in (Behaviour.MISSION, Behaviour.GUIDED)
        if not state.control.flying or not stoppable:
            state.say(4, "Failed to pause")
            return Result.FAILED
        self._transitions.enter(state.mode, Hold())
        state.paused = task
        return Result.ACCEPTED

    def resume(self) -> Result:
        state = self._state
        task = state.paused
        if not state.rules.pauses:
            return Result.UNSUPPORTED
        if task is None:
            state.say(4, "Failed to resume")
            return Result.FAILED
        self._transitions.enter(state.mode, task)
        return Result.ACCEPTED

    def change_speed(self, kind: SpeedType, speed_m_s: float | None) -> Result:
        """Metres per second; ArduCopter changes it in flight only."""
        if speed_m_s is not None and (not isfinite(speed_m_s) or speed_m_s <= 0.0):
            return Result.DENIED
        if not self._state.rules.changes_speed_on_ground and not self._state.control.flying:
            return Result.FAILED
        self._state.change_speed(speed_m_s, kind)
        return Result.ACCEPTED

    def change_altitude(self, up_above_home_m: float) -> Result:
        state = self._state
        if state.home_ned is None or not isfinite(up_above_home_m):
            return Result.DENIED
        if not state.control.flying:
            return Result.ACCEPTED  # PX4's, as recorded; it does not take off for it here
        s = state.look_around()
        goal = state.task.target.pos_ned or s.stop_ned
        return self.reposition((goal[0], goal[1], s.home_ned[2] - up_above_home_m), None, None)

    def condition_yaw(
        self, yaw_rad: float, relative: bool, rate_rad_s: float, direction: int
    ) -> Result:
        state = self._state
        if not isfinite(yaw_rad):
            return Result.DENIED
        if not state.control.flying:
            return Result.ACCEPTED  # and nothing turns
        state.roi_ned = None
        heading = state.control.heading
        if relative:
            yaw_rad = heading.yaw_rad + (-yaw_rad if direction < 0 else yaw_rad)
        heading.turn(yaw_rad, rate_rad_s, direction)
        return Result.ACCEPTED

    def set_home(self, where: Geodetic | None) -> Result:
        state = self._state
        if state.origin is None:
            return self._state.rules.not_now
        if where is not None and not _on_earth(where):
            return Result.DENIED
        state.move_home(None if where is None else state.projection.to_local(where))
        return Result.ACCEPTED

    def set_setpoint(self, setpoint: Setpoint) -> None:
        if setpoint.yaw_rad is not None or setpoint.yaw_rate_rad_s is not None:
            self._state.roi_ned = None
        goal = setpoint.pos_ned
        bound = self._state.rules.setpoints_within_fence
        if bound and goal is not None and self._bounds.fenced_off(goal):
            return
        self._hear(setpoint)

    def set_attitude(self, setpoint: AttitudeSetpoint) -> None:
        self._hear(setpoint)

    def _hear(self, setpoint: AnySetpoint) -> None:
        """What is not sound is as good as not sent; a take-off in GUIDED is not disturbed."""
        state = self._state
        taking_off = isinstance(state.task, Guided) and state.task.taking_off
        if is_sound(setpoint) and not taking_off:
            self._stream.heard(setpoint, state.sense().wall_ns, state.time_ns)
            state.request_decision()

    def look_at(self, where_ned: Vec3 | None) -> Result:
        if where_ned is not None and not all(map(isfinite, where_ned)):
            return Result.DENIED
        self._state.roi_ned = where_ned
        self._state.request_decision()
        return Result.ACCEPTED


def _on_earth(where: Geodetic) -> bool:
    return abs(where.lat_deg) <= 90.0 and abs(where.lon_deg) <= 180.0 and isfinite(where.alt_amsl_m)
