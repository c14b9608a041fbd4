"""The vehicle's own map projection: geodetic <-> local NED about the estimator's origin.

Each personality projects as its autopilot does, so that positions agree with it to the
millimetre; on the WGS84 ellipsoid instead they would be 2-3 m off per kilometre.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import acos, asin, atan2, cos, degrees, radians, sin, sqrt
from typing import Final, Protocol

from vehicle_sim.autopilot.interface import Geodetic
from vehicle_sim.autopilot.modes import Personality
from vehicle_sim.numerics.vectors import Vec3

_PX4_EARTH_M = 6_371_000.0
_ARDUPILOT_M_PER_E7 = 0.011131884502145034


class Projection(Protocol):
    """Degrees and metres above mean sea level <-> metres north, east, down of the origin."""

    def to_local(self, where: Geodetic) -> Vec3: ...
    def to_geodetic(self, pos_ned: Vec3) -> Geodetic: ...


class AzimuthalEquidistant:
    """PX4's MapProjection: a sphere of 6,371,000 m (Snyder, Map Projections, eq. 25-1..25-4)."""

    __slots__ = ("_cos_lat", "_lat", "_lon", "_origin", "_sin_lat")

    def __init__(self, origin: Geodetic) -> None:
        self._origin = origin
        self._lat = radians(origin.lat_deg)
        self._lon = radians(origin.lon_deg)
        self._sin_lat = sin(self._lat)
        self._cos_lat = cos(self._lat)

    def to_local(self, where: Geodetic) -> Vec3:
        lat = radians(where.lat_deg)
        turn = radians(where.lon_deg) - self._lon
        sin_lat, cos_lat, cos_turn = sin(lat), cos(lat), cos(turn)
        c = self._sin_lat * sin_lat + self._cos_lat * cos_lat * cos_turn
        arc = acos(max(-1.0, min(1.0, c)))
        k = arc / sin(arc) if arc > 0.0 else 1.0
        north = k * (self._cos_lat * sin_lat - self._sin_lat * cos_lat * cos_turn) * _PX4_EARTH_M
        east = k * cos_lat * sin(turn) * _PX4_EARTH_M
        return (north, east, self._origin.alt_amsl_m - where.alt_amsl_m)

    def to_geodetic(self, pos_ned: Vec3) -> Geodetic:
        x = pos_ned[0] / _PX4_EARTH_M
        y = pos_ned[1] / _PX4_EARTH_M
        alt_amsl_m = self._origin.alt_amsl_m - pos_ned[2]
        arc = sqrt(x * x + y * y)
        if arc == 0.0:
            return Geodetic(self._origin.lat_deg, self._origin.lon_deg, alt_amsl_m)
        sin_c, cos_c = sin(arc), cos(arc)
        lat = asin(cos_c * self._sin_lat + x * sin_c * self._cos_lat / arc)
        lon = self._lon + atan2(y * sin_c, arc * self._cos_lat * cos_c - x * self._sin_lat * sin_c)
        return Geodetic(degrees(lat), degrees(lon), alt_amsl_m)


@dataclass(slots=True, eq=False, repr=False)
class MeanLatitude:
    """ArduPilot's Location: a fixed length per 1e-7 degree, longitude by the mean latitude."""

    _origin: Geodetic

    def to_local(self, where: Geodetic) -> Vec3:
        origin = self._origin
        scale = cos(radians(0.5 * (where.lat_deg + origin.lat_deg)))
        east_e7 = _wrap_e7((where.lon_deg - origin.lon_deg) * 1e7)
        return (
            (where.lat_deg - origin.lat_deg) * 1e7 * _ARDUPILOT_M_PER_E7,
            east_e7 * _ARDUPILOT_M_PER_E7 * scale,
            origin.alt_amsl_m - where.alt_amsl_m,
        )

    def to_geodetic(self, pos_ned: Vec3) -> Geodetic:
        origin = self._origin
        lat_deg = origin.lat_deg + pos_ned[0] / _ARDUPILOT_M_PER_E7 * 1e-7
        scale = cos(radians(0.5 * (lat_deg + origin.lat_deg)))
        lon_deg = origin.lon_deg + pos_ned[1] / (_ARDUPILOT_M_PER_E7 * scale) * 1e-7
        return Geodetic(lat_deg, lon_deg, origin.alt_amsl_m - pos_ned[2])


def _wrap_e7(turn_e7: float) -> float:
    if turn_e7 > 1.8e9:
        return turn_e7 - 3.6e9
    if turn_e7 < -1.8e9:
        return turn_e7 + 3.6e9
    return turn_e7


_PROJECTIONS: Final[dict[Personality, Callable[[Geodetic], Projection]]] = {
    "px4": AzimuthalEquidistant,
    "ardupilot": MeanLatitude,
}


def projection(personality: Personality, origin: Geodetic) -> Projection:
    """The projection that the autopilot uses about `origin`."""
    return _PROJECTIONS[personality](origin)
