"""MAVSDK 4's services on the ground: parameters, files, logs, camera, metadata, refusals.

Run: python mavsdk_services.py udpin://127.0.0.1:14540 px4 SCRATCH_FOLDER
"""

from __future__ import annotations

import json
import sys
import time
from collections.abc import Callable
from pathlib import Path
from threading import Event

from mavsdk.plugins.action import Action
from mavsdk.plugins.calibration import Calibration, CalibrationResult
from mavsdk.plugins.camera import Camera, Mode
from mavsdk.plugins.component_metadata import ComponentMetadata, MetadataType
from mavsdk.plugins.ftp import Ftp, FtpResult
from mavsdk.plugins.gimbal import Gimbal
from mavsdk.plugins.log_files import LogFiles, LogFilesResult
from mavsdk.plugins.param import Param
from mavsdk.plugins.telemetry import LandedState, Telemetry
from mavsdk_station import PATIENT_S, Station, ask_for_streams, refusal, told_twice, until

SESSION_ENDS_S = 1.0
INT_PARAM = {"px4": "COM_RC_IN_MODE", "ardupilot": "FENCE_ENABLE"}
FLOAT_PARAM = {"px4": "MPC_XY_CRUISE", "ardupilot": "LOIT_SPEED"}


def parameters(station: Station, personality: str) -> None:
    param = Param(station.system)
    whole, real = INT_PARAM[personality], FLOAT_PARAM[personality]
    before = param.get_param_int(whole)
    told_twice(param.set_param_int, whole, 1 - min(before, 1))
    print("int parameter", param.get_param_int(whole) == 1 - min(before, 1))
    told_twice(param.set_param_int, whole, before)
    before_m_s = param.get_param_float(real)
    told_twice(param.set_param_float, real, before_m_s / 2.0)
    print("float parameter", param.get_param_float(real) == before_m_s / 2.0)
    told_twice(param.set_param_float, real, before_m_s)
    print("wrong type", refusal(param.get_param_float, whole))
    known = param.get_all_params()
    print("all parameters", len(known.int_params) >= 10, len(known.float_params) >= 30)


def carried(start: Callable[..., object], *paths: str) -> str:
    """A transfer's result."""
    ended = Event()
    results: list[FtpResult] = []

    def heard(result: FtpResult, _progress: object, _data: object) -> None:
        if result is not FtpResult.NEXT:
            results.append(result)
            ended.set()

    start(*paths, heard)
    assert ended.wait(PATIENT_S), f"{paths} is carried for ever"
    return results[0].name


def refused(call: Callable[..., object], path: str) -> str:
    """After a list or a refusal MAVSDK ends the session, and its next request must not overlap."""
    result = refusal(call, path)
    time.sleep(SESSION_ENDS_S)
    return result


def files(station: Station, scratch: Path) -> None:
    ftp = Ftp(station.system)
    here = scratch / "notes.txt"
    here.write_bytes(bytes(range(256)) * 40)
    print("directory", refusal(ftp.create_directory, "/box"))
    print("upload", carried(ftp.upload_async, str(here), "/box"))
    print("list", [(each.name, each.size_bytes) for each in ftp.list_directory("/box").entries])
    time.sleep(SESSION_ENDS_S)
    print("identical", ftp.are_files_identical(str(here), "/box/notes.txt"))
    print("rename", refusal(ftp.rename, "/box/notes.txt", "/box/kept.txt"))
    back = scratch / "back"
    back.mkdir()
    for burst in (False, True):
        result = carried(
            lambda path, folder, heard, burst=burst: ftp.download_async(path, folder, burst, heard),
            "/box/kept.txt",
            str(back),
        )
        same = (back / "kept.txt").read_bytes() == here.read_bytes()
        (back / "kept.txt").unlink()
        print("download", "burst" if burst else "plain", result, same)
    print("remove a full directory", refused(ftp.remove_directory, "/box"))
    print("remove", refusal(ftp.remove_file, "/box/kept.txt"))
    print("remove directory", refusal(ftp.remove_directory, "/box"))
    print("missing", refused(ftp.remove_file, "/box/kept.txt"))
    print("outside", refused(ftp.list_directory, "/../.."))


