"""A vehicle on its own link says the same bytes alone and in a fleet, large or small."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import cache
from math import nan

import pytest

from tests.unit.autopilot.flight import HOMES
from vehicle_sim.autopilot.autopilot import Autopilot
from vehicle_sim.autopilot.decisions import phase_ns
from vehicle_sim.autopilot.modes import Personality
from vehicle_sim.autopilot.parameters.parameters import Parameters
from vehicle_sim.engine.batch_engine import BatchEngine
from vehicle_sim.engine.scalar_engine import ScalarEngine
from vehicle_sim.engine.step import Engine, Seat, VehicleSpec
from vehicle_sim.plant.airframe import load
from vehicle_sim.services.profile import PROFILES
from vehicle_sim.services.server import VehicleServer
from vehicle_sim.simulation.world import Datagram, LinkSpec, Transmit, Wake, World
from vehicle_sim.wire import messages as m
from vehicle_sim.wire.codec import encode

pytestmark = pytest.mark.slow

MS = 1_000_000
S = 1000 * MS
SEED = 5
END_NS = 8 * S
BEAT = m.Heartbeat(0, 6, 8, 0, 4, 3)


def long(command: int, *params: float) -> m.CommandLong:
    p1, p2, p3, p4, p5, p6, p7 = (*params, *(0.0,) * (7 - len(params)))
    return m.CommandLong(p1, p2, p3, p4, p5, p6, p7, command, 0, 1, 0)


def orders(index: int, personality: Personality) -> list[tuple[int, m.Message]]:
    """Each takes off at a time of its own, is asked for other rates, and flies somewhere."""
    up_m = 3.0 + index % 5 + (HOMES["px4"].alt_amsl_m if personality == "px4" else 0.0)
    late_ns = index % 7 * 30 * MS
    mode = [long(176, 1, 4)] if personality == "ardupilot" else []
    first: list[m.Message] = [BEAT, *mode, long(400, 1), long(22, 0, 0, 0, nan, nan, nan, up_m)]
    goal = m.SetPositionTargetLocalNed(
        0, index % 9 - 4.0, 2.0, -5.0, 0, 0, 0, 0, 0, 0, 0, 0, 3576, 0, 1, 1
    )
    return [
        *((1500 * MS + late_ns + turn * MS, order) for turn, order in enumerate(first)),
        (2 * S, long(511, 32, 33_000)),
        (2500 * MS + late_ns, m.RequestDataStream(4, 0, 1, 0, 1)),
        *((6 * S + turn * 100 * MS, goal) for turn in range(10)),
        (7 * S, long(21)),
    ]


def spoken(
    personality: Personality,
    indices: Sequence[int],
    engine_of: Callable[[Sequence[VehicleSpec]], Engine],
    nap_ns: int,
) -> dict[int, bytes]:
    """By index, all that the vehicle sent on its own link."""
    home = HOMES[personality]
    engine = engine_of([VehicleSpec(SEED, index, home.lat_deg) for index in indices])
    servers = []
    for lane, index in enumerate(indices):
        parameters = Parameters(personality)
        seat = Seat(engine, lane)
        vehicle = Autopilot(personality, home, SEED, index, parameters, seat)
        system = index + 1
        servers.append(
            VehicleServer(
                vehicle, PROFILES[personality], parameters, system, phase_ns=phase_ns(index)
            )
        )
    links = [LinkSpec((("client", index),), lane) for lane, index in enumerate(indices)]
    world = World(servers, links)
    script = sorted(
        (at_ns, lane, order)
        for lane, index in enumerate(indices)
        for at_ns, order in framed_orders(index, personality)
    )
    sent = dict.fromkeys(indices, b"")

    def hear(outputs: Sequence[object]) -> None:
        for each in outputs:
            if isinstance(each, Transmit):
                sent[indices[each.link]] += each.data

    now_ns = 0
    for at_ns, lane, data in [*script, (END_NS, 0, b"")]:
        while now_ns + nap_ns < at_ns:
            now_ns += nap_ns
            hear(world.handle(Wake(), now_ns))
        now_ns = at_ns
        hear(world.handle(Datagram(lane, ("client", indices[lane]), data), at_ns))
    return sent


def framed_orders(index: int, personality: Personality) -> list[tuple[int, bytes]]:
    return [
        (at_ns, encode(order, number, 255, 190))
        for number, (at_ns, order) in enumerate(orders(index, personality))
    ]


def few(specs: Sequence[VehicleSpec]) -> Engine:
    return ScalarEngine(specs, load())


def many(specs: Sequence[VehicleSpec]) -> Engine:
    return BatchEngine(specs, load())


@cache
def fleet_of_30(personality: Personality) -> dict[int, bytes]:
    return spoken(personality, range(30), many, 20 * MS)


@pytest.mark.parametrize("personality", ["px4", "ardupilot"])
@pytest.mark.parametrize("index", [0, 7, 29])
def test_alone_it_says_what_it_says_in_a_fleet_of_30(personality: Personality, index: int) -> None:
    alone = spoken(personality, [index], few, 333 * MS)
    assert len(alone[index]) > 10_000
    assert alone[index] == fleet_of_30(personality)[index]


@pytest.mark.parametrize("engine_of", [few, many])
def test_the_size_of_the_fleet_changes_no_byte(
    engine_of: Callable[[Sequence[VehicleSpec]], Engine],
) -> None:
    whole = fleet_of_30("px4")
    assert len(set(whole.values())) == 30
    part = spoken("px4", [3, 17, 24, 28, 11], engine_of, 7 * MS)
    assert part == {index: whole[index] for index in part}


def test_streams_take_turns() -> None:
    """So that a fleet's heartbeats do not come all at once."""
    turns = {phase_ns(index) for index in range(250)}
    assert len(turns) == 50
    assert all(0 <= turn < S for turn in turns)
    assert {turn % (20 * MS) for turn in turns} == {16 * MS}
