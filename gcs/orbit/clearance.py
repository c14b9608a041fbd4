"""Is an orbit clear, the way to it and the room that its samples need to stop?

Asked once, before it begins.  Every sample is verified again by the gate when it is flown.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Final

from gcs.enu_text import fixed
from gcs.frames import Vec3
from gcs.gate.airspace.stopping import travel_m
from gcs.gate.airspace.stream_samples import sample_counts_s
from gcs.gate.airspace.verifier import Verifier
from gcs.gate.refusal import Refusal
from gcs.orbit.circle import Orbit

BESIDE_M: Final = 1.0
"""So far beside its circle, or the way to it, a vehicle may be."""
ABOVE_M: Final = 0.3
"""And above or below."""
BULGE_M: Final = 0.2
"""A sector of the circle is a region with straight sides, which reaches so far beyond its arc."""
LEAST_SECTORS, MOST_SECTORS = 12, 400


def why_not(orbit: Orbit, verifier: Verifier, pos_ned: Vec3, v_ned: Vec3) -> Refusal | None:
    """Why the orbit is refused, flown from here; None if all of it is clear.

    In this order: the way as that of a go-to, the circle, the room beside the way, and the room to
    stop along the circle.
    """
    entry_ned = orbit.entry_ned(pos_ned)
    there = verifier.goal(entry_ned, None, pos_ned, v_ned)
    if isinstance(there, Refusal):
        return there
    return (
        verifier.mission_circle(orbit.centre_ned, orbit.radius_m)
        or _way(verifier, pos_ned, entry_ned)
        or _room(orbit, verifier)
    )


def _way(verifier: Verifier, pos_ned: Vec3, entry_ned: Vec3) -> Refusal | None:
    """The way to the circle, as wide at its end as the vehicle may be beside it."""
    beside_m = BESIDE_M + _error_m(verifier)
    north, east, down = entry_ned
    square = [
        (north + n * beside_m, east + e * beside_m, down + d * ABOVE_M)
        for n in (-1.0, 1.0)
        for e in (-1.0, 1.0)
        for d in (-1.0, 1.0)
    ]
    return verifier.mission_region("the way to the circle", (pos_ned,), square, floor_applies=True)


def _room(orbit: Orbit, verifier: Verifier) -> Refusal | None:
    """All round the circle: from as far inside it as the vehicle may be, to where it rests if it is
    told to hold and flies straight on."""
    policy = verifier.policy
    braking = policy.braking_of(verifier.autopilot)
    held_s = sample_counts_s(policy.stream.position_age_s, policy.stream) + braking.react_s
    on_m = travel_m(orbit.speed_m_s, held_s, braking.a_brake_h_m_s2)
    beside_m = BESIDE_M + _error_m(verifier)
    inner_m = max(0.0, orbit.radius_m - beside_m)
    outer_m = math.hypot(orbit.radius_m + BESIDE_M, on_m) + _error_m(verifier)
    subject = (
        f"the room to stop in, {fixed(outer_m - orbit.radius_m, 1)} m outside the circle of "
        f"{fixed(orbit.radius_m, 1)} m at {fixed(orbit.speed_m_s, 1)} m/s"
    )
    for points in _sectors(orbit.centre_ned, inner_m, outer_m):
        refusal = verifier.mission_region(subject, (), points, floor_applies=True)
        if refusal is not None:
            return refusal
    return None


def _sectors(centre_ned: Vec3, inner_m: float, outer_m: float) -> Iterator[list[Vec3]]:
    """Corners of the parts of a ring; together they hold all of it."""
    half_rad = math.acos(outer_m / (outer_m + BULGE_M))
    count = min(MOST_SECTORS, max(LEAST_SECTORS, math.ceil(math.pi / half_rad)))
    step_rad = math.tau / count
    over_m = outer_m / math.cos(0.5 * step_rad)
    north, east, down = centre_ned
    for number in range(count):
        yield [
            (north + reach * math.cos(angle), east + reach * math.sin(angle), down + d)
            for angle in (number * step_rad, (number + 1) * step_rad)
            for reach in (inner_m, over_m)
            for d in (-ABOVE_M, ABOVE_M)
        ]


def _error_m(verifier: Verifier) -> float:
    return verifier.policy.braking_of(verifier.autopilot).position_error_h_m
