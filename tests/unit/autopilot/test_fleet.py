"""Fleets: one vehicle or many, in plain floats or in rows, the flights are the same bytes."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Sequence
from math import nan

import pytest

from tests.unit.autopilot.flight import HOMES
from vehicle_sim.autopilot.autopilot import Autopilot
from vehicle_sim.autopilot.modes import Personality
from vehicle_sim.autopilot.parameters.parameters import Parameters
from vehicle_sim.engine.batch_engine import BatchEngine
from vehicle_sim.engine.choose_engine import BATCH_FROM, engine_for
from vehicle_sim.engine.scalar_engine import ScalarEngine
from vehicle_sim.engine.step import Engine, Seat, VehicleSpec, state_bytes
from vehicle_sim.plant.airframe import load
from vehicle_sim.services.profile import PROFILES
from vehicle_sim.services.server import VehicleServer
from vehicle_sim.simulation.world import Datagram, LinkSpec, Transmit, Wake, World
from vehicle_sim.wire import messages as m
from vehicle_sim.wire.codec import encode

MS = 1_000_000
S = 1000 * MS


def personality(index: int) -> Personality:
    return "ardupilot" if index % 3 == 2 else "px4"


def specs(count: int) -> list[VehicleSpec]:
    return [VehicleSpec(7 + i // 4, i, HOMES[personality(i)].lat_deg) for i in range(count)]


def vehicle(engine: Engine, count: int) -> list[Autopilot]:
    vehicles = []
    for lane, spec in enumerate(specs(count)):
        kind = personality(lane)
        parameters = Parameters(kind)
        seat = Seat(engine, lane)
        vehicles.append(Autopilot(kind, HOMES[kind], spec.seed, spec.index, parameters, seat))
    return vehicles


def long(system: int, command: int, *params: float) -> m.CommandLong:
    p1, p2, p3, p4, p5, p6, p7 = (*params, *(0.0,) * (7 - len(params)))
    return m.CommandLong(p1, p2, p3, p4, p5, p6, p7, command, system, 1, 0)


def orders(system: int) -> list[tuple[int, m.Message]]:
    """A flight of its own for each: another height, then a place, a velocity or a landing."""
    index = system - 1
    up_m = 3.0 + index % 5
    late_ns = (index % 7) * 30 * MS
    script: list[tuple[int, m.Message]] = []
    if personality(index) == "ardupilot":
        script.append((1400 * MS, long(system, 176, 1, 4)))
    script += [
        (1500 * MS + late_ns, long(system, 400, 1)),
        (1600 * MS + late_ns, long(system, 22, 0, 0, 0, nan, nan, nan, up_m)),
    ]
    goal = (4.0 - index % 9, index % 6 - 2.0, -up_m)
    for tick in range(40):
        at_ns = 5 * S + tick * 50 * MS + late_ns
        if index % 4 == 3:
            velocity = m.SetPositionTargetLocalNed(
                0, 0, 0, 0, 1.0, 0.5, -0.2, 0, 0, 0, 0, 0.3, 0b0101_1100_0111, system, 1, 1
            )
            script.append((at_ns, velocity))
        else:
            place = m.SetPositionTargetLocalNed(
                0, *goal, 0, 0, 0, 0, 0, 0, 0, 0, 3576, system, 1, 1
            )
            script.append((at_ns, place))
    if personality(index) == "px4":
        script.append((6200 * MS + late_ns, long(system, 176, 1, 6)))
    if index % 5 == 4:
        script.append((7500 * MS, long(system, 21)))
    return script


def trouble(vehicles: Sequence[Autopilot]) -> None:
    """Wind for one, a dead motor for the next, then no satellites, then a wrong barometer."""
    for index, vehicle in enumerate(vehicles):
        blocks = vehicle.blocks
        match index % 8:
            case 1:
                blocks.body.wind_e, blocks.body.gust_m_s = 6.0, 1.0
            case 2:
                blocks.body.health_3 = 0.0
            case 3:
                blocks.sensed.gps_lost = True
            case 4:
                blocks.sensed.baro_off_m = 3.0
            case 5:
                blocks.body.payload_kg, blocks.body.mass_off_x = 0.5, 0.02
            case 6:
                blocks.body.thrust_scale, blocks.body.inertia_scale = 0.7, 0.5
                blocks.body.health_2 = 0.8
            case _:
                pass


def fly(engine: Engine, count: int, nap_ns: int, end_ns: int) -> tuple[list[bytes], bytes]:
    """All states at the end, and all that was sent."""
    vehicles = vehicle(engine, count)
    servers = [
        VehicleServer(vehicle, PROFILES[vehicle.personality], vehicle.parameters, system)
        for system, vehicle in enumerate(vehicles, start=1)
    ]
    world = World(servers, [LinkSpec()])
    script = [
        (at_ns, message) for system in range(1, count + 1) for at_ns, message in orders(system)
    ]
    script.append((100 * MS, m.Heartbeat(0, 6, 8, 0, 4, 3)))
    script.sort(key=lambda each: each[0])
    sent: list[bytes] = []
    now_ns, hurt = 0, False

    def hear(outputs: Sequence[object]) -> None:
        sent.extend(each.data for each in outputs if isinstance(each, Transmit))

    for number, (at_ns, message) in enumerate([*script, (end_ns, m.Heartbeat(0, 6, 8, 0, 4, 3))]):
        while now_ns + nap_ns < at_ns:
            now_ns += nap_ns
            hear(world.handle(Wake(), now_ns))
        now_ns = at_ns
        data = encode(message, number & 0xFF, 255, 190)
        hear(world.handle(Datagram(0, "ground", data), at_ns))
        if at_ns >= 7 * S and not hurt:
            hurt = True
            trouble(vehicles)
    return [vehicle.state_bytes() for vehicle in vehicles], b"".join(sent)


@pytest.mark.parametrize(
    ("count", "end_ns"),
    [
        (1, 12 * S),
        pytest.param(8, 12 * S, marks=pytest.mark.thorough),
        pytest.param(40, 9 * S, marks=pytest.mark.soak),
    ],
)
def test_few_and_many_fly_and_say_the_same_bytes(count: int, end_ns: int) -> None:
    few, said_few = fly(ScalarEngine(specs(count), load()), count, 20 * MS, end_ns)
    many, said_many = fly(BatchEngine(specs(count), load()), count, 333 * MS, end_ns)
    assert len(said_few) > 20_000
    assert few == many
    assert said_few == said_many
    assert len(set(few)) == count


def test_a_vehicle_flies_in_a_fleet_as_it_flies_alone() -> None:
    """The others are not there for it; only when it decides is shifted by its turn."""
    alone = ScalarEngine(specs(1), load())
    fleet = BatchEngine(specs(30), load())
    for _ in range(1500):
        alone.step()
        fleet.step()
    assert state_bytes(alone.blocks(0)) == state_bytes(fleet.blocks(0))


def test_the_engine_is_chosen_by_the_size_of_the_fleet() -> None:
    assert isinstance(engine_for(specs(1), load()), ScalarEngine)
    assert isinstance(engine_for(specs(BATCH_FROM), load()), BatchEngine)


def test_one_vehicle_needs_no_numpy() -> None:
    program = (
        "import sys, vehicle_sim.cli;"
        "from vehicle_sim.autopilot.autopilot import Autopilot;"
        "from vehicle_sim.autopilot.interface import Geodetic;"
        "Autopilot('px4', Geodetic(47.0, 8.0, 400.0), 1).step();"
        "sys.exit('numpy' in sys.modules)"
    )
    assert subprocess.run([sys.executable, "-c", program], check=False).returncode == 0
