"""How fast a vehicle is sent to a position: the law by hand, by random fences, and flown."""

from __future__ import annotations

import math
from collections import deque

import pytest
from hypothesis import assume, example, given
from hypothesis import strategies as st

from gcs.frames import Vec3
from gcs.gate.airspace.pace import Paced
from gcs.gate.airspace.verifier import Verifier
from gcs.gate.airspace.zones import Zone
from gcs.gate.geometry import Circle, Polygon
from gcs.gate.policy.parse import DEFAULT
from tests.unit.gate.airspace import HOME, STILL, at

AUTOPILOTS = ("px4", "ardupilot")
RADIUS_M, TOP_M = 150.0, 50.0
REST_H_M, REST_V_M = 1.0, 0.2
"""What a stop has to keep: 0.5 m of error and 2 m of margin less 1.5 m of slack beside, 0.2 + 0.3 -
0.3 m above and below."""
HOLDS = {"px4": (1.4, 3.35, 9.8), "ardupilot": (1.9, 9.8, 9.8)}
"""[braking]: seconds, m/s2 level, m/s2 vertically."""
LAGS = {"px4": (2.5, 0.3), "ardupilot": (0.6, 0.3)}
"""[pace] lag_s, level and vertically."""
FOLLOWS = {"px4": ((0.95, 50.0), (1.0, 50.0)), "ardupilot": ((1.0, 2.5), (1.0, 1.0))}
"""[pace] follow_per_s and follow_m_s2, level and vertically."""


def field(autopilot: str, radius_m: float = RADIUS_M, *more: Zone) -> Verifier:
    zone = Zone("field", True, Circle((0.0, 0.0), radius_m), 0.0, TOP_M)
    return Verifier(DEFAULT, (zone, *more), autopilot, HOME, origin_known=False)


def open_air(autopilot: str) -> Verifier:
    return Verifier(DEFAULT, (), autopilot, HOME, origin_known=False, fence_on=False)


class TestInOpenAir:
    """Figures of `[pace]`; 20 m up, to the east or straight up."""

    @pytest.mark.parametrize(
        ("autopilot", "v_m_s", "goal_m", "asked_m_s", "ahead_m"),
        [
            # gain: 0 + 5 m/s, and 5 / 0.95 m
            ("px4", 0.0, 100.0, 5.0, 5.26316),
            # most: 12 m/s, and 12 / 0.95 m
            ("px4", 10.0, 100.0, 12.0, 12.63158),
            # one that is faster is asked for no less: its stop fits
            ("px4", 13.0, 100.0, 12.0, 12.63158),
            # the end: sqrt(2 4 (10 - 4 / 2 0.95^2)), and by 0.95 / s of that ahead
            ("px4", 7.0, 10.0, 7.89123, 8.30656),
            # and so near that it flies to the goal itself: 0.95 x 1.5 m/s
            ("px4", 1.6, 1.5, 1.425, 1.5),
            ("px4", 0.0, 1.5, 1.425, 1.5),
            # gain: 5 m/s, and 5^2 / 2 2.5 + 2.5 / 2 m
            ("ardupilot", 0.0, 100.0, 5.0, 6.25),
            # most: 11 m/s, and 11^2 / 2 2.5 + 1.25 m
            ("ardupilot", 8.0, 100.0, 11.0, 25.45),
            # the end: sqrt(2 2.5 (5 - 2.5 / 2)) = 4.33013 m/s, and 4.33013 - 4 (4.5 - 4.33013) m/s,
            # of which it is asked 3.65065^2 / 2 2.5 + 1.25 m ahead
            ("ardupilot", 4.5, 5.0, 4.33013, 3.91545),
        ],
    )
    def test_level(
        self, autopilot: str, v_m_s: float, goal_m: float, asked_m_s: float, ahead_m: float
    ) -> None:
        goal = at(goal_m, 0, 20)
        sent = open_air(autopilot).paced(goal, at(0, 0, 20), at(v_m_s, 0, 0))
        assert sent.v_ned == pytest.approx(at(asked_m_s, 0, 0), abs=1e-4)
        assert sent.target_ned == pytest.approx(at(ahead_m, 0, 20), abs=1e-4)

    @pytest.mark.parametrize(
        ("autopilot", "asked_m_s", "ahead_m"),
        # 2.5^2 / 2 1 + 1 / 2 m
        [("px4", 3.0, 3.0), ("ardupilot", 2.5, 3.625)],
    )
    def test_up_and_down(self, autopilot: str, asked_m_s: float, ahead_m: float) -> None:
        for to_up, sign in ((50, 1), (0.5, -1)):
            sent = open_air(autopilot).paced(at(0, 0, to_up), at(0, 0, 20), STILL)
            assert sent.v_ned == pytest.approx(at(0, 0, sign * asked_m_s))
            assert sent.target_ned == pytest.approx(at(0, 0, 20 + sign * ahead_m))

    def test_from_an_old_position_it_is_so_much_farther_ahead(self) -> None:
        """10 m/s for 0.5 s are 5 m."""
        sent = open_air("px4").paced(at(100, 0, 20), at(0, 0, 20), at(10, 0, 0), 0.5)
        assert sent.target_ned == pytest.approx(at(5 + 12.63158, 0, 20), abs=1e-4)

    @pytest.mark.parametrize("autopilot", AUTOPILOTS)
    def test_within_half_a_metre_the_goal_itself_is_sent(self, autopilot: str) -> None:
        goal = at(0.3, 0.39, 20.49)
        for v_ned in (STILL, at(3, -2, 1)):
            assert open_air(autopilot).paced(goal, at(0, 0, 20), v_ned).target_ned == goal

    def test_another_autopilot_is_flown_by_the_slowest_of_every_figure(self) -> None:
        """5 m/s; asked of one that follows by 1 / s and may slow down by 50 m/s2."""
        sent = open_air("betaflight").paced(at(100, 0, 20), at(0, 0, 20), STILL)
        assert sent.v_ned == pytest.approx(at(5, 0, 0))
        assert sent.target_ned == pytest.approx(at(5, 0, 20))


