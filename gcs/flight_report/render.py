"""The page: one HTML file that holds all it needs, and asks no network for anything."""

from __future__ import annotations

import base64
import hashlib
import re
from collections.abc import Iterable, Iterator
from functools import cache
from importlib.resources import files

import msgspec

from gcs.flight_report.charts import Chart, ChartData, chart_data
from gcs.flight_report.drift import drift_before
from gcs.flight_report.findings.finding import Finding
from gcs.flight_report.flight import Flight, VehicleFlight
from gcs.flight_report.number_format import duration, metres, utc
from gcs.flight_report.page import tables_html
from gcs.flight_report.page.html_text import script_json, text
from gcs.flight_report.page.parameters_html import parameters
from gcs.flight_report.page.path_svg import path_pictures
from gcs.flight_report.page.spectrum_svg import spectrum_figure
from gcs.flight_report.page.timeline_html import timeline
from gcs.flight_report.summary import (
    consequences,
    main_trouble,
    other_vehicles,
    vehicle_name,
    what_happened,
    what_is_damaged,
    what_was_asked,
    what_was_before,
    what_went_wrong,
)

_PLACE = re.compile(r"\{\{(\w+)\}\}")


def page(flight: Flight) -> str:
    """The whole page.  Everything that comes from the record is escaped."""
    vehicles = flight.shown_vehicles()
    data = chart_data(flight, vehicles)
    head = _head(flight, vehicles)
    body = "".join(_body(flight, vehicles, data))
    return filled(flight.name, head, body, _foot(flight), data)


def filled(title: str, head: str, body: str, foot: str, data: ChartData) -> str:
    """A page of these parts, which are HTML but for the title and the foot."""
    licence = f"/* uPlot 1.6.32\n\n{_asset('uPlot.LICENSE')}*/"
    script = f"{licence}\n{_asset('uPlot.iife.min.js')}\n{_asset('report.js')}{_asset('scene.js')}"
    parts = {
        "title": text(title),
        "policy": _content_policy(script),
        "style": f"{_asset('uPlot.min.css')}\n{_asset('report.css')}",
        "head": head,
        "body": body,
        "foot": text(foot),
        "data": script_json(msgspec.json.encode(data)),
        "script": script,
    }
    return _PLACE.sub(lambda place: parts[place[1]], _asset("page.html"))


@cache
def _asset(name: str) -> str:
    return (files("gcs.flight_report") / "page" / name).read_text(encoding="utf-8")


def _content_policy(script: str) -> str:
    """No network at all, and no script but this one: an escape that failed would do nothing."""
    digest = base64.b64encode(hashlib.sha256(script.encode()).digest()).decode()
    return (
        f"default-src 'none'; script-src 'sha256-{digest}'; style-src 'unsafe-inline'; "
        "img-src data:; base-uri 'none'; form-action 'none'"
    )


def _body(flight: Flight, vehicles: list[VehicleFlight], data: ChartData) -> Iterator[str]:
    if len(vehicles) < 2:
        vehicle = vehicles[0] if vehicles else None
        yield verdict(flight, vehicle)
        yield _notes(flight, vehicles)
        if vehicle is not None:
            yield _totals(vehicle)
            yield from _sections(flight, vehicle, data)
        return
    for vehicle in vehicles:
        name = f"Vehicle {vehicle.sysid}"
        yield f'<h2 class="whose"><a href="#vehicle-{vehicle.sysid}">{name}</a></h2>'
        yield verdict(flight, vehicle)
    yield _notes(flight, vehicles)
    yield scene_html(data)
    for vehicle in vehicles:
        yield f'<h2 class="whose" id="vehicle-{vehicle.sysid}">Vehicle {vehicle.sysid}</h2>'
        yield _totals(vehicle)
        yield from _sections(flight, vehicle, data, f"-{vehicle.sysid}")


def scene_html(data: ChartData) -> str:
    if data.scene is None:
        return ""
    return (
        '<figure class="scene"><canvas id="scene" tabindex="0" role="img" '
        'aria-label="The path in three dimensions"></canvas>'
        '<figcaption>In three dimensions. <span class="screen-only">Drag to turn it, pinch or '
        "click and scroll to come closer; dotted on the ground: its shadow.</span></figcaption>"
        "</figure>"
    )


def _head(flight: Flight, vehicles: list[VehicleFlight]) -> str:
    began = utc(flight.start_ns)
    lines = [began, f"{duration(flight.seconds)} of record", f"{flight.size / 1e6:.1f} MB"]
    for vehicle in reversed(vehicles):
        build = vehicle.build
        told = [part for part in (build.firmware, build.hardware) if part]
        name = " ".join([vehicle_name(vehicle), *told[:1]])
        lines[:0] = [f"{name}, vehicle {vehicle.sysid}", *told[1:]]
    facts = "".join(f"<li>{text(line)}</li>" for line in lines if line)
    return f'<h1>{text(flight.name)}</h1><ul class="facts">{facts}</ul>'


