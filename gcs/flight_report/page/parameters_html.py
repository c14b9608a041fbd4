"""The parameters on the page: which differ from their defaults, and which changed in the record."""

from __future__ import annotations

from math import isclose

from gcs.flight_report.flight import ParameterSeen, VehicleFlight
from gcs.flight_report.number_format import clock, count
from gcs.flight_report.page.html_text import text

MAX_ROWS = 400
SHOWN_ROWS = 12
_NOT_SETTINGS = ("CAL_", "STAT_", "COMPASS_OFS", "COMPASS_DIA", "COMPASS_ODI", "INS_")
"""What a calibration or the flight itself writes differs on every vehicle: told as a number."""


def _same(a: float, b: float) -> bool:
    """As float32, which is how they travel and are logged."""
    return isclose(a, b, rel_tol=1e-6, abs_tol=1e-9)


def differing(vehicle: VehicleFlight) -> list[tuple[str, ParameterSeen]]:
    """Those whose default is known and is another one, by name."""
    return [
        (name, seen)
        for name, seen in sorted(vehicle.parameters.items())
        if seen.value is not None
        and seen.default is not None
        and not _same(seen.value, seen.default)
    ]


def parameters(vehicle: VehicleFlight) -> str:
    """Empty where the record has none."""
    known = [seen for seen in vehicle.parameters.values() if seen.value is not None]
    if not known:
        return ""
    changed = [
        (name, seen)
        for name, seen in sorted(vehicle.parameters.items())
        if seen.changed_s is not None
    ]
    parts = [_changed(changed)] if changed else []
    if not any(seen.default is not None for seen in known):
        told = f"The record has {count(len(known), 'parameter')} and does not say what their "
        return "".join(parts) + f'<p class="quiet">{told}defaults are.</p>'
    rows = differing(vehicle)
    settings = [row for row in rows if not row[0].startswith(_NOT_SETTINGS)]
    others = len(rows) - len(settings)
    more = f", and {others} that calibration or use wrote" if others else ""
    told = f"Of {len(known)} parameters {len(settings)} differ from their default{more}."
    parts.append(f'<p class="quiet">{text(told)}</p>')
    if settings:
        parts.append(_table(settings[:SHOWN_ROWS]))
    if len(settings) > SHOWN_ROWS:
        rest = _table(settings[SHOWN_ROWS:MAX_ROWS])
        parts.append(
            f"<details><summary>The other {len(settings) - SHOWN_ROWS}</summary>{rest}</details>"
        )
    return "".join(parts)


def _table(rows: list[tuple[str, ParameterSeen]]) -> str:
    cells = "".join(
        f'<tr><th scope="row">{text(name)}</th><td data-name="value">{seen.value:.6g}</td>'
        f'<td data-name="default">{seen.default:.6g}</td></tr>'
        for name, seen in rows
    )
    return (
        '<table class="stacked parameters"><thead><tr><th>parameter</th><th>value</th>'
        f"<th>default</th></tr></thead><tbody>{cells}</tbody></table>"
    )


def _changed(rows: list[tuple[str, ParameterSeen]]) -> str:
    listed = "; ".join(
        f"{name} from {seen.first:.6g} to {seen.value:.6g} at {clock(seen.changed_s or 0.0)}"
        for name, seen in rows[:SHOWN_ROWS]
    )
    more = f"; and {len(rows) - SHOWN_ROWS} more" if len(rows) > SHOWN_ROWS else ""
    return f"<p>Changed in this record: {text(listed + more)}.</p>"
