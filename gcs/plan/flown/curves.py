"""Where ArduCopter's spline waypoints lead: hulls of the curve, piece by piece.

A spline leg is a cubic Hermite curve from P to Q with tangents m and n, which is the Bezier curve
with the control points P, P + m / 3, Q - n / 3 and Q.  Any piece of it is a Bezier curve too, and
lies in the hull of its own control points.  An ArduCopter does not slow down before a bend: it
cuts across towards the control points, up to 5 m beside the curve.  The hulls of the two halves,
1.5 m wider (3 m at twice the acceleration), hold all that was recorded but for 0.7 m
(`tests/real/facts`: 17 flights, legs of 15 to 80 m at 5 to 12 m/s, turns of 30 to 180 degrees);
those of smaller pieces do not.  The tangents, by memory of AC_WPNav::set_spline_destination:

m   at rest none; after a straight leg that leg; after a spline that spline's n;
n   where a spline follows, from P to the place after Q; where a straight leg follows, from Q to
    the place after it; else none;

both scaled down, where they are longer together than four times the way from P to Q
(SplineCurve::set_origin_and_destination).  vehicle-sim's are half as long, and at rest they are the
way from P to Q.  The hull of a piece is that of both, and so of all that lies between.

Where a mission goes on to from a spline waypoint without a stop is told here, too (`ways_on`).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass
from typing import TypeAlias

from gcs.frames import Vec3
from gcs.gate.airspace.hulls import ground_track
from gcs.plan.commands import KINDS, Kind
from gcs.plan.flown.overshoot import ahead, between, past
from gcs.plan.item_places import ItemPlaces, PlaceUnknownError
from gcs.plan.items import Flown, flown_as
from gcs.plan.jumps import jump_target
from gcs.plan.model import AutopilotName, Plan

_LAG_M = 4.0
"""Where the target has left the curve, the vehicle may be so far behind it (vehicle-sim's; an
ArduCopter's error of position in WP_NAV is limited to a few metres as well, by memory)."""
_PIECES = 2
_TANGENTS_MAX = 4.0
_SHARES = (0.5, 1.0)
_REST: Vec3 = (0.0, 0.0, 0.0)
_STEPS = 16
"""In which the place is looked for where the vehicle is at the end of a curve."""

_ROUND = tuple((math.sin(0.25 * math.pi * n), math.cos(0.25 * math.pi * n)) for n in range(8))

Bezier: TypeAlias = tuple[Vec3, Vec3, Vec3, Vec3]

_THROUGH = (Flown.STRAIGHT, Flown.STAYS, Flown.CURVE)


@dataclass(frozen=True, slots=True)
class Onward:
    """Where the mission goes on to after a curve, and whether as a curve."""

    to_ned: Vec3
    curved: bool


@dataclass(frozen=True, slots=True)
class Neighbours:
    """Where the leg before began, None if there was none, whether that was a curve, and whether it
    may have ended at rest; where this one may go on to without a stop, and whether it may end at
    rest."""

    before_ned: Vec3 | None
    before_curved: bool
    may_rest: bool
    onward: tuple[Onward, ...]
    may_stop: bool


@dataclass(frozen=True, slots=True)
class Spline:
    """One way to fly the curve; `onward` None: it ends at rest."""

    controls: Bezier
    onward: Onward | None

    def at(self, share: float) -> Vec3:
        return _blossom(self.controls, share, share, share)

    def ends(self, accept_m: float, reach_m: float) -> tuple[Vec3, tuple[Vec3, Vec3]]:
        """Where the vehicle may be when the curve ends for it: behind its end; and past that, as
        the curve and as its chord lead there."""
        p, _, q_before, q = self.controls
        left_m = max(accept_m, _LAG_M)
        steps = (1.0 - step / _STEPS for step in range(1, _STEPS + 1))
        share = next((s for s in steps if math.dist(self.at(s), q) >= left_m), 0.0)
        return self.at(share), (past(q_before, q, reach_m), past(p, q, reach_m))


def splines(starts: Sequence[Vec3], to_ned: Vec3, neighbours: Neighbours) -> tuple[Spline, ...]:
    """All ways to fly it from each of `starts`."""
    return tuple(
        Spline(_controls(start, to_ned, entering, leaving, share), onward)
        for start in starts
        for entering in _entering(start, to_ned, neighbours)
        for leaving, onward in _leaving(start, to_ned, neighbours)
        for share in _SHARES
    )


def pieces(found: Sequence[Spline], wider_m: float) -> tuple[tuple[Vec3, ...], ...]:
    """Points whose hulls hold the pieces of the curves, one after the other, and `wider_m` about
    them."""
    return tuple(
        prism([point for one in found for point in _piece(one.controls, n)], wider_m)
        for n in range(_PIECES)
    )


def prism(points: Sequence[Vec3], wider_m: float) -> tuple[Vec3, ...]:
    """The corners of the points' outline on the ground, so much wider, at their lowest and their
    highest."""
    low, high = max(d for _, _, d in points), min(d for _, _, d in points)
    outline = ground_track([(e, n) for n, e, _ in points])
    if wider_m > 0.0:
        reach_m = wider_m / math.cos(math.pi / len(_ROUND))
        spread = [(e + reach_m * x, n + reach_m * y) for e, n in outline for x, y in _ROUND]
        outline = ground_track(spread)
    return tuple((n, e, d) for e, n in outline for d in dict.fromkeys((low, high)))


@dataclass(frozen=True, slots=True)
class _Tangent:
    """`whole`: as it is, neither shortened nor halved."""

    vector: Vec3
    whole: bool = False


def _at_rest(start: Vec3, to_ned: Vec3) -> tuple[_Tangent, ...]:
    return (_Tangent(_REST, whole=True), _Tangent(between(start, to_ned), whole=True))


def _entering(start: Vec3, to_ned: Vec3, neighbours: Neighbours) -> tuple[_Tangent, ...]:
    before_ned = neighbours.before_ned
    rest = _at_rest(start, to_ned) if neighbours.may_rest or before_ned is None else ()
    if before_ned is None:
        return rest
    return (*rest, _Tangent(between(before_ned, to_ned if neighbours.before_curved else start)))


def _leaving(
    start: Vec3, to_ned: Vec3, neighbours: Neighbours
) -> tuple[tuple[_Tangent, Onward | None], ...]:
    rest = _at_rest(start, to_ned) if neighbours.may_stop else ()
    return (
        *((tangent, None) for tangent in rest),
        *(
            (_Tangent(between(start if onward.curved else to_ned, onward.to_ned)), onward)
            for onward in neighbours.onward
        ),
    )


def _controls(
    start: Vec3, to_ned: Vec3, entering: _Tangent, leaving: _Tangent, share: float
) -> Bezier:
    size = sum(math.hypot(*one.vector) for one in (entering, leaving) if not one.whole)
    most = _TANGENTS_MAX * math.dist(start, to_ned)
    shorter = share * (most / size if size > most else 1.0)
    first, last = ((1.0 if one.whole else shorter) / 3.0 for one in (entering, leaving))
    after, before = ahead(start, entering.vector, first), ahead(to_ned, leaving.vector, -last)
    return start, after, before, to_ned


def _piece(controls: Bezier, number: int) -> Bezier:
    """The control points of one of the halves."""
    a, b = number / _PIECES, (number + 1) / _PIECES
    return (
        _blossom(controls, a, a, a),
        _blossom(controls, a, a, b),
        _blossom(controls, a, b, b),
        _blossom(controls, b, b, b),
    )


def _blossom(controls: Bezier, r: float, s: float, t: float) -> Vec3:
    """The polar form of the cubic (L. Ramshaw, 1989): at t, t, t it is the curve's point."""
    p, q, u, v = controls
    a, b, c = _mixed(p, q, r), _mixed(q, u, r), _mixed(u, v, r)
    return _mixed(_mixed(a, b, s), _mixed(b, c, s), t)


def _mixed(a: Vec3, b: Vec3, t: float) -> Vec3:
    return (a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1]), a[2] + t * (b[2] - a[2]))


