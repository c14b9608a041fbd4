"""A vehicle that is a point: it does what the policy trusts its kind to do, at the worst.

It gains speed on its way to a goal as fast as `[approach]` says, else far faster than any real one,
brakes no harder than `[braking]` and `[approach]` promise and begins no earlier, flies past its
goals by most of `[overshoot]`, and is wrong about where it is by all the error that the policy
allows.  NED, metres, seconds; one step is 20 ms.

It knows where it is from its estimate alone: what it reports is also what its guidance flies by, as
in every autopilot.  `[approach]` and `[overshoot]` were recorded in such positions.

Its own guidance brakes as `[approach]` says.  Told to stop, by hold mode or by a landing, it
brakes as `[braking]` says, but for two cases: on its way to a goal it flies no farther past that
than it would have by itself, or than real ones were recorded to (`RECORDED_HOLDS`); and one that
flies away from its goal, sent back at speed, brakes already, and goes on so.  That a vehicle does
not brake worse when it is told to stop than it was going to by itself is an assumption of the
policy; it is recorded up to 3 m/s.
"""

from __future__ import annotations

import math
import random
from typing import Final

from gcs.frames import Vec3
from gcs.gate.effects import CommandKind, SendCommand
from gcs.gate.policy.policy import Policy
from gcs.gate.states import FlightMode, LandedState

STEP_NS: Final = 20_000_000
STEP_S: Final = 0.02
GAIN_M_S2: Final = 12.0
"""How fast it gains speed that a pilot or a client's velocities fly."""
TO_RETURN_UP_M: Final = 10.0
STILL: Final = 0.15
FORGOTTEN_S: Final = 3.0
"""ArduCopter flies no older velocity (GUID_TIMEOUT; from memory)."""
ACCEPTED, DENIED = 0, 2
RECORDED_HOLDS: Final = {"px4": (2.6, 3.1), "ardupilot": (3.0, 5.0)}
"""m/s and the metres that a real one took to stop from there, told to hold: PX4 1.14.3, ArduCopter
4.7; see `[braking]` in gcs/gate/policy/default.toml."""


