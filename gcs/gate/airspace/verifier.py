"""The verifier: may the vehicle go there, stay here, come back, and can it still stop?

A `Verifier` is immutable: a new home, origin, fence or autopilot makes a new one.  Every
question is answered from its arguments alone; freshness of the position is the machine's to
judge, before it asks.  Whatever is not finite, not known or beyond what can be computed with is
refused, with the fence on or off.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from gcs.frames import Vec3
from gcs.gate.airspace.clearance import NO_WIDTHS, Widths
from gcs.gate.airspace.explain import metres, place
from gcs.gate.airspace.judge import Judge
from gcs.gate.airspace.limits import STANDING, beyond_limits, beyond_reach, not_finite
from gcs.gate.airspace.prediction import bad_stop, stopping_numbers
from gcs.gate.airspace.projection import Origin, Projection
from gcs.gate.airspace.zones import Zone, build_zones
from gcs.gate.policy.policy import Policy
from gcs.gate.policy.zonespec import FileSpec, ZoneSpec
from gcs.gate.refusal import Code, Refusal

_BRAKE_STEPS = 16


@dataclass(frozen=True, slots=True)
class Cleared:
    """Yes, with the numbers it was decided on."""

    evidence: tuple[tuple[str, float], ...] = ()


@dataclass(frozen=True, slots=True)
class Breach:
    """The vehicle would come to rest outside, or is outside.

    `brake_pos_ned` is the verified point to stop at; None where there is none (the vehicle is
    outside already, or its position is no number): then the hold mode is all there is.
    """

    zone: str
    sentence: str
    numbers: tuple[tuple[str, float], ...]
    brake_pos_ned: Vec3 | None


@dataclass(frozen=True, slots=True)
class Verifier:
    """Positions and velocities are local NED, metres and metres per second.

    `zones` is the whole fence in the local frame.  An empty one with the fence on means that the
    fence is not known (yet), and refuses everything that moves; `unplaced` says why.
    """

    policy: Policy
    zones: tuple[Zone, ...]
    autopilot: str
    home_ned: Vec3 | None
    origin_known: bool
    fence_on: bool = True
    unplaced: Refusal | None = None

    # ------------------------------------------------------------------------ questions

    def goal(
        self, goal_ned: Vec3, yaw_rad: float | None, pos_ned: Vec3, v_ned: Vec3
    ) -> Cleared | Refusal:
        """May the vehicle at `pos_ned`, moving at `v_ned`, fly straight to `goal_ned`?

        In this order: finite, altitude, distance, zones, leg, stopping distance.
        """
        yaw = () if yaw_rad is None else (yaw_rad,)
        refusal = self._unusable(goal=goal_ned, yaw=yaw, position=pos_ned, velocity=v_ned)
        if refusal is not None:
            return refusal
        judge, there = self._judge, place(goal_ned)
        refusal = (
            self._limits(f"goal {there}", goal_ned)
            or beyond_reach(pos_ned, v_ned)
            or judge.point(f"goal {there}", goal_ned, floor_applies=True)
            or judge.leg(
                f"the leg to {there}", pos_ned, goal_ned, judge.margins, floor_applies=True
            )
            or self._cannot_stop(pos_ned, v_ned, floor_applies=True)
        )
        return refusal or Cleared(
            (
                *self._nearest("goal", goal_ned, goal_ned),
                *self._nearest("leg", pos_ned, goal_ned),
                ("leg_m", math.dist(pos_ned, goal_ned)),
                *stopping_numbers(judge, v_ned),
            )
        )

    def hold_point(self, pos_ned: Vec3, v_ned: Vec3, *, floor_applies: bool) -> Cleared | Refusal:
        """May the vehicle stay where it is?

        A hold goes nowhere, so it need not keep the margin of a goal: it must be inside, within
        the limits, and the vehicle must be able to stop inside.
        """
        refusal = self._unusable(position=pos_ned, velocity=v_ned)
        if refusal is not None:
            return refusal
        judge, subject = self._judge, f"position {place(pos_ned)}"
        refusal = (
            self._limits(subject, pos_ned, allow=self._error(), floor_applies=floor_applies)
            or beyond_reach(pos_ned, v_ned)
            or judge.outside(subject, pos_ned, floor_applies=floor_applies)
            or self._cannot_stop(pos_ned, v_ned, floor_applies=floor_applies)
        )
        return refusal or Cleared(
            (*self._nearest("hold", pos_ned, pos_ned), *stopping_numbers(judge, v_ned))
        )

    def takeoff(self, up_m: float, pos_ned: Vec3) -> Cleared | Refusal:
        """May the vehicle climb straight up to `up_m` metres above where it stands?

        The floor does not apply to the climb; the top is a place to hover, so there it does.
        """
        refusal = self._unusable(height=(up_m,), position=pos_ned)
        if refusal is not None:
            return refusal
        most_m = self.policy.takeoff.max_up_m
        if up_m > most_m:
            sentence = f"take-off to {metres(up_m)} m, the policy's highest is {metres(most_m)} m"
            return Refusal(Code.TOO_HIGH, sentence, (("up_m", up_m), ("max_up_m", most_m)))
        if up_m <= 0.0:
            return Refusal(
                Code.TOO_LOW, f"take-off to {metres(up_m)} m is no climb", (("up_m", up_m),)
            )
        judge, top_ned = self._judge, (pos_ned[0], pos_ned[1], pos_ned[2] - up_m)
        top, climb = f"take-off top {place(top_ned)}", f"the climb to {place(top_ned)}"
        refusal = (
            beyond_reach(pos_ned)
            or self._limits(top, top_ned)
            or judge.point(top, top_ned, floor_applies=True)
            or judge.leg(climb, pos_ned, top_ned, judge.margins, floor_applies=False)
        )
        return refusal or Cleared((*self._nearest("top", top_ned, top_ned), ("leg_m", up_m)))

    def predicted_stop(self, pos_ned: Vec3, v_ned: Vec3, *, floor_applies: bool) -> Breach | None:
        """Would the vehicle, told to stop now, come to rest outside (or is it there)?

        Without the floor the stop is clipped to the ground: a landing ends there.
        """
        unusable = self._unusable(position=pos_ned, velocity=v_ned) or beyond_reach(pos_ned, v_ned)
        if unusable is not None:
            return Breach(unusable.zone, unusable.sentence, unusable.numbers, None)
        bad = bad_stop(self._judge, self.home_ned, pos_ned, v_ned, floor_applies=floor_applies)
        if bad is None:
            return None
        brake_pos_ned = self._brake_point(pos_ned, bad.stop_ned, floor_applies=floor_applies)
        return Breach(bad.measure.zone.name, bad.sentence, bad.numbers, brake_pos_ned)

    def return_path(self, pos_ned: Vec3, home_ned: Vec3, return_up_m: float) -> Cleared | Refusal:
        """Is the vehicle's own way home clear: climb to its return height (metres above home,
        or stay if higher), straight leg, descent?

        A return is asked for to be safe, so no margin is demanded of it, only that it stays
        inside for certain.  The floor does not apply: it ends on the ground.
        """
        down_m = min(pos_ned[2], home_ned[2] - return_up_m)
        top_ned, over_ned = (*pos_ned[:2], down_m), (*home_ned[:2], down_m)
        blocked = (
            self._unusable(position=pos_ned, home=home_ned, height=(return_up_m,))
            or beyond_reach(pos_ned)
            or beyond_reach((*home_ned[:2], down_m))
            or self._return_leg("the climb to return height", pos_ned, top_ned)
            or self._return_leg("the way home", top_ned, over_ned)
            or self._return_leg("the descent at home", over_ned, home_ned)
        )
        if blocked is not None:
            sentence = f"return blocked: {blocked.sentence}"
            return Refusal(Code.RTL_BLOCKED, sentence, blocked.numbers, blocked.zone)
        numbers = self._nearest("leg", top_ned, over_ned)
        return Cleared((*numbers, ("leg_m", math.dist(top_ned, over_ned))))

    def path(
        self,
        legs: Sequence[tuple[Vec3, Vec3]],
        circles: Sequence[tuple[Vec3, float]] = (),
        floor_free: frozenset[int] = frozenset(),
    ) -> Cleared | tuple[int, Refusal]:
        """A mission, whole: every leg with its end, every loiter circle (centre, radius).

        `floor_free` holds the indices of the legs that leave or reach the ground.  The first
        thing refused is returned with its index; circles are counted on after the legs.  The
        disc of a circle, not its rim alone, has to be clear.
        """
        for i, (a_ned, b_ned) in enumerate(legs):
            refusal = self._mission_leg(a_ned, b_ned, floor_applies=i not in floor_free)
            if refusal is not None:
                return i, refusal
        for i, (centre_ned, radius_m) in enumerate(circles, start=len(legs)):
            refusal = self._mission_circle(centre_ned, radius_m)
            if refusal is not None:
                return i, refusal
        length_m = sum(math.dist(a, b) for a, b in legs)
        return Cleared((("legs", float(len(legs))), ("length_m", length_m)))

    def start(self, pos_ned: Vec3) -> Refusal | None:
        """See `check_start`."""
        return (
            self._unusable(position=pos_ned)
            or beyond_reach(pos_ned)
            or self._judge.outside(f"start position {place(pos_ned)}", pos_ned, floor_applies=False)
        )

    # -------------------------------------------------------------------------- answers

    @property
    def _judge(self) -> Judge:
        zones = self.zones if self.fence_on else ()
        return Judge(zones, self.policy, self.policy.braking_of(self.autopilot))

    def _unusable(self, **values: Sequence[float]) -> Refusal | None:
        """NON_FINITE for numbers that are none, NO_ORIGIN for a fence that is not known."""
        refusal = not_finite({"home": self.home_ned or (), **values})
        if refusal is None and self.fence_on and not self.zones:
            return self.unplaced or Refusal(Code.NO_ORIGIN, "the fence is not known yet")
        return refusal

    def _limits(
        self, subject: str, pos_ned: Vec3, *, allow: Widths = NO_WIDTHS, floor_applies: bool = True
    ) -> Refusal | None:
        """From home, or from the local origin until home is known."""
        home_ned = self.home_ned or STANDING
        return beyond_limits(
            self.policy, home_ned, subject, pos_ned, allow=allow, floor_applies=floor_applies
        )

    def _error(self) -> Widths:
        b = self.policy.braking_of(self.autopilot)
        return Widths(b.position_error_h_m, b.position_error_v_m)

    def _cannot_stop(self, pos_ned: Vec3, v_ned: Vec3, *, floor_applies: bool) -> Refusal | None:
        bad = bad_stop(self._judge, self.home_ned, pos_ned, v_ned, floor_applies=floor_applies)
        if bad is None:
            return None
        return Refusal(Code.CANNOT_STOP, bad.sentence, bad.numbers, bad.measure.zone.name)

    def _nearest(self, what: str, a_ned: Vec3, b_ned: Vec3) -> tuple[tuple[str, float], ...]:
        """Distances to the nearest boundary; left out where there is none."""
        near = self._judge.nearest(a_ned, b_ned)
        named = ((f"{what}_clear_h_m", near.h_m), (f"{what}_clear_v_m", near.v_m))
        return tuple((name, value) for name, value in named if math.isfinite(value))

    def _brake_point(self, pos_ned: Vec3, stop_ned: Vec3, *, floor_applies: bool) -> Vec3 | None:
        """The predicted stop, pulled back until it is a place that would be verified as a goal;
        else the present position where that may be held; else nowhere."""
        judge = self._judge
        for step in range(_BRAKE_STEPS, -1, -1):
            t = step / _BRAKE_STEPS
            n, e, d = (a + t * (b - a) for a, b in zip(pos_ned, stop_ned, strict=True))
            point_ned = (n, e, self._above_ground(d, floor_applies=floor_applies))
            if (
                self._limits("brake", point_ned, floor_applies=floor_applies) is None
                and judge.point("brake", point_ned, floor_applies=floor_applies) is None
                and judge.leg(
                    "brake", pos_ned, point_ned, judge.margins, floor_applies=floor_applies
                )
                is None
            ):
                return point_ned
        n, e, d = pos_ned
        here_ned = (n, e, self._above_ground(d, floor_applies=floor_applies))
        here = self.hold_point(here_ned, STANDING, floor_applies=floor_applies)
        return here_ned if isinstance(here, Cleared) else None

    def _above_ground(self, down_m: float, *, floor_applies: bool) -> float:
        """Where no floor is asked for, the ground is one all the same: no brake points below it."""
        if floor_applies or self.home_ned is None:
            return down_m
        return min(down_m, self.home_ned[2])

    def _return_leg(self, subject: str, a_ned: Vec3, b_ned: Vec3) -> Refusal | None:
        return self._judge.leg(subject, a_ned, b_ned, NO_WIDTHS, floor_applies=False)

    def _mission_leg(self, a_ned: Vec3, b_ned: Vec3, *, floor_applies: bool) -> Refusal | None:
        judge = self._judge
        subject = f"waypoint {place(b_ned)}" if all(map(math.isfinite, b_ned)) else "a waypoint"
        return (
            self._unusable(waypoint=(*a_ned, *b_ned))
            or self._limits(subject, b_ned, floor_applies=floor_applies)
            or beyond_reach(a_ned)
            or judge.point(subject, b_ned, floor_applies=floor_applies)
            or judge.leg(
                f"the leg to {place(b_ned)}",
                a_ned,
                b_ned,
                judge.margins,
                floor_applies=floor_applies,
            )
        )

    def _mission_circle(self, centre_ned: Vec3, radius_m: float) -> Refusal | None:
        refusal = self._unusable(circle=(*centre_ned, radius_m))
        if refusal is not None:
            return refusal
        reach_m = abs(radius_m)
        subject = f"the circle of {metres(reach_m)} m about {place(centre_ned)}"
        return self._limits(subject, centre_ned, allow=Widths(-reach_m, 0.0)) or self._judge.point(
            subject, centre_ned, floor_applies=True, radius_m=reach_m
        )


def verifier_for(
    policy: Policy,
    autopilot: str,
    home_ned: Vec3 | None,
    origin: Origin | None,
    plan_zones: Sequence[ZoneSpec] = (),
    *,
    fence_on: bool = True,
) -> Verifier:
    """A verifier over the policy's fence and a plan's, placed from what is known now.

    `plan_zones` are those of a plan file, the policy's own fence file included.  All zones are
    placed or none: with one missing, everything that moves is refused with the reason of that one.
    """
    projection = None if origin is None else Projection(origin, autopilot)
    built = build_zones((*policy.fence, *plan_zones), home_ned, projection)
    unread = [z.name for z in policy.fence if isinstance(z.shape, FileSpec)]
    if unread and not plan_zones:
        sentence = f"the zones of fence file '{unread[0]}' are not known"
        built = Refusal(Code.NO_ORIGIN, sentence, zone=unread[0])
    zones, unplaced = ((), built) if isinstance(built, Refusal) else (built, None)
    known = origin is not None
    return Verifier(policy, zones, autopilot, home_ned, known, fence_on, unplaced)


def check_start(verifier: Verifier, pos_ned: Vec3) -> Refusal | None:
    """Is the vehicle inside the fence where it starts?  Neither floor nor margin applies."""
    return verifier.start(pos_ned)
