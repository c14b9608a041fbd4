"""Legs past an exclusion zone, over it and through its edge, and the sentences about them.

The tower stands at 20 to 30 m east, 10 m long, up to 20 m.
"""

from __future__ import annotations

import math

import pytest
from msgspec.structs import replace

from gcs.frames import Vec3
from gcs.gate.airspace.bounds import Cleared
from gcs.gate.airspace.clearance import Motion
from gcs.gate.airspace.zones import Zone
from gcs.gate.geometry import TOLERANCE_M, Circle
from gcs.gate.policy.parse import DEFAULT
from gcs.gate.policy.policy import Policy
from gcs.gate.refusal import Code, Refusal
from tests.unit.gate.airspace import HOME, OUTER, STILL, TOWER, around, at, go

INCLUSIVE = replace(DEFAULT, bounds_inclusive=True)
"""2 m beside and 0.3 m above, and a goal exactly there is inside an inclusion zone."""


def test_a_motion_is_two_places_in_the_plane_with_two_heights() -> None:
    assert Motion.between((1.0, 2.0, -3.0), (4.0, 5.0, -6.0)) == Motion(
        (2.0, 1.0), 3.0, (5.0, 4.0), 6.0
    )


class TestAtTheMargin:
    """Exactly at the margin is too close to say, and inclusive bounds are no help here."""

    @pytest.mark.parametrize("policy", [DEFAULT, INCLUSIVE], ids=["default", "inclusive"])
    @pytest.mark.parametrize(
        ("north", "expected"), [(7.0, Code.TOO_CLOSE), (7.25, None), (6.75, Code.TOO_CLOSE)]
    )
    def test_beside_it(self, policy: Policy, north: float, expected: Code | None) -> None:
        verifier = around(OUTER, TOWER, policy=policy)
        assert go(verifier, at(50, north, 10), at(0, north, 10)) is expected

    @pytest.mark.parametrize("policy", [DEFAULT, INCLUSIVE], ids=["default", "inclusive"])
    def test_above_it(self, policy: Policy) -> None:
        """A roof at zero, so that a margin above it is a number without rounding."""
        cellar = Zone("cellar", False, TOWER.shape, -9.0, 0.0)
        verifier = around(OUTER, cellar, policy=replace(policy, margin_v_m=0.5))
        assert go(verifier, at(50, 0, 0.5), at(0, 0, 0.5)) is not None
        assert go(verifier, at(50, 0, 0.75), at(0, 0, 0.75)) is None


class TestReturn:
    """A return is asked for no margin, only to stay inside for certain."""

    @pytest.mark.parametrize(
        ("north", "blocked"), [(5.5, False), (5.01, False), (5.0, True), (4.5, True)]
    )
    def test_past_a_tower(self, north: float, blocked: bool) -> None:
        home_ned = at(0, north, 0)
        answer = around(OUTER, TOWER).return_path(at(60, north, 10), home_ned, 10.0)
        assert isinstance(answer, Refusal if blocked else Cleared)

    @pytest.mark.parametrize(
        ("up", "blocked"), [(20.25, False), (20.01, False), (20.0, True), (19.5, True)]
    )
    def test_over_a_tower(self, up: float, blocked: bool) -> None:
        answer = around(OUTER, TOWER).return_path(at(60, 0, up), HOME, up)
        assert isinstance(answer, Refusal if blocked else Cleared)

    @pytest.mark.parametrize(("up", "blocked"), [(TOLERANCE_M, False), (0.5 * TOLERANCE_M, True)])
    def test_from_as_near_above_a_roof_as_can_be_told(self, up: float, blocked: bool) -> None:
        cellar = Zone("cellar", False, Circle((0.0, 0.0), 9.0), -9.0, 0.0)
        answer = around(OUTER, cellar).return_path(at(0, 0, up), at(0, 40, 0), 20.0)
        assert isinstance(answer, Refusal if blocked else Cleared)


class TestSentences:
    def refusal(self, goal_ned: Vec3, pos_ned: Vec3) -> Refusal:
        answer = around(OUTER, TOWER).goal(goal_ned, None, pos_ned, STILL)
        assert isinstance(answer, Refusal)
        return answer

    def test_half_a_metre_outside_is_half_a_metre(self) -> None:
        refusal = self.refusal(at(150.5, 0, 2), at(0, 0, 2))
        assert refusal.code is Code.OUTSIDE_FENCE
        assert refusal.numbers == (("outside_m", 0.5), ("margin_m", 2.0))

    def test_half_a_metre_into_a_tower_is_inside_it(self) -> None:
        refusal = self.refusal(at(50, 4.5, 2), at(0, 4.5, 2))
        assert refusal.code is Code.LEG_LEAVES_FENCE
        assert refusal.numbers == (("outside_m", 0.5), ("margin_m", 2.0))
        assert "goes inside exclusion polygon 'tower'" in refusal.sentence

    def test_along_its_wall_is_through_it(self) -> None:
        """The boundary is met and nothing is entered."""
        refusal = self.refusal(at(50, 5, 2), at(0, 5, 2))
        assert refusal.code is Code.LEG_LEAVES_FENCE
        assert math.copysign(1.0, dict(refusal.numbers)["outside_m"]) == 1.0
        assert refusal.numbers == (("outside_m", 0.0), ("margin_m", 2.0))
        assert "goes through exclusion polygon 'tower'" in refusal.sentence
