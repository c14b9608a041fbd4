"""What a vehicle is made of, and how it changes from one task to another.

`Life` adds what it does by itself, `View` what it shows, `Autopilot` what it can be asked:
four files for four reasons to change, one object.
"""

from __future__ import annotations

from dataclasses import replace

from vehicle_sim.autopilot.arming import AutoDisarm
from vehicle_sim.autopilot.camera import Camera
from vehicle_sim.autopilot.demands import Situation, Task
from vehicle_sim.autopilot.failsafe import Failsafes
from vehicle_sim.autopilot.geo import Projection, projection
from vehicle_sim.autopilot.guided import Guided, Stream
from vehicle_sim.autopilot.interface import (
    Geodetic,
    HomeChanged,
    Power,
    StatusText,
    Vec3,
    VehicleEvent,
)
from vehicle_sim.autopilot.mission import Mission
from vehicle_sim.autopilot.modes import BOOT_MODE, KINDS, MODES, Behaviour, Mode, Personality
from vehicle_sim.autopilot.parameters import Parameters, Quantity
from vehicle_sim.autopilot.pilot import Pilot, heading_of
from vehicle_sim.autopilot.plan import Datum
from vehicle_sim.autopilot.tasks import Hold, Land, Level, Return, TakeOff
from vehicle_sim.autopilot.trajectory import Limits
from vehicle_sim.model import sensors
from vehicle_sim.model.airframe import load
from vehicle_sim.model.quad import Quad

DT_NS = 4_000_000
DT_S = DT_NS / 1e9
_READY_NS = 1_000_000_000


