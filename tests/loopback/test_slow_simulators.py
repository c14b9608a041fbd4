"""A vehicle whose clock is slower than ours, as of a simulator on a busy machine."""

from __future__ import annotations

from fractions import Fraction

import pytest

from gcs.gate.states import State
from tests.loopback.flight import PEER, PERSONALITIES, Flight, Personality
from tests.loopback.lossy_link import Weather
from tests.loopback.observed import START_NS
from vehicle_sim.services.profile import profile_of
from vehicle_sim.services.server import VehicleServer
from vehicle_sim.simulation.world import LinkSpec, World


class SlowFlight(Flight):
    """The same flight, its vehicle at `rate` of real time."""

    def __init__(self, personality: Personality, rate: str) -> None:
        super().__init__(personality)
        parameters = self.vehicle.parameters
        profile = profile_of(personality, parameters.firmware)
        server = VehicleServer(self.vehicle, profile, parameters, 1)
        self.world = World([server], [LinkSpec((PEER,))], Fraction(rate), START_NS)


@pytest.mark.parametrize("rate", ["0.95", "0.8"])
@pytest.mark.parametrize("personality", PERSONALITIES)
def test_it_flies_and_is_never_stale(personality: Personality, rate: str) -> None:
    flight = SlowFlight(personality, rate).connected()
    since_ns = flight.now_ns
    flight.hovering(3.0)
    flight.run(20.0)
    assert flight.done(flight.goto(4.0, 0.0, 3.0)) == "complete"
    flight.do("land")
    flight.until(lambda: not flight.vehicle.armed)
    assert "STALE" not in flight.states(since_ns)
    assert flight.is_in(State.GROUNDED)


def test_its_positions_in_a_long_queue_are_stale_all_the_same() -> None:
    flight = SlowFlight("px4", "0.8").hovering(3.0)
    since_ns = flight.now_ns
    flight.down.weather = Weather(delay_s=(3.0, 3.0))
    flight.until(lambda: "STALE" in flight.states(since_ns), 8.0)
    flight.run(10.0)
    assert not flight.is_in(State.HOVERING)
