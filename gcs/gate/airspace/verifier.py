"""The verifier: may the vehicle fly to a goal, stay, take off, return, and can it still stop?

A `Verifier` is immutable: a new home, origin, fence or autopilot makes a new one.  Every question
is answered from its arguments alone; the state machine makes sure before it asks that the position
is fresh.  Numbers that are not finite, not known or too large to compute with are refused, whether
the fence is on or off.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Final

from gcs.enu_text import place
from gcs.frames import Vec3
from gcs.gate.airspace.attitude_samples import BeforeThis, flies_too_fast
from gcs.gate.airspace.clearance import NO_MARGINS, Margins
from gcs.gate.airspace.explain import metres
from gcs.gate.airspace.judge import FenceJudge
from gcs.gate.airspace.limits import STANDING, beyond_limits, beyond_reach, not_finite
from gcs.gate.airspace.prediction import BadStop, bad_overshoot, bad_stop, stopping_numbers
from gcs.gate.airspace.projection import Origin, Projection
from gcs.gate.airspace.return_place import HOME, ReturnPlace
from gcs.gate.airspace.stopping import Path, predicted_stop, stops_of
from gcs.gate.airspace.stream_samples import (
    StreamSample,
    beyond_rules,
    places_of_rest,
    sample_counts_s,
    velocities,
)
from gcs.gate.airspace.zones import Zone, build_zones
from gcs.gate.geometry import TOLERANCE_M
from gcs.gate.policy.policy import Policy
from gcs.gate.policy.zonespec import ZoneSpec
from gcs.gate.refusal import Code, Refusal

BRAKE_STEPS: Final = 16
"""How many positions between the predicted stop and the vehicle are tried for the brake."""

WIND_DRIFT_S: Final = 0.25
"""So far beside its path a vehicle is that flies a mission, for each m/s of wind: in 431 random
missions of vehicle-sim in up to 8 m/s it was 1.7 m at the most."""

LOCAL_ORIGIN: Final[Vec3] = (0.0, 0.0, 0.0)


@dataclass(frozen=True, slots=True)
class Cleared:
    """The verifier allows it; `evidence` has the numbers that this was decided on."""

    evidence: tuple[tuple[str, float], ...] = ()


@dataclass(frozen=True)
class Breach:
    """The vehicle would stop outside the fence, or is outside already.

    `towards` is who judged it, and the way to the predicted stop; None where that is not finite.
    """

    zone: str
    sentence: str
    numbers: tuple[tuple[str, float], ...]
    towards: WayToStop | None

    @cached_property
    def brake_pos_ned(self) -> Vec3 | None:
        """A verified position to stop at.  None where there is none, because the vehicle is outside
        or its position is not finite: then only hold mode is left.

        Looked for when it is asked for: a vehicle that is held already is not braked again, and its
        breach is predicted with every position."""
        way = self.towards
        if way is None:
            return None
        return way.verifier.brake_point(way.pos_ned, way.stop_ned, floor_applies=way.floor_applies)


@dataclass(frozen=True, slots=True)
class WayToStop:
    """From where to where, and whose floors count."""

    verifier: Verifier
    pos_ned: Vec3
    stop_ned: Vec3
    floor_applies: bool


@dataclass(frozen=True, slots=True)
class Verifier:
    """Answers for one fence, home and autopilot.  Positions and velocities are local NED, in metres
    and metres per second.

    `zones` is the whole fence in the local frame.  Where it is empty and the fence is on, the fence
    is not known yet: everything that moves is refused, and `unplaced` says why.
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
        self,
        goal_ned: Vec3,
        yaw_rad: float | None,
        pos_ned: Vec3,
        v_ned: Vec3,
        path: Path = None,
        gained_ned: Sequence[Vec3] = (),
    ) -> Cleared | Refusal:
        """May the vehicle at `pos_ned`, moving at `v_ned`, fly straight to `goal_ned`?

        `path` is the leg to that goal, where it is flown already; `gained_ned` are velocities that
        the vehicle may have as well, on its way to somewhere else.

        In this order: finite, altitude, distance, zones, leg, overshoot, stopping distance.
        """
        yaw = () if yaw_rad is None else (yaw_rad,)
        refusal = self._unusable(goal=goal_ned, yaw=yaw, position=pos_ned, velocity=v_ned)
        if refusal is not None:
            return refusal
        judge, there = self._judge, place(goal_ned)
        overshoot = self.policy.overshoot_of(self.autopilot)
        refusal = (
            self._limits(f"goal {there}", goal_ned)
            or beyond_reach(pos_ned, v_ned)
            or judge.point(f"goal {there}", goal_ned, floor_applies=True)
            or judge.leg(
                f"the leg to {there}", pos_ned, goal_ned, judge.margins, floor_applies=True
            )
            or bad_overshoot(judge, f"goal {there}", pos_ned, goal_ned, overshoot)
            or self._cannot_stop(pos_ned, v_ned, path, floor_applies=True)
            or self._cannot_stop_gained(pos_ned, gained_ned, floor_applies=True)
        )
        return refusal or Cleared(
            (
                *self._nearest("goal", goal_ned, goal_ned),
                *self._nearest("leg", pos_ned, goal_ned),
                ("leg_m", math.dist(pos_ned, goal_ned)),
                *stopping_numbers(judge, v_ned),
            )
        )

    def hold_point(
        self,
        pos_ned: Vec3,
        v_ned: Vec3,
        gained_ned: Sequence[Vec3] = (),
        *,
        floor_applies: bool,
    ) -> Cleared | Refusal:
        """May the vehicle stay where it is?

        The margin is not asked for, because a hold leads nowhere: the position must be inside the
        fence and within the limits, and the vehicle must be able to stop inside.
        """
        refusal = self._unusable(position=pos_ned, velocity=v_ned)
        if refusal is not None:
            return refusal
        judge, subject = self._judge, f"position {place(pos_ned)}"
        refusal = (
            self._limits(subject, pos_ned, allow=self._error(), floor_applies=floor_applies)
            or beyond_reach(pos_ned, v_ned)
            or judge.outside(subject, pos_ned, floor_applies=floor_applies)
            or self._cannot_stop(pos_ned, v_ned, None, floor_applies=floor_applies)
            or self._cannot_stop_gained(pos_ned, gained_ned, floor_applies=floor_applies)
        )
        return refusal or Cleared(
            (*self._nearest("hold", pos_ned, pos_ned), *stopping_numbers(judge, v_ned))
        )

    def stream_sample(
        self,
        sample: StreamSample,
        pos_ned: Vec3,
        v_ned: Vec3,
        age_s: float,
        before: Sequence[BeforeThis] = (),
        gained_ned: Sequence[Vec3] = (),
    ) -> Cleared | Refusal:
        """May a sample of a client's stream be flown, by a position that is `age_s` old?

        Its position is judged as a goal is.  For a velocity, an acceleration or an attitude the
        vehicle must be able to stop inside by the margin after it has flown that, or gone on as it
        flies now, for as long as the sample counts; see `stream_samples.py`.  `before` is how it
        leant for the attitudes that the sample follows, `gained_ned` the velocities that it may
        have as well, on its way to somewhere else.
        """
        refusal = self._unusable(position=pos_ned, velocity=v_ned, **sample.numbers)
        refusal = (
            refusal or beyond_rules(sample, self.policy.stream) or beyond_reach(pos_ned, v_ned)
        )
        if refusal is None and sample.attitude is not None:
            refusal = flies_too_fast(v_ned, self.policy.stream)
        if refusal is not None:
            return refusal
        evidence: tuple[tuple[str, float], ...] = ()
        if sample.pos_ned is not None:
            goal = self.goal(sample.pos_ned, sample.yaw_rad, pos_ned, v_ned, gained_ned=gained_ned)
            if isinstance(goal, Refusal):
                return goal
            evidence = goal.evidence
            if sample.v_ned is None and not before:
                return goal
        asked = () if sample.attitude is None else (("tilt_deg", sample.attitude.tilt_deg),)
        flown = self._stream_velocity(sample, pos_ned, v_ned, age_s, before, gained_ned)
        return flown or Cleared(
            (
                *evidence,
                *asked,
                *stopping_numbers(self._judge, sample.v_ned or v_ned),
                ("age_s", age_s),
            )
        )

    def _stream_velocity(
        self,
        sample: StreamSample,
        pos_ned: Vec3,
        v_ned: Vec3,
        age_s: float,
        before: Sequence[BeforeThis],
        gained_ned: Sequence[Vec3],
    ) -> Refusal | None:
        """Refuses what leads to velocities that the vehicle could not stop from inside."""
        rules, braking = self.policy.stream, self.policy.braking_of(self.autopilot)
        counts_s = sample_counts_s(age_s, rules)
        flown = (*velocities(sample, v_ned, age_s, before, braking, rules), *gained_ned)
        # With a position too, the vehicle may come to rest as far beyond that as beyond its own.
        begins = (pos_ned,) if sample.pos_ned is None else (pos_ned, sample.pos_ned)
        rest = [p for begin in begins for p in places_of_rest(begin, flown, counts_s, braking)]
        judge, keep, error = self._judge, self._judge.margins, self._error()
        margins = Margins(keep.h_m + error.h_m, keep.v_m + error.v_m)
        fastest_m_s = max(math.hypot(*v) for v in flown)
        subject = f"the way to a stop from {metres(fastest_m_s)} m/s"
        beyond = (self._limits(subject, place, allow=error) for place in rest)
        refusal = next(filter(None, beyond), None) or judge.hull(
            subject, (pos_ned,), rest, floor_applies=True, margins=margins
        )
        return None if refusal is None else replace(refusal, code=Code.CANNOT_STOP)

    def hold_ahead(self, pos_ned: Vec3, v_ned: Vec3, age_s: float) -> Vec3 | None:
        """Where to hold a vehicle that flies: where it is when the hold reaches it, if it may hover
        there, else as far on the way there as it may; None where no place clears.

        It flies past that while it brakes, and back.  A place farther ahead would send it on: px4
        in OFFBOARD flies the faster to a position the farther that is away.
        """
        if self._unusable(position=pos_ned, velocity=v_ned) or beyond_reach(pos_ned, v_ned):
            return None
        heard_s = age_s + self.policy.approach_of(self.autopilot).react_s
        north, east, down = (x + v * heard_s for x, v in zip(pos_ned, v_ned, strict=True))
        return self.brake_point(pos_ned, (north, east, down), floor_applies=True)

    def takeoff(self, up_m: float, pos_ned: Vec3) -> Cleared | Refusal:
        """May the vehicle climb straight up to `up_m` metres above where it stands?

        The floor does not apply to the climb.  It applies to its top, where the vehicle hovers.
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

    def predicted_stop(
        self, pos_ned: Vec3, v_ned: Vec3, path: Path = None, *, floor_applies: bool
    ) -> Breach | None:
        """Would the vehicle on this `path` come to rest outside, or is it outside already?

        Where the floor does not apply, the stop is no lower than the ground: a landing ends there.
        """
        unusable = self._unusable(position=pos_ned, velocity=v_ned) or beyond_reach(pos_ned, v_ned)
        if unusable is not None:
            return Breach(unusable.zone, unusable.sentence, unusable.numbers, None)
        bad = self._bad_stop(pos_ned, v_ned, path, floor_applies=floor_applies)
        if bad is None:
            return None
        way = WayToStop(self, pos_ned, bad.stop_ned, floor_applies)
        return Breach(bad.measure.zone.name, bad.sentence, bad.numbers, way)

    def return_paths(
        self, pos_ned: Vec3, places: Sequence[ReturnPlace], return_up_m: float
    ) -> Cleared | Refusal:
        """The vehicle's own return, which may end at any of `places`: each way must be clear.

        The numbers are those of the way that comes nearest to a zone beside it.
        """
        cleared: list[Cleared] = []
        for to in places:
            up_m = max(return_up_m, to.over_up_m)
            judged = self.return_path(pos_ned, to.ground_ned, up_m, to.name)
            if isinstance(judged, Refusal):
                return judged
            cleared.append(judged)
        return min(cleared, key=_least_clear_h_m)

    def return_path(
        self, pos_ned: Vec3, home_ned: Vec3, return_up_m: float, name: str = HOME
    ) -> Cleared | Refusal:
        """As `return_refusal`, with the numbers where the way home is clear."""
        refusal = self.return_refusal(pos_ned, home_ned, return_up_m, name)
        if refusal is not None:
            return refusal
        top_ned, over_ned = _way_home(pos_ned, home_ned, return_up_m)
        numbers = self._nearest("leg", top_ned, over_ned)
        return Cleared((*numbers, ("leg_m", math.dist(top_ned, over_ned))))

    def return_refusal(
        self, pos_ned: Vec3, home_ned: Vec3, return_up_m: float, name: str = HOME
    ) -> Refusal | None:
        """Why the vehicle's own way home is refused, or to the place `name` that stands for home;
        None if it is clear.

        It climbs to its return height (metres above home) unless it is higher, flies straight home
        and descends.  A return makes it safer, so no margin is asked for, only that it stays inside
        for certain.  The floor does not apply: a return ends on the ground.
        """
        top_ned, over_ned = _way_home(pos_ned, home_ned, return_up_m)
        way = "the way home" if name == HOME else f"the way to {name}"
        blocked = (
            self._unusable(position=pos_ned, home=home_ned, height=(return_up_m,))
            or beyond_reach(pos_ned)
            or beyond_reach(over_ned)
            or self._return_leg("the climb to return height", pos_ned, top_ned)
            or self._return_leg(way, top_ned, over_ned)
            or self._return_leg(f"the descent at {name}", over_ned, home_ned)
        )
        if blocked is None:
            return None
        sentence = f"return blocked: {blocked.sentence}"
        return Refusal(Code.RTL_BLOCKED, sentence, blocked.numbers, blocked.zone)

    def mission_leg(self, a_ned: Vec3, b_ned: Vec3, *, floor_applies: bool) -> Refusal | None:
        """Why a straight leg of a mission, or its end, is refused; None if both are clear.

        The floor does not apply to legs that leave or reach the ground.
        """
        judge, subject = self._mission_judge, f"waypoint {place(b_ned)}"
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

    def mission_region(
        self,
        subject: str,
        starts_ned: Sequence[Vec3],
        ends_ned: Sequence[Vec3],
        *,
        floor_applies: bool,
    ) -> Refusal | None:
        """Why the convex hull of the points, where a mission may fly, is refused; None if it is
        clear.

        As a leg, it may be as close to a boundary as its starts are.
        """
        points = (*starts_ned, *ends_ned)
        refusal = self._unusable(region=[value for point in points for value in point])
        if refusal is not None:
            return refusal
        for point in points:
            limit = self._limits(subject, point, floor_applies=floor_applies)
            if limit is not None:
                return limit
        return self._mission_judge.hull(subject, starts_ned, ends_ned, floor_applies=floor_applies)

    def mission_circle(self, centre_ned: Vec3, radius_m: float) -> Refusal | None:
        """Why a loiter circle is refused; None if it is clear.

        Its line counts and not its inside, where the mast may stand that it goes round.
        """
        refusal = self._unusable(circle=(*centre_ned, radius_m))
        if refusal is not None:
            return refusal
        reach_m = abs(radius_m)
        subject = f"the circle of {metres(reach_m)} m about {place(centre_ned)}"
        beyond = self._limits(subject, centre_ned, allow=Margins(-reach_m, 0.0))
        return beyond or self._mission_judge.ring(subject, centre_ned, reach_m)

    def mission_take_off(self, from_ned: Vec3, top_ned: Vec3) -> Refusal | None:
        """Why a take-off of a mission is refused: the policy's highest one binds it as well."""
        up_m, most_m = from_ned[2] - top_ned[2], self.policy.takeoff.max_up_m
        if up_m > most_m + TOLERANCE_M:
            sentence = f"take-off to {metres(up_m)} m, the policy's highest is {metres(most_m)} m"
            return Refusal(Code.TOO_HIGH, sentence, (("up_m", up_m), ("max_up_m", most_m)))
        return None

    def start(self, pos_ned: Vec3) -> Refusal | None:
        """See `check_start`."""
        return (
            self._unusable(position=pos_ned)
            or beyond_reach(pos_ned)
            or self._judge.outside(f"start position {place(pos_ned)}", pos_ned, floor_applies=False)
        )

    def outside(self, pos_ned: Vec3, *, for_certain: bool) -> Refusal | None:
        """Why a vehicle at `pos_ned` is outside the fence; None if it is not, or no fence is known.

        `for_certain`: by more than its position may be wrong.  The floor does not apply: every
        landing ends there.
        """
        if not all(map(math.isfinite, pos_ned)):
            return None
        allow = self._error() if for_certain else NO_MARGINS
        subject = f"position {place(pos_ned)}"
        return beyond_reach(pos_ned) or self._judge.outside(
            subject, pos_ned, floor_applies=False, allow=allow
        )

    # ---------------------------------------------------------------- parts of the answers

    @property
    def _judge(self) -> FenceJudge:
        zones = self.zones if self.fence_on else ()
        return FenceJudge(zones, self.policy, self.policy.braking_of(self.autopilot))

    @property
    def _mission_judge(self) -> FenceJudge:
        """No station holds a mission beside its path: its margin has room for the wind too."""
        return replace(self._judge, least_h_m=WIND_DRIFT_S * self.policy.mission_wind_m_s)

    def _unusable(self, **values: Sequence[float]) -> Refusal | None:
        """NON_FINITE where a number is not finite, NO_ORIGIN where the fence is not known."""
        refusal = not_finite({"home": self.home_ned or (), **values})
        if refusal is None and self.fence_on and not self.zones:
            return self.unplaced or Refusal(Code.NO_ORIGIN, "the fence is not known yet")
        return refusal

    def _limits(
        self,
        subject: str,
        pos_ned: Vec3,
        *,
        allow: Margins = NO_MARGINS,
        floor_applies: bool = True,
    ) -> Refusal | None:
        """The policy's limits, counted from the local origin until home is known."""
        home_ned = self.home_ned or LOCAL_ORIGIN
        return beyond_limits(
            self.policy, home_ned, subject, pos_ned, allow=allow, floor_applies=floor_applies
        )

    def _error(self) -> Margins:
        b = self.policy.braking_of(self.autopilot)
        return Margins(b.position_error_h_m, b.position_error_v_m)

    def _bad_stop(
        self, pos_ned: Vec3, v_ned: Vec3, path: Path, *, floor_applies: bool
    ) -> BadStop | None:
        stop_ned = predicted_stop(pos_ned, v_ned, path, stops_of(self.policy, self.autopilot))
        return bad_stop(
            self._judge, self.home_ned, pos_ned, v_ned, stop_ned, floor_applies=floor_applies
        )

    def _cannot_stop(
        self, pos_ned: Vec3, v_ned: Vec3, path: Path, *, floor_applies: bool
    ) -> Refusal | None:
        bad = self._bad_stop(pos_ned, v_ned, path, floor_applies=floor_applies)
        if bad is None:
            return None
        return Refusal(Code.CANNOT_STOP, bad.sentence, bad.numbers, bad.measure.zone.name)

    def _cannot_stop_gained(
        self, pos_ned: Vec3, gained_ned: Sequence[Vec3], *, floor_applies: bool
    ) -> Refusal | None:
        """As `_cannot_stop`, by velocities that are not reported yet."""
        for v_ned in gained_ned:
            refusal = self._cannot_stop(pos_ned, v_ned, None, floor_applies=floor_applies)
            if refusal is not None:
                sentence = f"it gains speed on its way: {refusal.sentence}"
                return replace(refusal, sentence=sentence)
        return None

    def _nearest(self, what: str, a_ned: Vec3, b_ned: Vec3) -> tuple[tuple[str, float], ...]:
        """The distances of a-b to the nearest boundary, as evidence; infinite ones are left out."""
        near = self._judge.nearest(a_ned, b_ned)
        named = ((f"{what}_clear_h_m", near.h_m), (f"{what}_clear_v_m", near.v_m))
        return tuple((name, value) for name, value in named if math.isfinite(value))

    def brake_point(self, pos_ned: Vec3, stop_ned: Vec3, *, floor_applies: bool) -> Vec3 | None:
        """Where to brake: the predicted stop, or the first position back from it towards the
        vehicle that would be accepted as a goal; else the vehicle's position, if it may stay
        there; else None."""
        judge = self._judge
        for step in range(BRAKE_STEPS, -1, -1):
            t = step / BRAKE_STEPS
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
        """No brake leads below the ground, even where the floor does not apply."""
        if floor_applies or self.home_ned is None:
            return down_m
        return min(down_m, self.home_ned[2])

    def _return_leg(self, subject: str, a_ned: Vec3, b_ned: Vec3) -> Refusal | None:
        return self._judge.leg(subject, a_ned, b_ned, NO_MARGINS, floor_applies=False)


