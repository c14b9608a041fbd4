"""The station as a client of the vehicle's own operator control, which vehicle-sim plays.

pymavlink 2.4.50 lacks the protocol; the other station's commands go by number.
"""

from __future__ import annotations

from pymavlink.dialects.v20 import all as dialect

from gcs.exit_codes import ExitCode
from gcs.gate.states import State
from gcs.session import inputs
from tests.loopback.flight import MISSIONS, Flight, Personality
from vehicle_sim.simulation.world import Datagram

CONTROL = 32100
OTHER = 250
RELEASE, REQUEST = 0.0, 1.0


def other_asks(flight: Flight, wish: float, *, others_may: bool) -> None:
    """The other station asks for control, or gives it up; its answer is not looked at."""
    mav = dialect.MAVLink(None, srcSystem=OTHER, srcComponent=190)
    command = dialect.MAVLink_command_long_message(
        1, 1, CONTROL, 0, wish, float(others_may), 3, 0, 0, 0, 0
    )
    flight.world.handle(Datagram(0, "other", bytes(command.pack(mav))), flight.now_ns)
    flight.run(2.5)


def owner(flight: Flight) -> int:
    control = flight.world._servers[0]._operator_control
    assert control is not None
    return control.owner


def test_the_station_asks_for_control_before_it_commands(personality: Personality) -> None:
    flight = Flight(personality, operator_control=True).connected()
    assert owner(flight) == 0, "who only looks takes no control"
    flight.do("arm")
    assert owner(flight) == 255
    flight.do("takeoff", up_m=2.0)
    assert flight.is_in(State.HOVERING)
    assert "the vehicle obeys this station" in flight.lines("link")


def test_of_another_station_that_lets_others_take_over_it_takes_over() -> None:
    flight = Flight(operator_control=True).connected()
    other_asks(flight, REQUEST, others_may=True)
    assert owner(flight) == OTHER
    words = "station 250 is in control of the vehicle, and lets others take over"
    assert words in flight.lines("link")
    flight.do("arm")
    assert owner(flight) == 255


def test_where_another_station_keeps_control_the_refusal_names_it() -> None:
    flight = Flight(operator_control=True).connected()
    other_asks(flight, REQUEST, others_may=False)
    assert flight.done(flight.say("arm")).startswith("aborted")
    assert (owner(flight), flight.vehicle.armed) == (OTHER, False)
    assert "NOT_IN_CONTROL" in " ".join(flight.told())
    words = "station 250 is in control of the vehicle, and has to give it up first"
    assert words in flight.lines("link")
    other_asks(flight, RELEASE, others_may=False)
    assert "no station is in control of the vehicle" in flight.lines("link")
    flight.do("arm")


def test_a_mission_is_brought_on_board_under_control() -> None:
    flight = Flight(operator_control=True).connected()
    other_asks(flight, REQUEST, others_may=True)
    flight.do("mission_upload", path=str(MISSIONS / "demo.toml"))
    assert owner(flight) == 255


def test_it_gives_control_up_when_it_leaves() -> None:
    flight = Flight(operator_control=True).connected()
    flight.do("arm")
    flight.do("disarm")
    flight.run(2.0)
    flight.feed(inputs.SignalCame("SIGTERM"))
    assert flight.finish is not None
    assert flight.finish.exit_code == ExitCode.DONE
    flight.finish = None
    flight.run(0.5)
    assert owner(flight) == 0


def test_of_a_vehicle_without_it_nothing_is_asked() -> None:
    flight = Flight().connected()
    flight.do("arm")
    assert not flight.sent_commands(CONTROL)