class Core:
    """State, modes and tasks."""

    def __init__(
        self,
        personality: Personality,
        home: Geodetic,
        seed: int,
        index: int = 0,
        params: Parameters | None = None,
    ) -> None:
        self.parameters = params if params is not None else Parameters(personality)
        self.personality = personality
        self._quad = Quad(load(), DT_S)
        self._sensors = sensors.Sensors(seed, index, DT_S)
        self._pilot = Pilot(self._quad)
        self._events: list[VehicleEvent] = []
        self._step = 0
        self._wall_ns: int | None = None
        self._field = home
        self._projection: Projection = projection(personality, home)
        self._cruise_m_s: float | None = None
        self._limits_version = -1
        self._situation = Situation(self._limits())
        self._camera = Camera()
        self._auto_disarm = AutoDisarm()
        self._stream = Stream()
        self._failsafes = Failsafes(self.parameters)
        self._mission = Mission(self.parameters, self)
        self._restart()

    def _restart(self) -> None:
        """As after power-up, but for the clock and the stored mission."""
        self._boot_ns = self.time_ns
        self._origin: Geodetic | None = None
        self._home_ned: Vec3 | None = None
        self._armed = False
        self._terminated = False
        self._failsafe_active = False
        self._offboard_wanted = False
        self._auto_armed = False
        self._paused: Task | None = None
        self._cruise_m_s = None
        self._mode: Mode = MODES[self.personality][BOOT_MODE[self.personality]]
        self._task: Task = Hold() if self._mode.behaviour is Behaviour.HOLD else Level()
        self._pilot.stop()
        self._stream.forget()
        self._mission.rewind()
        self._limits_version = -1

    # ------------------------------------------------------------------------- time

    @property
    def time_ns(self) -> int:
        return self._step * DT_NS

    def wall(self, wall_ns: int) -> None:
        self._wall_ns = wall_ns

    def gcs_heard(self, wall_ns: int) -> None:
        if self._failsafes.station_lost:
            self._say(6, "Ground station is back")
        self._failsafes.station_heard(wall_ns)

    def events(self) -> list[VehicleEvent]:
        drained = self._events
        self._events = []
        return drained

    def emit(self, event: VehicleEvent) -> None:
        self._events.append(event)

    def _say(self, severity: int, text: str) -> None:
        self._events.append(StatusText(severity, text))

    # ------------------------------------------------------------------ the 50 Hz part

    def _sense(self) -> Situation:
        s = self._situation
        body = self._quad.body
        err = self._sensors
        s.time_ns = self._step * DT_NS
        s.wall_ns = s.time_ns if self._wall_ns is None else self._wall_ns
        s.pos_ned = (
            body.pos_n + err.err_pos_n,
            body.pos_e + err.err_pos_e,
            body.pos_d + err.err_pos_d,
        )
        s.v_ned = (
            body.vel_n + err.err_vel_n,
            body.vel_e + err.err_vel_e,
            body.vel_d + err.err_vel_d,
        )
        s.flying = self._pilot.flying
        if self.parameters.version != self._limits_version:
            s.limits = self._limits()
        return s

    def _look_around(self) -> Situation:
        """The situation with what only a change of task wants to know."""
        s = self._sense()
        body = self._quad.body
        s.heading_rad = heading_of((body.qw, body.qx, body.qy, body.qz))
        s.stop_ned = self._pilot.reference.stopping_point(s.limits) if s.flying else s.pos_ned
        s.home_ned = self._home_ned or (0.0, 0.0, 0.0)
        return s

    # ------------------------------------------------------------------ modes and tasks

    def _enter(self, mode: Mode, task: Task | None = None) -> None:
        """Change the mode; `task` instead of the one that the mode has of its own."""
        self._mode = mode
        self._failsafe_active = False
        self._offboard_wanted = False
        self._paused = None
        self._task = task if task is not None else self._task_of(mode.behaviour)
        self._task.begin(self._look_around(), self._pilot.heading)

    def _enter_kind(self, kind: str, task: Task | None = None) -> None:
        self._enter(MODES[self.personality][KINDS[self.personality][kind]], task)

    def _task_of(self, behaviour: Behaviour) -> Task:
        match behaviour:
            case Behaviour.LEVEL:
                return Level()
            case Behaviour.HOLD:
                return Hold()
            case Behaviour.GUIDED:
                if self.personality == "ardupilot":
                    self._stream.forget()
                return Guided(self.parameters, self._stream)
            case Behaviour.TAKEOFF:
                return self._take_off_task(self.parameters.si(Quantity.TAKEOFF_UP_M))
            case Behaviour.MISSION:
                return self._mission
            case Behaviour.RETURN:
                return Return(self.parameters)
            case Behaviour.LAND:
                return Land(self.parameters)

    def _take_off_task(self, up_m: float) -> TakeOff:
        home_d = self._home_ned[2] if self._home_ned is not None else 0.0
        return TakeOff(home_d - up_m, self.parameters.si(Quantity.TAKEOFF_CLIMB_M_S))

    def _limits(self) -> Limits:
        self._limits_version = self.parameters.version
        si = self.parameters.si
        self._pilot.heading.max_rad_s = si(Quantity.TURN_RAD_S)
        limits = Limits(
            si(Quantity.CRUISE_M_S),
            si(Quantity.CLIMB_M_S),
            si(Quantity.DESCEND_M_S),
            si(Quantity.ACCEL_M_S2),
            si(Quantity.ACCEL_VERTICAL_M_S2),
        )
        cruise = self._cruise_m_s
        return limits if cruise is None else replace(limits, speed_m_s=cruise)

    # ------------------------------------------------------------------------- arming

    @property
    def _position_ok(self) -> bool:
        return self.time_ns - self._boot_ns >= _READY_NS

    def _disarm(self, text: str) -> None:
        self._armed = False
        self._pilot.stop()
        self._cruise_m_s = None
        self._limits_version = -1
        self._failsafe_active = False
        self._auto_armed = False
        self._say(6, text)
        if self.personality == "px4" and self._mode.behaviour in (
            Behaviour.LAND,
            Behaviour.RETURN,
            Behaviour.TAKEOFF,
            Behaviour.MISSION,
        ):
            self._enter(MODES["px4"]["AUTO.LOITER"])

    def _terminate(self) -> None:
        self._armed = False
        self._terminated = True
        self._pilot.stop()
        self._say(0, "Flight terminated: motors off")

    @property
    def power(self) -> Power:
        battery = self._quad.battery
        return Power(
            battery.voltage_v,
            battery.current_a,
            battery.consumed_mah,
            int(100.0 * battery.remaining + 0.5),
        )

    # ----------------------------------------------------------- what a mission asks for

    def datum(self) -> Datum:
        return Datum(self._projection, self._field, self._home_ned or (0.0, 0.0, 0.0))

    def take_pictures(self, interval_s: float, count: int) -> None:
        self._camera.capture(interval_s, count, self.time_ns)

    def stop_pictures(self) -> None:
        self._camera.stop()

    def cruise_at(self, speed_m_s: float | None) -> None:
        self._cruise_m_s = speed_m_s
        self._limits_version = -1

    def move_home(self, where_ned: Vec3 | None) -> None:
        self._home_ned = self._sense().pos_ned if where_ned is None else where_ned
        self._events.append(HomeChanged())

    def turn_nose(self, yaw_rad: float, rate_rad_s: float, direction: int) -> None:
        self._pilot.heading.turn(yaw_rad, rate_rad_s, direction)

    def nose_turns(self) -> bool:
        return self._pilot.heading.turning

    def leave_for_return(self) -> bool:
        if self.personality != "px4":
            return False
        self._enter(MODES["px4"]["AUTO.RTL"])
        return True
