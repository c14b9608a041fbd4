"""Derived topics for plots, state bars and programs: JSON with a schema, heights up, degrees.

A value that is not known is left out rather than null: viewers read `type` as one plain type.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from math import asin, atan2, degrees, hypot
from typing import TypeAlias

import msgspec

from gcs.frames import Vec3, enu_from_ned
from gcs.record.backend import Channel
from gcs.record.items import (
    DecisionItem,
    FsaItem,
    GeodeticItem,
    InputItem,
    ParamItem,
    PoseItem,
    Quat,
    RecordItem,
    StatusItem,
)
from gcs.record.topics import Grid, Out, finite

STATE_HZ = 5.0
FSA_HZ = 1.0

Json: TypeAlias = "str | int | float | bool | dict[str, Json] | None"
Shape: TypeAlias = "str | dict[str, Shape]"
"""A JSON type's name, or the properties of an object."""

_POINT: Shape = {"east_m": "number", "north_m": "number", "up_m": "number"}

STATE_SHAPE: dict[str, Shape] = {
    "east_m": "number",
    "north_m": "number",
    "up_m": "number",
    "groundspeed_mps": "number",
    "climb_mps": "number",
    "roll_deg": "number",
    "pitch_deg": "number",
    "yaw_deg": "number",
    "alt_amsl_m": "number",
    "alt_rel_m": "number",
    "armed": "boolean",
    "mode": "string",
    "landed": "string",
    "battery_pct": "number",
    "battery_v": "number",
    "rx_hz": "number",
    "lost_pct": "number",
}
FSA_SHAPE: dict[str, Shape] = {
    "state": "string",
    "state_id": "integer",
    "before": "string",
    "event": "string",
    "control": "string",
    "severity": "string",
    "goal": _POINT,
}
DECISION_SHAPE: dict[str, Shape] = {
    "vehicle": "integer",
    "request_id": "integer",
    "source": "string",
    "word": "string",
    "phase": "string",
    "outcome": "string",
    "code": "string",
    "sentence": "string",
    "zone": "string",
    "goal": _POINT,
    "numbers": {},
}
PARAM_SHAPE: dict[str, Shape] = {"name": "string", "value": "number"}
INPUT_SHAPE: dict[str, Shape] = {"kind": "string", "data": {}}


def json_channel(topic: str, title: str, shape: dict[str, Shape]) -> Channel:
    schema: dict[str, Json] = {"title": title, **_schema(shape)}
    return Channel(topic, "json", title, "jsonschema", msgspec.json.encode(schema))


def _schema(shape: dict[str, Shape]) -> dict[str, Json]:
    return {
        "type": "object",
        "properties": {
            name: _schema(inner) if isinstance(inner, dict) else {"type": inner}
            for name, inner in shape.items()
        },
    }


def encode(values: dict[str, Json]) -> bytes:
    """Without what is None; NaN and infinity (in `numbers` and goals) become null."""
    return msgspec.json.encode({name: v for name, v in values.items() if v is not None})


def point(at_ned: Vec3 | None) -> dict[str, Json] | None:
    if at_ned is None:
        return None
    east, north, up = enu_from_ned(at_ned)
    return {"east_m": east, "north_m": north, "up_m": up}


def euler_deg(q: Quat) -> tuple[float, float, float]:
    """Roll, pitch, yaw (0..360 clockwise from north) of a body-FRD-to-NED quaternion w, x, y, z.

    The 3-2-1 sequence (Diebel 2006, eq. 290).
    """
    w, x, y, z = q
    roll = atan2(2 * (w * x + y * z), 1 - 2 * (x * x + y * y))
    pitch = asin(max(-1.0, min(1.0, 2 * (w * y - z * x))))
    yaw = atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z))
    return degrees(roll), degrees(pitch), degrees(yaw) % 360.0


@dataclass(slots=True)
class _Vehicle:
    """What is known of one vehicle, and when its topics are due."""

    state: Channel
    fsa: Channel
    param: Channel
    pose: PoseItem | None = None
    geodetic: GeodeticItem | None = None
    status: StatusItem | None = None
    machine: FsaItem | None = None
    state_grid: Grid = field(default_factory=lambda: Grid(STATE_HZ))
    fsa_sent_ns: int = 0


