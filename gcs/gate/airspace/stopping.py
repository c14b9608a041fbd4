"""Where a vehicle comes to rest: d = v t_react + v^2 / (2 a_brake) + position error + margin.

Horizontal and vertical are computed apart, because a multirotor brakes them apart.  The first two
terms are the way that it travels, along its velocity; the last two are a distance to keep in every
direction.

Two sets of figures: the policy's braking, what a hold takes from the command on, and its approach,
what a vehicle takes that slows down by itself, for a position that it is sent or on a path of its
own.  A vehicle that is outside the box round its verified mission slows down for nothing that is
known.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import Enum
from typing import TypeAlias, assert_never

from gcs.frames import Vec3
from gcs.gate.airspace.mission_box import MissionBox
from gcs.gate.policy.policy import Approach, Braking, Overshoot, Policy


class StopBy(Enum):
    """How a vehicle comes to rest; the values are parts of names and sentences."""

    HOLD = "hold"  # it is told its hold mode
    SETPOINT = "setpoint"  # it is sent a position at which to stop, then told its hold mode
    ITSELF = "itself"  # on a path of its own


@dataclass(frozen=True, slots=True)
class Setpoints:
    """The vehicle flies to the positions that it is sent."""


@dataclass(frozen=True, slots=True)
class OwnPath:
    """The vehicle flies a path of its own that was verified: a take-off, mission or return.

    `within` is where that path is; None where it is not known so.
    """

    within: MissionBox | None = None


@dataclass(frozen=True, slots=True)
class OnWayBack:
    """The vehicle is outside, and is sent to a verified place inside."""

    to_ned: Vec3


Path: TypeAlias = Setpoints | OwnPath | OnWayBack | None
"""What the vehicle flies; None: nothing that it would slow down for by itself."""


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


def stop_point(
    pos_ned: Vec3, v_ned: Vec3, braking: Braking | Approach, late_s: float = 0.0
) -> Vec3:
    """Where the vehicle would stop if it were told to now: its position plus the way it travels.

    It hears of it `late_s` later, too: the position is as old.
    """
    north, east, down = v_ned
    speed_h, react_s = math.hypot(north, east), braking.react_s + late_s
    run_h = travel_m(speed_h, react_s, braking.a_brake_h_m_s2)
    per_speed = run_h / speed_h if speed_h > 0.0 else 0.0
    run_v = math.copysign(travel_m(down, react_s, braking.a_brake_v_m_s2), down)
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


def ways_to_stop(
    pos_ned: Vec3, v_ned: Vec3, path: Path, policy: Policy, autopilot: str, late_s: float = 0.0
) -> tuple[tuple[StopBy, Vec3], ...]:
    """How the vehicle on this path can come to rest, and where: the first of them is the usual one.

    One that follows setpoints is slowed down by them at every tick; its hold mode is the other way.
    """
    held = (StopBy.HOLD, stop_point(pos_ned, v_ned, policy.braking_of(autopilot), late_s))
    own_ned = stop_point(pos_ned, v_ned, policy.approach_of(autopilot), late_s)
    match path:
        case None | OnWayBack():
            return (held,)
        case OwnPath(within):
            on_path = within is None or within.holds(pos_ned)
            return ((StopBy.ITSELF, own_ned),) if on_path else (held,)
        case Setpoints():
            return (held, (StopBy.SETPOINT, own_ned))
        case _:
            assert_never(path)
