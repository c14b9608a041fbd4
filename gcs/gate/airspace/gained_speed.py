"""How fast a vehicle may be that flies to a goal and still gains speed.

Its velocity is reported late, and a hold acts later still; `[braking] react_s` is all of that
time.  On its leg this does no harm: the leg is clear to its end, and the vehicle slows down for it.
But what is asked for instead begins with a stop, from the speed that it has gained by then:

    v + a_gain react_s

and no more than the speed from which it can still stop for its goal by its approach.  Horizontal
alone: vertically the vehicle reaches its few m/s within a metre.
"""

from __future__ import annotations

import math

from gcs.frames import Vec3
from gcs.gate.airspace.stopping import Leg, Stops, overshoot_point


def gained_velocity(pos_ned: Vec3, v_ned: Vec3, leg: Leg, stops: Stops) -> Vec3 | None:
    """The velocity, in m/s towards the goal, that the vehicle may have when a hold acts; None
    where that is none but the reported one."""
    past_ned = overshoot_point(leg.from_ned, leg.goal_ned, stops.overshoot)
    north, east = past_ned[0] - pos_ned[0], past_ned[1] - pos_ned[1]
    away_m, speed_m_s = math.hypot(north, east), math.hypot(v_ned[0], v_ned[1])
    approach = stops.approach
    most_m_s = speed_to_stop_within(away_m, approach.react_s, approach.a_brake_h_m_s2)
    fast_m_s = min(most_m_s, speed_m_s + approach.a_gain_h_m_s2 * stops.braking.react_s)
    if fast_m_s <= speed_m_s:
        return None
    return (north / away_m * fast_m_s, east / away_m * fast_m_s, v_ned[2])


def speed_to_stop_within(distance_m: float, react_s: float, a_brake_m_s2: float) -> float:
    """The v of v t_react + v^2 / (2 a_brake) = distance."""
    return a_brake_m_s2 * (math.sqrt(react_s * react_s + 2.0 * distance_m / a_brake_m_s2) - react_s)