def test_one_too_fast_for_its_stop_is_asked_for_less_by_four_times_the_difference() -> None:
    """25 m before the fence, 2 m of which are kept: w (1.4 + 2.5) + w^2 / 2 3.35 = 23 m for w =
    4.96 m/s, which is found to a hundredth of the 10 m/s wanted."""
    sent = field("px4").paced(at(147.9, 0, 20), at(125, 0, 20), at(5.5, 0, 0))
    assert sent.v_ned[1] == pytest.approx(4.96, abs=0.1)
    asked_m_s = 5 * sent.v_ned[1] - 4 * 5.5
    assert sent.target_ned[1] == pytest.approx(125 + asked_m_s / 0.95)


def test_where_there_is_no_room_past_the_goal_it_is_asked_for_less_than_the_law() -> None:
    """1.2 m/s, 1 m before its goal: 0.95 m/s; and 4 x 0.25 m/s less than that where 5 m past it are
    less than 2 m before the fence."""
    for radius_m, asked_m_s in ((60.0, 0.95), (26.0, -0.05)):
        sent = field("px4", radius_m).paced(at(20, 0, 20), at(19, 0, 20), at(1.2, 0, 0))
        assert sent.v_ned == pytest.approx(at(0.95, 0, 0))
        assert sent.target_ned == pytest.approx(at(19 + asked_m_s / 0.95, 0, 20))


def test_what_is_sent_back_and_down_at_once_is_free_as_a_whole() -> None:
    """A roof of 10 m stands behind it: at its own height it may be asked to fly back, lower not."""
    roof = Zone(
        "roof",
        False,
        Polygon(((-50.0, -50.0), (50.0, -50.0), (50.0, 0.0), (-50.0, 0.0))),
        0.0,
        10.0,
    )
    yard = Zone(
        "yard", True, Polygon(((-50.0, -50.0), (50.0, -50.0), (50.0, 7.5), (-50.0, 7.5))), 0.0, 50.0
    )
    verifier = Verifier(DEFAULT, (yard, roof), "px4", HOME, origin_known=False)
    sent = verifier.paced((4.0, 0.0, -5.0), (2.05, 0.0, -10.25), (2.5, 0.0, 0.0))
    assert sent.target_ned[0] >= 2.05


def test_to_a_goal_without_room_past_it_it_is_flown_slower() -> None:
    """5 m and 2 m before the fence are 7 m."""
    for goal_m, asked_m_s in ((142.9, 12.0), (143.1, 10.0)):
        sent = field("px4").paced(at(goal_m, 0, 20), at(-100, 0, 20), at(9, 0, 0))
        assert sent.v_ned == pytest.approx(at(asked_m_s, 0, 0))


