"""Is a part of a mission clear: a leg, a region beside it, a loiter circle, the take-off?"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Final

from gcs.enu_text import place
from gcs.frames import Vec3
from gcs.gate.airspace.bounds import Bounds, beyond_reach
from gcs.gate.airspace.clearance import Margins
from gcs.gate.airspace.explain import metres
from gcs.gate.airspace.fence_check import FenceCheck
from gcs.gate.geometry import TOLERANCE_M
from gcs.gate.refusal import Code, Refusal

WIND_DRIFT_S: Final = 0.25
"""So far beside its path a vehicle is that flies a mission, for each m/s of wind: in 431 random
missions of vehicle-sim in up to 8 m/s it was 1.7 m at the most; a recorded ArduCopter 4.7 was 0.1 m
beside its regions in calm and 0.4 m in 8 m/s, but for splines (1.4 m in calm), and a PX4 1.7 m in
calm, by the error of its estimate (`tests/unit/plan/test_recorded_missions.py`)."""


def mission_leg(bounds: Bounds, a_ned: Vec3, b_ned: Vec3, *, floor_applies: bool) -> Refusal | None:
    """Why a straight leg of a mission, or its end, is refused; None if both are clear.

    The floor does not apply to legs that leave or reach the ground.
    """
    judge, subject = _judge(bounds), f"waypoint {place(b_ned)}"
    return (
        bounds.unusable(waypoint=(*a_ned, *b_ned))
        or bounds.beyond_limits(subject, b_ned, floor_applies=floor_applies)
        or beyond_reach(a_ned)
        or judge.point(subject, b_ned, floor_applies=floor_applies)
        or judge.leg(
            f"the leg to {place(b_ned)}",
            a_ned,
            b_ned,
            judge.margins,
            floor_applies=floor_applies,
        )
    )


def mission_region(
    bounds: Bounds,
    subject: str,
    starts_ned: Sequence[Vec3],
    ends_ned: Sequence[Vec3],
    *,
    floor_applies: bool,
) -> Refusal | None:
    """Why the convex hull of the points, where a mission may fly, is refused; None if it is
    clear.

    As a leg, it may be as close to a boundary as its starts are.
    """
    points = (*starts_ned, *ends_ned)
    refusal = bounds.unusable(region=[value for point in points for value in point])
    if refusal is not None:
        return refusal
    for point in points:
        limit = bounds.beyond_limits(subject, point, floor_applies=floor_applies)
        if limit is not None:
            return limit
    return _judge(bounds).hull(subject, starts_ned, ends_ned, floor_applies=floor_applies)


def mission_circle(bounds: Bounds, centre_ned: Vec3, radius_m: float) -> Refusal | None:
    """Why a loiter circle is refused; None if it is clear.

    Its line counts and not its inside, where the mast may stand that it goes round.
    """
    refusal = bounds.unusable(circle=(*centre_ned, radius_m))
    if refusal is not None:
        return refusal
    reach_m = abs(radius_m)
    subject = f"the circle of {metres(reach_m)} m about {place(centre_ned)}"
    beyond = bounds.beyond_limits(subject, centre_ned, allow=Margins(-reach_m, 0.0))
    return beyond or _judge(bounds).ring(subject, centre_ned, reach_m)


def mission_take_off(bounds: Bounds, from_ned: Vec3, top_ned: Vec3) -> Refusal | None:
    """Why a take-off of a mission is refused: the policy's highest one binds it as well."""
    up_m, most_m = from_ned[2] - top_ned[2], bounds.policy.takeoff.max_up_m
    if up_m > most_m + TOLERANCE_M:
        sentence = f"take-off to {metres(up_m)} m, the policy's highest is {metres(most_m)} m"
        return Refusal(Code.TOO_HIGH, sentence, (("up_m", up_m), ("max_up_m", most_m)))
    return None


def _judge(bounds: Bounds) -> FenceCheck:
    """No station holds a mission beside its path: its margin has room for the wind too."""
    return replace(bounds.judge, least_h_m=WIND_DRIFT_S * bounds.policy.mission_wind_m_s)
