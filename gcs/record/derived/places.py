"""What a map shows: /vehicle/N/location and /origin.

A LocationFix is the place of the origin of its frame: of `base_link` for a vehicle, of `map` for
the local origin that GPS_GLOBAL_ORIGIN tells.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import ClassVar

from foxglove.messages import LocationFix, LocationFixPositionCovarianceType

from gcs.mcap_file.writer import Channel
from gcs.record.derived.body_frames import FrameNames
from gcs.record.derived.drawing import channel, stamp
from gcs.record.topics import Deriver, Grid, Out
from gcs.report import FenceItem, GeodeticItem, RecordItem

LOCATION_HZ = 5.0


@dataclass(slots=True)
class _Vehicle:
    location: Channel
    grid: Grid = field(default_factory=lambda: Grid(LOCATION_HZ))


class Places(Deriver):
    """Fixes at 5 Hz; the origin when it is known, and when it moves."""

    takes: ClassVar = frozenset({GeodeticItem, FenceItem})

    def __init__(self, names: FrameNames) -> None:
        self._names = names
        self._vehicles: dict[int, _Vehicle] = {}
        self._origin = channel("/origin", LocationFix.get_schema())
        self._told: tuple[float, float, float] | None = None

    def handle(self, item: RecordItem, now_ns: int) -> list[Out]:
        match item:
            case GeodeticItem(sysid, lat_deg, lon_deg, alt_amsl_m):
                vehicle = self._vehicles.get(sysid)
                if vehicle is None:
                    location = channel(f"/vehicle/{sysid}/location", LocationFix.get_schema())
                    vehicle = self._vehicles[sysid] = _Vehicle(location)
                if not vehicle.grid.due(now_ns):
                    return []
                frame_id = self._names.of(sysid).flu
                fix = _fix(frame_id, (lat_deg, lon_deg, alt_amsl_m), now_ns)
                return [Out(vehicle.location, fix.encode())]
            case FenceItem(origin=origin) if origin is not None and origin != self._told:
                self._told = origin
                return [Out(self._origin, _fix("map", origin, now_ns).encode(), latch="origin")]
            case _:
                return []


def _fix(frame_id: str, at: tuple[float, float, float], now_ns: int) -> LocationFix:
    latitude, longitude, altitude = at
    return LocationFix(
        timestamp=stamp(now_ns),
        frame_id=frame_id,
        latitude=latitude,
        longitude=longitude,
        altitude=altitude,
        position_covariance_type=LocationFixPositionCovarianceType.Unknown,
    )
