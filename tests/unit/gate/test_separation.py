"""How near two vehicles come, against every moment of their flight tried one by one."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from gcs.gate.airspace.separation import (
    Approach,
    Track,
    between_legs_m,
    closest_approach,
    is_too_close,
    legs_near,
)
from gcs.gate.policy.policy import SeparationLimits

V = tuple[float, float, float]
STILL = (0.0, 0.0, 0.0)
LIMITS = SeparationLimits(least_m=5.0, hysteresis_m=5.0, within_s=10.0)


def test_two_that_fly_towards_each_other_meet_in_the_middle() -> None:
    found = closest_approach(
        Track((0.0, 0.0, -10.0), (5.0, 0.0, 0.0)), Track((50.0, 0.0, -10.0), (-5.0, 0.0, 0.0)), 10.0
    )
    assert found == Approach(5.0, 0.0, 0.0, 0.0)


def test_two_that_cross_at_different_heights_are_apart_by_the_height() -> None:
    found = closest_approach(
        Track((0.0, 0.0, -10.0), (5.0, 0.0, 0.0)),
        Track((20.0, -20.0, -16.0), (0.0, 5.0, 0.0)),
        10.0,
    )
    assert (found.in_s, found.beside_m, found.above_m) == pytest.approx((4.0, 0.0, 6.0))
    assert found.least_m == pytest.approx(6.0)


def test_two_that_fly_apart_are_nearest_now() -> None:
    found = closest_approach(Track(STILL, (-1.0, 0.0, 0.0)), Track((8.0, 0.0, 0.0), STILL), 10.0)
    assert found == Approach(0.0, 8.0, 0.0, 8.0)


def test_what_comes_after_the_time_that_is_looked_ahead_does_not_count() -> None:
    found = closest_approach(Track(STILL, (1.0, 0.0, 0.0)), Track((30.0, 0.0, 0.0), STILL), 10.0)
    assert found == Approach(10.0, 20.0, 0.0, 20.0)


def test_two_that_fly_side_by_side_are_as_near_as_they_are() -> None:
    found = closest_approach(
        Track(STILL, (9.0, 3.0, 1.0)), Track((0.0, 4.0, 3.0), (9.0, 3.0, 1.0)), 60.0
    )
    assert found.least_m == pytest.approx(5.0)


def test_an_old_position_is_flown_on_and_its_error_grows() -> None:
    old = Track((0.0, 0.0, 0.0), (4.0, 0.0, 0.0), age_s=2.0, error_m=0.5, v_error_m_s=0.25)
    found = closest_approach(old, Track((20.0, 0.0, 0.0), STILL, error_m=1.0), 0.0)
    assert found.beside_m == pytest.approx(12.0)
    assert found.least_m == pytest.approx(12.0 - 0.5 - 1.0 - 0.5)


def test_a_velocity_that_may_be_wrong_brings_two_that_hover_nearer_with_time() -> None:
    found = closest_approach(
        Track(STILL, STILL, v_error_m_s=0.5), Track((20.0, 0.0, 0.0), STILL, v_error_m_s=0.5), 8.0
    )
    assert (found.in_s, found.least_m) == (8.0, 12.0)


@pytest.mark.parametrize(
    ("least_m", "anew", "still"),
    [
        (20.0, False, False),
        (10.0, False, False),
        (9.9, False, True),
        (5.0, False, True),
        (4.9, True, True),
        (0.0, True, True),
        (math.nan, True, True),
    ],
)
def test_it_begins_below_one_distance_and_ends_above_another(
    least_m: float, anew: bool, still: bool
) -> None:
    approach = Approach(1.0, least_m, 0.0, least_m)
    assert is_too_close(approach, LIMITS, was=False) is anew
    assert is_too_close(approach, LIMITS, was=True) is still


def test_a_least_distance_of_zero_finds_nothing() -> None:
    touching = Approach(0.0, 0.0, 0.0, 0.0)
    assert not is_too_close(touching, SeparationLimits(0.0, 0.0, 10.0), was=False)


@pytest.mark.parametrize("bad", [math.nan, math.inf, -math.inf])
def test_what_is_no_number_is_the_worst(bad: float) -> None:
    good = Track((500.0, 0.0, 0.0), STILL)
    for track in (
        Track((bad, 0.0, 0.0), STILL),
        Track(STILL, (0.0, bad, 0.0)),
        Track(STILL, STILL, age_s=bad),
        Track(STILL, STILL, error_m=bad),
        Track(STILL, STILL, v_error_m_s=bad),
    ):
        for pair in ((track, good), (good, track)):
            assert is_too_close(closest_approach(*pair, 5.0), LIMITS, was=False)


METRES = st.floats(-500.0, 500.0)
SPEEDS = st.floats(-20.0, 20.0)
TRACKS = st.builds(
    Track,
    pos_ned=st.tuples(METRES, METRES, METRES),
    v_ned=st.tuples(SPEEDS, SPEEDS, SPEEDS),
    age_s=st.floats(0.0, 2.0),
    error_m=st.floats(0.0, 3.0),
    v_error_m_s=st.floats(0.0, 1.0),
)


@given(a=TRACKS, b=TRACKS, within_s=st.floats(0.0, 30.0), share=st.floats(0.0, 1.0))
def test_at_no_moment_are_they_nearer(a: Track, b: Track, within_s: float, share: float) -> None:
    found = closest_approach(a, b, within_s)
    at_s = share * within_s
    places = [
        [p + v * (each.age_s + at_s) for p, v in zip(each.pos_ned, each.v_ned, strict=True)]
        for each in (a, b)
    ]
    wrong_m = sum(each.error_m + each.v_error_m_s * (each.age_s + at_s) for each in (a, b))
    assert found.least_m <= max(0.0, math.dist(*places) - wrong_m) + 1e-6
    assert 0.0 <= found.in_s <= within_s
    swapped = closest_approach(b, a, within_s)
    assert swapped.least_m == pytest.approx(found.least_m, abs=1e-6)


@given(
    pos=st.tuples(METRES, METRES, METRES),
    v=st.tuples(SPEEDS, SPEEDS, SPEEDS),
    error=st.floats(0, 5),
)
def test_a_wider_error_never_makes_it_safer(
    pos: tuple[float, float, float], v: tuple[float, float, float], error: float
) -> None:
    still = Track(STILL, STILL)
    sure = closest_approach(Track(pos, v), still, 10.0)
    unsure = closest_approach(Track(pos, v, error_m=error, v_error_m_s=error), still, 10.0)
    assert unsure.least_m <= sure.least_m + 1e-9


places = st.tuples(*[st.floats(-100.0, 100.0)] * 3)


@given(places, places, places, places)
def test_legs_are_as_near_as_any_two_of_their_points(a: V, b: V, c: V, d: V) -> None:
    shares = [number / 20 for number in range(21)]
    tried_m = min(
        math.dist(_share(a, b, one), _share(c, d, other)) for one in shares for other in shares
    )
    found_m = between_legs_m(a, b, c, d)
    coarse_m = (math.dist(a, b) + math.dist(c, d)) / 40
    assert tried_m - coarse_m - 1e-6 <= found_m <= tried_m + 1e-6
    assert found_m == pytest.approx(between_legs_m(d, c, b, a), abs=1e-6)


ways = st.lists(st.tuples(places, places), min_size=1, max_size=5)


@given(ways, ways, st.floats(0.0, 40.0))
def test_legs_that_are_not_compared_are_farther_apart(
    mine: list[tuple[V, V]], others: list[tuple[V, V]], within_m: float
) -> None:
    near, others_near = legs_near(mine, others, within_m)
    for one in mine:
        for other in others:
            if one not in near or other not in others_near:
                assert between_legs_m(*one, *other) > within_m


def test_of_long_ways_that_meet_at_a_corner_few_legs_are_compared() -> None:
    mine = [((0.0, east, 0.0), (100.0, east, 0.0)) for east in map(float, range(100))]
    others = [((103.0, east, 0.0), (200.0, east, 0.0)) for east in map(float, range(98, 198))]
    near, others_near = legs_near(mine, others, 5.0)
    assert (len(near), len(others_near)) == (7, 7)


def test_legs_that_cross_meet_and_one_that_is_not_finite_is_taken_to_meet() -> None:
    assert between_legs_m((0, 0, 0), (10, 10, 0), (10, 0, 0), (0, 10, 0)) == pytest.approx(0.0)
    assert between_legs_m((0, 0, 0), (10, 10, 0), (10, 0, 7), (0, 10, 7)) == pytest.approx(7.0)
    assert between_legs_m((0, 0, 0), (9, 0, 0), (0, 4, 0), (9, 4, 0)) == pytest.approx(4.0)
    assert between_legs_m((0, 0, 0), (math.nan, 0, 0), (50, 0, 0), (50, 0, 0)) == 0.0


def _share(a: V, b: V, share: float) -> V:
    return (
        a[0] + share * (b[0] - a[0]),
        a[1] + share * (b[1] - a[1]),
        a[2] + share * (b[2] - a[2]),
    )
