"""A vehicle that is a point: it does what the policy trusts its kind to do, at the worst.

Sent a position, it flies towards that as `[pace]` says that its autopilot does, `follow_per_s` and
`follow_m_s2`, no faster than its own limit, and slows down as late as `lag_s` allows and no harder
than `[approach]`.  Told to stop, it brakes no harder than `[braking]` promises and begins no
earlier.  It gains speed far faster than any real one, and is wrong about where it is by all the
error that the policy allows.  NED, metres, seconds; one step is 20 ms.

It knows where it is from its estimate alone: what it reports is also what its guidance flies by, as
in every autopilot.

On a path of its own it brakes for the end of each leg as `[approach]` says.  Told to stop there, it
flies no farther past that end than it would have by itself, or than real ones were recorded to
(`RECORDED_HOLDS`); and one that flies away from it, sent back at speed, brakes already, and goes
on so.  That a vehicle does not brake worse when it is told to stop than it was going to by itself
is an assumption of the policy.
"""

from __future__ import annotations

import math
import random
from typing import Final

from gcs.frames import Vec3
from gcs.gate.effects import CommandKind, SendCommand
from gcs.gate.policy.policy import Pace, Policy
from gcs.gate.states import FlightMode, LandedState

STEP_NS: Final = 20_000_000
STEP_S: Final = 0.02
GAIN_M_S2: Final = 12.0
"""How fast it gains speed that a pilot or a client's velocities fly."""
TO_RETURN_UP_M: Final = 10.0
STILL: Final = 0.15
OWN_PATHS: Final = (FlightMode.TAKEOFF, FlightMode.MISSION, FlightMode.RETURN)
FORGOTTEN_S: Final = 3.0
"""ArduCopter flies no older velocity (GUID_TIMEOUT; from memory)."""
ACCEPTED, DENIED = 0, 2
RECORDED_HOLDS: Final = {"px4": (2.6, 3.1), "ardupilot": (3.0, 5.0)}
"""m/s and the metres that a real one took to stop from there, told to hold: PX4 1.14.3, ArduCopter
4.7; slower than that, it takes as much less."""
BESIDE_M: Final = 1.0
BESIDE_M_S: Final = 1.0
"""So far beside its leg, and leaving it so fast, it brakes for the end of the leg no more."""


