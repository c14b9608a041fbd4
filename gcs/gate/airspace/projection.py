"""Converts geodetic coordinates to local NED and back, as the vehicle itself does.

The vehicle flies in local coordinates that it projected itself, so the gate has to project in the
same way.  The WGS84 ellipsoid would be more accurate, but two to three metres per kilometre away
from what the vehicle flies.

px4: azimuthal equidistant projection about the origin on a sphere of 6,371,000 m (J. P. Snyder,
Map Projections: A Working Manual, 1987, equations 5-3, 25-2 to 25-4, 20-14 and 20-15).
ardupilot: 0.011131884502145034 m per 1e-7 degree, longitude scaled by the cosine of the mean
latitude.

Down is metres below the origin's altitude, both above mean sea level.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from gcs.frames import Vec3

SPHERE_RADIUS_M = 6_371_000.0
FLAT_TO_DEG = 85.0
METRES_PER_DEGREE = 0.011131884502145034 * 1.0e7


@dataclass(frozen=True, slots=True)
class Origin:
    """GPS_GLOBAL_ORIGIN: where local NED is (0, 0, 0)."""

    lat_deg: float
    lon_deg: float
    alt_amsl_m: float


@dataclass(frozen=True, slots=True)
class Projection:
    """`autopilot` "ardupilot" projects as ardupilot does, every other as px4 does."""

    origin: Origin
    autopilot: str

    def north_east(self, lat_deg: float, lon_deg: float) -> tuple[float, float]:
        """Metres north and east of the origin."""
        if self.autopilot == "ardupilot":
            return _flat_forward(self.origin, lat_deg, lon_deg)
        return _azimuthal_forward(self.origin, lat_deg, lon_deg)

    def lat_lon(self, north_m: float, east_m: float) -> tuple[float, float]:
        """Degrees; longitude in [-180, 180]."""
        if self.autopilot == "ardupilot":
            return _flat_inverse(self.origin, north_m, east_m)
        return _azimuthal_inverse(self.origin, north_m, east_m)

    def holds_at(self, lat_deg: float) -> bool:
        """Is the vehicle's own map true there?

        ArduPilot's is flat and ends at the meridian opposite its origin, which is near at a pole.
        Up to FLAT_TO_DEG that meridian is more than 1500 km away.
        """
        return self.autopilot != "ardupilot" or abs(lat_deg) <= FLAT_TO_DEG

    def ned_from_geodetic(self, lat_deg: float, lon_deg: float, alt_amsl_m: float) -> Vec3:
        north_m, east_m = self.north_east(lat_deg, lon_deg)
        return (north_m, east_m, self.origin.alt_amsl_m - alt_amsl_m)

    def geodetic_from_ned(self, pos_ned: Vec3) -> tuple[float, float, float]:
        """Latitude and longitude in degrees, altitude in metres above mean sea level."""
        lat_deg, lon_deg = self.lat_lon(pos_ned[0], pos_ned[1])
        return (lat_deg, lon_deg, self.origin.alt_amsl_m - pos_ned[2])


def _wrapped(lon_deg: float) -> float:
    return math.remainder(lon_deg, 360.0)


def _azimuthal_forward(origin: Origin, lat_deg: float, lon_deg: float) -> tuple[float, float]:
    lat0, lat = math.radians(origin.lat_deg), math.radians(lat_deg)
    dlon = math.radians(lon_deg - origin.lon_deg)
    # The unit vector to the point, in the origin's north, east and up.  The length of its
    # horizontal part is sin c; the arc cosine of `up`, close to 1, would lose precision.
    north = math.cos(lat0) * math.sin(lat) - math.sin(lat0) * math.cos(lat) * math.cos(dlon)
    east = math.cos(lat) * math.sin(dlon)
    up = math.sin(lat0) * math.sin(lat) + math.cos(lat0) * math.cos(lat) * math.cos(dlon)
    sin_c = math.hypot(north, east)
    scale = SPHERE_RADIUS_M * (math.atan2(sin_c, up) / sin_c if sin_c > 0.0 else 1.0)
    return (north * scale, east * scale)


def _azimuthal_inverse(origin: Origin, north_m: float, east_m: float) -> tuple[float, float]:
    lat0 = math.radians(origin.lat_deg)
    rho_m = math.hypot(north_m, east_m)
    if rho_m == 0.0:
        return (origin.lat_deg, origin.lon_deg)
    c = rho_m / SPHERE_RADIUS_M
    north, east, up = math.sin(c) * north_m / rho_m, math.sin(c) * east_m / rho_m, math.cos(c)
    lat = math.asin(min(1.0, max(-1.0, up * math.sin(lat0) + north * math.cos(lat0))))
    dlon = math.atan2(east, up * math.cos(lat0) - north * math.sin(lat0))
    return (math.degrees(lat), _wrapped(origin.lon_deg + math.degrees(dlon)))


def _flat_forward(origin: Origin, lat_deg: float, lon_deg: float) -> tuple[float, float]:
    mean_lat = math.radians(0.5 * (origin.lat_deg + lat_deg))
    north_m = (lat_deg - origin.lat_deg) * METRES_PER_DEGREE
    east_m = _wrapped(lon_deg - origin.lon_deg) * METRES_PER_DEGREE * _longitude_scale(mean_lat)
    return (north_m, east_m)


def _flat_inverse(origin: Origin, north_m: float, east_m: float) -> tuple[float, float]:
    lat_deg = origin.lat_deg + north_m / METRES_PER_DEGREE
    mean_lat = math.radians(0.5 * (origin.lat_deg + lat_deg))
    dlon_deg = east_m / (METRES_PER_DEGREE * _longitude_scale(mean_lat))
    return (lat_deg, _wrapped(origin.lon_deg + dlon_deg))


def _longitude_scale(lat_rad: float) -> float:
    """The cosine of the latitude, at least 0.01 as in the vehicle: it is zero at the poles."""
    return max(math.cos(lat_rad), 0.01)
