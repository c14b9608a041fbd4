"""How far its speed carries a vehicle on that is told to go another way.

A vehicle whose velocity is v, and that is to fly at V in another direction, changes its velocity
with the acceleration a along the straight line from the one to the other.  That takes |V - v| / a;
meanwhile it goes on by v |V - v| / 2a in its old direction, and the rest of its way leads towards
the new place.  So all of it lies in the hull of where it is, of that place so far ahead, and of the
new place.  The vehicle does not come back to the leg: it flies straight to that place.

This is how vehicle-sim flies.  ArduCopter and PX4 keep closer to the leg, by memory of their
sources (SCurve, PositionSmoothing).
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

from gcs.frames import Vec3

_BRAKE_SHARE = 0.6
"""Of the acceleration that a vehicle plans to brake with (vehicle-sim; an ArduCopter's corner too
leaves some of it)."""
_BEHIND_M = 0.5
"""Its speed is that of a vehicle that is so much farther away than it is thought to be."""
_REACTS_S = 1.0 / 3.0
_SLOWEST_M_S = 0.3
_SPREAD = 0.77
"""Max of 2 s (1 - s^2): see `Motion.settled_m`."""
_MORE = 1.2
"""What that law leaves out: the new direction changes too while the vehicle turns."""
_CARRY_UP_M = 4.0
"""2.5 m/s of climb and 1 m/s^2, as delivered, are 3.1 m."""
_MOST_MOVING = 12
_DIRECTIONS = 8
_SPEEDS = 4


@dataclass(frozen=True, slots=True)
class Motion:
    """How a vehicle flies its legs: metres and seconds.  At no speed nothing carries it."""

    speed_m_s: float
    accel_m_s2: float
    jerk_m_s3: float = math.inf

    def arrival_m_s(self, left_m: float) -> float:
        """How fast it is where `left_m` are left to a place where it could stop."""
        brake_m_s2 = _BRAKE_SHARE * self.accel_m_s2
        half_m_s = 2.0 * brake_m_s2 * brake_m_s2 / self.jerk_m_s3
        twice = 2.0 * brake_m_s2 * (left_m + _BEHIND_M)
        return min(self.speed_m_s, twice / (math.hypot(half_m_s, math.sqrt(twice)) + half_m_s))

    def circling_m_s(self, radius_m: float) -> float:
        """AC_Circle and vehicle-sim: half the acceleration bends the way; and a tenth more."""
        return min(self.speed_m_s, 1.1 * math.sqrt(0.5 * self.accel_m_s2 * radius_m))

    def carried_m(self, speed_m_s: float, turn_rad: float = math.pi) -> float:
        """How far on in its old direction, at that speed or less, whatever the new speed is."""
        fast, cosine = self.speed_m_s, math.cos(turn_rad)
        turned = 0.0
        for part in range(1, _SPEEDS + 1):
            slow = speed_m_s * part / _SPEEDS
            change = math.sqrt(max(0.0, fast * fast + slow * slow - 2.0 * fast * slow * cosine))
            turned = max(turned, slow * max(change, slow))
        turned_m = turned / (2.0 * self.accel_m_s2)
        return turned_m + 0.5 * speed_m_s * self.accel_m_s2 / self.jerk_m_s3

    def slowed_m_s(self, stay_s: float) -> float:
        """By how much it has become slower after a stay, which begins where it arrives."""
        brake_m_s2 = _BRAKE_SHARE * self.accel_m_s2
        return brake_m_s2 * max(0.0, stay_s - 0.5 * brake_m_s2 / self.jerk_m_s3)

    def stops_in_m(self, speed_m_s: float) -> float:
        """How far on it comes to rest (vehicle-sim)."""
        brake_m_s2 = _BRAKE_SHARE * self.accel_m_s2
        by_jerk_m = speed_m_s * self.accel_m_s2 / self.jerk_m_s3
        return speed_m_s * (speed_m_s / (2.0 * brake_m_s2) + _REACTS_S) + by_jerk_m

    @property
    def settled_m(self) -> float:
        """After a leg of this length nothing is left of an old direction.

        A turn by the angle t at the speed V takes 2 V sin(t / 2) / a, at cos(t / 2)^2 V along the
        leg on average: V^2 / a times 2 s (1 - s^2), which is 0.77 at the most.
        """
        return _SPREAD * self.speed_m_s * self.speed_m_s / self.accel_m_s2


@dataclass(frozen=True, slots=True)
class Moving:
    """A vehicle that is at `pos_ned` and moves along `way` (a unit vector; longer in `all_round`).

    `onward_ned`: only where it goes on to there; None: wherever it goes on to.  `height_left_m`
    is how much of its climb is left, which has a goal of its own; None: not known.
    """

    pos_ned: Vec3
    way: Vec3
    speed_m_s: float
    onward_ned: Vec3 | None = None
    height_left_m: float | None = None

    def carried(self, motion: Motion, aim_ned: Vec3 | None) -> Vec3:
        """Where its speed would carry it before it moves to `aim_ned` alone; None: to any place."""
        there = self.pos_ned
        # The place is seen under a wider angle from there, by which the turn grows on the way.
        for _ in range(2):
            turn_rad = math.pi if aim_ned is None else _angle(self.way, between(there, aim_ned))
            reach_m = _MORE * motion.carried_m(self.speed_m_s, turn_rad)
            there = ahead(self.pos_ned, self.way, reach_m)
        return self._no_higher(there)

    def stopped(self, motion: Motion) -> Vec3:
        """Where it comes to rest."""
        return self._no_higher(ahead(self.pos_ned, self.way, motion.stops_in_m(self.speed_m_s)))

    def _no_higher(self, there: Vec3) -> Vec3:
        climb_m = self.pos_ned[2] - there[2]
        most_m = _CARRY_UP_M if self.height_left_m is None else abs(self.height_left_m)
        return (*there[:2], self.pos_ned[2] - max(-most_m, min(most_m, climb_m)))


def moving(pos_ned: Vec3, from_ned: Vec3, to_ned: Vec3, speed_m_s: float) -> tuple[Moving, ...]:
    """One that moves as from `from_ned` to `to_ned`; () where it hardly moves."""
    way = between(from_ned, to_ned)
    size = math.hypot(*way)
    if size == 0.0 or speed_m_s < _SLOWEST_M_S:
        return ()
    n, e, d = (round(part / size, 2) for part in way)
    left_m = round(abs(to_ned[2] - pos_ned[2]), 1)
    return (Moving(pos_ned, (n, e, d), round(speed_m_s, 1), height_left_m=left_m),)


def still_moving(
    found: tuple[Moving, ...], motion: Motion, leg_m: float, to_ned: Vec3
) -> tuple[Moving, ...]:
    """What a leg of `leg_m` leaves of the old directions, at its end `to_ned`."""
    if not found or motion.settled_m <= 0.0:
        return ()
    left = min(1.0, max(0.0, 1.0 - leg_m / motion.settled_m))
    later = (
        replace(one, pos_ned=to_ned, speed_m_s=round(left * one.speed_m_s, 1), onward_ned=None)
        for one in found
    )
    kept = tuple(dict.fromkeys(one for one in later if one.speed_m_s >= _SLOWEST_M_S))
    if len(kept) <= _MOST_MOVING:
        return kept
    fastest = max(one.speed_m_s for one in kept)
    return all_round(to_ned, fastest)


def not_stopped(found: tuple[Moving, ...], slowed_m_s: float) -> tuple[Moving, ...]:
    """Without those that are at rest when they have become so much slower."""
    return tuple(one for one in found if one.speed_m_s - slowed_m_s >= _SLOWEST_M_S)


def all_round(pos_ned: Vec3, speed_m_s: float) -> tuple[Moving, ...]:
    """One that may move in any level direction: `way` reaches to an octagon about the circle."""
    wider = 1.0 / math.cos(math.pi / _DIRECTIONS)
    angles = (2.0 * math.pi * n / _DIRECTIONS for n in range(_DIRECTIONS))
    return tuple(
        Moving(pos_ned, (wider * math.cos(a), wider * math.sin(a), 0.0), round(speed_m_s, 1))
        for a in angles
    )


def between(a: Vec3, b: Vec3) -> Vec3:
    return (b[0] - a[0], b[1] - a[1], b[2] - a[2])


def ahead(at: Vec3, by: Vec3, share: float) -> Vec3:
    return (at[0] + share * by[0], at[1] + share * by[1], at[2] + share * by[2])


def _angle(u: Vec3, v: Vec3) -> float:
    size = math.hypot(*u) * math.hypot(*v)
    if size == 0.0:
        return math.pi
    return math.acos(max(-1.0, min(1.0, sum(x * y for x, y in zip(u, v, strict=True)) / size)))
