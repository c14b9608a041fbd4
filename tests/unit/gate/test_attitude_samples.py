"""Attitudes of a client's stream: what is refused by itself, and that the bound on where the others
lead holds against a vehicle that does the worst that it may.

The vehicle of the property is a point mass of its own making: rotation matrices, not the gate's
quaternions; force as any power of the thrust between 1 and 2; any wind and hover thrust within the
policy's figures; it turns from one attitude to the next within the time that the policy gives it.
"""

from __future__ import annotations

import math
import struct
from dataclasses import dataclass

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from msgspec import structs

from gcs.frames import Vec3
from gcs.gate.airspace.attitude_samples import Lean, lean_of
from gcs.gate.airspace.stream_samples import (
    TICK_S,
    StreamSample,
    beyond_rules,
    places_of_rest,
    sample_counts_s,
    velocities,
)
from gcs.gate.attitude import (
    Attitude,
    ClimbRate,
    HoverThrust,
    ThrustMeaning,
    UnknownThrust,
    attitude_of,
    roll_pitch_yaw,
)
from gcs.gate.policy.parse import DEFAULT
from gcs.gate.refusal import Code

RULES = structs.replace(
    DEFAULT.stream, tilt_deg=15.0, hover_thrust_error=0.1, attitude_error_m_s2=1.0
)
PX4 = DEFAULT.braking_of("px4")
HOVERS = HoverThrust(0.5)
CLIMBS = ClimbRate(2.5, 1.5)
G = 9.80665
STEP_S = 0.01


def tilted(
    roll_deg: float = 0.0,
    pitch_deg: float = 0.0,
    yaw_deg: float = 0.0,
    thrust: float = 0.5,
    means: ThrustMeaning = HOVERS,
) -> Attitude:
    angles = map(math.radians, (roll_deg, pitch_deg, yaw_deg))
    return Attitude(attitude_of(*angles), thrust, means)


def code(attitude: Attitude, **changes: float) -> tuple[Code, str] | None:
    refusal = beyond_rules(StreamSample(attitude=attitude), structs.replace(RULES, **changes))
    return None if refusal is None else (refusal.code, refusal.sentence)


# ---------------------------------------------------------------------------- by themselves


def test_none_is_flown_by_default() -> None:
    assert DEFAULT.stream.tilt_deg == 0.0
    refusal = beyond_rules(StreamSample(attitude=tilted()), DEFAULT.stream)
    assert refusal is not None
    assert (refusal.code, "stream.tilt_deg is 0" in refusal.sentence) == (Code.POLICY, True)


@pytest.mark.parametrize(
    ("attitude", "refused", "says"),
    [
        (tilted(), None, ""),
        (tilted(pitch_deg=-14.9, yaw_deg=77.0), None, ""),
        (tilted(pitch_deg=15.1), Code.POLICY, "15.1 degrees of tilt is asked for, at most 15.0"),
        (tilted(roll_deg=11.0, pitch_deg=-11.0), Code.POLICY, "tilt_deg"),
        (tilted(roll_deg=180.0), Code.POLICY, "180.0 degrees of tilt"),
        (tilted(thrust=0.615), Code.POLICY, "5.030 m/s2 by this attitude and thrust"),
        (tilted(thrust=0.61), None, ""),
        (tilted(thrust=0.35), Code.POLICY, "5.001 m/s2 by this attitude and thrust"),
        (tilted(thrust=0.36), None, ""),
        (tilted(thrust=0.0), Code.POLICY, "9.8 m/s2"),
        (tilted(thrust=1.01), Code.UNSUPPORTED, "1.010 is not from 0 to 1"),
        (tilted(thrust=-0.01), Code.UNSUPPORTED, "is not from 0 to 1"),
        (tilted(means=HoverThrust(0.0)), Code.UNSUPPORTED, "hover thrust of 0.000"),
        (tilted(means=HoverThrust(1.2)), Code.UNSUPPORTED, "hover thrust of 1.200"),
        (tilted(means=UnknownThrust("it sleeps")), Code.UNSUPPORTED, "thrust: it sleeps"),
        (Attitude((1.0, 0.0, 0.0, 0.1), 0.5, HOVERS), Code.UNSUPPORTED, "length of 1.005"),
        (Attitude((0.0, 0.0, 0.0, 0.0), 0.5, HOVERS), Code.UNSUPPORTED, "length of 0.000"),
        (tilted(thrust=1.0, means=CLIMBS), None, ""),
        (tilted(thrust=1.0, means=ClimbRate(3.5, 1.5)), Code.POLICY, "3.5 m/s up"),
        (tilted(thrust=0.0, means=ClimbRate(2.5, 2.5)), Code.POLICY, "2.5 m/s down"),
    ],
)
def test_what_an_attitude_may_ask_for(attitude: Attitude, refused: Code | None, says: str) -> None:
    """max_a_m_s2 is 5: of a thrust u with 0.5 to hover, g ((2 u)^2 - 1) above it and below."""
    judged = code(attitude)
    assert (None if judged is None else judged[0]) == refused
    assert judged is None or says in judged[1]


