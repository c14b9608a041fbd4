"""May the vehicle fly straight to a goal, or climb straight up?"""

from __future__ import annotations

import math
from collections.abc import Sequence

from gcs.enu_text import place
from gcs.frames import Vec3
from gcs.gate.airspace.bounds import Bounds, Cleared, beyond_reach, clearance_numbers
from gcs.gate.airspace.explain import metres
from gcs.gate.airspace.prediction import (
    bad_overshoot,
    cannot_stop,
    cannot_stop_gained,
    stopping_numbers,
)
from gcs.gate.airspace.stopping import Path
from gcs.gate.refusal import Code, Refusal


def goal(
    bounds: Bounds,
    goal_ned: Vec3,
    yaw_rad: float | None,
    pos_ned: Vec3,
    v_ned: Vec3,
    path: Path = None,
    gained_ned: Sequence[Vec3] = (),
) -> Cleared | Refusal:
    """May the vehicle at `pos_ned`, moving at `v_ned`, fly straight to `goal_ned`?

    `path` is the leg to that goal, where it is flown already; `gained_ned` are velocities that
    the vehicle may have as well, on its way to somewhere else.

    In this order: finite, altitude, distance, zones, leg, overshoot, stopping distance.
    """
    yaw = () if yaw_rad is None else (yaw_rad,)
    refusal = bounds.unusable(goal=goal_ned, yaw=yaw, position=pos_ned, velocity=v_ned)
    if refusal is not None:
        return refusal
    judge, there = bounds.judge, place(goal_ned)
    overshoot = bounds.policy.overshoot_of(bounds.autopilot)
    refusal = (
        bounds.beyond_limits(f"goal {there}", goal_ned)
        or beyond_reach(pos_ned, v_ned)
        or judge.point(f"goal {there}", goal_ned, floor_applies=True)
        or judge.leg(f"the leg to {there}", pos_ned, goal_ned, judge.margins, floor_applies=True)
        or bad_overshoot(judge, f"goal {there}", pos_ned, goal_ned, overshoot)
        or cannot_stop(bounds, pos_ned, v_ned, path, floor_applies=True)
        or cannot_stop_gained(bounds, pos_ned, gained_ned, floor_applies=True)
    )
    return refusal or Cleared(
        (
            *clearance_numbers(judge, "goal", goal_ned, goal_ned),
            *clearance_numbers(judge, "leg", pos_ned, goal_ned),
            ("leg_m", math.dist(pos_ned, goal_ned)),
            *stopping_numbers(judge, v_ned),
        )
    )


def takeoff(bounds: Bounds, up_m: float, pos_ned: Vec3) -> Cleared | Refusal:
    """May the vehicle climb straight up to `up_m` metres above where it stands?

    The floor does not apply to the climb.  It applies to its top, where the vehicle hovers.
    """
    refusal = bounds.unusable(height=(up_m,), position=pos_ned)
    if refusal is not None:
        return refusal
    most_m = bounds.policy.takeoff.max_up_m
    if up_m > most_m:
        sentence = f"take-off to {metres(up_m)} m, the policy's highest is {metres(most_m)} m"
        return Refusal(Code.TOO_HIGH, sentence, (("up_m", up_m), ("max_up_m", most_m)))
    if up_m <= 0.0:
        return Refusal(Code.TOO_LOW, f"take-off to {metres(up_m)} m is no climb", (("up_m", up_m),))
    judge, top_ned = bounds.judge, (pos_ned[0], pos_ned[1], pos_ned[2] - up_m)
    top, climb = f"take-off top {place(top_ned)}", f"the climb to {place(top_ned)}"
    refusal = (
        beyond_reach(pos_ned)
        or bounds.beyond_limits(top, top_ned)
        or judge.point(top, top_ned, floor_applies=True)
        or judge.leg(climb, pos_ned, top_ned, judge.margins, floor_applies=False)
    )
    return refusal or Cleared((*clearance_numbers(judge, "top", top_ned, top_ned), ("leg_m", up_m)))
