"""Is a point, a leg or a stop clear of every zone of the fence?

Only the fence and the policy's distances are considered here.  Limits of height and distance, and
whether the numbers are finite, are checked by the caller, the verifier.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from enum import Enum
from functools import cached_property

from gcs.enu_text import place
from gcs.frames import Vec3, enu_from_ned
from gcs.gate.airspace.clearance import (
    NO_MARGINS,
    Face,
    Margins,
    Measure,
    Motion,
    StopLimit,
    body_clearance,
    inclusion_measures,
    swept_body_measure,
)
from gcs.gate.airspace.explain import zone_refusal
from gcs.gate.airspace.hulls import (
    ground_track,
    hull_inside,
    hull_outside,
    ring_inside,
    ring_outside,
)
from gcs.gate.airspace.zones import Zone
from gcs.gate.geometry import TOLERANCE_M
from gcs.gate.policy.policy import Braking, Policy
from gcs.gate.refusal import Refusal


class Slack(Enum):
    """How much nearer than the margin a stop may end."""

    ERROR = "error"  # by the error of the position: one at the margin is the last that fits
    POLICY = "policy"  # by the policy's slack
    MARGIN = "margin"  # by the margin: what is sent to its goal may fly past it, and comes back


@dataclass(frozen=True)
class FenceCheck:
    """Judges by the zones of one fence; see `clearance.py` for the three rules.

    `subject` is what a refusal's sentence begins with.  `floor_applies` says whether the floors of
    inclusion zones are considered.  `least_h_m`: the margin beside zones is no less, whatever the
    policy's.
    """

    zones: tuple[Zone, ...]
    policy: Policy
    braking: Braking
    least_h_m: float = 0.0
    slack: Slack = Slack.POLICY

    @cached_property
    def margins(self) -> Margins:
        return Margins(max(self.policy.margin_h_m, self.least_h_m), self.policy.margin_v_m)

    def point(self, subject: str, pos_ned: Vec3, *, floor_applies: bool) -> Refusal | None:
        """Refuses a point that does not keep the margin."""
        here = Motion.between(pos_ned, pos_ned)
        for zone in self.zones:
            for measure in self._point_measures(zone, here, floor_applies, self.margins):
                margin_m = self.margins.of(measure.face)
                if not measure.least_m >= self._need(measure.face, margin_m):
                    return zone_refusal(subject, measure, margin_m, leg=False)
        return None

    def leg(
        self, subject: str, a_ned: Vec3, b_ned: Vec3, margins: Margins, *, floor_applies: bool
    ) -> Refusal | None:
        """Refuses a leg that does not keep the margin all along.

        Its ground track is straight.  Its height at each place may be any between those of its
        ends: a vehicle that climbs slower than it would have to is below the straight line, and a
        PX4 climbs at a speed of its own however long the leg is.

        A leg that starts closer than the margin must not come closer than at its start.
        """
        motion = Motion.between(a_ned, b_ned)
        for zone in self.zones:
            if zone.inclusion:
                refusal = self._inclusion_leg(zone, subject, motion, margins, floor_applies)
            else:
                refusal = self._exclusion_leg(zone, subject, motion, margins)
            if refusal is not None:
                return refusal
        return None

    def leg_back(self, subject: str, a_ned: Vec3, b_ned: Vec3) -> Refusal | None:
        """Refuses a leg that begins outside, or nearer than the margin, and comes nowhere farther
        out than at its start; of what it begins inside of, it keeps the margin all along."""
        motion = Motion.between(a_ned, b_ned)
        for zone in self.zones:
            measures = inclusion_measures(zone, motion, floor_applies=True)
            if not zone.inclusion:
                swept = swept_body_measure(zone, motion, self.margins.v_m)
                measures = [] if swept is None else [swept]
            for measure in measures:
                margin_m = self.margins.of(measure.face)
                if not measure.least_m >= min(margin_m, measure.start_m) - TOLERANCE_M:
                    return zone_refusal(subject, measure, margin_m, leg=True)
        return None

    def hull(
        self,
        subject: str,
        starts_ned: Sequence[Vec3],
        ends_ned: Sequence[Vec3],
        *,
        floor_applies: bool,
        margins: Margins | None = None,
    ) -> Refusal | None:
        """Refuses the region over the convex hull of the points' ground track, from the lowest of
        them to the highest, if any of it does not keep the margin.

        A hull that starts closer than the margin must not come closer than its starts are; one
        without starts keeps the margin.
        """
        margins = self.margins if margins is None else margins
        for zone in self.zones:
            measures = self._hull_measures(zone, starts_ned, ends_ned, floor_applies, margins)
            for measure in measures:
                margin_m = margins.of(measure.face)
                need_m = self._no_nearer(measure.face, margin_m, measure.start_m)
                inside = measure.start_m >= self._outermost(measure.face)
                if not (inside and measure.least_m >= need_m):
                    return zone_refusal(subject, measure, margin_m, leg=True)
        return None

    def ring(self, subject: str, centre_ned: Vec3, radius_m: float) -> Refusal | None:
        """Refuses the line of a level circle if any of it does not keep the margin."""
        here = Motion.between(centre_ned, centre_ned)
        for zone in self.zones:
            for measure in self._ring_measures(zone, here, radius_m):
                margin_m = self.margins.of(measure.face)
                if not measure.least_m >= self._need(measure.face, margin_m):
                    return zone_refusal(subject, measure, margin_m, leg=False)
        return None

    def outside(
        self,
        what: str,
        pos_ned: Vec3,
        *,
        floor_applies: bool,
        allow: Margins = NO_MARGINS,
    ) -> Refusal | None:
        """Refuses a point that is outside by more than `allow`.  No margin is asked for.  It is
        called `what` and its place, in words that are made for a refusal only.

        Where the policy's slack is larger than its margin and position error together (as in the
        lab), a point may be outside by the difference.
        """
        here = Motion.between(pos_ned, pos_ned)
        for zone in self.zones:
            if _is_inside(zone, here, TOLERANCE_M, TOLERANCE_M, floor_applies):
                continue  # no `outermost_m` asks for more
            for measure in self._point_measures(zone, here, floor_applies, NO_MARGINS):
                if not measure.least_m >= self._outermost(measure.face) - allow.of(measure.face):
                    subject = f"{what} {place(pos_ned)}"
                    return zone_refusal(subject, measure, 0.0, leg=False)
        return None

    def broken_stop(self, pos_ned: Vec3, stop_ned: Vec3, *, floor_applies: bool) -> Measure | None:
        """The first measure of the way to a predicted stop that breaks its limit; None if none
        does."""
        motion = Motion.between(pos_ned, stop_ned)
        beside_m, stacked_m = self._beside_limit.limit_m, self._stacked_limit.limit_m
        for zone in self.zones:
            if _is_inside(zone, motion, beside_m, stacked_m, floor_applies):
                continue  # nearly always, and without an object for each face
            for measure in self._stop_measures(zone, motion, floor_applies):
                if self.stop_limit(measure.face).broken_by(measure):
                    return measure
        return None

    def stop_limit(self, face: Face) -> StopLimit:
        """The limit for a predicted stop.  The slack may let it leave an inclusion zone, but never
        enter an exclusion zone."""
        if face is Face.SIDES:
            return self._beside_limit
        return self._body_limit if face is Face.BODY else self._stacked_limit

    @cached_property
    def _stacked_limit(self) -> StopLimit:
        p, b = self.policy, self.braking
        slack_m = self._slack_m(p.brake_slack_v_m, p.margin_v_m, b.position_error_v_m)
        return StopLimit(b.position_error_v_m, p.margin_v_m, slack_m, p.creep_m)

    @cached_property
    def _beside_limit(self) -> StopLimit:
        p, b = self.policy, self.braking
        slack_m = self._slack_m(p.brake_slack_h_m, p.margin_h_m, b.position_error_h_m)
        return StopLimit(b.position_error_h_m, p.margin_h_m, slack_m, p.creep_m)

    @cached_property
    def _body_limit(self) -> StopLimit:
        beside = self._beside_limit
        return replace(beside, slack_m=min(beside.slack_m, beside.error_m + beside.margin_m))

    def _slack_m(self, policy_m: float, margin_m: float, error_m: float) -> float:
        match self.slack:
            case Slack.ERROR:
                return min(policy_m, error_m)
            case Slack.POLICY:
                return policy_m
            case Slack.MARGIN:
                return max(policy_m, margin_m)

    def nearest(self, a_ned: Vec3, b_ned: Vec3) -> Margins:
        """The least horizontal and vertical distance from a-b to any boundary; inf without one."""
        motion = Motion.between(a_ned, b_ned)
        beside, stacked = [math.inf], [math.inf]
        for zone in self.zones:
            if not zone.inclusion:
                measure = swept_body_measure(zone, motion, self.policy.margin_v_m)
                beside.append(math.inf if measure is None else measure.least_m)
                continue
            for measure in inclusion_measures(zone, motion, floor_applies=True):
                (beside if measure.face is Face.SIDES else stacked).append(measure.least_m)
        return Margins(min(beside), min(stacked))

    def _need(self, face: Face, margin_m: float) -> float:
        """The clearance that counts as keeping the margin.

        What is too close to say counts as not keeping it, unless the policy's bounds are inclusive
        and the zone is an inclusion zone.
        """
        given = self.policy.bounds_inclusive and face is not Face.BODY
        return margin_m - TOLERANCE_M if given else margin_m + TOLERANCE_M

    def _outermost(self, face: Face) -> float:
        return self._need(face, self.stop_limit(face).outermost_m)

    def _no_nearer(self, face: Face, margin_m: float, start_m: float) -> float:
        """The clearance that a motion keeps that starts with `start_m`: the margin, or as near as
        it starts; and no less than any start must have."""
        start_m = max(start_m - TOLERANCE_M, self._outermost(face))
        return min(self._need(face, margin_m), start_m)

    def _point_measures(
        self, zone: Zone, here: Motion, floor_applies: bool, margins: Margins
    ) -> Iterator[Measure]:
        if zone.inclusion:
            yield from inclusion_measures(zone, here, floor_applies=floor_applies)
            return
        stacked_m = max(zone.floor_up_m - here.a_up_m, here.a_up_m - zone.ceiling_up_m)
        if not stacked_m >= self._need(Face.BODY, margins.v_m):
            beside_m = -zone.shape.clearance(here.a_en)
            yield Measure(zone, Face.BODY, beside_m, beside_m)

    def _ring_measures(self, zone: Zone, here: Motion, radius_m: float) -> Iterator[Measure]:
        for m in self._point_measures(zone, here, True, self.margins):
            clear_m = m.least_m
            if m.face is Face.SIDES:
                clear_m = ring_inside(zone.shape, here.a_en, radius_m)
            elif m.face is Face.BODY:
                clear_m = ring_outside(zone.shape, here.a_en, radius_m)
            yield Measure(zone, m.face, clear_m, clear_m)

    def _hull_measures(
        self,
        zone: Zone,
        starts_ned: Sequence[Vec3],
        ends_ned: Sequence[Vec3],
        floor_applies: bool,
        margins: Margins,
    ) -> Iterator[Measure]:
        starts = [Motion.between(start, start) for start in starts_ned]
        points_enu = [enu_from_ned(pos_ned) for pos_ned in (*starts_ned, *ends_ned)]
        low, high = min(up for _, _, up in points_enu), max(up for _, _, up in points_enu)
        track = ground_track([(east, north) for east, north, _ in points_enu])
        if not zone.inclusion:
            near = (body_clearance(zone, m.a_en, m.a_up_m) for m in starts)
            start_m = min(near, default=math.inf)
            if not start_m >= TOLERANCE_M:
                yield Measure(zone, Face.BODY, start_m, start_m)
                return
            stacked_m = self._no_nearer(Face.BODY, margins.v_m, start_m)
            if low < zone.ceiling_up_m + stacked_m and high > zone.floor_up_m - stacked_m:
                yield Measure(zone, Face.BODY, start_m, hull_outside(zone.shape, track))
            return
        start_low = min((m.a_up_m for m in starts), default=math.inf)
        start_high = max((m.a_up_m for m in starts), default=-math.inf)
        start_m = min((zone.shape.clearance(m.a_en) for m in starts), default=math.inf)
        yield Measure(zone, Face.SIDES, start_m, hull_inside(zone.shape, track))
        top = zone.ceiling_up_m
        yield Measure(zone, Face.CEILING, top - start_high, top - high)
        if floor_applies:
            yield Measure(zone, Face.FLOOR, start_low - zone.floor_up_m, low - zone.floor_up_m)

    def _inclusion_leg(
        self, zone: Zone, subject: str, motion: Motion, margins: Margins, floor_applies: bool
    ) -> Refusal | None:
        for measure in inclusion_measures(zone, motion, floor_applies=floor_applies):
            margin_m = margins.of(measure.face)
            need_m = self._no_nearer(measure.face, margin_m, measure.start_m)
            inside = measure.start_m >= self._outermost(measure.face)
            if not (inside and measure.least_m >= need_m):
                return zone_refusal(subject, measure, margin_m, leg=True)
        return None

    def _exclusion_leg(
        self, zone: Zone, subject: str, motion: Motion, margins: Margins
    ) -> Refusal | None:
        start_m = body_clearance(zone, motion.a_en, motion.a_up_m)
        if not start_m >= TOLERANCE_M:
            return zone_refusal(
                subject, Measure(zone, Face.BODY, start_m, start_m), margins.h_m, leg=True
            )
        stacked_m = self._no_nearer(Face.BODY, margins.v_m, start_m)
        measure = swept_body_measure(zone, motion, stacked_m)
        if measure is None or measure.least_m >= self._no_nearer(Face.BODY, margins.h_m, start_m):
            return None
        return zone_refusal(subject, measure, margins.h_m, leg=True)

    def _stop_measures(self, zone: Zone, motion: Motion, floor_applies: bool) -> Sequence[Measure]:
        if zone.inclusion:
            return inclusion_measures(zone, motion, floor_applies=floor_applies)
        p, b = self.policy, self.braking
        above_m = max(0.0, b.position_error_v_m + p.margin_v_m - p.brake_slack_v_m)
        measure = swept_body_measure(zone, motion, above_m)
        return () if measure is None else (measure,)


def _is_inside(
    zone: Zone, motion: Motion, beside_m: float, stacked_m: float, floor_applies: bool
) -> bool:
    """Whether all of a motion is inside an inclusion zone by these distances from its sides, and
    from its ceiling and, where it applies, its floor."""
    if not zone.inclusion:
        return False
    a_en, a_up_m, b_en, b_up_m = motion
    return (
        zone.ceiling_up_m - max(a_up_m, b_up_m) >= stacked_m
        and (not floor_applies or min(a_up_m, b_up_m) - zone.floor_up_m >= stacked_m)
        and zone.shape.inner_clearance(a_en, b_en) >= beside_m
    )
