"""The zones' own verdicts: is a place, a leg, a stop clear of every one of them?

Knows the fence and the policy's distances, and nothing of limits, home or finite numbers: its
caller, the verifier, has seen to those.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

from gcs.frames import Vec3
from gcs.gate.airspace.clearance import (
    NO_WIDTHS,
    Face,
    Keep,
    Measure,
    Motion,
    Widths,
    body_clearance,
    inclusion_measures,
    leg_body_clearance,
    swept_body_measure,
)
from gcs.gate.airspace.explain import zone_refusal
from gcs.gate.airspace.zones import Zone
from gcs.gate.geometry import TOLERANCE_M
from gcs.gate.policy.policy import Braking, Policy
from gcs.gate.refusal import Refusal


@dataclass(frozen=True, slots=True)
class Judge:
    zones: tuple[Zone, ...]
    policy: Policy
    braking: Braking

    @property
    def margins(self) -> Widths:
        return Widths(self.policy.margin_h_m, self.policy.margin_v_m)

    def point(
        self, subject: str, pos_ned: Vec3, *, floor_applies: bool, radius_m: float = 0.0
    ) -> Refusal | None:
        """Clear by the margin, a disc of `radius_m` about `pos_ned` included."""
        here = Motion.between(pos_ned, pos_ned)
        for zone in self.zones:
            for measure in self._point_measures(zone, here, floor_applies, radius_m):
                margin_m = self.margins.of(measure.face)
                if not measure.least_m >= self._need(measure.face, margin_m):
                    return zone_refusal(subject, measure, margin_m, leg=False)
        return None

    def leg(
        self, subject: str, a_ned: Vec3, b_ned: Vec3, margins: Widths, *, floor_applies: bool
    ) -> Refusal | None:
        """Clear all along by the margin; or, where it starts nearer, never nearer than that."""
        motion = Motion.between(a_ned, b_ned)
        for zone in self.zones:
            if zone.inclusion:
                refusal = self._inclusion_leg(zone, subject, motion, margins, floor_applies)
            else:
                refusal = self._exclusion_leg(zone, subject, motion, margins)
            if refusal is not None:
                return refusal
        return None

    def outside(self, subject: str, pos_ned: Vec3, *, floor_applies: bool) -> Refusal | None:
        """Inside at all (by the lab's slack, where there is one); no margin is asked for."""
        here = Motion.between(pos_ned, pos_ned)
        for zone in self.zones:
            for measure in self._point_measures(zone, here, floor_applies, 0.0, NO_WIDTHS):
                if not measure.least_m >= self._outermost(measure.face):
                    return zone_refusal(subject, measure, 0.0, leg=False)
        return None

    def broken_stop(self, pos_ned: Vec3, stop_ned: Vec3, *, floor_applies: bool) -> Measure | None:
        """The first face that the way from here to the stop does not keep clear of."""
        motion = Motion.between(pos_ned, stop_ned)
        measures = self._stop_measures(motion, floor_applies)
        return next((m for m in measures if self.keep(m.face).broken_by(m)), None)

    def keep(self, face: Face) -> Keep:
        """The slack reaches out of an inclusion zone, never into an exclusion zone."""
        p, b = self.policy, self.braking
        if face in (Face.CEILING, Face.FLOOR):
            return Keep(b.position_error_v_m, p.margin_v_m, p.brake_slack_v_m, p.creep_m)
        slack_m = p.brake_slack_h_m
        if face is Face.BODY:
            slack_m = min(slack_m, b.position_error_h_m + p.margin_h_m)
        return Keep(b.position_error_h_m, p.margin_h_m, slack_m, p.creep_m)

    def nearest(self, a_ned: Vec3, b_ned: Vec3) -> Widths:
        """How near a-b comes to any boundary, beside it and above or below; inf for none."""
        motion = Motion.between(a_ned, b_ned)
        beside, stacked = [math.inf], [math.inf]
        for zone in self.zones:
            if not zone.inclusion:
                clear_m = leg_body_clearance(zone, motion, self.policy.margin_v_m)
                beside.append(math.inf if clear_m is None else clear_m)
                continue
            for measure in inclusion_measures(zone, motion, floor_applies=True):
                (beside if measure.face is Face.SIDES else stacked).append(measure.least_m)
        return Widths(min(beside), min(stacked))

    def _need(self, face: Face, margin_m: float) -> float:
        """What counts as clear for certain.  A policy with inclusive bounds gives what is too
        close to say to the inside of an inclusion zone; an exclusion zone gets it always."""
        given = self.policy.bounds_inclusive and face is not Face.BODY
        return margin_m - TOLERANCE_M if given else margin_m + TOLERANCE_M

    def _outermost(self, face: Face) -> float:
        return self._need(face, self.keep(face).outermost_m)

    def _point_measures(
        self,
        zone: Zone,
        here: Motion,
        floor_applies: bool,
        radius_m: float,
        margins: Widths | None = None,
    ) -> Iterator[Measure]:
        if zone.inclusion:
            for m in inclusion_measures(zone, here, floor_applies=floor_applies):
                wide_m = radius_m if m.face is Face.SIDES else 0.0
                yield Measure(zone, m.face, m.start_m - wide_m, m.least_m - wide_m)
            return
        beside_m = -zone.shape.clearance(here.a_en) - radius_m
        stacked_m = max(zone.floor_up_m - here.a_up_m, here.a_up_m - zone.ceiling_up_m)
        if not stacked_m >= self._need(Face.BODY, (margins or self.margins).v_m):
            yield Measure(zone, Face.BODY, beside_m, beside_m)

    def _inclusion_leg(
        self, zone: Zone, subject: str, motion: Motion, margins: Widths, floor_applies: bool
    ) -> Refusal | None:
        for measure in inclusion_measures(zone, motion, floor_applies=floor_applies):
            margin_m = margins.of(measure.face)
            need_m = min(self._need(measure.face, margin_m), measure.start_m - TOLERANCE_M)
            inside = measure.start_m >= self._outermost(measure.face)
            if not (inside and measure.least_m >= need_m):
                return zone_refusal(subject, measure, margin_m, leg=True)
        return None

    def _exclusion_leg(
        self, zone: Zone, subject: str, motion: Motion, margins: Widths
    ) -> Refusal | None:
        start_m = body_clearance(zone, motion.a_en, motion.a_up_m)
        if not start_m >= TOLERANCE_M:
            return zone_refusal(
                subject, Measure(zone, Face.BODY, start_m, start_m), margins.h_m, leg=True
            )
        near_m = start_m - TOLERANCE_M
        beside_m = leg_body_clearance(zone, motion, min(self._need(Face.BODY, margins.v_m), near_m))
        if beside_m is None or beside_m >= min(self._need(Face.BODY, margins.h_m), near_m):
            return None
        return zone_refusal(
            subject, Measure(zone, Face.BODY, start_m, beside_m), margins.h_m, leg=True
        )

    def _stop_measures(self, motion: Motion, floor_applies: bool) -> Iterator[Measure]:
        for zone in self.zones:
            if zone.inclusion:
                yield from inclusion_measures(zone, motion, floor_applies=floor_applies)
                continue
            p, b = self.policy, self.braking
            above_m = max(0.0, b.position_error_v_m + p.margin_v_m - p.brake_slack_v_m)
            measure = swept_body_measure(zone, motion, above_m)
            if measure is not None:
                yield measure
