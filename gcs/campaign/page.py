"""The report of a campaign: one HTML file that needs no network, as that of a flight."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence

from gcs.campaign.case import Row, Value
from gcs.campaign.charts import TITLES, by_axis, distributions
from gcs.campaign.plan import Plan
from gcs.campaign.statistics import CONFIDENCE, Share, Summary
from gcs.flight_report.charts import ChartData
from gcs.flight_report.flight import Flight
from gcs.flight_report.number_format import count, sentence
from gcs.flight_report.page.html_text import text
from gcs.flight_report.page.path_svg import path_pictures
from gcs.flight_report.render import filled

MOST_CELLS = 200


def campaign_page(
    plan: Plan, told: Summary, rows: Sequence[Row], records: Mapping[int, Flight]
) -> str:
    """`records` are the worst flights, read from their records, the worst first."""
    by_id = {row.id: row for row in rows}
    head = f"<h1>{text(told.name)}</h1><ul class='facts'>" + "".join(
        f"<li>{text(fact)}</li>" for fact in _facts(plan, told)
    )
    body = "".join(
        (
            _verdict(told),
            _tiles(told),
            _section("worst", "The worst flights", _worst(records, by_id)),
            _section("distributions", "Distributions", distributions(rows) + _spreads(told)),
            _section("axes", "What it depends on", _axes(told) + by_axis(plan, rows)),
            _section("cells", "Cells", _cells(told)),
        )
    )
    foot = (
        "Judged by where the vehicle really was. Bounds are Wilson's, for "
        f"{100 * CONFIDENCE:.0f} %. SHA-256 of all rows: {told.rows_sha256}"
    )
    return filled(told.name, head + "</ul>", body, foot, ChartData(0.0, []))


def lead(told: Summary) -> str:
    """The answer in one sentence."""
    share = told.breaches
    if told.flights == 0:
        return "Nothing was flown."
    near = "" if told.closest_m is None else f"; the nearest came to {told.closest_m:.2f} m"
    if share.hits == 0:
        return f"None of {count(told.flights, 'flight')} left its fence{near}."
    of = f"{share.hits} of {count(told.flights, 'flight')} left the fence"
    return f"{of}; the worst by {-(told.closest_m or 0.0):.2f} m."


def probability(told: Summary) -> str:
    """What the share says of the flights that were not flown; empty for those that were chosen
    because of what they might do."""
    if not _drawn(told):
        return ""
    share = told.breaches
    return (
        f"Of flights drawn like these, {_percent(share.low)} to {_percent(share.high)} leave "
        f"their fence, with {100 * CONFIDENCE:.0f} % of confidence."
    )


def _facts(plan: Plan, told: Summary) -> Iterable[str]:
    yield f"{told.flights} of {count(told.planned, 'flight')}"
    yield f"sampled by {told.sample}"
    yield f"simulator {plan.simulator}"
    yield f"plan {told.plan}"


def _section(name: str, title: str, inner: str) -> str:
    return f'<section id="{name}"><h2>{title}</h2>{inner}</section>' if inner else ""


def _verdict(told: Summary) -> str:
    bad = bool(told.breaches.hits)
    level = "critical" if bad else "warning" if told.failures else "ok"
    lines = [probability(told), _failed(told), _differing(told)]
    shown = "".join(f"<p>{text(line)}</p>" for line in lines if line)
    box = f'<div class="trouble-box {level}"><h2>What it says</h2>{shown}</div>' if shown else ""
    return f'<section class="verdict"><p class="lead">{text(lead(told))}</p>{box}</section>'


def _failed(told: Summary) -> str:
    if not told.failures:
        return ""
    ends = ", ".join(f"{name} {number}" for name, number in told.outcomes.items())
    return f"{count(told.failures, 'flight')} failed. How they ended: {ends}."


def _differing(told: Summary) -> str:
    if not told.differing:
        return ""
    listed = ", ".join(map(str, told.differing))
    return f"Flown again, these became another row, which none should: {listed}."


def _tiles(told: Summary) -> str:
    tiles = [
        ("flights", str(told.flights)),
        ("left the fence", str(told.breaches.hits)),
        ("failed", str(told.failures)),
        ("closest", _metres(told.closest_m)),
        ("goals refused", str(told.refused)),
        ("with a critical finding", str(told.critical)),
    ]
    cells = "".join(f"<div><dt>{name}</dt><dd>{text(value)}</dd></div>" for name, value in tiles)
    return f'<dl class="tiles">{cells}</dl>'


def _worst(records: Mapping[int, Flight], rows: Mapping[int, Row]) -> str:
    parts = []
    for number, flight in records.items():
        row, vehicle = rows[number], flight.main_vehicle()
        pictures = path_pictures(flight, vehicle) if vehicle is not None else []
        figures = "".join(
            f"<figure>{_own_ids(p.svg, f'{number}-{n}')}"
            f"<figcaption>{text(p.caption)}</figcaption></figure>"
            for n, p in enumerate(pictures)
        )
        told = f"{nearness(row)}; {row.outcome}"
        found = f'<p class="quiet">{text(sentence(row.findings))}.</p>' if row.findings else ""
        parts.append(
            f"<h3>Flight {number} <small>{text(told)}</small></h3>"
            f'<p class="quiet">{text(_inputs(row.inputs))}</p>{found}'
            f'<div class="pictures">{figures}</div>'
        )
    return "".join(parts)


def nearness(row: Row) -> str:
    """How far it was from leaving its fence, or beyond."""
    if row.closest_m is None:
        return "never flew"
    beyond = row.closest_m < 0.0
    return f"{abs(row.closest_m):.2f} m {'' if beyond else 'from being '}{row.closest_of}"


def _own_ids(svg: str, suffix: str) -> str:
    """One page has many pictures, and each a clip path for each zone."""
    return svg.replace('id="zone', f'id="z{suffix}-').replace("url(#zone", f"url(#z{suffix}-")


def _inputs(inputs: Mapping[str, Value]) -> str:
    """Without what is "", which stands for none of it."""
    return ", ".join(
        f"{name} {value:.4g}" if isinstance(value, float) else f"{name} {value}"
        for name, value in inputs.items()
        if value != ""
    )


def _spreads(told: Summary) -> str:
    rows = (
        (
            TITLES[each.measure],
            *(f"{value:.2f}" for value in each.quantiles),
            each.unit,
        )
        for each in told.spreads
    )
    return _table(("", "least", "5 %", "median", "95 %", "greatest", ""), rows)


def _axes(told: Summary) -> str:
    numbers = _table(
        ("axis of numbers", "rank correlation with the closest approach"),
        ((each.axis, f"{each.rank_correlation:+.2f}") for each in told.dependences),
    )
    levels = _table(
        ("axis", "value", "flights", "left the fence", "probability", "median closest"),
        (
            (
                each.axis,
                each.value or "none",
                str(each.breaches.of),
                str(each.breaches.hits),
                _bounds(told, each.breaches),
                _metres(each.median_m),
            )
            for each in told.levels
        ),
    )
    return numbers + levels


def _cells(told: Summary) -> str:
    ordered = sorted(told.cells, key=lambda cell: (cell.closest_m is None, cell.closest_m))
    table = _table(
        ("cell", "flights", "left the fence", "probability", "failed", "closest", "worst"),
        (
            (
                each.cell,
                str(each.breaches.of),
                str(each.breaches.hits),
                _bounds(told, each.breaches),
                str(each.failures),
                _metres(each.closest_m),
                str(each.worst),
            )
            for each in ordered[:MOST_CELLS]
        ),
    )
    more = len(ordered) - MOST_CELLS
    return table + (f'<p class="quiet">{more} more are in the rows.</p>' if more > 0 else "")


def _table(names: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    body = "".join(
        f'<tr><th scope="row">{text(row[0])}</th>'
        + "".join(
            f'<td data-name="{text(name)}">{text(value)}</td>'
            for name, value in zip(names[1:], row[1:], strict=True)
        )
        + "</tr>"
        for row in rows
    )
    if not body:
        return ""
    head = "".join(f"<th>{text(name)}</th>" for name in names)
    return f'<table class="stacked"><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>'


def _drawn(told: Summary) -> bool:
    """By chance, and not because of what they might do: a share of them is a probability."""
    return told.sample in ("random", "latin") and told.flights > 0


def _bounds(told: Summary, share: Share) -> str:
    return "—" if not _drawn(told) else f"{_percent(share.low)} to {_percent(share.high)}"


def _percent(share: float) -> str:
    return f"{100 * share:.2g} %" if share < 0.995 else "100 %"


def _metres(value: float | None) -> str:
    return "—" if value is None else f"{value:.2f} m"
