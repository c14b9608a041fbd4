"""Where a vehicle comes to rest: d = v t_react + v^2 / (2 a_brake) + position error + margin.

Horizontal and vertical are computed apart, because a multirotor brakes them apart.  The first two
terms are the way that it travels, along its velocity; the last two are a distance to keep in every
direction.

Two sets of figures: the policy's braking, what a hold takes from the command on, and its approach,
what a vehicle takes that slows down by itself for a goal it was sent.  `predicted_stop` chooses.

A vehicle that is outside the box round its verified mission slows down for nothing that is known.

What a vehicle slows down for is its goal and nothing that stands before it.  A leg is clear of
everything at all heights between those of its ends; what the vehicle flies towards above or below
those is judged by its braking.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TypeAlias, assert_never

from gcs.frames import Vec3
from gcs.gate.airspace.mission_box import MissionBox
from gcs.gate.policy.policy import Approach, Braking, Overshoot, Policy


@dataclass(frozen=True, slots=True)
class Leg:
    """The vehicle flies straight to a goal that was accepted from where it was then.

    One that hovers is on the leg from where it hovers to the same place.
    """

    from_ned: Vec3
    goal_ned: Vec3


@dataclass(frozen=True, slots=True)
class OwnPath:
    """The vehicle flies a path of its own that was verified: a take-off, mission or return.

    `within` is where that path is; None where it is not known so.
    """

    within: MissionBox | None = None


Path: TypeAlias = Leg | OwnPath | None
"""What the vehicle flies; None: nothing that it would slow down for by itself."""


@dataclass(frozen=True, slots=True)
class Stops:
    """All that one autopilot's stops are predicted by."""

    braking: Braking
    approach: Approach
    overshoot: Overshoot


def stops_of(policy: Policy, autopilot: str) -> Stops:
    """The policy's figures for an autopilot."""
    return Stops(
        policy.braking_of(autopilot), policy.approach_of(autopilot), policy.overshoot_of(autopilot)
    )


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


def stop_point(pos_ned: Vec3, v_ned: Vec3, braking: Braking | Approach) -> Vec3:
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


def predicted_stop(pos_ned: Vec3, v_ned: Vec3, path: Path, stops: Stops) -> Vec3:
    """Where the vehicle comes to rest: by its approach where it slows down for a goal of its own,
    else by its braking.  On a leg, horizontal and vertical are decided apart.  Above or below both
    ends of the leg it is braked for what is before the goal, but not for what is behind it."""
    held_ned = stop_point(pos_ned, v_ned, stops.braking)
    own_ned = stop_point(pos_ned, v_ned, stops.approach)
    match path:
        case None:
            return held_ned
        case OwnPath(within):
            on_path = within is None or within.holds(pos_ned)
            return own_ned if on_path else held_ned
        case Leg():
            north, east, _ = held_ned
            if _along_leg(own_ned, v_ned, path, stops):
                north, east, _ = own_ned
                if not _at_a_height_of_leg(own_ned, path, stops):
                    north, east = _no_farther_than_goal(pos_ned, own_ned, held_ned, path)
            down = (own_ned if _between_heights(own_ned, v_ned, path, stops) else held_ned)[2]
            return (north, east, down)
        case _:
            assert_never(path)


def _at_a_height_of_leg(stop_ned: Vec3, leg: Leg, stops: Stops) -> bool:
    """Is the stop between the heights of the leg's ends, but for the error of its position?"""
    error_m = stops.braking.position_error_v_m
    low, high = sorted((leg.from_ned[2], leg.goal_ned[2]))
    return low - error_m <= stop_ned[2] <= high + error_m


def _no_farther_than_goal(pos: Vec3, own: Vec3, held: Vec3, leg: Leg) -> tuple[float, float]:
    """The own stop, and on from there along the leg: as far as a hold takes, or to the goal."""
    leg_n, leg_e = leg.goal_ned[0] - leg.from_ned[0], leg.goal_ned[1] - leg.from_ned[1]
    leg_m = math.hypot(leg_n, leg_e)
    n, e = (leg_n / leg_m, leg_e / leg_m) if leg_m > 0.0 else (0.0, 0.0)
    left_m = (leg.goal_ned[0] - own[0]) * n + (leg.goal_ned[1] - own[1]) * e
    more_m = math.dist(pos[:2], held[:2]) - math.dist(pos[:2], own[:2])
    on_m = max(0.0, min(left_m, more_m))
    return (own[0] + on_m * n, own[1] + on_m * e)


def _along_leg(stop_ned: Vec3, v_ned: Vec3, leg: Leg, stops: Stops) -> bool:
    """Horizontally: is the stop on the leg or its overshoot, and the velocity along it?"""
    approach, overshoot = stops.approach, stops.overshoot
    leg_n, leg_e = leg.goal_ned[0] - leg.from_ned[0], leg.goal_ned[1] - leg.from_ned[1]
    leg_m = math.hypot(leg_n, leg_e)
    n, e = (leg_n / leg_m, leg_e / leg_m) if leg_m > 0.0 else (0.0, 0.0)
    stop_n, stop_e = stop_ned[0] - leg.from_ned[0], stop_ned[1] - leg.from_ned[1]
    along_m = stop_n * n + stop_e * e
    beside_m = math.hypot(stop_n - along_m * n, stop_e - along_m * e)
    ahead_m_s = max(0.0, v_ned[0] * n + v_ned[1] * e)
    aside_m_s = math.hypot(v_ned[0] - ahead_m_s * n, v_ned[1] - ahead_m_s * e)
    past_m = min(overshoot.share_h * leg_m, overshoot.most_h_m)
    return (
        beside_m <= approach.cross_track_m
        and -approach.cross_track_m <= along_m <= leg_m + past_m + approach.cross_track_m
        and aside_m_s <= approach.cross_track_m_s
    )


def _between_heights(stop_ned: Vec3, v_ned: Vec3, leg: Leg, stops: Stops) -> bool:
    """Vertically: is the stop between the ends of the leg, or its overshoot, and the velocity
    towards the goal?"""
    approach = stops.approach
    past_down = overshoot_point(leg.from_ned, leg.goal_ned, stops.overshoot)[2]
    low, high = sorted((leg.from_ned[2], past_down))
    within = low - approach.cross_track_m <= stop_ned[2] <= high + approach.cross_track_m
    towards = (leg.goal_ned[2] - leg.from_ned[2]) * v_ned[2] > 0.0
    return within and (towards or abs(v_ned[2]) <= approach.cross_track_m_s)
