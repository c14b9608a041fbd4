"""The policy's height and distance from home, and the largest numbers that can be computed with.

Home lies off the origin on all three axes, and at a different distance on each.
"""

from __future__ import annotations

import math

import pytest

from gcs.frames import Vec3
from gcs.gate.airspace.bounds import (
    FASTEST_M_S,
    STANDING,
    Bounds,
    Cleared,
    beyond_reach,
    not_finite,
)
from gcs.gate.airspace.clearance import NO_MARGINS, Margins
from gcs.gate.airspace.verifier import Verifier
from gcs.gate.geometry import REACH_M
from gcs.gate.policy.parse import DEFAULT
from gcs.gate.refusal import Code, Refusal
from tests.unit.gate.airspace import at, go

HOME: Vec3 = (10.0, -20.0, -3.0)
"""10 m north, 20 m west, 3 m up."""

HIGHEST_M, LOWEST_M, FARTHEST_M = 120.0, 0.0, 1000.0
"""The default policy's."""


def limits(
    north: float, east: float, up: float, *, allow: Margins = NO_MARGINS, floor: bool = True
) -> Refusal | None:
    """The verdict on a place so far from home."""
    pos_ned = (HOME[0] + north, HOME[1] + east, HOME[2] - up)
    bounds = Bounds(DEFAULT, (), "px4", HOME, origin_known=True)
    return bounds.beyond_limits("it", pos_ned, allow=allow, floor_applies=floor)


def code(refusal: Refusal | None) -> Code | None:
    return None if refusal is None else refusal.code


@pytest.mark.parametrize(
    ("place", "expected"),
    [
        ((0.0, 0.0, HIGHEST_M), None),
        ((0.0, 0.0, HIGHEST_M + 0.25), Code.TOO_HIGH),
        ((0.0, 0.0, LOWEST_M), None),
        ((0.0, 0.0, LOWEST_M - 0.25), Code.TOO_LOW),
        ((600.0, 800.0, 5.0), None),
        ((600.0, 800.25, 5.0), Code.TOO_FAR),
        ((600.25, 800.0, 5.0), Code.TOO_FAR),
        ((-600.0, -800.0, 5.0), None),
        ((-600.0, -800.25, 5.0), Code.TOO_FAR),
        ((-600.25, -800.0, 5.0), Code.TOO_FAR),
    ],
)
def test_a_limit_itself_is_allowed_and_a_hand_beyond_is_not(
    place: Vec3, expected: Code | None
) -> None:
    assert code(limits(*place)) is expected


@pytest.mark.parametrize(
    ("place", "expected"),
    [
        ((0.0, 0.0, HIGHEST_M + 2.0), None),
        ((0.0, 0.0, HIGHEST_M + 2.25), Code.TOO_HIGH),
        ((0.0, 0.0, LOWEST_M - 2.0), None),
        ((0.0, 0.0, LOWEST_M - 2.25), Code.TOO_LOW),
        ((0.0, FARTHEST_M + 1.0, 5.0), None),
        ((0.0, FARTHEST_M + 1.25, 5.0), Code.TOO_FAR),
    ],
)
def test_what_is_allowed_on_top_widens_each_limit(place: Vec3, expected: Code | None) -> None:
    assert code(limits(*place, allow=Margins(1.0, 2.0))) is expected


def test_the_least_height_is_a_floor() -> None:
    assert limits(0.0, 0.0, -50.0, floor=False) is None
    assert code(limits(0.0, 0.0, HIGHEST_M + 1.0, floor=False)) is Code.TOO_HIGH


def test_the_numbers_count_from_home() -> None:
    too_high, too_low, too_far = limits(1, 2, 130), limits(1, 2, -5), limits(3000, 4000, 5)
    assert too_high is not None
    assert too_low is not None
    assert too_far is not None
    assert too_high.numbers == (("up_m", 130.0), ("max_up_m", HIGHEST_M))
    assert too_low.numbers == (("up_m", -5.0), ("min_up_m", LOWEST_M))
    assert too_far.numbers == (("distance_m", 5000.0), ("max_distance_m", FARTHEST_M))


