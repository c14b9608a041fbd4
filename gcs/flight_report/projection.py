"""Metres -> pixels of one view, with a grid of round metres."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from math import ceil, floor, log10


@dataclass(frozen=True, slots=True)
class Box:
    """The part of a plane that a view shows, metres."""

    left: float
    right: float
    bottom: float
    top: float

    @property
    def width(self) -> float:
        return self.right - self.left

    @property
    def height(self) -> float:
        return self.top - self.bottom

    def holds(self, x: float, y: float) -> bool:
        return self.left <= x <= self.right and self.bottom <= y <= self.top

    def joined(self, other: Box) -> Box:
        return Box(
            min(self.left, other.left),
            max(self.right, other.right),
            min(self.bottom, other.bottom),
            max(self.top, other.top),
        )

    def padded(self, share: float, least_m: float) -> Box:
        pad_x, pad_y = (max(share * size, least_m) for size in (self.width, self.height))
        return Box(self.left - pad_x, self.right + pad_x, self.bottom - pad_y, self.top + pad_y)

    def at_least(self, width: float, height: float) -> Box:
        """Grown about its middle to this size."""
        more_x = max(0.0, width - self.width) / 2
        more_y = max(0.0, height - self.height) / 2
        return Box(self.left - more_x, self.right + more_x, self.bottom - more_y, self.top + more_y)


def box_of(points: Iterable[tuple[float, float]]) -> Box | None:
    """None where there are no points."""
    listed = list(points)
    if not listed:
        return None
    xs, ys = zip(*listed, strict=True)
    return Box(min(xs), max(xs), min(ys), max(ys))


@dataclass(frozen=True, slots=True)
class View:
    """`box` in a picture of `width_px` by `height_px`, y upwards; the scales may differ."""

    box: Box
    width_px: float
    height_px: float

    @property
    def x_scale(self) -> float:
        """Pixels a metre."""
        return self.width_px / self.box.width

    @property
    def y_scale(self) -> float:
        return self.height_px / self.box.height

    def px(self, x: float, y: float) -> tuple[float, float]:
        return (x - self.box.left) * self.x_scale, (self.box.top - y) * self.y_scale


def round_step(span: float, steps: int) -> float:
    """1, 2 or 5 times a power of ten, so that `span` has about that many steps."""
    rough = max(span, 1e-6) / max(1, steps)
    power = 10.0 ** floor(log10(rough))
    return next((f * power for f in (1.0, 2.0, 5.0) if f * power >= rough), 10.0 * power)


def ticks(low: float, high: float, steps: int) -> list[float]:
    """Round values from `low` to `high`."""
    step = round_step(high - low, steps)
    first = ceil(low / step - 1e-9)
    last = floor(high / step + 1e-9)
    return [number * step for number in range(first, last + 1)]
