"""What a pilot, a leader or an eye for something asks of a vehicle, beside its own flights.

Sticks act when they come: a gesture arms, a moved stick takes over, a switch changes the mode.
"""

from __future__ import annotations

from math import isfinite

from vehicle_sim.autopilot.interface import AttitudeGoal, Geodetic, Orbiting, OrbitRequest, Result
from vehicle_sim.autopilot.manual.stick_gestures import Gesture
from vehicle_sim.autopilot.mode_changes import ModeChanges
from vehicle_sim.autopilot.modes import MODES, Behaviour, by_number
from vehicle_sim.autopilot.tasks.follow import Sighting
from vehicle_sim.autopilot.tasks.orbit import Nose, Orbit, Round, px4_round
from vehicle_sim.numerics.vectors import Vec3

_AUTO_BIT, _OFFBOARD_BIT = 1, 2  # COM_RC_OVERRIDE
_DEFAULT_ORBIT_M = 1.0
_DEFAULT_ORBIT_M_S = 1.0


class ManualInput(ModeChanges):
    """Sticks, circles, leaders, regions of interest."""

    # ----------------------------------------------------------------------------- sticks

    @property
    def channels_us(self) -> tuple[int, ...]:
        return self._radio.channels_us(self._sense().wall_ns)

    @property
    def sticks(self) -> tuple[float, float, float, float] | None:
        now = self._radio.sticks(self._sense().wall_ns)
        return None if now is None else (now.roll, now.pitch, now.yaw, now.throttle)

    def joystick(self, forward: int, right: int, up: int, clockwise: int, wall_ns: int) -> None:
        self._radio.joystick(forward, right, up, clockwise, wall_ns)
        self._heed(wall_ns)

    def override_channels(self, channels_us: tuple[int, ...], wall_ns: int) -> None:
        self._radio.override(channels_us, wall_ns)
        self._heed(wall_ns)

    def _heed(self, wall_ns: int) -> None:
        if self.personality == "ardupilot":
            number = self._gestures.mode(self._radio, wall_ns)
            mode = None if number is None else by_number("ardupilot", number)
            if mode is not None and mode is not self._mode:
                self._change_mode(mode)
        hand = self._radio.sticks(wall_ns)
        if hand is None:
            return
        match self._gestures.seen(hand, wall_ns):
            case Gesture.ARM if self._mode.law is not None and not self._armed:
                self.arm(False)
            case Gesture.DISARM if self._armed and not self._pilot.flying:
                self.disarm(False)
            case _:
                pass
        if self.personality == "px4" and self._gestures.takes_over(hand):
            self._take_over()
        if self._armed:
            self._poke()

    def _take_over(self) -> None:
        """PX4's COM_RC_OVERRIDE: a moved stick ends an automatic flight."""
        if not self._pilot.flying or self._mode.law is not None:
            return
        guided = self._mode.behaviour is Behaviour.GUIDED
        bit = _OFFBOARD_BIT if guided else _AUTO_BIT
        allowed = int(self.parameters.get("COM_RC_OVERRIDE")) & bit
        if allowed and self._mode.behaviour is not Behaviour.ORBIT:
            self._say(6, "Pilot took over using sticks")
            self._enter_kind("position" if self._position_ok else "altitude")

    # ------------------------------------------------------------------ circles, interest

    @property
    def orbiting(self) -> Orbiting | None:
        """What ORBIT_EXECUTION_STATUS tells; PX4's Orbit mode alone does."""
        task = self._task
        if isinstance(task, Orbit) and self._mode.behaviour is Behaviour.ORBIT:
            return task.status
        return None

    def orbit(self, asked: OrbitRequest) -> Result:
        if self.personality != "px4":
            return Result.UNSUPPORTED
        if not self._position_ok:
            return Result.TEMPORARILY_REJECTED
        s = self._look_around()
        task = self._task
        now = task.round if isinstance(task, Orbit) else None
        if now is None:
            now = Round(s.stop_ned, _DEFAULT_ORBIT_M, _DEFAULT_ORBIT_M_S, Nose.TO_CENTRE)
        way = 1.0 if now.speed_m_s >= 0.0 else -1.0
        north, east = now.centre_ned[:2] if asked.centre_ne is None else asked.centre_ne
        down = now.centre_ned[2] if asked.down_m is None else asked.down_m
        nose = now.nose
        if asked.nose is not None and asked.nose in (0, 1, 2, 3, 4):
            nose = Nose(asked.nose)
        wanted = px4_round(
            self.parameters,
            (north, east, down),
            asked.radius_m if asked.radius_m is not None else way * now.radius_m,
            asked.speed_m_s if asked.speed_m_s is not None else abs(now.speed_m_s),
            nose,
        )
        if wanted is None:
            self._say(2, "Orbit radius limit exceeded")
            return Result.DENIED
        if isinstance(task, Orbit):
            task.change(wanted, s)
        else:
            circle = Orbit(lambda s: wanted, self.parameters, self._radio)
            self._enter(MODES["px4"]["POSCTL.ORBIT"], circle)
        self._poke()
        return Result.ACCEPTED

    def look_at(self, where_ned: Vec3 | None) -> Result:
        if where_ned is not None and not all(map(isfinite, where_ned)):
            return Result.DENIED
        self._roi_ned = where_ned
        self._poke()
        return Result.ACCEPTED

    def hear_leader(
        self, system: int, where: Geodetic, v_ned: Vec3, heading_rad: float | None, wall_ns: int
    ) -> None:
        if self._origin is None or not all(map(isfinite, v_ned)):
            return
        pos_ned = self._projection.to_local(where)
        self._leader.heard(Sighting(system, pos_ned, v_ned, heading_rad, wall_ns))

    # ----------------------------------------------------------------------------- telling

    @property
    def attitude_goal(self) -> AttitudeGoal | None:
        f = self.blocks.flight
        if not f.flying:
            return None
        full_n = 4.0 * self._believed.thrust_max_n
        return AttitudeGoal(
            (f.sp_w, f.sp_x, f.sp_y, f.sp_z),
            (f.rate_sp_x, f.rate_sp_y, f.rate_sp_z),
            min(1.0, f.collective_n / full_n),
        )
