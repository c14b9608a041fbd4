"""Two flights beside each other: their figures, where they went, what went wrong, parameters.

Times count from each one's take-off.  Places are in the first one's local frame, where both records
know where on the earth their own is; else each is taken as it stands.
"""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Callable, Iterable, Iterator, Sequence
from math import isclose
from typing import TypeAlias

import msgspec

from gcs.flight_report.charts import Chart, ChartData, charts_of
from gcs.flight_report.flight import VehicleFlight
from gcs.flight_report.scene import scene_of_tracks
from gcs.flight_report.series import BREAK_S, Series
from gcs.flight_report.track import Track, TrackPoint
from gcs.frames import Vec3

MAX_PARAMETERS = 200

_Read: TypeAlias = Callable[[VehicleFlight], "float | None"]


class Figure(msgspec.Struct):
    """None is not known; `difference` is the second less the first."""

    name: str
    unit: str
    a: float | None
    b: float | None
    difference: float | None


class ParameterPair(msgspec.Struct):
    name: str
    a: float
    b: float


class Comparison(msgspec.Struct):
    a: str
    """The files."""
    b: str
    figures: list[Figure]
    paths_apart_m: float | None
    """The farthest that a place of the second path is from the first path."""
    same_frame: bool
    """Both records know where on the earth their local frame is."""
    only_in_a: list[str]
    """What went wrong in one of them alone."""
    only_in_b: list[str]
    parameters: list[ParameterPair]
    """That differ, of those that both records have."""


def compare(names: tuple[str, str], a: VehicleFlight, b: VehicleFlight) -> Comparison:
    shift = _shift(a, b)
    wrong_a, wrong_b = ([f.title for f in v.went_wrong] for v in (a, b))
    return Comparison(
        *names,
        [_figure(name, unit, read(a), read(b)) for name, unit, read in _FIGURES],
        _apart_m(a.track, _moved(b, shift or (0.0, 0.0))),
        shift is not None,
        [title for title in dict.fromkeys(wrong_a) if title not in wrong_b],
        [title for title in dict.fromkeys(wrong_b) if title not in wrong_a],
        list(_parameters(a, b))[:MAX_PARAMETERS],
    )


def compared_charts(a: VehicleFlight, b: VehicleFlight) -> ChartData:
    """Each plot that both have something for, the second's lines dashed; both paths."""
    begins = _begin_s(a), _begin_s(b)
    theirs = {chart.id: chart for chart in charts_of(b) if chart.lines}
    charts = []
    for chart in charts_of(a):
        other = theirs.get(chart.id)
        if chart.lines and other is not None:
            charts.append(_over_each_other(chart, other, begins))
    last_s = max((chart.x[-1] for chart in charts if chart.x), default=1.0)
    moved = _moved(b, _shift(a, b) or (0.0, 0.0))
    scene = scene_of_tracks([("A", a.track, a.plan), ("B", moved, [])])
    if scene is not None:
        for track in scene.tracks:
            track.colour = "--c1" if track.name == "A" else "--c2"
    return ChartData(round(last_s, 2), charts, scene)


# ----------------------------------------------------------------------------------- figures


def _extreme(plot: str, columns: Sequence[int], of: Callable[[Iterable[float]], float]) -> _Read:
    """The largest or smallest value in the air: a series keeps both whatever it leaves out."""

    def read(vehicle: VehicleFlight) -> float | None:
        series: Series = (
            vehicle.plots.sampled[plot].series
            if plot in vehicle.plots.sampled
            else getattr(vehicle.plots, plot)
        )
        begin_s = vehicle.totals.took_off_s
        end_s = vehicle.totals.landed_s
        values = [
            row[column]
            for t_s, row in series.rows()
            for column in columns
            if (begin_s is None or t_s >= begin_s) and (end_s is None or t_s <= end_s)
        ]
        known = [value for value in values if value is not None]
        return of(known) if known else None

    return read


def _largest(values: Iterable[float]) -> float:
    return max(map(abs, values))


def _used_pct(vehicle: VehicleFlight) -> float | None:
    left = vehicle.totals.remaining_pct
    return None if left is None else left[0] - left[1]


