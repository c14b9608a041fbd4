"""The plots of the page: which there are, and their numbers for the script that draws them."""

from __future__ import annotations

from math import atan2, cos, degrees, radians, sin

import msgspec

from gcs.flight_report.findings.limits import BAD, FAIR, HDOP_BAD, REJECTED
from gcs.flight_report.flight import Flight, VehicleFlight
from gcs.flight_report.series import Series

MAX_MARKS = 40


class Line(msgspec.Struct):
    """One line of a plot; `axis` 1 is the second scale, at the right."""

    label: str
    unit: str
    values: list[float | None]
    axis: int = 0
    steps: bool = False
    dots: bool = False
    dashed: bool = False


class LimitLine(msgspec.Struct):
    """A horizontal line; drawn where it is in sight."""

    value: float
    level: str
    axis: int = 0


class Chart(msgspec.Struct):
    id: str
    title: str
    about: str
    x: list[float]
    lines: list[Line]
    limits: list[LimitLine] = []
    low: float | None = None
    """The first scale begins here, whatever the values."""
    right_to: float | None = None
    """The second scale reaches at least so far."""
    circle: bool = False
    """Degrees of a heading, which may be drawn beyond 0 and 360."""


class Mark(msgspec.Struct):
    """A finding in every plot."""

    t_s: float
    level: str


class ChartData(msgspec.Struct):
    seconds: float
    marks: list[Mark]
    charts: list[Chart]


def chart_data(flight: Flight, vehicle: VehicleFlight | None) -> ChartData:
    """Only plots that have something to draw."""
    if vehicle is None:
        return ChartData(flight.seconds, [], [])
    marks = [Mark(round(f.t_s, 2), f.level.value) for f in vehicle.went_wrong[:MAX_MARKS]]
    charts = [chart for chart in _charts(vehicle) if chart.lines]
    return ChartData(round(flight.seconds, 2), marks, charts)


def _charts(vehicle: VehicleFlight) -> list[Chart]:
    plots, kind = vehicle.plots, vehicle.autopilot
    return [
        _chart(
            "height",
            "Height",
            "above the local origin, with the height of the goal",
            plots.height,
            [_line("height", "m"), Line("goal", "m", [], steps=True, dashed=True)],
        ),
        _chart(
            "speed",
            "Speed",
            "over ground, and climbing",
            plots.speed,
            [_line("over ground", "m/s"), _line("climb", "m/s")],
        ),
        _chart(
            "attitude",
            "Attitude",
            "roll to the right, pitch up",
            plots.attitude,
            [_line("roll", "°"), _line("pitch", "°")],
        ),
        _heading(plots.heading),
        _battery(plots.battery),
        _link(plots.link),
        _gps(plots.gps),
        _estimator(plots.estimator, kind),
        _vibration(plots.vibration, kind),
    ]


def _heading(series: Series) -> Chart:
    """Cut where the vehicle looks least, so that a heading about north is one line and not two."""
    chart = _chart(
        "heading",
        "Heading",
        "clockwise from north",
        series,
        [Line("heading", "°", [], dots=True)],
    )
    chart.circle = True
    for line in chart.lines:
        turns = [radians(value) for value in line.values if value is not None]
        middle = degrees(atan2(sum(map(sin, turns)), sum(map(cos, turns))))
        line.values = [
            None if value is None else round(middle + (value - middle + 180.0) % 360.0 - 180.0, 1)
            for value in line.values
        ]
    return chart


def _link(series: Series) -> Chart:
    chart = _chart(
        "link",
        "Link",
        "messages of the vehicle a second, and how many were lost",
        series,
        [_line("messages", "/s"), Line("lost", "%", [], axis=1)],
        low=0.0,
    )
    chart.right_to = 10.0
    return chart


def _battery(series: Series) -> Chart:
    lines = [
        _line("voltage", "V"),
        Line("left", "%", [], axis=1),
        Line("current", "A", [], axis=1, dashed=True),
    ]
    chart = _chart("battery", "Battery", "voltage; what is left, and the current", series, lines)
    chart.right_to = 100.0
    return chart


def _gps(series: Series) -> Chart:
    chart = _chart(
        "gps",
        "GPS",
        f"satellites; HDOP, bad above {HDOP_BAD.value:g}",
        series,
        [Line("satellites", "", [], steps=True), Line("HDOP", "", [], axis=1)],
        low=0.0,
    )
    chart.limits = [LimitLine(HDOP_BAD.value, "warning", 1)]
    chart.right_to = 1.25 * HDOP_BAD.value
    return chart


def _estimator(series: Series, autopilot: str) -> Chart:
    limit = REJECTED.get(autopilot, REJECTED["px4"])
    chart = _chart(
        "estimator",
        "Estimator",
        f"how far measurements are from what it expects; bad above {limit.value:g}",
        series,
        [_line(name, "") for name in series.names],
        low=0.0,
    )
    chart.limits = [LimitLine(limit.value, "warning")]
    return chart


def _vibration(series: Series, autopilot: str) -> Chart:
    kind = autopilot if autopilot in FAIR else "ardupilot"
    about = f"good below {FAIR[kind].value:g}, bad above {BAD[kind].value:g} m/s²"
    if kind == "px4":
        about += "; PX4 sends the accelerometers' in z, the gyroscopes' in x and y"
    lines = [_line("x", ""), _line("y", ""), _line("z", "m/s²")]
    chart = _chart("vibration", "Vibration", about, series, lines, low=0.0)
    chart.limits = [LimitLine(FAIR[kind].value, "note"), LimitLine(BAD[kind].value, "critical")]
    return chart


def _line(label: str, unit: str) -> Line:
    return Line(label, unit, [])


def _chart(
    name: str,
    title: str,
    about: str,
    series: Series,
    lines: list[Line],
    low: float | None = None,
) -> Chart:
    """Without the lines that have no value at all."""
    rows = series.rows()
    times = [round(t_s, 2) for t_s, _ in rows]
    drawn = []
    for column, line in enumerate(lines):
        line.values = [_rounded(values[column]) for _, values in rows]
        if any(value is not None for value in line.values):
            drawn.append(line)
    return Chart(name, title, about, times if drawn else [], drawn, low=low)


def _rounded(value: float | None) -> float | None:
    """Four digits are more than a plot shows."""
    if value is None:
        return None
    return round(value, 1 if abs(value) >= 100.0 else 3 if abs(value) < 10.0 else 2)
