"""The velocity that takes a vehicle to its circle and round it, made anew at every tick.

First straight to the nearest point of the circle and to its height, never faster than it can stop
there by the policy's braking, so that every such sample leaves room for its stop.  Then along the
tangent, with a correction towards the circle and towards its height.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final

from gcs.frames import Vec3
from gcs.gate.airspace.stream_samples import sample_counts_s
from gcs.gate.policy.policy import Braking, StreamRules
from gcs.orbit.circle import BELOW, Nose, Orbit

NEAR_H_M: Final = 1.0
NEAR_V_M: Final = 0.5
"""So near to the point where it begins, and its height, the circle is flown."""
APPROACH_M_S: Final = 5.0
CLIMB_M_S: Final = 2.0
DESCEND_M_S: Final = 1.0
GAINS_M_S2: Final = 1.0
"""The speed on the circle grows by this."""
TO_CIRCLE_PER_S: Final = 0.7
"""Of the distance from the circle, as a speed towards it."""
LEARNS_PER_S2: Final = 0.15
"""What stays of that distance is learnt as one more speed towards the circle, such as that of a
vehicle that lags more (PX4: 1.7 m outside 50 m at 10 m/s without it)."""
MOST_LEARNT: Final = 0.25
"""Of the speed."""
MOST_ACROSS: Final = 0.5
"""Of the speed may be across the circle."""
LAG_S: Final = 0.3
"""A vehicle has the velocity asked for so much later (vehicle-sim): what is asked for is the
tangent where it will be then."""


@dataclass(frozen=True, slots=True)
class Place:
    """How the vehicle was reported, `age_s` ago."""

    pos_ned: Vec3
    v_ned: Vec3
    age_s: float

    @property
    def now_ned(self) -> Vec3:
        """Where it is by now."""
        north, east, down = (
            x + v * self.age_s for x, v in zip(self.pos_ned, self.v_ned, strict=True)
        )
        return (north, east, down)


@dataclass(frozen=True, slots=True)
class Setpoint:
    """What is to be flown until the next one; a heading of None is the autopilot's."""

    v_ned: Vec3
    yaw_rad: float | None


def speed_to_rest(left_m: float, held_s: float, a_m_s2: float) -> float:
    """The speed from which the vehicle rests within `left_m`, if it flies on for `held_s` and then
    brakes: v held + v^2 / (2 a) = left."""
    return a_m_s2 * (math.sqrt(held_s * held_s + 2.0 * left_m / a_m_s2) - held_s)


