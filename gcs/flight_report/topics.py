"""Messages -> facts: one reader for each topic that a report uses.

A reader is chosen once for a channel and called for each of its messages.  A message that cannot
be read gives no fact.
"""

from __future__ import annotations

import struct
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from math import isfinite
from typing import TypeAlias

import msgspec

from gcs.flight_report import payload
from gcs.flight_report.facts import (
    Battery,
    Cells,
    Decision,
    Estimator,
    Fact,
    Gps,
    Identity,
    Machine,
    Pose,
    Status,
    Text,
    Vibration,
)
from gcs.flight_report.log_line import read_log_line
from gcs.flight_report.onboard_logs import AUTOPILOT_OF_PREFIX, onboard_reader
from gcs.protocol.autopilot import autopilot_of, type_name
from gcs.report import PointEnu
from gcs.wire.ids import MavAutopilot, MavType

Read: TypeAlias = Callable[[bytes], "list[Fact]"]

AUTOPILOT_COMPONENT = 1
_TEXT_BYTES = 50
_NOT_VEHICLES = frozenset(
    {MavType.GCS, MavType.ANTENNA_TRACKER, MavType.ONBOARD_CONTROLLER, MavType.ADSB}
)


@dataclass(frozen=True, slots=True)
class Source:
    """Whose channel it is, and how its messages are read.

    `vehicle` 0 is the whole record's, or its only vehicle's; a Decision names its own.  `heard`
    says that a message is a sign of life of the vehicle.
    """

    vehicle: int
    read: Read | None
    heard: bool = False
    autopilot: str = ""
    """Whose own log it is."""


def source_of(topic: str, schema: bytes = b"") -> Source | None:
    """None for a topic that a report does not use."""
    match topic.split("/"):
        case ["", "mavlink", sysid, compid, name] if sysid.isdecimal() and compid.isdecimal():
            if int(compid) != AUTOPILOT_COMPONENT:
                return None
            make = _MAVLINK.get(name)
            return Source(int(sysid), make() if make else None, heard=True)
        case ["", "vehicle", sysid, "state"] if sysid.isdecimal():
            return Source(int(sysid), _state)
        case ["", "vehicle", sysid, "fsa"] if sysid.isdecimal():
            return Source(int(sysid), _machine)
        case ["", "gate", "decision"]:
            return Source(0, _decision)
        case ["", "dataflash" | "ulog" as log, name]:
            read = onboard_reader(log, name, schema)
            return read and Source(0, read, autopilot=AUTOPILOT_OF_PREFIX[log])
        case ["", "log"]:
            return Source(0, _log)
        case _:
            return None


# ------------------------------------------------------------------------------- JSON topics


class _StateMessage(msgspec.Struct):
    """`/vehicle/N/state`: what was not known is not there."""

    east_m: float | None = None
    north_m: float | None = None
    up_m: float | None = None
    groundspeed_mps: float = 0.0
    climb_mps: float = 0.0
    roll_deg: float = 0.0
    pitch_deg: float = 0.0
    yaw_deg: float = 0.0
    armed: bool | None = None
    mode: str = ""
    landed: str = ""
    battery_pct: float | None = None
    battery_v: float | None = None
    rx_hz: float | None = None
    lost_pct: float | None = None


class _MachineMessage(msgspec.Struct):
    state: str
    event: str = ""
    control: str = ""
    severity: str = ""
    goal: PointEnu | None = None


class _DecisionMessage(msgspec.Struct):
    vehicle: int
    request_id: int
    word: str
    phase: str
    outcome: str
    source: str = ""
    code: str = ""
    sentence: str = ""
    goal: PointEnu | None = None
    numbers: dict[str, float | None] = {}


_decode_state = msgspec.json.Decoder(_StateMessage).decode
_decode_machine = msgspec.json.Decoder(_MachineMessage).decode
_decode_decision = msgspec.json.Decoder(_DecisionMessage).decode


