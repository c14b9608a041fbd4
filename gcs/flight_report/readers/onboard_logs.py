"""Facts of the autopilots' own logs, imported: `/dataflash/NAME` and `/ulog/name_0`.

Position, attitude, battery and mode come in the derived topics, as in any record; what is plotted
or shown as it is stands in `onboard_samples.py`.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping

from gcs.flight_report.facts import Battery, Estimator, Fact, Gps, Text, Vibration
from gcs.flight_report.readers.onboard_samples import ONBOARD_SAMPLES
from gcs.flight_report.readers.packed_fields import PackedFields, Read

AUTOPILOT_OF_PREFIX = {"dataflash": "ardupilot", "ulog": "px4"}


def onboard_reader(log: str, name: str, schema: bytes) -> Read | None:
    """The reader of a topic `/<log>/<name>`; None for one that a report does not use."""
    make = _READERS.get((log, name))
    if make is None:
        return None
    try:
        return make(PackedFields(schema))
    except ValueError:
        return None


def _count(value: float | None) -> int | None:
    return None if value is None else int(value)


# ---------------------------------------------------------------------- ArduPilot's DataFlash


def _vibe(fields: PackedFields) -> Read:
    """One accelerometer a message in newer logs (`IMU`, `Clip`), all in one in older ones."""
    imu = fields.value("IMU")
    x, y, z = (fields.value(name) for name in ("VibeX", "VibeY", "VibeZ"))
    clips = [fields.value(name) for name in ("Clip", "Clip0", "Clip1", "Clip2")]

    def facts(data: bytes) -> list[Fact]:
        x_level, y_level, z_level = x(data), y(data), z(data)
        if imu(data) or x_level is None or y_level is None or z_level is None:
            return []
        clipped = sum(int(read(data) or 0) for read in clips)
        return [Vibration(x_level, y_level, z_level, clipped)]

    return facts


def _gps(fields: PackedFields) -> Read:
    instance = fields.value("I")
    status, satellites, hdop = (fields.value(name) for name in ("Status", "NSats", "HDop"))

    def facts(data: bytes) -> list[Fact]:
        fix = _count(status(data))
        if instance(data) or fix is None:
            return []
        return [Gps(fix, _count(satellites(data)), hdop(data), None)]

    return facts


def _ekf_ratios(fields: PackedFields) -> Read:
    core = fields.value("C")
    ratios = [fields.value(name) for name in ("SV", "SP", "SH", "SM")]

    def facts(data: bytes) -> list[Fact]:
        if core(data):
            return []
        return [Estimator("ardupilot", *(read(data) for read in ratios))]

    return facts


def _bat(fields: PackedFields) -> Read:
    instance = fields.value("Inst", "Instance", "I")
    volts, amperes, left = fields.value("Volt"), fields.value("Curr"), fields.value("RemPct")

    def facts(data: bytes) -> list[Fact]:
        return [] if instance(data) else [Battery(volts(data), amperes(data), left(data))]

    return facts


ERRORS: Mapping[tuple[int, int], str] = {
    (5, 1): "Radio Failsafe",
    (6, 1): "Battery Failsafe",
    (8, 1): "GCS Failsafe",
    (9, 1): "Altitude fence breached",
    (9, 2): "Circular fence breached",
    (9, 3): "Altitude and circular fence breached",
    (9, 4): "Polygon fence breached",
    (11, 2): "GPS Glitch",
    (12, 1): "Crash: Disarming",
    (16, 2): "EKF variance",
    (17, 1): "EKF Failsafe",
    (23, 1): "Terrain Failsafe",
    (25, 1): "Potential Thrust Loss",
    (29, 1): "Vibration compensation ON",
}
"""ERR (subsystem, code) -> the text that ArduCopter says with it.

Subsystems and codes: ArduPilot wiki, Diagnosing problems using Logs."""


def _err(fields: PackedFields) -> Read:
    subsystem, code = fields.value("Subsys"), fields.value("ECode")

    def facts(data: bytes) -> list[Fact]:
        number = _count(subsystem(data)) or 0, _count(code(data)) or 0
        text = ERRORS.get(number)
        return [] if text is None else [Text(3, f"{text} (ERR {number[0]}, {number[1]})")]

    return facts


# ----------------------------------------------------------------------------------- PX4's ULog


def _imu_status(fields: PackedFields) -> Read:
    level = fields.value("accel_vibration_metric")
    clips = [fields.value(f"accel_clipping_{axis}") for axis in range(3)]

    def facts(data: bytes) -> list[Fact]:
        metric = level(data)
        if metric is None:
            return []
        return [Vibration(0.0, 0.0, metric, sum(int(read(data) or 0) for read in clips))]

    return facts


def _vehicle_gps(fields: PackedFields) -> Read:
    fix_type, hdop, eph = (fields.value(name) for name in ("fix_type", "hdop", "eph"))
    satellites = fields.value("satellites_used")

    def facts(data: bytes) -> list[Fact]:
        fix = _count(fix_type(data))
        if fix is None:
            return []
        return [Gps(fix, _count(satellites(data)), hdop(data), eph(data))]

    return facts


def _test_ratios(fields: PackedFields) -> Read:
    ratios = [fields.value(f"{name}_test_ratio") for name in ("vel", "pos", "hgt", "mag")]

    def facts(data: bytes) -> list[Fact]:
        return [Estimator("px4", *(read(data) for read in ratios))]

    return facts


def _battery_status(fields: PackedFields) -> Read:
    volts, amperes = fields.value("voltage_v"), fields.value("current_a")
    left = fields.value("remaining")

    def facts(data: bytes) -> list[Fact]:
        share = left(data)
        percent = None if share is None or share < 0.0 else 100.0 * share
        return [Battery(volts(data), amperes(data), percent)]

    return facts


_READERS: Mapping[tuple[str, str], Callable[[PackedFields], Read]] = {
    ("dataflash", "VIBE"): _vibe,
    ("dataflash", "GPS"): _gps,
    ("dataflash", "XKF4"): _ekf_ratios,
    ("dataflash", "NKF4"): _ekf_ratios,
    ("dataflash", "BAT"): _bat,
    ("dataflash", "ERR"): _err,
    ("ulog", "vehicle_imu_status_0"): _imu_status,
    ("ulog", "vehicle_gps_position_0"): _vehicle_gps,
    ("ulog", "sensor_gps_0"): _vehicle_gps,
    ("ulog", "estimator_status_0"): _test_ratios,
    ("ulog", "battery_status_0"): _battery_status,
    **ONBOARD_SAMPLES,
}
