"""Messages -> facts: one reader for each topic that a report uses.

A reader is chosen once for a channel and called for each of its messages.  A message that cannot
be read gives no fact.
"""

from __future__ import annotations

import struct
from dataclasses import dataclass

import msgspec

from gcs.flight_report.facts import (
    Battery,
    Decision,
    Fact,
    LogLine,
    Machine,
    Parameter,
    Pose,
    Status,
)
from gcs.flight_report.readers.mavlink_fields import Read
from gcs.flight_report.readers.mavlink_readers import MAVLINK_READERS
from gcs.flight_report.readers.mavlink_samples import PLAN_READERS
from gcs.flight_report.readers.onboard_logs import AUTOPILOT_OF_PREFIX, onboard_reader
from gcs.record.log_line import read_log_line
from gcs.report import ConditionItem, PointEnu

AUTOPILOT_COMPONENT = 1
UNREADABLE = (struct.error, msgspec.MsgspecError)
"""What a reader raises for a message that is not what its topic says."""


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
            own = int(compid) == AUTOPILOT_COMPONENT
            make = PLAN_READERS.get(name) or (MAVLINK_READERS.get(name) if own else None)
            if make is None and not own:
                return None
            return Source(int(sysid) if own else 0, make() if make else None, heard=own)
        case ["", "vehicle", sysid, "param"] if sysid.isdecimal():
            return Source(int(sysid), _parameter)
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
    alt_rel_m: float | None = None
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
    conditions: tuple[ConditionItem, ...] | None = None


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


class _ParameterMessage(msgspec.Struct):
    name: str
    value: float


_decode_parameter = msgspec.json.Decoder(_ParameterMessage).decode
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
                found.alt_rel_m,
            )
        )
    return facts


def _machine(data: bytes) -> list[Fact]:
    try:
        found = _decode_machine(data)
    except msgspec.DecodeError:
        return []
    goal = found.goal.enu if found.goal else None
    return [
        Machine(found.state, found.event, found.control, found.severity, goal, found.conditions)
    ]


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


def _parameter(data: bytes) -> list[Fact]:
    try:
        found = _decode_parameter(data)
    except msgspec.DecodeError:
        return []
    return [Parameter(found.name, found.value)]


def _log(data: bytes) -> list[Fact]:
    line = read_log_line(data)
    return [] if line is None else [LogLine(*line)]