_FIGURES: tuple[tuple[str, str, _Read], ...] = (
    ("in the air", "s", lambda v: v.totals.flying_s),
    ("flown", "m", lambda v: v.track.length_m),
    ("highest", "m", lambda v: v.totals.max_up_m),
    ("farthest", "m", lambda v: v.totals.max_distance_m),
    ("fastest", "m/s", lambda v: v.totals.max_speed_mps),
    ("battery used", "%", _used_pct),
    ("lowest voltage", "V", _extreme("battery", (0,), min)),
    ("largest roll", "°", _extreme("attitude", (0,), _largest)),
    ("largest pitch", "°", _extreme("attitude", (1,), _largest)),
    ("motor that gave most", "%", _extreme("motors", range(8), max)),
    ("strongest wind", "m/s", _extreme("wind", (0,), max)),
    ("most vibration", "", _extreme("vibration", range(3), max)),
    ("fewest satellites", "", _extreme("gps", (0,), min)),
    ("worst HDOP", "", _extreme("gps", (1,), max)),
    ("estimator's worst ratio", "", _extreme("estimator", range(4), max)),
    ("most messages lost", "%", _extreme("link", (1,), max)),
)


def _figure(name: str, unit: str, a: float | None, b: float | None) -> Figure:
    return Figure(name, unit, a, b, None if a is None or b is None else b - a)


def _parameters(a: VehicleFlight, b: VehicleFlight) -> Iterator[ParameterPair]:
    for name in sorted(a.parameters.keys() & b.parameters.keys()):
        one, other = a.parameters[name].value, b.parameters[name].value
        if one is not None and other is not None and not isclose(one, other, rel_tol=1e-6):
            yield ParameterPair(name, one, other)


# ------------------------------------------------------------------------------------- places


def _shift(a: VehicleFlight, b: VehicleFlight) -> tuple[float, float] | None:
    """East and north of the second's local origin in the first's frame."""
    if a.anchor is None or b.anchor is None:
        return None
    east, north = a.anchor.east_north_of(b.anchor.fix.lat_deg, b.anchor.fix.lon_deg)
    return east - b.anchor.enu[0], north - b.anchor.enu[1]


def _moved(vehicle: VehicleFlight, shift: tuple[float, float]) -> Track:
    def moved(enu: Vec3) -> Vec3:
        return (enu[0] + shift[0], enu[1] + shift[1], enu[2])

    points = [TrackPoint(p.t_s, moved(p.enu), p.piece) for p in vehicle.track.points]
    return Track(points, vehicle.track.length_m)


def _apart_m(a: Track, b: Track) -> float | None:
    """From each kept place of `b` to the nearest line of `a`; of the places the farthest."""
    import numpy as np

    line = [point.enu for piece in a.drawn() for point in piece]
    places = [point.enu for piece in b.drawn() for point in piece]
    if len(line) < 2 or not places:
        return None
    begins = np.array(line[:-1])
    ways = np.array(line[1:]) - begins
    lengths = np.maximum((ways**2).sum(axis=1), 1e-9)
    farthest_m = 0.0
    for place in places:
        share = np.clip(((place - begins) * ways).sum(axis=1) / lengths, 0.0, 1.0)
        nearest = begins + share[:, None] * ways
        farthest_m = max(farthest_m, float(np.sqrt(((place - nearest) ** 2).sum(axis=1).min())))
    return farthest_m


# -------------------------------------------------------------------------------------- plots


def _begin_s(vehicle: VehicleFlight) -> float:
    totals = vehicle.totals
    return totals.took_off_s if totals.took_off_s is not None else totals.first_armed_s or 0.0


def _over_each_other(a: Chart, b: Chart, begins: tuple[float, float]) -> Chart:
    """Both on one time axis; what was wanted is left out."""
    times_a, times_b = ([t - begin for t in c.x] for c, begin in zip((a, b), begins, strict=True))
    grid = sorted({round(t, 2) for t in (*times_a, *times_b)})
    a.about = f"{a.about.split('; dashed')[0]}; dashed: B"
    lines = []
    for chart, times, name in ((a, times_a, "A"), (b, times_b, "B")):
        for line in chart.lines:
            if line.label.endswith("wanted") or line.label == "goal":
                continue
            values = _on(grid, times, line.values)
            own = msgspec.structs.replace(line, label=f"{line.label} {name}", values=values)
            own.dashed, own.dots = name == "B", False
            lines.append(own)
    a.x, a.lines, a.marks = grid, lines, []
    return a


def _on(grid: list[float], times: list[float], values: list[float | None]) -> list[float | None]:
    """The values at other times: on the line between two that are not too far apart."""
    found: list[float | None] = []
    for t_s in grid:
        after = bisect_right(times, t_s + 0.006)
        if not after:
            found.append(None)
            continue
        t0, v0 = times[after - 1], values[after - 1]
        if after == len(times) or t_s <= t0:
            found.append(v0 if abs(t_s - t0) <= 0.01 else None)
            continue
        t1, v1 = times[after], values[after]
        if v0 is None or v1 is None or t1 - t0 > BREAK_S:
            found.append(None)
        else:
            found.append(round(v0 + (v1 - v0) * (t_s - t0) / (t1 - t0), 3))
    return found