class Readings:
    """/vehicle/N/state, /vehicle/N/fsa, /vehicle/N/param, /gate/decision and /session/input."""

    def __init__(self) -> None:
        self._vehicles: dict[int, _Vehicle] = {}
        self._decision = json_channel("/gate/decision", "gate.Decision", DECISION_SHAPE)
        self._input = json_channel("/session/input", "session.Input", INPUT_SHAPE)

    def handle(self, item: RecordItem, now_ns: int) -> list[Out]:
        match item:
            case InputItem(kind, json):
                message = b'{"kind":%b,"data":%b}' % (msgspec.json.encode(kind), json or b"{}")
                return [Out(self._input, message)]
            case PoseItem():
                vehicle = self._vehicle(item.sysid)
                vehicle.pose = item
                return _state(vehicle, now_ns)
            case GeodeticItem():
                self._vehicle(item.sysid).geodetic = item
                return []
            case StatusItem():
                vehicle = self._vehicle(item.sysid)
                vehicle.status = item
                return _state(vehicle, now_ns)
            case FsaItem():
                return self._fsa(item, now_ns)
            case DecisionItem():
                return [Out(self._decision, _decision(item))]
            case ParamItem(sysid, name, value):
                message = encode({"name": name, "value": finite(value)})
                return [Out(self._vehicle(sysid).param, message, latch=name)]
            case _:
                return []

    def tick(self, now_ns: int) -> list[Out]:
        period_ns = round(1e9 / FSA_HZ)
        due = [v for v in self._vehicles.values() if now_ns - v.fsa_sent_ns >= period_ns]
        return [out for vehicle in due for out in _remind(vehicle, now_ns)]

    def close(self, now_ns: int) -> list[Out]:
        return [out for vehicle in self._vehicles.values() for out in _remind(vehicle, now_ns)]

    def _fsa(self, item: FsaItem, now_ns: int) -> list[Out]:
        vehicle = self._vehicle(item.sysid)
        unchanged = item == vehicle.machine
        vehicle.machine = item
        if unchanged and now_ns - vehicle.fsa_sent_ns < round(1e9 / FSA_HZ):
            return []
        return _remind(vehicle, now_ns)

    def _vehicle(self, sysid: int) -> _Vehicle:
        known = self._vehicles.get(sysid)
        if known is None:
            base = f"/vehicle/{sysid}"
            known = self._vehicles[sysid] = _Vehicle(
                state=json_channel(f"{base}/state", "vehicle.State", STATE_SHAPE),
                fsa=json_channel(f"{base}/fsa", "gate.Fsa", FSA_SHAPE),
                param=json_channel(f"{base}/param", "vehicle.Param", PARAM_SHAPE),
            )
        return known


def _remind(vehicle: _Vehicle, now_ns: int) -> list[Out]:
    item = vehicle.machine
    if item is None:
        return []
    vehicle.fsa_sent_ns = now_ns
    message = encode(
        {
            "state": item.state_name,
            "state_id": item.state,
            "before": item.before_name,
            "event": item.event,
            "control": item.control,
            "severity": item.severity,
            "goal": point(item.active_goal_ned),
        }
    )
    return [Out(vehicle.fsa, message)]


def _state(vehicle: _Vehicle, now_ns: int) -> list[Out]:
    if not vehicle.state_grid.due(now_ns):
        return []
    values: dict[str, Json] = {}
    if vehicle.pose is not None:
        v_north, v_east, v_down = vehicle.pose.v_ned
        roll, pitch, yaw = euler_deg(vehicle.pose.q_ned_from_frd)
        values |= point(vehicle.pose.pos_ned) or {}
        values |= {"groundspeed_mps": hypot(v_north, v_east), "climb_mps": 0.0 - v_down}
        values |= {"roll_deg": roll, "pitch_deg": pitch, "yaw_deg": yaw}
    if vehicle.geodetic is not None:
        values["alt_amsl_m"] = vehicle.geodetic.alt_amsl_m
        values["alt_rel_m"] = vehicle.geodetic.alt_rel_m
    if vehicle.status is not None:
        status = vehicle.status
        values |= {"armed": status.armed, "mode": status.mode, "landed": status.landed}
        values |= {"battery_pct": status.battery_pct, "battery_v": status.battery_v}
        values |= {"rx_hz": status.rx_hz, "lost_pct": status.lost_pct}
    known = {n: finite(v) if isinstance(v, float) else v for n, v in values.items()}
    return [Out(vehicle.state, encode(known))]


def _decision(item: DecisionItem) -> bytes:
    return encode(
        {
            "vehicle": item.sysid,
            "request_id": item.request_id,
            "source": item.source,
            "word": item.word,
            "phase": item.phase,
            "outcome": item.outcome,
            "code": item.code,
            "sentence": item.sentence,
            "zone": item.zone,
            "goal": point(item.goal_ned),
            "numbers": dict(item.numbers),
        }
    )
