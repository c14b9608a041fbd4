"""One vehicle as the services see it: the `Vehicle` of interface.py, composed of its parts.

What is asked goes to the part that answers it.  The parts know each other in one direction only,
in the order in which they are made here.
"""

from __future__ import annotations

from vehicle_sim.autopilot.acting_failsafe import ActingFailsafe
from vehicle_sim.autopilot.arming_commands import ArmingCommands
from vehicle_sim.autopilot.battery_monitor import BatteryMonitor
from vehicle_sim.autopilot.boot import Boot, BootStage
from vehicle_sim.autopilot.bounds import Bounds
from vehicle_sim.autopilot.calibration_commands import CalibrationCommands
from vehicle_sim.autopilot.camera_commands import CameraCommands
from vehicle_sim.autopilot.control.airflow import Airflow
from vehicle_sim.autopilot.decisions import Decisions
from vehicle_sim.autopilot.failsafe_actions import FailsafeActions
from vehicle_sim.autopilot.failsafes.arming import AutoDisarm
from vehicle_sim.autopilot.failsafes.copter_failsafes import CopterFailsafes
from vehicle_sim.autopilot.failsafes.failsafe_checks import FailsafeChecks
from vehicle_sim.autopilot.failsafes.failure_detector import FailureDetector
from vehicle_sim.autopilot.failsafes.px4_failsafes import Px4Failsafes
from vehicle_sim.autopilot.fault_injection import FaultInjection
from vehicle_sim.autopilot.flight_commands import FlightCommands
from vehicle_sim.autopilot.flight_state import FlightState
from vehicle_sim.autopilot.health_checks import HealthChecks
from vehicle_sim.autopilot.interface import (
    AttitudeGoal,
    Estimate,
    FenceState,
    Geodetic,
    Landed,
    Orbiting,
    PlanItem,
    Power,
    Readings,
    Result,
    Target,
    Truth,
    Vehicle,
)
from vehicle_sim.autopilot.manual.sticks import Radio
from vehicle_sim.autopilot.manual_input import ManualInput
from vehicle_sim.autopilot.mission.mission import Mission
from vehicle_sim.autopilot.mission_checks import MissionChecks
from vehicle_sim.autopilot.mission_requests import MissionRequests
from vehicle_sim.autopilot.mission_support import MissionSupport
from vehicle_sim.autopilot.mode_changes import ModeChanges
from vehicle_sim.autopilot.mode_tasks import ModeTasks
from vehicle_sim.autopilot.modes import Personality
from vehicle_sim.autopilot.parameters.parameters import Parameters
from vehicle_sim.autopilot.target_commands import TargetCommands
from vehicle_sim.autopilot.task_flight import TaskFlight
from vehicle_sim.autopilot.tasks.follow import Leader
from vehicle_sim.autopilot.tasks.guided import SetpointStream
from vehicle_sim.autopilot.transitions import Transitions
from vehicle_sim.autopilot.view import View
from vehicle_sim.engine.few import Few
from vehicle_sim.engine.step import DT_NS, Seat, VehicleSpec, restart
from vehicle_sim.estimation.estimator import Health
from vehicle_sim.numerics.vectors import Vec3
from vehicle_sim.plant.airframe import load
from vehicle_sim.plant.faults import Fault, Reboot

_FAILSAFE_CHECKS: dict[Personality, type[FailsafeChecks]] = {
    "px4": Px4Failsafes,
    "ardupilot": CopterFailsafes,
}


