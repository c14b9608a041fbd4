"""Is the way of the vehicle's own return clear: home, or to each place where it may end?"""

from __future__ import annotations

import math
from collections.abc import Sequence

from gcs.frames import Vec3
from gcs.gate.airspace.bounds import Bounds, Cleared, beyond_reach, clearance_numbers
from gcs.gate.airspace.clearance import NO_MARGINS
from gcs.gate.airspace.return_place import HOME, ReturnPlace
from gcs.gate.refusal import Code, Refusal


def return_paths(
    bounds: Bounds, pos_ned: Vec3, places: Sequence[ReturnPlace], return_up_m: float
) -> Cleared | Refusal:
    """The vehicle's own return, which may end at any of `places`: each way must be clear.

    The numbers are those of the way that comes nearest to a zone beside it.
    """
    cleared: list[Cleared] = []
    for to in places:
        up_m = max(return_up_m, to.over_up_m)
        judged = return_path(bounds, pos_ned, to.ground_ned, up_m, to.name)
        if isinstance(judged, Refusal):
            return judged
        cleared.append(judged)
    return min(cleared, key=_least_clear_h_m)


def return_path(
    bounds: Bounds, pos_ned: Vec3, home_ned: Vec3, return_up_m: float, name: str = HOME
) -> Cleared | Refusal:
    """As `return_refusal`, with the numbers where the way home is clear."""
    refusal = return_refusal(bounds, pos_ned, home_ned, return_up_m, name)
    if refusal is not None:
        return refusal
    top_ned, over_ned = way_home(pos_ned, home_ned, return_up_m)
    numbers = clearance_numbers(bounds.judge, "leg", top_ned, over_ned)
    return Cleared((*numbers, ("leg_m", math.dist(top_ned, over_ned))))


def return_refusal(
    bounds: Bounds, pos_ned: Vec3, home_ned: Vec3, return_up_m: float, name: str = HOME
) -> Refusal | None:
    """Why the vehicle's own way home is refused, or to the place `name` that stands for home;
    None if it is clear.

    It climbs to its return height (metres above home) unless it is higher, flies straight home
    and descends.  A return makes it safer, so no margin is asked for, only that it stays inside
    for certain.  The floor does not apply: a return ends on the ground.
    """
    top_ned, over_ned = way_home(pos_ned, home_ned, return_up_m)
    way = "the way home" if name == HOME else f"the way to {name}"
    blocked = (
        bounds.unusable(position=pos_ned, home=home_ned, height=(return_up_m,))
        or beyond_reach(pos_ned)
        or beyond_reach(over_ned)
        or _clear_leg(bounds, "the climb to return height", pos_ned, top_ned)
        or _clear_leg(bounds, way, top_ned, over_ned)
        or _clear_leg(bounds, f"the descent at {name}", over_ned, home_ned)
    )
    if blocked is None:
        return None
    sentence = f"return blocked: {blocked.sentence}"
    return Refusal(Code.RTL_BLOCKED, sentence, blocked.numbers, blocked.zone)


def _clear_leg(bounds: Bounds, subject: str, a_ned: Vec3, b_ned: Vec3) -> Refusal | None:
    return bounds.judge.leg(subject, a_ned, b_ned, NO_MARGINS, floor_applies=False)


def way_home(pos_ned: Vec3, home_ned: Vec3, return_up_m: float) -> tuple[Vec3, Vec3]:
    """The ends of the straight leg: above the vehicle, and above home."""
    down_m = min(pos_ned[2], home_ned[2] - return_up_m)
    return (*pos_ned[:2], down_m), (*home_ned[:2], down_m)


def _least_clear_h_m(way: Cleared) -> float:
    """How near to a zone a way comes; infinite where there is none."""
    return dict(way.evidence).get("leg_clear_h_m", math.inf)
