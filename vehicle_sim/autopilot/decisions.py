"""What the vehicle does by itself: boots, flies its mode's task, lands, disarms, fails safe.

It decides ten times a second, and at once when something was asked of it; its engine flies what
was decided, with every step.  Everything runs on simulated time, counted in steps; only what
measures the other side (setpoint and ground-station silence) runs on wall time.
"""

from __future__ import annotations

from vehicle_sim.autopilot.control.demands import Situation, Task
from vehicle_sim.autopilot.failsafe_actions import FailsafeActions
from vehicle_sim.autopilot.interface import HomeChanged, ImageCaptured
from vehicle_sim.autopilot.modes import MODES, Behaviour
from vehicle_sim.autopilot.parameters.parameters import Quantity
from vehicle_sim.autopilot.tasks.tasks import Hold, TakeOff, face
from vehicle_sim.engine.step import DT_NS, GUIDE_EVERY

_DECIDE_EVERY = 25  # 10 Hz
_ARMING_DELAY_S = 2.0  # ArduCopter's ARMING_DELAY_SEC, by memory: its motors idle so long at first
_ALIGNED_UP_M = 2.5  # EKF3_MAG_FINAL_RESET_ALT
_STILL_M_S = 0.5  # no more than this up or down: it does not fall
_STRENGTH_LEAST = 0.5  # of a full battery's voltage; for less the motors do not make up
_TAKES_OFF_BY_ITSELF = 2  # AUTO_OPTIONS

_POINTED = (
    Behaviour.HOLD,
    Behaviour.GUIDED,
    Behaviour.TAKEOFF,
    Behaviour.MISSION,
    Behaviour.RETURN,
)
"""In these, unless they are flown by hand, a region of interest turns the nose."""


def _turn_of(index: int) -> int:
    """The step in which it decides: vehicles of a fleet take turns, just before the guidance's."""
    return GUIDE_EVERY * (index + 1) - 1


def phase_ns(index: int) -> int:
    """What shifts a vehicle's streams: it speaks when it has just decided.

    Over a fleet the second is used evenly, so that no heartbeats come all at once.
    """
    return _turn_of(index) * DT_NS % 1_000_000_000


