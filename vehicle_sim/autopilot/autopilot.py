"""One vehicle as the services see it: the `Vehicle` of interface.py.

Here is what it can be asked.  Requests answer at once; what they lead to is seen in the state.
"""

from __future__ import annotations

from math import isfinite

from vehicle_sim.autopilot.boot import Boot
from vehicle_sim.autopilot.calibration import copter_procedure, motor_test, px4_procedure
from vehicle_sim.autopilot.interface import (
    AttitudeSetpoint,
    Geodetic,
    PlanItem,
    Result,
    Setpoint,
    SpeedType,
    Vehicle,
)
from vehicle_sim.autopilot.manual_input import ManualInput
from vehicle_sim.autopilot.mission import plan as plans
from vehicle_sim.autopilot.modes import MODES, Behaviour, Personality
from vehicle_sim.autopilot.parameters.parameters import Parameters, Quantity
from vehicle_sim.autopilot.parameters.simulated import Simulated
from vehicle_sim.autopilot.tasks.guided import AnySetpoint, Guided, is_sound
from vehicle_sim.autopilot.tasks.tasks import Hold
from vehicle_sim.engine.step import Seat, restart
from vehicle_sim.engine.truth import inject, put_home
from vehicle_sim.numerics.vectors import Vec3
from vehicle_sim.plant.faults import ClockJump, Fault, RcLost, Reboot

_LOWEST_GOAL_UP_M = 0.5
_SIMPLE_ACCEL = 4.0  # PREFLIGHT_CALIBRATION's parameter 5


