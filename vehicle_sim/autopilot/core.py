"""What a vehicle is made of, and how it changes from one task to another.

`Life` adds what it does by itself, `View` what it shows, `Autopilot` what it can be asked:
four files for four reasons to change, one object.
"""

from __future__ import annotations

from dataclasses import replace
from typing import assert_never

from vehicle_sim.autopilot.boot import Boot, BootSequence, BootStage
from vehicle_sim.autopilot.calibration import Calibration
from vehicle_sim.autopilot.camera import Camera
from vehicle_sim.autopilot.control.airflow import Airflow
from vehicle_sim.autopilot.control.battery_charge import charge_by_voltage
from vehicle_sim.autopilot.control.demands import Situation, Task
from vehicle_sim.autopilot.control.flight_control import LAND_S, FlightControl, heading_of
from vehicle_sim.autopilot.control.gains import write_gains
from vehicle_sim.autopilot.failsafes.arm_authorization import ArmAuthorization
from vehicle_sim.autopilot.failsafes.arming import AutoDisarm
from vehicle_sim.autopilot.failsafes.copter_failsafes import CopterFailsafes
from vehicle_sim.autopilot.failsafes.failsafe_checks import FailsafeChecks
from vehicle_sim.autopilot.failsafes.failure_detector import FAILURE_DETECTORS
from vehicle_sim.autopilot.failsafes.px4_failsafes import Px4Failsafes
from vehicle_sim.autopilot.fence.geofence import Geofence
from vehicle_sim.autopilot.fence.rally import Point
from vehicle_sim.autopilot.geo import Projection, projection
from vehicle_sim.autopilot.interface import (
    Geodetic,
    HomeChanged,
    Power,
    Result,
    SpeedType,
    StatusText,
    VehicleEvent,
)
from vehicle_sim.autopilot.manual.stick_gestures import Gestures
from vehicle_sim.autopilot.manual.stick_tasks import StickFlight
from vehicle_sim.autopilot.manual.sticks import Radio
from vehicle_sim.autopilot.mission.mission import Mission
from vehicle_sim.autopilot.mission.plan import Datum
from vehicle_sim.autopilot.modes import BOOT_MODE, KINDS, MODES, Behaviour, Mode, Personality
from vehicle_sim.autopilot.parameters.parameters import Parameters, Quantity
from vehicle_sim.autopilot.parameters.simulated import SimulatedBattery
from vehicle_sim.autopilot.tasks.follow import FOLLOW, Leader
from vehicle_sim.autopilot.tasks.guided import Guided, SetpointStream
from vehicle_sim.autopilot.tasks.orbit import Orbit, ardupilot_circle, px4_default
from vehicle_sim.autopilot.tasks.tasks import Hold, Land, Level, Return, TakeOff
from vehicle_sim.control_loops.trajectory import MotionLimits, stopping_point
from vehicle_sim.engine.few import Few
from vehicle_sim.engine.step import DT_NS, Blocks, Seat, VehicleSpec
from vehicle_sim.estimation.estimator import Health, health, position_ok
from vehicle_sim.numerics.vectors import Quat, Vec3
from vehicle_sim.plant.airframe import load

UNMEASURED = Power(0.0, -0.01, 0.0, -1)
"""As MAVLink says it: current and remaining charge of -1."""
_FAILSAFE_CHECKS: dict[Personality, type[FailsafeChecks]] = {
    "px4": Px4Failsafes,
    "ardupilot": CopterFailsafes,
}


