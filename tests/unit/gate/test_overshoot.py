"""A goal past which the vehicle would fly into the brake is refused; figures as recorded.

Scenario I1_step_response: PX4 1.14.3 in OFFBOARD flies 0.54 and 0.52 m past a step of 10 m (0.58 m
at most in its track), 0.21 and 0.19 m above a climb of 5 m, 0.13 and 0.14 m below a descent of 5 m;
ArduCopter 4.7 in GUIDED 0.21 m (0.25 m in its track) and 0.06 m.
"""

from __future__ import annotations

from dataclasses import replace

import pytest

from gcs.gate.airspace.stopping import overshoot_point
from gcs.gate.policy.parse import DEFAULT, parse_policy
from gcs.gate.policy.policy import Overshoot
from gcs.gate.refusal import Code, Refusal
from tests.unit.gate.airspace import LAB, OUTER, STILL, TOWER, around, at, flying, go

CLOSE = parse_policy("margin_h_m = 0.5\nbrake_slack_h_m = 0.5", "my.toml")
"""It brakes where the stop would be less than 0.5 m from a boundary, the error of a position."""


@pytest.mark.parametrize(
    ("autopilot", "beside_m", "above_m", "below_m"),
    [("px4", 0.58, 0.21, 0.14), ("ardupilot", 0.25, 0.06, 0.04)],
)
def test_the_default_covers_what_was_recorded(
    autopilot: str, beside_m: float, above_m: float, below_m: float
) -> None:
    overshoot = DEFAULT.overshoot_of(autopilot)
    here = at(0, 0, 10)
    assert overshoot_point(here, at(0, 10, 10), overshoot)[0] >= 10.0 + beside_m
    assert -overshoot_point(here, at(0, 0, 15), overshoot)[2] >= 15.0 + above_m
    assert -overshoot_point(here, at(0, 0, 5), overshoot)[2] <= 5.0 - below_m


def test_it_is_a_share_of_the_leg_and_bounded() -> None:
    overshoot = Overshoot(share_h=0.1, most_h_m=1.0, share_v=0.2, most_v_m=0.5)
    here = at(0, 0, 10)
    assert overshoot_point(here, at(3, 4, 12), overshoot) == pytest.approx(at(3.3, 4.4, 12.4))
    assert overshoot_point(here, at(30, 40, 2), overshoot) == pytest.approx(at(30.6, 40.8, 1.5))
    assert overshoot_point(here, here, overshoot) == here


def test_an_autopilot_that_is_not_known_flies_past_as_far_as_the_worst() -> None:
    assert DEFAULT.overshoot_of("betaflight") == DEFAULT.overshoot["px4"]


@pytest.mark.parametrize(
    ("autopilot", "from_east_m", "code"),
    [("px4", 9.0, Code.TOO_CLOSE), ("px4", 18.1, None), ("ardupilot", 9.0, None)],
)
def test_towards_an_exclusion_zone_it_depends_on_leg_and_autopilot(
    autopilot: str, from_east_m: float, code: Code | None
) -> None:
    """0.9 m before the tower: after 10 m a px4 may be at its wall, an ardupilot 0.6 m before it."""
    verifier = replace(around(OUTER, TOWER, policy=CLOSE), autopilot=autopilot)
    assert go(verifier, at(19.1, 0, 2), at(from_east_m, 0, 2)) is code


def test_along_a_zone_and_away_from_it_nothing_is_flown_into() -> None:
    verifier = around(OUTER, TOWER, policy=CLOSE)
    assert go(verifier, at(19.1, 3, 2), at(19.1, -7, 2)) is None
    assert go(verifier, at(9.0, 0, 2), at(19.1, 0, 2)) is None


def test_it_is_said_how_far_and_how_close() -> None:
    refusal = flying().goal(at(0, 0, 49.6), None, at(0, 0, 2), STILL)
    assert isinstance(refusal, Refusal)
    assert refusal.sentence == (
        "goal (0.00 E, 0.00 N, 49.60 U) is 0.40 m from inclusion circle 'home': "
        "the vehicle may fly 0.25 m past it, and be braked 0.20 m from the edge"
    )
    assert refusal.zone == "home"
    assert dict(refusal.numbers) == pytest.approx(
        {"clear_m": 0.4, "overshoot_m": 0.25, "limit_m": 0.2}
    )


def test_the_lab_accepts_a_goal_on_its_cage_from_anywhere() -> None:
    assert go(flying(LAB), at(5, 5, 2), at(-5, -5, 0)) is None
