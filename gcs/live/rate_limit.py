"""How often something may be asked by viewers: a token bucket."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(slots=True)
class RateLimit:
    """So many a second, and a few more at once."""

    per_second: float
    burst: float
    level: float
    at_ns: int

    @classmethod
    def full(cls, per_second: float, burst: float, now_ns: int) -> RateLimit:
        return cls(per_second, burst, burst, now_ns)

    def take(self, now_ns: int) -> bool:
        self.level = min(self.burst, self.level + (now_ns - self.at_ns) * self.per_second / 1e9)
        self.at_ns = now_ns
        if self.level < 1.0:
            return False
        self.level -= 1.0
        return True
