"""What the vehicle does by itself: boots, flies its mode's task, lands, disarms, fails safe.

It decides ten times a second, and at once when something was asked of it; its engine flies what
was decided, with every step.  Everything runs on simulated time, counted in steps; only what
measures the other side (setpoint and ground-station silence) runs on wall time.
"""

from __future__ import annotations

from dataclasses import dataclass

from vehicle_sim.autopilot.bounds import Bounds
from vehicle_sim.autopilot.control.airflow import Airflow
from vehicle_sim.autopilot.failsafe_actions import FailsafeActions
from vehicle_sim.autopilot.fault_injection import FaultInjection
from vehicle_sim.autopilot.flight_state import FlightState
from vehicle_sim.autopilot.health.battery_monitor import BatteryMonitor
from vehicle_sim.autopilot.health.health_checks import HealthChecks
from vehicle_sim.autopilot.interface import HomeChanged
from vehicle_sim.autopilot.requests.arming import ArmingRequests
from vehicle_sim.autopilot.requests.camera import CameraRequests
from vehicle_sim.autopilot.requests.mode_changes import ModeChanges
from vehicle_sim.autopilot.task_flight import TaskFlight
from vehicle_sim.engine.step import DT_NS, GUIDE_EVERY

_DECIDE_EVERY = 25  # 10 Hz
_STRENGTH_LEAST = 0.5  # of a full battery's voltage; for less the motors do not make up


def turn_of(index: int) -> int:
    """The step in which it decides: vehicles of a fleet take turns, just before the guidance's."""
    return GUIDE_EVERY * (index + 1) - 1


def phase_ns(index: int) -> int:
    """What shifts a vehicle's streams: it speaks when it has just decided.

    Over a fleet the second is used evenly, so that no heartbeats come all at once.
    """
    return turn_of(index) * DT_NS % 1_000_000_000


@dataclass(slots=True, eq=False, repr=False)
class Decisions:
    """Time passes; `_phase` is the step of each turn in which it decides."""

    _phase: int
    _state: FlightState
    _battery: BatteryMonitor
    _bounds: Bounds
    _health_checks: HealthChecks
    _failsafe_actions: FailsafeActions
    _task_flight: TaskFlight
    _arming: ArmingRequests
    _mode_changes: ModeChanges
    _camera: CameraRequests
    _faults: FaultInjection
    _airflow: Airflow

    @property
    def due_step(self) -> int:
        """The next step of the engine after which `live` has something to do."""
        k = self._state.steps.k
        if self._state.decision_requested:
            return k + 1
        every = GUIDE_EVERY if self._camera.camera.busy else _DECIDE_EVERY
        return k + 1 + (self._phase - k - 1) % every

    def live(self) -> None:
        """After a step of the engine: decide, where a decision is due."""
        state = self._state
        turn = (state.steps.k - self._phase) % _DECIDE_EVERY
        if turn == 0 or state.decision_requested:
            state.decision_requested = False
            self._decide(turn == 0)
        if turn % GUIDE_EVERY == 0 and self._camera.camera.busy:
            self._camera.photograph()

    def _decide(self, regular: bool) -> None:
        """`regular`: one of ten a second, not one in between."""
        state = self._state
        self._faults.update()
        self._arming.settle_overdue()
        if regular:
            self._boot()
            state.outputs.update(state.time_ns)
            self._battery.update(state.armed, _DECIDE_EVERY * DT_NS * 1e-9)
            sensed = state.sensed
            rates_frd = (sensed.gyro_x, sensed.gyro_y, sensed.gyro_z)
            for event in state.calibration.update(state.time_ns, rates_frd):
                state.emit(event)
            strength = state.sensed.battery_v / state.believed.full_v
            least = _STRENGTH_LEAST
            state.loops.strength_inv = 1.0 / (strength if strength > least else least)
            self._feel_air(strength)
        if state.offboard_wanted:
            self._mode_changes.try_offboard()
        if state.armed:
            s = state.look_around()
            if regular:
                self._failsafe_actions.watch_armed(s)
            self._failsafe_actions.watch_offboard(s)
            if state.armed and state.terminated:
                self._task_flight.stay_down(s, regular)
            elif state.armed:
                self._task_flight.fly(s, regular)
        elif regular:
            s = state.look_around()
            self._bounds.crossing(s)
            self._failsafe_actions.watch_disarmed(s)
            self._health_checks.display_failures()

    def _feel_air(self, strength: float) -> None:
        state = self._state
        f = state.loops
        self._airflow.shake(state.sensed)
        if state.control.flying:
            spin = strength * (f.u1 + f.u2 + f.u3 + f.u4)
            self._airflow.update(
                state.est, state.sensed, spin, state.believed, _DECIDE_EVERY * DT_NS * 1e-9
            )

    def _boot(self) -> None:
        state = self._state
        if state.origin is not None and state.home_ned is not None and not state.boot_sequence.real:
            return  # that is all of a quick start
        stage = state.boot_stage
        for text in state.boot_sequence.texts(state.age_ns, state.ground.alt_amsl_m):
            state.say(6, text)
        if state.origin is None and stage.origin and state.est.placed:
            state.origin = state.ground
        if state.home_ned is None and stage.home and state.origin is not None:
            state.home_ned = (0.0, 0.0, 0.0)
            if not state.boot_sequence.real:
                state.say(6, state.rules.origin_text)
            state.emit(HomeChanged())
        if state.boot_sequence.shows_prearm(state.age_ns) and not state.armed:
            self._health_checks.check_arming()
