"""MAVLink messages -> facts: one reader for each message that a report uses.

Those that are plotted or shown as they are stand in `mavlink_samples.py`.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from math import isfinite

from gcs.flight_report.facts import (
    Battery,
    Cells,
    Estimator,
    Fact,
    Failed,
    Gps,
    Identity,
    Text,
    Vibration,
)
from gcs.flight_report.readers.mavlink_fields import Read, numbers, text
from gcs.flight_report.readers.mavlink_samples import SAMPLE_READERS
from gcs.protocol.autopilot import autopilot_of, type_name
from gcs.wire.ids import MavAutopilot, MavType

_TEXT_BYTES = 50
_NOT_VEHICLES = frozenset(
    {MavType.GCS, MavType.ANTENNA_TRACKER, MavType.ONBOARD_CONTROLLER, MavType.ADSB}
)


def _heartbeat() -> Read:
    read = numbers("HEARTBEAT", "autopilot", "type")

    def facts(data: bytes) -> list[Fact]:
        autopilot, kind = (int(value) for value in read(data))
        if autopilot == MavAutopilot.INVALID or kind in _NOT_VEHICLES:
            return []
        return [Identity(autopilot_of(autopilot, kind).name, type_name(kind))]

    return facts


SENSORS: Mapping[int, str] = {
    1 << 0: "gyroscope",
    1 << 1: "accelerometer",
    1 << 2: "compass",
    1 << 3: "barometer",
    1 << 16: "radio receiver",
}
"""MAV_SYS_STATUS_SENSOR; GPS and battery are told in other messages, and better."""


def _sensors(bits: int) -> frozenset[str]:
    return frozenset(name for bit, name in SENSORS.items() if bits & bit)


def _sys_status() -> Read:
    read = numbers("SYS_STATUS", "voltage_battery", "current_battery", "battery_remaining")
    health = numbers(
        "SYS_STATUS",
        *(f"onboard_control_sensors_{each}" for each in ("present", "enabled", "health")),
    )

    def facts(data: bytes) -> list[Fact]:
        millivolts, centiamperes, percent = read(data)
        present, enabled, healthy = (int(bits) for bits in health(data))
        in_use = present & enabled
        return [
            Failed(_sensors(in_use & ~healthy), _sensors(in_use)),
            Battery(
                millivolts / 1e3 if 0 < millivolts < 0xFFFF else None,
                centiamperes / 1e2 if centiamperes >= 0 else None,
                float(percent) if percent >= 0 else None,
            ),
        ]

    return facts


def _battery_status() -> Read:
    read = numbers("BATTERY_STATUS", "id", "voltages")

    def facts(data: bytes) -> list[Fact]:
        battery, *millivolts = read(data)
        # A pack without cells has its whole voltage in the first; a cell has less than 4.5 V.
        cells = [mv for mv in millivolts if 0 < mv < 4500]
        return [Cells(len(cells))] if battery == 0 and len(cells) > 1 else []

    return facts


def _vibration() -> Read:
    read = numbers(
        "VIBRATION",
        *("vibration_x", "vibration_y", "vibration_z", "clipping_0", "clipping_1", "clipping_2"),
    )

    def facts(data: bytes) -> list[Fact]:
        x, y, z, *clipped = read(data)
        return [Vibration(x, y, z, int(sum(clipped)))]

    return facts


def _gps_raw() -> Read:
    read = numbers("GPS_RAW_INT", "fix_type", "satellites_visible", "eph", "h_acc")

    def facts(data: bytes) -> list[Fact]:
        fix_type, satellites, eph, h_acc_mm = read(data)
        return [
            Gps(
                int(fix_type),
                int(satellites) if satellites != 0xFF else None,
                eph / 100.0 if eph != 0xFFFF else None,
                h_acc_mm / 1e3 if h_acc_mm else None,
            )
        ]

    return facts


def _ratios(autopilot: str, message: str, *names: str) -> Callable[[], Read]:
    def make() -> Read:
        read = numbers(message, *names)

        def facts(data: bytes) -> list[Fact]:
            ratios = (value if isfinite(value) else None for value in read(data))
            return [Estimator(autopilot, *ratios)]

        return facts

    return make


def _statustext() -> Read:
    """Joins the chunks of a long text, which come in order and carry the text's `id`."""
    read = numbers("STATUSTEXT", "severity", "id", "chunk_seq")
    begun: dict[int, str] = {}

    def facts(data: bytes) -> list[Fact]:
        severity, number, chunk = (int(value) for value in read(data))
        part = text("STATUSTEXT", "text", data)
        if number == 0:
            return [Text(severity, part.strip())]
        whole = (begun.pop(number, "") if chunk else "") + part
        if len(part.encode()) < _TEXT_BYTES:
            return [Text(severity, whole.strip())]
        begun[number] = whole
        return []

    return facts


MAVLINK_READERS: Mapping[str, Callable[[], Read]] = {
    "HEARTBEAT": _heartbeat,
    "SYS_STATUS": _sys_status,
    "BATTERY_STATUS": _battery_status,
    "VIBRATION": _vibration,
    "GPS_RAW_INT": _gps_raw,
    "ESTIMATOR_STATUS": _ratios(
        "px4",
        "ESTIMATOR_STATUS",
        *("vel_ratio", "pos_horiz_ratio", "pos_vert_ratio", "mag_ratio"),
    ),
    "EKF_STATUS_REPORT": _ratios(
        "ardupilot",
        "EKF_STATUS_REPORT",
        *("velocity_variance", "pos_horiz_variance", "pos_vert_variance", "compass_variance"),
    ),
    "STATUSTEXT": _statustext,
    **SAMPLE_READERS,
}
