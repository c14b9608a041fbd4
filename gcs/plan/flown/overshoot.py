"""How far a vehicle flies on past a place where it turns, or stops.

Both real autopilots slow down before a corner by how sharp it is, and come back to the next leg;
what is left grows with their speed, as with a late answer.  Recorded (`tests/real/facts`): turns of
30 to 180 degrees on legs of 10 to 113 m at 3 to 12 m/s, stops, ways onto circles and off them.
"""

from __future__ import annotations

import math
from typing import Final

from gcs.frames import Vec3
from gcs.plan.model import AutopilotName

LATE_S: Final[dict[AutopilotName, float]] = {"px4": 0.2, "ardupilot": 0.1}
"""Metres past the place for each m/s, beside `LEAST_M`: 1.3 times the worst recorded (0.15 s: PX4
at 8 m/s with 5 m/s^2; 0.075 s: ArduCopter at 9 m/s), whatever the turn, the acceleration that the
vehicle flies with, and its radius of acceptance."""
LEAST_M: Final = 0.3


def overshoot_m(autopilot: AutopilotName, speed_m_s: float) -> float:
    """At that speed of the legs; nothing of a vehicle that has none."""
    return LEAST_M + LATE_S[autopilot] * speed_m_s if speed_m_s > 0.0 else 0.0


def past(from_ned: Vec3, to_ned: Vec3, reach_m: float) -> Vec3:
    """So far behind `to_ned`, level, on the way from `from_ned`; `to_ned` where that is upright."""
    way_m = math.dist(from_ned, to_ned)
    share = reach_m / way_m if way_m > 0.0 else 0.0
    north, east, down = to_ned
    return (
        north + share * (north - from_ned[0]),
        east + share * (east - from_ned[1]),
        down,
    )


def between(a: Vec3, b: Vec3) -> Vec3:
    """From a to b."""
    return (b[0] - a[0], b[1] - a[1], b[2] - a[2])


def ahead(at: Vec3, by: Vec3, share: float) -> Vec3:
    """At `at`, and so many times `by` on."""
    return (at[0] + share * by[0], at[1] + share * by[1], at[2] + share * by[2])
