"""Where one sample of a client's setpoint stream can take the vehicle before it is stopped.

As long as a sample counts, the vehicle may fly what it asks for, or go on as it flies now: nobody
knows how quick it is.  Then it is told to hold, reacts, and brakes.  With w any velocity between
the present one and the one asked for, and T the time that the sample counts and that the position
is old, it comes to rest within

    position + w (T + react + |w| / (2 a_brake))

which the convex hull of the vehicle's position and of this place for both velocities, with the
larger |w| for both, contains.  An acceleration leads to velocities of its own: what it adds in
T + react to the present velocity and to the one asked for.  What an attitude leads to is in
`attitude_samples.py`.  Horizontal and vertical are apart.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import product
from typing import Final

from gcs.enu_text import fixed
from gcs.frames import Vec3
from gcs.gate.airspace.attitude_samples import (
    BeforeThis,
    attitude_asks,
    attitude_beyond_rules,
    attitude_velocities,
    leaning_velocities,
)
from gcs.gate.attitude import Attitude
from gcs.gate.policy.policy import Braking, StreamRules
from gcs.gate.refusal import Code, Refusal

TICK_S: Final = 0.05
"""A sample that counts no more is followed by a hold at the next tick: 20 Hz."""


@dataclass(frozen=True, slots=True)
class StreamSample:
    """One sample: metres, m/s and m/s^2 in local NED, radians; None is not asked for.

    An attitude stands alone, or has a yaw rate beside it.
    """

    pos_ned: Vec3 | None = None
    v_ned: Vec3 | None = None
    a_ned: Vec3 | None = None
    yaw_rad: float | None = None
    yaw_rate_rad_s: float | None = None
    attitude: Attitude | None = None

    @property
    def numbers(self) -> dict[str, Sequence[float]]:
        """By name, what is asked for; for the check that all of it is finite."""
        return {
            "position asked for": self.pos_ned or (),
            "velocity asked for": self.v_ned or (),
            "acceleration asked for": self.a_ned or (),
            "yaw asked for": () if self.yaw_rad is None else (self.yaw_rad,),
            "yaw rate asked for": () if self.yaw_rate_rad_s is None else (self.yaw_rate_rad_s,),
            "attitude asked for": () if self.attitude is None else self.attitude.numbers,
        }


ROUNDED_UP: Final = 1.0 + 2.0**-22
"""Parts of a vector as long as allowed are rounded to float32 each, by 2**-24 at most.  Where
it leads to is judged by what it is."""


def beyond_rules(sample: StreamSample, rules: StreamRules) -> Refusal | None:
    """Refuses a sample that asks for nothing that can be judged, or for more than the policy's
    most."""
    moves = (sample.pos_ned, sample.v_ned, sample.a_ned)
    if sample.attitude is not None:
        if (*moves, sample.yaw_rad) != (None, None, None, None):
            return Refusal(
                Code.UNSUPPORTED,
                "an attitude leaves no room for a position, a velocity,"
                " an acceleration or a yaw beside it",
            )
        refusal = attitude_beyond_rules(sample.attitude, rules)
        if refusal is not None:
            return refusal
    elif all(part is None for part in moves) or (
        sample.pos_ned is not None and sample.a_ned is not None and sample.v_ned is None
    ):
        return Refusal(
            Code.UNSUPPORTED,
            "a sample has a position, a velocity, an acceleration or an attitude; a position and an"
            " acceleration need a velocity between them",
        )
    for value, most, key, unit in _asked(sample, rules):
        if value > most * ROUNDED_UP:
            digits = next((n for n in (1, 3) if fixed(value, n) != fixed(most, n)), 6)
            return Refusal(
                Code.POLICY,
                f"{fixed(value, digits)} {unit} is asked for, at most {fixed(most, digits)} {unit} "
                f"(policy: stream.{key})",
                (("asked", value), (key, most)),
            )
    return None


def _asked(sample: StreamSample, rules: StreamRules) -> Iterator[tuple[float, float, str, str]]:
    """What is asked for, the most that is allowed, the policy's key of that, and the unit."""
    if sample.v_ned is not None:
        north, east, down = sample.v_ned
        yield math.hypot(north, east), rules.max_speed_h_m_s, "max_speed_h_m_s", "m/s"
        yield -down, rules.max_speed_up_m_s, "max_speed_up_m_s", "m/s up"
        yield down, rules.max_speed_down_m_s, "max_speed_down_m_s", "m/s down"
    if sample.a_ned is not None:
        yield math.hypot(*sample.a_ned), rules.max_a_m_s2, "max_a_m_s2", "m/s2"
    if sample.attitude is not None:
        yield from attitude_asks(sample.attitude, rules)
    if sample.yaw_rate_rad_s is not None:
        rate_deg_s = abs(math.degrees(sample.yaw_rate_rad_s))
        yield rate_deg_s, rules.max_yaw_rate_deg_s, "max_yaw_rate_deg_s", "degrees/s"


def velocities(
    sample: StreamSample,
    v_ned: Vec3,
    age_s: float,
    before: Sequence[BeforeThis],
    braking: Braking,
    rules: StreamRules,
) -> tuple[Vec3, ...]:
    """The vehicle's velocity, `age_s` ago, and what the sample may lead to; that one is the first.

    `before` is how the vehicle leant for the samples before this one.
    """
    counts_s = sample_counts_s(age_s, rules)
    if sample.attitude is not None:
        react_s = braking.react_s
        led_to = attitude_velocities(
            sample.attitude, before, v_ned, age_s, counts_s, react_s, rules
        )
        return (v_ned, *led_to)
    found = [v_ned, *leaning_velocities(before, v_ned, age_s, rules)]
    if sample.v_ned is not None:
        found.append(sample.v_ned)
    if sample.a_ned is not None:
        gained = [a * (counts_s + braking.react_s) for a in sample.a_ned]
        for n, e, d in tuple(found):
            found.append((n + gained[0], e + gained[1], d + gained[2]))
    return tuple(found)


def sample_counts_s(age_s: float, rules: StreamRules) -> float:
    """How long the vehicle flies by a sample before it is told to hold, from the position on that
    is `age_s` old when the sample comes."""
    return rules.deadman_s + TICK_S + age_s


def places_of_rest(
    pos_ned: Vec3, v_ned: Sequence[Vec3], counts_s: float, braking: Braking
) -> tuple[Vec3, ...]:
    """Corners of a hull that contains wherever the vehicle comes to rest, flying any of the
    velocities or one between them for `counts_s` before it is told to hold."""
    fastest_h = max(math.hypot(n, e) for n, e, _ in v_ned)
    fastest_v = max(abs(d) for *_, d in v_ned)
    held_s = counts_s + braking.react_s
    h_s = held_s + fastest_h / (2.0 * braking.a_brake_h_m_s2)
    v_s = held_s + fastest_v / (2.0 * braking.a_brake_v_m_s2)
    north, east, down = pos_ned
    beside = ((north, east), *((north + n * h_s, east + e * h_s) for n, e, _ in v_ned))
    downs = sorted({down, *(down + d * v_s for *_, d in v_ned)})
    heights = {downs[0], downs[-1]}
    return tuple((n, e, d) for (n, e), d in product(dict.fromkeys(beside), sorted(heights)))
