"""Where each vehicle of a log was, for maps."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from gcs.logfile.columns.layout import Records
from gcs.logfile.tables import Table, tables_of
from gcs.mcap_file.errors import BadLogError

PERIOD_NS = 200_000_000
"""Of what comes more often than 5 times a second, one a period is kept."""

_Floats: TypeAlias = NDArray[np.float64]


@dataclass(slots=True)
class Track:
    """One vehicle's path; degrees, metres above mean sea level, ns since 1970."""

    name: str
    time_ns: NDArray[np.int64]
    lat_deg: _Floats
    lon_deg: _Floats
    alt_amsl_m: _Floats

    def __len__(self) -> int:
        return len(self.time_ns)


@dataclass(frozen=True, slots=True)
class _Source:
    """A kind of message that tells a position; numbers are what one unit of its fields is."""

    lat: str
    lon: str
    alt: str
    degrees: float
    metres: float


_SOURCES = {
    # Best first.  MAVLink's, the dataflash log's, and the topics of PX4 1.14 and of older ones.
    "GLOBAL_POSITION_INT": _Source("lat", "lon", "alt", 1e-7, 1e-3),
    "POS": _Source("Lat", "Lng", "Alt", 1.0, 1.0),
    "vehicle_global_position": _Source("lat", "lon", "alt", 1.0, 1.0),
    "GPS_RAW_INT": _Source("lat", "lon", "alt", 1e-7, 1e-3),
    "GPS": _Source("Lat", "Lng", "Alt", 1.0, 1.0),
    "vehicle_gps_position": _Source("latitude_deg", "longitude_deg", "altitude_msl_m", 1.0, 1.0),
    "vehicle_gps_position (old)": _Source("lat", "lon", "alt", 1e-7, 1e-3),
}


def tracks_of(path: Path, progress: Callable[[int], None] | None = None) -> list[Track]:
    """The best source of each vehicle.  Raises BadLogError where there is no position."""
    best: dict[int, tuple[int, list[NDArray[Any]]]] = {}
    """Of each vehicle the rank of its best source, and the points of that."""
    names = {name.partition(" ")[0] for name in _SOURCES}
    names |= {f"{name}_0" for name in names}
    for table in tables_of(path, names, progress):
        rank, source = _source_of(table)
        if source is None:
            continue
        for sysid, rows in _by_vehicle(table.rows):
            points = _not_too_often(_points(rows, source))
            known = best.get(sysid)
            if not len(points):
                continue
            if known is None or rank < known[0]:
                best[sysid] = rank, [points]
            elif rank == known[0]:
                known[1].append(points)
    tracks = [_track(f"vehicle {n}", np.concatenate(best.pop(n)[1])) for n in sorted(best)]
    if not tracks:
        raise BadLogError(path, "there is no position in it")
    return tracks


def _source_of(table: Table) -> tuple[int, _Source | None]:
    for rank, (name, source) in enumerate(_SOURCES.items()):
        # PX4's topics have their instance behind the name.
        plain = table.name.removesuffix("_0") == name.partition(" ")[0]
        names = table.rows.dtype.names or ()
        if plain and {source.lat, source.lon, source.alt} <= set(names):
            return rank, source
    return 0, None


def _by_vehicle(rows: Records) -> list[tuple[int, Records]]:
    if "sysid" not in (rows.dtype.names or ()):
        return [(1, rows)]
    return [(n, rows[rows["sysid"] == n]) for n in np.unique(rows["sysid"]).tolist()]


def _points(rows: Records, source: _Source) -> NDArray[Any]:
    """Those that are a fix."""
    points = np.zeros(len(rows), [("t", "<i8"), ("lat", "f8"), ("lon", "f8"), ("alt", "f8")])
    points["t"] = rows["time_ns"]
    points["lat"] = rows[source.lat] * source.degrees
    points["lon"] = rows[source.lon] * source.degrees
    points["alt"] = rows[source.alt] * source.metres
    good = np.isfinite(points["lat"]) & np.isfinite(points["lon"]) & np.isfinite(points["alt"])
    good &= (abs(points["lat"]) <= 90) & (abs(points["lon"]) <= 180)
    good &= (points["lat"] != 0) | (points["lon"] != 0)
    found: NDArray[Any] = points[good]
    return found


def _not_too_often(points: NDArray[Any]) -> NDArray[Any]:
    """The first in each period.  Of a large log this is done part by part, to bound memory."""
    kept: NDArray[Any] = points[np.diff(points["t"] // PERIOD_NS, prepend=-1) != 0]
    return kept


def _track(name: str, points: NDArray[Any]) -> Track:
    """In order of time, and not more often than `PERIOD_NS`."""
    if (np.diff(points["t"]) < 0).any():
        points = points[np.argsort(points["t"], kind="stable")]
    points = _not_too_often(points)
    return Track(name, points["t"], points["lat"], points["lon"], points["alt"])
