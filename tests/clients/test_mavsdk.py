"""MAVSDK 4 flies both personalities; nothing warns on its side."""

from __future__ import annotations

import time

import pytest

from tests.clients.client_script import TIMEOUT_S, end, fly, start
from tests.clients.mavutil_client import complaints
from tests.system.machine import KeptWaiting
from tests.system.vehicle_program import free_port, vehicle_sim

pytestmark = pytest.mark.system

FAST = ("--speedup", "10")


def test_px4_flies_to_places_on_an_orbit_and_by_every_kind_of_offboard_setpoint() -> None:
    flown = fly("mavsdk", "mavsdk_flight.py", "px4", vehicle=FAST)
    assert flown.said == [
        "healthy True",
        "version 1 14 3",
        "legacy uid True",
        "faster than real time",
        "origin 47.3977 8.5456",
        "home 47.3977 8.5456",
        "streams",
        "take-off altitude 4.0",
        "taken off True",
        "went to a location",
        "at the speed that was set True",
        "holds",
        "orbits",
        "offboard without a setpoint NO_SETPOINT_SET",
        "offboard position",
        "offboard global position",
        "offboard velocity",
        "offboard body velocity",
        "offboard position and velocity",
        "offboard acceleration",
        "offboard attitude",
        "offboard rates",
        "offboard stopped",
        "landed and disarmed",
    ]
    assert flown.modes() == [
        "AUTO.TAKEOFF",
        "AUTO.LOITER",
        "POSCTL.ORBIT",
        "AUTO.LOITER",
        "OFFBOARD",
        "AUTO.LOITER",
        "AUTO.RTL",
        "AUTO.LAND",
        "AUTO.LOITER",
    ]


@pytest.mark.thorough
def test_ardupilot_flies_to_places_and_by_every_kind_of_offboard_setpoint() -> None:
    flown = fly("mavsdk", "mavsdk_flight.py", "ardupilot", vehicle=FAST)
    assert "version 4 5 7" in flown.said
    assert "home -35.3633 149.1652" in flown.said
    assert "orbit UNSUPPORTED" in flown.said
    assert flown.said[-11:] == [
        "offboard without a setpoint NO_SETPOINT_SET",
        "offboard position",
        "offboard global position",
        "offboard velocity",
        "offboard body velocity",
        "offboard position and velocity",
        "offboard acceleration",
        "offboard attitude",
        "offboard rates",
        "offboard stopped",
        "landed and disarmed",
    ]
    assert flown.modes() == ["GUIDED", "BRAKE", "GUIDED", "BRAKE", "RTL", "LAND"]


@pytest.mark.thorough
def test_px4_follows_fails_breaches_a_fence_reboots_and_falls_as_it_is_told() -> None:
    flown = fly("mavsdk", "mavsdk_faults.py", "px4", vehicle=FAST)
    assert flown.said == [
        "followed",
        "breached the fence, and holds True",
        "failed and mended",
        "no sticks yet INPUT_NOT_SET",
        "position by stick",
        "altitude by stick",
        "rebooted",
        "fell after kill",
        "fell after terminate",
    ]
    assert [m for m in flown.modes() if not m.startswith("AUTO.T")][:5] == [
        "AUTO.LOITER",
        "AUTO.FOLLOW_TARGET",
        "AUTO.LOITER",
        "OFFBOARD",
        "AUTO.LOITER",
    ]
    fixes = [line for line in flown.vehicle if line.endswith("vehicle1: GPS fix")]
    assert len(fixes) == 3, "it booted three times"
    assert any("Geofence violation" in line for line in flown.vehicle)
    assert any("Preflight Fail: Flight termination active" in line for line in flown.vehicle)


def test_mavsdk_finds_a_vehicle_that_starts_later_loses_it_and_finds_the_next_one() -> None:
    port = free_port()
    link = ("--link", f"udpout://127.0.0.1:{port}")
    client = start("mavsdk", "mavsdk_start.py", f"udpin://127.0.0.1:{port}", "again")
    assert client.stdout is not None
    try:
        said = [client.stdout.readline().split()[0]]
        started_ns = time.time_ns()
        with vehicle_sim(*link) as lines:
            kept = KeptWaiting(lines.pid, client.pid)
            times = [client.stdout.readline().split() for _ in range(2)]
            kept_waiting_s = kept.seconds
        said += [event for event, _ in times]
        assert said == ["waiting", "heard", "armable"]
        armable_s = (int(times[1][1]) - started_ns) * 1e-9
        assert armable_s < 5.0 + kept_waiting_s, "about 1 s on an idle machine"
        said.append(client.stdout.readline().split()[0])
        with vehicle_sim(*link):
            rest, _ = client.communicate(timeout=TIMEOUT_S)
        said += [line.split()[0] for line in rest.splitlines()]
    finally:
        end(client)
    assert said == ["waiting", "heard", "armable", "lost", "back", "healthy"]
    assert client.returncode == 0


@pytest.mark.parametrize("personality", ["px4", "ardupilot"])
def test_ten_times_faster_is_ten_times_faster_with_mavsdk_flying(personality: str) -> None:
    """The vehicle's time stamps against the wall, less what the machine kept it waiting; it fails
    nothing by being fast."""
    flown = fly("mavsdk", "mavsdk_speedup.py", personality, "10", "1.5", vehicle=FAST)
    measured = dict(line.removesuffix(" s").rsplit(" ", 1) for line in flown.said)
    wall_s, factor = float(measured["wall"]), float(measured["factor"])
    assert factor * wall_s > 9.5 * (wall_s - flown.kept_waiting_s)
    assert factor * wall_s < 10.5 * (wall_s + flown.kept_waiting_s)
    assert measured["link lost"] == "0"
    assert complaints(flown.vehicle) == []
