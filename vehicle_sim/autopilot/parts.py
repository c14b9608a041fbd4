"""The parts of an autopilot, each given what it needs.

They know each other in one direction only, in the order in which they are made here.  The one
exception is the mission: it is a task that modes fly, and may change the mode itself.
"""

from __future__ import annotations

from vehicle_sim.autopilot.acting_failsafe import ActingFailsafe
from vehicle_sim.autopilot.bounds import Bounds
from vehicle_sim.autopilot.control.airflow import Airflow
from vehicle_sim.autopilot.decisions import Decisions, turn_of
from vehicle_sim.autopilot.failsafe_actions import FailsafeActions
from vehicle_sim.autopilot.failsafes.arming import AutoDisarm
from vehicle_sim.autopilot.failsafes.copter_failsafes import CopterFailsafes
from vehicle_sim.autopilot.failsafes.failsafe_checks import FailsafeChecks
from vehicle_sim.autopilot.failsafes.failure_detector import FAILURE_DETECTORS
from vehicle_sim.autopilot.failsafes.px4_failsafes import Px4Failsafes
from vehicle_sim.autopilot.fault_injection import FaultInjection
from vehicle_sim.autopilot.flight_state import FlightState
from vehicle_sim.autopilot.health.battery_monitor import BatteryMonitor
from vehicle_sim.autopilot.health.health_checks import HealthChecks
from vehicle_sim.autopilot.health.mission_checks import MissionChecks
from vehicle_sim.autopilot.manual.sticks import Radio
from vehicle_sim.autopilot.mission.mission import Mission
from vehicle_sim.autopilot.mode_tasks import ModeTasks
from vehicle_sim.autopilot.modes import Personality
from vehicle_sim.autopilot.requests.arming import ArmingRequests
from vehicle_sim.autopilot.requests.calibration import CalibrationRequests
from vehicle_sim.autopilot.requests.camera import CameraRequests
from vehicle_sim.autopilot.requests.flight import FlightRequests
from vehicle_sim.autopilot.requests.manual_input import ManualInput
from vehicle_sim.autopilot.requests.mission import MissionRequests
from vehicle_sim.autopilot.requests.mission_support import MissionSupport
from vehicle_sim.autopilot.requests.mode_changes import ModeChanges
from vehicle_sim.autopilot.requests.orbit_follow import OrbitFollowRequests
from vehicle_sim.autopilot.requests.outputs import OutputRequests
from vehicle_sim.autopilot.task_flight import TaskFlight
from vehicle_sim.autopilot.tasks.follow import Leader
from vehicle_sim.autopilot.tasks.guided import SetpointStream
from vehicle_sim.autopilot.transitions import Transitions
from vehicle_sim.autopilot.view import View
from vehicle_sim.engine.step import Blocks

_FAILSAFE_CHECKS: dict[Personality, type[FailsafeChecks]] = {
    "px4": Px4Failsafes,
    "ardupilot": CopterFailsafes,
}


class Parts:
    """All the parts of one vehicle."""

    def __init__(self, state: FlightState, blocks: Blocks, index: int, camera: bool) -> None:
        """`blocks` are for the simulator's own parts: they have the truth."""
        self.state = state
        parameters = state.parameters
        self.radio = radio = Radio(parameters)
        self.leader = leader = Leader(parameters)
        self.stream = stream = SetpointStream()
        self.airflow = Airflow()
        self.failsafe_checks = _FAILSAFE_CHECKS[state.personality](parameters, state.believed)
        self.failure_detector = FAILURE_DETECTORS[state.personality](parameters)
        self.acting = ActingFailsafe(state.time_ns)
        auto_disarm = AutoDisarm()

        self.battery = BatteryMonitor(parameters, state.sensed, state.loops, state.believed)
        self.faults = FaultInjection(state, blocks, radio)
        self.camera = CameraRequests(state, camera)
        self.bounds = bounds = Bounds(state)
        mode_tasks = ModeTasks(state, bounds, radio, stream, leader)
        self.transitions = transitions = Transitions(
            state,
            mode_tasks,
            self.acting,
            bounds.geofence,
            self.failsafe_checks,
            self.failure_detector,
        )
        self.outputs = OutputRequests(state)
        self.mission_support = MissionSupport(state, bounds, self.camera, self.outputs, transitions)
        self.mission = mode_tasks.mission = mission = Mission(parameters, self.mission_support)
        mission_checks = MissionChecks(state, bounds.geofence, mission)
        self.health_checks = HealthChecks(
            state,
            self.battery,
            bounds.geofence,
            mission_checks,
            radio,
            stream,
            self.failsafe_checks,
            self.failure_detector,
        )
        self.failsafe_actions = FailsafeActions(
            state,
            self.battery,
            bounds,
            self.health_checks,
            stream,
            self.acting,
            transitions,
            self.failsafe_checks,
            self.failure_detector,
        )
        self.arming = ArmingRequests(
            state, self.health_checks, mission_checks, transitions, auto_disarm
        )
        self.mode_changes = ModeChanges(
            state, mission_checks, self.failsafe_actions, transitions, radio, stream
        )
        self.manual = ManualInput(state, radio, self.arming, self.mode_changes, transitions)
        self.flight = FlightRequests(
            state,
            bounds,
            self.failsafe_actions,
            mode_tasks,
            self.mode_changes,
            transitions,
            stream,
        )
        self.targets = OrbitFollowRequests(state, transitions, radio, leader)
        self.missions = MissionRequests(
            state, mission, mission_checks, self.arming, self.mode_changes, transitions
        )
        self.calibrations = CalibrationRequests(state)
        self.view = View(state, blocks, self.health_checks, self.acting, mission)
        self.decisions = Decisions(
            turn_of(index),
            state,
            self.battery,
            bounds,
            self.health_checks,
            self.failsafe_actions,
            TaskFlight(state, mission, mission_checks, transitions, auto_disarm),
            self.arming,
            self.mode_changes,
            self.camera,
            self.faults,
            self.airflow,
        )

    def restart(self) -> None:
        """As after power-up, but for the clock and what is stored."""
        self.state.restart()
        self.arming.restart()
        self.radio.forget()
        self.manual.restart()
        self.airflow.forget()
        self.stream.forget()
        self.mission.rewind()
        self.transitions.restart()
        self.health_checks.restart()
        self.failsafe_checks.restart()
        self.failure_detector.reset()
        self.bounds.geofence.forget()
        self.acting.restart(self.state.time_ns)
        self.view.restart()
        self.faults.restart()