class Guidance:
    """Of one vehicle on one orbit."""

    __slots__ = (
        "_bearing_rad",
        "_braking",
        "_entry_ned",
        "_learnt_m_s",
        "_rules",
        "_speed_m_s",
        "orbit",
        "swept_rad",
    )

    def __init__(self, orbit: Orbit, pos_ned: Vec3, braking: Braking, rules: StreamRules) -> None:
        self.orbit = orbit
        self.swept_rad = 0.0
        """Of the circle, in the direction of flight."""
        self._braking = braking
        self._rules = rules
        self._entry_ned: Vec3 | None = orbit.entry_ned(pos_ned)
        """None: it is on its circle."""
        self._bearing_rad = 0.0
        self._speed_m_s = 0.0
        self._learnt_m_s = 0.0
        """Outward."""

    @property
    def circling(self) -> bool:
        """It has come to the circle."""
        return self._entry_ned is None

    @property
    def done(self) -> bool:
        """All of it was flown."""
        turn_rad = self.orbit.turn_rad
        return turn_rad is not None and self.swept_rad >= turn_rad

    def step(self, place: Place, dt_s: float) -> Setpoint:
        """The next sample, `dt_s` after the one before."""
        here = place.now_ned
        down_m_s = self._towards_height(here, place.age_s)
        bearing_rad = self.orbit.bearing_rad(here)
        if self._entry_ned is not None:
            north, east = self._entry_ned[0] - here[0], self._entry_ned[1] - here[1]
            left_m = math.hypot(north, east)
            if left_m > NEAR_H_M or abs(self.orbit.centre_ned[2] - here[2]) > NEAR_V_M:
                return self._approach(north, east, left_m, down_m_s, place.age_s, bearing_rad)
            self._entry_ned, self._bearing_rad = None, bearing_rad
            # One that flies round already, such as on the orbit before, goes on at its speed.
            north_m_s, east_m_s, _ = place.v_ned
            along_m_s = east_m_s * math.cos(bearing_rad) - north_m_s * math.sin(bearing_rad)
            self._speed_m_s = max(0.0, self.orbit.way * along_m_s)
        turned_rad = math.remainder(bearing_rad - self._bearing_rad, math.tau)
        self.swept_rad += self.orbit.way * turned_rad
        self._bearing_rad = bearing_rad
        self._speed_m_s = min(self.orbit.speed_m_s, self._speed_m_s + GAINS_M_S2 * dt_s)
        return self._circle(here, bearing_rad, down_m_s, dt_s)

    def _approach(
        self,
        north_m: float,
        east_m: float,
        left_m: float,
        down_m_s: float,
        age_s: float,
        bearing_rad: float,
    ) -> Setpoint:
        fastest_m_s = min(APPROACH_M_S, self._rules.max_speed_h_m_s * BELOW)
        rests_m_s = speed_to_rest(left_m, self._held_s(age_s), self._braking.a_brake_h_m_s2)
        per_metre = min(fastest_m_s, rests_m_s) / left_m if left_m > 0.0 else 0.0
        # Along: as if it was at its entry already.
        yaw_rad = self._yaw(bearing_rad)
        return Setpoint((north_m * per_metre, east_m * per_metre, down_m_s), yaw_rad)

    def _circle(self, here: Vec3, bearing_rad: float, down_m_s: float, dt_s: float) -> Setpoint:
        orbit, speed_m_s = self.orbit, self._speed_m_s
        away_m = math.hypot(here[0] - orbit.centre_ned[0], here[1] - orbit.centre_ned[1])
        left_m = orbit.radius_m - away_m
        self._learnt_m_s = _within(
            MOST_LEARNT * speed_m_s, self._learnt_m_s + LEARNS_PER_S2 * left_m * dt_s
        )
        outward_m_s = _within(MOST_ACROSS * speed_m_s, TO_CIRCLE_PER_S * left_m + self._learnt_m_s)
        along_m_s = math.sqrt(speed_m_s * speed_m_s - outward_m_s * outward_m_s)
        ahead_rad = bearing_rad + orbit.way * LAG_S * speed_m_s / orbit.radius_m
        cos, sin = math.cos(ahead_rad), math.sin(ahead_rad)
        north_m_s = outward_m_s * cos - orbit.way * along_m_s * sin
        east_m_s = outward_m_s * sin + orbit.way * along_m_s * cos
        return Setpoint((north_m_s, east_m_s, down_m_s), self._yaw(bearing_rad))

    def _towards_height(self, here: Vec3, age_s: float) -> float:
        left_m = self.orbit.centre_ned[2] - here[2]
        rests_m_s = speed_to_rest(abs(left_m), self._held_s(age_s), self._braking.a_brake_v_m_s2)
        if left_m > 0.0:
            return min(rests_m_s, DESCEND_M_S, self._rules.max_speed_down_m_s * BELOW)
        return -min(rests_m_s, CLIMB_M_S, self._rules.max_speed_up_m_s * BELOW)

    def _held_s(self, age_s: float) -> float:
        """How long it may fly on by a sample that is followed by a hold."""
        return sample_counts_s(age_s, self._rules) + self._braking.react_s

    def _yaw(self, bearing_rad: float) -> float | None:
        match self.orbit.nose:
            case Nose.CENTRE:
                return math.remainder(bearing_rad + math.pi, math.tau)
            case Nose.ALONG:
                return math.remainder(bearing_rad + self.orbit.way * 0.5 * math.pi, math.tau)
            case Nose.INITIAL:
                return self.orbit.heading_rad
            case Nose.FREE:
                return None


def _within(most: float, value: float) -> float:
    return max(-most, min(most, value))
