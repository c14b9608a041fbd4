"""`vehicle-sim --count`: who is on which link, and what a fleet sends."""

from __future__ import annotations

import socket
import statistics
import subprocess
import sys
from collections import Counter
from itertools import pairwise

import pytest

from tests.system.patience import PATIENT_S
from tests.system.vehicle_program import free_port, vehicle_sim
from vehicle_sim.cli import Options, own_link, plan_of
from vehicle_sim.options import SpeedType
from vehicle_sim.wire import messages as m
from vehicle_sim.wire.split import Counters, split

POSITIONS, STEP_MS = 10, 100
"""So many of each vehicle are listened to; the steps between them in the vehicle's time."""


def options(count: int, links: tuple[str, ...] = ()) -> Options:
    return Options(
        autopilot="px4",
        firmware="1.14",
        boot="quick",
        camera="still",
        operator_control=False,
        count=count,
        airframe="s500",
        sensors="good",
        home=(47.0, 8.0, 400.0),
        seed=1,
        speedup=SpeedType().convert("1", None, None),
        links=links,
        params=(),
        param_file=None,
        wind=(0.0, 0.0, 0.0),
        fault=None,
        signing_key=None,
        files=None,
        sysid=1,
        streams="full",
        view=None,
        lifeline=True,
        control=False,
        plain=True,
        verbose=False,
    )


def test_no_vehicle_has_the_ground_stations_port_for_its_own() -> None:
    ports = [own_link("px4", index).rpartition(":")[2] for index in range(12)]
    assert ports[:3] == ["14540", "14541", "14542"]
    assert "14550" not in ports
    assert len(set(ports)) == 12


def test_250_vehicles_share_the_stations_link_and_more_have_links_of_their_own_only() -> None:
    assert [str(url) for url in plan_of(options(250)).shared] == ["udpout://127.0.0.1:14550"]
    many = plan_of(options(600))
    assert many.shared == ()
    assert len({url for vehicle in many.vehicles for url in vehicle.urls}) == 600
    assert [vehicle.system for vehicle in many.vehicles[248:252]] == [249, 250, 1, 2]


def test_more_than_250_on_one_link_are_refused() -> None:
    done = subprocess.run(
        [sys.executable, "-m", "vehicle_sim", "--count", "251", "--port", "0"],
        capture_output=True,
        text=True,
        check=False,
        timeout=PATIENT_S,
    )
    assert done.returncode == 2
    assert "MAVLink has system ids for 250" in done.stderr


@pytest.mark.parametrize("count", [3, 40])
def test_a_fleet_that_streams_positions_sends_nothing_else(count: int) -> None:
    port = free_port()
    heard: Counter[tuple[int, str]] = Counter()
    boot_ms: dict[int, list[int]] = {}
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as ear:
        ear.bind(("127.0.0.1", port))
        ear.settimeout(PATIENT_S)
        words = ("--count", str(count), "--streams", "position")
        with vehicle_sim(*words, "--link", f"udpout://127.0.0.1:{port}"):
            while len(boot_ms) < count or min(map(len, boot_ms.values())) < POSITIONS:
                for frame in split(ear.recv(65536), Counters()):
                    message = frame.message()
                    heard[frame.system, type(message).__name__] += 1
                    if isinstance(message, m.LocalPositionNed):
                        boot_ms.setdefault(frame.system, []).append(message.time_boot_ms)
    streamed = {"Heartbeat", "SysStatus", "LocalPositionNed", "GlobalPositionInt"}
    greeting = {"GpsGlobalOrigin", "HomePosition", "Statustext"}
    assert {name for _, name in heard} <= streamed | greeting
    assert sorted(boot_ms) == list(range(1, count + 1))
    for steps_ms in ([b - a for a, b in pairwise(times_ms)] for times_ms in boot_ms.values()):
        assert statistics.median(steps_ms) == STEP_MS
