"""Flies the task of the mode, armed: from lifting off to what follows its end."""

from __future__ import annotations

from dataclasses import dataclass

from vehicle_sim.autopilot.control.demands import Situation, Task
from vehicle_sim.autopilot.failsafes.arming import AutoDisarm
from vehicle_sim.autopilot.flight_state import FlightState
from vehicle_sim.autopilot.health.mission_checks import MissionChecks
from vehicle_sim.autopilot.mission.mission import Mission
from vehicle_sim.autopilot.modes import Behaviour
from vehicle_sim.autopilot.parameters.parameters import Quantity
from vehicle_sim.autopilot.tasks.tasks import Hold, TakeOff, face
from vehicle_sim.autopilot.transitions import Transitions

_ALIGNED_UP_M = 2.5  # EKF3_MAG_FINAL_RESET_ALT
_STILL_M_S = 0.5  # no more than this up or down: it does not fall
_TAKES_OFF_BY_ITSELF = 2  # AUTO_OPTIONS

_POINTED = (
    Behaviour.HOLD,
    Behaviour.GUIDED,
    Behaviour.TAKEOFF,
    Behaviour.MISSION,
    Behaviour.RETURN,
)
"""In these, unless they are flown by hand, a region of interest turns the nose."""


@dataclass(slots=True, eq=False, repr=False)
class TaskFlight:
    """Writes the task's demands; lands, disarms and goes on when they have been met."""

    _state: FlightState
    _mission: Mission
    _mission_checks: MissionChecks
    _transitions: Transitions
    _auto_disarm: AutoDisarm

    def fly(self, s: Situation, regular: bool) -> None:
        state = self._state
        pilot = state.control
        task = state.task
        if not pilot.flying:
            if self._may_lift_off(task, s):
                pilot.lift_off(s.pos_ned, s.heading_rad)
                s.flying = True
                if state.rules.tells_land_detector:
                    state.say(6, "Takeoff detected")
                state.auto_armed = True
            else:
                pilot.rest()
                self._disarm_when_due(s, regular)
                return
        if regular and state.rules.aligns_yaw_in_flight:
            self._align_yaw(s)
        demand = task.update(s, pilot.heading)
        if state.task is not task:
            return
        pointed = state.mode.law is None and state.mode.behaviour in _POINTED
        if state.roi_ned is not None and pointed:
            face(state.roi_ned, s, pilot.heading)
        pilot.fly(demand, s)
        if pilot.touched_down():
            self._touch_down(s)
        elif task.done:
            self._move_on(task, s)

    def _align_yaw(self, s: Situation) -> None:
        """EKF3 aligns its yaw anew, once in each flight, when the ground no longer disturbs the
        magnetometer; it runs on two IMUs."""
        state = self._state
        if not state.yaw_aligned and s.home_ned[2] - s.pos_ned[2] > _ALIGNED_UP_M:
            state.yaw_aligned = True
            for imu in (0, 1):
                state.say(6, f"EKF3 IMU{imu} MAG0 in-flight yaw alignment complete")

    def _disarm_when_due(self, s: Situation, regular: bool) -> None:
        if regular and self._auto_disarm.due(self._state.parameters, self._lands_itself, s.time_ns):
            self._transitions.disarm(self._auto_disarm.words(self._state.parameters))

    def stay_down(self, s: Situation, regular: bool) -> None:
        """Armed with its motors cut off; a landing that is asked for is over at once."""
        state = self._state
        if not state.cut_off_in_air:
            self._disarm_when_due(s, regular)
        elif state.mode.behaviour is Behaviour.LAND and abs(s.v_ned[2]) < _STILL_M_S:
            state.cut_off_in_air = False
            self._touch_down(s)

    def _may_lift_off(self, task: Task, s: Situation) -> bool:
        state = self._state
        spool_up_ns = int(
            (state.rules.arming_delay_s + state.parameters.si(Quantity.SPOOL_UP_S)) * 1e9
        )
        if s.time_ns - state.armed_ns < spool_up_ns:
            return False
        # ArduCopter's AUTO leaves the ground only once the mission was started in so many words.
        waits = state.rules.mission_waits_for_start and not state.auto_armed
        if (
            task is self._mission
            and waits
            and not int(state.parameters.get("AUTO_OPTIONS")) & _TAKES_OFF_BY_ITSELF
        ):
            return False
        return task.lifts_off(s)

    @property
    def _lands_itself(self) -> bool:
        return self._state.mode.behaviour in (Behaviour.LAND, Behaviour.RETURN, Behaviour.MISSION)

    def _touch_down(self, s: Situation) -> None:
        state = self._state
        state.control.settle()
        state.auto_armed = False
        self._auto_disarm.on_ground(True, s.time_ns)
        if state.rules.tells_land_detector:
            state.say(6, "Landing detected")
        if state.task is self._mission:
            self._mission.touched_down()
            if state.rules.holds_after_task and self._mission.finished:
                state.say(6, "Mission finished, landed")

    def _move_on(self, task: Task, s: Situation) -> None:
        """PX4 goes to AUTO.LOITER after a take-off and after a mission; ArduCopter stays.

        After a take-off it holds the height where it is now.
        """
        state = self._state
        if not state.rules.holds_after_task:
            return
        if isinstance(task, TakeOff) or task is self._mission:
            # The climb's own end takes back nothing that was asked for meanwhile.
            wanted = state.offboard_wanted
            goes_on = isinstance(task, TakeOff) and state.parameters.get("COM_TAKEOFF_ACT") == 1
            if goes_on and self._mission_checks.passed:
                self._transitions.enter_kind("mission")
                return
            goal = task.target.pos_ned
            if isinstance(task, TakeOff) and goal is not None:
                goal = (goal[0], goal[1], s.pos_ned[2])
            if task is self._mission:
                state.say(6, "Mission finished, loitering")
            self._transitions.enter_kind("hold", Hold(goal))
            state.offboard_wanted = wanted
