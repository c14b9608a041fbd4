"""How often, how long and how far a value was beyond its limit."""

from __future__ import annotations

from dataclasses import dataclass
from math import isfinite


@dataclass(slots=True)
class Spells:
    """The spells beyond a limit, taken together."""

    count: int = 0
    first_s: float = 0.0
    last_s: float = 0.0
    total_s: float = 0.0
    _began_s: float | None = None

    @property
    def open(self) -> bool:
        """It is beyond the limit now."""
        return self._began_s is not None

    @property
    def spell_s(self) -> float:
        """How long the present spell lasts, so far."""
        return 0.0 if self._began_s is None else self.last_s - self._began_s

    def update(self, t_s: float, beyond: bool) -> None:
        if self._began_s is not None:
            self.total_s += max(0.0, t_s - self.last_s)
            self.last_s = t_s
            if not beyond:
                self._began_s = None
        elif beyond:
            self.first_s = t_s if not self.count else self.first_s
            self.count += 1
            self._began_s = self.last_s = t_s

    @property
    def words(self) -> str:
        """ "for 8.0 s", "3 times, 12.5 s in all"; a spell ends with the first good value."""
        if self.count == 1:
            return f"for {self.total_s:.1f} s"
        return f"{self.count} times, {self.total_s:.1f} s in all"


@dataclass(slots=True)
class Worst:
    """The largest (or, with `sign` -1, the smallest) value and when it was."""

    sign: int = 1
    value: float | None = None
    t_s: float = 0.0

    def update(self, t_s: float, value: float | None) -> None:
        if value is None or not isfinite(value):
            return
        if self.value is None or self.sign * value > self.sign * self.value:
            self.value, self.t_s = value, t_s