def test_the_policys_most_bounds_what_a_tilt_pulls() -> None:
    """At the hover thrust 15 degrees pull g sin(15) = 2.54 m/s2 aside, and fall a little."""
    assert code(tilted(pitch_deg=-14.9), max_a_m_s2=2.6) is None
    assert code(tilted(pitch_deg=-14.9), max_a_m_s2=2.5) is not None


@pytest.mark.parametrize("part", ["pos_ned", "v_ned", "a_ned", "yaw_rad"])
def test_an_attitude_stands_alone(part: str) -> None:
    value = 0.0 if part == "yaw_rad" else (0.0, 0.0, 0.0)
    beside = StreamSample(**{part: value}, attitude=tilted())  # type: ignore[arg-type]
    refusal = beyond_rules(beside, RULES)
    assert refusal is not None
    assert refusal.code is Code.UNSUPPORTED


def test_a_yaw_rate_beside_it_is_bounded() -> None:
    for rate_deg_s, fine in ((89.0, True), (-91.0, False)):
        sample = StreamSample(yaw_rate_rad_s=math.radians(rate_deg_s), attitude=tilted())
        assert (beyond_rules(sample, RULES) is None) == fine


@pytest.mark.parametrize(
    ("attitude", "up_ned"),
    [
        (tilted(), (0.0, 0.0, -1.0)),
        (tilted(pitch_deg=-10.0), (0.17365, 0.0, -0.98481)),
        (tilted(roll_deg=10.0), (0.0, 0.17365, -0.98481)),
        (tilted(pitch_deg=-10.0, yaw_deg=90.0), (0.0, 0.17365, -0.98481)),
        (tilted(roll_deg=10.0, yaw_deg=180.0), (0.0, -0.17365, -0.98481)),
    ],
)
def test_the_thrust_points_where_the_body_leans(attitude: Attitude, up_ned: Vec3) -> None:
    """Nose down leans forward, right side down leans to the right (MAVLink's signs)."""
    assert attitude.up_ned == pytest.approx(up_ned, abs=1e-5)
    assert attitude.tilt_deg == pytest.approx(math.degrees(math.acos(-up_ned[2])), abs=1e-2)


@given(*(st.floats(-85.0, 85.0),) * 2, st.floats(-179.0, 179.0))
def test_angles_and_quaternions_are_the_same_attitude(
    roll_deg: float, pitch_deg: float, yaw_deg: float
) -> None:
    q = tilted(roll_deg, pitch_deg, yaw_deg).q_ned_from_frd
    back = [math.degrees(angle) for angle in roll_pitch_yaw(q)]
    assert back == pytest.approx([roll_deg, pitch_deg, yaw_deg], abs=1e-6)
    assert math.hypot(*q) == pytest.approx(1.0)


@pytest.mark.parametrize(
    ("thrust", "down_m_s"), [(0.5, 0.0), (1.0, -2.5), (0.75, -1.25), (0.0, 1.5), (0.25, 0.75)]
)
def test_a_climb_rate(thrust: float, down_m_s: float) -> None:
    assert tilted(thrust=thrust, means=CLIMBS).down_m_s == pytest.approx(down_m_s)
    assert tilted(thrust=thrust).down_m_s is None


