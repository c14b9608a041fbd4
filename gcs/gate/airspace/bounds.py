"""What every question is judged by: the fence as it is placed, home, and the policy's figures.

Beside the fence these are the limits that need none: numbers that can be computed with, and the
policy's height and distance from home.  `Cleared` is the answer where nothing refuses.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Final

from gcs.frames import Vec3
from gcs.gate.airspace.clearance import NO_MARGINS, Margins
from gcs.gate.airspace.explain import metres
from gcs.gate.airspace.fence_check import FenceCheck, Slack
from gcs.gate.airspace.zones import Zone
from gcs.gate.geometry import REACH_M
from gcs.gate.policy.policy import Policy
from gcs.gate.refusal import Code, Refusal

LOCAL_ORIGIN: Final[Vec3] = (0.0, 0.0, 0.0)
STANDING: Vec3 = (0.0, 0.0, 0.0)
"""The velocity of a vehicle that does not move."""

FASTEST_M_S = 1.0e4
"""No vehicle is faster than this; a larger velocity is a wrong number."""


@dataclass(frozen=True)
class Bounds:
    """One fence, home and autopilot.  Positions are local NED, in metres.

    `zones` is the whole fence in the local frame.  Where it is empty and the fence is on, the fence
    is not known yet: everything that moves is refused, and `unplaced` says why.
    """

    policy: Policy
    zones: tuple[Zone, ...]
    autopilot: str
    home_ned: Vec3 | None
    origin_known: bool
    fence_on: bool = True
    unplaced: Refusal | None = None

    @cached_property
    def judge(self) -> FenceCheck:
        """Judges by the zones; by none where the fence is off."""
        zones = self.zones if self.fence_on else ()
        return FenceCheck(zones, self.policy, self.policy.braking_of(self.autopilot))

    @cached_property
    def judge_within_error(self) -> FenceCheck:
        """As `judge`; a stop may be nearer than the margin by no more than the position's error."""
        return replace(self.judge, slack=Slack.ERROR)

    @cached_property
    def judge_within_margin(self) -> FenceCheck:
        """As `judge`; a stop may be nearer than the margin by the whole of it."""
        return replace(self.judge, slack=Slack.MARGIN)

    @cached_property
    def position_error(self) -> Margins:
        """By how much a reported position may be wrong."""
        b = self.policy.braking_of(self.autopilot)
        return Margins(b.position_error_h_m, b.position_error_v_m)

    def unusable(self, **values: Sequence[float]) -> Refusal | None:
        """NON_FINITE where a number is not finite, NO_ORIGIN where the fence is not known."""
        refusal = not_finite({"home": self.home_ned or (), **values})
        if refusal is None and self.fence_on and not self.zones:
            return self.unplaced or Refusal(Code.NO_ORIGIN, "the fence is not known yet")
        return refusal

    def beyond_limits(
        self,
        subject: str,
        pos_ned: Vec3,
        *,
        allow: Margins = NO_MARGINS,
        floor_applies: bool = True,
    ) -> Refusal | None:
        """Refuses a position too high, too low or too far from home, by more than `allow`; it is
        counted from the local origin until home is known.

        The policy's least height is a floor: it is not considered where `floor_applies` is False.
        """
        policy, home_ned = self.policy, self.home_ned or LOCAL_ORIGIN
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


@dataclass(frozen=True, slots=True)
class Cleared:
    """The verifier allows it; `evidence` has the numbers that this was decided on."""

    evidence: tuple[tuple[str, float], ...] = ()


def clearance_numbers(
    judge: FenceCheck, what: str, a_ned: Vec3, b_ned: Vec3
) -> tuple[tuple[str, float], ...]:
    """The distances of a-b to the nearest boundary, as evidence; infinite ones are left out."""
    near = judge.nearest(a_ned, b_ned)
    named = ((f"{what}_clear_h_m", near.h_m), (f"{what}_clear_v_m", near.v_m))
    return tuple((name, value) for name, value in named if math.isfinite(value))
