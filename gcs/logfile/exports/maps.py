"""The paths of the vehicles of a log as KML 2.2 and as GPX 1.1; heights above mean sea level."""

from __future__ import annotations

from collections.abc import Iterator
from xml.sax.saxutils import escape

import numpy as np

from gcs.logfile.exports.track import Track
from gcs.mcap_file.batch_writer import Sink

_POINTS = 10_000


def write_kml(title: str, tracks: list[Track], target: Sink) -> None:
    """For each vehicle its path as a line, and the same with times (`gx:Track`)."""
    target.write(
        '<?xml version="1.0" encoding="UTF-8"?>\n'
        '<kml xmlns="http://www.opengis.net/kml/2.2"'
        ' xmlns:gx="http://www.google.com/kml/ext/2.2">\n'
        f"<Document><name>{escape(title)}</name>\n".encode()
    )
    for track in tracks:
        target.write(
            f"<Placemark><name>{track.name}</name><LineString>"
            "<altitudeMode>absolute</altitudeMode><coordinates>\n".encode()
        )
        for part in _parts(track):
            lines = (f"{lon},{lat},{alt}\n" for lat, lon, alt in _places(part))
            target.write("".join(lines).encode())
        target.write(b"</coordinates></LineString></Placemark>\n")
        target.write(
            f"<Placemark><name>{track.name}, with times</name><gx:Track>"
            "<altitudeMode>absolute</altitudeMode>\n".encode()
        )
        for part in _parts(track):
            target.write("".join(f"<when>{each}</when>\n" for each in _times(part)).encode())
        for part in _parts(track):
            lines = (f"<gx:coord>{lon} {lat} {alt}</gx:coord>\n" for lat, lon, alt in _places(part))
            target.write("".join(lines).encode())
        target.write(b"</gx:Track></Placemark>\n")
    target.write(b"</Document></kml>\n")


def write_gpx(title: str, tracks: list[Track], target: Sink) -> None:
    """For each vehicle a track."""
    target.write(
        '<?xml version="1.0" encoding="UTF-8"?>\n'
        '<gpx version="1.1" creator="mavgate" xmlns="http://www.topografix.com/GPX/1/1">\n'
        f"<metadata><name>{escape(title)}</name></metadata>\n".encode()
    )
    for track in tracks:
        target.write(f"<trk><name>{track.name}</name><trkseg>\n".encode())
        for part in _parts(track):
            points = (
                f'<trkpt lat="{lat}" lon="{lon}"><ele>{alt}</ele><time>{when}</time></trkpt>\n'
                for (lat, lon, alt), when in zip(_places(part), _times(part), strict=True)
            )
            target.write("".join(points).encode())
        target.write(b"</trkseg></trk>\n")
    target.write(b"</gpx>\n")


def _parts(track: Track) -> Iterator[Track]:
    """Texts of a long path take more memory than the path."""
    for first in range(0, len(track), _POINTS):
        part = slice(first, first + _POINTS)
        yield Track(
            track.name,
            track.time_ns[part],
            track.lat_deg[part],
            track.lon_deg[part],
            track.alt_amsl_m[part],
        )


def _places(track: Track) -> Iterator[tuple[str, str, str]]:
    """Latitude, longitude, height."""
    for lat, lon, alt in zip(
        track.lat_deg.tolist(), track.lon_deg.tolist(), track.alt_amsl_m.tolist(), strict=True
    ):
        yield f"{lat:.7f}", f"{lon:.7f}", f"{alt:.2f}"


def _times(track: Track) -> list[str]:
    """ISO 8601, UTC."""
    times: list[str] = np.datetime_as_string(
        track.time_ns.astype("datetime64[ns]"), unit="ms", timezone="UTC"
    ).tolist()
    return times
