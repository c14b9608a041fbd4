"""What a camera that looks straight down sees of flat ground, by the ratio of sensor and lens."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final


@dataclass(frozen=True, slots=True)
class Camera:
    """Millimetres and pixels; `width_px` None is not known.  Its width is across the way."""

    sensor_width_mm: float
    sensor_height_mm: float
    focal_mm: float
    width_px: int | None = None

    def footprint_m(self, height_m: float) -> tuple[float, float]:
        """Across and along the way, from that height."""
        scale = height_m / self.focal_mm
        return self.sensor_width_mm * scale, self.sensor_height_mm * scale


CAMERAS: Final = {
    "canon-s100": Camera(7.6, 5.7, 5.2, 4000),
    "dji-fc6310": Camera(13.2, 8.8, 8.8, 5472),
    "sony-a6000-16mm": Camera(23.5, 15.6, 16.0, 6000),
    "sony-rx0": Camera(13.2, 8.8, 7.7, 4800),
    "sony-qx1-16mm": Camera(23.2, 15.4, 16.0, 5456),
    "sony-rx100ii": Camera(13.2, 8.8, 10.4, 5472),
}
"""Some that fly often.  Sensor, lens and pixels are the makers' figures; those of sony-qx1 and
sony-rx0 were looked up, the others are from memory."""


@dataclass(frozen=True, slots=True)
class Pictures:
    """How far apart lines and pictures are; metres, and centimetres a pixel where that is known."""

    across_m: float
    along_m: float
    spacing_m: float
    trigger_m: float
    ground_cm_px: float | None = None


def pictures(
    footprint_m: tuple[float, float], front_pct: float, side_pct: float, width_px: int | None = None
) -> Pictures:
    """`front_pct` of a picture is on the next one of its line too, `side_pct` on those beside."""
    across_m, along_m = footprint_m
    return Pictures(
        across_m,
        along_m,
        across_m * (1.0 - side_pct / 100.0),
        along_m * (1.0 - front_pct / 100.0),
        None if width_px is None else 100.0 * across_m / width_px,
    )