def test_the_share_of_the_weight_that_a_thrust_carries() -> None:
    """Of 0.5 as told: 0.45 to 0.55 in truth; force goes with the thrust or with its square."""
    lean = lean_of(tilted(thrust=0.6), RULES)
    assert (lean.least, lean.most) == pytest.approx((0.6 / 0.55, (0.6 / 0.45) ** 2))
    lean = lean_of(tilted(thrust=0.4), RULES)
    assert (lean.least, lean.most) == pytest.approx(((0.4 / 0.55) ** 2, 0.4 / 0.45))


def test_the_defaults_hold_what_a_px4_was_recorded_to_do() -> None:
    """px4_1_14_flight.tlog, PX4 1.14.3.  At rest, more than 2 m up, ATTITUDE_TARGET.thrust is 0.473
    to 0.502 for nine tenths of 848 samples; MPC_THR_HOVER of px4_1_14_params.json is 0.5.  ATTITUDE
    follows ATTITUDE_TARGET best 0.20 s (pitch) and 0.22 s (roll) later, and then within 3.5 degrees
    for 95 of 100 samples."""
    told, rules = 0.5, DEFAULT.stream
    for recorded in (0.473, 0.502):
        assert told * (1.0 - rules.hover_thrust_error) < recorded
        assert recorded < told * (1.0 + rules.hover_thrust_error)
    assert rules.attitude_settle_s > 0.22
    assert rules.attitude_error_m_s2 > G * math.sin(math.radians(3.5))


# ------------------------------------------------------------------- where they may lead to


@pytest.mark.parametrize(("thrust", "asked_m_s"), [(1.0, -2.5), (0.0, 1.5), (0.5, 0.0)])
def test_a_climb_rate_is_between_the_present_one_and_the_one_asked_for(
    thrust: float, asked_m_s: float
) -> None:
    attitude = tilted(thrust=thrust, means=CLIMBS)
    found = velocities(StreamSample(attitude=attitude), (0.0, 0.0, 0.5), 0.125, (), PX4, RULES)
    assert {down for *_, down in found} == {0.5, asked_m_s}
    assert found[0] == (0.0, 0.0, 0.5)


@dataclass(frozen=True)
class Angles:
    roll_deg: float
    pitch_deg: float
    yaw_deg: float
    thrust: float

    @property
    def attitude(self) -> Attitude:
        return tilted(self.roll_deg, self.pitch_deg, self.yaw_deg, self.thrust)

    @property
    def up_ned(self) -> Vec3:
        """Minus the third column of Rz(yaw) Ry(pitch) Rx(roll)."""
        r, p, y = map(math.radians, (self.roll_deg, self.pitch_deg, self.yaw_deg))
        return (
            -(math.cos(y) * math.sin(p) * math.cos(r) + math.sin(y) * math.sin(r)),
            -(math.sin(y) * math.sin(p) * math.cos(r) - math.cos(y) * math.sin(r)),
            -math.cos(p) * math.cos(r),
        )


@dataclass(frozen=True)
class Truth:
    """What the gate does not know; `wind` is an acceleration."""

    hover: float
    power: float
    wind_ned: Vec3
    turns_s: float
    age_s: float
    held_after_s: float
    brakes_m_s2: float


angles = st.builds(
    Angles, st.floats(-10, 10), st.floats(-10, 10), st.floats(-180, 180), st.floats(0.37, 0.6)
)
truths = st.builds(
    Truth,
    st.floats(0.45, 0.55),
    st.floats(1.0, 2.0),
    st.tuples(*(st.floats(-1.0, 1.0),) * 3),
    st.floats(0.01, RULES.attitude_settle_s),
    st.sampled_from([0.05, 0.125, 0.5]),
    st.floats(0.0, RULES.deadman_s + TICK_S + PX4.react_s),
    st.floats(1.0, 4.0),
)
speeds = st.tuples(st.floats(-6, 6), st.floats(-6, 6), st.floats(-3, 3))


