"""The clearance of a straight motion from a zone, which three rules compare with their limits.

A motion is a straight line; a point is a line of length zero.  Clearances are metres, negative on
the forbidden side, and are measured for each face of the zone.  An inclusion zone has three faces:
its sides, its ceiling and its floor.  An exclusion zone has one, its body: a point that is beside
it *or* above it *or* below it is clear of it.  A `Measure` has the clearance at the start of the
motion and the least one along it:

point   the least must be at least the margin;
leg     the same, but a leg that starts closer than the margin may be as close as at its start;
stop    the least must not be below a limit that is smaller than the margin, see `StopLimit`.

All three limits grow with the margin: a wider margin never accepts what a narrower one refuses.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum

from gcs.frames import Vec3, enu_from_ned
from gcs.gate.airspace.zones import Zone
from gcs.gate.geometry import TOLERANCE_M, Point, along


class Face(Enum):
    """A face of a zone; the values are parts of sentences."""

    SIDES = "outside"
    CEILING = "above the ceiling of"
    FLOOR = "below the floor of"
    BODY = "inside"


@dataclass(frozen=True, slots=True)
class Measure:
    """The clearance from one face, in metres: at the start of a motion, and the least along it."""

    zone: Zone
    face: Face
    start_m: float
    least_m: float


@dataclass(frozen=True, slots=True)
class Margins:
    """A horizontal and a vertical distance, in metres."""

    h_m: float
    v_m: float

    def of(self, face: Face) -> float:
        return self.v_m if face in (Face.CEILING, Face.FLOOR) else self.h_m


NO_MARGINS = Margins(0.0, 0.0)


@dataclass(frozen=True, slots=True)
class Motion:
    """A straight line from `a` to `b`: each (east, north) and up, metres from the local origin."""

    a_en: Point
    a_up_m: float
    b_en: Point
    b_up_m: float

    @staticmethod
    def between(a_ned: Vec3, b_ned: Vec3) -> Motion:
        a, b = enu_from_ned(a_ned), enu_from_ned(b_ned)
        return Motion(a[:2], a[2], b[:2], b[2])


def inclusion_measures(zone: Zone, motion: Motion, *, floor_applies: bool) -> list[Measure]:
    """The measures of an inclusion zone: sides, ceiling and, where it applies, floor."""
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
    """The clearance of a point from an exclusion zone: the largest of beside, above and below."""
    return max(-zone.shape.clearance(en), zone.floor_up_m - up_m, up_m - zone.ceiling_up_m)


def leg_body_clearance(zone: Zone, motion: Motion, beside_m: float) -> float | None:
    """The horizontal clearance of a leg from an exclusion zone.

    Only that part of the leg counts which is less than `beside_m` above or below the zone; None
    if no part is.
    """
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
    """As `leg_body_clearance`, for a motion that is not a straight line in height.

    A vehicle that brakes stops at different times horizontally and vertically.  So if any height
    that it passes is too close to the zone, its whole ground track has to be beside the zone.
    """
    m = motion
    lowest, highest = min(m.a_up_m, m.b_up_m), max(m.a_up_m, m.b_up_m)
    if highest <= zone.floor_up_m - beside_m or lowest >= zone.ceiling_up_m + beside_m:
        return None
    start_m = body_clearance(zone, m.a_en, m.a_up_m)
    return Measure(zone, Face.BODY, start_m, zone.shape.outer_clearance(m.a_en, m.b_en))


@dataclass(frozen=True, slots=True)
class StopLimit:
    """The least clearance that a predicted stop must have from one face.

    The limit is `error_m + margin_m - slack_m`.  A vehicle that is closer already may move away,
    and may come `creep_m` closer than it is now, which is the noise of hovering; but never closer
    than `error_m`, the error of its position, where it could be outside without our knowing.
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
        """With less clearance than this the present position is a breach, however it moves."""
        return min(0.0, self.limit_m)

    def broken_by(self, measure: Measure) -> bool:
        """Does the measured way to the stop break the limit?  One that is not finite does."""
        start_m = measure.start_m
        error_bound_m = min(self.error_m, self.limit_m, start_m - TOLERANCE_M)
        creep_bound_m = min(self.limit_m, start_m - self.creep_m)
        bound_m = max(error_bound_m, creep_bound_m)
        kept = start_m >= self.outermost_m and measure.least_m >= bound_m
        return not kept
