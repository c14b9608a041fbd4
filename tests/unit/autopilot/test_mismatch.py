"""The mismatch grid: with another plant than it believes in, the vehicle still does its work."""

from __future__ import annotations

import pytest

from tests.shares import one_in
from tests.unit.autopilot.mismatch import CASES, flown
from vehicle_sim.autopilot.modes import Personality


@pytest.mark.slow
@pytest.mark.parametrize("personality", ["px4", "ardupilot"])
@pytest.mark.parametrize("case", one_in(3, CASES))
def test_it_takes_off_hovers_flies_the_square_lands_and_disarms(
    case: str, personality: Personality
) -> None:
    """`python -m tests.unit.autopilot.mismatch` prints the figures."""
    figures = flown(personality, CASES[case])
    # PX4's loops have its own gains, which are weaker in a wind of 10 m/s.
    assert figures.hover_m < (0.35 if personality == "px4" else 0.3)
    assert figures.hover_up_m < 0.4
    assert figures.climb_over_m < 1.1
    # In a wind of 10 m/s the loops that have learnt its drag overshoot.
    assert figures.over_m < (0.6 if case == "wind 10 m/s" else 0.5)
    # PX4 flies its legs by MPC_JERK_AUTO: 40 m in 13.3 s (I2_takeoff_and_goto_profiles).
    assert figures.square_s < (27.0 if personality == "px4" else 20.0)
    assert figures.land_s < (20.0 if personality == "px4" else 25.0)
    assert figures.yaw_deg < 2.0