class Autopilot(ManualInput):
    """`Autopilot(personality, home, seed, index, params)`; `home` is where it stands at boot.

    Local NED has its origin there; `index` tells vehicles of one seed apart; `seat` is its place
    in a fleet's engine, if it has not one of its own.
    """

    def _restart(self) -> None:
        super()._restart()
        self._simulated = Simulated(self.parameters, self._field.lat_deg)

    def _decide(self, regular: bool) -> None:
        for fault in self._simulated.news():
            self.inject(fault)
        super()._decide(regular)

    # -------------------------------------------------------------------------- flights

    def take_off(self, up_above_home_m: float | None) -> Result:
        up_m = up_above_home_m
        if up_m is None:
            up_m = self.parameters.si(Quantity.TAKEOFF_UP_M)
        if not isfinite(up_m) or up_m < _LOWEST_GOAL_UP_M:
            return Result.DENIED
        if self._armed and self._pilot.flying:
            return Result.FAILED if self.personality == "ardupilot" else Result.ACCEPTED
        if not self._position_ok:
            return self._not_now
        if self.personality == "px4":
            self._enter(MODES["px4"]["AUTO.TAKEOFF"], self._take_off_task(up_m))
            return Result.ACCEPTED
        if not self._armed or not isinstance(self._task, Guided):
            return Result.FAILED
        home_d = self._home_ned[2] if self._home_ned is not None else 0.0
        self._task.take_off(home_d - up_m, self._look_around(), self._pilot.heading)
        self._poke()
        return Result.ACCEPTED

    def land(self) -> Result:
        return self.set_mode_kind("land")

    def return_home(self) -> Result:
        return self.set_mode_kind("return")

    def reposition(
        self,
        pos_ned: Vec3 | None,
        yaw_rad: float | None,
        speed_m_s: float | None,
        changes_mode: bool = True,
    ) -> Result:
        """PX4 takes it on the ground, too, and flies there once it is armed."""
        if pos_ned is not None and not all(map(isfinite, pos_ned)):
            return Result.DENIED
        if not self._position_ok:
            return self._not_now
        ardupilot = self.personality == "ardupilot"
        guided = self._mode.behaviour is Behaviour.GUIDED
        if ardupilot and not guided and not changes_mode:
            return Result.DENIED
        if pos_ned is not None and self._fenced_off(pos_ned):
            return Result.FAILED if ardupilot else Result.ACCEPTED
        goal = pos_ned if pos_ned is not None else self._look_around().stop_ned
        wanted = speed_m_s if speed_m_s is not None and speed_m_s > 0.0 else None
        if not ardupilot:
            # The speed is that of this way alone: DO_CHANGE_SPEED's holds again after it.
            if wanted is not None:
                wanted = min(wanted, self.parameters.si(Quantity.FASTEST_M_S))
            self._enter_kind("hold", Hold(goal, yaw_rad, wanted, lifts=not self._pilot.flying))
            return Result.ACCEPTED
        if wanted is not None:
            self.cruise_at(wanted)
        if not guided and self._held_by_fence(MODES["ardupilot"]["GUIDED"]):
            return Result.FAILED
        if not guided or not self._pilot.flying or not isinstance(self._task, Guided):
            # On the ground it drops a take-off that was asked for, and stays there.
            self._enter_kind("guided")
        if not self._pilot.flying:
            return Result.ACCEPTED
        goal_setpoint = Setpoint(pos_ned=goal, yaw_rad=yaw_rad)
        self._stream.heard(goal_setpoint, self._sense().wall_ns, self.time_ns)
        self._poke()
        return Result.ACCEPTED

    def pause(self) -> Result:
        """ArduCopter stops within AUTO or GUIDED; PX4 1.14 does not know the command."""
        if self.personality == "px4":
            return Result.UNSUPPORTED
        if self._paused is not None:
            return Result.ACCEPTED
        task = self._task
        stoppable = self._mode.behaviour in (Behaviour.MISSION, Behaviour.GUIDED)
        if not self._pilot.flying or not stoppable:
            self._say(4, "Failed to pause")
            return Result.FAILED
        self._enter(self._mode, Hold())
        self._paused = task
        return Result.ACCEPTED

    def resume(self) -> Result:
        task = self._paused
        if self.personality == "px4":
            return Result.UNSUPPORTED
        if task is None:
            self._say(4, "Failed to resume")
            return Result.FAILED
        self._enter(self._mode, task)
        return Result.ACCEPTED

    def change_speed(self, kind: SpeedType, speed_m_s: float | None) -> Result:
        """Metres per second; ArduCopter changes it in flight only."""
        if speed_m_s is not None and (not isfinite(speed_m_s) or speed_m_s <= 0.0):
            return Result.DENIED
        if self.personality == "ardupilot" and not self._pilot.flying:
            return Result.FAILED
        self.cruise_at(speed_m_s, kind)
        return Result.ACCEPTED

    def change_altitude(self, up_above_home_m: float) -> Result:
        if self._home_ned is None or not isfinite(up_above_home_m):
            return Result.DENIED
        if not self._pilot.flying:
            return Result.ACCEPTED  # PX4's, as recorded; it does not take off for it here
        s = self._look_around()
        goal = self._task.target.pos_ned or s.stop_ned
        return self.reposition((goal[0], goal[1], s.home_ned[2] - up_above_home_m), None, None)

    def condition_yaw(
        self, yaw_rad: float, relative: bool, rate_rad_s: float, direction: int
    ) -> Result:
        if not isfinite(yaw_rad):
            return Result.DENIED
        if not self._pilot.flying:
            return Result.ACCEPTED  # and nothing turns
        self._roi_ned = None
        heading = self._pilot.heading
        if relative:
            yaw_rad = heading.yaw_rad + (-yaw_rad if direction < 0 else yaw_rad)
        heading.turn(yaw_rad, rate_rad_s, direction)
        return Result.ACCEPTED

    def set_home(self, where: Geodetic | None) -> Result:
        if self._origin is None:
            return self._not_now
        if where is not None and not _on_earth(where):
            return Result.DENIED
        self.move_home(None if where is None else self._projection.to_local(where))
        return Result.ACCEPTED

    def set_setpoint(self, setpoint: Setpoint) -> None:
        if setpoint.yaw_rad is not None or setpoint.yaw_rate_rad_s is not None:
            self._roi_ned = None
        goal = setpoint.pos_ned
        if self.personality == "ardupilot" and goal is not None and self._fenced_off(goal):
            return  # ArduCopter's GUIDED takes no goal outside its fence
        self._hear(setpoint)

    def set_attitude(self, setpoint: AttitudeSetpoint) -> None:
        self._hear(setpoint)

    def _hear(self, setpoint: AnySetpoint) -> None:
        """What is not sound is as good as not sent; a take-off in GUIDED is not disturbed."""
        taking_off = isinstance(self._task, Guided) and self._task.taking_off
        if is_sound(setpoint) and not taking_off:
            self._stream.heard(setpoint, self._sense().wall_ns, self.time_ns)
            self._poke()

    # --------------------------------------------------------------------------- camera

    def capture_image(self, interval_s: float, count: int) -> Result:
        if count < 0 or not isfinite(interval_s) or interval_s < 0.0:
            return Result.DENIED
        if self._camera.busy:
            return Result.TEMPORARILY_REJECTED
        self.take_pictures(interval_s, count)
        return Result.ACCEPTED

    def stop_capture(self) -> Result:
        self.stop_pictures()
        return Result.ACCEPTED

    # -------------------------------------------------------------------------- mission

    def check_plan(self, items: tuple[PlanItem, ...]) -> tuple[int, str] | None:
        return plans.check(items, self.personality)

    def load_plan(self, items: tuple[PlanItem, ...]) -> None:
        self._mission.load(items)
        if self.personality == "ardupilot" and items:
            self._say(6, "Flight plan received")
        self._judge_mission()
        if self._task is self._mission:
            if not self._mission.empty:
                self._mission.begin(self._look_around(), self._pilot.heading)
            elif self.personality == "px4" or self._armed:
                self._enter_kind("hold")

    def mission_start(self, first: int, last: int) -> Result:
        mission = self._mission
        if self.personality == "px4" and not self._mission_ok:
            self._say(2, "Mission start denied! No valid mission")
            return Result.DENIED
        if first > 0 and not mission.jump_to(first):
            return Result.DENIED
        mission.limit(last)
        if mission.empty and not self._armed:
            self._say(2, "PreArm: Mode requires mission")
        begun = self._task is mission
        result = self.set_mode_kind("mission")
        if result is Result.ACCEPTED:
            if not begun:
                mission.announce_begin()  # by the command, after the mode has done so
            self._auto_armed = True
            if self.personality == "px4":
                result = self.arm(False)
        return result

    def mission_set_current(self, seq: int) -> Result:
        if not self._mission.jump_to(seq):
            return Result.DENIED
        self._poke()
        return Result.ACCEPTED

    # ------------------------------------------------------------------------ last things

    def terminate(self, on: bool) -> Result:
        if on:
            self._terminate()
        elif self.personality == "ardupilot":
            return Result.FAILED
        self._terminated = on and self.personality == "px4"
        return Result.ACCEPTED

    def calibrate(self, parameters: tuple[float, ...]) -> Result | None:
        if self.personality == "px4":
            return self._calibrate_px4(parameters)
        if self._armed:
            self._say(5, "Disarm to allow calibration")
            return Result.FAILED
        if parameters[4] == _SIMPLE_ACCEL:
            return Result.TEMPORARILY_REJECTED
        self._calibration.mind_radio(parameters[3])
        procedure = copter_procedure(parameters)
        if procedure is None:
            return Result.UNSUPPORTED
        return self._calibration.begin(procedure, self.time_ns)

    def _calibrate_px4(self, parameters: tuple[float, ...]) -> Result | None:
        if not any(parameters[:6]) and (self._calibration.busy or not any(parameters)):
            result, events = self._calibration.cancel_px4()
            for event in events:
                self.emit(event)
            return result
        if self._calibration.busy:
            # Two answer, the procedure (if it listens) and the commander; the first one is told.
            if not self._calibration.listens:
                return Result.TEMPORARILY_REJECTED
            self._say(2, "command denied during calibration: 241")
            return Result.DENIED
        if self._armed:
            return Result.TEMPORARILY_REJECTED
        procedure = px4_procedure(parameters)
        return None if procedure is None else self._calibration.begin(procedure, self.time_ns)

    def calibration_position(self, position: float) -> Result:
        result, events = self._calibration.turned(position)
        for event in events:
            self.emit(event)
        return result

    def test_motor(self, seconds: float) -> Result:
        if self._armed:
            return Result.FAILED
        return self._calibration.begin(motor_test(seconds), self.time_ns)

    def reboot(self) -> Result:
        """Starts anew on the ground, disarmed; its clock does, too."""
        if self._armed:
            return Result.DENIED
        self._power_up()
        return Result.ACCEPTED

    def reset_parameters(self) -> None:
        if self.personality == "px4":
            self.parameters.reset()
        else:
            self.parameters.erase()
            self._say(4, "All parameters reset, reboot board")

    def _power_up(self) -> None:
        self.parameters.power_up()
        # Who stands is a simulator's vehicle again on its home ground; who flies falls.
        put_home(self.blocks)
        restart(self.blocks, self._believed)
        self._clock_off_ns = 0
        self._restart()

    @property
    def takes_failures(self) -> bool:
        return self.personality != "px4" or self.parameters.get("SYS_FAILURE_EN") == 1

    def inject(self, fault: Fault) -> None:
        match fault:
            case RcLost(lost):
                self._radio.deaf = lost
            case ClockJump(by_ns):
                self._clock_off_ns += by_ns
            case Reboot():
                self._power_up()
            case _:
                inject(fault, self.blocks)


def _on_earth(where: Geodetic) -> bool:
    return abs(where.lat_deg) <= 90.0 and abs(where.lon_deg) <= 180.0 and isfinite(where.alt_amsl_m)


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
