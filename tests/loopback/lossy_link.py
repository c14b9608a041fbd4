"""A simulated radio link: datagrams go in, and come out late, twice, out of order, broken or never.

Pure: time is passed in, and every accident comes from one seeded generator.
"""

from __future__ import annotations

import heapq
import random
from dataclasses import dataclass, field

NEVER_NS = 1 << 62


@dataclass(frozen=True, slots=True)
class Weather:
    """Probabilities a datagram, and its delay: uniform between the two, in seconds."""

    loss: float = 0.0
    duplicate: float = 0.0
    corrupt: float = 0.0
    delay_s: tuple[float, float] = (0.001, 0.001)


CLEAR = Weather()


@dataclass(slots=True)
class Air:
    """One direction of the link.  A spread of delays reorders by itself."""

    weather: Weather
    seed: int
    _random: random.Random = field(init=False)
    _flying: list[tuple[int, int, bytes]] = field(init=False, default_factory=list)
    _count: int = field(init=False, default=0)

    def __post_init__(self) -> None:
        self._random = random.Random(self.seed)

    def send(self, data: bytes, now_ns: int) -> None:
        """Off it goes, and may arrive."""
        dice, weather = self._random, self.weather
        if dice.random() < weather.loss:
            return
        if dice.random() < weather.corrupt:
            broken = bytearray(data)
            broken[dice.randrange(len(broken))] ^= 1 << dice.randrange(8)
            data = bytes(broken)
        copies = 2 if dice.random() < weather.duplicate else 1
        least_s, most_s = weather.delay_s
        for _ in range(copies):
            delay_ns = round((least_s + (most_s - least_s) * dice.random()) * 1e9)
            self._count += 1
            heapq.heappush(self._flying, (now_ns + delay_ns, self._count, data))

    @property
    def next_ns(self) -> int:
        """When the next datagram arrives; `NEVER_NS` where none is under way."""
        return self._flying[0][0] if self._flying else NEVER_NS

    def arrived(self, now_ns: int) -> list[bytes]:
        """What has arrived by now, in order of arrival."""
        out = []
        while self._flying and self._flying[0][0] <= now_ns:
            out.append(heapq.heappop(self._flying)[2])
        return out
