"""How often messages come: mean rate, and the spread of the times between them."""

from __future__ import annotations

import itertools
import math
from collections import deque
from dataclasses import dataclass

import msgspec

LIST_SPAN_S = 1.0
"""A burst that is over sooner has no rate in a list."""
DEFAULT_WINDOW = 10_000
"""Messages, as `ros2 topic hz` has it."""


class Rate(msgspec.Struct, frozen=True):
    """Of the times between the messages of a window; seconds.  `window`: the messages in it."""

    hz: float
    min_s: float
    max_s: float
    std_dev_s: float
    window: int


@dataclass(slots=True)
class Intervals:
    """The times of the newest messages of one topic; `window` None: of all."""

    times_ns: deque[int]
    total: int = 0

    @classmethod
    def over(cls, window: int | None) -> Intervals:
        return cls(deque(maxlen=window))

    def add(self, time_ns: int) -> None:
        self.times_ns.append(time_ns)
        self.total += 1

    def rate(self, least_span_s: float = 0.0) -> Rate | None:
        """None with fewer than two messages, or where all came within `least_span_s`."""
        times = [*self.times_ns]
        gaps_s = [(after - before) / 1e9 for before, after in itertools.pairwise(times)]
        span_s = math.fsum(gaps_s)
        if not gaps_s or span_s <= least_span_s:
            return None
        mean_s = span_s / len(gaps_s)
        variance = math.fsum((gap_s - mean_s) ** 2 for gap_s in gaps_s) / len(gaps_s)
        return Rate(1.0 / mean_s, min(gaps_s), max(gaps_s), math.sqrt(variance), len(times))
