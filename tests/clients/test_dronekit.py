"""DroneKit 2.9.2 flies by its own API and logs no warning."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.clients.mavutil_client import complaints, in_order, run_script, vehicle

pytestmark = pytest.mark.system


def test_an_arducopter_flies_as_in_the_examples(tmp_path: Path) -> None:
    with vehicle("ardupilot", "--speedup", "4") as (url, said):
        lines = run_script("dronekit", "dronekit_flight.py", "ardupilot", url, folder=tmp_path)
    in_order(
        lines,
        r"connected: \d+ parameters",
        "version APM:Copter-4.5.7, stable True",
        "attributes, home at 584 m",
        "WPNAV_SPEED set and heard",
        "mission of 4 commands up and down",
        "armed in GUIDED",
        "took off to 10 m",
        "went there at 4 m/s",
        "climbed by a channel override",
        "mission to item 4",
        "landed in RTL",
        "listeners: location, attitude, mode, armed, SYS_STATUS",
    )
    in_order(said, "mission of 5 items", "mode GUIDED", "armed$", "mode AUTO", "item 3 reached")
    assert complaints(said) == []


def test_the_same_over_mavlink_1(tmp_path: Path) -> None:
    with vehicle("ardupilot", "--speedup", "4", waits=True) as (url, _):
        lines = run_script("dronekit", "dronekit_flight.py", "ardupilot", url, folder=tmp_path)
    in_order(
        lines,
        "version APM:Copter-4.5.7",
        "mission of 4 commands up and down",
        "went there at 4 m/s",
        "channels are told",
        "mission to item 4",
        "landed in RTL",
    )


def test_a_px4_flies_as_far_as_dronekit_knows_it(tmp_path: Path) -> None:
    with vehicle("px4", "--speedup", "4") as (url, said):
        lines = run_script("dronekit", "dronekit_flight.py", "px4", url, folder=tmp_path)
    in_order(
        lines,
        "version PX4Copter-1.14.3, stable True",
        "attributes, home at 488 m",
        "MPC_XY_CRUISE set and heard",
        "^armed",
        r"took off to [12]\.\d m",
        "landed in POSCTL",  # disarmed: the mode that was asked for before the landing
    )
    in_order(said, "armed$", "mode AUTO.TAKEOFF", "mode POSCTL", "mode AUTO.LAND", "disarmed$")
    assert complaints(said) == []
