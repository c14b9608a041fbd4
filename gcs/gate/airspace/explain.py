"""The verifier's sentences, in metres and in the operator's frame (east, north, up)."""

from __future__ import annotations

from gcs.enu_text import fixed
from gcs.gate.airspace.clearance import Face, Measure
from gcs.gate.geometry import Side, side
from gcs.gate.refusal import Code, Refusal


def metres(value: float) -> str:
    """Metres as a number: two decimals below 1 m, one above (0.01, 350.0)."""
    return fixed(value, 2 if abs(value) < 1.0 else 1)


def zone_refusal(subject: str, measure: Measure, margin_m: float, *, leg: bool) -> Refusal:
    """The refusal of `subject`, which does not keep the margin from the measured face.

    Either it is outside for certain, and the numbers say by how much (`outside_m`); or it is too
    close, and they say how close (`clear_m`).  Both give the margin.
    """
    zone, clear_m = measure.zone, measure.least_m
    if side(clear_m) is Side.OUTSIDE or (leg and clear_m <= 0.0):
        code = Code.OUTSIDE_FENCE if zone.inclusion else Code.INSIDE_EXCLUSION
        if leg:
            code = Code.LEG_LEAVES_FENCE
        return Refusal(
            code,
            f"{subject} {'goes' if leg else 'is'} {_how_far(measure)}",
            (("outside_m", max(0.0, -clear_m)), ("margin_m", margin_m)),
            zone.name,
        )
    edge = {Face.CEILING: "the ceiling of ", Face.FLOOR: "the floor of "}.get(measure.face, "")
    return Refusal(
        Code.TOO_CLOSE,
        f"{subject} is only {metres(clear_m)} m from {edge}{zone.title}, "
        f"margin {metres(margin_m)} m",
        (("clear_m", clear_m), ("margin_m", margin_m)),
        zone.name,
    )


def _how_far(measure: Measure) -> str:
    title, depth_m = measure.zone.title, max(0.0, -measure.least_m)
    if measure.face is Face.BODY:
        return f"inside {title}" if depth_m > 0.0 else f"through {title}"
    return f"{metres(depth_m)} m {measure.face.value} {title}"
