"""The plots of the page: which there are, and their numbers for the script that draws them."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from math import atan2, cos, degrees, radians, sin

import msgspec

from gcs.flight_report.findings.limits import BAD, FAIR, HDOP_BAD, REJECTED
from gcs.flight_report.flight import Flight, VehicleFlight
from gcs.flight_report.sampled import MOTORS, MOTORS_OF, WANTED
from gcs.flight_report.scene import Scene, scene_of
from gcs.flight_report.series import Series

MAX_MARKS = 40


class Line(msgspec.Struct):
    """One line of a plot; `axis` 1 is the second scale, at the right."""

    label: str
    unit: str
    values: list[float | None] = []
    axis: int = 0
    steps: bool = False
    dots: bool = False
    dashed: bool = False
    column: int = -1
    """Of the series; else its place among the lines."""


class LimitLine(msgspec.Struct):
    """A horizontal line; drawn where it is in sight."""

    value: float
    level: str
    axis: int = 0


class Mark(msgspec.Struct):
    """A finding in every plot."""

    t_s: float
    level: str


class Chart(msgspec.Struct):
    id: str
    title: str
    about: str
    x: list[float] = []
    lines: list[Line] = []
    limits: list[LimitLine] = []
    low: float | None = None
    """The first scale begins here, whatever the values."""
    right_to: float | None = None
    """The second scale reaches at least so far."""
    circle: bool = False
    """Degrees of a heading, which may be drawn beyond 0 and 360."""
    vehicle: int = 0
    marks: list[Mark] = []


class ChartData(msgspec.Struct):
    seconds: float
    charts: list[Chart]
    scene: Scene | None = None


def chart_data(flight: Flight, vehicles: Sequence[VehicleFlight]) -> ChartData:
    """Only plots that have something to draw."""
    charts = []
    for vehicle in vehicles:
        marks = [Mark(round(f.t_s, 2), f.level.value) for f in vehicle.went_wrong[:MAX_MARKS]]
        for chart in charts_of(vehicle):
            if chart.lines:
                chart.vehicle, chart.marks = vehicle.sysid, marks
                charts.append(chart)
    return ChartData(round(flight.seconds, 2), charts, scene_of(flight, vehicles))


def charts_of(vehicle: VehicleFlight) -> list[Chart]:
    plots, autopilot = vehicle.plots, vehicle.autopilot
    rejected = REJECTED.get(autopilot, REJECTED["px4"]).value
    kind = autopilot if autopilot in FAIR else "ardupilot"
    dilution = HDOP_BAD.get(autopilot, HDOP_BAD["px4"]).value
    fair, bad = FAIR[kind].value, BAD[kind].value
    shaken = f"good below {fair:g}, bad above {bad:g} m/s²"
    if kind == "px4":
        shaken += "; PX4 sends the accelerometers' in z, the gyroscopes' in x and y"
    return [
        _chart(
            Chart("height", "Height", "above the local origin; dashed: of the goal"),
            plots.height,
            Line("height", "m"),
            Line("goal", "m", steps=True, dashed=True),
        ),
        _chart(
            Chart("speed", "Speed", "over ground, and climbing"),
            plots.speed,
            Line("over ground", "m/s"),
            Line("climb", "m/s"),
        ),
        *_sampled(vehicle),
        _chart(
            Chart("battery", "Battery", "voltage; what is left, and the current", right_to=100.0),
            plots.battery,
            Line("voltage", "V"),
            Line("left", "%", axis=1),
            Line("current", "A", axis=1, dashed=True),
        ),
        _chart(
            Chart(
                "link",
                "Link",
                "messages of the vehicle a second, and how many were lost",
                low=0.0,
                right_to=10.0,
            ),
            plots.link,
            Line("messages", "/s"),
            Line("lost", "%", axis=1),
        ),
        _chart(
            Chart(
                "gps",
                "GPS",
                f"satellites; HDOP, bad above {dilution:g}",
                limits=[LimitLine(dilution, "warning", 1)],
                low=0.0,
                right_to=1.25 * dilution,
            ),
            plots.gps,
            Line("satellites", "", steps=True),
            Line("HDOP", "", axis=1),
        ),
        _chart(
            Chart(
                "estimator",
                "Estimator",
                f"how far measurements are from what it expects; bad above {rejected:g}",
                limits=[LimitLine(rejected, "warning")],
                low=0.0,
            ),
            plots.estimator,
            *(Line(name, "") for name in plots.estimator.names),
        ),
        _chart(
            Chart(
                "vibration",
                "Vibration",
                shaken,
                limits=[LimitLine(fair, "note"), LimitLine(bad, "critical")],
                low=0.0,
            ),
            plots.vibration,
            Line("x", ""),
            Line("y", ""),
            Line("z", "m/s²"),
        ),
    ]


def _sampled(vehicle: VehicleFlight) -> Iterator[Chart]:
    """What is measured beside what was wanted of it; motors, sticks, wind."""
    series = {plot: sampled.series for plot, sampled in vehicle.plots.sampled.items()}
    place = Chart("place", "Place", "of the local origin; dashed: where it was to be")
    pairs = (("east", 0), ("north", 1), ("east wanted", 3), ("north wanted", 4))
    yield _chart(place, series["place"], *_wanted("m", pairs))
    for number, (axis, about) in enumerate(
        (("roll", "to the right"), ("pitch", "up"), ("yaw", "clockwise from north"))
    ):
        columns = ((axis, number), (f"{axis} wanted", number + WANTED))
        turns = axis == "yaw"
        chart = Chart(axis, axis.capitalize(), f"{about}; dashed: what was wanted", circle=turns)
        drawn = _chart(chart, series["attitude"], *_wanted("°", columns, dots=turns))
        yield _turned(drawn) if turns else drawn
        rate = Chart(f"{axis}-rate", f"{axis.capitalize()} rate", "dashed: what was wanted")
        yield _chart(rate, series["rates"], *_wanted("°/s", columns))
    motors = Chart("motors", "Motors", "what each is told to give", low=0.0)
    turning = MOTORS_OF.get(vehicle.kind, MOTORS)
    names = ((name, column) for column, name in enumerate(series["motors"].names[:turning]))
    yield _chart(motors, series["motors"], *(Line(name, "%", column=c) for name, c in names))
    sticks = Chart("sticks", "Sticks", "of the pilot")
    names = ((name, column) for column, name in enumerate(series["sticks"].names))
    yield _chart(sticks, series["sticks"], *(Line(name, "%", column=c) for name, c in names))
    wind = Chart("wind", "Wind", "as the vehicle reckons it; where it comes from", low=0.0)
    yield _chart(
        wind,
        series["wind"],
        Line("speed", "m/s", column=0),
        Line("from", "°", axis=1, dots=True, column=1),
    )


def _wanted(unit: str, columns: Iterable[tuple[str, int]], *, dots: bool = False) -> Iterator[Line]:
    for name, column in columns:
        dashed = name.endswith("wanted")
        yield Line(name, unit, dashed=dashed, dots=dots and not dashed, column=column)


def _turned(chart: Chart) -> Chart:
    """Cut where the vehicle looks least, so that a heading about north is one line and not two."""
    turns = [radians(value) for line in chart.lines for value in line.values if value is not None]
    middle = degrees(atan2(sum(map(sin, turns)), sum(map(cos, turns))))
    for line in chart.lines:
        line.values = [
            None if value is None else round(middle + (value - middle + 180.0) % 360.0 - 180.0, 1)
            for value in line.values
        ]
    return chart


def _chart(chart: Chart, series: Series, *lines: Line) -> Chart:
    """With its values, and without the lines that have none at all."""
    rows = series.rows()
    for number, line in enumerate(lines):
        column = line.column if line.column >= 0 else number
        line.values = [_rounded(values[column]) for _, values in rows]
        # Noughts throughout are no wish that was told.
        wish = line.label.endswith("wanted")
        if any(line.values) or (not wish and any(value is not None for value in line.values)):
            chart.lines.append(line)
    if not any(line.dashed for line in chart.lines):
        chart.about = chart.about.partition("dashed:")[0].rstrip("; ")
    if not any(any(line.values) for line in chart.lines):
        chart.lines = []  # noughts throughout are what an import writes that was told nothing
    if chart.lines:
        chart.x = [round(t_s, 2) for t_s, _ in rows]
    return chart


def _rounded(value: float | None) -> float | None:
    """Four digits are more than a plot shows."""
    if value is None:
        return None
    return round(value, 1 if abs(value) >= 100.0 else 3 if abs(value) < 10.0 else 2)
