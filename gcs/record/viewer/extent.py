"""How large a recorded flight is, so that a viewer's camera, grid and map fit it."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from math import cos, degrees, dist, radians
from pathlib import Path

import msgspec

from gcs.frames import Vec3
from gcs.mcap_file.format import Channel, Message
from gcs.mcap_file.reader import Progress, Reading
from gcs.record.fence_topic import FENCE_TOPIC, read
from gcs.report import FenceItem, FenceShape

EARTH_RADIUS_M = 6_371_000.0
LEAST_RADIUS_M = 3.0
ANY_WIDTH_M, ANY_HEIGHT_M = 20.0, 10.0
FENCE_FACTOR = 4.0
"""A zone that is more times larger than the flight does not decide what is seen."""

_SUFFIXED = re.compile(rb"base_link_(\d+)")
_STATE = re.compile(r"/vehicle/\d+/state")


@dataclass(frozen=True, slots=True)
class Extent:
    """A box, ENU metres, about the flight; `origin` is latitude and longitude of the frame's."""

    low_enu: Vec3
    high_enu: Vec3
    origin_deg: tuple[float, float] | None = None

    @property
    def centre_enu(self) -> Vec3:
        (a, b, c), (d, e, f) = self.low_enu, self.high_enu
        return ((a + d) / 2, (b + e) / 2, (c + f) / 2)

    @property
    def radius_m(self) -> float:
        """Of the ball about the box."""
        return max(LEAST_RADIUS_M, dist(self.low_enu, self.high_enu) / 2)

    @property
    def centre_deg(self) -> tuple[float, float] | None:
        """Latitude and longitude; for a map only: equirectangular about the origin."""
        if self.origin_deg is None:
            return None
        lat_deg, lon_deg = self.origin_deg
        east, north, _ = self.centre_enu
        across_m = EARTH_RADIUS_M * cos(radians(lat_deg))
        return (lat_deg + degrees(north / EARTH_RADIUS_M), lon_deg + degrees(east / across_m))


@dataclass(frozen=True, slots=True)
class Survey:
    """What a layout needs to know of a file.

    `suffixed` are the vehicles whose body frames carry their number.
    """

    topics: frozenset[str]
    extent: Extent | None
    suffixed: frozenset[int]


class _State(msgspec.Struct):
    east_m: float | None = None
    north_m: float | None = None
    up_m: float | None = None


_state = msgspec.json.Decoder(_State)


def survey(path: Path, progress: Progress | None = None) -> Survey:
    """Read the whole file.  Raises BadRecordError and OSError; what does not decode is left out."""
    topics: dict[int, str] = {}
    track: list[Vec3] = []
    fence: FenceItem | None = None
    frames = b""
    for record in Reading(path, progress):
        if isinstance(record, Channel):
            topics[record.id] = record.topic
        elif isinstance(record, Message):
            topic = topics.get(record.channel_id, "")
            if _STATE.fullmatch(topic):
                track += _places(record.data)
            elif topic == FENCE_TOPIC:
                fence = fence_of(record.data) or fence
            elif topic == "/tf_static":
                frames = record.data
    suffixed = frozenset(int(one) for one in _SUFFIXED.findall(frames))
    return Survey(frozenset(topics.values()), extent_of(track, fence), suffixed)


def extent_of(track: Sequence[Vec3], fence: FenceItem | None) -> Extent | None:
    """About the track, and about every zone that is not much larger; None without a track."""
    if not track:
        return None
    low, high = _box(track)
    most_m = FENCE_FACTOR * max(2 * LEAST_RADIUS_M, dist(low, high))
    corners = [low, high]
    for zone in fence.zones if fence is not None else ():
        a, b = _zone_box(zone, low[2], high[2])
        if dist(a, b) <= most_m:
            corners += [a, b]
    low, high = _box(corners)
    origin = None if fence is None or fence.origin is None else fence.origin[:2]
    return Extent(low, high, origin)


def fence_extent(fence: FenceItem | None) -> Extent:
    """About the whole fence, for a viewer that is to fly in it; where none is known, about the
    origin."""
    corners: list[Vec3] = [(0.0, 0.0, 0.0)]
    zones = () if fence is None else fence.zones
    for zone in zones:
        corners += _zone_box(zone, 0.0, ANY_HEIGHT_M)
    if not zones:
        corners += [(-ANY_WIDTH_M, -ANY_WIDTH_M, 0.0), (ANY_WIDTH_M, ANY_WIDTH_M, ANY_HEIGHT_M)]
    origin = None if fence is None or fence.origin is None else fence.origin[:2]
    return Extent(*_box(corners), origin)


def _box(points: Iterable[Vec3]) -> tuple[Vec3, Vec3]:
    east, north, up = zip(*points, strict=True)
    return (min(east), min(north), min(up)), (max(east), max(north), max(up))


def _zone_box(zone: FenceShape, floor_m: float, ceiling_m: float) -> tuple[Vec3, Vec3]:
    """A side without a bound ends where the flight does."""
    floor = floor_m if zone.floor_up_m is None else zone.floor_up_m
    ceiling = ceiling_m if zone.ceiling_up_m is None else zone.ceiling_up_m
    if zone.centre_en is not None:
        (east, north), radius_m = zone.centre_en, zone.radius_m
        outline = [(east - radius_m, north - radius_m), (east + radius_m, north + radius_m)]
    else:
        outline = zone.corners_en or [(0.0, 0.0)]
    return _box((east, north, up) for east, north in outline for up in (floor, ceiling))


def _places(data: bytes) -> list[Vec3]:
    try:
        at = _state.decode(data)
    except msgspec.DecodeError:
        return []
    if at.east_m is None or at.north_m is None or at.up_m is None:
        return []
    return [(at.east_m, at.north_m, at.up_m)]


def fence_of(data: bytes) -> FenceItem | None:
    try:
        return read(data)
    except msgspec.DecodeError:
        return None
