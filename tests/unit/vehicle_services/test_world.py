"""The whole simulation: exact time, equal bytes for equal inputs, and any noise at its doors."""

from __future__ import annotations

from fractions import Fraction
from itertools import pairwise

import pytest

from tests.unit.vehicle_services.fake_vehicle import MS, Bench, FakeVehicle, S, long
from vehicle_sim.autopilot.autopilot import Autopilot
from vehicle_sim.autopilot.interface import Geodetic
from vehicle_sim.autopilot.modes import Personality
from vehicle_sim.services.profile import PROFILES
from vehicle_sim.services.server import VehicleServer
from vehicle_sim.simulation.world import (
    DATAGRAM_BYTES,
    Datagram,
    Input,
    Joined,
    Left,
    LinkSpec,
    Transmit,
    Wake,
    World,
)
from vehicle_sim.wire import messages as m
from vehicle_sim.wire.codec import encode
from vehicle_sim.wire.messages import Message
from vehicle_sim.wire.split import Counters, split

HOME = Geodetic(47.397742, 8.545594, 488.0)
GROUND = m.Heartbeat(0, 6, 8, 0, 4, 3)


def real_world(
    seed: int, personality: Personality = "px4", speedup: Fraction = Fraction(1)
) -> World:
    vehicle = Autopilot(personality, HOME, seed)
    server = VehicleServer(vehicle, PROFILES[personality], vehicle.parameters, 1, speedup)
    return World([server], [LinkSpec()], speedup)


def script() -> list[tuple[int, Message]]:
    """Arms, takes off, streams a goal, asks for OFFBOARD, lands."""
    goal = m.SetPositionTargetLocalNed(0, 3, 1, -3, 0, 0, 0, 0, 0, 0, 0, 0, 3576, 1, 1, 1)
    nan = float("nan")
    return [
        (100 * MS, GROUND),
        (1500 * MS, long(400, 1)),
        (1600 * MS, long(22, 0, 0, 0, nan, nan, nan, nan)),
        (1700 * MS, m.ParamRequestList(1, 1)),
        *((5 * S + n * 50 * MS, goal) for n in range(60)),
        (5 * S + 60 * MS, long(176, 1, 6)),
        (8 * S, long(21)),
    ]


def fly(seed: int, nap_ns: int, speedup: Fraction = Fraction(1)) -> bytes:
    """Everything that is transmitted, waking every `nap_ns` besides the script."""
    world = real_world(seed, speedup=speedup)
    inputs: list[tuple[int, Input]] = [
        (at_ns, Datagram(0, "ground", encode(message, number & 0xFF, 255, 190)))
        for number, (at_ns, message) in enumerate(script())
    ]
    inputs += [(at_ns, Wake()) for at_ns in range(nap_ns, 10 * S, nap_ns)]
    inputs.sort(key=lambda each: each[0])
    sent = b""
    for at_ns, given in [*inputs, (10 * S, Wake())]:
        for output in world.handle(given, at_ns):
            if isinstance(output, Transmit):
                sent += output.data
    return sent


@pytest.mark.slow
def test_the_bytes_do_not_depend_on_how_many_steps_a_call_covers() -> None:
    reference = fly(1, 4 * MS)
    assert len(reference) > 50_000
    for nap_ns in (20 * MS, 333 * MS, 9 * S):
        assert fly(1, nap_ns) == reference


@pytest.mark.slow
def test_the_bytes_are_equal_for_equal_seeds_only() -> None:
    speedup = Fraction(7, 3)
    assert fly(1, 100 * MS, speedup) == fly(1, 37 * MS, speedup)
    assert fly(1, 100 * MS) != fly(2, 100 * MS)


@pytest.mark.slow
@pytest.mark.parametrize("speedup", [Fraction(1), Fraction(50), Fraction(1, 3), Fraction(7, 3)])
def test_simulated_time_is_exact_for_ever(speedup: Fraction) -> None:
    bench = Bench(speedup=speedup)
    world = bench.world
    world.handle(Wake(), 11 * S)
    assert world.time_ns == 11 * S * speedup // (4 * MS) * 4 * MS
    assert 11 * S < world.deadline_ns <= 11 * S + 20 * MS
    before = world.time_ns
    world.handle(Wake(), world.deadline_ns - 1)
    world.handle(Wake(), world.deadline_ns)
    assert world.time_ns > before


def test_the_deadline_is_never_in_the_past_even_with_transfers_under_way() -> None:
    bench = Bench()
    bench.send(m.MissionCount(3, 1, 1))
    bench.send(m.ParamRequestList(1, 1))
    for _ in range(300):
        assert bench.world.deadline_ns > bench.now_ns
        bench.now_ns = bench.world.deadline_ns
        bench.world.handle(Wake(), bench.now_ns)


