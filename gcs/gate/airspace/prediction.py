"""Predicts where the vehicle would stop if it were told to stop now, and judges that stop."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

from gcs.enu_text import fixed
from gcs.frames import Vec3
from gcs.gate.airspace import stopping
from gcs.gate.airspace.bounds import Bounds
from gcs.gate.airspace.clearance import Measure
from gcs.gate.airspace.explain import metres
from gcs.gate.airspace.fence_check import FenceCheck
from gcs.gate.airspace.stopping import Path, StopBy
from gcs.gate.policy.policy import Overshoot
from gcs.gate.refusal import Code, Refusal


@dataclass(frozen=True, slots=True)
class BadStop:
    """No way of stopping keeps the limits of the fence: the best of them, where it ends, and which
    measure breaks its limit."""

    by: StopBy
    stop_ned: Vec3
    measure: Measure
    sentence: str
    numbers: tuple[tuple[str, float], ...]


def bad_stop(
    bounds: Bounds,
    pos_ned: Vec3,
    v_ned: Vec3,
    path: Path,
    late_s: float = 0.0,
    *,
    floor_applies: bool,
) -> BadStop | None:
    """None where the vehicle can come to rest inside; else the way that ends nearest to it.

    Where the floor does not apply, a stop is no lower than the ground, at home's height.  The
    numbers have where each way would end: how far from the limit, negative beyond it.  One that
    follows setpoints to its goal may fly past that by the margin: no other way is better then, as
    it comes back by itself.
    """
    home_ned = bounds.home_ned
    policy, autopilot = bounds.policy, bounds.autopilot
    found: list[tuple[float, StopBy, Vec3, Measure, FenceCheck]] = []
    for by, (north_m, east_m, down_m) in stopping.ways_to_stop(
        pos_ned, v_ned, path, policy, autopilot, late_s
    ):
        if not floor_applies and home_ned is not None:
            down_m = min(down_m, max(pos_ned[2], home_ned[2]))
        stop_ned = (north_m, east_m, down_m)
        judge = bounds.judge_within_margin if by is StopBy.SETPOINT else bounds.judge
        measure = judge.broken_stop(pos_ned, stop_ned, floor_applies=floor_applies)
        if measure is None:
            return None
        over_m = measure.least_m - bounds.judge.stop_limit(measure.face).limit_m
        found.append((over_m, by, stop_ned, measure, judge))
    _, by, stop_ned, measure, judge = max(found, key=lambda way: way[0])
    limit_m, rest_m = judge.stop_limit(measure.face).limit_m, measure.least_m
    sentence = (
        f"at {fixed(math.hypot(*v_ned), 1)} m/s it would come to rest {metres(abs(rest_m))} m "
        f"{'past' if rest_m < 0.0 else 'from'} the edge of {measure.zone.title}, "
        f"{metres(abs(limit_m))} m {'asked' if limit_m >= 0.0 else 'past it allowed'}"
    )
    if len(found) > 1:
        compared = (f"{way.value} {metres(-over_m)} m" for over_m, way, *_ in found)
        sentence += f" (past the limit by {', by '.join(compared)})"
    numbers = (
        ("clear_m", measure.start_m),
        ("stop_clear_m", rest_m),
        ("limit_m", limit_m),
        *((f"{way.value}_over_limit_m", over_m) for over_m, way, *_ in found),
        *stopping_numbers(judge, v_ned),
    )
    return BadStop(by, stop_ned, measure, sentence, numbers)


def cannot_stop(
    bounds: Bounds,
    pos_ned: Vec3,
    v_ned: Vec3,
    path: Path,
    late_s: float = 0.0,
    *,
    floor_applies: bool,
) -> Refusal | None:
    """Refuses a position and velocity from which the vehicle could not stop inside."""
    bad = bad_stop(bounds, pos_ned, v_ned, path, late_s, floor_applies=floor_applies)
    if bad is None:
        return None
    return Refusal(Code.CANNOT_STOP, bad.sentence, bad.numbers, bad.measure.zone.name)


def cannot_stop_gained(
    bounds: Bounds, pos_ned: Vec3, gained_ned: Sequence[Vec3], *, floor_applies: bool
) -> Refusal | None:
    """As `cannot_stop`, by velocities that are not reported yet."""
    for v_ned in gained_ned:
        refusal = cannot_stop(bounds, pos_ned, v_ned, None, floor_applies=floor_applies)
        if refusal is not None:
            sentence = f"it gains speed on its way: {refusal.sentence}"
            return replace(refusal, sentence=sentence)
    return None


def bad_overshoot(
    judge: FenceCheck, subject: str, pos_ned: Vec3, goal_ned: Vec3, overshoot: Overshoot
) -> Refusal | None:
    """Refuses a goal past which the vehicle would fly so close to a boundary that it is braked."""
    past_ned = stopping.overshoot_point(pos_ned, goal_ned, overshoot)
    measure = judge.broken_stop(goal_ned, past_ned, floor_applies=True)
    if measure is None:
        return None
    limit_m, past_m = judge.stop_limit(measure.face).limit_m, math.dist(goal_ned, past_ned)
    sentence = (
        f"{subject} is {metres(measure.start_m)} m from {measure.zone.title}: the vehicle may fly "
        f"{metres(past_m)} m past it, and be braked {metres(limit_m)} m from the edge"
    )
    numbers = (("clear_m", measure.start_m), ("overshoot_m", past_m), ("limit_m", limit_m))
    return Refusal(Code.TOO_CLOSE, sentence, numbers, measure.zone.name)


def stopping_numbers(judge: FenceCheck, v_ned: Vec3) -> tuple[tuple[str, float], ...]:
    """The stopping distances, horizontal and vertical, as evidence for a verdict."""
    margins = judge.margins
    return (
        ("stopping_h_m", stopping.distance_h_m(v_ned, judge.braking, margins.h_m)),
        ("stopping_v_m", stopping.distance_v_m(v_ned, judge.braking, margins.v_m)),
    )
