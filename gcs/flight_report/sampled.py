"""Plots whose columns come in several messages: what is measured and what was wanted of it.

A row is drawn when its leading message comes, with what the other columns had last.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from gcs.flight_report.series import Series

_AXES = ("roll", "pitch", "yaw")
_WANTED = tuple(f"{axis} wanted" for axis in _AXES)
WANTED = 3
"""Where in "attitude", "rates" and "place" the columns of what was wanted begin."""
MOTORS = 8
MOTORS_OF = {"quadrotor": 4, "hexarotor": 6, "octorotor": 8, "tricopter": 3}
"""By the kind of vehicle: what else is driven has the channels after them."""

COLUMNS: Mapping[str, tuple[str, ...]] = {
    "attitude": (*_AXES, *_WANTED),  # degrees
    "rates": (*_AXES, *_WANTED),  # degrees a second
    "place": ("east", "north", "up", "east wanted", "north wanted", "up wanted"),  # metres
    "motors": tuple(f"motor {n}" for n in range(1, MOTORS + 1)),  # per cent
    "sticks": ("roll", "pitch", "throttle", "yaw"),  # per cent, -100 to 100
    "wind": ("speed", "from"),  # m/s, degrees
}
OLDEST_S = 2.0
"""What was told longer ago counts as not known."""


@dataclass(slots=True)
class Sampled:
    """One of these plots while its columns come in."""

    series: Series
    _last: list[tuple[float, float | None]] = field(default_factory=list)

    @classmethod
    def of(cls, plot: str) -> Sampled:
        names = COLUMNS[plot]
        return cls(Series(names), [(0.0, None)] * len(names))

    def take(self, t_s: float, first: int, values: tuple[float | None, ...], leads: bool) -> None:
        for column, value in enumerate(values[: len(self._last) - first], first):
            self._last[column] = (t_s, value)
        if leads:
            row = [value if t_s - at_s <= OLDEST_S else None for at_s, value in self._last]
            self.series.add(t_s, row)