class Core:
    """State, modes and tasks."""

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
        """Without a `seat` in a fleet's engine the vehicle has an engine of its own."""
        self.parameters = params if params is not None else Parameters(personality)
        self.personality = personality
        self._seat = seat or Seat(Few([VehicleSpec(seed, index, home.lat_deg)], load()), 0)
        self.engine = self._seat.engine
        self.blocks: Blocks = self.engine.blocks(self._seat.lane)
        self._sensed, self._est = self.blocks.sensed, self.blocks.est
        self._believed = self.engine.believed
        self._pilot = FlightControl(self.blocks.flight, self._believed.idle, LAND_S[personality])
        self._events: list[VehicleEvent] = []
        self._index = index
        self._poked = False
        self._clock_off_ns = 0
        self._wall_ns: int | None = None
        self._field = home
        self._projection: Projection = projection(personality, home)
        self._cruise_m_s: float | None = None
        self._climb_m_s: float | None = None
        self._descend_m_s: float | None = None
        self._limits_version = -1
        self._judged: tuple[int, Health] | None = None
        self._situation = Situation(self._limits())
        self._camera = Camera()
        self._has_camera = camera
        self._calibration = Calibration()
        self._airflow = Airflow()
        self._radio = Radio(self.parameters)
        self._gestures = Gestures(self.parameters)
        self._leader = Leader(self.parameters)
        self._simulated_battery = SimulatedBattery(self.parameters)
        self._auto_disarm = AutoDisarm()
        self._stream = SetpointStream()
        self._failsafe_checks: FailsafeChecks = _FAILSAFE_CHECKS[personality](
            self.parameters, self._believed
        )
        self._failure_detector = FAILURE_DETECTORS[personality](self.parameters)
        self._arm_authorization = ArmAuthorization(self.parameters)
        self._geofence = Geofence(self.parameters)
        self._rally: tuple[Point, ...] = ()
        self._mission = Mission(self.parameters, self)
        self._boot_sequence = BootSequence(personality, boot)
        self._restart()

    def _restart(self) -> None:
        """As after power-up, but for the clock and the stored mission."""
        self._boot_ns = self.time_ns
        self._boot_sequence.restart()
        self._arm_authorization.restart()
        self._judged = None
        self._origin: Geodetic | None = None
        self._home_ned: Vec3 | None = None
        self._armed = False
        self._armed_ns = self.time_ns
        self._terminated = False
        self._cut_off_in_air = False
        self._yaw_aligned = False
        self._failsafe_active = False
        self._offboard_wanted = False
        self._auto_armed = False
        self._paused: Task | None = None
        self._calibration = Calibration()
        self._cruise_m_s = self._climb_m_s = self._descend_m_s = None
        self._mode: Mode = MODES[self.personality][BOOT_MODE[self.personality]]
        self._radio.forget()
        self._gestures.forget()
        self._mode_after_disarming = self._mode
        self._roi_ned: Vec3 | None = None
        self._task: Task = self._task_of(self._mode)
        self._pilot.stop()
        self._airflow.forget()
        self._stream.forget()
        self._mission.rewind()
        self._limits_version = -1

    # ------------------------------------------------------------------------- time

    @property
    def time_ns(self) -> int:
        return self.engine.k * DT_NS

    @property
    def clock_ns(self) -> int:
        clock_ns = self.engine.k * DT_NS - self._boot_ns + self._clock_off_ns
        return clock_ns if clock_ns > 0 else 0

    @property
    def _age_ns(self) -> int:
        """Simulated time since power-up."""
        return self.time_ns - self._boot_ns

    @property
    def boot_stage(self) -> BootStage:
        return self._boot_sequence.stage(self._age_ns)

    def _poke(self) -> None:
        """Something came that cannot wait for the next regular decision."""
        self._poked = True

    def wall(self, wall_ns: int) -> None:
        self._wall_ns = wall_ns

    def events(self) -> list[VehicleEvent]:
        drained = self._events
        self._events = []
        return drained

    def emit(self, event: VehicleEvent) -> None:
        self._events.append(event)

    def _say(self, severity: int, text: str) -> None:
        self._events.append(StatusText(severity, text))

    # ------------------------------------------------------------------ what it sees

    def _sense(self) -> Situation:
        s = self._situation
        est = self._est
        s.time_ns = self.time_ns
        s.wall_ns = s.time_ns if self._wall_ns is None else self._wall_ns
        s.pos_ned = (est.pos_n, est.pos_e, est.pos_d)
        s.v_ned = (est.vel_n, est.vel_e, est.vel_d)
        s.flying = self._pilot.flying
        if self.parameters.version != self._limits_version:
            s.limits = self._limits()
        return s

    @property
    def health(self) -> Health:
        """The estimate judged: once a step, for all who ask."""
        k = self.engine.k
        if self._judged is None or self._judged[0] != k:
            judged = health(self._est, self._sensed)
            self._judged = (k, self._boot_sequence.known(judged, self._age_ns))
        return self._judged[1]

    def _look_around(self) -> Situation:
        """The situation with what only a change of task wants to know."""
        s = self._sense()
        s.heading_rad = heading_of(self._attitude)
        f = self.blocks.flight
        # Where the estimate has just jumped, the reference is still where it was before.
        sure = s.flying and f.resets == self._est.resets
        s.stop_ned = stopping_point(f, s.limits) if sure else s.pos_ned
        s.home_ned = self._home_ned or (0.0, 0.0, 0.0)
        return s

    @property
    def _attitude(self) -> Quat:
        est = self._est
        return (est.qw, est.qx, est.qy, est.qz)

    # ------------------------------------------------------------------ modes and tasks

    def _enter(self, mode: Mode, task: Task | None = None) -> None:
        """Change the mode; `task` instead of the one that the mode has of its own."""
        self._mode = mode
        self._failsafe_active = False
        self._offboard_wanted = False
        self._paused = None
        if self.personality == "ardupilot":
            self._roi_ned = None  # ArduCopter's every mode begins with its own way to point
        self._task = task if task is not None else self._task_of(mode)
        self._task.begin(self._look_around(), self._pilot.heading)
        self._poke()

    def _enter_kind(self, kind: str, task: Task | None = None) -> None:
        self._enter(MODES[self.personality][KINDS[self.personality][kind]], task)

    def _task_of(self, mode: Mode) -> Task:
        if mode.law is not None:
            idle = Level if mode.behaviour is Behaviour.LEVEL else Hold
            return StickFlight(mode.law, self.parameters, self._radio, idle)
        match mode.behaviour:
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
            case Behaviour.ORBIT:
                return Orbit(px4_default, self.parameters, self._radio)
            case Behaviour.CIRCLE:
                return Orbit(ardupilot_circle(self.parameters), self.parameters)
            case Behaviour.FOLLOW:
                return FOLLOW[self.personality](self.parameters, self._leader)
            case _:
                assert_never(mode.behaviour)

    def _take_off_task(self, up_m: float) -> TakeOff:
        home_d = self._home_ned[2] if self._home_ned is not None else 0.0
        return TakeOff(home_d - up_m, self.parameters)

    def _limits(self) -> MotionLimits:
        self._limits_version = self.parameters.version
        si = self.parameters.si
        self._pilot.heading.max_rad_s = si(Quantity.TURN_RAD_S)
        limits = MotionLimits(
            si(Quantity.CRUISE_M_S),
            self._climb_m_s if self._climb_m_s is not None else si(Quantity.CLIMB_M_S),
            self._descend_m_s if self._descend_m_s is not None else si(Quantity.DESCEND_M_S),
            si(Quantity.ACCEL_M_S2),
            si(Quantity.ACCEL_VERTICAL_M_S2),
            si(Quantity.ACCEL_UP_M_S2),
        )
        write_gains(self.parameters, self.blocks.flight, self._est, self._believed)
        if self.personality == "ardupilot":
            self._pilot.idle = self.parameters.get("MOT_SPIN_ARM")
        cruise = self._cruise_m_s
        if cruise is None:
            return limits
        return replace(limits, speed_m_s=min(cruise, si(Quantity.FASTEST_M_S)))

    # ------------------------------------------------------------------------- arming

    @property
    def _position_ok(self) -> bool:
        return position_ok(self._est) and self.boot_stage.position

    def _disarm(self, text: str) -> None:
        self._armed = False
        self._pilot.stop()
        self._cruise_m_s = self._climb_m_s = self._descend_m_s = None
        self._limits_version = -1
        self._failsafe_active = False
        self._auto_armed = False
        self._cut_off_in_air = False
        self._yaw_aligned = False
        self._say(6, text)
        if self.personality != "px4":
            return
        before = self._mode_after_disarming
        if before is not self._mode or before.behaviour is Behaviour.HOLD:
            # HOLD begins anew: what it was to fly to ends with the flight.
            self._enter(before)

    def _terminate(self) -> None:
        """Motors off.  ArduCopter's is no more than a disarming: nothing of it stays.

        PX4 stays armed and in its mode.  As the mode's demands go on, its land detector does not
        notice the fall: it says IN_AIR until it is told to land.
        """
        if self.personality == "ardupilot":
            if self._armed:
                self._disarm("Disarming motors")
            else:
                self._say(6, "Disarming motors")
            return
        self._terminated = True
        self._cut_off_in_air = self._cut_off_in_air or self._pilot.flying
        self._pilot.stop()
        self._say(2, "Preflight Fail: Flight termination active")

    @property
    def power(self) -> Power:
        sensed = self._sensed
        if self.personality == "ardupilot" and self.parameters.get("BATT_MONITOR") == 0:
            return UNMEASURED
        return Power(
            self._simulated_battery.volts(sensed.battery_v),
            sensed.battery_a,
            sensed.battery_used_mah,
            int(100.0 * self._charge_seen + 0.5),
        )

    @property
    def _charge_seen(self) -> float:
        """0..1: PX4, unless it is told a capacity, goes by the voltage; ArduCopter counts."""
        f = self.blocks.flight
        simulated = self._simulated_battery.charge(0.25 * (f.u1 + f.u2 + f.u3 + f.u4))
        if simulated is not None:
            return simulated
        px4 = self.personality == "px4"
        capacity_mah = self.parameters.get("BAT1_CAPACITY" if px4 else "BATT_CAPACITY")
        if px4 and capacity_mah <= 0.0:
            return charge_by_voltage(self._sensed, self._believed)
        if capacity_mah <= 0.0:
            return 0.0
        return max(0.0, 1.0 - self._sensed.battery_used_mah / capacity_mah)

    # ----------------------------------------------------------- what a mission asks for

    def datum(self) -> Datum:
        return Datum(self._projection, self._field, self._home_ned or (0.0, 0.0, 0.0))

    def take_pictures(self, interval_s: float, count: int) -> None:
        if self._has_camera:
            self._camera.capture(interval_s, count, self.time_ns)

    def stop_pictures(self) -> None:
        self._camera.stop()

    def cruise_at(self, speed_m_s: float | None, kind: SpeedType = SpeedType.GROUND) -> None:
        """None = the default again.  A multicopter has no airspeed: that is over ground, too."""
        match kind:
            case SpeedType.CLIMB:
                self._climb_m_s = speed_m_s
            case SpeedType.DESCENT:
                self._descend_m_s = speed_m_s
            case _:
                self._cruise_m_s = speed_m_s
        self._limits_version = -1
        self._poke()

    def move_home(self, where_ned: Vec3 | None) -> None:
        self._home_ned = self._sense().pos_ned if where_ned is None else where_ned
        self._events.append(HomeChanged())

    def turn_nose(self, yaw_rad: float, rate_rad_s: float, direction: int) -> None:
        self._pilot.heading.turn(yaw_rad, rate_rad_s, direction)

    def enable_fence(self, choice: int) -> Result:
        """ArduCopter's DO_FENCE_ENABLE, command or mission item; PX4 does not know it."""
        if self.personality == "px4":
            return Result.UNSUPPORTED
        if choice not in (0, 1, 2):
            return Result.FAILED
        self._geofence.bar_floor(choice == 2)
        if choice != 2:
            self.parameters.set("FENCE_ENABLE", choice)
        return Result.ACCEPTED

    def nose_turns(self) -> bool:
        return self._pilot.heading.turning

    def leave_for_return(self) -> bool:
        if self.personality != "px4":
            return False
        self._say(6, "Returning to launch")
        self._enter(MODES["px4"]["AUTO.RTL"])
        return True
