"""MAVSDK 4's plans, files and other services, in both personalities; nothing warns on its side."""

from __future__ import annotations

from pathlib import Path

import pytest
from pyulog import ULog

from tests.clients.client_script import fly

pytestmark = pytest.mark.system

FAST = ("--speedup", "10")
MISSIONS = Path(__file__).parents[2] / "missions"
PLANS = tuple(str(MISSIONS / name) for name in ("survey.plan", "fence.plan"))
CARRIED = [
    "survey.plan mission True fence True",
    "fence.plan mission True fence True",
    "rally [0, 1, 2]",
    "unknown item UNSUPPORTED",
    "geofence [4] [(5, 'EXCLUSION')]",
    "geofence cleared SUCCESS",
]
FILES = [
    "directory SUCCESS",
    "upload SUCCESS",
    "list [('notes.txt', 10240)]",
    "identical True",
    "rename SUCCESS",
    "download plain SUCCESS True",
    "download burst SUCCESS True",
    "remove a full directory PROTOCOL_ERROR",
    "remove SUCCESS",
    "remove directory SUCCESS",
    "missing FILE_DOES_NOT_EXIST",
    "outside PROTOCOL_ERROR",
]
CAMERA = [
    "camera vehicle-sim still 4000",
    "mode SUCCESS",
    "no film True",
    "photos [(0, True), (1, True), (2, True)]",
    "storage True",
]
CALIBRATED = [
    "calibration gyro SUCCESS",
    "calibration level_horizon SUCCESS",
]
# What only sets an output is accepted, with nothing on it.
ABSENT = {
    "px4": [
        "gimbals 0",
        "actuator SUCCESS",
        "relay UNSUPPORTED",
        "vtol NO_VTOL_TRANSITION_SUPPORT",
    ],
    "ardupilot": [
        "gimbals 0",
        "actuator SUCCESS",
        "relay SUCCESS",
        "vtol UNSUPPORTED",
    ],
}


def test_px4_carries_plans_and_flies_a_mission_with_photos_a_pause_and_a_return() -> None:
    flown = fly("mavsdk", "mavsdk_mission.py", "px4", *PLANS, vehicle=FAST)
    assert flown.said == [
        *CARRIED,
        "uploaded with progress True True True",
        "downloaded 5 [5, 5, 8, 8, 8]",
        "paused",
        "finished in order True",
        "photos True True",
        "cleared 0",
    ]
    assert flown.modes() == [
        "AUTO.MISSION",
        "AUTO.LOITER",
        "AUTO.MISSION",
        "AUTO.RTL",
        "AUTO.MISSION",  # disarmed: the mode that was asked for last
        "AUTO.LOITER",
    ]
    reached = [int(line.split()[-2]) for line in flown.vehicle if line.endswith(" reached")]
    assert reached == list(range(15)), "px4 counts what is done at once too"


@pytest.mark.thorough
def test_ardupilot_carries_plans_and_flies_a_raw_mission() -> None:
    flown = fly("mavsdk", "mavsdk_mission.py", "ardupilot", *PLANS, vehicle=FAST)
    assert flown.said == [
        *CARRIED,
        "downloaded [16, 22, 16, 16, 20] [5, 5, 8]",
        "flown in order True True",
    ]
    reached = [int(line.split()[-2]) for line in flown.vehicle if line.endswith(" reached")]
    assert reached == [1, 2, 3, 4]


@pytest.mark.thorough
def test_px4_serves_parameters_files_logs_camera_and_metadata(tmp_path: Path) -> None:
    flown = fly("mavsdk", "mavsdk_services.py", "px4", str(tmp_path), vehicle=FAST)
    assert flown.said == [
        "int parameter True",
        "float parameter True",
        "wrong type WRONG_TYPE",
        "all parameters True True",
        *FILES,
        "log SUCCESS True",
        *CAMERA,
        *CALIBRATED,
        "metadata True",
        *ABSENT["px4"],
    ]
    log = ULog(str(tmp_path / "flight.log"))
    assert not log.file_corruption
    assert log.get_dataset("vehicle_local_position").data["z"].min() < -1.0, "it flew"


def test_ardupilot_serves_parameters_files_logs_and_camera(tmp_path: Path) -> None:
    flown = fly("mavsdk", "mavsdk_services.py", "ardupilot", str(tmp_path), vehicle=FAST)
    assert flown.said == [
        "int parameter True",
        "float parameter True",
        "wrong type WRONG_TYPE",
        "all parameters True True",
        *FILES,
        "log SUCCESS True",
        *CAMERA,
        *ABSENT["ardupilot"],
    ]
