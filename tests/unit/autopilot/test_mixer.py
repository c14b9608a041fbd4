"""The mixer gives what turns the vehicle, whatever thrust is asked for."""

from __future__ import annotations

import pytest

from tests.unit.estimator.flown import Flown
from vehicle_sim.control_loops.cascade import stabilise
from vehicle_sim.control_loops.flight import BY_RATES

ROLL_RAD_S = 0.3


def rolls_by(collective: float) -> float:
    """How much more thrust the left motors give than the right ones (1 = one motor's most).

    A roll is asked for, with so much (1 = hovering) of collective thrust.
    """
    vehicle = Flown()
    vehicle.lift_off()
    vehicle.fly(2.0)
    flight, believed = vehicle.flight, vehicle.engine.believed
    flight.attitude, flight.flying = BY_RATES, True
    flight.rate_sp_x, flight.rate_sp_y, flight.rate_sp_z = ROLL_RAD_S, 0.0, 0.0
    flight.collective_n = 4.0 * believed.hover_n * collective
    stabilise(flight, vehicle.est, believed)
    assert min(flight.u1, flight.u2, flight.u3, flight.u4) >= 0.0
    # Numbered as PX4 does: 1 and 4 on the right.
    return flight.u2**2 + flight.u3**2 - flight.u1**2 - flight.u4**2


@pytest.mark.parametrize("collective", [0.0, 0.05, 0.2])
def test_with_hardly_any_thrust_it_turns_as_when_it_hovers(collective: float) -> None:
    """PX4's MC_AIRMODE 1: thrust is added rather than a turn lost."""
    assert rolls_by(collective) == pytest.approx(rolls_by(1.0), rel=1e-6)


def test_it_rolls_to_the_right() -> None:
    assert rolls_by(1.0) > 0.05
