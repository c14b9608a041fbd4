"""pymavlink's own helpers against the vehicle: what most scripts are made of."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.clients.mavutil_client import complaints, in_order, run_script, vehicle

pytestmark = pytest.mark.system

PATIENT = {
    "px4": ("--param", "COM_OF_LOSS_T=60", "--param", "COM_RC_LOSS_T=35"),
    "ardupilot": (),
}
"""A script that the machine stops for a second is still there."""
MODES = {
    "px4": "ALTCTL, POSCTL, STABILIZED, MANUAL, ACRO, FOLLOWME, LOITER",
    "ardupilot": "STABILIZE, ACRO, ALT_HOLD, LOITER, POSHOLD, BRAKE, CIRCLE, FOLLOW, GUIDED",
}


@pytest.mark.parametrize("autopilot", ["px4", "ardupilot"])
def test_mavutil_flies_a_mission_and_every_mode(autopilot: str, tmp_path: Path) -> None:
    with vehicle(autopilot, "--speedup", "20", *PATIENT[autopilot]) as (url, said):
        lines = run_script("pymavlink", "pymavlink_flight.py", autopilot, url, folder=tmp_path)
    in_order(
        lines,
        "heartbeat of system 1",
        "at home",
        "mission of 4 items up and down",
        "^armed",
        "10 m up",
        "10 m west by COMMAND_INT",
        "at the setpoint in (OFFBOARD|GUIDED)",
        "mission item 1 reached",
        "mission item 3 reached",
        f"flew in {MODES[autopilot]}",
        "5 m up by the sticks, and stays",
        "disarmed [01] m from home",
        "log 0: a ULog" if autopilot == "px4" else "log 1: .* m was the highest",
    )
    in_order(said, "mission of 4 items received", "armed", "mission item 3 reached", "disarmed")


@pytest.mark.parametrize("autopilot", ["px4", "ardupilot"])
def test_mavparm_mavwp_mavftp_and_signing(autopilot: str, tmp_path: Path) -> None:
    with vehicle(autopilot) as (url, said):
        lines = run_script("pymavlink", "pymavlink_services.py", autopilot, url, folder=tmp_path)
    name, value = ("MPC_XY_CRUISE", "2.5") if autopilot == "px4" else ("WPNAV_SPEED", "500")
    packed = [r"param.pck: \d+ parameters, changed: \['WPNAV_SPEED,500'\]"]
    in_order(
        lines,
        rf"\d+ parameters, {name} = ",
        f"changed {name}",
        f"set, saved, loaded: {name} = {value}",
        "fence of 4 vertices up and down",
        "1 rally point up and down",
        "fence and rally points cleared",
        "10240 bytes up, listed, checked, renamed, down, removed",
        *(packed if autopilot == "ardupilot" else []),
        "TIMESYNC and PING answered",
        "no parachute",
        "signed both ways",
        "an unsigned command is not heard",
    )
    in_order(said, f"parameter {name} = {value}", "fence of 4 items", "signing is on", "unsigned")


@pytest.mark.parametrize("autopilot", ["px4", "ardupilot"])
def test_mavlink_1_is_answered_in_mavlink_1(autopilot: str, tmp_path: Path) -> None:
    with vehicle(autopilot, waits=True) as (url, said):
        lines = run_script("pymavlink", "pymavlink_mavlink1.py", autopilot, url, folder=tmp_path)
    channels = ["channels 1500 1500 1000"] if autopilot == "ardupilot" else []
    in_order(lines, "MAVLink 1 with system 1", "a mission of float items", *channels, "armed")
    assert complaints(said) == []
