"""The spectrum of the accelerations in the air: at which frequencies it shakes.

Segments of `SEGMENT` samples at an even rate are transformed, and their power averaged (Welch
1967, Hann window, no overlap), so the memory does not grow with the flight.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

from gcs.frames import Vec3

SEGMENT = 256
MOTOR_HZ = 20.0
"""What turns and shakes a multirotor is faster: a rate of less than twice this shows none of it."""
_UNEVEN = 3.0
"""A step of so many times the mean is a gap: the segment is dropped."""
_MOST_CHANGE = 0.2
"""A segment whose rate differs by more from the first one's is dropped."""


@dataclass(slots=True)
class Spectrum:
    """Samples come in by `add`, `amplitudes` is what came out."""

    segments: int = 0
    rate_hz: float | None = None
    """Of the first segment."""
    _times: list[float] = field(default_factory=list)
    _values: list[Vec3] = field(default_factory=list)
    _power: Any = None

    def add(self, t_s: float, xyz: Vec3) -> None:
        if self._times and t_s <= self._times[-1]:
            return
        self._times.append(t_s)
        self._values.append(xyz)
        if len(self._times) == SEGMENT:
            self._transform()
            self.rest()

    def rest(self) -> None:
        """It is not in the air: what has been gathered is no whole segment."""
        self._times.clear()
        self._values.clear()

    @property
    def too_slow(self) -> bool:
        return self.rate_hz is not None and self.rate_hz < 2.0 * MOTOR_HZ

    def amplitudes(self) -> list[tuple[float, tuple[float, ...]]]:
        """Of each frequency in Hz: m/s² in x, y and z; empty where the samples come too slowly."""
        if self._power is None or self.rate_hz is None or self.too_slow:
            return []
        import numpy as np

        rows = np.sqrt(self._power / self.segments)
        # The first is the mean, which was taken out.
        hertz = [number * self.rate_hz / SEGMENT for number in range(1, len(rows))]
        return list(zip(hertz, map(tuple, rows[1:].tolist()), strict=True))

    def _transform(self) -> None:
        import numpy as np

        times = np.array(self._times)
        steps = np.diff(times)
        mean_s = float(steps.mean())
        rate_hz = 1.0 / mean_s
        if self.rate_hz is None:
            self.rate_hz = rate_hz
        uneven = float(steps.max()) > _UNEVEN * mean_s
        if uneven or abs(rate_hz / self.rate_hz - 1.0) > _MOST_CHANGE:
            return
        values = np.array(self._values)
        window = np.hanning(SEGMENT)
        lines = np.fft.rfft((values - values.mean(axis=0)) * window[:, None], axis=0)
        # The amplitude of a sine at this frequency: half of it is at the negative one.
        power = (np.abs(lines) * 2.0 / window.sum()) ** 2
        self._power = power if self._power is None else self._power + power
        self.segments += 1
