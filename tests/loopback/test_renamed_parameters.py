"""What the station makes of an ArduCopter whose parameters have the names of 4.5, or of 4.7."""

from __future__ import annotations

from gcs.gate.states import State
from tests.loopback.flight import Flight


def returns(flight: Flight) -> None:
    flight.hovering(5.0)
    assert flight.done(flight.say("rtl"), 120.0) == "complete"
    assert flight.is_in(State.GROUNDED)


def test_it_returns_with_the_names_of_4_5() -> None:
    returns(Flight("ardupilot", firmware="4.5"))


def test_it_returns_with_the_names_of_4_7() -> None:
    returns(Flight("ardupilot", firmware="4.7"))