def _sections(
    flight: Flight, vehicle: VehicleFlight, data: ChartData, suffix: str = ""
) -> list[str]:
    """`suffix` of the names of the sections, where the page has several vehicles."""
    sections = []

    def add(name: str, title: str, inner: str) -> None:
        sections.append(f'<section id="{name}{suffix}"><h2>{title}</h2>{inner}</section>')

    pictures = path_pictures(flight, vehicle)
    if pictures:
        figures = "".join(
            f"<figure>{p.svg}<figcaption>{text(p.caption)}</figcaption></figure>" for p in pictures
        )
        key = tables_html.path_key(vehicle, flight.fence)
        scene = "" if suffix else scene_html(data)
        add("path", "Path", f'<div class="pictures">{figures}</div>{key}{scene}')
    else:
        add("path", "Path", '<p class="quiet">The record has no position of this vehicle.</p>')
    lanes = timeline(flight, vehicle)
    if lanes:
        add("states", "States", lanes)
    add("findings", "Findings", tables_html.findings(vehicle))
    if vehicle.requests:
        add("requests", "Requests", tables_html.requests(vehicle))
    charts = [
        (number, chart)
        for number, chart in enumerate(data.charts)
        if chart.vehicle == vehicle.sysid
    ]
    if charts:
        add("plots", "Plots", plots_html(charts, spectrum_figure(vehicle.spectrum)))
    add("checks", "What was looked at", tables_html.checks(vehicle))
    set_to = parameters(vehicle)
    if set_to:
        add("parameters", "Parameters", set_to)
    if vehicle.said:
        add("texts", "What the vehicle said", tables_html.said(vehicle))
    return sections


def plots_html(charts: Iterable[tuple[int, Chart]], more: str = "") -> str:
    """Plots by their number in the page's data; `more` pictures after them."""
    plots = "".join(
        f'<figure class="plot" data-chart="{number}"><h3>{text(chart.title)} '
        f"<small>{text(chart.about)}</small></h3></figure>"
        for number, chart in charts
    )
    note = (
        '<noscript><p class="quiet">The plots need JavaScript.</p></noscript>'
        '<p class="quiet screen-only">Drag over a plot to look closer, in all of them; '
        "tap twice to see all.</p>"
    )
    return f'{note}<div class="plots">{plots}{more}</div>'


def verdict(flight: Flight, vehicle: VehicleFlight | None) -> str:
    """What happened, and what went wrong first: what is read when nothing else is."""
    asked = what_was_asked(vehicle) if vehicle else ""
    asked = f'<p class="asked">{text(asked)}</p>' if asked else ""
    happened = f'<p class="lead">{text(what_happened(flight, vehicle))}</p>{asked}'
    wrong = what_went_wrong(flight, vehicle)
    first = main_trouble(vehicle)
    chain = ""
    if vehicle is not None and first is not None:
        then = "".join(_consequence(later, first) for later in consequences(vehicle, first))
        chain = f'<ol class="chain">{then}</ol>' if then else ""
    level = first.level.value if first else "ok"
    drift = drift_before(vehicle, first) if vehicle is not None and first is not None else ""
    before = " ".join(filter(None, (drift, what_was_before(vehicle))))
    before = f'<p class="before">{text(before)}</p>' if before else ""
    trouble = (
        f'<div class="trouble-box {level}"><h2>What went wrong</h2><p>{text(wrong)}</p>'
        f"{chain}{before}</div>"
        if wrong
        else ""
    )
    return f'<section class="verdict">{happened}{trouble}</section>'


def _consequence(later: Finding, first: Finding) -> str:
    after_s = later.t_s - first.t_s
    when = "at the same time" if after_s < 0.05 else f"{after_s:.1f} s later"
    detail = f"<em>{text(later.detail)}</em>" if later.detail else ""
    return f"<li><span>{when}</span><div>{text(later.title)} {detail}</div></li>"


def _notes(flight: Flight, vehicles: list[VehicleFlight]) -> str:
    notes = []
    if not flight.closed:
        notes.append("The file was not closed: its writer was killed, or is still writing.")
    if damage := what_is_damaged(flight):
        notes.append(damage)
    others = other_vehicles(flight, vehicles)
    if others:
        notes.append("Also in the record: " + "; ".join(others[:20]) + ".")
    return "".join(f'<p class="quiet">{text(note)}</p>' for note in notes)


def _totals(vehicle: VehicleFlight) -> str:
    totals = vehicle.totals
    tiles = [("in the air", duration(totals.flying_s))]
    if totals.max_up_m is not None:
        tiles.append(("highest", metres(totals.max_up_m)))
    if totals.max_distance_m is not None:
        tiles.append(("farthest", metres(totals.max_distance_m)))
    if totals.take_offs:
        tiles.append(("flown", metres(vehicle.track.length_m)))
    if totals.max_speed_mps is not None:
        tiles.append(("fastest", f"{totals.max_speed_mps:.1f} m/s"))
    if totals.remaining_pct is not None:
        first, last = totals.remaining_pct
        tiles.append(("battery", f"{first:.0f} → {last:.0f} %"))
    elif totals.voltage_v is not None:
        first, last = totals.voltage_v
        tiles.append(("battery", f"{first:.1f} → {last:.1f} V"))
    cells = "".join(f"<div><dt>{name}</dt><dd>{text(value)}</dd></div>" for name, value in tiles)
    return f'<dl class="tiles">{cells}</dl>'


def _foot(flight: Flight) -> str:
    software = flight.metadata.get("mavgate", {})
    parts = [f"{key} {value}" for key, value in sorted(software.items()) if value]
    recorded = f"Recorded with mavgate: {', '.join(parts)}. " if parts else ""
    return f"{recorded}Times count from the first message of the record."
