"""A bug in the middle of a flight: the vehicle is told to hold before the link goes."""

from __future__ import annotations

import pytest

from gcs.exit_codes import ExitCode
from gcs.gate.states import State
from gcs.session import inputs
from gcs.session.effects import Finish, Transmit
from tests.loopback.flight import PERSONALITIES, Flight, Personality


@pytest.mark.parametrize("personality", PERSONALITIES)
def test_a_fault_on_the_clock_in_flight_holds_the_vehicle(personality: Personality) -> None:
    flight = Flight(personality).hovering(2.0)
    flight.goto(20.0, 0.0, 2.0)
    flight.run(1.0)
    assert flight.is_in(State.MOVING)
    fault_ns = flight.now_ns
    effects = flight.fault(inputs.Wake(), "ZeroDivisionError: a bug")
    sent = [effect.data for effect in effects if isinstance(effect, Transmit)]
    (finish,) = [effect for effect in effects if isinstance(effect, Finish)]
    assert finish.exit_code == ExitCode.BUG
    for data in sent:
        flight.up.send(data, fault_ns)
    flight.recorder = None  # a station that has ended records nothing
    flight.vehicle_silent = True  # the link is gone: nobody listens, nobody speaks
    flight.finish = None
    flight.run(0.2)
    assert flight.vehicle.mode_name in ("AUTO.LOITER", "BRAKE")
