"""A GPS that is lost in flight: the gate knows it at once, and stops what it flies."""

from __future__ import annotations

import pytest

from gcs.gate.condition import Condition
from gcs.gate.states import State
from tests.loopback.flight import PERSONALITIES, Flight, Personality
from vehicle_sim.simulation.fault_script import fault_of


@pytest.mark.parametrize("personality", PERSONALITIES)
def test_a_lost_fix_stops_the_flight_long_before_the_vehicle_s_own_failsafe(
    personality: Personality,
) -> None:
    """autopilots.md, defect 10: a go-to went on for 6 to 8 s by dead-reckoned positions."""
    flight = Flight(personality).hovering(5.0)
    goal = flight.goto(60.0, 0.0, 5.0)
    flight.run(2.0)
    assert flight.is_in(State.MOVING)
    lost = fault_of("gps_lost", {}, "script")
    assert flight.world.inject(lost, 1)
    flight.run(1.5)
    assert flight.outcome(goal) == "aborted SEVERITY"
    assert Condition.GPS_LOST in flight.conditions
    assert any(line.startswith("HOLD: gps_lost: ") for line in flight.lines("state_and_safety"))
    assert flight.done(flight.goto(1.0, 0.0, 5.0)) in ("refused SEVERITY", "refused HOLDING")


@pytest.mark.parametrize("personality", PERSONALITIES)
def test_on_the_ground_it_does_not_arm_until_the_fix_is_back(personality: Personality) -> None:
    flight = Flight(personality).connected()
    lost = fault_of("gps_lost", {}, "script")
    assert flight.world.inject(lost, 1)
    flight.run(1.5)
    assert flight.done(flight.say("arm")) == "refused SEVERITY"
    back = lost.ended()
    assert back is not None
    assert flight.world.inject(back, 1)
    flight.until(lambda: not flight.conditions or flight.vehicle.armable, 30.0)
    flight.until(lambda: Condition.GPS_LOST not in flight.conditions, 30.0)
    flight.run(5.0)
    flight.do("arm")