class PointMass:
    """The truth, and what is reported of it."""

    def __init__(self, autopilot: str, policy: Policy, dice: random.Random) -> None:
        self.autopilot = autopilot
        self.policy, self.dice = policy, dice
        self.braking = policy.braking_of(autopilot)
        self.approach = policy.approach_of(autopilot)
        self.overshoot = policy.overshoot_of(autopilot)
        self.cruise_m_s = dice.choice((1.0, 3.0, 5.0, 12.0))
        self.climb_m_s = dice.choice((0.7, 1.5, 3.0))
        self.pos: list[float] = [0.0, 0.0, 0.0]
        self.vel: list[float] = [0.0, 0.0, 0.0]
        self.mode = FlightMode.HOLD
        self.armed = False
        self.landed = LandedState.ON_GROUND
        self.failsafe = False
        self.setpoint: Vec3 | None = None
        self.velocity: Vec3 | None = None
        self.setpoint_s = -9.0
        self.mission: list[Vec3] = []
        """What is on board; `path` is what is left of what it flies by itself."""
        self.path: list[Vec3] = []
        self.home_ned: Vec3 = (0.0, 0.0, 0.0)
        """Where a return leads; as it tells it."""
        self.items_flown = 0
        self.pilot_v: Vec3 = (0.0, 0.0, 0.0)
        self.hold_react_s = 0.0
        self.stubborn = False
        self.now_s = 0.0
        self._leg_from: Vec3 = (0.0, 0.0, 0.0)
        self._acts_s = self._acts_v_s = 0.0
        self._stopping = False
        self._brakes_as = (self.braking.a_brake_h_m_s2, self.braking.a_brake_v_m_s2)
        self._bearing = dice.uniform(0.0, math.tau)
        self._error: Vec3 = (0.0, 0.0, 0.0)
        self._estimates()

    # --------------------------------------------------------------------------- reports

    def reported(self) -> Vec3:
        """Its estimate: the truth with all of the error that the policy allows."""
        north, east, down = self._error
        return (self.pos[0] + north, self.pos[1] + east, self.pos[2] + down)

    def _estimates(self) -> None:
        """The error has a bearing, which turns.  On the ground there is none in height."""
        b = self.braking
        self._bearing += 0.004
        h = 0.99 * b.position_error_h_m
        v = 0.99 * b.position_error_v_m * math.sin(1.7 * self._bearing)
        airborne = self.landed is not LandedState.ON_GROUND
        self._error = (
            h * math.cos(self._bearing),
            h * math.sin(self._bearing),
            v if airborne else 0.0,
        )

    @property
    def at(self) -> Vec3:
        return (self.pos[0], self.pos[1], self.pos[2])

    @property
    def speed_m_s(self) -> float:
        return math.hypot(*self.vel)

    # -------------------------------------------------------------------------- commands

    def hears_setpoint(self, pos_ned: Vec3 | None, v_ned: Vec3 | None) -> None:
        """A position wins over the velocity beside it; without either nothing changes."""
        self.setpoint_s = self.now_s
        if pos_ned is None:
            self.velocity = v_ned
            return
        streamed = self.velocity is not None
        if self.setpoint != pos_ned or streamed:
            if self.mode is FlightMode.GUIDED:
                self._stops_first()
            self._leg_from = self.reported()
            self.setpoint = pos_ned
        self.velocity = None

    def hears_command(self, sent: SendCommand) -> int:
        """MAV_RESULT.  A stubborn vehicle refuses all but to stop: that it does is promised."""
        kind = sent.kind
        if self.stubborn and kind is not CommandKind.HOLD:
            return DENIED
        match kind:
            case CommandKind.ARM:
                if self.landed is not LandedState.ON_GROUND:
                    return DENIED
                self.armed = True
            case CommandKind.DISARM:
                if self.landed is not LandedState.ON_GROUND:
                    return DENIED
                self.armed = False
            case CommandKind.FORCE_DISARM:
                self.armed = False
            case CommandKind.TAKE_OFF:
                if not self.armed:
                    return DENIED
                north, east, down = self.reported()
                self.path = [(north, east, down - sent.up_m)]
                if self.autopilot == "px4":
                    self._enter(FlightMode.TAKEOFF)
                else:
                    self.setpoint, self.setpoint_s = self.path[0], 1e12
                    self._leg_from = self.reported()
                    self._enter(FlightMode.GUIDED)
            case CommandKind.GUIDED:
                stale = self.now_s - self.setpoint_s > 0.5
                if self.autopilot == "px4" and stale:
                    return DENIED
                if stale:
                    self.setpoint = None
                self._enter(FlightMode.GUIDED)
            case CommandKind.HOLD:
                self._enter(FlightMode.HOLD)
            case CommandKind.LAND:
                self._enter(FlightMode.LAND)
            case CommandKind.RETURN:
                north, east, down = self.reported()
                up_m = max(TO_RETURN_UP_M, -down)
                self.path = [(north, east, -up_m), (*self.home_ned[:2], -up_m)]
                self._enter(FlightMode.RETURN)
            case CommandKind.START_MISSION:
                if not self.mission:
                    return DENIED
                if self.mode is not FlightMode.MISSION:
                    self.path = list(self.mission)
                self._enter(FlightMode.MISSION)
            case CommandKind.PHOTO | CommandKind.SET_MODE:
                pass
        return ACCEPTED

    def _enter(self, mode: FlightMode) -> None:
        if mode is self.mode:
            return
        if mode in (FlightMode.HOLD, FlightMode.LAND):
            self._told_to_stop()
        self._stopping = False
        if mode is not FlightMode.HOLD:
            self._leg_from = self.reported()
        if mode is FlightMode.GUIDED:
            self._stops_first()
        self.mode = mode

    def _told_to_stop(self) -> None:
        """When it begins to brake, and how hard.  One that brakes already goes on with that."""
        if self.mode in (FlightMode.HOLD, FlightMode.LAND) or self._stopping:
            return
        b, v = self.braking, math.hypot(*self.vel[:2])
        self._acts_s = self._acts_v_s = self.now_s + max(0.0, self.hold_react_s)
        self._brakes_as = (b.a_brake_h_m_s2, b.a_brake_v_m_s2)
        room_m = self._room_to_stop_m(v)
        held_m = v * max(0.0, self.hold_react_s) + v * v / 2.0 / b.a_brake_h_m_s2
        if room_m < held_m:  # then it goes on for longer, level, and brakes harder
            a = self.approach
            brakes_m = v * v / 2.0 / a.a_brake_h_m_s2
            self._acts_s = self.now_s + max(0.0, (room_m - brakes_m) / v)
            self._brakes_as = (a.a_brake_h_m_s2, a.a_brake_v_m_s2)

    def _room_to_stop_m(self, v: float) -> float:
        """So far it flies at the most, level, until it rests, told to at `v` m/s."""
        goal, a = self._goal(), self.approach
        if self.mode is FlightMode.OTHER or goal is None or not self._slows_down():
            return math.inf
        here = self.reported()
        away = (goal[0] - here[0], goal[1] - here[1])
        ahead_m = (away[0] * self.vel[0] + away[1] * self.vel[1]) / v if v > STILL else 0.0
        own_m = v * a.react_s + v * v / 2.0 / a.a_brake_h_m_s2
        if ahead_m <= 0.0:  # away from its goal: it brakes already
            return max(own_m, self._recorded_m(v))
        aside_m = math.sqrt(max(0.0, math.hypot(*away) ** 2 - ahead_m**2))
        if aside_m > a.cross_track_m and v * aside_m > a.cross_track_m_s * math.hypot(*away):
            return math.inf
        return max(own_m, ahead_m + 0.9 * self._past_m(goal), self._recorded_m(v))

    def _recorded_m(self, v: float) -> float:
        fast_m_s, took_m = RECORDED_HOLDS[self.autopilot]
        react_s, v = self.braking.react_s, min(v, fast_m_s)
        a_m_s2 = fast_m_s * fast_m_s / 2.0 / (took_m - fast_m_s * react_s)
        return v * react_s + v * v / 2.0 / a_m_s2

    def _past_m(self, goal: Vec3) -> float:
        """How far it may fly past a goal."""
        if self.mode is not FlightMode.GUIDED:
            return 0.0
        leg_m = math.dist(self._leg_from[:2], goal[:2])
        return min(self.overshoot.share_h * leg_m, self.overshoot.most_h_m)

    def _stops_first(self) -> None:
        """Sent elsewhere at speed, it stops as it would in hold mode before it flies there."""
        if self.speed_m_s > STILL:
            self._told_to_stop()
            self._stopping = True

    def _slows_down(self) -> bool:
        """Is it on its way to a goal, so that it has kept its speed for stopping there?"""
        if self.velocity is not None or self._stopping:
            return False
        return self._goal() is not None and self.speed_m_s > STILL

    def takes_over(self, mode: FlightMode, v_ned: Vec3) -> None:
        """Somebody else flies it, or the vehicle does something by itself."""
        self.pilot_v = v_ned
        self._enter(mode)

    def has_no_mission(self) -> None:
        """But one that it flies, it flies on."""
        self.mission = []

    # ------------------------------------------------------------------------------ motion

    def _goal(self) -> Vec3 | None:
        match self.mode:
            case FlightMode.GUIDED:
                return self.setpoint
            case FlightMode.TAKEOFF | FlightMode.MISSION | FlightMode.RETURN:
                return self.path[0] if self.path else None
            case _:
                return None

    def step(self) -> None:
        """20 ms."""
        self.now_s += STEP_S
        self._estimates()
        if not self.armed:
            self.vel = [0.0, 0.0, 0.0]
            self._falls()
            return
        match self.mode:
            case FlightMode.OTHER:
                self._towards_velocity(self.pilot_v, GAIN_M_S2, GAIN_M_S2)
            case FlightMode.HOLD | FlightMode.LAND:
                self._brakes(0.0 if self.mode is FlightMode.HOLD else 0.7)
            case _:
                self._flies_its_path()
        guided_px4 = self.mode is FlightMode.GUIDED and self.autopilot == "px4"
        if guided_px4 and self.now_s - self.setpoint_s > 1.0:
            self.failsafe = True
            self._enter(FlightMode.HOLD)
        for axis in range(3):
            self.pos[axis] += self.vel[axis] * STEP_S
        self._meets_the_ground()

    def _flies_its_path(self) -> None:
        if self.mode is FlightMode.GUIDED and self.velocity is not None:
            b = self.braking
            if self.now_s - self.setpoint_s > FORGOTTEN_S:
                self.velocity = (0.0, 0.0, 0.0)
            slower = math.hypot(*self.velocity[:2]) < math.hypot(*self.vel[:2])
            a_h = b.a_brake_h_m_s2 if slower else GAIN_M_S2
            self._towards_velocity(self.velocity, a_h, b.a_brake_v_m_s2)
            self._stopping = False
            return
        goal = self._goal()
        if goal is None:
            if self.mode is FlightMode.RETURN:
                self._towards_velocity((0.0, 0.0, 0.7), GAIN_M_S2, GAIN_M_S2)
            else:
                a = self.approach
                self._towards_velocity((0.0, 0.0, 0.0), a.a_brake_h_m_s2, a.a_brake_v_m_s2)
            return
        self._fly_to(goal)
        near = math.dist(self.reported(), goal) < 0.4
        if near and self.mode is not FlightMode.GUIDED:
            self.path.pop(0)
            self.items_flown += 1
            self._leg_from = goal
            if not self.path and self.mode is FlightMode.TAKEOFF:
                self._enter(FlightMode.HOLD)
            if not self.path and self.mode is FlightMode.MISSION:
                self._enter(FlightMode.HOLD)

    def _fly_to(self, goal: Vec3) -> None:
        """Straight there, as fast as it can still stop, a little behind it, by its approach."""
        a = self.approach
        if self._stopping:
            self._brakes(0.0)
            self._stopping = self.speed_m_s > STILL
            return
        here = self.reported()
        north, east = goal[0] - here[0], goal[1] - here[1]
        away_m = math.hypot(north, east)
        past_m = 0.9 * self._past_m(goal)
        v = min(self.cruise_m_s, _fastest(away_m + past_m, a.react_s, a.a_brake_h_m_s2))
        if away_m < 0.3:
            v = min(v, 0.5 * away_m)
        n, e = (north / away_m, east / away_m) if away_m > 1e-9 else (0.0, 0.0)
        down = goal[2] - here[2]
        w = min(self.climb_m_s, _fastest(abs(down), a.react_s, a.a_brake_v_m_s2))
        wanted = (n * v, e * v, math.copysign(w, down))
        faster = math.hypot(*self.vel[:2]) < v
        self._towards_velocity(
            wanted, a.a_gain_h_m_s2 if faster else a.a_brake_h_m_s2, max(a.a_brake_v_m_s2, 0.1)
        )

    def _brakes(self, down_m_s: float) -> None:
        """As it was told to, level and vertically each from its own time on."""
        a_h, a_v = self._brakes_as
        level = a_h if self.now_s >= self._acts_s else 0.0
        upright = a_v if self.now_s >= self._acts_v_s else 0.0
        self._towards_velocity((0.0, 0.0, down_m_s), level, upright)

    def _towards_velocity(self, wanted: Vec3, a_h: float, a_v: float) -> None:
        """Changes the velocity by no more than the accelerations, horizontally as a vector."""
        north, east = wanted[0] - self.vel[0], wanted[1] - self.vel[1]
        change, most = math.hypot(north, east), a_h * STEP_S
        part = 1.0 if change <= most else most / change
        self.vel[0] += north * part
        self.vel[1] += east * part
        down = wanted[2] - self.vel[2]
        self.vel[2] += max(-a_v * STEP_S, min(a_v * STEP_S, down))

    def _meets_the_ground(self) -> None:
        if self.pos[2] < -0.3:
            self.landed = LandedState.IN_AIR
            return
        if self.pos[2] >= 0.0:
            self.pos[2] = 0.0
            self.vel[2] = min(0.0, self.vel[2])
        if self.pos[2] > -0.05 and self.mode in (FlightMode.LAND, FlightMode.RETURN):
            self.landed = LandedState.ON_GROUND
            self.vel = [0.0, 0.0, 0.0]
            if self.dice.random() < 0.02:
                self.armed = False

    def _falls(self) -> None:
        if self.pos[2] < 0.0:
            self.pos[2] = min(0.0, self.pos[2] + 10.0 * STEP_S)
        else:
            self.landed = LandedState.ON_GROUND


def _fastest(distance_m: float, react_s: float, a_m_s2: float) -> float:
    """The speed from which it stops within the distance: v react + v^2 / 2a."""
    return a_m_s2 * (math.sqrt(react_s * react_s + 2.0 * distance_m / a_m_s2) - react_s)
