"""Two flights beside each other: their figures, paths, plots and parameters."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from gcs.flight_report.compare import compare, compared_charts
from gcs.flight_report.compare_html import compare_page, number
from gcs.flight_report.facts import Fix
from gcs.flight_report.flight import Anchor, Flight, ParameterSeen, VehicleFlight
from tests.unit.cli.command_line import gcs
from tests.unit.flight_report.test_scan import a_flight_that_loses_gps, scanned, vehicle_of

NAMES = ("a.mcap", "b.mcap")


@pytest.fixture
def flights(tmp_path: Path) -> tuple[Flight, Flight]:
    """The same flight; the second begins later and does not lose its GPS."""
    items = a_flight_that_loses_gps()
    (tmp_path / "b").mkdir()
    return scanned(tmp_path, items), scanned(tmp_path / "b", items[:2] + items[6:100])


def moved_east(metres: float) -> tuple[VehicleFlight, VehicleFlight]:
    """Two straight flights of 10 m to the north, side by side."""
    pair = VehicleFlight(1), VehicleFlight(1)
    for vehicle, east_m in zip(pair, (0.0, metres), strict=True):
        for step in range(11):
            vehicle.track.add(step / 2, (east_m, float(step), 5.0), flying=True)
    return pair


def test_the_paths_are_as_far_apart_as_they_were_flown() -> None:
    assert compare(NAMES, *moved_east(3.0)).paths_apart_m == pytest.approx(3.0)


def test_places_are_compared_on_the_earth_where_both_records_know_where_they_are() -> None:
    """The origins are 0.00001 degrees of latitude apart, which is 1.112 m; so are the paths."""
    a, b = moved_east(0.0)
    a.anchor = Anchor(Fix(47.0, 8.0, 500.0, 0.0), (0.0, 0.0, 0.0))
    b.anchor = Anchor(Fix(47.00001, 8.0, 500.0, 0.0), (0.0, 0.0, 0.0))
    told = compare(NAMES, a, b)
    assert told.same_frame
    assert told.paths_apart_m == pytest.approx(1.112, abs=0.001)


def test_figures_and_what_went_wrong_in_one_alone(flights: tuple[Flight, Flight]) -> None:
    a, b = map(vehicle_of, flights)
    told = compare(NAMES, a, b)
    figures = {figure.name: figure for figure in told.figures}
    assert figures["highest"].a == pytest.approx(10.0)
    assert figures["strongest wind"].a is None
    assert figures["in the air"].difference == pytest.approx(b.totals.flying_s - a.totals.flying_s)
    assert "the GPS lost its fix" in told.only_in_a
    assert told.only_in_b == []


def test_plots_lie_over_each_other_from_the_take_off_on(flights: tuple[Flight, Flight]) -> None:
    a, b = map(vehicle_of, flights)
    height = next(chart for chart in compared_charts(a, b).charts if chart.id == "height")
    assert [line.label for line in height.lines] == ["height A", "height B"]
    assert height.x == sorted(height.x)
    both = [
        (one, other)
        for one, other in zip(*(line.values for line in height.lines), strict=True)
        if one is not None and other is not None
    ]
    assert len(both) > 10
    assert all(abs(one - other) < 0.6 for one, other in both)


def test_parameters_that_differ() -> None:
    a, b = moved_east(0.0)
    for vehicle, values in ((a, (1.0, 2.0, 3.0)), (b, (1.0, 2.5, None))):
        for name, value in zip(("SAME", "OTHER", "GONE"), values, strict=True):
            vehicle.parameters[name] = ParameterSeen(value)
    assert [(p.name, p.a, p.b) for p in compare(NAMES, a, b).parameters] == [("OTHER", 2.0, 2.5)]


def test_a_difference_that_rounds_to_nothing_has_no_sign_but_plus() -> None:
    assert number(-0.001, "m", signed=True) == "+0.00 m"
    assert number(None, "m") == "—"


def test_the_page_needs_no_network(flights: tuple[Flight, Flight]) -> None:
    html = compare_page(flights, tuple(map(vehicle_of, flights)))
    assert "default-src 'none'" in html
    assert "http://" not in html.replace("http://www.w3.org", "")
    assert 'id="figures"' in html


def test_the_command(flights: tuple[Flight, Flight], tmp_path: Path) -> None:
    a, b = tmp_path / flights[0].name, tmp_path / "b" / flights[1].name
    page = tmp_path / "out.html"
    told = gcs("log", "compare", str(a), str(b), "-o", str(page))
    assert "highest" in told.output
    assert page.read_text(encoding="utf-8").startswith("<!doctype html>")
    found = json.loads(gcs("log", "compare", str(a), str(b), "--json").output)
    assert found["a"] == a.name
    assert {"name", "unit", "a", "b", "difference"} == set(found["figures"][0])
    refused = gcs("log", "compare", str(a), str(b), "--vehicle", "9")
    assert "vehicles in it: 1" in refused.output
