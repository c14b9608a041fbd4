"""How a vehicle can accelerate that a client's stream gives attitudes and thrusts.

The thrust of a multirotor points where its body's up points, so an attitude is a direction, and
thrust over weight a length: a = g + thrust / mass.  Neither is known exactly:

- A thrust as a share of full collective thrust is compared with the share at which the vehicle says
  that it hovers, which may be wrong by the policy's `hover_thrust_error`.  Between the two, force
  grows at least as the share and at most as its square (the square of the motors' speed, PX4 with
  THR_MDL_FAC 0 as recorded; ArduCopter's curve lies between).
- A thrust that is a climb rate is a vertical speed.  The vehicle then carries its weight itself,
  and up to `LIFT_MOST` of it while it changes its height.
- Wind, and an attitude that is not quite held, add up to `attitude_error_m_s2` in any direction.
- For `attitude_settle_s` the vehicle still leans as it did for the samples before, or in between.

So there is a box of accelerations for the time in which the older samples may still act, and one
for the rest; `attitude_velocities` are the corners of what they lead to.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import product
from typing import Final, TypeAlias

from gcs.enu_text import fixed
from gcs.frames import Vec3
from gcs.gate.attitude import Attitude, ClimbRate, HoverThrust, UnknownThrust
from gcs.gate.policy.policy import StreamRules
from gcs.gate.refusal import Code, Refusal

GRAVITY_M_S2: Final = 9.80665
UNIT_WITHIN: Final = 1e-3
"""ArduCopter takes no quaternion whose length is farther from 1 (from memory)."""
LIFT_LEAST: Final = 0.75
LIFT_MOST: Final = 1.25
"""Of the weight, while a vehicle holds or changes its height by itself: ArduCopter accelerates by
1 m/s2 (WP_ACC_Z, as recorded), and this leaves as much again for disturbances."""
NOT_FLOWN: Final = (
    "attitudes are not flown (policy: stream.tilt_deg is 0); send positions, velocities or "
    "MANUAL_CONTROL"
)
STRAIGHT_UP: Final[Vec3] = (0.0, 0.0, -1.0)
OTHERWISE_M_S2: Final = 9.81
"""In any direction: how a vehicle may accelerate that flew positions or velocities until now.  PX4
leans up to 45 degrees then (MPC_TILTMAX_AIR, as recorded), ArduCopter up to 30 (ATC_ANGLE_MAX)."""


@dataclass(frozen=True, slots=True)
class Lean:
    """A direction of thrust, and how much thrust there may be, as shares of the weight."""

    up_ned: Vec3
    least: float
    most: float


BeforeThis: TypeAlias = Lean | None
"""What acted before a sample, and may act yet; None: a flight to positions or velocities."""


def lean_of(attitude: Attitude, rules: StreamRules) -> Lean:
    """What the vehicle may make of an attitude that `attitude_beyond_rules` has let through."""
    match attitude.means:
        case HoverThrust(share):
            low = attitude.thrust / share / (1.0 + rules.hover_thrust_error)
            high = attitude.thrust / share / (1.0 - rules.hover_thrust_error)
            return Lean(attitude.up_ned, min(low, low * low), max(high, high * high))
        case ClimbRate() | UnknownThrust():
            return Lean(attitude.up_ned, LIFT_LEAST, LIFT_MOST)


def attitude_beyond_rules(attitude: Attitude, rules: StreamRules) -> Refusal | None:
    """Refuses an attitude whose effect is not known, or that is beyond the policy's most."""
    if rules.tilt_deg <= 0.0:
        return Refusal(Code.POLICY, NOT_FLOWN)
    if isinstance(attitude.means, UnknownThrust):
        return Refusal(Code.UNSUPPORTED, f"an attitude and a thrust: {attitude.means.why}")
    size = math.hypot(*attitude.q_ned_from_frd)
    if abs(size - 1.0) > UNIT_WITHIN:
        sentence = f"the quaternion of an attitude has a length of {fixed(size, 3)}, and 1 is asked"
        return Refusal(Code.UNSUPPORTED, sentence, (("length", size),))
    if not 0.0 <= attitude.thrust <= 1.0:
        sentence = f"a thrust of {fixed(attitude.thrust, 3)} is not from 0 to 1"
        return Refusal(Code.UNSUPPORTED, sentence, (("thrust", attitude.thrust),))
    if isinstance(attitude.means, HoverThrust) and not 0.05 <= attitude.means.share <= 1.0:
        sentence = (
            f"a hover thrust of {fixed(attitude.means.share, 3)}, as the vehicle tells, is none"
        )
        return Refusal(Code.UNSUPPORTED, sentence, (("hover_thrust", attitude.means.share),))
    return None


