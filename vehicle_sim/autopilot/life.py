"""What the vehicle does by itself: boots, flies its mode's task, lands, disarms, fails safe.

Everything runs on simulated time, counted in steps; only what measures the other side
(setpoint and ground-station silence) runs on wall time.
"""

from __future__ import annotations

from vehicle_sim.autopilot.core import DT_NS, DT_S
from vehicle_sim.autopilot.demands import Situation, Task
from vehicle_sim.autopilot.interface import HomeChanged, ImageCaptured
from vehicle_sim.autopilot.modes import MODES, Behaviour
from vehicle_sim.autopilot.parameters import Quantity
from vehicle_sim.autopilot.tasks import Hold, TakeOff
from vehicle_sim.autopilot.watch import Watch
from vehicle_sim.model import sensors

_OUTER_EVERY = 5  # 50 Hz
_OUTER_S = DT_S * _OUTER_EVERY
_SLOW_EVERY = 25  # 10 Hz
_FIX_NS = 400_000_000


class Life(Watch):
    """Time passes."""

    @property
    def dt_ns(self) -> int:
        return DT_NS

    def step(self) -> None:
        """Advance everything by `dt_ns`."""
        self._step = count = self._step + 1
        if count % _OUTER_EVERY == 0:
            self._navigate(count)
        quad = self._quad
        pilot = self._pilot
        control = pilot.control
        if pilot.flying:
            control.inner(quad.body)
        quad.step(control.u1, control.u2, control.u3, control.u4)
        if count % sensors.EVERY == 0:
            self._sensors.wander(count)

    def _navigate(self, count: int) -> None:
        slow = count % _SLOW_EVERY == 0
        if slow:
            self._boot()
            strength = self._quad.battery.strength
            self._pilot.control.strength_inv = 1.0 / strength if strength > 0.5 else 2.0
        if self._offboard_wanted:
            self._try_offboard()
        if self._armed:
            s = self._look_around()
            if slow:
                self._guard(s)
            self._watch_offboard(s)
            if self._armed:
                self._fly(s, slow)
        if self._camera.busy:
            self._photograph()

    def _fly(self, s: Situation, slow: bool) -> None:
        pilot = self._pilot
        task = self._task
        if not pilot.flying:
            if self._may_lift_off(task, s):
                pilot.lift_off(s.pos_ned, s.heading_rad)
                s.flying = True
                self._auto_armed = True
            else:
                pilot.rest()
                if slow and self._auto_disarm.due(self.parameters, self._lands_itself, s.time_ns):
                    self._disarm("Disarmed by auto disarm")
                return
        demand = task.update(s, pilot.heading)
        if self._task is not task:
            return
        pilot.fly(demand, s, _OUTER_S)
        if pilot.touched_down(s, _OUTER_S):
            self._touch_down(s)
        elif task.done:
            self._move_on(task)

    def _may_lift_off(self, task: Task, s: Situation) -> bool:
        if not task.lifts_off(s):
            return False
        # ArduCopter's AUTO leaves the ground only once the mission was started in so many words.
        return task is not self._mission or self.personality == "px4" or self._auto_armed

    @property
    def _lands_itself(self) -> bool:
        return self._mode.behaviour in (Behaviour.LAND, Behaviour.RETURN, Behaviour.MISSION)

    def _touch_down(self, s: Situation) -> None:
        self._pilot.settle()
        self._auto_armed = False
        self._auto_disarm.on_ground(True, s.time_ns)
        self._say(6, "Landing detected")
        if self._task is self._mission:
            self._mission.touched_down()

    def _move_on(self, task: Task) -> None:
        """PX4 goes to AUTO.LOITER after a take-off and after a mission; ArduCopter stays."""
        if self.personality != "px4":
            return
        if isinstance(task, TakeOff) or task is self._mission:
            # The climb's own end takes back nothing that was asked for meanwhile.
            wanted = self._offboard_wanted
            self._enter(MODES["px4"]["AUTO.LOITER"], Hold(task.target.pos_ned))
            self._offboard_wanted = wanted

    # ------------------------------------------------------------------------- guards

    def _boot(self) -> None:
        since_ns = self.time_ns - self._boot_ns
        if self._origin is None and since_ns >= _FIX_NS:
            self._origin = self._field
            self._home_ned = (0.0, 0.0, 0.0)
            self._say(6, "EKF3 IMU0 origin set" if self.personality == "ardupilot" else "GPS fix")
            self._events.append(HomeChanged())

    def _try_offboard(self) -> None:
        """OFFBOARD was asked for: enter once the stream has proven itself."""
        wall_ns = self._sense().wall_ns
        if self._stream.proven(wall_ns):
            self._enter(MODES["px4"]["OFFBOARD"])
        elif not self._stream.alive(wall_ns):
            self._offboard_wanted = False
            self._say(4, "Offboard refused: setpoint stream lost")

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
                self._sensors.attitude(self._quad.body),
            )
        )