def _way_home(pos_ned: Vec3, home_ned: Vec3, return_up_m: float) -> tuple[Vec3, Vec3]:
    """The ends of the straight leg: above the vehicle, and above home."""
    down_m = min(pos_ned[2], home_ned[2] - return_up_m)
    return (*pos_ned[:2], down_m), (*home_ned[:2], down_m)


def _least_clear_h_m(way: Cleared) -> float:
    """How near to a zone a way comes; infinite where there is none."""
    return dict(way.evidence).get("leg_clear_h_m", math.inf)


def verifier_for(
    policy: Policy,
    autopilot: str,
    home_ned: Vec3 | None,
    origin: Origin | None,
    plan_zones: Sequence[ZoneSpec] = (),
    *,
    fence_on: bool = True,
) -> Verifier:
    """A verifier for the policy's fence and the fence of a plan file, from what is known now.

    `plan_zones` are the zones of a mission's own fence.  Where one zone cannot be placed in the
    local frame yet, none is, and everything that moves is refused for that reason.
    """
    projection = None if origin is None else Projection(origin, autopilot)
    built = build_zones((*policy.fence, *plan_zones), home_ned, projection)
    zones, unplaced = ((), built) if isinstance(built, Refusal) else (built, None)
    known = origin is not None
    return Verifier(policy, zones, autopilot, home_ned, known, fence_on, unplaced)


def check_start(verifier: Verifier, pos_ned: Vec3) -> Refusal | None:
    """Is the vehicle inside the fence where it starts?  Neither floor nor margin applies."""
    return verifier.start(pos_ned)
