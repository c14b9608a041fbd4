"""`vehicle-sim --fault FILE`, as a program: what was declared happens, at its simulated time."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest
from pymavlink import mavutil

from tests.system.patience import PATIENT_S, until
from tests.system.vehicle_program import free_port, vehicle_sim
from vehicle_sim.simulation.fault_script import parse
from vehicle_sim.testing import SimVehicle

pytestmark = pytest.mark.system

BAD_DAY = Path(__file__).parents[2] / "vehicle_sim" / "examples" / "bad_day.toml"
SPEED = 4
"""Seconds of the vehicle in which a machine may stop a script for a moment."""


def fly_on_a_bad_day(port: int, lines: list[str]) -> list[str]:
    """Takes off and stays up; the texts that it tells until 45 simulated seconds are over."""
    link = mavutil.mavlink_connection(f"udpin:127.0.0.1:{port}", source_system=255)
    try:
        link.wait_heartbeat(timeout=PATIENT_S)
        target = (link.target_system, link.target_component)
        link.mav.heartbeat_send(6, 8, 0, 0, 0)
        texts: list[str] = []
        armed = taken_off = False
        while True:
            told = link.recv_match(blocking=True, timeout=PATIENT_S)
            assert told is not None, lines
            match told.get_type():
                case "STATUSTEXT":
                    texts.append(told.text)
                case "HEARTBEAT":
                    armed = armed or bool(told.base_mode & 128)
                case "SYS_STATUS" if not armed and told.onboard_control_sensors_health & 1 << 28:
                    link.mav.command_long_send(*target, 400, 0, 1, 0, 0, 0, 0, 0, 0)
                case "ATTITUDE" if armed and not taken_off:
                    taken_off = True
                    nan = float("nan")
                    link.mav.command_long_send(*target, 22, 0, 0, 0, 0, nan, nan, nan, 498.0)
                case "ATTITUDE" if told.time_boot_ms > 45_000:
                    return texts
    finally:
        link.close()


def test_the_shipped_bad_day_happens_as_written() -> None:
    port = free_port()
    arguments = ("--speedup", str(SPEED), "--fault", str(BAD_DAY))
    with vehicle_sim(*arguments, "--link", f"udpout://127.0.0.1:{port}") as lines:
        texts = "".join(fly_on_a_bad_day(port, lines))
        said = [line for line in lines if " faults: " in line]
    expected = parse(BAD_DAY.read_text(encoding="utf-8"), "bad_day.toml")
    due = [timed for timed in expected if timed.at_ns < 45e9]
    assert len(due) <= len(said) <= len(expected)
    assert "the wind is 5.66 m/s from 135 degrees, with gusts of 1 m/s" in said[0]
    assert texts.count("Failsafe activated") > 1, "GPS was lost, then a cell"
    assert "low battery" in texts, "a cell collapsed"


def test_a_fault_file_that_is_wrong_or_not_there_ends_it_with_4(tmp_path: Path) -> None:
    import subprocess

    wrong = tmp_path / "wrong.toml"
    wrong.write_text("[[fault]]\nat_s = 1\nkind = 'bad_mood'\n")
    for path, said in ((wrong, "kind: must be one of"), (tmp_path / "no.toml", "No such file")):
        ended = subprocess.run(
            [sys.executable, "-m", "vehicle_sim", "--fault", str(path)],
            capture_output=True,
            text=True,
            timeout=PATIENT_S,
            check=False,
        )
        assert ended.returncode == 4
        assert said in ended.stderr
        assert "Traceback" not in ended.stderr


@pytest.mark.vehicle(speedup=SPEED)
def test_the_plugin_breaks_and_mends_a_flying_vehicle(vehicle: SimVehicle) -> None:
    link = mavutil.mavlink_connection(vehicle.pymavlink_url, source_system=255)
    try:
        link.mav.heartbeat_send(6, 8, 0, 0, 0)
        link.wait_heartbeat(timeout=PATIENT_S)
        vehicle.wait(lambda truth: truth.time_s > 3.0)
        link.mav.command_long_send(1, 1, 400, 0, 1, 0, 0, 0, 0, 0, 0)
        link.mav.command_long_send(1, 1, 22, 0, 0, 0, 0, 0, 0, 0, 498.0)
        vehicle.wait(lambda truth: truth.mode == "AUTO.LOITER" and -truth.pos_ned[2] > 9.0)
        vehicle.inject("gps_lost")
        vehicle.wait(lambda truth: truth.mode == "AUTO.LAND")
        vehicle.mend("gps_lost")
        vehicle.wait(lambda truth: truth.mode == "AUTO.LOITER")
        vehicle.inject("motor", motor=2)
        fallen = vehicle.wait(lambda truth: -truth.pos_ned[2] < 0.2)
        assert fallen.armed, "a PX4 does not disarm by itself after a crash"
        until(lambda: any("Motor 2 failure" in line for line in vehicle.log), "told")
    finally:
        link.close()
