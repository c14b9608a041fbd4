"""How clear of a zone a straight motion keeps, and the three rules that are made of it.

A motion is a straight line (a point is one of no length).  Its clearance is measured face by
face: an inclusion zone has sides, a ceiling and a floor, each to be kept apart; an exclusion
zone is one body, clear of which is whoever is beside it *or* above *or* below.  Each measure
says how clear the start is and how clear the least clear place is, and that is all a rule needs:

point   the least is at least the margin;
leg     the same, but one that starts within the margin may run as close as it started;
stop    the least stays above a limit below the margin, see `Keep`.

All three limits grow with the margin, so a wider one never accepts what a narrower refuses.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum

from gcs.frames import Vec3, enu_from_ned
from gcs.gate.airspace.zones import Zone
from gcs.gate.geometry import TOLERANCE_M, Point, along


class Face(Enum):
    SIDES = "outside"
    CEILING = "above the ceiling of"
    FLOOR = "below the floor of"
    BODY = "inside"


@dataclass(frozen=True, slots=True)
class Measure:
    """Metres clear of one face at the start of a motion and where it is least."""

    zone: Zone
    face: Face
    start_m: float
    least_m: float


@dataclass(frozen=True, slots=True)
class Widths:
    """A horizontal and a vertical distance to keep."""

    h_m: float
    v_m: float

    def of(self, face: Face) -> float:
        return self.v_m if face in (Face.CEILING, Face.FLOOR) else self.h_m


NO_WIDTHS = Widths(0.0, 0.0)


@dataclass(frozen=True, slots=True)
class Motion:
    """From `a` to `b`, each (east, north) and metres up of the local origin."""

    a_en: Point
    a_up_m: float
    b_en: Point
    b_up_m: float

    @staticmethod
    def between(a_ned: Vec3, b_ned: Vec3) -> Motion:
        a, b = enu_from_ned(a_ned), enu_from_ned(b_ned)
        return Motion(a[:2], a[2], b[:2], b[2])


def inclusion_measures(zone: Zone, motion: Motion, *, floor_applies: bool) -> list[Measure]:
    """Sides, ceiling and, where it applies, floor."""
    m = motion
    sides = Measure(
        zone, Face.SIDES, zone.shape.clearance(m.a_en), zone.shape.inner_clearance(m.a_en, m.b_en)
    )
    top = zone.ceiling_up_m
    ceiling = Measure(zone, Face.CEILING, top - m.a_up_m, top - max(m.a_up_m, m.b_up_m))
    if not floor_applies:
        return [sides, ceiling]
    low = zone.floor_up_m
    floor = Measure(zone, Face.FLOOR, m.a_up_m - low, min(m.a_up_m, m.b_up_m) - low)
    return [sides, ceiling, floor]


def body_clearance(zone: Zone, en: Point, up_m: float) -> float:
    """Metres that a point is clear of an exclusion zone, whichever way it is clear most."""
    return max(-zone.shape.clearance(en), zone.floor_up_m - up_m, up_m - zone.ceiling_up_m)


def leg_body_clearance(zone: Zone, motion: Motion, beside_m: float) -> float | None:
    """Metres beside an exclusion zone of that part of a leg which is less than `beside_m` above
    or below it; None if no part is."""
    m = motion
    low, high = zone.floor_up_m - beside_m, zone.ceiling_up_m + beside_m
    climb = m.b_up_m - m.a_up_m
    if climb == 0.0:
        part = (0.0, 1.0) if low < m.a_up_m < high else None
    else:
        s, t = sorted(((low - m.a_up_m) / climb, (high - m.a_up_m) / climb))
        part = (max(0.0, s), min(1.0, t))
        part = part if part[0] < part[1] else None
    if part is None:
        return None
    return zone.shape.outer_clearance(
        along(m.a_en, m.b_en, part[0]), along(m.a_en, m.b_en, part[1])
    )


def swept_body_measure(zone: Zone, motion: Motion, beside_m: float) -> Measure | None:
    """As above for a motion whose horizontal and vertical parts do not keep step: if any height
    it passes is too near the zone's, its whole ground track has to be beside the zone."""
    m = motion
    lowest, highest = min(m.a_up_m, m.b_up_m), max(m.a_up_m, m.b_up_m)
    if highest <= zone.floor_up_m - beside_m or lowest >= zone.ceiling_up_m + beside_m:
        return None
    start_m = body_clearance(zone, m.a_en, m.a_up_m)
    return Measure(zone, Face.BODY, start_m, zone.shape.outer_clearance(m.a_en, m.b_en))


@dataclass(frozen=True, slots=True)
class Keep:
    """What a predicted stop must keep, for one face.

    `error_m + margin_m - slack_m` is the limit.  Within it a vehicle may creep: `creep_m` nearer
    than it is now is the noise of hovering, and moving away is always allowed; but not nearer
    than `error_m`, where it could be outside without knowing.
    """

    error_m: float
    margin_m: float
    slack_m: float
    creep_m: float

    @property
    def limit_m(self) -> float:
        return self.error_m + self.margin_m - self.slack_m

    @property
    def outermost_m(self) -> float:
        """A present position with less clearance is a breach, wherever it moves."""
        return min(0.0, self.limit_m)

    def broken_by(self, measure: Measure) -> bool:
        """Non-finite measures break it."""
        start_m = measure.start_m
        hard_m = min(self.error_m, self.limit_m, start_m - TOLERANCE_M)
        soft_m = min(self.limit_m, start_m - self.creep_m)
        kept = start_m >= self.outermost_m and measure.least_m >= max(hard_m, soft_m)
        return not kept