@pytest.mark.parametrize("axis", [0, 1, 2])
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_a_place_is_within_reach_of_the_origin_on_each_axis(axis: int, sign: float) -> None:
    def there(reach_m: float) -> Vec3:
        north, east, down = (sign * reach_m if i == axis else 1.0 for i in range(3))
        return (north, east, down)

    assert beyond_reach(there(REACH_M)) is None
    assert code(beyond_reach(there(math.nextafter(REACH_M, math.inf)))) is Code.TOO_FAR
    assert code(beyond_reach(there(math.nan))) is Code.TOO_FAR


@pytest.mark.parametrize("axis", [0, 1, 2])
def test_a_velocity_is_no_faster_than_anything_flies(axis: int) -> None:
    def speed(m_s: float) -> Vec3:
        north, east, down = (-m_s if i == axis else 1.0 for i in range(3))
        return (north, east, down)

    assert FASTEST_M_S == 10_000.0
    assert beyond_reach((1.0, 2.0, 3.0), speed(FASTEST_M_S)) is None
    assert code(beyond_reach((1.0, 2.0, 3.0), speed(10_000.5))) is Code.CANNOT_STOP


def test_what_stands_has_no_velocity_and_is_within_reach() -> None:
    assert STANDING == (0.0, 0.0, 0.0)
    assert beyond_reach((1.0, 2.0, 3.0)) is None


@pytest.mark.parametrize("wrong", [math.nan, math.inf, -math.inf])
def test_one_number_that_is_not_finite_is_enough_and_is_named(wrong: float) -> None:
    refusal = not_finite({"home": (1.0, 2.0), "goal": (0.0, wrong, 0.0), "yaw": ()})
    assert refusal == Refusal(Code.NON_FINITE, "goal is not finite")
    assert not_finite({"home": (1.0, 2.0), "yaw": ()}) is None


class TestUntilHomeIsKnown:
    def verifier(self) -> Verifier:
        """Without a fence: the limits alone."""
        return Verifier(DEFAULT, (), "px4", None, origin_known=False, fence_on=False)

    @pytest.mark.parametrize(
        ("goal", "expected"),
        [
            (at(0, 0, 120), None),
            (at(0, 0, 120.25), Code.TOO_HIGH),
            (at(0, 0, 0), None),
            (at(0, 0, -0.25), Code.TOO_LOW),
            (at(800, 600, 5), None),
            (at(-800, 600, 5), None),
            (at(800, -600, 5), None),
            (at(800.25, 600, 5), Code.TOO_FAR),
        ],
    )
    def test_the_limits_count_from_the_local_origin(
        self, goal: Vec3, expected: Code | None
    ) -> None:
        assert go(self.verifier(), goal, at(0, 0, 2)) is expected


class TestTakeOff:
    def take_off(self, up_m: float) -> Code | None:
        verifier = Verifier(DEFAULT, (), "px4", HOME, origin_known=False, fence_on=False)
        answer = verifier.takeoff(up_m, (15.0, 25.0, -3.0))
        return None if isinstance(answer, Cleared) else answer.code

    def test_it_is_a_climb_of_at_most_30_metres(self) -> None:
        assert self.take_off(30.0) is None
        assert self.take_off(30.25) is Code.TOO_HIGH
        assert self.take_off(0.25) is None
        assert self.take_off(0.0) is Code.TOO_LOW
        assert self.take_off(-1.0) is Code.TOO_LOW


class TestCircle:
    def circle(self, north: float, east: float, radius_m: float) -> Code | None:
        verifier = Verifier(DEFAULT, (), "px4", HOME, origin_known=False, fence_on=False)
        refusal = verifier.mission_circle((HOME[0] + north, HOME[1] + east, -53.0), radius_m)
        return code(refusal)

    @pytest.mark.parametrize("radius_m", [100.0, -100.0])
    def test_the_far_side_of_a_circle_is_within_the_distance(self, radius_m: float) -> None:
        assert self.circle(0.0, 900.0, radius_m) is None
        assert self.circle(0.0, 900.25, radius_m) is Code.TOO_FAR

    def test_it_is_within_the_heights(self) -> None:
        verifier = Verifier(DEFAULT, (), "px4", HOME, origin_known=False, fence_on=False)
        centre = (HOME[0], HOME[1])
        assert verifier.mission_circle((*centre, -123.0), 50.0) is None
        assert code(verifier.mission_circle((*centre, -123.25), 50.0)) is Code.TOO_HIGH
        assert verifier.mission_circle((*centre, -3.0), 50.0) is None
        assert code(verifier.mission_circle((*centre, -2.75), 50.0)) is Code.TOO_LOW
