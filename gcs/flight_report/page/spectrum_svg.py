"""The spectrum of the accelerations as a picture."""

from __future__ import annotations

from gcs.flight_report.page.html_text import text
from gcs.flight_report.page.path_svg import WIDTH_PX, grid
from gcs.flight_report.projection import Box, View
from gcs.flight_report.spectrum import MOTOR_HZ, SEGMENT, Spectrum

_HEIGHT_PX = 220.0
_AXES = ("x", "y", "z")


def spectrum_figure(spectrum: Spectrum) -> str:
    """Empty where the record has no accelerations in the air."""
    if spectrum.rate_hz is None:
        return ""
    head = "<h3>Vibration spectrum <small>of the accelerations in the air</small></h3>"
    rows = spectrum.amplitudes()
    if not rows:
        why = (
            f"accelerations come {spectrum.rate_hz:.0f} times a second, which shows nothing that "
            f"is faster than {spectrum.rate_hz / 2:.0f} Hz; rotors turn faster than {MOTOR_HZ:g} Hz"
            if spectrum.too_slow
            else "accelerations come at uneven times"
        )
        return f'<figure>{head}<p class="quiet">No spectrum: {text(why)}.</p></figure>'
    most = max(max(values) for _, values in rows) or 1.0
    view = View(Box(0.0, rows[-1][0], 0.0, 1.08 * most), WIDTH_PX, _HEIGHT_PX)
    lines = []
    for axis, name in enumerate(_AXES):
        places = (view.px(hertz, values[axis]) for hertz, values in rows)
        points = " ".join(f"{x:.1f},{y:.1f}" for x, y in places)
        lines.append(
            f'<polyline class="a{axis}" points="{points}"><title>{name}</title></polyline>'
        )
    peaks = (max((values[axis], hertz) for hertz, values in rows) for axis in range(3))
    told = ", ".join(
        f"{name} {value:.2f} m/s² at {hertz:.0f} Hz"
        for name, (value, hertz) in zip(_AXES, peaks, strict=True)
    )
    caption = (
        f"Amplitude in m/s², mean of {spectrum.segments} stretches of {SEGMENT} samples at "
        f"{spectrum.rate_hz:.0f} Hz. Largest: {told}."
    )
    drawn = "".join(grid(view, "Hz", "m/s²", unit="")) + "".join(lines)
    return (
        f'<figure class="spectrum">{head}<svg viewBox="0 0 {view.width_px:.0f} {_HEIGHT_PX:.0f}" '
        f'role="img" aria-label="Vibration spectrum">{drawn}</svg>'
        f'<figcaption><b class="a0">x</b> <b class="a1">y</b> <b class="a2">z</b> '
        f"{text(caption)}</figcaption></figure>"
    )
