"""Orders that come late, twice, or in the wrong state: none of them may lose the vehicle."""

from __future__ import annotations

import pytest

from tests.unit.autopilot.hand_flight import HandFlight
from vehicle_sim.autopilot.interface import Result
from vehicle_sim.autopilot.modes import Personality


@pytest.mark.parametrize(("personality", "mode"), [("px4", "MANUAL"), ("ardupilot", "STABILIZE")])
def test_a_manual_mode_does_not_begin_with_sticks_that_fell_silent_long_ago(
    personality: Personality, mode: str
) -> None:
    flight = HandFlight(personality).airborne(20.0)
    flight.hold(0.3, right=1000, up=0)
    flight.fly(10.0)  # a failsafe has taken the vehicle
    flight.vehicle.set_mode_kind("hold")
    flight.fly(10.0)
    height_m = flight.up_m
    assert flight.mode(mode) is Result.ACCEPTED
    flight.fly(3.0)
    assert flight.up_m == pytest.approx(height_m, abs=1.0)
    assert flight.flat_m_s < 2.0
