"""The page that shows two flights beside each other; one file, as the report's."""

from __future__ import annotations

from gcs.flight_report.compare import Comparison, Figure, compare, compared_charts
from gcs.flight_report.flight import Flight, VehicleFlight
from gcs.flight_report.number_format import sentence, utc
from gcs.flight_report.page.html_text import text
from gcs.flight_report.render import filled, plots_html, scene_html, verdict


def compare_page(flights: tuple[Flight, Flight], vehicles: tuple[VehicleFlight, ...]) -> str:
    a, b = vehicles
    told = compare((flights[0].name, flights[1].name), a, b)
    data = compared_charts(a, b)
    parts = []
    for letter, flight, vehicle in zip("AB", flights, vehicles, strict=True):
        when = f" <small>{text(utc(flight.start_ns))}</small>"
        parts.append(f'<h2 class="whose">{letter}: {text(flight.name)}{when}</h2>')
        parts.append(verdict(flight, vehicle))
    parts.append(_section("figures", "Figures", _figures(told)))
    parts.append(_section("wrong", "What went wrong in one alone", _wrong(told)))
    parts.append(_section("paths", "Paths", scene_html(data) + _apart(told)))
    parts.append(_section("plots", "Plots", plots_html(enumerate(data.charts))))
    parts.append(_section("parameters", "Parameters that differ", _parameters(told)))
    names = f"{flights[0].name} and {flights[1].name}"
    head = f"<h1>{text(names)}</h1>"
    foot = "A and B are two flights; times count from each one's take-off."
    return filled(f"{names}, compared", head, "".join(parts), foot, data)


def _section(name: str, title: str, inner: str) -> str:
    return f'<section id="{name}"><h2>{title}</h2>{inner}</section>' if inner else ""


def number(value: float | None, unit: str, *, signed: bool = False) -> str:
    if value is None:
        return "—"
    digits = 0 if abs(value) >= 100.0 else 1 if abs(value) >= 10.0 else 2
    rounded = round(value, digits) + 0.0  # a difference of -0.001 is no -0.00
    return f"{rounded:{'+' if signed else ''}.{digits}f} {unit}".strip()


def known(told: Comparison) -> list[Figure]:
    return [figure for figure in told.figures if figure.a is not None or figure.b is not None]


def _figures(told: Comparison) -> str:
    rows = "".join(
        f'<tr><th scope="row">{text(sentence(each.name))}</th>'
        f'<td data-name="A">{number(each.a, each.unit)}</td>'
        f'<td data-name="B">{number(each.b, each.unit)}</td>'
        f'<td data-name="B − A">{number(each.difference, each.unit, signed=True)}</td></tr>'
        for each in known(told)
    )
    return (
        '<table class="stacked compared"><thead><tr><th></th><th>A</th><th>B</th><th>B − A</th>'
        f"</tr></thead><tbody>{rows}</tbody></table>"
    )


def _wrong(told: Comparison) -> str:
    lists = [
        f"<p><b>{letter}</b> {text('; '.join(titles))}.</p>"
        for letter, titles in (("A", told.only_in_a), ("B", told.only_in_b))
        if titles
    ]
    return "".join(lists) or '<p class="quiet">Nothing.</p>'


def apart(told: Comparison) -> str:
    """One sentence; empty where one of them has no path."""
    if told.paths_apart_m is None:
        return ""
    frame = "" if told.same_frame else ", each in its own local frame"
    return f"The path of B is at most {told.paths_apart_m:.1f} m from that of A{frame}."


def _apart(told: Comparison) -> str:
    words = apart(told)
    return words and f'<p class="quiet">{text(words)}</p>'


def _parameters(told: Comparison) -> str:
    if not told.parameters:
        return '<p class="quiet">None of those that both records have.</p>'
    rows = "".join(
        f'<tr><th scope="row">{text(each.name)}</th><td data-name="A">{each.a:.6g}</td>'
        f'<td data-name="B">{each.b:.6g}</td></tr>'
        for each in told.parameters
    )
    return (
        '<table class="stacked"><thead><tr><th>parameter</th><th>A</th><th>B</th></tr></thead>'
        f"<tbody>{rows}</tbody></table>"
    )
