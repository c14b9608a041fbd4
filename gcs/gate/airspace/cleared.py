"""The verifier's yes, and the numbers that say how far from the boundaries it was given."""

from __future__ import annotations

import math
from dataclasses import dataclass

from gcs.frames import Vec3
from gcs.gate.airspace.fence_check import FenceCheck


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
