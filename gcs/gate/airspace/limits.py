"""The limits that need no fence: numbers that can be computed with, and the policy's height and
distance from home."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

from gcs.frames import Vec3
from gcs.gate.airspace.clearance import Margins
from gcs.gate.airspace.explain import metres
from gcs.gate.geometry import REACH_M
from gcs.gate.policy.policy import Policy
from gcs.gate.refusal import Code, Refusal

STANDING: Vec3 = (0.0, 0.0, 0.0)
"""The velocity of a vehicle that does not move."""

FASTEST_M_S = 1.0e4
"""No vehicle is faster than this; a larger velocity is a wrong number."""


def not_finite(values: Mapping[str, Sequence[float]]) -> Refusal | None:
    """Refuses values, by name, with an infinite number or a NaN among them."""
    for name, numbers in values.items():
        if not all(map(math.isfinite, numbers)):
            return Refusal(Code.NON_FINITE, f"{name} is not finite")
    return None


def beyond_reach(pos_ned: Vec3, v_ned: Vec3 = STANDING) -> Refusal | None:
    """Refuses numbers too large for the geometry and for the stopping distance to be exact."""
    north, east, down = pos_ned
    if not (abs(north) <= REACH_M and abs(east) <= REACH_M and abs(down) <= REACH_M):
        return Refusal(Code.TOO_FAR, f"a position beyond {REACH_M / 1000:.0f} km of the origin")
    v_n, v_e, v_d = v_ned
    if not (abs(v_n) <= FASTEST_M_S and abs(v_e) <= FASTEST_M_S and abs(v_d) <= FASTEST_M_S):
        return Refusal(Code.CANNOT_STOP, f"a velocity beyond {FASTEST_M_S:.0f} m/s")
    return None


def beyond_limits(
    policy: Policy,
    home_ned: Vec3,
    subject: str,
    pos_ned: Vec3,
    *,
    allow: Margins,
    floor_applies: bool,
) -> Refusal | None:
    """Refuses a position too high, too low or too far from home, by more than `allow`.

    The policy's least height is a floor: it is not considered where `floor_applies` is False.
    """
    up_m = home_ned[2] - pos_ned[2]
    distance_m = math.hypot(pos_ned[0] - home_ned[0], pos_ned[1] - home_ned[1])
    if not up_m <= policy.max_up_m + allow.v_m:
        return Refusal(
            Code.TOO_HIGH,
            f"{subject} is {metres(up_m)} m above home, at most {metres(policy.max_up_m)} m",
            (("up_m", up_m), ("max_up_m", policy.max_up_m)),
        )
    if floor_applies and not up_m >= policy.min_up_m - allow.v_m:
        return Refusal(
            Code.TOO_LOW,
            f"{subject} is {metres(up_m)} m above home, at least {metres(policy.min_up_m)} m",
            (("up_m", up_m), ("min_up_m", policy.min_up_m)),
        )
    if not distance_m <= policy.max_distance_m + allow.h_m:
        most_m = policy.max_distance_m
        return Refusal(
            Code.TOO_FAR,
            f"{subject} is {metres(distance_m)} m from home, at most {metres(most_m)} m",
            (("distance_m", distance_m), ("max_distance_m", most_m)),
        )
    return beyond_reach(pos_ned)
