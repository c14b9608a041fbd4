"""How fast a vehicle is sent to a position: never faster than its hold fits.

An autopilot flies to a position that it is sent the faster the farther that is away, and a hold
takes longer from a higher speed than slowing down for the goal does.  So what is sent at each tick
is a position on the way to the goal, just so far ahead of the vehicle that the autopilot flies
towards it at the speed of this law, and slows down for it by itself where no other one follows.
What has held a PX4 against its drag is left in its integrator when it has slowed down: asked for no
speed it went on at 1.3 m/s for 2 s, and after 10 m/s its hold took 2.3 to 3.5 m from under 1 m/s.
The integrator takes 4.5 s to follow.  So where there is no room past the goal it is flown no faster
than `near`, and asked to fly back, no faster than it flies on and by up to `back`, until it does
slow down.

The speed is the least of

    most, or near                     the policy's, `[pace]`: with room past the goal, or without
    its share of what was asked for   so that level and vertical together are no faster than that
    v + gain                          it grows no faster than that, so the vehicle leans little
    p d,  or sqrt(2 a (d - a / 2 p^2)) for d > a / p^2
                                      a gentle end: d metres before the goal it slows down by a
    w with  w (react + lag + late) + w^2 / (2 a_brake)  inside every zone and height limit
                                      the stop of a hold from w fits, straight on from here

`react` and `a_brake` are the policy's `[braking]`, `late` is how old the reported position is, and
`lag` is how much later than asked the vehicle slows down, what its integrator carries on included.
Where there is room past the goal, one that is faster than the least of these, but not than its stop
fits from, slows down by itself: recorded on PX4 1.14.3, legs of 58 m, 7.3 to 7.5 s to within 1 m
and 2 m past the goal, where the bare goal takes 7.1 to 7.4 s and is passed by 2.0 to 2.7 m.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Final, NamedTuple

from msgspec import structs

from gcs.enu_text import fixed
from gcs.frames import Vec3
from gcs.gate.airspace.bounds import STANDING, Bounds
from gcs.gate.airspace.stopping import travel_m
from gcs.gate.policy.policy import Pace, Paces, Policy
from gcs.gate.refusal import Code, Refusal

FIRM: Final = 4.0
"""One that is faster than its stop fits from is asked for less, by this times the difference; where
there is no room past its goal, one that is faster than the law.  Recorded on PX4's own simulation,
whose drag keeps it fast: 147.8 m to 2.2 m before the fence ended 1.1 m outside with 1, 0.9 and
1.2 m inside with 3.  In open air it slows down as by itself: else it took a third longer."""
LAST_M: Final = 0.5
"""So near to its goal the goal itself is sent, where the stop from the speed of that fits; where no
stop fits, too: that speed is below CRAWL_M_S."""
CRAWL_M_S: Final = 1.0
"""The speed of one that is where no stop fits, such as outside: its verified way leads inside."""
HALVINGS: Final = 7
"""The speed that fits is found to a hundredth of the speed that is wanted."""


@dataclass(frozen=True, slots=True)
class Paced:
    """A position to send on the way to a goal, and the velocity at which the autopilot is to fly
    there; local NED."""

    goal_ned: Vec3
    target_ned: Vec3
    v_ned: Vec3


LEAST_M_S: Final = 0.1
"""A leg may be asked for this slow: the policy's own `[pace]` begins here."""


def why_not_speed(policy: Policy, autopilot: str, speed_m_s: float) -> Refusal | None:
    """May a leg be flown at this speed?  It may be no faster than the policy's."""
    most_m_s = policy.pace_of(autopilot).level.most_m_s
    numbers = (("speed_m_s", speed_m_s), ("min_speed_m_s", LEAST_M_S), ("max_speed_m_s", most_m_s))
    if not math.isfinite(speed_m_s):
        return Refusal(Code.NON_FINITE, "the speed is not a finite number", numbers)
    if not LEAST_M_S <= speed_m_s <= most_m_s:
        asked = f"{fixed(speed_m_s, 2)} m/s"
        sentence = f"{asked}: legs are flown at {LEAST_M_S:g} to {most_m_s:g} m/s"
        return Refusal(Code.POLICY, sentence, numbers)
    return None