def attitude_asks(
    attitude: Attitude, rules: StreamRules
) -> Iterator[tuple[float, float, str, str]]:
    """What is asked for, the most that is allowed, the policy's key of that, and the unit."""
    yield attitude.tilt_deg, rules.tilt_deg, "tilt_deg", "degrees of tilt"
    match attitude.means:
        case HoverThrust(share):
            lift = attitude.thrust / share
            north, east, down = attitude.up_ned
            for over_weight in (lift, lift * lift):
                pull = over_weight * GRAVITY_M_S2
                a_m_s2 = math.hypot(pull * north, pull * east, pull * down + GRAVITY_M_S2)
                yield a_m_s2, rules.max_a_m_s2, "max_a_m_s2", "m/s2 by this attitude and thrust"
        case ClimbRate():
            down_m_s = attitude.down_m_s or 0.0
            yield -down_m_s, rules.max_speed_up_m_s, "max_speed_up_m_s", "m/s up"
            yield down_m_s, rules.max_speed_down_m_s, "max_speed_down_m_s", "m/s down"
        case UnknownThrust():
            return


def flies_too_fast(v_ned: Vec3, rules: StreamRules) -> Refusal | None:
    """An attitude asks for no speed, so it is the vehicle's own that the policy bounds."""
    north, east, down = v_ned
    for speed_m_s, most_m_s, key in (
        (math.hypot(north, east), rules.max_speed_h_m_s, "max_speed_h_m_s"),
        (-down, rules.max_speed_up_m_s, "max_speed_up_m_s"),
        (down, rules.max_speed_down_m_s, "max_speed_down_m_s"),
    ):
        if speed_m_s > most_m_s:
            return Refusal(
                Code.POLICY,
                f"attitudes have brought the vehicle to {fixed(speed_m_s, 1)} m/s, at most "
                f"{fixed(most_m_s, 1)} m/s (policy: stream.{key})",
                (("speed_m_s", speed_m_s), (key, most_m_s)),
            )
    return None


def attitude_velocities(
    attitude: Attitude,
    before: Sequence[BeforeThis],
    v_ned: Vec3,
    age_s: float,
    counts_s: float,
    react_s: float,
    rules: StreamRules,
) -> tuple[Vec3, ...]:
    """Corners of the velocities that an attitude may lead to, beside `v_ned`, before a hold that
    follows it acts.

    `before` acted until the sample came.  `counts_s` is how long the sample counts, with the
    `age_s` of the position and velocity before it.
    """
    lean = lean_of(attitude, rules)
    settles_s = age_s + rules.attitude_settle_s
    turning = _gains((lean, *before), settles_s, rules, turning=True)
    there = _gains((lean,), max(0.0, counts_s + react_s - settles_s), rules)
    north, east, down = (
        (v + first_low + low, v + first_high + high)
        for v, (first_low, first_high), (low, high) in zip(v_ned, turning, there, strict=True)
    )
    asked_m_s = attitude.down_m_s
    return tuple(product(north, east, down if asked_m_s is None else (asked_m_s,)))


def leaning_velocities(
    before: Sequence[BeforeThis], v_ned: Vec3, age_s: float, rules: StreamRules
) -> tuple[Vec3, ...]:
    """Corners of the velocities that a lean of attitudes before may lead to until it is over."""
    leans = [lean for lean in before if lean is not None]
    if not leans:
        return ()
    gains = _gains(leans, age_s + rules.attitude_settle_s, rules, turning=True)
    sides = [(v + low, v + high) for v, (low, high) in zip(v_ned, gains, strict=True)]
    return tuple(product(sides[0], sides[1], sides[2]))


def _gains(
    leans: Sequence[BeforeThis], seconds: float, rules: StreamRules, *, turning: bool = False
) -> list[tuple[float, float]]:
    """What is gained, least and most, north, east and down, by any of the leans and of the thrusts,
    or less than that; while it is `turning` from one to another the vehicle may be level, too."""
    known = [lean for lean in leans if lean is not None]
    ups = [lean.up_ned for lean in known] + [STRAIGHT_UP] * turning
    shares = (min(lean.least for lean in known), max(lean.most for lean in known))
    wrong, box = rules.attitude_error_m_s2, []
    for axis, weight in enumerate((0.0, 0.0, GRAVITY_M_S2)):
        ends = [weight + GRAVITY_M_S2 * share * up[axis] for up in ups for share in shares]
        low, high = min(0.0, *ends) - wrong, max(0.0, *ends) + wrong
        if None in leans:
            low, high = min(low, -OTHERWISE_M_S2), max(high, OTHERWISE_M_S2)
        box.append((low * seconds, high * seconds))
    return box
