"""The stopping distance: d = v t_react + v^2 / (2 a_brake) + position error + margin.

Horizontal and vertical are computed apart, because a multirotor brakes them apart.  The first two
terms are the way that it travels, along its velocity; the last two are a distance to keep in every
direction.
"""

from __future__ import annotations

import math

from gcs.frames import Vec3
from gcs.gate.policy.policy import Braking, Overshoot


def travel_m(speed_m_s: float, react_s: float, a_brake_m_s2: float) -> float:
    """v t_react + v^2 / (2 a_brake) in metres: never negative, never less for a larger |v|."""
    v = abs(speed_m_s)
    return v * react_s + v * v / (2.0 * a_brake_m_s2)


def distance_h_m(v_ned: Vec3, braking: Braking, margin_m: float) -> float:
    """The stopping distance d, horizontally, in metres."""
    travel = travel_m(math.hypot(v_ned[0], v_ned[1]), braking.react_s, braking.a_brake_h_m_s2)
    return travel + braking.position_error_h_m + margin_m


def distance_v_m(v_ned: Vec3, braking: Braking, margin_m: float) -> float:
    """The stopping distance d, vertically, in metres."""
    travel = travel_m(v_ned[2], braking.react_s, braking.a_brake_v_m_s2)
    return travel + braking.position_error_v_m + margin_m


def stop_point(pos_ned: Vec3, v_ned: Vec3, braking: Braking) -> Vec3:
    """Where the vehicle would stop if it were told to now: its position plus the way it travels."""
    north, east, down = v_ned
    speed_h = math.hypot(north, east)
    run_h = travel_m(speed_h, braking.react_s, braking.a_brake_h_m_s2)
    per_speed = run_h / speed_h if speed_h > 0.0 else 0.0
    run_v = math.copysign(travel_m(down, braking.react_s, braking.a_brake_v_m_s2), down)
    return (pos_ned[0] + north * per_speed, pos_ned[1] + east * per_speed, pos_ned[2] + run_v)


def overshoot_point(pos_ned: Vec3, goal_ned: Vec3, overshoot: Overshoot) -> Vec3:
    """How far the vehicle may fly past a goal, straight on from its leg."""
    north, east, down = (goal - pos for pos, goal in zip(pos_ned, goal_ned, strict=True))
    leg_h = math.hypot(north, east)
    past_h = min(overshoot.share_h * leg_h, overshoot.most_h_m)
    per_metre = past_h / leg_h if leg_h > 0.0 else 0.0
    past_v = math.copysign(min(overshoot.share_v * abs(down), overshoot.most_v_m), down)
    return (
        goal_ned[0] + north * per_metre,
        goal_ned[1] + east * per_metre,
        goal_ned[2] + past_v,
    )