class PointMass:
    """The truth, and what is reported of it."""

    def __init__(self, autopilot: str, policy: Policy, dice: random.Random) -> None:
        self.autopilot = autopilot
        self.policy, self.dice = policy, dice
        self.braking = policy.braking_of(autopilot)
        self.approach = policy.approach_of(autopilot)
        self.pace = policy.pace_of(autopilot)
        self.lags = (self.pace.level.lag_s, self.pace.vertical.lag_s)
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
        self._acts_s = self._acts_v_s = 0.0
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
        self.setpoint, self.velocity = pos_ned, None

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
        self.mode = mode

    def _told_to_stop(self) -> None:
        """When it begins to brake, and how hard.  One that brakes already goes on with that."""
        if self.mode in (FlightMode.HOLD, FlightMode.LAND):
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
        a = self.approach
        if self.mode not in OWN_PATHS or not self.path or self.speed_m_s <= STILL:
            return math.inf
        here, goal = self.reported(), self.path[0]
        away = (goal[0] - here[0], goal[1] - here[1])
        ahead_m = (away[0] * self.vel[0] + away[1] * self.vel[1]) / v if v > STILL else 0.0
        fast_m_s, took_m = RECORDED_HOLDS[self.autopilot]
        recorded_m = took_m * min(1.0, v / fast_m_s)
        own_m = v * a.react_s + v * v / 2.0 / a.a_brake_h_m_s2
        if ahead_m <= 0.0:  # away from its goal: it brakes already
            return max(own_m, recorded_m)
        aside_m = math.sqrt(max(0.0, math.hypot(*away) ** 2 - ahead_m**2))
        if aside_m > BESIDE_M and v * aside_m > BESIDE_M_S * math.hypot(*away):
            return math.inf
        return max(own_m, ahead_m, recorded_m)

    def takes_over(self, mode: FlightMode, v_ned: Vec3) -> None:
        """Somebody else flies it, or the vehicle does something by itself."""
        self.pilot_v = v_ned
        self._enter(mode)

    def has_no_mission(self) -> None:
        """But one that it flies, it flies on."""
        self.mission = []

    # ------------------------------------------------------------------------------ motion

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
        elif self.mode is FlightMode.GUIDED and self.setpoint is not None:
            self._follows(self.setpoint)
        elif self.path and self.mode is not FlightMode.GUIDED:
            self._flies_its_leg(self.path[0])
        elif self.mode is FlightMode.RETURN:
            self._towards_velocity((0.0, 0.0, 0.7), GAIN_M_S2, GAIN_M_S2)
        else:
            a = self.approach
            self._towards_velocity((0.0, 0.0, 0.0), a.a_brake_h_m_s2, a.a_brake_v_m_s2)

    def _follows(self, to: Vec3) -> None:
        """Towards the position that it was sent; it slows down by first order, `lags` late."""
        here, a = self.reported(), self.approach
        north, east, down = to[0] - here[0], to[1] - here[1], to[2] - here[2]
        away_m = math.hypot(north, east)
        v = min(self.cruise_m_s, _followed(away_m, self.pace.level))
        w = min(self.climb_m_s, _followed(abs(down), self.pace.vertical))
        n, e = (north / away_m, east / away_m) if away_m > 1e-9 else (0.0, 0.0)
        wanted = (n * v, e * v, math.copysign(w, down))
        level_s, vertical_s = (max(lag_s, STEP_S) for lag_s in self.lags)
        apart = math.hypot(wanted[0] - self.vel[0], wanted[1] - self.vel[1])
        ahead = n * self.vel[0] + e * self.vel[1]
        a_h = min(a.a_brake_h_m_s2, apart / level_s)
        if ahead < v and math.hypot(*self.vel[:2]) <= v:
            a_h = GAIN_M_S2
        a_v = min(a.a_brake_v_m_s2, abs(wanted[2] - self.vel[2]) / vertical_s)
        if abs(self.vel[2]) < w and self.vel[2] * down >= 0.0:
            a_v = a.a_brake_v_m_s2
        self._towards_velocity(wanted, a_h, a_v)

    def _flies_its_leg(self, goal: Vec3) -> None:
        """Straight there, as fast as it can still stop by its approach."""
        here, a = self.reported(), self.approach
        north, east, down = goal[0] - here[0], goal[1] - here[1], goal[2] - here[2]
        away_m = math.hypot(north, east)
        v = min(self.cruise_m_s, _fastest(away_m, a.react_s, a.a_brake_h_m_s2))
        if away_m < 0.3:
            v = min(v, 0.5 * away_m)
        n, e = (north / away_m, east / away_m) if away_m > 1e-9 else (0.0, 0.0)
        w = min(self.climb_m_s, _fastest(abs(down), a.react_s, a.a_brake_v_m_s2))
        faster = math.hypot(*self.vel[:2]) < v
        self._towards_velocity(
            (n * v, e * v, math.copysign(w, down)),
            GAIN_M_S2 if faster else a.a_brake_h_m_s2,
            a.a_brake_v_m_s2,
        )
        if math.dist(self.reported(), goal) < 0.4:
            self.path.pop(0)
            self.items_flown += 1
            if not self.path and self.mode in (FlightMode.TAKEOFF, FlightMode.MISSION):
                self._enter(FlightMode.HOLD)

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


def _followed(left_m: float, pace: Pace) -> float:
    """How fast its autopilot flies to a position so far away."""
    p, a = pace.follow_per_s, pace.follow_m_s2
    near_m = a / (p * p)
    return p * left_m if left_m <= near_m else math.sqrt(2.0 * a * (left_m - near_m / 2.0))