class Decisions(FailsafeActions):
    """Time passes."""

    @property
    def dt_ns(self) -> int:
        return DT_NS

    def step(self) -> None:
        """For a vehicle with an engine of its own: one step, and what it leads to."""
        self.engine.step()
        self.live()

    @property
    def due_step(self) -> int:
        """The next step of the engine after which `live` has something to do."""
        k = self.engine.k
        if self._poked:
            return k + 1
        every = GUIDE_EVERY if self._camera.busy else _DECIDE_EVERY
        return k + 1 + (self._phase - k - 1) % every

    @property
    def _phase(self) -> int:
        return _turn_of(self._index)

    def live(self) -> None:
        """After a step of the engine: decide, where a decision is due."""
        turn = (self.engine.k - self._phase) % _DECIDE_EVERY
        if turn == 0 or self._poked:
            self._poked = False
            self._decide(turn == 0)
        if self._camera.busy and turn % GUIDE_EVERY == 0:
            self._photograph()

    def _decide(self, regular: bool) -> None:
        """`regular`: one of ten a second, not one in between."""
        if regular:
            self._boot()
            self._simulated_battery.update(self._armed, _DECIDE_EVERY * DT_NS * 1e-9)
            sensed = self.blocks.sensed
            rates_frd = (sensed.gyro_x, sensed.gyro_y, sensed.gyro_z)
            for event in self._calibration.update(self.time_ns, rates_frd):
                self.emit(event)
            strength = self._sensed.battery_v / self._believed.full_v
            least = _STRENGTH_LEAST
            self.blocks.flight.strength_inv = 1.0 / (strength if strength > least else least)
            self._feel_air(strength)
        if self._offboard_wanted:
            self._try_offboard()
        if self._armed:
            s = self._look_around()
            if regular:
                self._guard(s)
            self._watch_offboard(s)
            if self._armed and self._terminated:
                self._lie_down(s, regular)
            elif self._armed:
                self._fly(s, regular)
        elif regular:
            s = self._look_around()
            self._look_at_fence(s)
            self._watch_disarmed(s)
            self._display_failures()

    def _feel_air(self, strength: float) -> None:
        f = self.blocks.flight
        self._airflow.shake(self._sensed)
        if self._pilot.flying:
            spin = strength * (f.u1 + f.u2 + f.u3 + f.u4)
            self._airflow.update(
                self._est, self._sensed, spin, self._believed, _DECIDE_EVERY * DT_NS * 1e-9
            )

    def _fly(self, s: Situation, regular: bool) -> None:
        pilot = self._pilot
        task = self._task
        if not pilot.flying:
            if self._may_lift_off(task, s):
                pilot.lift_off(s.pos_ned, s.heading_rad)
                s.flying = True
                if self.personality == "px4":
                    self._say(6, "Takeoff detected")
                self._auto_armed = True
            else:
                pilot.rest()
                self._disarm_when_due(s, regular)
                return
        if regular and self.personality == "ardupilot":
            self._align_yaw(s)
        demand = task.update(s, pilot.heading)
        if self._task is not task:
            return
        pointed = self._mode.law is None and self._mode.behaviour in _POINTED
        if self._roi_ned is not None and pointed:
            face(self._roi_ned, s, pilot.heading)
        pilot.fly(demand, s)
        if pilot.touched_down():
            self._touch_down(s)
        elif task.done:
            self._move_on(task, s)

    def _align_yaw(self, s: Situation) -> None:
        """EKF3 aligns its yaw anew, once in each flight, when the ground no longer disturbs the
        magnetometer; it runs on two IMUs."""
        if not self._yaw_aligned and s.home_ned[2] - s.pos_ned[2] > _ALIGNED_UP_M:
            self._yaw_aligned = True
            for imu in (0, 1):
                self._say(6, f"EKF3 IMU{imu} MAG0 in-flight yaw alignment complete")

    def _disarm_when_due(self, s: Situation, regular: bool) -> None:
        if regular and self._auto_disarm.due(self.parameters, self._lands_itself, s.time_ns):
            self._disarm(self._auto_disarm.words(self.parameters))

    def _lie_down(self, s: Situation, regular: bool) -> None:
        """Armed with its motors cut off; a landing that is asked for is over at once."""
        if not self._cut_off_in_air:
            self._disarm_when_due(s, regular)
        elif self._mode.behaviour is Behaviour.LAND and abs(s.v_ned[2]) < _STILL_M_S:
            self._cut_off_in_air = False
            self._touch_down(s)

    def _may_lift_off(self, task: Task, s: Situation) -> bool:
        delay_s = _ARMING_DELAY_S if self.personality == "ardupilot" else 0.0
        spool_up_ns = int((delay_s + self.parameters.si(Quantity.SPOOL_UP_S)) * 1e9)
        if s.time_ns - self._armed_ns < spool_up_ns:
            return False
        # ArduCopter's AUTO leaves the ground only once the mission was started in so many words.
        waits = task is self._mission and self.personality == "ardupilot" and not self._auto_armed
        if waits and not int(self.parameters.get("AUTO_OPTIONS")) & _TAKES_OFF_BY_ITSELF:
            return False
        return task.lifts_off(s)

    @property
    def _lands_itself(self) -> bool:
        return self._mode.behaviour in (Behaviour.LAND, Behaviour.RETURN, Behaviour.MISSION)

    def _touch_down(self, s: Situation) -> None:
        self._pilot.settle()
        self._auto_armed = False
        self._auto_disarm.on_ground(True, s.time_ns)
        if self.personality == "px4":
            self._say(6, "Landing detected")
        if self._task is self._mission:
            self._mission.touched_down()
            if self.personality == "px4" and self._mission.finished:
                self._say(6, "Mission finished, landed")

    def _move_on(self, task: Task, s: Situation) -> None:
        """PX4 goes to AUTO.LOITER after a take-off and after a mission; ArduCopter stays.

        After a take-off it holds the height where it is now.
        """
        if self.personality != "px4":
            return
        if isinstance(task, TakeOff) or task is self._mission:
            # The climb's own end takes back nothing that was asked for meanwhile.
            wanted = self._offboard_wanted
            goes_on = isinstance(task, TakeOff) and self.parameters.get("COM_TAKEOFF_ACT") == 1
            if goes_on and self._mission_ok:
                self._enter(MODES["px4"]["AUTO.MISSION"])
                return
            goal = task.target.pos_ned
            if isinstance(task, TakeOff) and goal is not None:
                goal = (goal[0], goal[1], s.pos_ned[2])
            if task is self._mission:
                self._say(6, "Mission finished, loitering")
            self._enter(MODES["px4"]["AUTO.LOITER"], Hold(goal))
            self._offboard_wanted = wanted

    # ------------------------------------------------------------------------- guards

    def _boot(self) -> None:
        stage = self.boot_stage
        for text in self._boot_sequence.texts(self._age_ns, self._field.alt_amsl_m):
            self._say(6, text)
        if self._origin is None and stage.origin and self._est.placed:
            self._origin = self._field
        if self._home_ned is None and stage.home and self._origin is not None:
            self._home_ned = (0.0, 0.0, 0.0)
            if not self._boot_sequence.real:
                ardupilot = self.personality == "ardupilot"
                self._say(6, "EKF3 IMU0 origin set" if ardupilot else "GPS fix")
            self._events.append(HomeChanged())
        if self._boot_sequence.shows_prearm(self._age_ns) and not self._armed:
            self.check_arming()

    def _try_offboard(self) -> None:
        """OFFBOARD was asked for: enter once the stream has proven itself."""
        wall_ns = self._sense().wall_ns
        if self._stream.proven(wall_ns):
            self._enter(MODES["px4"]["OFFBOARD"])
        elif not self._stream.alive(wall_ns):
            self._offboard_wanted = False
            self._say(2, "Switching to OFFBOARD is currently not available")

    def _photograph(self) -> None:
        shot = self._camera.update(self.time_ns, self.parameters.si(Quantity.EXPOSURE_S))
        if shot is None:
            return
        pos = self._sense().pos_ned
        home_d = self._home_ned[2] if self._home_ned is not None else 0.0
        self._events.append(
            ImageCaptured(
                shot.index,
                self.time_ns,
                self._projection.to_geodetic(pos),
                home_d - pos[2],
                self._attitude,
            )
        )
