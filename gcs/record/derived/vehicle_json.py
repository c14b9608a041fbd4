"""What plots and programs read of a vehicle: /vehicle/N/state, /vehicle/N/fsa, /vehicle/N/param.

In the operator's frame: heights are up, angles degrees.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from math import asin, atan2, degrees, hypot
from typing import ClassVar

import msgspec

from gcs.frames import enu_from_ned
from gcs.record.derived.json_topic import JsonTopic
from gcs.record.topics import Deriver, Grid, Out
from gcs.report import (
    FsaItem,
    GeodeticItem,
    ParamItem,
    PoseItem,
    Quat,
    RecordItem,
    StatusItem,
    StopItem,
)

STATE_HZ = 5.0
FSA_PERIOD_NS = 750_000_000
"""Shorter than the time between two flushes, which are when a state is repeated."""
DECIMALS = 3
"""Millimetres and thousandths of a degree: no autopilot reports better."""


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
        values = (*enu_from_ned(pose.pos_ned), *speeds, *euler_deg(pose.q_ned_from_frd))
        return cls(*(round(value, DECIMALS) for value in values))


class Allowed(msgspec.Struct, frozen=True):
    """How fast the law of pace lets it fly now; not there where it flies to no goal."""

    allowed_mps: float | None


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
    allowed: Allowed | None = None
    machine: FsaItem | None = None
    state_grid: Grid = field(default_factory=lambda: Grid(STATE_HZ))
    fsa_sent_ns: int = 0


class VehicleJson(Deriver):
    """The state at 5 Hz; the gate's machine on change, every second and at the end."""

    takes: ClassVar = frozenset({PoseItem, GeodeticItem, StatusItem, FsaItem, ParamItem, StopItem})

    def __init__(self) -> None:
        self._vehicles: dict[int, _Vehicle] = {}

    def handle(self, item: RecordItem, now_ns: int) -> list[Out]:
        match item:
            case PoseItem(sysid):
                vehicle = self._vehicle(sysid)
                vehicle.pose = item
                return _state(vehicle, now_ns)
            case StopItem(sysid, allowed_m_s=allowed_m_s):
                rounded = None if allowed_m_s is None else round(allowed_m_s, DECIMALS)
                self._vehicle(sysid).allowed = Allowed(rounded)
                return []
            case GeodeticItem(sysid):
                self._vehicle(sysid).geodetic = item
                return []
            case StatusItem(sysid):
                vehicle = self._vehicle(sysid)
                vehicle.status = item
                return _state(vehicle, now_ns)
            case FsaItem():
                return self._fsa(item, now_ns)
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
                    *(Motion, GeodeticItem, StatusItem, Allowed),
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
    return [vehicle.state.out(motion, vehicle.geodetic, vehicle.status, vehicle.allowed)]
