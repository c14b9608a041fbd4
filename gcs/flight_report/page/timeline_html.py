"""The state timeline: a bar for each lane, in plain HTML, so that it prints and needs no script."""

from __future__ import annotations

from gcs.flight_report.flight import Flight, VehicleFlight
from gcs.flight_report.lanes import Lane, Span
from gcs.flight_report.number_format import clock
from gcs.flight_report.page.html_text import text

SHORTEST_SHARE = 0.004
"""Of the whole record: a state that is shorter is not seen, and hides the name of the next."""
SHORTEST_S = 0.4
"""Nor is a state shorter than this, which is often no more than a step on the way."""
MAX_SPANS = 400
_STEPS_S = (0.5, 1, 2, 5, 10, 15, 30, 60, 120, 300, 600, 900, 1800, 3600, 7200, 14400, 43200, 86400)
_MOST_MARKS = 6

_KINDS = {
    "calm": "GROUNDED NO_VEHICLE ON_GROUND NONE NOMINAL disarmed AUTO.READY",
    "ready": "HOVERING STREAMING OURS TAKING armed AUTO.LOITER LOITER BRAKE POSHOLD",
    "move": "MOVING VERIFYING IN_AIR OFFBOARD GUIDED TAKING_PICTURE",
    "climb": "TAKING_OFF TAKEOFF AUTO.TAKEOFF",
    "plan": "FLYING_MISSION AUTO.MISSION AUTO",
    "down": "LANDING RETURNING AUTO.LAND AUTO.RTL LAND RTL SMART_RTL AUTO_RTL AUTO.PRECLAND",
    "caution": "CAUTION EXTERNAL STALE",
    "bad": "HOLDING HOLD RETURN TERMINATE TERMINATION",
}
_KIND_OF = {name: kind for kind, names in _KINDS.items() for name in names.split()}


def timeline(flight: Flight, vehicle: VehicleFlight) -> str:
    """Empty where no state is known."""
    lanes = [lane for lane in vehicle.lanes.all if lane.changes]
    if not lanes or flight.seconds <= 0.0:
        return ""
    shortest_s = max(SHORTEST_S, SHORTEST_SHARE * flight.seconds)
    rows = [_lane(lane, flight.seconds, shortest_s) for lane in lanes]
    return f'<div class="lanes">{"".join(rows)}{_axis(flight.seconds)}</div>'


def _lane(lane: Lane, end_s: float, shortest_s: float) -> str:
    spans = lane.debounced(end_s, shortest_s)[:MAX_SPANS]
    bars = "".join(_bar(span, end_s, severity=lane.title == "Severity") for span in spans)
    cut = '<p class="quiet">This row is cut off: it changes too often.</p>' if lane.cut_off else ""
    return (
        f'<div class="lane"><div class="lane-name">{text(lane.title)}</div>'
        f'<div class="lane-bar">{bars}</div></div>{cut}'
    )


def _bar(span: Span, end_s: float, *, severity: bool) -> str:
    left, width = 100.0 * span.start_s / end_s, 100.0 * (span.end_s - span.start_s) / end_s
    # LAND is a mode, and a severity.
    kind = "bad" if severity and span.value == "LAND" else _KIND_OF.get(span.value, "other")
    name = text(span.value.replace("_", " "))
    title = f"{name}, {clock(span.start_s)} to {clock(span.end_s)}"
    return (
        f'<span class="bar {kind}" style="left:{left:.3f}%;width:{width:.3f}%" title="{title}">'
        f"<span>{name}</span></span>"
    )


def _axis(end_s: float) -> str:
    step_s = next((step for step in _STEPS_S if end_s / step <= _MOST_MARKS), end_s)
    marks = (number * step_s for number in range(int(end_s / step_s) + 1))
    labels = "".join(
        f"<span{' class=last' if t_s > 0.9 * end_s else ''} "
        f'style="left:{100.0 * t_s / end_s:.3f}%">{clock(t_s).removesuffix(".0")}</span>'
        for t_s in marks
    )
    return (
        '<div class="lane axis"><div class="lane-name"></div>'
        f'<div class="lane-bar">{labels}</div></div>'
    )
