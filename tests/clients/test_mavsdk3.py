"""MAVSDK's 3.x API flies both personalities; nothing warns on its side."""

from __future__ import annotations

from pathlib import Path

import pytest
from pyulog import ULog

from tests.clients.client_script import fly

pytestmark = pytest.mark.system

SERVICES = [
    "raw mission 40 True",
    "geofence 3 80",
    "parameter True",
    "all parameters True",
    "identical True",
    "downloaded True",
    "log True",
    "photo True",
    "tune SUCCESS",
]


@pytest.mark.thorough
def test_px4_flies_orbits_follows_and_finishes_a_mission(tmp_path: Path) -> None:
    flown = fly("mavsdk3", "mavsdk3_flight.py", "px4", str(tmp_path), vehicle=("--speedup", "10"))
    assert flown.said == [
        "healthy",
        "version 1 14",
        "battery True",
        "taken off",
        "went to a location",
        "orbits",
        "offboard position, velocity, attitude",
        "followed",
        "mission uploaded True",
        "mission downloaded [6, 6, 8]",
        "mission finished True",
        *SERVICES,
        "calibration True",
        "actuator SUCCESS",
    ]
    assert flown.modes() == [
        "AUTO.TAKEOFF",
        "AUTO.LOITER",
        "POSCTL.ORBIT",
        "AUTO.LOITER",
        "OFFBOARD",
        "AUTO.LOITER",
        "AUTO.FOLLOW_TARGET",
        "AUTO.LOITER",
        "AUTO.MISSION",
        "AUTO.RTL",
        "AUTO.MISSION",  # disarmed: the mode that was asked for last
        "AUTO.LOITER",
    ]
    assert ULog(str(tmp_path / "flight.log")).last_timestamp > 60_000_000


def test_ardupilot_flies_and_serves(tmp_path: Path) -> None:
    flown = fly(
        "mavsdk3", "mavsdk3_flight.py", "ardupilot", str(tmp_path), vehicle=("--speedup", "5")
    )
    assert flown.said == [
        "healthy",
        "version 4 5",
        "battery True",
        "taken off",
        "went to a location",
        "offboard position, velocity, attitude",
        *SERVICES,
        "actuator SUCCESS",
    ]
    assert flown.modes() == ["GUIDED", "LOITER", "GUIDED", "LOITER", "LAND"]