@pytest.mark.parametrize(
    ("pos_m", "goal_m", "asked_m_s", "there_m_s"),
    [
        # without a time to become so fast: see `test_level` for the figures of the ends
        (0, 100, math.inf, 12.0),
        (90, 100, math.inf, 7.89123),
        (98.5, 100, math.inf, 1.425),
        # what was asked for; in no room past the goal; where the stop fits, 25 m before the fence
        (0, 100, 3.0, 3.0),
        (0, 143.1, math.inf, 10.0),
        (125, 147.9, math.inf, 4.96),
    ],
)
def test_the_speed_at_a_place_on_the_way_is_that_of_one_that_is_as_fast_as_it_may_be(
    pos_m: float, goal_m: float, asked_m_s: float, there_m_s: float
) -> None:
    speed_m_s = field("px4").speed_there(at(goal_m, 0, 20), at(pos_m, 0, 20), asked_m_s)
    assert speed_m_s == pytest.approx(there_m_s, abs=0.1)


def test_one_that_does_not_slow_down_is_asked_to_fly_back() -> None:
    """2.5 m before the fence; no faster than it flies on, and at 2.5 m/s at the most."""
    for speed_m_s, back_m_s in ((1.3, 1.3), (0.4, 0.4), (6.0, 2.5)):
        sent = field("px4").paced(at(147.9, 0, 20), at(147.5, 0, 20), at(speed_m_s, 0, 0))
        assert sent.target_ned == pytest.approx(at(147.5 - back_m_s / 0.95, 0, 20), abs=1e-6)
    still = field("ardupilot").paced(at(147.9, 0, 20), at(147.5, 0, 20), at(1.3, 0, 0))
    assert still.target_ned == at(147.5, 0, 20)


def test_nobody_is_asked_to_fly_back_into_what_is_behind() -> None:
    tower = Zone("tower", False, Circle((142.0, 0.0), 3.2), 0.0, 50.0)
    sent = field("px4", RADIUS_M, tower).paced(at(147.9, 0, 20), at(147.5, 0, 20), at(6.0, 0, 0))
    assert sent.target_ned == at(147.5, 0, 20)


# ------------------------------------------------------------------------------- random fences

TOWER = Zone(
    "tower", False, Polygon(((20.0, -5.0), (30.0, -5.0), (30.0, 5.0), (20.0, 5.0))), 0.0, 20.0
)
TOWER_AND_ROOM_M = 20.2
bearings = st.floats(0.0, math.tau)
places = st.builds(
    lambda r, b, up: at(r * math.cos(b), r * math.sin(b), up),
    st.floats(0.0, 147.9),
    bearings,
    st.floats(0.5, 49.5),
)
velocities = st.builds(
    lambda v, b, up: at(v * math.cos(b), v * math.sin(b), up),
    st.floats(0.0, 12.0),
    bearings,
    st.floats(-3.0, 3.0),
)
lates = st.floats(0.0, 0.5)


def now(pos_ned: Vec3, v_ned: Vec3, late_s: float) -> Vec3:
    north, east, down = (x + v * late_s for x, v in zip(pos_ned, v_ned, strict=True))
    return (north, east, down)


def room_m(pos_ned: Vec3) -> float:
    """The least of what a stop there keeps beyond what it has to."""
    up_m = -pos_ned[2]
    beside_m = RADIUS_M - math.hypot(*pos_ned[:2])
    return min(beside_m - REST_H_M, TOP_M - up_m - REST_V_M, up_m - REST_V_M)


def from_tower_m(pos_ned: Vec3) -> float:
    north, east = pos_ned[0], pos_ned[1]
    return math.hypot(max(20.0 - east, east - 30.0, 0.0), max(abs(north) - 5.0, 0.0))


def rest_of(autopilot: str, here_ned: Vec3, sent: Paced) -> Vec3:
    """Where a hold ends from the speed that is asked for, and from what it is more by the lag."""
    react_s, a_h, a_v = HOLDS[autopilot]
    lag_h, lag_v = LAGS[autopilot]
    north, east, down = sent.v_ned
    h = math.hypot(north, east)
    share = (react_s + lag_h) + h / (2.0 * a_h)
    fall = down * (react_s + lag_v) + math.copysign(down * down / (2.0 * a_v), down)
    return (here_ned[0] + north * share, here_ned[1] + east * share, here_ned[2] + fall)