def rests_at(v_ned: Vec3, flown: list[Angles], truth: Truth) -> Vec3:
    """From `age_s` before the last of `flown` came, which is flown until it is held and reacts."""
    *before, last = flown
    from_up = before[0].up_ned if before else (0.0, 0.0, -1.0)
    pos, v = [0.0, 0.0, 0.0], list(v_ned)
    share = truth.age_s / max(1, len(before))
    ends_s = truth.age_s + truth.held_after_s
    turned_s, goal = truth.turns_s, before[0] if before else None
    for step in range(round(ends_s / STEP_S)):
        now_s = step * STEP_S
        goal_now: Angles | None = last
        if now_s < truth.age_s:
            goal_now = before[min(len(before) - 1, int(now_s / share))] if before else None
        if goal_now is not goal:
            from_up = _between(from_up, goal, turned_s / truth.turns_s)
            goal, turned_s = goal_now, 0.0
        turned_s = min(truth.turns_s, turned_s + STEP_S)
        up = _between(from_up, goal, turned_s / truth.turns_s)
        thrust = 0.5 if goal is None else goal.thrust
        force = 1.0 if goal is None else (thrust / truth.hover) ** truth.power
        for axis in range(3):
            a = G * force * up[axis] + (G if axis == 2 else 0.0) + truth.wind_ned[axis]
            pos[axis] += v[axis] * STEP_S + 0.5 * a * STEP_S**2
            v[axis] += a * STEP_S
    speed_h = math.hypot(v[0], v[1])
    for axis, speed, brake in (
        (0, speed_h, PX4.a_brake_h_m_s2),
        (1, speed_h, PX4.a_brake_h_m_s2),
        (2, abs(v[2]), PX4.a_brake_v_m_s2),
    ):
        pos[axis] += v[axis] * speed / (2.0 * brake)
    return (pos[0], pos[1], pos[2])


def _between(from_up: Vec3, goal: Angles | None, share: float) -> Vec3:
    """A direction on the way, as a body turns: of length 1."""
    to_up = (0.0, 0.0, -1.0) if goal is None else goal.up_ned
    mixed = [a + (b - a) * share for a, b in zip(from_up, to_up, strict=True)]
    size = math.hypot(*mixed)
    return (mixed[0] / size, mixed[1] / size, mixed[2] / size)


@given(speeds, st.lists(angles, min_size=1, max_size=4), truths)
def test_a_vehicle_comes_to_rest_where_the_bound_has_it(
    v_ned: Vec3, flown: list[Angles], truth: Truth
) -> None:
    *before, last = (each.attitude for each in flown)
    assume(beyond_rules(StreamSample(attitude=last), RULES) is None)
    leans: tuple[Lean, ...] = tuple(lean_of(each, RULES) for each in before)
    sample = StreamSample(attitude=last)
    may_have = velocities(sample, v_ned, truth.age_s, leans, PX4, RULES)
    rest = places_of_rest((0.0, 0.0, 0.0), may_have, sample_counts_s(truth.age_s, RULES), PX4)
    north, east, down = rests_at(v_ned, flown, truth)
    allowed_m = 0.02  # the steps of the point mass
    for turn in range(72):
        c, s = math.cos(turn * math.tau / 72), math.sin(turn * math.tau / 72)
        most_m = max(c * n + s * e for n, e, _ in (*rest, (0.0, 0.0, 0.0)))
        assert c * north + s * east <= most_m + allowed_m
    downs = [d for *_, d in rest]
    assert min(downs) - allowed_m <= down <= max(downs) + allowed_m