def logs(station: Station, scratch: Path) -> None:
    plugin = LogFiles(station.system)
    until(lambda: refusal(plugin.get_entries) == "SUCCESS", "logs listed")
    newest = plugin.get_entries()[-1]
    there = scratch / "flight.log"
    ended = Event()
    results: list[LogFilesResult] = []

    def heard(result: LogFilesResult, _progress: object, _data: object) -> None:
        if result is not LogFilesResult.NEXT:
            results.append(result)
            ended.set()

    plugin.download_log_file_async(newest, str(there), heard)
    assert ended.wait(PATIENT_S), "the log is carried for ever"
    print("log", results[0].name, there.stat().st_size == newest.size_bytes > 1000)


def camera(station: Station) -> None:
    plugin = Camera(station.system)
    until(lambda: plugin.camera_list().cameras, "camera found")
    found = plugin.camera_list().cameras[0]
    print("camera", found.vendor_name, found.model_name, found.horizontal_resolution_px)
    number = found.component_id
    print("mode", refusal(plugin.set_mode, number, Mode.PHOTO))
    print("no film", refusal(plugin.set_mode, number, Mode.VIDEO) != "SUCCESS")
    taken: list[tuple[int, bool]] = []
    plugin.subscribe_capture_info(lambda info, _: taken.append((info.index, info.is_success)))
    plugin.take_photo(number)
    until(lambda: len(taken) == 1, "a photo")
    plugin.start_photo_interval(number, 3.0)
    until(lambda: len(taken) >= 3, "photos at an interval")
    plugin.stop_photo_interval(number)
    print("photos", taken[:3])
    until(lambda: refusal(plugin.get_storage, number) == "SUCCESS", "storage told")
    until(lambda: plugin.get_storage(number).total_storage_mib > 0, "storage known")
    print("storage", round(plugin.get_storage(number).available_storage_mib) > 0)


def calibrations(station: Station) -> None:
    """Those that need nobody who turns the vehicle over.

    MAVSDK understands PX4's texts alone: on an ArduPilot it would wait for ever.
    """
    plugin = Calibration(station.system)
    for name in ("gyro", "level_horizon"):
        ended = Event()
        results: list[CalibrationResult] = []

        def heard(
            result: CalibrationResult,
            _progress: object,
            _data: object,
            results: list[CalibrationResult] = results,
            ended: Event = ended,
        ) -> None:
            if result is not CalibrationResult.NEXT:
                results.append(result)
                ended.set()

        getattr(plugin, f"calibrate_{name}_async")(heard)
        assert ended.wait(PATIENT_S), f"calibration of {name} hangs"
        print("calibration", name, results[0].name)


def metadata(station: Station) -> None:
    plugin = ComponentMetadata(station.system)
    heard: list[MetadataType] = []
    texts: dict[MetadataType, str] = {}

    def take(update: object) -> None:
        heard.append(update.type)
        texts[update.type] = update.json_metadata

    plugin.subscribe_metadata_available(lambda update, _: take(update))
    plugin.request_autopilot_component()
    until(lambda: MetadataType.ALL_COMPLETED in heard, "metadata read")
    told = json.loads(texts[MetadataType.PARAMETER])
    print("metadata", len(told["parameters"]) >= 40)


def others(station: Station, action: Action) -> None:
    """What a quadrotor without the equipment answers, and soon."""
    print("gimbals", len(Gimbal(station.system).gimbal_list().gimbals))
    print("actuator", refusal(action.set_actuator, 9, 0.5))
    print("relay", refusal(action.set_relay, 0, 0))
    print("vtol", refusal(action.transition_to_fixedwing))


def main(url: str, personality: str, scratch: Path) -> None:
    with Station(url) as station:
        telemetry, action = Telemetry(station.system), Action(station.system)
        station.system.enable_timesync()
        if personality == "ardupilot":
            ask_for_streams(telemetry)
        until(telemetry.health_all_ok, "health all ok")
        action.arm()
        action.takeoff()
        until(lambda: telemetry.position().relative_altitude_m > 1.0, "off the ground")
        action.land()
        until(lambda: telemetry.landed_state() is LandedState.ON_GROUND, "landed")
        until(lambda: not telemetry.armed(), "disarmed")
        parameters(station, personality)
        files(station, scratch)
        logs(station, scratch)
        camera(station)
        if personality == "px4":
            calibrations(station)
            metadata(station)
        others(station, action)


if __name__ == "__main__":
    main(sys.argv[1], sys.argv[2], Path(sys.argv[3]))
