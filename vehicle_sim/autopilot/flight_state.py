"""The state of one flight: what every part of the autopilot reads, and its simplest acts."""

from __future__ import annotations

from vehicle_sim.autopilot.boot import Boot, BootSequence, BootStage
from vehicle_sim.autopilot.calibration import Calibration
from vehicle_sim.autopilot.control.demands import Situation, Task
from vehicle_sim.autopilot.control.flight_control import LAND_S, FlightControl, heading_of
from vehicle_sim.autopilot.geo import Projection, projection
from vehicle_sim.autopilot.interface import (
    Geodetic,
    HomeChanged,
    SpeedType,
    StatusText,
    VehicleEvent,
)
from vehicle_sim.autopilot.mission.plan import Datum
from vehicle_sim.autopilot.modes import BOOT_MODE, MODES, Mode
from vehicle_sim.autopilot.parameters.parameters import Parameters
from vehicle_sim.autopilot.rules import RULES, AutopilotRules
from vehicle_sim.autopilot.servo_outputs import ServoOutputs
from vehicle_sim.autopilot.speed_limits import SpeedLimits
from vehicle_sim.autopilot.tasks.tasks import Hold
from vehicle_sim.control_loops.trajectory import stopping_point
from vehicle_sim.engine.step import DT_NS, Onboard
from vehicle_sim.estimation.estimator import Health, health, position_ok
from vehicle_sim.numerics.vectors import Quat, Vec3


class FlightState:
    """What is true of the flight now.  It decides nothing.

    `ground` is where the vehicle stands at boot: there local NED has its origin.  `origin` and
    `home_ned` are None until they are set.  `paused` is the task that a pause interrupted,
    `mode_after_disarming` the mode that PX4 goes back to.
    """

    def __init__(
        self,
        ground: Geodetic,
        parameters: Parameters,
        onboard: Onboard,
        boot: Boot,
    ) -> None:
        self.parameters = parameters
        self.personality = personality = parameters.personality
        self.rules: AutopilotRules = RULES[personality]
        self.steps = onboard.steps
        self.sensed, self.est, self.loops = onboard.sensed, onboard.est, onboard.flight
        self.believed = onboard.believed
        self.control = FlightControl(self.loops, self.believed.idle, LAND_S[personality])
        self.limits = SpeedLimits(parameters, self.control, onboard)
        self.ground = ground
        self.projection: Projection = projection(personality, ground)
        self.boot_sequence = BootSequence(personality, boot)
        self.decision_requested = False
        self.clock_off_ns = 0
        self.outputs = ServoOutputs()
        self._wall_ns: int | None = None
        self._events: list[VehicleEvent] = []
        self._judged: tuple[int, Health] | None = None
        self._situation = Situation(self.limits.current())
        self.restart()

    def restart(self) -> None:
        """As after power-up.  The task of the mode is entered by `Transitions.restart`."""
        self._boot_ns = self.time_ns
        self.boot_sequence.restart()
        self._judged = None
        self.origin: Geodetic | None = None
        self.home_ned: Vec3 | None = None
        self.armed = False
        self.armed_ns = self.time_ns
        self.terminated = False
        self.cut_off_in_air = False
        self.yaw_aligned = False
        self.failsafe_active = False
        self.offboard_wanted = False
        self.auto_armed = False
        self.paused: Task | None = None
        self.calibration = Calibration()
        self.limits.reset()
        self.outputs.restart()
        self.mode: Mode = MODES[self.personality][BOOT_MODE[self.personality]]
        self.mode_after_disarming = self.mode
        self.roi_ned: Vec3 | None = None
        self.task: Task = Hold()
        self.control.stop()

    # ------------------------------------------------------------------------- time

    @property
    def time_ns(self) -> int:
        return self.steps.k * DT_NS

    @property
    def clock_ns(self) -> int:
        clock_ns = self.steps.k * DT_NS - self._boot_ns + self.clock_off_ns
        return clock_ns if clock_ns > 0 else 0

    @property
    def age_ns(self) -> int:
        """Simulated time since power-up."""
        return self.time_ns - self._boot_ns

    @property
    def boot_stage(self) -> BootStage:
        return self.boot_sequence.stage(self.age_ns)

    def request_decision(self) -> None:
        """Something came that cannot wait for the next regular decision."""
        self.decision_requested = True

    def wall(self, wall_ns: int) -> None:
        self._wall_ns = wall_ns

    # ---------------------------------------------------------------- what it tells

    def events(self) -> list[VehicleEvent]:
        drained = self._events
        self._events = []
        return drained

    def emit(self, event: VehicleEvent) -> None:
        self._events.append(event)

    def say(self, severity: int, text: str) -> None:
        self._events.append(StatusText(severity, text))

    # ------------------------------------------------------------------ what it sees

    def sense(self) -> Situation:
        s = self._situation
        est = self.est
        s.time_ns = self.time_ns
        s.wall_ns = s.time_ns if self._wall_ns is None else self._wall_ns
        s.pos_ned = (est.pos_n, est.pos_e, est.pos_d)
        s.v_ned = (est.vel_n, est.vel_e, est.vel_d)
        s.flying = self.control.flying
        if self.parameters.version != self.limits.made_from:
            s.limits = self.limits.current()
        return s

    @property
    def health(self) -> Health:
        """The estimate judged: once a step, for all who ask."""
        k = self.steps.k
        if self._judged is None or self._judged[0] != k:
            judged = health(self.est, self.sensed)
            self._judged = (k, self.boot_sequence.known(judged, self.age_ns))
        return self._judged[1]

    def look_around(self) -> Situation:
        """The situation with what only a change of task wants to know."""
        s = self.sense()
        s.heading_rad = heading_of(self.attitude)
        f = self.loops
        # Where the estimate has just jumped, the reference is still where it was before.
        sure = s.flying and f.resets == self.est.resets
        s.stop_ned = stopping_point(f, self.est, s.limits) if sure else s.pos_ned
        s.home_ned = self.home_ned or (0.0, 0.0, 0.0)
        return s

    @property
    def attitude(self) -> Quat:
        est = self.est
        return (est.qw, est.qx, est.qy, est.qz)

    @property
    def position_ok(self) -> bool:
        return position_ok(self.est) and self.boot_stage.position

    # ------------------------------------------------------------- its home and its speed

    def datum(self) -> Datum:
        home_ned = self.home_ned or (0.0, 0.0, 0.0)
        return Datum(self.projection, self.ground, home_ned, self.rules.zero_keeps_height)

    def change_speed(self, speed_m_s: float | None, kind: SpeedType = SpeedType.GROUND) -> None:
        """For the vehicle's own flights, until it is disarmed; None = the default again."""
        self.limits.change(speed_m_s, kind)
        self.request_decision()

    def move_home(self, where_ned: Vec3 | None) -> None:
        self.home_ned = self.sense().pos_ned if where_ned is None else where_ned
        self._events.append(HomeChanged())