def paced(
    bounds: Bounds,
    goal_ned: Vec3,
    pos_ned: Vec3,
    v_ned: Vec3,
    late_s: float = 0.0,
    beside_ned: Vec3 = STANDING,
    most_m_s: float = math.inf,
    rules: Paces | None = None,
) -> Paced:
    """What to send now to a vehicle that is to fly to `goal_ned`, which was verified.

    `late_s`: how old the position is, and so how late a stop would be.  `beside_ned`: the velocity
    that is sent beside the position, which the autopilot adds.  `most_m_s`: along the way, what
    was asked for.  `rules`: other ones than the policy's.
    """
    rules = rules or bounds.policy.pace_of(bounds.autopilot)
    north, east, down = (goal - pos for goal, pos in zip(goal_ned, pos_ned, strict=True))
    away_m = math.hypot(north, east)
    n, e = (north / away_m, east / away_m) if away_m > 0.0 else (0.0, 0.0)
    sign = math.copysign(1.0, down)

    braking = bounds.policy.braking_of(bounds.autopilot)
    here_ned = (
        pos_ned[0] + v_ned[0] * late_s,
        pos_ned[1] + v_ned[1] * late_s,
        pos_ned[2] + v_ned[2] * late_s,
    )

    beside_h_m_s, beside_v_m_s = math.hypot(*beside_ned[:2]), abs(beside_ned[2])
    react_h_s = braking.react_s + rules.level.lag_s
    react_v_s = braking.react_s + rules.vertical.lag_s

    judge = bounds.judge_within_error

    def is_free(from_ned: Vec3, to_ned: Vec3) -> bool:
        return (
            judge.broken_stop(from_ned, to_ned, floor_applies=True) is None
            and bounds.beyond_limits("", to_ned, allow=bounds.position_error) is None
        )

    past_h_m = rules.level.past_m
    past_v_m = sign * min(abs(down), rules.vertical.past_m)
    past_ned = (
        goal_ned[0] + n * past_h_m,
        goal_ned[1] + e * past_h_m,
        goal_ned[2] + past_v_m,
    )
    may_pass = past_ned != goal_ned and is_free(goal_ned, past_ned)
    left_m = math.hypot(away_m, down)
    per_m = most_m_s / left_m if left_m > 0.0 and most_m_s < math.inf else math.inf
    level = _axis(rules.level, away_m, v_ned[0] * n + v_ned[1] * e, late_s, may_pass, per_m)
    vertical = _axis(rules.vertical, abs(down), v_ned[2] * sign, late_s, may_pass, per_m)

    def stop_fits(share: float) -> bool:
        fast_h_m_s = share * level.most_m_s + beside_h_m_s
        fast_v_m_s = share * vertical.most_m_s + beside_v_m_s
        run_h_m = travel_m(fast_h_m_s, react_h_s, braking.a_brake_h_m_s2)
        run_v_m = travel_m(fast_v_m_s, react_v_s, braking.a_brake_v_m_s2)
        stop_ned = (
            here_ned[0] + n * run_h_m,
            here_ned[1] + e * run_h_m,
            here_ned[2] + sign * run_v_m,
        )
        return is_free(here_ned, stop_ned)

    share = _largest_share(stop_fits)
    last_m = LAST_M if share is None or share >= 1.0 else 0.0
    if share is not None:
        fits_h_m_s, fits_v_m_s = share * level.most_m_s, share * vertical.most_m_s
    else:
        crawl = CRAWL_M_S / max(math.hypot(level.wanted_m_s, vertical.wanted_m_s), CRAWL_M_S)
        fits_h_m_s, fits_v_m_s = crawl * level.wanted_m_s, crawl * vertical.wanted_m_s
    level_m_s, ahead_m = level.asked(fits_h_m_s, last_m)
    vertical_m_s, up_or_down_m = vertical.asked(fits_v_m_s, last_m)

    def so_far_ahead(ahead_m: float, up_or_down_m: float) -> Vec3:
        return (
            goal_ned[0] if ahead_m >= away_m else pos_ned[0] + n * ahead_m,
            goal_ned[1] if ahead_m >= away_m else pos_ned[1] + e * ahead_m,
            goal_ned[2] if up_or_down_m >= abs(down) else pos_ned[2] + sign * up_or_down_m,
        )

    target_ned = so_far_ahead(ahead_m, up_or_down_m)
    if min(ahead_m, up_or_down_m) < 0.0 and not is_free(pos_ned, target_ned):
        target_ned = so_far_ahead(max(0.0, ahead_m), max(0.0, up_or_down_m))
    return Paced(goal_ned, target_ned, (n * level_m_s, e * level_m_s, sign * vertical_m_s))