def _state(data: bytes) -> list[Fact]:
    try:
        found = _decode_state(data)
    except msgspec.DecodeError:
        return []
    facts: list[Fact] = []
    if found.armed is not None:
        facts.append(Status(found.armed, found.mode, found.landed, found.rx_hz, found.lost_pct))
        if found.battery_v is not None or found.battery_pct is not None:
            facts.append(Battery(found.battery_v, None, found.battery_pct))
    if found.east_m is not None and found.north_m is not None and found.up_m is not None:
        facts.append(
            Pose(
                (found.east_m, found.north_m, found.up_m),
                found.groundspeed_mps,
                found.climb_mps,
                found.roll_deg,
                found.pitch_deg,
                found.yaw_deg,
            )
        )
    return facts


def _machine(data: bytes) -> list[Fact]:
    try:
        found = _decode_machine(data)
    except msgspec.DecodeError:
        return []
    goal = found.goal.enu if found.goal else None
    return [Machine(found.state, found.event, found.control, found.severity, goal)]


def _decision(data: bytes) -> list[Fact]:
    try:
        found = _decode_decision(data)
    except msgspec.DecodeError:
        return []
    return [
        Decision(
            found.vehicle,
            found.request_id,
            found.source,
            found.word,
            found.phase,
            found.outcome,
            found.code,
            found.sentence,
            found.goal.enu if found.goal else None,
            found.numbers,
        )
    ]


def _log(data: bytes) -> list[Fact]:
    line = read_log_line(data)
    return [] if line is None else [line]


# ------------------------------------------------------------------------------------ MAVLink


def _heartbeat() -> Read:
    read = payload.numbers("HEARTBEAT", "autopilot", "type")

    def facts(data: bytes) -> list[Fact]:
        autopilot, kind = (int(value) for value in read(data))
        if autopilot == MavAutopilot.INVALID or kind in _NOT_VEHICLES:
            return []
        return [Identity(autopilot_of(autopilot, kind).name, type_name(kind))]

    return facts


def _sys_status() -> Read:
    read = payload.numbers("SYS_STATUS", "voltage_battery", "current_battery", "battery_remaining")

    def facts(data: bytes) -> list[Fact]:
        millivolts, centiamperes, percent = read(data)
        return [
            Battery(
                millivolts / 1e3 if 0 < millivolts < 0xFFFF else None,
                centiamperes / 1e2 if centiamperes >= 0 else None,
                float(percent) if percent >= 0 else None,
            )
        ]

    return facts


def _battery_status() -> Read:
    read = payload.numbers("BATTERY_STATUS", "id", "voltages")

    def facts(data: bytes) -> list[Fact]:
        battery, *millivolts = read(data)
        # A pack without cells has its whole voltage in the first; a cell has less than 4.5 V.
        cells = [mv for mv in millivolts if 0 < mv < 4500]
        return [Cells(len(cells))] if battery == 0 and len(cells) > 1 else []

    return facts


def _vibration() -> Read:
    read = payload.numbers(
        "VIBRATION",
        *("vibration_x", "vibration_y", "vibration_z", "clipping_0", "clipping_1", "clipping_2"),
    )

    def facts(data: bytes) -> list[Fact]:
        x, y, z, *clipped = read(data)
        return [Vibration(x, y, z, int(sum(clipped)))]

    return facts


def _gps_raw() -> Read:
    read = payload.numbers("GPS_RAW_INT", "fix_type", "satellites_visible", "eph", "h_acc")

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
        read = payload.numbers(message, *names)

        def facts(data: bytes) -> list[Fact]:
            ratios = (value if isfinite(value) else None for value in read(data))
            return [Estimator(autopilot, *ratios)]

        return facts

    return make


def _statustext() -> Read:
    """Joins the chunks of a long text, which come in order and carry the text's `id`."""
    read = payload.numbers("STATUSTEXT", "severity", "id", "chunk_seq")
    begun: dict[int, str] = {}

    def facts(data: bytes) -> list[Fact]:
        severity, number, chunk = (int(value) for value in read(data))
        part = payload.text("STATUSTEXT", "text", data)
        if number == 0:
            return [Text(severity, part.strip())]
        whole = (begun.pop(number, "") if chunk else "") + part
        if len(part.encode()) < _TEXT_BYTES:
            return [Text(severity, whole.strip())]
        begun[number] = whole
        return []

    return facts


_MAVLINK: Mapping[str, Callable[[], Read]] = {
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
}

UNREADABLE = (struct.error, msgspec.MsgspecError)
"""What a reader raises for a message that is not what its topic says."""
