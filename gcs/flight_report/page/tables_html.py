"""The tables of the page: findings, requests, what was looked at, what the vehicle said."""

from __future__ import annotations

from collections.abc import Iterable

from gcs.enu_text import labelled_enu
from gcs.flight_report.findings.finding import Check, Finding, Level
from gcs.flight_report.flight import Fence, Request, VehicleFlight
from gcs.flight_report.number_format import clock, sentence
from gcs.flight_report.page.html_text import text
from gcs.flight_report.page.path_svg import colour_of

MAX_FINDINGS = 200
_WORDS = {
    Level.OK: "ok",
    Level.NOTE: "note",
    Level.WARNING: "warning",
    Level.CRITICAL: "critical",
    None: "no data",
}
_SEVERITIES = (
    *("emergency", "alert", "critical", "error"),
    *("warning", "notice", "info", "debug"),
)
_LOUD = 4
"""MAV_SEVERITY_WARNING: texts up to it are shown, the rest are folded away."""


def findings(vehicle: VehicleFlight) -> str:
    """In time order, the notes after what went wrong."""
    if not vehicle.findings:
        return '<p class="quiet">Nothing was found that is worth a line.</p>'
    worse = [f for f in vehicle.findings if f.level is not Level.NOTE]
    notes = [f for f in vehicle.findings if f.level is Level.NOTE]
    rows = "".join(_finding(f) for f in (*worse, *notes)[:MAX_FINDINGS])
    return f'<ol class="findings">{rows}</ol>'


def _finding(finding: Finding) -> str:
    detail = f"<p>{text(sentence(finding.detail))}</p>" if finding.detail else ""
    source = f'<p class="source">{text(finding.source)}</p>' if finding.source else ""
    return (
        f'<li class="{finding.level.value}"><time>{clock(finding.t_s)}</time>'
        f"<div><h3>{text(sentence(finding.title))} {_badge(finding.level)}</h3>"
        f"{detail}{source}</div></li>"
    )


def _badge(level: Level | None) -> str:
    name = "none" if level is None else level.value
    return f'<span class="badge {name}">{_WORDS[level]}</span>'


def checks(vehicle: VehicleFlight) -> str:
    rows = "".join(_check(check) for check in vehicle.checks)
    return (
        '<table class="stacked checks"><thead><tr><th>value</th><th>measured</th><th>limit</th>'
        f"<th></th></tr></thead><tbody>{rows}</tbody></table>"
    )


def _check(check: Check) -> str:
    source = f'<div class="source">{text(check.source)}</div>' if check.source else ""
    return (
        f'<tr><th scope="row">{text(check.name)}</th>'
        f'<td data-name="measured">{text(check.measured or "—")}</td>'
        f'<td data-name="limit">{text(check.limit)}{source}</td>'
        f"<td>{_badge(check.level)}</td></tr>"
    )


def requests(vehicle: VehicleFlight) -> str:
    rows = "".join(_request(request) for request in vehicle.requests)
    more = ""
    if vehicle.requests_left_out:
        more = f'<p class="quiet">{vehicle.requests_left_out} more are left out.</p>'
    return (
        '<table class="stacked requests"><thead><tr><th>#</th><th>at</th><th>request</th>'
        "<th>verdict</th><th>ending</th><th>reason and numbers</th></tr></thead>"
        f"<tbody>{rows}</tbody></table>{more}"
    )


def _request(request: Request) -> str:
    goal = f"<br><small>{text(labelled_enu(request.goal_enu))}</small>" if request.goal_enu else ""
    ending = "—" if not request.ending else text(request.ending)
    if request.ended_s is not None:
        ending += f" <br><small>after {request.ended_s - request.t_s:.1f} s</small>"
    words = [part for part in (request.sentence, _told(request.ending_sentence)) if part]
    why = "".join(f"<div>{text(part)}</div>" for part in words)
    code = f"<code>{text(request.code)}</code> " if request.code else ""
    verdict = text(request.outcome or "—")
    badge = "bad" if request.outcome == "refused" else "good"
    ended = "bad" if request.ending not in ("", "complete") else ""
    return (
        f'<tr><th scope="row">{request.request_id}</th>'
        f'<td data-name="at">{clock(request.t_s)}</td>'
        f'<td data-name="request"><b>{text(request.word)}</b>{goal}</td>'
        f'<td data-name="verdict" class="{badge}">{verdict}</td>'
        f'<td data-name="ending" class="{ended}">{ending}</td>'
        f'<td data-name="reason">{code}{why}{_numbers(request.numbers)}</td></tr>'
    )


def _told(ending: str) -> str:
    """An ending without what its column says already."""
    return "" if ending == "Complete" else ending


def _numbers(numbers: dict[str, float | None]) -> str:
    if not numbers:
        return ""
    known = [(name, value) for name, value in sorted(numbers.items()) if value is not None]
    pairs = "".join(f"<span><i>{text(name)}</i> {value:.2f}</span>" for name, value in known[:20])
    return f'<div class="numbers">{pairs}</div>'


def said(vehicle: VehicleFlight) -> str:
    loud = [said for said in vehicle.said if said.severity <= _LOUD]
    quiet = len(vehicle.said) - len(loud)
    rows = _texts((s.t_s, s.severity, s.text) for s in vehicle.said)
    cut = f" {vehicle.said_left_out} more are left out." if vehicle.said_left_out else ""
    shown = _texts((s.t_s, s.severity, s.text) for s in loud)
    first = shown or '<p class="quiet">No warnings or errors.</p>'
    if not quiet:
        return first + (f'<p class="quiet">{cut}</p>' if cut else "")
    return (
        f"{first}<details><summary>All {len(vehicle.said)} texts</summary>{rows}"
        f'<p class="quiet">{cut}</p></details>'
    )


def _texts(lines: Iterable[tuple[float, int, str]]) -> str:
    rows = "".join(
        f'<li><time>{clock(t_s)}</time><span class="severity s{min(severity, 7)}">'
        f"{_SEVERITIES[min(severity, 7)]}</span> {text(line)}</li>"
        for t_s, severity, line in lines
    )
    return f'<ol class="texts">{rows}</ol>' if rows else ""


def path_key(vehicle: VehicleFlight, fence: Fence) -> str:
    """What the pictures' marks mean, and the times of the path's colours."""
    points = vehicle.track.points
    stops = ", ".join(colour_of(i / 6) for i in range(7))
    items = [
        f"<li>▲ {clock(points[0].t_s)} "
        f'<i class="ramp" style="background:linear-gradient(90deg,{stops})"></i> '
        f"{clock(points[-1].t_s)} ■</li>",
    ]
    outcomes = {r.outcome for r in vehicle.requests if r.goal_enu is not None}
    if "accepted" in outcomes:
        items.append('<li><i class="dot good"></i> goal, accepted</li>')
    if "refused" in outcomes:
        items.append('<li><i class="cross">✕</i> goal, refused (→ out of view)</li>')
    if vehicle.plan:
        items.append('<li><i class="planned"></i> mission</li>')
    if vehicle.went_wrong:
        items.append('<li><i class="dot bad">!</i> where it went wrong</li>')
    if any(zone.inclusion for zone in fence.zones):
        items.append('<li><i class="swatch inside"></i> margin of the fence</li>')
    if any(not zone.inclusion for zone in fence.zones):
        items.append('<li><i class="swatch outside"></i> keep out</li>')
    return f'<ul class="key">{"".join(items)}</ul>'
