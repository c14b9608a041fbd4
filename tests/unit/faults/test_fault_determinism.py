"""Equal seeds and equal fault files: equal bytes, however the time is cut, in every engine."""

from __future__ import annotations

from collections.abc import Sequence
from math import nan

import pytest

from tests.unit.faults.stage import BEAT, HOMES, MS, S, Stage, aloft
from vehicle_sim.autopilot.autopilot import Autopilot
from vehicle_sim.autopilot.modes import Personality
from vehicle_sim.autopilot.parameters.parameters import Parameters
from vehicle_sim.engine.batch_engine import BatchEngine
from vehicle_sim.engine.scalar_engine import ScalarEngine
from vehicle_sim.engine.step import Engine, Seat, VehicleSpec
from vehicle_sim.plant.airframe import load
from vehicle_sim.services.profile import PROFILES
from vehicle_sim.services.server import VehicleServer
from vehicle_sim.simulation.fault_script import parse
from vehicle_sim.simulation.world import Datagram, LinkSpec, Log, Transmit, Wake, World
from vehicle_sim.wire import messages as m
from vehicle_sim.wire.codec import encode

END_NS = 16 * S

# Every kind once, some at odd times, some on top of each other, links too.
EVERYTHING = """
fault = [
  { at_s = 4.0, kind = "wind", wind_ned_m_s = [3, -4, 0], gust_m_s = 1.5 },
  { at_s = 5.003, for_s = 2.5, kind = "gps_lost", vehicle = 1 },
  { at_s = 6.1, for_s = 2.0, kind = "gps_glitch", offset_ned_m = [20, 5, 0], vehicle = 2 },
  { at_s = 6.5, for_s = 1.0, kind = "motor", motor = 3, health = 0.6 },
  { at_s = 7.0, kind = "battery", cells = 0.4, vehicle = 1 },
  { at_s = 7.3, for_s = 2.0, kind = "accel_bias", offset_m_s2 = [0.4, -0.3, 0.2] },
  { at_s = 7.4, for_s = 2.0, kind = "gyro_bias", offset_rad_s = [0.02, 0, -0.03] },
  { at_s = 8.0, for_s = 3.0, kind = "baro", offset_m = 2.0 },
  { at_s = 8.2, for_s = 3.0, kind = "mag", lost = true },
  { at_s = 8.5, for_s = 2.0, kind = "rc_lost" },
  { at_s = 9.0, for_s = 1.0, kind = "clock_jump", by_s = 3.0, vehicle = 2 },
  { at_s = 13.0, kind = "reboot", vehicle = 1 },
  { at_s = 3.0, for_s = 4.0, kind = "link", loss = 0.1, duplicate = 0.1, delay_s = 0.05 },
  { at_s = 8.0, for_s = 3.0, kind = "link", reorder = 0.2, direction = "in" },
  { at_s = 11.0, for_s = 0.3, kind = "link", jitter_s = 0.1 },
  { at_s = 11.5, for_s = 0.8, kind = "link", out = true },
]
"""


def personality(index: int) -> Personality:
    return "ardupilot" if index % 2 else "px4"


def script(count: int) -> list[tuple[int, bytes]]:
    """Every vehicle arms and takes off; a heartbeat each second."""
    said: list[tuple[int, m.Message]] = [(second * S, BEAT) for second in range(16)]
    for index in range(count):
        system = index + 1
        if personality(index) == "ardupilot":
            said.append((1400 * MS, long(system, 176, 1, 4)))
        said.append((1500 * MS, long(system, 400, 1)))
        said.append((1700 * MS, long(system, 22, 0, 0, 0, nan, nan, nan, 6.0)))
    said.sort(key=lambda each: each[0])
    return [
        (at_ns, encode(message, number & 0xFF, 255, 190))
        for number, (at_ns, message) in enumerate(said)
    ]


def long(system: int, command: int, *params: float) -> m.CommandLong:
    p1, p2, p3, p4, p5, p6, p7 = (*params, *(0.0,) * (7 - len(params)))
    return m.CommandLong(p1, p2, p3, p4, p5, p6, p7, command, system, 1, 0)


def fly(engine: Engine, count: int, nap_ns: int, seed: int = 3) -> tuple[list[bytes], list[bytes]]:
    """All that was sent and logged, and all states at the end."""
    servers, vehicles = [], []
    for lane in range(count):
        kind = personality(lane)
        parameters = Parameters(kind)
        vehicle = Autopilot(kind, HOMES[kind], seed, lane, parameters, Seat(engine, lane))
        vehicles.append(vehicle)
        servers.append(VehicleServer(vehicle, PROFILES[kind], parameters, lane + 1))
    world = World(servers, [LinkSpec(("ground",))], seed=seed, faults=parse(EVERYTHING, "all.toml"))
    said: list[bytes] = []

    def hear(outputs: Sequence[Transmit | Log]) -> None:
        said.extend(
            each.data if isinstance(each, Transmit) else each.text.encode() for each in outputs
        )

    now_ns = 0
    for at_ns, data in [*script(count), (END_NS, None)]:
        while now_ns + nap_ns < at_ns:
            now_ns += nap_ns
            hear(world.handle(Wake(), now_ns))
        now_ns = at_ns
        hear(world.handle(Wake() if data is None else Datagram(0, "ground", data), now_ns))
    return said, [vehicle.state_bytes() for vehicle in vehicles]


def specs(count: int, seed: int = 3) -> list[VehicleSpec]:
    return [VehicleSpec(seed, i, HOMES[personality(i)].lat_deg) for i in range(count)]


def test_batches_do_not_matter() -> None:
    once = fly(ScalarEngine(specs(2), load()), 2, 20 * MS)
    assert len(b"".join(once[0])) > 100_000
    assert fly(ScalarEngine(specs(2), load()), 2, 20 * MS) == once
    assert fly(ScalarEngine(specs(2), load()), 2, 3 * MS) == once
    assert fly(ScalarEngine(specs(2), load()), 2, 700 * MS) == once


@pytest.mark.thorough
def test_many_fail_as_few_do() -> None:
    few = fly(ScalarEngine(specs(4), load()), 4, 20 * MS)
    assert fly(BatchEngine(specs(4), load()), 4, 700 * MS) == few


def test_another_seed_is_another_flight() -> None:
    said, states = fly(ScalarEngine(specs(2), load()), 2, 700 * MS)
    other_said, other_states = fly(ScalarEngine(specs(2, 4), load()), 2, 700 * MS, seed=4)
    assert said != other_said
    assert set(states).isdisjoint(other_states)


def test_a_copy_of_a_hover_suffers_as_a_vehicle_that_flew_there() -> None:
    """What `aloft` rests on: the same bytes and logs, and no copy is seen by the next one."""
    faults = """
    fault = [
      { at_s = 20.0, for_s = 2.0, kind = "gps_glitch", offset_ned_m = [20, 5, 0] },
      { at_s = 20.5, kind = "wind", wind_ned_m_s = [3, -4, 0], gust_m_s = 1.5 },
      { at_s = 21.0, for_s = 3.0, kind = "link", loss = 0.1, duplicate = 0.1, delay_s = 0.05 },
      { at_s = 24.0, kind = "motor", motor = 3, health = 0.0 },
    ]
    """
    flown = Stage("px4", faults).take_off(10.0)
    before = len(flown.heard)
    flown.run(6.0)
    assert len(flown.heard) > before + 1000
    for _ in range(2):
        copy = aloft("px4", faults)
        copy.run(6.0)
        assert copy.vehicle.state_bytes() == flown.vehicle.state_bytes()
        assert (copy.heard, copy.logs) == (flown.heard, flown.logs)