@pytest.mark.parametrize(
    ("changed", "why"),
    [
        ({"hover": 0.40}, "the hover thrust is wrong by more than the policy says"),
        ({"wind_ned": (0.0, 0.0, -4.0)}, "it is lifted more than the policy says"),
    ],
)
def test_the_property_notices_a_vehicle_beyond_its_promise(
    changed: dict[str, float], why: str
) -> None:
    """At rest, level and hovering, for as long as it counts, then held."""
    honest = Truth(0.45, 2.0, (0.0, 0.0, -1.0), 0.3, 0.125, 1.95, 2.0)
    level = Angles(0.0, 0.0, 0.0, 0.5)
    sample = StreamSample(attitude=level.attitude)
    may_have = velocities(sample, (0.0, 0.0, 0.0), 0.125, (), PX4, RULES)
    rest = places_of_rest((0.0, 0.0, 0.0), may_have, sample_counts_s(0.125, RULES), PX4)
    highest = min(down for *_, down in rest)
    assert highest <= rests_at((0.0, 0.0, 0.0), [level], honest)[2] < 0.0
    liar = Truth(**{**honest.__dict__, **changed})
    assert rests_at((0.0, 0.0, 0.0), [level], liar)[2] < highest, why


def test_a_sample_may_add_its_acceleration_for_as_long_as_it_counts() -> None:
    sample = StreamSample(v_ned=(0.0, 4.0, 0.0), a_ned=(1.0, -1.0, 0.5))
    found = velocities(sample, (2.0, 0.0, 0.0), 0.125, (), PX4, RULES)
    gained = sample_counts_s(0.125, RULES) + PX4.react_s
    assert (2.0 + gained, -gained, 0.5 * gained) in found
    assert (gained, 4.0 - gained, 0.5 * gained) in found


@pytest.mark.parametrize(
    ("autopilot", "deadman_s", "ahead_m", "beside_m", "above_m", "below_m"),
    [
        ("px4", 0.5, 24.5, 10.2, 18.7, 17.0),
        ("px4", 0.2, 18.0, 7.5, 13.7, 12.4),
        ("ardupilot", 0.5, 28.9, 11.9, 0.0, 0.0),
    ],
)
def test_how_much_room_a_hovering_vehicle_needs(
    autopilot: str,
    deadman_s: float,
    ahead_m: float,
    beside_m: float,
    above_m: float,
    below_m: float,
) -> None:
    """The figures of default.toml's comment: 10 degrees of tilt to the north, 1.5 m/s2 of wind.

    px4, ahead: (sin 10 / 0.81 g + 1.5) m/s2 for 0.5 + 0.05 + 0.125 + 1.4 s are 7.47 m/s, beside 1.5
    m/s2 3.11 m/s, together 8.10 m/s; so for 2.075 s + 8.10 / 6.7 s."""
    rules = structs.replace(DEFAULT.stream, tilt_deg=10.0, deadman_s=deadman_s)
    attitude = tilted(pitch_deg=-10.0, means=HOVERS if autopilot == "px4" else CLIMBS)
    braking, before = DEFAULT.braking_of(autopilot), (lean_of(attitude, rules),)
    asked = StreamSample(attitude=attitude)
    may_have = velocities(asked, (0.0, 0.0, 0.0), 0.125, before, braking, rules)
    rest = places_of_rest((0.0, 0.0, 0.0), may_have, sample_counts_s(0.125, rules), braking)
    assert max(n for n, _, _ in rest) == pytest.approx(ahead_m, abs=0.051)
    assert max(e for _, e, _ in rest) == pytest.approx(beside_m, abs=0.051)
    assert -min(d for *_, d in rest) == pytest.approx(above_m, abs=0.051)
    assert max(d for *_, d in rest) == pytest.approx(below_m, abs=0.051)


@pytest.mark.parametrize("degrees", range(0, 360, 7))
def test_a_velocity_as_great_as_allowed_is_rounded_for_the_wire(degrees: int) -> None:
    """10 m/s to any side in float32 are up to 10.0000005."""
    north, east = (
        struct.unpack("<f", struct.pack("<f", 10.0 * part(math.radians(degrees))))[0]
        for part in (math.cos, math.sin)
    )
    assert beyond_rules(StreamSample(v_ned=(north, east, 0.0)), DEFAULT.stream) is None
    refusal = beyond_rules(StreamSample(v_ned=(north * 1.001, east * 1.001, 0.0)), DEFAULT.stream)
    assert refusal is not None
    assert refusal.sentence.startswith("10.010 m/s is asked for, at most 10.000 m/s")