@pytest.mark.parametrize("autopilot", AUTOPILOTS)
@given(goal=places, pos=places, v=velocities, late_s=lates)
@example(goal=at(147.9, 0, 10), pos=at(140, 0, 10), v=at(12, 0, 0), late_s=0.5)
def test_the_stop_from_the_asked_speed_keeps_every_limit(
    autopilot: str, goal: Vec3, pos: Vec3, v: Vec3, late_s: float
) -> None:
    here = now(pos, v, late_s)
    assume(room_m(here) > 0.0)
    assume(from_tower_m(here) > 1.0 or -here[2] > TOWER_AND_ROOM_M)
    sent = field(autopilot, RADIUS_M, TOWER).paced(goal, pos, v, late_s)
    rest = rest_of(autopilot, here, sent)
    assert room_m(rest) > -1e-6
    # Along the ground, where it passes the tower's heights at all.
    if min(-here[2], -rest[2]) < TOWER_AND_ROOM_M:
        for part in range(41):
            north, east = (a + part / 40 * (b - a) for a, b in zip(here[:2], rest[:2], strict=True))
            assert from_tower_m((north, east, 0.0)) > REST_H_M - 1e-6


@pytest.mark.parametrize("autopilot", AUTOPILOTS)
@given(goal=places, pos=places, v=velocities, late_s=lates)
@example(goal=at(1, 0, 1), pos=at(0, 0, 49.5), v=at(1, 0, 2), late_s=0.5)
def test_the_target_is_on_the_way_no_farther_than_the_goal_and_behind_only_to_brake(
    autopilot: str, goal: Vec3, pos: Vec3, v: Vec3, late_s: float
) -> None:
    """`[pace].back_m_s` is asked for by that much over `follow_per_s` behind the vehicle."""
    rules = DEFAULT.pace_of(autopilot)
    sent = field(autopilot).paced(goal, pos, v, late_s).target_ned
    north, east, down = (b - a for a, b in zip(pos, goal, strict=True))
    left_m = math.hypot(north, east)
    gone = [x - a for a, x in zip(pos, sent, strict=True)]
    across = north * gone[1] - east * gone[0]
    assert abs(across) <= 1e-6 * max(1.0, left_m)
    ahead_m = (north * gone[0] + east * gone[1]) / left_m if left_m > 0.0 else math.hypot(*gone[:2])
    behind_m = rules.level.back_m_s / rules.level.follow_per_s
    assert -behind_m - 1e-9 <= ahead_m <= left_m + 1e-9
    behind_m = rules.vertical.back_m_s / rules.vertical.follow_per_s
    assert -behind_m - 1e-9 <= math.copysign(1.0, down) * gone[2] <= abs(down) + 1e-9


@pytest.mark.parametrize("autopilot", AUTOPILOTS)
@given(goal=places, pos=places, v=velocities, more_m=st.floats(0.0, 100.0))
def test_with_more_room_it_is_asked_to_fly_no_slower(
    autopilot: str, goal: Vec3, pos: Vec3, v: Vec3, more_m: float
) -> None:
    narrow = field(autopilot).paced(goal, pos, v).v_ned
    wide = field(autopilot, RADIUS_M + more_m).paced(goal, pos, v).v_ned
    assert math.hypot(*wide) >= math.hypot(*narrow) - 1e-9


# -------------------------------------------------------------------------------------- flown

STEP_S, TICK = 0.01, 5
"""A setpoint every 0.05 s."""


