"""How often messages come: which count, their mean rate, and the spread of the times between."""

from __future__ import annotations

import itertools
import math
from collections import deque
from dataclasses import dataclass

import msgspec

from gcs.report import Direction
from gcs.topics.topic import Heard

LIST_SPAN_S = 1.0
"""A burst that is over sooner has no rate in a list."""
DEFAULT_WINDOW = 10_000
"""Messages, as `ros2 topic hz` has it."""


class Crossings:
    """Of a component that is heard, the frames that were received: what a bridge passes on of it,
    answers in its name, or refuses of another one that calls itself so, is not its own traffic.
    Of a component that is only sent, such as the station itself, all of them.
    """

    def __init__(self, *, each_topic: bool = False) -> None:
        """`each_topic`: what is sent, or refused, and received of nobody counts for its topic."""
        self._each_topic = each_topic
        self._received: set[str] = set()

    def counts(self, heard: Heard) -> bool:
        """Messages are given in the order of the record."""
        direction = heard.direction
        if direction is None:
            return True
        name = heard.topic.name
        source = name if self._each_topic else name.rpartition("/")[0]
        if direction == Direction.RECEIVED:
            self._received.add(source)
            return True
        return source not in self._received


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
