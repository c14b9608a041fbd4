"""The log of a real flight says what the telemetry of the same moment said."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from tests.unit.vehicle_logbook.flights import MS, START_S, S, read_dataflash, read_ulog
from tests.unit.vehicle_services.fake_vehicle import HOME, long
from vehicle_sim.autopilot.autopilot import Autopilot
from vehicle_sim.autopilot.modes import Personality
from vehicle_sim.services.profile import PROFILES
from vehicle_sim.services.server import VehicleServer
from vehicle_sim.simulation.world import Datagram, LinkSpec, Transmit, Wake, World
from vehicle_sim.storage.store import MemoryStore
from vehicle_sim.wire import messages as m
from vehicle_sim.wire.codec import encode
from vehicle_sim.wire.split import Counters, split

NAN = float("nan")
SCRIPTS: dict[Personality, list[tuple[int, m.Message]]] = {
    "px4": [
        (3 * S, long(400, 1)),
        (3100 * MS, long(22, 0, 0, 0, NAN, NAN, NAN, NAN)),
        (12 * S, long(21)),
    ],
    "ardupilot": [
        (3 * S, m.RequestDataStream(20, 1, 1, 6, 1)),
        (4 * S, m.SetMode(4, 1, 1)),
        (4100 * MS, long(400, 1)),
        (4200 * MS, long(22, 0, 0, 0, 0, 0, 0, 3)),
        (12 * S, long(21)),
    ],
}


def fly(personality: Personality, nap_ns: int = 1 * S) -> tuple[bytes, list[m.LocalPositionNed]]:
    """The log, and every LOCAL_POSITION_NED."""
    vehicle = Autopilot(personality, HOME, 1)
    store = MemoryStore()
    server = VehicleServer(
        vehicle,
        PROFILES[personality],
        vehicle.parameters,
        1,
        unix_start_ns=START_S * S,
        store=store,
    )
    world = World([server], [LinkSpec()])
    inputs: list[tuple[int, Datagram | Wake]] = [
        (at_ns, Datagram(0, "ground", encode(message, 0, 255, 190)))
        for at_ns, message in [(100 * MS, m.Heartbeat(0, 6, 8, 0, 4, 3)), *SCRIPTS[personality]]
    ]
    inputs += [(at_ns, Wake()) for at_ns in range(nap_ns, 30 * S, nap_ns)]
    heard: list[m.LocalPositionNed] = []
    for at_ns, given in sorted(inputs, key=lambda each: each[0]):
        for output in world.handle(given, at_ns):
            if isinstance(output, Transmit):
                told = [frame.message() for frame in split(output.data, Counters())]
                heard += [each for each in told if isinstance(each, m.LocalPositionNed)]
    assert not vehicle.armed
    root = "/fs/microsd/log/2024-05-01" if personality == "px4" else "/APM/LOGS"
    (name,) = [each.name for each in store.entries(root) if not each.name.endswith("TXT")]
    return store.read(f"{root}/{name}", 0, 1 << 30), heard


def test_px4(tmp_path: Path) -> None:
    pytest.importorskip("pyulog")
    log, heard = fly("px4")
    local: dict[str, Any] = read_ulog(log).get_dataset("vehicle_local_position").data
    told = {each.time_boot_ms * 1000: each[1:] for each in heard}
    names = ("x", "y", "z", "vx", "vy", "vz")
    compared = [
        (tuple(float(local[name][row]) for name in names), told[int(time_us)])
        for row, time_us in enumerate(local["timestamp"])
        if int(time_us) in told
    ]
    assert len(compared) > 100
    assert all(logged == sent for logged, sent in compared)
    # MIS_TAKEOFF_ALT 2.5 m; the climb may end NAV_MC_ALT_RAD = 0.8 m below it.
    assert min(logged[2] for logged, _ in compared) < -1.7, "it flew"


def test_ardupilot(tmp_path: Path) -> None:
    log, heard = fly("ardupilot")
    _, records = read_dataflash(log, tmp_path)
    told = {each.time_boot_ms * 1000: each[1:] for each in heard}
    compared = [
        ((ekf.PN, ekf.PE, ekf.PD, ekf.VN, ekf.VE, ekf.VD), told[ekf.TimeUS])
        for ekf in records
        if ekf.get_type() == "XKF1" and ekf.TimeUS in told
    ]
    assert len(compared) > 50
    assert all(logged == sent for logged, sent in compared)
    assert min(logged[2] for logged, _ in compared) < -2.0, "it flew"


@pytest.mark.slow
@pytest.mark.parametrize("personality", ["px4", "ardupilot"])
def test_the_bytes_do_not_depend_on_how_often_the_world_is_woken(
    personality: Personality,
) -> None:
    assert fly(personality, 1 * S)[0] == fly(personality, 37 * MS)[0]
