"""The clearance of a straight motion from a zone, which three rules compare with their limits.

A motion is straight over the ground, and at each place of that at any height between those of its
ends; a point is a motion of length zero.  Clearances are metres, negative on the forbidden side,
and are measured for each face of the zone.  An inclusion zone has three faces: its sides, its
ceiling and its floor.  An exclusion zone has one, its body: a point that is beside it *or* above it
*or* below it is clear of it.  A `Measure` has the clearance at the start of the motion and the
least one along it:

point   the least must be at least the margin;
leg     the same, but a leg that starts closer than the margin may be as close as at its start;
stop    the least must not be below a limit that is smaller than the margin, see `StopLimit`.

All three limits grow with the margin: a wider margin never accepts what a narrower one refuses.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum
from functools import cached_property
from typing import NamedTuple

from gcs.frames import Vec3, enu_from_ned
from gcs.gate.airspace.zones import Zone
from gcs.gate.geometry import TOLERANCE_M, Point


class Face(Enum):
    """A face of a zone; the values are parts of sentences."""

    SIDES = "outside"
    CEILING = "above the ceiling of"
    FLOOR = "below the floor of"
    BODY = "inside"


class Measure(NamedTuple):
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


class Motion(NamedTuple):
    """A straight way over the ground from `a` to `b`: each (east, north) and up, in metres from the
    local origin."""

    a_en: Point
    a_up_m: float
    b_en: Point
    b_up_m: float

    @staticmethod
    def between(a_ned: Vec3, b_ned: Vec3) -> Motion:
        a_east, a_north, a_up = enu_from_ned(a_ned)
        b_east, b_north, b_up = enu_from_ned(b_ned)
        return Motion((a_east, a_north), a_up, (b_east, b_north), b_up)


def inclusion_measures(zone: Zone, motion: Motion, *, floor_applies: bool) -> list[Measure]:
    """The measures of an inclusion zone: sides, ceiling and, where it applies, floor."""
    a_en, a_up_m, b_en, b_up_m = motion
    shape = zone.shape
    sides = Measure(zone, Face.SIDES, shape.clearance(a_en), shape.inner_clearance(a_en, b_en))
    top = zone.ceiling_up_m
    ceiling = Measure(zone, Face.CEILING, top - a_up_m, top - max(a_up_m, b_up_m))
    if not floor_applies:
        return [sides, ceiling]
    low = zone.floor_up_m
    floor = Measure(zone, Face.FLOOR, a_up_m - low, min(a_up_m, b_up_m) - low)
    return [sides, ceiling, floor]


def body_clearance(zone: Zone, en: Point, up_m: float) -> float:
    """The clearance of a point from an exclusion zone: the largest of beside, above and below."""
    return max(-zone.shape.clearance(en), zone.floor_up_m - up_m, up_m - zone.ceiling_up_m)


def swept_body_measure(zone: Zone, motion: Motion, beside_m: float) -> Measure | None:
    """The horizontal clearance of a motion from an exclusion zone; None where it passes only
    heights that are `beside_m` and more above or below the zone.

    Only the ground track of a motion is straight.  A vehicle climbs and brakes at speeds of its own
    vertically and horizontally, so if any height that it passes is too close to the zone, its whole
    ground track has to be beside the zone.
    """
    m = motion
    lowest, highest = min(m.a_up_m, m.b_up_m), max(m.a_up_m, m.b_up_m)
    if highest <= zone.floor_up_m - beside_m or lowest >= zone.ceiling_up_m + beside_m:
        return None
    start_m = body_clearance(zone, m.a_en, m.a_up_m)
    return Measure(zone, Face.BODY, start_m, zone.shape.outer_clearance(m.a_en, m.b_en))


@dataclass(frozen=True)
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

    @cached_property
    def limit_m(self) -> float:
        return self.error_m + self.margin_m - self.slack_m

    @cached_property
    def outermost_m(self) -> float:
        """With less clearance than this the present position is a breach, however it moves."""
        return min(0.0, self.limit_m)

    def broken_by(self, measure: Measure) -> bool:
        """Does the measured way to the stop break the limit?  One that is not finite does."""
        start_m, limit_m = measure.start_m, self.limit_m
        if not start_m >= self.outermost_m:
            return True
        if measure.least_m >= limit_m:
            return False
        error_bound_m = min(self.error_m, limit_m, start_m - TOLERANCE_M)
        creep_bound_m = min(limit_m, start_m - self.creep_m)
        return not measure.least_m >= max(error_bound_m, creep_bound_m)
