"""May the vehicle stay where it is, may it start there, and is it outside?"""

from __future__ import annotations

import math
from collections.abc import Sequence

from gcs.enu_text import place
from gcs.frames import Vec3
from gcs.gate.airspace.bounds import Bounds, Cleared, beyond_reach, clearance_numbers
from gcs.gate.airspace.clearance import NO_MARGINS
from gcs.gate.airspace.prediction import cannot_stop, cannot_stop_gained, stopping_numbers
from gcs.gate.refusal import Refusal


def hold_point(
    bounds: Bounds,
    pos_ned: Vec3,
    v_ned: Vec3,
    gained_ned: Sequence[Vec3] = (),
    *,
    floor_applies: bool,
) -> Cleared | Refusal:
    """May the vehicle stay where it is?

    The margin is not asked for, because a hold leads nowhere: the position must be inside the
    fence and within the limits, and the vehicle must be able to stop inside.
    """
    refusal = bounds.unusable(position=pos_ned, velocity=v_ned)
    if refusal is not None:
        return refusal
    judge = bounds.judge
    refusal = (
        bounds.beyond_limits(
            f"position {place(pos_ned)}",
            pos_ned,
            allow=bounds.position_error,
            floor_applies=floor_applies,
        )
        or beyond_reach(pos_ned, v_ned)
        or judge.outside("position", pos_ned, floor_applies=floor_applies)
        or cannot_stop(bounds, pos_ned, v_ned, None, floor_applies=floor_applies)
        or cannot_stop_gained(bounds, pos_ned, gained_ned, floor_applies=floor_applies)
    )
    return refusal or Cleared(
        (*clearance_numbers(judge, "hold", pos_ned, pos_ned), *stopping_numbers(judge, v_ned))
    )


def start(bounds: Bounds, pos_ned: Vec3) -> Refusal | None:
    """Why the vehicle may not start at `pos_ned`: it is outside the fence.  Neither floor nor
    margin applies."""
    return (
        bounds.unusable(position=pos_ned)
        or beyond_reach(pos_ned)
        or bounds.judge.outside("start position", pos_ned, floor_applies=False)
    )


def outside(bounds: Bounds, pos_ned: Vec3, *, for_certain: bool) -> Refusal | None:
    """Why a vehicle at `pos_ned` is outside the fence; None if it is not, or no fence is known.

    `for_certain`: by more than its position may be wrong.  The floor does not apply: every
    landing ends there.
    """
    if not all(map(math.isfinite, pos_ned)):
        return None
    allow = bounds.position_error if for_certain else NO_MARGINS
    return beyond_reach(pos_ned) or bounds.judge.outside(
        "position", pos_ned, floor_applies=False, allow=allow
    )
