"""The wind that the vehicle feels by its own drag, and how its board shakes."""

from __future__ import annotations

import pytest

from tests.unit.autopilot.flight import Flight
from vehicle_sim.autopilot.modes import Personality
from vehicle_sim.plant.faults import WindChange

either = pytest.mark.parametrize("personality", ["px4", "ardupilot"])


@pytest.mark.parametrize("wind_ne", [(0.0, 0.0), (6.0, 0.0), (-3.0, 4.0), (0.0, -9.0)])
def test_a_hovering_vehicle_feels_the_wind(wind_ne: tuple[float, float]) -> None:
    flight = Flight("px4")
    flight.vehicle.inject(WindChange((*wind_ne, 0.0), 0.0))
    flight.airborne(8.0)
    flight.fly(15.0)
    felt = flight.vehicle.wind_ned
    assert felt is not None
    assert felt[:2] == pytest.approx(wind_ne, abs=0.9)
    assert felt[2] == 0.0


@either
def test_the_vehicles_own_speed_is_no_wind(personality: Personality) -> None:
    flight = Flight.hovering(personality, 8.0)
    flight.vehicle.reposition((80.0, 0.0, -8.0), None, 5.0)
    flight.fly(12.0)
    felt = flight.vehicle.wind_ned
    assert flight.speed_m_s > 4.0
    assert felt is not None
    assert felt[:2] == pytest.approx((0.0, 0.0), abs=0.9)


@either
def test_nothing_is_said_of_the_wind_before_it_was_flown_in(personality: Personality) -> None:
    flight = Flight(personality).boot()
    flight.fly(20.0)
    assert flight.vehicle.wind_ned is None


@either
def test_vibration_is_the_noise_of_the_accelerometer_and_grows_with_it(
    personality: Personality,
) -> None:
    flight = Flight.hovering(personality, 5.0)
    flight.fly(5.0)
    quiet = flight.vehicle.vibration_m_s2
    assert all(0.001 < axis < 0.3 for axis in quiet)
    flight.vehicle.inject(WindChange((6.0, 0.0, 0.0), 4.0))
    flight.fly(6.0)
    rough = flight.vehicle.vibration_m_s2
    assert rough[0] > 2.0 * quiet[0]
