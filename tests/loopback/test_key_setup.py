"""A key is given to a vehicle and taken away again, over links good and bad."""

from __future__ import annotations

import pytest

from gcs.protocol.signing_setup import Ending, SigningSetup
from gcs.wire.frame import Frame, split
from gcs.wire.signing import SecretKey
from tests.loopback.flight import PEER, Flight, Personality
from tests.loopback.lossy_link import CLEAR, Air, Weather
from vehicle_sim.simulation.world import Datagram, Transmit, Wake

KEY, OTHER = SecretKey(bytes(range(32))), SecretKey(bytes(32 * [7]))
STEP_NS = 10_000_000
LOSSY = Weather(loss=0.3, duplicate=0.1, delay_s=(0.001, 0.05))


def carried_out(
    flight: Flight,
    new: SecretKey | None,
    old: SecretKey | None = None,
    weather: Weather = CLEAR,
    *,
    deaf: bool = False,
) -> SigningSetup:
    """The set-up against the flight's vehicle, without its station."""
    flight.run(0.05)  # its record, which may be audited, begins with the station
    world = flight.world
    now_ns = flight.now_ns
    setup = SigningSetup(new, old, 0, now_ns + 10 * 10**9)
    up, down = Air(weather, 5), Air(weather, 6)
    while setup.ending is None:
        now_ns += STEP_NS
        sent = setup.wake(now_ns)
        outputs = [*world.handle(Wake(), now_ns)]
        for data in up.arrived(now_ns):
            outputs += world.handle(Datagram(0, PEER, data), now_ns)
        for output in outputs:
            if isinstance(output, Transmit):
                down.send(output.data, now_ns)
        for data in down.arrived(now_ns):
            for item in split(data):
                if isinstance(item, Frame):
                    sent += setup.handle(item, now_ns)
        for raw in sent:
            if not deaf:
                up.send(raw, now_ns)
    flight.now_ns = now_ns
    return setup


@pytest.mark.parametrize("weather", [CLEAR, LOSSY], ids=["clear", "30 % loss"])
def test_a_key_comes_and_goes(personality: Personality, weather: Weather) -> None:
    flight = Flight(personality)
    assert carried_out(flight, KEY, weather=weather).ending is Ending.DONE
    again = carried_out(flight, KEY, weather=weather)
    assert (again.ending, again.had_it) == (Ending.DONE, True)
    assert carried_out(flight, OTHER, weather=weather).ending is Ending.OTHER_KEY
    assert carried_out(flight, OTHER, KEY, weather).ending is Ending.DONE
    assert carried_out(flight, None, KEY, weather).ending is Ending.OTHER_KEY
    removed = carried_out(flight, None, OTHER, weather)
    assert (removed.ending, removed.had_it) == (Ending.DONE, False)
    assert carried_out(flight, None, OTHER, weather).had_it


def test_an_armed_vehicle_is_left_as_it_is(personality: Personality) -> None:
    flight = Flight(personality).connected()
    flight.do("arm")
    assert carried_out(flight, KEY).ending is Ending.ARMED


def test_firmware_that_takes_no_key_is_told_from_one_that_does() -> None:
    """A vehicle that never hears SETUP_SIGNING is to us like one that has no signing."""
    flight = Flight()
    flight.run(1.0)
    assert carried_out(flight, KEY, deaf=True).ending is Ending.NO_EFFECT


def test_without_a_vehicle_it_ends_in_time() -> None:
    setup = SigningSetup(KEY, None, 0, 10**10)
    now_ns = 0
    while setup.ending is None:
        now_ns += 100_000_000
        setup.wake(now_ns)
    assert setup.ending is Ending.NO_VEHICLE
    assert now_ns < 12 * 10**9


def test_a_vehicle_that_answers_unsigned_requests_is_told_of() -> None:
    """As ArduPilot's does over USB: here one whose rules allow COMMAND_LONG unsigned."""
    flight = Flight("ardupilot")
    flight.world._board._signing._unsigned_allowed = frozenset({76})
    assert carried_out(flight, KEY).ending is Ending.TAKES_UNSIGNED


def test_only_the_vehicle_that_was_named_is_spoken_to() -> None:
    flight = Flight()
    setup = SigningSetup(KEY, None, 2, flight.now_ns + 10**9)
    flight.run(2.0)
    sent = []
    for each in flight.received:
        for item in split(each.data):
            if isinstance(item, Frame):
                sent += setup.handle(item, each.time_ns)
    assert sent == []