def speed_there(bounds: Bounds, goal_ned: Vec3, pos_ned: Vec3, most_m_s: float) -> float:
    """The speed of this law at a place on the way to `goal_ned`, of a vehicle that has had the time
    to become so fast; it may not have: see `gain`."""
    own = bounds.policy.pace_of(bounds.autopilot)
    level, vertical = (
        structs.replace(axis, gain_m_s=math.inf) for axis in (own.level, own.vertical)
    )
    rules = Paces(level=level, vertical=vertical)
    sent = paced(bounds, goal_ned, pos_ned, STANDING, most_m_s=most_m_s, rules=rules)
    return math.hypot(*sent.v_ned)


class _Axis(NamedTuple):
    """Level or vertical: `left_m` to the goal, at `speed_m_s` towards it; `may_pass`: there is room
    to fly past it.  `flown_m`: so far ahead of the reported position it is by now; `wanted_m_s`:
    the speed where everything is open; `most_m_s`: the most that is wanted or flown, from which the
    stop is looked at."""

    pace: Pace
    left_m: float
    speed_m_s: float
    may_pass: bool
    flown_m: float
    wanted_m_s: float
    most_m_s: float

    def asked(self, fits_m_s: float, last_m: float) -> tuple[float, float]:
        """The speed to fly at, where the stop fits from `fits_m_s`, and how far ahead of the
        reported position to send it for that; to the goal where that is within `last_m`, unless it
        is asked to fly back."""
        pace = self.pace
        speed_m_s = min(self.wanted_m_s, fits_m_s)
        limit_m_s = fits_m_s if self.may_pass else speed_m_s
        too_fast_m_s = max(0.0, self.speed_m_s - limit_m_s)
        back_m_s = max(0.0, min(self.speed_m_s, pace.back_m_s))
        asked_m_s = max(-back_m_s, min(speed_m_s, limit_m_s - FIRM * too_fast_m_s))
        if self.left_m <= last_m and asked_m_s >= 0.0:
            return speed_m_s, self.left_m
        p, a = pace.follow_per_s, pace.follow_m_s2
        if asked_m_s <= a / p:
            return speed_m_s, self.flown_m + asked_m_s / p
        return speed_m_s, self.flown_m + asked_m_s * asked_m_s / (2.0 * a) + a / (2.0 * p * p)


def _axis(
    pace: Pace, left_m: float, speed_m_s: float, late_s: float, may_pass: bool, per_m: float
) -> _Axis:
    """`per_m`: the speed that was asked for, by the length of the way that is left."""
    on_m_s = max(0.0, speed_m_s)
    flown_m = on_m_s * late_s
    still_m = max(0.0, left_m - flown_m)
    p = pace.follow_per_s
    a = min(pace.end_m_s2, pace.follow_m_s2)
    near_m = a / (p * p)
    end_m_s = p * still_m if still_m <= near_m else math.sqrt(2.0 * a * (still_m - near_m / 2.0))
    most_m_s = pace.most_m_s if may_pass else pace.near_m_s
    if per_m < math.inf:
        most_m_s = min(most_m_s, per_m * left_m)
    wanted_m_s = min(most_m_s, on_m_s + pace.gain_m_s, end_m_s)
    return _Axis(pace, left_m, speed_m_s, may_pass, flown_m, wanted_m_s, max(wanted_m_s, speed_m_s))


def _largest_share(fits: Callable[[float], bool]) -> float | None:
    """The largest share of the speed from which the stop fits; None where not even that from rest
    does."""
    if fits(1.0):
        return 1.0
    if not fits(0.0):
        return None
    low, high = 0.0, 1.0
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if fits(middle) else (low, middle)
    return low