def test_messages_of_one_moment_share_datagrams_of_bounded_size() -> None:
    bench = Bench()
    bench.send(GROUND)
    outputs = bench.world.handle(Wake(), 20 * MS)
    position = [each for each in outputs if isinstance(each, Transmit)]
    assert len(position) == 1
    assert len(split(position[0].data, Counters())) > 1
    asked = Datagram(0, "ground", encode(long(512, 435, 0), 9, 255, 190))
    sizes = [len(o.data) for o in bench.world.handle(asked, 20 * MS) if isinstance(o, Transmit)]
    assert max(sizes) <= DATAGRAM_BYTES


def test_sequence_numbers_run_without_a_gap_on_every_channel() -> None:
    bench = Bench()
    bench.send(GROUND, peer="one")
    bench.send(GROUND, peer="two")
    heard: dict[str, list[int]] = {"one": [], "two": []}
    for at_ns in range(20 * MS, 3 * S, 20 * MS):
        for output in bench.world.handle(Wake(), at_ns):
            if isinstance(output, Transmit):
                frames = split(output.data, Counters())
                heard[str(output.peer)] += [frame.sequence for frame in frames]
    for sequences in heard.values():
        steps = {(b - a) & 0xFF for a, b in pairwise(sequences)}
        assert steps == {1}


def test_a_peer_that_only_makes_noise_is_not_spoken_to() -> None:
    bench = Bench()
    assert bench.world.handle(Datagram(0, "noise", b"*Init ArduCopter"), 0) == []
    assert bench.world.counters(0, "noise") is None


def test_a_silent_peer_is_forgotten_when_room_is_needed_and_a_lasting_one_is_not() -> None:
    vehicle = FakeVehicle()
    bench = Bench()
    server = VehicleServer(vehicle, PROFILES["px4"], bench.parameters, 1)
    world = World([server], [LinkSpec(peers=("station",))])
    beat = encode(GROUND, 0, 255, 190)
    world.handle(Datagram(0, "early", beat), 0)
    world.handle(Datagram(0, "late", beat), 61 * S)
    assert world.counters(0, "early") is None
    assert world.counters(0, "station") is not None


def test_one_peer_too_many_is_spoken_to_when_the_others_have_been_silent_for_a_minute() -> None:
    bench = Bench("ardupilot")
    for number in range(32):
        bench.send(GROUND, peer=f"peer {number}")
    assert bench.send(m.Timesync(0, 77), peer="one more") == []
    bench.now_ns = 59 * S
    assert bench.send(m.Timesync(0, 77), peer="one more") == []
    bench.now_ns = 61 * S
    assert m.Timesync in {type(each) for each in bench.send(m.Timesync(0, 77), peer="one more")}
    assert bench.world.counters(0, "peer 0") is None


def test_a_value_that_no_field_holds_is_said_once_and_costs_its_message_only() -> None:
    bench = Bench()
    bench.send(GROUND)
    bench.vehicle.custom_mode = -1
    heard = {type(each) for each in bench.advance(3 * S)}
    assert m.Attitude in heard
    assert m.Heartbeat not in heard
    told = [log for log in bench.logs if "Heartbeat cannot be sent" in log.text]
    assert [log.level for log in told] == ["error"]


def test_connections_come_and_go() -> None:
    bench = Bench("ardupilot")
    greeting = bench.world.handle(Joined(0, "tcp"), 0)
    assert [type(each) for each in greeting] == [Transmit]
    bench.world.handle(Datagram(0, "tcp", encode(m.MissionCount(2, 1, 1), 0, 255, 190)), 0)
    bench.world.handle(Left(0, "tcp"), 1 * MS)
    later = bench.world.handle(Wake(), 5 * S)
    assert [each for each in later if isinstance(each, Transmit)] == []


def test_two_vehicles_on_one_link_answer_each_for_itself() -> None:
    bench = Bench()
    vehicles = [FakeVehicle(), FakeVehicle()]
    servers = [
        VehicleServer(vehicle, PROFILES["px4"], bench.parameters, system)
        for system, vehicle in enumerate(vehicles, start=1)
    ]
    world = World(servers, [LinkSpec()])
    world.handle(Datagram(0, "ground", encode(long(21, target=2), 0, 255, 190)), 0)
    assert [len(vehicle.named("land")) for vehicle in vehicles] == [0, 1]
    world.handle(Datagram(0, "ground", encode(long(21, target=0), 1, 255, 190)), 0)
    assert [len(vehicle.named("land")) for vehicle in vehicles] == [1, 2]
