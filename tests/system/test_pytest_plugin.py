"""The pytest plugin, as somebody else's test suite uses it."""

from __future__ import annotations

import socket
import subprocess
import sys
import textwrap
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest

from tests.system.patience import PATIENT_S, until
from tests.system.programs import LONGEST_S
from vehicle_sim.testing import Simulator, SimulatorError, SimVehicle

pytestmark = pytest.mark.system


@pytest.mark.vehicle(speedup=10, seed=7)
def test_the_fixture_is_a_running_vehicle_with_its_truth(vehicle: SimVehicle) -> None:
    assert vehicle.personality == "px4"
    assert vehicle.url.startswith("udpout://127.0.0.1:")
    assert vehicle.pymavlink_url.startswith("udpout:127.0.0.1:")
    truth = vehicle.wait(lambda t: t.time_s > 2.0)
    assert truth.landed
    assert not truth.armed
    assert truth.lat_deg == pytest.approx(47.397742)


@pytest.mark.vehicle("ardupilot", speedup=10, options=["--wind", "12,270"])
def test_faults_are_injected_and_what_is_no_fault_is_refused(vehicle: SimVehicle) -> None:
    assert vehicle.personality == "ardupilot"
    vehicle.inject("battery", cells=1)
    with pytest.raises(SimulatorError, match="motor: is missing"):
        vehicle.inject("motor")
    with pytest.raises(SimulatorError, match="kind: must be one of"):
        vehicle.inject("bad_mood")
    with pytest.raises(TimeoutError, match="at last Truth"):
        vehicle.wait(lambda t: t.armed, timeout_s=0.2)


def test_the_factory_starts_several_and_they_have_their_own_places(
    vehicles: Callable[..., tuple[SimVehicle, ...]],
) -> None:
    first, second, third = vehicles(count=3)
    assert [v.system for v in (first, second, third)] == [1, 2, 3]
    assert first.truth().lon_deg < second.truth().lon_deg
    assert first.url == second.url == third.url


def test_what_cannot_start_says_why() -> None:
    with pytest.raises(SimulatorError, match="nonsense"):
        Simulator(options=["--airframe", "nonsense"])


def test_a_suite_of_strangers_needs_nothing_but_the_package(tmp_path: Path) -> None:
    suite = tmp_path / "test_theirs.py"
    suite.write_text(
        textwrap.dedent(
            """
            from pymavlink import mavutil

            def test_it_flies(vehicle):
                link = mavutil.mavlink_connection(vehicle.pymavlink_url)
                link.mav.heartbeat_send(6, 8, 0, 0, 0)
                assert link.wait_heartbeat(timeout=60).autopilot == 12

            def test_it_fails(vehicle):
                vehicle.inject("gps_lost")
                assert False, "on purpose"
            """
        )
    )
    ended = subprocess.run(
        [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", str(suite)],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        timeout=LONGEST_S,
        check=False,
    )
    assert "1 failed, 1 passed" in ended.stdout, ended.stdout
    assert "on purpose" in ended.stdout
    _, said, at_teardown = ended.stdout.partition("Captured vehicle-sim teardown")
    assert said, "what the vehicle has said is shown with the failure"
    assert "simulated seconds" in at_teardown


def test_the_vehicle_ends_with_its_owner() -> None:
    simulator = Simulator()
    _, _, port = simulator.vehicles[0].url.rpartition(":")
    simulator.stop()
    simulator.stop()
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as again:
        again.bind(("127.0.0.1", int(port)))


@pytest.mark.vehicle(speedup=10, params={"NAV_DLL_ACT": 3})
def test_a_fault_is_mended_unless_it_does_not_last(vehicle: SimVehicle) -> None:
    vehicle.inject("motor", motor=2, health=0.5)
    vehicle.mend("motor", motor=2)
    with pytest.raises(SimulatorError, match="reboot: does not last"):
        vehicle.mend("reboot")


def test_who_asks_a_simulator_that_has_ended_is_told_so_at_once_and_again() -> None:
    simulator = Simulator(speedup=10)
    simulator.stop()
    for _ in range(2):
        with pytest.raises(SimulatorError, match=r"vehicle-sim has ended \(0\)"):
            simulator.vehicles[0].truth()


def test_many_threads_may_ask() -> None:
    simulator = Simulator(count=4, speedup=10)
    try:
        with ThreadPoolExecutor(8) as pool:
            truths = list(pool.map(lambda n: simulator.vehicles[n % 4].truth(), range(80)))
        assert [round(truth.lat_deg, 3) for truth in truths] == [47.398] * 80
    finally:
        simulator.stop()


@pytest.mark.skipif(sys.platform == "win32", reason="POSIX signals")
def test_nothing_is_left_of_a_test_run_that_is_killed(tmp_path: Path) -> None:
    program = (
        "import time; from vehicle_sim.testing import Simulator; s = Simulator();"
        "print(s.vehicles[0].url, flush=True); time.sleep(60)"
    )
    run = subprocess.Popen(
        [sys.executable, "-c", program], cwd=tmp_path, stdout=subprocess.PIPE, text=True
    )
    assert run.stdout is not None
    port = int(run.stdout.readline().rpartition(":")[2])
    run.kill()
    run.wait(PATIENT_S)
    run.stdout.close()

    def free() -> bool:
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
            try:
                probe.bind(("127.0.0.1", port))
            except OSError:
                return False
            return True

    until(free, "the vehicle has ended with its owner")
