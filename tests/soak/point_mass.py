"""A vehicle that is a point: it does what the policy trusts its kind to do, at the worst.

It gains speed far faster than any real one, brakes no harder than `[braking]` and `[approach]`
promise and begins no earlier, flies past its goals by most of `[overshoot]`, and reports where it
is with all the error that the policy allows.  NED, metres, seconds; one step is 20 ms.

Its own guidance brakes as `[approach]` says.  In hold mode it brakes as `[braking]` says, but for
one case: told to hold while its guidance slows down for a goal, it brakes no worse than that.
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
"""How fast it gains speed."""
TO_RETURN_UP_M: Final = 10.0
STILL: Final = 0.15
FORGOTTEN_S: Final = 3.0
"""ArduCopter flies no older velocity (GUID_TIMEOUT; from memory)."""
ACCEPTED, DENIED = 0, 2


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
        self.path: list[Vec3] = []
        self.items_flown = 0
        self.pilot_v: Vec3 = (0.0, 0.0, 0.0)
        self.hold_react_s = 0.0
        self.stubborn = False
        self.now_s = 0.0
        self._leg_from: Vec3 = (0.0, 0.0, 0.0)
        self._acts_s = 0.0
        self._stopping = False
        self._brakes_as: tuple[float, float] = (self.braking.a_brake_h_m_s2, 0.0)
        self._bearing = dice.uniform(0.0, math.tau)

    # --------------------------------------------------------------------------- reports

    def reported(self) -> Vec3:
        """Its position with all of the error that the policy allows, in a bearing that turns."""
        b = self.braking
        self._bearing += 0.004
        h = 0.99 * b.position_error_h_m
        v = 0.99 * b.position_error_v_m * math.sin(1.7 * self._bearing)
        airborne = self.landed is not LandedState.ON_GROUND
        return (
            self.pos[0] + h * math.cos(self._bearing),
            self.pos[1] + h * math.sin(self._bearing),
            self.pos[2] + (v if airborne else 0.0),
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
        streamed, self.velocity = self.velocity is not None, None
        if self.setpoint != pos_ned or streamed:
            self._leg_from = self.at
            self.setpoint = pos_ned
            if self.mode is FlightMode.GUIDED:
                self._stops_first()

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
                self.path = [(self.pos[0], self.pos[1], self.pos[2] - sent.up_m)]
                if self.autopilot == "px4":
                    self._enter(FlightMode.TAKEOFF)
                else:
                    self.setpoint, self.setpoint_s = self.path[0], 1e12
                    self._leg_from = self.at
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
                up_m = max(TO_RETURN_UP_M, -self.pos[2])
                over = (self.pos[0], self.pos[1], -up_m)
                self.path = [over, (0.0, 0.0, -up_m)]
                self._enter(FlightMode.RETURN)
            case CommandKind.START_MISSION:
                if not self.path:
                    return DENIED
                self._enter(FlightMode.MISSION)
            case CommandKind.PHOTO | CommandKind.SET_MODE:
                pass
        return ACCEPTED

    def _enter(self, mode: FlightMode) -> None:
        """Hold mode brakes after the time that the promise leaves it, and as it promises."""
        if mode is FlightMode.HOLD and self.mode is not FlightMode.HOLD:
            own = self.mode is not FlightMode.OTHER and self._slows_down()
            self._acts_s = self.now_s + (0.0 if own else max(0.0, self.hold_react_s))
            figures = self.approach if own else self.braking
            self._brakes_as = (figures.a_brake_h_m_s2, figures.a_brake_v_m_s2)
        if mode is not FlightMode.HOLD:
            self._leg_from = self.at
        if mode is FlightMode.GUIDED and self.mode is not mode:
            self._stops_first()
        self.mode = mode

    def _stops_first(self) -> None:
        """Sent elsewhere at speed, it stops as it would in hold mode before it flies there."""
        if self.speed_m_s > STILL:
            self._stopping = True
            self._acts_s = self.now_s + max(0.0, self.hold_react_s)

    def _slows_down(self) -> bool:
        """Is it on its way to a goal, so that it has kept its speed for stopping there?"""
        if self.velocity is not None or self._stopping:
            return False
        return self._goal() is not None and self.speed_m_s > STILL

    def takes_over(self, mode: FlightMode, v_ned: Vec3) -> None:
        """Somebody else flies it, or the vehicle does something by itself."""
        self.pilot_v = v_ned
        self._enter(mode)

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
        if not self.armed:
            self.vel = [0.0, 0.0, 0.0]
            self._falls()
            return
        match self.mode:
            case FlightMode.OTHER:
                self._towards_velocity(self.pilot_v, GAIN_M_S2, GAIN_M_S2)
            case FlightMode.HOLD:
                if self.now_s >= self._acts_s:
                    self._towards_velocity((0.0, 0.0, 0.0), *self._brakes_as)
            case FlightMode.LAND:
                self._towards_velocity((0.0, 0.0, 0.7), *self._brakes_as)
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
        near = math.dist(self.pos, goal) < 0.4
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
        a, o = self.approach, self.overshoot
        if self._stopping:
            b = self.braking
            if self.now_s >= self._acts_s:
                self._towards_velocity((0.0, 0.0, 0.0), b.a_brake_h_m_s2, b.a_brake_v_m_s2)
            self._stopping = self.speed_m_s > STILL
            return
        north, east = goal[0] - self.pos[0], goal[1] - self.pos[1]
        away_m = math.hypot(north, east)
        leg_m = math.dist(self._leg_from[:2], goal[:2])
        past_m = min(o.share_h * leg_m, o.most_h_m) if self.mode is FlightMode.GUIDED else 0.0
        v = min(self.cruise_m_s, _fastest(away_m + 0.9 * past_m, a.react_s, a.a_brake_h_m_s2))
        if away_m < 0.3:
            v = min(v, 0.5 * away_m)
        n, e = (north / away_m, east / away_m) if away_m > 1e-9 else (0.0, 0.0)
        down = goal[2] - self.pos[2]
        w = min(self.climb_m_s, _fastest(abs(down), a.react_s, a.a_brake_v_m_s2))
        wanted = (n * v, e * v, math.copysign(w, down))
        faster = math.hypot(*self.vel[:2]) < v
        self._towards_velocity(
            wanted, GAIN_M_S2 if faster else a.a_brake_h_m_s2, max(a.a_brake_v_m_s2, 0.1)
        )

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
