"""What an orbit is, and how one is made of what was asked for.

MAVLink's DO_ORBIT leaves what is not given to the vehicle: the circle that is flown already, else
its defaults.  Here they are: about the place where the vehicle is, as high as it is,
DEFAULT_RADIUS_M and DEFAULT_SPEED_M_S, with the nose to the centre, until something else is asked
for.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import Enum
from typing import Final

from gcs.enu_text import fixed
from gcs.frames import Vec3
from gcs.gate.policy.policy import StreamRules
from gcs.gate.refusal import Code, Refusal

DEFAULT_RADIUS_M: Final = 10.0
"""CIRCLE_RADIUS_M of ArduCopter 4.7, as recorded."""
DEFAULT_SPEED_M_S: Final = 1.0
"""PX4's Orbit mode without a speed (from memory of FlightTaskOrbit)."""
LEAST_RADIUS_M: Final = 2.0
MOST_RADIUS_M: Final = 1000.0
"""PX4's MC_ORBIT_RAD_MAX, as recorded."""
CENTRIPETAL_M_S2: Final = 2.0
"""A circle is flown no faster than this bends the way into it: PX4's own figure (from memory of
FlightTaskOrbit), and a tilt of 12 degrees."""
BELOW: Final = 1.0 - 1e-6
"""Rounding to the wire's float32 must not take a speed beyond the policy's most."""


class Nose(Enum):
    """Where the vehicle's nose points on its way: ORBIT_YAW_BEHAVIOUR."""

    CENTRE = "centre"
    INITIAL = "initial"
    FREE = "free"
    ALONG = "along"


@dataclass(frozen=True, slots=True)
class Asked:
    """An orbit as it was asked for; None is not given.

    `centre_enu` may have parts that are not given: east and north together, or up.  A positive
    radius is clockwise, seen from above; `turns` 0 is until something else is asked for.
    """

    centre_enu: tuple[float | None, float | None, float | None] | None = None
    radius_m: float | None = None
    speed_m_s: float | None = None
    turns: float | None = None
    nose: Nose | None = None


@dataclass(frozen=True, slots=True)
class Orbit:
    """A level circle in local NED.  `way` is 1 clockwise and -1 counter-clockwise, seen from above;
    `turn_rad` is how far it is flown, None for ever; `heading_rad` is the nose's when it was asked
    for."""

    centre_ned: Vec3
    radius_m: float
    way: int
    speed_m_s: float
    turn_rad: float | None
    nose: Nose
    heading_rad: float | None

    def point_ned(self, bearing_rad: float) -> Vec3:
        """Of the circle, seen from its centre; clockwise from north."""
        north, east, down = self.centre_ned
        return (
            north + self.radius_m * math.cos(bearing_rad),
            east + self.radius_m * math.sin(bearing_rad),
            down,
        )

    def bearing_rad(self, pos_ned: Vec3) -> float:
        """Of a place, from the centre; of the centre itself the nose's heading, as every point of
        the circle is as near."""
        north, east = pos_ned[0] - self.centre_ned[0], pos_ned[1] - self.centre_ned[1]
        if math.hypot(north, east) < 0.01:
            return self.heading_rad or 0.0
        return math.atan2(east, north)

    def entry_ned(self, pos_ned: Vec3) -> Vec3:
        """The nearest point of the circle."""
        return self.point_ned(self.bearing_rad(pos_ned))


def orbit_of(
    asked: Asked, pos_ned: Vec3, heading_rad: float | None, before: Orbit | None, rules: StreamRules
) -> Orbit | Refusal:
    """What is to be flown; `before` is the orbit that is flown already."""
    radius_m = asked.radius_m
    if radius_m is None:
        radius_m = DEFAULT_RADIUS_M if before is None else before.way * before.radius_m
    speed_m_s = asked.speed_m_s
    if speed_m_s is None:
        speed_m_s = DEFAULT_SPEED_M_S if before is None else before.speed_m_s
    turns = asked.turns
    if turns is None:
        known = before is not None and before.turn_rad is not None
        turns = before.turn_rad / math.tau if known and before and before.turn_rad else 0.0
    centre_ned = _centre_ned(asked, pos_ned, before)
    if isinstance(centre_ned, Refusal):
        return centre_ned
    refusal = _bad_number(radius_m, speed_m_s, turns)
    if refusal is not None:
        return refusal
    fastest_m_s = min(
        rules.max_speed_h_m_s * BELOW,
        math.sqrt(min(CENTRIPETAL_M_S2, rules.max_a_m_s2) * abs(radius_m)),
    )
    if asked.speed_m_s is not None and speed_m_s > fastest_m_s / BELOW:
        numbers = (("speed_m_s", speed_m_s), ("max_speed_m_s", fastest_m_s), ("radius_m", radius_m))
        sentence = (
            f"{fixed(speed_m_s, 1)} m/s: a circle of {fixed(abs(radius_m), 1)} m and the policy "
            f"allow no more than {fixed(fastest_m_s, 1)} m/s"
        )
        return Refusal(Code.POLICY, sentence, numbers)
    nose = asked.nose or (before.nose if before is not None else Nose.CENTRE)
    return Orbit(
        centre_ned,
        abs(radius_m),
        1 if radius_m > 0.0 else -1,
        min(speed_m_s, fastest_m_s),
        turns * math.tau if turns > 0.0 else None,
        nose,
        heading_rad,
    )


def _centre_ned(asked: Asked, pos_ned: Vec3, before: Orbit | None) -> Vec3 | Refusal:
    """What is not given is the centre that is flown about, else the place; the height where the
    vehicle is."""
    east, north, up = asked.centre_enu or (None, None, None)
    flat = pos_ned if before is None else before.centre_ned
    if (east is None) != (north is None):
        return Refusal(Code.NON_FINITE, "a centre has east and north, or neither")
    return (
        flat[0] if north is None else north,
        flat[1] if east is None else east,
        pos_ned[2] if up is None else -up,
    )


def _bad_number(radius_m: float, speed_m_s: float, turns: float) -> Refusal | None:
    if not all(map(math.isfinite, (radius_m, speed_m_s, turns))):
        return Refusal(Code.NON_FINITE, "an orbit with a number that is not finite")
    if not LEAST_RADIUS_M <= abs(radius_m) <= MOST_RADIUS_M:
        sentence = (
            f"a circle of {fixed(abs(radius_m), 1)} m: it has {fixed(LEAST_RADIUS_M, 0)} to "
            f"{fixed(MOST_RADIUS_M, 0)} m"
        )
        return Refusal(Code.UNSUPPORTED, sentence, (("radius_m", radius_m),))
    if speed_m_s <= 0.0:
        sentence = "an orbit has a speed above 0; the sign of the radius is its direction"
        return Refusal(Code.UNSUPPORTED, sentence, (("speed_m_s", speed_m_s),))
    if turns < 0.0:
        sentence = "an orbit has no negative turns; the sign of the radius is its direction"
        return Refusal(Code.UNSUPPORTED, sentence, (("turns", turns),))
    return None
