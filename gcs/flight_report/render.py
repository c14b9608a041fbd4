"""The page: one HTML file that holds all it needs, and asks no network for anything."""

from __future__ import annotations

import base64
import hashlib
import re
from functools import cache
from importlib.resources import files

import msgspec

from gcs.flight_report import tables_html
from gcs.flight_report.charts import ChartData, chart_data
from gcs.flight_report.findings.finding import Finding
from gcs.flight_report.flight import Flight, VehicleFlight
from gcs.flight_report.html_text import script_json, text
from gcs.flight_report.number_format import duration, metres, utc
from gcs.flight_report.parameters_html import parameters
from gcs.flight_report.path_svg import path_pictures
from gcs.flight_report.spectrum_svg import spectrum_figure
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
from gcs.flight_report.timeline_html import timeline

_PLACE = re.compile(r"\{\{(\w+)\}\}")


def page(flight: Flight) -> str:
    """The whole page.  Everything that comes from the record is escaped."""
    vehicle = flight.main_vehicle()
    data = chart_data(flight, vehicle)
    licence = f"/* uPlot 1.6.32\n\n{_asset('uPlot.LICENSE')}*/"
    script = f"{licence}\n{_asset('uPlot.iife.min.js')}\n{_asset('report.js')}"
    parts = {
        "title": text(flight.name),
        "policy": _content_policy(script),
        "style": f"{_asset('uPlot.min.css')}\n{_asset('report.css')}",
        "head": _head(flight, vehicle),
        "body": "".join(_sections(flight, vehicle, data)),
        "foot": _foot(flight),
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


def _head(flight: Flight, vehicle: VehicleFlight | None) -> str:
    began = utc(flight.start_ns)
    lines = [began, f"{duration(flight.seconds)} of record", f"{flight.size / 1e6:.1f} MB"]
    if vehicle is not None:
        lines.insert(0, f"{vehicle_name(vehicle)}, vehicle {vehicle.sysid}")
        build = vehicle.build
        lines[1:1] = [part for part in (build.firmware, build.hardware) if part]
    facts = "".join(f"<li>{text(line)}</li>" for line in lines if line)
    return f'<h1>{text(flight.name)}</h1><ul class="facts">{facts}</ul>'


def _sections(flight: Flight, vehicle: VehicleFlight | None, data: ChartData) -> list[str]:
    sections = [_verdict(flight, vehicle)]
    if vehicle is None:
        return sections
    sections.append(_totals(vehicle))
    pictures = path_pictures(flight, vehicle)
    if pictures:
        figures = "".join(
            f"<figure>{p.svg}<figcaption>{text(p.caption)}</figcaption></figure>" for p in pictures
        )
        key = tables_html.path_key(vehicle, flight.fence)
        sections.append(_section("path", "Path", f'<div class="pictures">{figures}</div>{key}'))
    else:
        quiet = '<p class="quiet">The record has no position of this vehicle.</p>'
        sections.append(_section("path", "Path", quiet))
    lanes = timeline(flight, vehicle)
    if lanes:
        sections.append(_section("states", "States", lanes))
    sections.append(_section("findings", "Findings", tables_html.findings(vehicle)))
    if vehicle.requests:
        sections.append(_section("requests", "Requests", tables_html.requests(vehicle)))
    if data.charts:
        plots = "".join(
            f'<figure class="plot" data-chart="{number}"><h3>{text(chart.title)} '
            f"<small>{text(chart.about)}</small></h3></figure>"
            for number, chart in enumerate(data.charts)
        )
        note = (
            '<noscript><p class="quiet">The plots need JavaScript.</p></noscript>'
            '<p class="quiet screen-only">Drag over a plot to look closer, in all of them; '
            "tap twice to see all.</p>"
        )
        spectrum = spectrum_figure(vehicle.spectrum)
        drawn = f'{note}<div class="plots">{plots}{spectrum}</div>'
        sections.append(_section("plots", "Plots", drawn))
    sections.append(_section("checks", "What was looked at", tables_html.checks(vehicle)))
    set_to = parameters(vehicle)
    if set_to:
        sections.append(_section("parameters", "Parameters", set_to))
    if vehicle.said:
        sections.append(_section("texts", "What the vehicle said", tables_html.said(vehicle)))
    return sections


def _verdict(flight: Flight, vehicle: VehicleFlight | None) -> str:
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
    before = what_was_before(vehicle)
    before = f'<p class="before">{text(before)}</p>' if before else ""
    trouble = (
        f'<div class="trouble-box {level}"><h2>What went wrong</h2><p>{text(wrong)}</p>'
        f"{chain}{before}</div>"
        if wrong
        else ""
    )
    notes = "".join(f'<p class="quiet">{text(note)}</p>' for note in _record_notes(flight, vehicle))
    return f'<section class="verdict">{happened}{trouble}{notes}</section>'


def _consequence(later: Finding, first: Finding) -> str:
    after_s = later.t_s - first.t_s
    when = "at the same time" if after_s < 0.05 else f"{after_s:.1f} s later"
    detail = f"<em>{text(later.detail)}</em>" if later.detail else ""
    return f"<li><span>{when}</span><div>{text(later.title)} {detail}</div></li>"


def _record_notes(flight: Flight, vehicle: VehicleFlight | None) -> list[str]:
    notes = []
    if not flight.closed:
        notes.append("The file was not closed: its writer was killed, or is still writing.")
    if damage := what_is_damaged(flight):
        notes.append(damage)
    others = other_vehicles(flight, vehicle)
    if others:
        notes.append("Also in the record: " + "; ".join(others[:20]) + ".")
    return notes


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


def _section(name: str, title: str, inner: str) -> str:
    return f'<section id="{name}"><h2>{title}</h2>{inner}</section>'


def _foot(flight: Flight) -> str:
    software = flight.metadata.get("mavgate", {})
    parts = [f"{key} {value}" for key, value in sorted(software.items()) if value]
    recorded = f"Recorded with mavgate: {', '.join(parts)}. " if parts else ""
    return text(f"{recorded}Times count from the first message of the record.")
