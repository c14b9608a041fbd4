"""MAVSDK 4 flies, lists the flight logs, downloads one and erases them all."""

from __future__ import annotations

import threading
from pathlib import Path
from typing import Any

import pytest

from tests.system.patience import PATIENT_S, until
from tests.system.vehicle_program import free_port, vehicle_sim

mavsdk = pytest.importorskip("mavsdk")
pyulog = pytest.importorskip("pyulog")

from mavsdk.plugins.action import Action  # noqa: E402
from mavsdk.plugins.log_files import LogFiles, LogFilesError, LogFilesResult  # noqa: E402
from mavsdk.plugins.telemetry import Telemetry  # noqa: E402

pytestmark = pytest.mark.system


def download(logs: Any, entry: Any, path: Path) -> None:
    """Waits for the end; fails if it is not a success."""
    ended = threading.Event()
    results: list[Any] = []

    def progress(result: Any, _progress: Any, _context: Any = None) -> None:
        results.append(result)
        if result is not LogFilesResult.NEXT:
            ended.set()

    logs.download_log_file_async(entry, str(path), progress)
    assert ended.wait(PATIENT_S), "no end of the download"
    assert results[-1] is LogFilesResult.SUCCESS


def test_mavsdk_lists_downloads_and_erases_the_logs_of_two_flights(tmp_path: Path) -> None:
    port = free_port()
    with vehicle_sim("--speedup", "8", "--link", f"udpout://127.0.0.1:{port}") as lines:
        station = mavsdk.Configuration.create_with_component_type(
            mavsdk.ComponentType.GROUND_STATION
        )
        with mavsdk.Mavsdk(station) as sdk:
            sdk.add_any_connection(f"udpin://127.0.0.1:{port}")
            system = sdk.first_autopilot(PATIENT_S)
            assert system is not None, lines
            telemetry, action, logs = Telemetry(system), Action(system), LogFiles(system)
            until(telemetry.health_all_ok, "health all ok")
            with pytest.raises(LogFilesError, match="NO_LOGFILES"):
                logs.get_entries()

            for _ in range(2):
                action.arm()
                until(telemetry.armed, "armed")
                action.takeoff()
                until(lambda: telemetry.position().relative_altitude_m > 1.5, "1.5 m up")
                action.land()
                until(lambda: not telemetry.armed(), "disarmed")

            entries = logs.get_entries()
            assert [entry.id for entry in entries] == [0, 1]
            file = tmp_path / "flight.ulg"
            download(logs, entries[1], file)
            assert file.stat().st_size == entries[1].size_bytes
            log = pyulog.ULog(str(file))
            assert not log.file_corruption
            assert min(log.get_dataset("vehicle_local_position").data["z"]) < -1.5, "it flew"

            logs.erase_all_log_files()
            with pytest.raises(LogFilesError, match="NO_LOGFILES"):
                logs.get_entries()
