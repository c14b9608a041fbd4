"""The flown items of a mission: where each goes, and when it is over."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from math import inf, sqrt
from typing import Protocol

from vehicle_sim.autopilot.control.demands import Demand, FlyTo, Situation, Task, Turner
from vehicle_sim.autopilot.interface import Landed, Target
from vehicle_sim.autopilot.parameters.parameters import Parameters
from vehicle_sim.autopilot.tasks.tasks import Land, TakeOff, distance
from vehicle_sim.control_loops.trajectory import MotionLimits
from vehicle_sim.numerics.vectors import Vec3

_OVER_M = 1.0  # "over the landing place"
_AT_HEIGHT_M = 0.3
_NEARLY_M = 0.5


class Leg(Protocol):
    """One flown item, while it is flown."""

    @property
    def landed_word(self) -> Landed: ...
    @property
    def target(self) -> Target: ...
    def done(self, s: Situation) -> bool:
        """Asked once before each `update`."""
        ...

    def update(self, s: Situation, turner: Turner) -> Demand: ...


@dataclass(slots=True, eq=False, repr=False)
class Whole:
    """A task that is an item by itself."""

    _task: Task

    @property
    def landed_word(self) -> Landed:
        return self._task.landed_word

    @property
    def target(self) -> Target:
        return self._task.target

    def done(self, s: Situation) -> bool:
        return self._task.done

    def update(self, s: Situation, turner: Turner) -> Demand:
        return self._task.update(s, turner)


@dataclass(slots=True, eq=False, repr=False)
class Go:
    """To a place, and there for `stay_s` (infinite = for ever) once within `accept_m`."""

    landed_word = Landed.IN_AIR

    _place_ned: Vec3
    _accept_m: float
    _stay_s: float
    _until_ns: int | None = field(default=None, init=False)

    @property
    def target(self) -> Target:
        return Target(self._place_ned, None, None)

    def done(self, s: Situation) -> bool:
        if self._stay_s == inf:
            return False
        if self._until_ns is None:
            if distance(s.pos_ned, self._place_ned) >= self._accept_m:
                return False
            self._until_ns = s.time_ns + int(self._stay_s * 1e9)
        return s.time_ns >= self._until_ns

    def update(self, s: Situation, turner: Turner) -> Demand:
        if self._stay_s > 0.0:
            return FlyTo(self._place_ned, s.limits)
        left_m = distance(s.pos_ned, self._place_ned) - self._accept_m
        return FlyTo(self._place_ned, slowed_for_a_turn(s.limits, self._accept_m, left_m))


def slowed_for_a_turn(limits: MotionLimits, accept_m: float, left_m: float) -> MotionLimits:
    """So slow where it turns (`left_m` is 0) that it does not go on by more than `accept_m` in its
    old direction, whatever the new one is.

    A velocity v that becomes V, along a straight line and with the acceleration a, carries it on
    by v |V - v| / 2a.  Both real autopilots slow down for their turns, too (recorded).
    """
    fast, accel = limits.speed_m_s, limits.accel_m_s2
    turns_m_s = 0.5 * (sqrt(fast * fast + 8.0 * accel * (accept_m + _NEARLY_M)) - fast)
    slow_m_s = sqrt(turns_m_s * turns_m_s + accel * max(0.0, left_m))
    return replace(limits, speed_m_s=min(fast, slow_m_s))


class GoToHeight:
    """LOITER_TO_ALT: at the present height over the place, then up or down there."""

    landed_word = Landed.IN_AIR

    __slots__ = ("_over_ned", "_place_ned", "_there")

    def __init__(self, place_ned: Vec3, from_d: float) -> None:
        self._place_ned = place_ned
        self._over_ned: Vec3 = (place_ned[0], place_ned[1], from_d)
        self._there = False

    @property
    def target(self) -> Target:
        return Target(self._place_ned if self._there else self._over_ned, None, None)

    def done(self, s: Situation) -> bool:
        if not self._there:
            self._there = distance(s.pos_ned, self._over_ned) < _OVER_M
            return False
        return abs(s.pos_ned[2] - self._place_ned[2]) < _AT_HEIGHT_M

    def update(self, s: Situation, turner: Turner) -> Demand:
        return FlyTo(self._place_ned if self._there else self._over_ned, s.limits)


@dataclass(slots=True, eq=False, repr=False)
class GoAndLand:
    """At the present height over the place, then down; the land detector ends it."""

    _parameters: Parameters
    _over_ned: Vec3
    _land: Land | None = field(default=None, init=False)

    @property
    def landed_word(self) -> Landed:
        return Landed.IN_AIR if self._land is None else Landed.LANDING

    @property
    def target(self) -> Target:
        return Target(self._over_ned, None, None)

    def done(self, s: Situation) -> bool:
        if self._land is None and distance(s.pos_ned, self._over_ned) < _OVER_M:
            self._land = Land(self._parameters, self._over_ned)
        return False

    def update(self, s: Situation, turner: Turner) -> Demand:
        if self._land is not None:
            return self._land.update(s, turner)
        return FlyTo(self._over_ned, s.limits)


@dataclass(slots=True, eq=False, repr=False)
class Rise:
    """A take-off; then to the item's own place, where the personality goes there (PX4)."""

    _take_off: TakeOff
    _go: Go | None
    _up: bool = field(default=False, init=False)

    @property
    def landed_word(self) -> Landed:
        return self._take_off.landed_word

    @property
    def target(self) -> Target:
        if self._up and self._go is not None:
            return self._go.target
        return self._take_off.target

    def done(self, s: Situation) -> bool:
        self._up = self._take_off.done
        return self._up and (self._go is None or self._go.done(s))

    def update(self, s: Situation, turner: Turner) -> Demand:
        if self._up and self._go is not None:
            return self._go.update(s, turner)
        return self._take_off.update(s, turner)