class Autopilot:
    """`Autopilot(personality, home, seed, index, params)`; `home` is where it stands at boot.

    Local NED has its origin there; `index` tells vehicles of one seed apart; `seat` is its place
    in a fleet's engine, if it has not one of its own.
    """

    dt_ns = DT_NS

    def __init__(
        self,
        personality: Personality,
        home: Geodetic,
        seed: int,
        index: int = 0,
        params: Parameters | None = None,
        seat: Seat | None = None,
        boot: Boot = "quick",
        camera: bool = True,
    ) -> None:
        self.personality = personality
        self.parameters = parameters = params if params is not None else Parameters(personality)
        seat = seat or Seat(Few([VehicleSpec(seed, index, home.lat_deg)], load()), 0)
        self.engine = seat.engine
        self.state = state = FlightState(home, parameters, seat, boot)
        self.blocks = state.blocks
        self._compose(index, camera)
        self._forward()
        self._restart()

    def _compose(self, index: int, camera: bool) -> None:
        state, parameters = self.state, self.parameters
        self.radio = radio = Radio(parameters)
        self.leader = leader = Leader(parameters)
        self._stream = stream = SetpointStream()
        self._airflow = Airflow()
        self._failsafe_checks = _FAILSAFE_CHECKS[self.personality](parameters, state.believed)
        self._failure_detector = FailureDetector(parameters)
        self._acting = ActingFailsafe(state.time_ns)
        auto_disarm = AutoDisarm()

        self._battery = BatteryMonitor(parameters, state.blocks, state.believed)
        self._faults = FaultInjection(state, radio)
        self._camera = CameraCommands(state, camera)
        self._bounds = bounds = Bounds(state)
        mode_tasks = ModeTasks(state, bounds, radio, stream, leader)
        self._transitions = transitions = Transitions(
            state,
            mode_tasks,
            self._acting,
            bounds.geofence,
            self._failsafe_checks,
            self._failure_detector,
        )
        self.mission_support = MissionSupport(state, bounds, self._camera, transitions)
        self._mission = mode_tasks.mission = mission = Mission(parameters, self.mission_support)
        mission_checks = MissionChecks(state, bounds.geofence, mission)
        self._health_checks = HealthChecks(
            state,
            self._battery,
            bounds.geofence,
            mission_checks,
            radio,
            stream,
            self._failsafe_checks,
            self._failure_detector,
        )
        self._failsafe_actions = FailsafeActions(
            state,
            self._battery,
            bounds,
            self._health_checks,
            stream,
            self._acting,
            transitions,
            self._failsafe_checks,
            self._failure_detector,
        )
        self._arming = ArmingCommands(
            state, self._health_checks, mission_checks, transitions, auto_disarm
        )
        self._mode_changes = ModeChanges(
            state, mission_checks, self._failsafe_actions, transitions, radio, stream
        )
        self._manual = ManualInput(state, radio, self._arming, self._mode_changes, transitions)
        self._flight = FlightCommands(
            state,
            bounds,
            self._failsafe_actions,
            mode_tasks,
            self._mode_changes,
            transitions,
            stream,
        )
        self._targets = TargetCommands(state, transitions, radio, leader)
        self._missions = MissionRequests(
            state, mission, mission_checks, self._arming, self._mode_changes, transitions
        )
        self._calibrations = CalibrationCommands(state)
        self._view = View(state, self._health_checks, self._acting, mission)
        self._decisions = Decisions(
            index,
            state,
            self._battery,
            bounds,
            self._health_checks,
            self._failsafe_actions,
            TaskFlight(state, mission, mission_checks, transitions, auto_disarm),
            self._arming,
            self._mode_changes,
            self._camera,
            self._faults,
            self._airflow,
        )

    def _forward(self) -> None:
        """The methods of `Vehicle` that are those of a part."""
        state = self.state
        self.wall, self.events = state.wall, state.events
        self.live = self._decisions.live
        self.gcs_heard = self._failsafe_actions.gcs_heard
        arming = self._arming
        self.arm, self.disarm, self.terminate = arming.arm, arming.disarm, arming.terminate
        self.command_acked = arming.command_acked
        self.check_arming = self._health_checks.check_arming
        self.set_mode = self._mode_changes.set_mode
        self.set_mode_kind = self._mode_changes.set_mode_kind
        flight = self._flight
        self.take_off, self.land, self.return_home = (
            flight.take_off,
            flight.land,
            flight.return_home,
        )
        self.reposition, self.pause, self.resume = flight.reposition, flight.pause, flight.resume
        self.change_speed, self.change_altitude = flight.change_speed, flight.change_altitude
        self.condition_yaw, self.look_at = flight.condition_yaw, flight.look_at
        self.set_home = flight.set_home
        self.set_setpoint, self.set_attitude = flight.set_setpoint, flight.set_attitude
        self.orbit, self.hear_leader = self._targets.orbit, self._targets.hear_leader
        self.joystick = self._manual.joystick
        self.override_channels = self._manual.override_channels
        self.capture_image, self.stop_capture = (
            self._camera.capture_image,
            self._camera.stop_capture,
        )
        missions = self._missions
        self.check_plan, self.load_plan = missions.check_plan, missions.load_plan
        self.mission_start = missions.mission_start
        self.mission_set_current = missions.mission_set_current
        bounds = self._bounds
        self.check_fence, self.load_fence = bounds.check_fence, bounds.load_fence
        self.enable_fence = bounds.enable_fence
        self.check_rally, self.load_rally = bounds.check_rally, bounds.load_rally
        self.calibrate = self._calibrations.calibrate
        self.calibration_position = self._calibrations.calibration_position
        self.test_motor = self._calibrations.test_motor
        self.state_bytes = self._view.state_bytes

    # ------------------------------------------------------------------------- power-up

    def _restart(self) -> None:
        """As after power-up, but for the clock and what is stored."""
        self.state.restart()
        self._arming.restart()
        self.radio.forget()
        self._manual.restart()
        self._airflow.forget()
        self._stream.forget()
        self._mission.rewind()
        self._transitions.restart()
        self._health_checks.restart()
        self._failsafe_checks.restart()
        self._failure_detector.reset()
        self._bounds.geofence.forget()
        self._acting.restart(self.state.time_ns)
        self._view.restart()
        self._faults.restart()

    def _power_up(self) -> None:
        self.parameters.power_up()
        self._faults.put_home()
        restart(self.blocks, self.state.believed)
        self.state.clock_off_ns = 0
        self._restart()

    def reboot(self) -> Result:
        """Starts anew on the ground, disarmed; its clock does, too."""
        if self.state.armed:
            return Result.DENIED
        self._power_up()
        return Result.ACCEPTED

    def reset_parameters(self) -> None:
        if self.personality == "px4":
            self.parameters.reset()
        else:
            self.parameters.erase()
            self.state.say(4, "All parameters reset, reboot board")

    def inject(self, fault: Fault) -> None:
        if isinstance(fault, Reboot):
            self._power_up()
        else:
            self._faults.inject(fault)

    @property
    def takes_failures(self) -> bool:
        return self._faults.allowed

    # ----------------------------------------------------------------------------- time

    def step(self) -> None:
        """For a vehicle with an engine of its own: one step, and what it leads to."""
        self.engine.step()
        self.live()

    @property
    def due_step(self) -> int:
        return self._decisions.due_step

    @property
    def time_ns(self) -> int:
        return self.state.time_ns

    @property
    def clock_ns(self) -> int:
        return self.state.clock_ns

    # -------------------------------------------------------------------- what it shows

    @property
    def truth(self) -> Truth:
        return self._view.truth

    @property
    def estimate(self) -> Estimate:
        return self._view.estimate

    @property
    def health(self) -> Health:
        return self.state.health

    @property
    def boot_stage(self) -> BootStage:
        return self.state.boot_stage

    @property
    def readings(self) -> Readings:
        return self._view.readings

    @property
    def power(self) -> Power:
        return self._battery.power

    @property
    def target(self) -> Target:
        return self.state.task.target

    @property
    def armed(self) -> bool:
        return self.state.armed

    @property
    def landed(self) -> Landed:
        return self._view.landed

    @property
    def mode_name(self) -> str:
        return self.state.mode.name

    @property
    def custom_mode(self) -> int:
        return self.state.mode.custom_mode

    @property
    def base_mode(self) -> int:
        return self._view.base_mode

    @property
    def system_status(self) -> int:
        return self._view.system_status

    @property
    def origin(self) -> Geodetic | None:
        return self.state.origin

    @property
    def home(self) -> Geodetic | None:
        return self._view.home

    @property
    def home_pos_ned(self) -> Vec3 | None:
        return self.state.home_ned

    @property
    def armable(self) -> bool:
        return self._view.armable

    @property
    def mav_type(self) -> int:
        return self._view.mav_type

    @property
    def motor_outputs(self) -> tuple[float, float, float, float]:
        return self._view.motor_outputs

    @property
    def wind_ned(self) -> Vec3 | None:
        return self._airflow.wind_ned

    @property
    def vibration_m_s2(self) -> Vec3:
        return self._airflow.vibration_m_s2

    @property
    def attitude_goal(self) -> AttitudeGoal | None:
        return self._view.attitude_goal

    @property
    def orbiting(self) -> Orbiting | None:
        return self._view.orbiting

    @property
    def channels_us(self) -> tuple[int, ...]:
        return self._manual.channels_us

    @property
    def sticks(self) -> tuple[float, float, float, float] | None:
        return self._manual.sticks

    @property
    def capturing(self) -> bool:
        return self._camera.camera.exposing

    @property
    def images_captured(self) -> int:
        return self._camera.camera.images

    @property
    def plan(self) -> tuple[PlanItem, ...]:
        return self._mission.items

    @property
    def mission_current(self) -> int:
        return self._mission.current

    @property
    def mission_state(self) -> int:
        return self._view.mission_state

    @property
    def fence_state(self) -> FenceState:
        return self._bounds.fence_state


def create(
    personality: Personality,
    home: Geodetic,
    seed: int,
    index: int = 0,
    params: Parameters | None = None,
    seat: Seat | None = None,
    boot: Boot = "quick",
) -> Vehicle:
    """A vehicle, for whoever needs no more than the contract."""
    return Autopilot(personality, home, seed, index, params, seat, boot)
