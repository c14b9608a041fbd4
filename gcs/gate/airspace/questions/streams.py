"""May a sample of a client's setpoint stream be flown?

Where a sample can take the vehicle is in `stream_samples.py`.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

from gcs.frames import Vec3
from gcs.gate.airspace.attitude_samples import BeforeThis, flies_too_fast
from gcs.gate.airspace.bounds import Bounds, Cleared, beyond_reach
from gcs.gate.airspace.clearance import Margins
from gcs.gate.airspace.explain import metres
from gcs.gate.airspace.prediction import stopping_numbers
from gcs.gate.airspace.questions import goals
from gcs.gate.airspace.stream_samples import (
    StreamSample,
    beyond_rules,
    places_of_rest,
    sample_counts_s,
    velocities,
)
from gcs.gate.refusal import Code, Refusal


def stream_sample(
    bounds: Bounds,
    sample: StreamSample,
    pos_ned: Vec3,
    v_ned: Vec3,
    age_s: float,
    before: Sequence[BeforeThis] = (),
    gained_ned: Sequence[Vec3] = (),
) -> Cleared | Refusal:
    """May a sample of a client's stream be flown, by a position that is `age_s` old?

    Its position is judged as a goal is.  For a velocity, an acceleration or an attitude the
    vehicle must be able to stop inside by the margin after it has flown that, or gone on as it
    flies now, for as long as the sample counts; see `stream_samples.py`.  `before` is how it
    leant for the attitudes that the sample follows, `gained_ned` the velocities that it may
    have as well, on its way to somewhere else.
    """
    refusal = bounds.unusable(position=pos_ned, velocity=v_ned, **sample.numbers)
    refusal = refusal or beyond_rules(sample, bounds.policy.stream) or beyond_reach(pos_ned, v_ned)
    if refusal is None and sample.attitude is not None:
        refusal = flies_too_fast(v_ned, bounds.policy.stream)
    if refusal is not None:
        return refusal
    evidence: tuple[tuple[str, float], ...] = ()
    if sample.pos_ned is not None:
        goal = goals.goal(
            bounds, sample.pos_ned, sample.yaw_rad, pos_ned, v_ned, gained_ned=gained_ned
        )
        if isinstance(goal, Refusal):
            return goal
        evidence = goal.evidence
        if sample.v_ned is None and not before:
            return goal
    asked = () if sample.attitude is None else (("tilt_deg", sample.attitude.tilt_deg),)
    flown = _stream_velocity(bounds, sample, pos_ned, v_ned, age_s, before, gained_ned)
    return flown or Cleared(
        (
            *evidence,
            *asked,
            *stopping_numbers(bounds.judge, sample.v_ned or v_ned),
            ("age_s", age_s),
        )
    )


def _stream_velocity(
    bounds: Bounds,
    sample: StreamSample,
    pos_ned: Vec3,
    v_ned: Vec3,
    age_s: float,
    before: Sequence[BeforeThis],
    gained_ned: Sequence[Vec3],
) -> Refusal | None:
    """Refuses what leads to velocities that the vehicle could not stop from inside."""
    rules, braking = bounds.policy.stream, bounds.policy.braking_of(bounds.autopilot)
    counts_s = sample_counts_s(age_s, rules)
    flown = (*velocities(sample, v_ned, age_s, before, braking, rules), *gained_ned)
    # With a position too, the vehicle may come to rest as far beyond that as beyond its own.
    begins = (pos_ned,) if sample.pos_ned is None else (pos_ned, sample.pos_ned)
    rest = [p for begin in begins for p in places_of_rest(begin, flown, counts_s, braking)]
    judge, keep, error = bounds.judge, bounds.judge.margins, bounds.position_error
    margins = Margins(keep.h_m + error.h_m, keep.v_m + error.v_m)
    fastest_m_s = max(math.hypot(*v) for v in flown)
    subject = f"the way to a stop from {metres(fastest_m_s)} m/s"
    beyond = (bounds.beyond_limits(subject, place, allow=error) for place in rest)
    refusal = next(filter(None, beyond), None) or judge.hull(
        subject, (pos_ned,), rest, floor_applies=True, margins=margins
    )
    return None if refusal is None else replace(refusal, code=Code.CANNOT_STOP)
