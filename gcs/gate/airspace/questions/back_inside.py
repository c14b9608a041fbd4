"""Where may a vehicle that is outside the fence fly back inside?"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final

from gcs.enu_text import fixed, place
from gcs.frames import Vec3, enu_from_ned, ned_from_enu
from gcs.gate.airspace.bounds import Bounds, beyond_reach, clearance_numbers
from gcs.gate.airspace.stopping import stop_point
from gcs.gate.geometry import Point, along
from gcs.gate.refusal import Code, Refusal

SLOW_M_S: Final = 1.0
"""A vehicle that is faster is to be held first."""
DRIFTS_M: Final = 0.5
"""On its way back a vehicle may stop so much farther out than it is."""
ROOM_M: Final = 0.5
"""So much more than the margin is kept at the end of the way."""
ROUNDS: Final = 8
"""Zones may meet at corners: how often a place is moved away from the nearest of them."""


@dataclass(frozen=True, slots=True)
class WayBack:
    """A way inside, straight to `to_ned`, and the numbers that it was cleared on."""

    to_ned: Vec3
    evidence: tuple[tuple[str, float], ...]


def way_back(bounds: Bounds, pos_ned: Vec3, v_ned: Vec3) -> WayBack | Refusal:
    """The way to a place inside near `pos_ned`, which is outside the fence or its margin.

    It keeps the margin at its end, and is nowhere farther out, or nearer to an exclusion zone, than
    at its start.
    """
    refusal = bounds.unusable(position=pos_ned, velocity=v_ned) or beyond_reach(pos_ned, v_ned)
    if refusal is not None:
        return refusal
    speed_m_s = math.hypot(*v_ned)
    if speed_m_s > SLOW_M_S:
        sentence = f"it moves at {fixed(speed_m_s, 1)} m/s: hold first"
        return Refusal(Code.CANNOT_STOP, sentence, (("speed_m_s", speed_m_s),))
    to_ned = _inside(bounds, pos_ned)
    judge, there = bounds.judge, place(to_ned)
    refusal = (
        bounds.beyond_limits(f"the way back to {there}", to_ned)
        or judge.point(f"the way back to {there}", to_ned, floor_applies=True)
        or judge.leg_back(f"the way back to {there}", pos_ned, to_ned)
    )
    if refusal is not None:
        return refusal
    way_m = ("way_back_m", math.dist(pos_ned, to_ned))
    return WayBack(to_ned, (way_m, *clearance_numbers(judge, "goal", to_ned, to_ned)))


def leaves_way_back(bounds: Bounds, pos_ned: Vec3, v_ned: Vec3, to_ned: Vec3) -> Refusal | None:
    """Refuses to let a vehicle on its way back to `to_ned` fly on: it would stop farther out than
    it is, or its way does not clear any more."""
    stop_ned = stop_point(pos_ned, v_ned, bounds.policy.braking_of(bounds.autopilot))
    before, after = (bounds.judge.nearest(at, at) for at in (pos_ned, stop_ned))
    out_m = max(before.h_m - after.h_m, before.v_m - after.v_m)
    if out_m > DRIFTS_M:
        sentence = f"on its way back it would stop {fixed(out_m, 1)} m farther out"
        return Refusal(Code.CANNOT_STOP, sentence, (("farther_out_m", out_m),))
    return bounds.judge.leg_back(f"the way back to {place(to_ned)}", pos_ned, to_ned)


def _inside(bounds: Bounds, pos_ned: Vec3) -> Vec3:
    """A place near `pos_ned` that probably keeps every margin: `way_back` judges it."""
    margins = bounds.judge.margins
    east, north, up = enu_from_ned(pos_ned)
    home_up_m = 0.0 if bounds.home_ned is None else -bounds.home_ned[2]
    low, high = home_up_m + bounds.policy.min_up_m, home_up_m + bounds.policy.max_up_m
    for zone in bounds.zones:
        if zone.inclusion:
            low = max(low, zone.floor_up_m + margins.v_m)
            high = min(high, zone.ceiling_up_m - margins.v_m)
    room_m = min(ROOM_M, max(0.0, high - low) / 2.0)
    up = min(max(up, low + room_m), high - room_m)
    here: Point = (east, north)
    for _ in range(ROUNDS):
        moved = here
        for zone in bounds.zones:
            beside = zone.inclusion or zone.floor_up_m - margins.v_m < up < (
                zone.ceiling_up_m + margins.v_m
            )
            clear_m = zone.shape.clearance(moved) * (1.0 if zone.inclusion else -1.0)
            wanted_m = margins.h_m + ROOM_M
            if beside and clear_m < wanted_m and clear_m != 0.0:
                edge = zone.shape.nearest_edge(moved)
                moved = along(edge, moved, wanted_m / clear_m)
        if moved == here:
            break
        here = moved
    return ned_from_enu((*here, up))