def ways_on(
    plan: Plan, index: int, places: ItemPlaces, autopilot: AutopilotName, pos_ned: Vec3
) -> tuple[tuple[Onward, ...], bool]:
    """Where it may go on to from item `index`, which ends at `pos_ned`, by every jump; and whether
    it may end at rest."""
    if plan.items[index].params[0] > 0.0:
        return (), True
    found: list[Onward] = []
    waiting, seen = [index + 1], set[int]()
    while waiting:
        at = waiting.pop()
        if at in seen or at >= len(plan.items):
            continue
        seen.add(at)
        item = plan.items[at]
        if KINDS.get(item.command) in (Kind.MOVE, Kind.RETURN, Kind.WAIT):
            flown = flown_as(item.command, autopilot)
            if flown in _THROUGH:
                with suppress(PlaceUnknownError):  # told when the walk comes to it
                    found.append(Onward(places.place(item, pos_ned), flown is Flown.CURVE))
            continue
        waiting.append(at + 1)
        target = jump_target(plan, item) if KINDS.get(item.command) is Kind.JUMP else None
        if target is not None:
            waiting.append(target)
    after = plan.items[index + 1] if index + 1 < len(plan.items) else None
    at_once = after is not None and flown_as(after.command, autopilot) in _THROUGH
    return tuple(found), not (at_once and found)
