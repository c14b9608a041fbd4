"""Places and heights of a client's message in the vehicle's local NED frame.

Three data are never mixed: local z counts from the origin, a relative height from home, and AMSL
from mean sea level.  Heights above terrain are refused: there is no terrain data here.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from enum import Enum
from typing import Final, assert_never

from gcs.bridge.translate.meaning import Seen
from gcs.frames import Vec3
from gcs.gate.airspace.projection import Projection
from gcs.gate.refusal import Code, Refusal
from gcs.wire.ids import MavFrame

UNSET: Final = 0x7FFFFFFF
"""INT32_MAX: a coordinate that is not given (MAVLink, COMMAND_INT)."""
DEGREES_PER_UNIT: Final = 1e-7


class Datum(Enum):
    """What a height is counted from."""

    SEA = "mean sea level"
    HOME = "home"


_DATA: Final[Mapping[int, Datum]] = {
    MavFrame.GLOBAL: Datum.SEA,
    MavFrame.GLOBAL_INT: Datum.SEA,
    MavFrame.GLOBAL_RELATIVE_ALT: Datum.HOME,
    MavFrame.GLOBAL_RELATIVE_ALT_INT: Datum.HOME,
}
_TERRAIN: Final = frozenset({MavFrame.GLOBAL_TERRAIN_ALT, MavFrame.GLOBAL_TERRAIN_ALT_INT})


def datum_of(frame: int) -> Datum | Refusal:
    """Of a MAV_FRAME with latitude and longitude."""
    if frame in _TERRAIN:
        return Refusal(
            Code.UNSUPPORTED, "a height above terrain cannot be verified: no terrain data"
        )
    datum = _DATA.get(frame)
    if datum is None:
        return Refusal(Code.UNSUPPORTED, f"frame {frame} is not one for a place on the map")
    return datum


def down_of(seen: Seen, height_m: float, datum: Datum) -> float | Refusal:
    """Metres below the origin.  A height that is not finite stays so, for the gate to refuse."""
    match datum:
        case Datum.SEA:
            if seen.origin is None:
                return Refusal(
                    Code.NO_ORIGIN, "a height above sea level needs the vehicle's origin"
                )
            return seen.origin.alt_amsl_m - height_m
        case Datum.HOME:
            if seen.origin is not None and seen.home_amsl_m is not None:
                return seen.origin.alt_amsl_m - (seen.home_amsl_m + height_m)
            if seen.home_ned is not None:
                return seen.home_ned[2] - height_m
            return Refusal(Code.NO_ORIGIN, "a height above home needs the vehicle's home position")
        case _:
            assert_never(datum)


def place_of(
    seen: Seen, lat_deg: float, lon_deg: float, height_m: float, datum: Datum
) -> Vec3 | Refusal:
    """A place on the map, with the vehicle's own projection.

    Latitude and longitude both NaN: where the vehicle is.  Height NaN: the height where it is.
    """
    stays, level = math.isnan(lat_deg) and math.isnan(lon_deg), math.isnan(height_m)
    here = seen.pos_ned
    if here is None and (stays or level):
        return Refusal(Code.NO_POSITION, "where the vehicle is now is not known")
    if stays:
        assert here is not None
        north_m, east_m = here[0], here[1]
    else:
        flat = north_east_of(seen, lat_deg, lon_deg)
        if isinstance(flat, Refusal):
            return flat
        north_m, east_m = flat
    if level:
        assert here is not None
        return (north_m, east_m, here[2])
    down_m = down_of(seen, height_m, datum)
    return down_m if isinstance(down_m, Refusal) else (north_m, east_m, down_m)


def north_east_of(seen: Seen, lat_deg: float, lon_deg: float) -> tuple[float, float] | Refusal:
    """Metres north and east of the origin."""
    if not (abs(lat_deg) <= 90.0 and abs(lon_deg) <= 180.0):
        known = math.isfinite(lat_deg) and math.isfinite(lon_deg)
        return Refusal(
            Code.BAD_PARAMETER if known else Code.NON_FINITE,
            f"{lat_deg:g}, {lon_deg:g} is no place on the map",
            (("lat_deg", lat_deg), ("lon_deg", lon_deg)),
        )
    if seen.origin is None:
        return Refusal(Code.NO_ORIGIN, "a place on the map needs the vehicle's origin")
    return Projection(seen.origin, seen.autopilot.name).north_east(lat_deg, lon_deg)


def rotated(vector: Vec3, heading_rad: float) -> Vec3:
    """Forward, right, down of a level frame with this heading, as north, east, down."""
    forward, right, down = vector
    cos, sin = math.cos(heading_rad), math.sin(heading_rad)
    return (cos * forward - sin * right, sin * forward + cos * right, down)
