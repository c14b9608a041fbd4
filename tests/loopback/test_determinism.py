"""Equal seeds and equal inputs: equal bytes, equal flights."""

from __future__ import annotations

from fractions import Fraction

import pytest

from gcs.gate.states import State
from tests.loopback.bridged import Client
from tests.loopback.copies import each_flies_itself, fly_or_copy
from tests.loopback.fleet import Fleet
from tests.loopback.flight import HOMES, PEER, Flight, Personality
from tests.loopback.lossy_link import Weather
from tests.loopback.observed import START_NS, Sent
from vehicle_sim.autopilot.autopilot import Autopilot
from vehicle_sim.autopilot.parameters.parameters import Parameters
from vehicle_sim.services.profile import PROFILES
from vehicle_sim.services.server import VehicleServer
from vehicle_sim.simulation.world import Datagram, LinkSpec, Transmit, Wake, World

ROUGH = Weather(loss=0.1, duplicate=0.1, corrupt=0.05, delay_s=(0.001, 0.08))
MS = 1_000_000


def lab_flight(personality: Personality, seed: int) -> Flight:
    flight = Flight(personality, seed=seed, up=ROUGH, down=ROUGH)
    flight.run(2.0)
    flight.until(lambda: flight.is_in(State.GROUNDED))  # its first messages may be lost
    flight.say("arm")
    flight.run(3.0)
    flight.say("takeoff", up_m=2.0)
    flight.run(5.0)
    flight.goto(3.0, 1.0, 2.0)
    flight.run(4.0)
    flight.say("land")
    flight.run(3.0)
    return flight


def answers(personality: Personality, seed: int, given: list[Sent], wake_ms: int) -> list[bytes]:
    """Everything that a fresh vehicle says to `given`, lived in batches of `wake_ms`."""
    parameters = Parameters(personality)
    vehicle = Autopilot(personality, HOMES[personality], seed, params=parameters)
    server = VehicleServer(vehicle, PROFILES[personality], parameters, 1)
    world = World([server], [LinkSpec((PEER,))], Fraction(1), START_NS)
    out: list[bytes] = []
    now_ns = START_NS
    for sent in given:
        while now_ns + wake_ms * MS < sent.time_ns:
            now_ns += wake_ms * MS
            out += _said(world, Wake(), now_ns)
        now_ns = sent.time_ns
        out += _said(world, Datagram(0, PEER, sent.data), now_ns)
    return out


def _said(world: World, given: Wake | Datagram, now_ns: int) -> list[bytes]:
    return [item.data for item in world.handle(given, now_ns) if isinstance(item, Transmit)]


def test_a_vehicle_says_the_same_bytes_in_whatever_batches_it_lives(
    personality: Personality,
) -> None:
    given = lab_flight(personality, 7).sent
    once = answers(personality, 7, given, wake_ms=20)
    assert len(once) > 500
    assert answers(personality, 7, given, wake_ms=20) == once
    assert answers(personality, 7, given, wake_ms=3) == once
    assert answers(personality, 7, given, wake_ms=700) == once
    assert answers(personality, 8, given, wake_ms=20) != once


def test_two_flights_of_one_seed_are_one_record(personality: Personality) -> None:
    one, two, other = (lab_flight(personality, seed) for seed in (7, 7, 8))
    assert len(one.records) > 2000
    assert one.records == two.records
    assert one.sent == two.sent
    assert one.events == two.events
    assert one.records != other.records


def further(flight: Flight) -> tuple[object, ...]:
    flight.goto(3.0, 1.0, 2.0)
    flight.run(4.0)
    flight.say("land")
    flight.run(2.0)
    return flight.sent, flight.received, flight.events, flight.state, flight.truth_enu()


def in_the_air(personality: Personality) -> Flight:
    flight = Flight(personality, seed=3)
    fly_or_copy(flight, (Flight, personality), lambda: flight.hovering(2.0))
    return flight


def test_a_copy_goes_on_as_the_flight_that_it_is_a_copy_of(personality: Personality) -> None:
    """What tests that begin in the air rest on (`copies.py`)."""
    with each_flies_itself():
        itself = further(in_the_air(personality))
    assert len(itself) > 0
    for _ in range(3):  # the first one flies, and nobody's way is seen by the next copy
        assert further(in_the_air(personality)) == itself


@pytest.mark.thorough
def test_a_copy_of_a_fleet_goes_on_as_the_fleet() -> None:
    def heard(fleet: Fleet, client: Client) -> list[bytes]:
        fleet.send_to(client, 1, 8, 0, 5)
        fleet.send_to(client, 2, 0, 12, 7)
        fleet.run(5.0)
        return [one.message.get_msgbuf() for one in client.heard]

    with each_flies_itself():
        fleet = Fleet()
        itself = heard(fleet, fleet.all_flying())
    for _ in range(3):
        copied = Fleet()
        assert heard(copied, copied.all_flying()) == itself
        assert copied.sent == fleet.sent
