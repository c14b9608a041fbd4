"""Topics for plots, state bars and programs: JSON with a schema, in the operator's frame.

Heights are up, angles degrees.  Schema and messages come from the fields of a struct.  A value
that is not known is left out rather than null: viewers read `type` as one plain type.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable
from dataclasses import dataclass, field
from math import asin, atan2, degrees, hypot, isfinite
from typing import TypeAlias

import msgspec
from msgspec import inspect

from gcs.frames import enu_from_ned
from gcs.record.backend import Channel
from gcs.record.topics import INPUT_TOPIC, Grid, Out
from gcs.report import (
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

STATE_HZ = 5.0
FSA_PERIOD_NS = 750_000_000
"""Shorter than the time between two flushes, which are when a state is repeated."""

_encode = msgspec.json.Encoder().encode

Json: TypeAlias = "str | dict[str, Json]"
_TYPES: dict[type[inspect.Type], str] = {
    inspect.FloatType: "number",
    inspect.IntType: "integer",
    inspect.BoolType: "boolean",
    inspect.StrType: "string",
    inspect.LiteralType: "string",
}


class Motion(msgspec.Struct, frozen=True):
    """A pose as a person reads it: east, north, up of the local origin, angles in degrees.

    `yaw_deg` is 0..360, clockwise from north.
    """

    east_m: float
    north_m: float
    up_m: float
    groundspeed_mps: float
    climb_mps: float
    roll_deg: float
    pitch_deg: float
    yaw_deg: float

    @classmethod
    def of(cls, pose: PoseItem) -> Motion:
        v_north, v_east, v_down = pose.v_ned
        speeds = hypot(v_north, v_east), 0.0 - v_down
        return cls(*enu_from_ned(pose.pos_ned), *speeds, *euler_deg(pose.q_ned_from_frd))


class JsonTopic:
    """A topic whose messages are the fields of a struct, or of several structs in a row.

    `without` names fields that are left out: `sysid` is in the topic's name.
    """

    def __init__(
        self,
        topic: str,
        title: str,
        *kinds: type[msgspec.Struct],
        without: Collection[str] = ("sysid",),
    ) -> None:
        self._names = {
            kind: [name for name in kind.__struct_fields__ if name not in without] for kind in kinds
        }
        schema: dict[str, Json] = {"title": title, **_object(kinds, without)}
        self.channel = Channel(topic, "json", title, "jsonschema", _encode(schema))

    def out(self, *facts: msgspec.Struct | None, latch: str = "") -> Out:
        """Without what is None, NaN or infinite; deeper inside, NaN and infinity become null."""
        values = {}
        for fact in facts:
            for name in self._names[type(fact)] if fact is not None else ():
                value = getattr(fact, name)
                if value is not None and not (isinstance(value, float) and not isfinite(value)):
                    values[name] = value
        return Out(self.channel, _encode(values), latch)


def _object(kinds: Iterable[type[msgspec.Struct]], without: Collection[str]) -> dict[str, Json]:
    fields = [one for kind in kinds for one in msgspec.structs.fields(kind)]
    properties: dict[str, Json] = {
        one.name: _schema(inspect.type_info(one.type)) for one in fields if one.name not in without
    }
    return {"type": "object", "properties": properties}


def _schema(kind: inspect.Type) -> dict[str, Json]:
    """One plain type; an object's properties only where they are always the same."""
    if isinstance(kind, inspect.UnionType):
        (kind,) = (each for each in kind.types if not isinstance(each, inspect.NoneType))
    if isinstance(kind, inspect.StructType):
        return _object([kind.cls], ())
    if isinstance(kind, inspect.DictType | inspect.RawType):
        return {"type": "object", "properties": {}}
    return {"type": _TYPES[type(kind)]}


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
    """The newest facts about one vehicle, and when its topics are due."""

    state: JsonTopic
    fsa: JsonTopic
    param: JsonTopic
    pose: PoseItem | None = None
    geodetic: GeodeticItem | None = None
    status: StatusItem | None = None
    machine: FsaItem | None = None
    state_grid: Grid = field(default_factory=lambda: Grid(STATE_HZ))
    fsa_sent_ns: int = 0


class JsonTopics:
    """/vehicle/N/state, /vehicle/N/fsa, /vehicle/N/param, /gate/decision and /session/input."""

    def __init__(self) -> None:
        self._vehicles: dict[int, _Vehicle] = {}
        self._decision = JsonTopic("/gate/decision", "gate.Decision", DecisionItem)
        self._input = JsonTopic(INPUT_TOPIC, "session.Input", InputItem)

    def handle(self, item: RecordItem, now_ns: int) -> list[Out]:
        match item:
            case InputItem():
                return [Out(self._input.channel, _encode(item))]
            case PoseItem(sysid):
                vehicle = self._vehicle(sysid)
                vehicle.pose = item
                return _state(vehicle, now_ns)
            case GeodeticItem(sysid):
                self._vehicle(sysid).geodetic = item
                return []
            case StatusItem(sysid):
                vehicle = self._vehicle(sysid)
                vehicle.status = item
                return _state(vehicle, now_ns)
            case FsaItem():
                return self._fsa(item, now_ns)
            case DecisionItem():
                return [self._decision.out(item)]
            case ParamItem(sysid, name):
                return [self._vehicle(sysid).param.out(item, latch=name)]
            case _:
                return []

    def tick(self, now_ns: int) -> list[Out]:
        due = [v for v in self._vehicles.values() if now_ns - v.fsa_sent_ns >= FSA_PERIOD_NS]
        return [out for vehicle in due for out in _repeat_fsa(vehicle, now_ns)]

    def close(self, now_ns: int) -> list[Out]:
        return [out for vehicle in self._vehicles.values() for out in _repeat_fsa(vehicle, now_ns)]

    def _fsa(self, item: FsaItem, now_ns: int) -> list[Out]:
        vehicle = self._vehicle(item.sysid)
        unchanged = item == vehicle.machine
        vehicle.machine = item
        if unchanged and now_ns - vehicle.fsa_sent_ns < FSA_PERIOD_NS:
            return []
        return _repeat_fsa(vehicle, now_ns)

    def _vehicle(self, sysid: int) -> _Vehicle:
        known = self._vehicles.get(sysid)
        if known is None:
            base = f"/vehicle/{sysid}"
            known = self._vehicles[sysid] = _Vehicle(
                state=JsonTopic(
                    f"{base}/state",
                    "vehicle.State",
                    *(Motion, GeodeticItem, StatusItem),
                    without=("sysid", "lat_deg", "lon_deg"),
                ),
                fsa=JsonTopic(f"{base}/fsa", "gate.Fsa", FsaItem),
                param=JsonTopic(f"{base}/param", "vehicle.Param", ParamItem),
            )
        return known


def _repeat_fsa(vehicle: _Vehicle, now_ns: int) -> list[Out]:
    if vehicle.machine is None:
        return []
    vehicle.fsa_sent_ns = now_ns
    return [vehicle.fsa.out(vehicle.machine)]


def _state(vehicle: _Vehicle, now_ns: int) -> list[Out]:
    if not vehicle.state_grid.due(now_ns):
        return []
    motion = None if vehicle.pose is None else Motion.of(vehicle.pose)
    return [vehicle.state.out(motion, vehicle.geodetic, vehicle.status)]