class Flown:
    """Follows the speed to which the position leads that it is sent, with a lag of first order."""

    def __init__(self, autopilot: str, pos: Vec3, v: Vec3, lag_share: float) -> None:
        self.autopilot, self.pos, self.v = autopilot, list(pos), list(v)
        self.lags = tuple(max(lag_share * lag_s, 1e-9) for lag_s in LAGS[autopilot])

    def step(self, to: Vec3) -> None:
        away = [goal - pos for goal, pos in zip(to, self.pos, strict=True)]
        level_m = math.hypot(*away[:2])
        (p_h, p_v), (lag_h, lag_v) = FOLLOWS[self.autopilot], self.lags
        level = follow(level_m, *p_h) / level_m if level_m > 0.0 else 0.0
        down = math.copysign(follow(abs(away[2]), *p_v), away[2])
        asked = (away[0] * level, away[1] * level, down)
        for axis, lag_s in enumerate((lag_h, lag_h, lag_v)):
            self.v[axis] += (asked[axis] - self.v[axis]) * (1.0 - math.exp(-STEP_S / lag_s))
            self.pos[axis] += self.v[axis] * STEP_S

    def rest(self) -> Vec3:
        """Of a hold that it is told now."""
        react_s, a_h, a_v = HOLDS[self.autopilot]
        h = math.hypot(*self.v[:2])
        fall = self.v[2] * react_s + math.copysign(self.v[2] ** 2 / (2.0 * a_v), self.v[2])
        north, east = (
            self.pos[axis] + self.v[axis] * (react_s + h / (2.0 * a_h)) for axis in (0, 1)
        )
        return (north, east, self.pos[2] + fall)


def follow(left_m: float, per_s: float, a_m_s2: float) -> float:
    """p d, and from a / p^2 on sqrt(2 a (d - a / 2 p^2))."""
    near_m = a_m_s2 / per_s**2
    if left_m <= near_m:
        return per_s * left_m
    return math.sqrt(2.0 * a_m_s2 * (left_m - near_m / 2.0))


@pytest.mark.slow
@pytest.mark.parametrize("autopilot", AUTOPILOTS)
@given(
    goal=st.builds(
        lambda b, up: at(147.9 * math.cos(b), 147.9 * math.sin(b), up),
        bearings,
        st.sampled_from((0.4, 20.0, 49.6)),
    ),
    start=places,
    speed_m_s=st.floats(0.0, 10.0),
    lag_share=st.floats(0.0, 1.0),
    delay=st.integers(0, 50),
)
@example(goal=at(147.9, 0, 49.6), start=at(60, 0, 20), speed_m_s=10.0, lag_share=1.0, delay=50)
@example(goal=at(0, 147.9, 0.4), start=at(0, 0, 20), speed_m_s=0.0, lag_share=0.0, delay=0)
def test_flown_by_it_a_hold_ends_inside_at_every_moment_and_it_arrives(
    autopilot: str, goal: Vec3, start: Vec3, speed_m_s: float, lag_share: float, delay: int
) -> None:
    """From rest, or on its way already; by positions that are up to half a second old."""
    away = [b - a for a, b in zip(start, goal, strict=True)]
    far_m = math.hypot(*away[:2])
    assume(far_m > 1.0)
    v = (away[0] / far_m * speed_m_s, away[1] / far_m * speed_m_s, 0.0)
    flown = Flown(autopilot, start, v, lag_share)
    assume(room_m(flown.rest()) > 0.0)
    verifier, late_s = field(autopilot), delay * STEP_S
    before = [(now(start, v, -late_s + k * STEP_S), v) for k in range(delay)]
    reports: deque[tuple[Vec3, Vec3]] = deque(before)
    to = start
    for step in range(round(200 / STEP_S)):
        here: tuple[Vec3, Vec3] = (tuple(flown.pos), tuple(flown.v))  # type: ignore[assignment]
        reports.append(here)
        pos_ned, v_ned = reports.popleft()
        if step % TICK == 0:
            rest = flown.rest()
            beside_m = RADIUS_M - math.hypot(*rest[:2])
            assert min(beside_m, TOP_M + rest[2], -rest[2]) >= 0.0, (step * STEP_S, here)
            if math.dist(here[0], goal) < 0.3 and math.hypot(*here[1]) < 0.1:
                return
            to = verifier.paced(goal, pos_ned, v_ned, late_s).target_ned
        flown.step(to)
    pytest.fail(f"at {flown.pos} after 200 s")


@pytest.mark.parametrize("autopilot", AUTOPILOTS)
@pytest.mark.parametrize(
    "start", [at(170, 0, 20), at(0, 0, 60), at(-160, 40, 55)], ids=["beside", "above", "both"]
)
def test_where_no_stop_fits_it_crawls_at_a_metre_a_second(autopilot: str, start: Vec3) -> None:
    for v_ned in (STILL, at(-3, 1, -2)):
        sent = field(autopilot).paced(at(0, 0, 20), start, v_ned)
        assert math.hypot(*sent.v_ned) == pytest.approx(1.0)
