"""What the station makes of PX4's take-off, which ends up to NAV_MC_ALT_RAD too low."""

from __future__ import annotations

import pytest

from gcs.gate.states import State
from tests.loopback.flight import Flight


def takes_off(alt_rad_m: float) -> None:
    flight = Flight("px4", params={"NAV_MC_ALT_RAD": alt_rad_m})
    flight.hovering(1.5)
    flight.run(2.0)
    assert flight.is_in(State.HOVERING)


def test_a_climb_that_ends_near_its_height_is_complete() -> None:
    takes_off(0.3)


@pytest.mark.xfail(
    strict=True,
    reason="autopilots.md, defect 1 of the station: with PX4's own 0.8 m its climb ends too low",
)
def test_a_climb_that_ends_as_the_real_one_is_complete() -> None:
    takes_off(0.8)
