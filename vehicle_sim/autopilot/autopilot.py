"""One vehicle as the services see it: the `Vehicle` of interface.py.

What is asked goes to the part (`parts.py`) that answers it.
"""

from __future__ import annotations

from collections.abc import Sequence

from vehicle_sim.autopilot.boot import Boot, BootStage
from vehicle_sim.autopilot.flight_state import FlightState
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
from vehicle_sim.autopilot.modes import Personality
from vehicle_sim.autopilot.parameters.parameters import Parameters
from vehicle_sim.autopilot.parts import Parts
from vehicle_sim.engine.scalar_engine import ScalarEngine
from vehicle_sim.engine.step import DT_NS, Seat, VehicleSpec, restart
from vehicle_sim.estimation.estimator import Health
from vehicle_sim.numerics.vectors import Vec3
from vehicle_sim.plant.airframe import load
from vehicle_sim.plant.faults import Fault, Reboot


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
        seat = seat or Seat(ScalarEngine([VehicleSpec(seed, index, home.lat_deg)], load()), 0)
        self.engine = seat.engine
        self.state = state = FlightState(home, parameters, seat.onboard, boot)
        self.blocks = seat.engine.blocks(seat.lane)
        self.parts = Parts(state, self.blocks, index, camera)
        self._forward(self.parts)
        self.parts.restart()

    def _forward(self, parts: Parts) -> None:
        """The methods of `Vehicle` that are those of a part."""
        self.wall, self.events = self.state.wall, self.state.events
        self._decisions = parts.decisions
        self.live = parts.decisions.live
        self.gcs_heard = parts.failsafe_actions.gcs_heard
        arming = parts.arming
        self.arm, self.disarm, self.terminate = arming.arm, arming.disarm, arming.terminate
        self.command_acked = arming.command_acked
        self.check_arming = parts.health_checks.check_arming
        self.set_mode = parts.mode_changes.set_mode
        self.set_mode_kind = parts.mode_changes.set_mode_kind
        flight = parts.flight
        self.take_off = flight.take_off
        self.land, self.return_home = flight.land, flight.return_home
        self.reposition, self.pause, self.resume = flight.reposition, flight.pause, flight.resume
        self.change_speed, self.change_altitude = flight.change_speed, flight.change_altitude
        self.condition_yaw, self.look_at = flight.condition_yaw, flight.look_at
        self.set_home = flight.set_home
        self.set_setpoint, self.set_attitude = flight.set_setpoint, flight.set_attitude
        self.orbit, self.hear_leader = parts.targets.orbit, parts.targets.hear_leader
        self.joystick = parts.manual.joystick
        self.override_channels = parts.manual.override_channels
        self.capture_image = parts.camera.capture_image
        self.stop_capture = parts.camera.stop_capture
        missions = parts.missions
        self.check_plan, self.load_plan = missions.check_plan, missions.load_plan
        self.mission_start = missions.mission_start
        self.mission_set_current = missions.mission_set_current
        bounds = parts.bounds
        self.check_fence, self.load_fence = bounds.check_fence, bounds.load_fence
        self.enable_fence = bounds.enable_fence
        self.check_rally, self.load_rally = bounds.check_rally, bounds.load_rally
        self.calibrate = parts.calibrations.calibrate
        self.calibration_position = parts.calibrations.calibration_position
        self.calibrate_compass_by_yaw = parts.calibrations.calibrate_compass_by_yaw
        self.log_download = parts.health_checks.log_download
        self.test_motor = parts.calibrations.test_motor
        outputs = parts.outputs
        self.set_servo, self.repeat_servo = outputs.set_servo, outputs.repeat_servo
        self.set_relay, self.repeat_relay = outputs.set_relay, outputs.repeat_relay
        self.state_bytes = parts.view.state_bytes

    # ------------------------------------------------------------------------- power-up

    def _power_up(self) -> None:
        self.parameters.power_up()
        self.parts.faults.put_home()
        restart(self.blocks, self.state.believed)
        self.state.clock_off_ns = 0
        self.parts.restart()

    def reboot(self) -> Result:
        """Starts anew on the ground, disarmed; its clock does, too."""
        if self.state.armed:
            return Result.DENIED
        self._power_up()
        return Result.ACCEPTED

    def reset_parameters(self) -> None:
        if self.state.rules.parameters_reset_at_once:
            self.parameters.reset()
        else:
            self.parameters.erase()
            self.state.say(4, "All parameters reset, reboot board")

    def inject(self, fault: Fault) -> None:
        if isinstance(fault, Reboot):
            self._power_up()
        else:
            self.parts.faults.inject(fault)

    @property
    def faults(self) -> Sequence[Fault]:
        return self.parts.faults.present

    @property
    def takes_failures(self) -> bool:
        return self.parts.faults.allowed

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
        return self.parts.view.truth

    @property
    def estimate(self) -> Estimate:
        return self.parts.view.estimate

    @property
    def health(self) -> Health:
        return self.state.health

    @property
    def boot_stage(self) -> BootStage:
        return self.state.boot_stage

    @property
    def readings(self) -> Readings:
        return self.parts.view.readings

    @property
    def power(self) -> Power:
        return self.parts.battery.power

    @property
    def target(self) -> Target:
        return self.state.task.target

    @property
    def armed(self) -> bool:
        return self.state.armed

    @property
    def landed(self) -> Landed:
        return self.parts.view.landed

    @property
    def mode_name(self) -> str:
        return self.state.mode.name

    @property
    def custom_mode(self) -> int:
        return self.state.mode.custom_mode

    @property
    def base_mode(self) -> int:
        return self.parts.view.base_mode

    @property
    def system_status(self) -> int:
        return self.parts.view.system_status

    @property
    def origin(self) -> Geodetic | None:
        return self.state.origin

    @property
    def home(self) -> Geodetic | None:
        return self.parts.view.home

    @property
    def home_pos_ned(self) -> Vec3 | None:
        return self.state.home_ned

    @property
    def armable(self) -> bool:
        return self.parts.view.armable

    @property
    def mav_type(self) -> int:
        return self.parts.view.mav_type

    @property
    def motor_outputs(self) -> tuple[float, float, float, float]:
        return self.parts.view.motor_outputs

    @property
    def servos_us(self) -> tuple[int, ...]:
        return self.state.outputs.pulses_us

    @property
    def relays(self) -> tuple[int, int]:
        return self.state.outputs.relays

    @property
    def wind_ned(self) -> Vec3 | None:
        return self.parts.airflow.wind_ned

    @property
    def vibration_m_s2(self) -> Vec3:
        return self.parts.airflow.vibration_m_s2

    @property
    def attitude_goal(self) -> AttitudeGoal | None:
        return self.parts.view.attitude_goal

    @property
    def orbiting(self) -> Orbiting | None:
        return self.parts.view.orbiting

    @property
    def channels_us(self) -> tuple[int, ...]:
        return self.parts.manual.channels_us

    @property
    def sticks(self) -> tuple[float, float, float, float] | None:
        return self.parts.manual.sticks

    @property
    def capturing(self) -> bool:
        return self.parts.camera.camera.exposing

    @property
    def images_captured(self) -> int:
        return self.parts.camera.camera.images

    @property
    def plan(self) -> tuple[PlanItem, ...]:
        return self.parts.mission.items

    @property
    def mission_current(self) -> int:
        return self.parts.mission.current

    @property
    def mission_state(self) -> int:
        return self.parts.view.mission_state

    @property
    def fence_state(self) -> FenceState:
        return self.parts.bounds.fence_state


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
