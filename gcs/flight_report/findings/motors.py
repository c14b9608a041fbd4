"""The motors: whether some must give more than the others, and whether hovering takes more at once.

An autopilot makes good for a weak motor, a shifted load or a lost propeller by what it tells the
motors: there it is seen before anything else is.
"""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass, field
from math import inf

from gcs.flight_report.facts import Fact, Pose, Sample
from gcs.flight_report.findings.finding import Check, Finding, Level, Limit, Result, Situation
from gcs.flight_report.sampled import MOTORS, MOTORS_OF

_OWN = "this project's own choice"
UNEVEN = Limit(8.0, "%", _OWN)
"""Between the motor that gives most and that which gives least, on the mean of `WINDOW_S`."""
TORN = Limit(40.0, "%", _OWN)
"""The same on the mean of a second, also in fast flight: control is being lost."""
MORE = Limit(8.0, "%", _OWN)
"""What hovering takes more or less than up to `MEMORY_S` before; a battery that empties takes more
slowly."""
WINDOW_S, MEMORY_S = 2.0, 12.0
SLOW_M_S, LEVEL_M_S = 2.0, 0.5
"""In fast flight, and in climbs, motors differ by the way that they go."""
LEANT_DEG = 8.0
"""Who leans more hovers in a wind, which takes more of the motors."""
LOW_M, HIGH_M, SETTLED_S = 1.0, 2.0, 4.0
"""At touch-down motors differ, and idle, until the vehicle knows some seconds later that it stands:
so high is in the air, and a hover of which no landing follows within so long."""
_LEAST_SAMPLES = 4
_IN_USE = 5.0
"""Per cent: a channel that never gives so much is no motor."""


@dataclass(slots=True)
class _Window:
    """The mean of the motors over some time."""

    seconds: float
    began_s: float = 0.0
    count: int = 0
    sums: list[float] = field(default_factory=list)

    def add(self, t_s: float, values: tuple[float | None, ...]) -> tuple[float, list[float]] | None:
        """Begin and means of the window that this sample ends, if it ends one."""
        known = [0.0 if value is None else value for value in values]
        ended = None
        if self.count and t_s - self.began_s >= self.seconds:
            if self.count >= _LEAST_SAMPLES and t_s - self.began_s < 2.0 * self.seconds:
                ended = self.began_s, [total / self.count for total in self.sums]
            self.count = 0
        if not self.count:
            self.began_s, self.sums = t_s, [0.0] * len(known)
        self.count += 1
        self.sums = [total + value for total, value in zip(self.sums, known, strict=True)]
        return ended

    def rest(self) -> None:
        self.count = 0


@dataclass(slots=True)
class MotorsDetector:
    slow: bool = False
    hover: _Window = field(default_factory=lambda: _Window(WINDOW_S))
    second: _Window = field(default_factory=lambda: _Window(1.0))
    before: deque[tuple[float, float]] = field(default_factory=deque)
    """When hovering took how much."""
    suspect: tuple[float, str] | None = None
    """Since when, and which motors gave more than the others in the last window."""
    uneven: tuple[float, str, float] | None = None
    torn: tuple[float, str, float] | None = None
    more: tuple[float, float, float] | None = None
    most_uneven: float | None = None
    ground_up_m: float | None = None
    up_m: float = inf
    """Above where it stood last; infinite where the record begins in the air."""
    settling: deque[tuple[float, float, list[float]]] = field(default_factory=deque)
    """Windows that are judged once it is known that no landing followed: when they ended, then as
    `_hovered` takes them."""

    def handle(self, fact: Fact, now: Situation) -> None:
        if isinstance(fact, Pose):
            slow = fact.groundspeed_mps < SLOW_M_S and abs(fact.climb_mps) < LEVEL_M_S
            self.slow = slow and max(abs(fact.roll_deg), abs(fact.pitch_deg)) < LEANT_DEG
            if not now.flying:
                self.ground_up_m = fact.pos_enu[2]
            self.up_m = inf if self.ground_up_m is None else fact.pos_enu[2] - self.ground_up_m
        if not isinstance(fact, Sample) or fact.plot != "motors":
            return
        if not now.in_air:
            self.hover.rest()
            self.second.rest()
            self.settling.clear()
            return
        while self.settling and now.t_s - self.settling[0][0] > SETTLED_S:
            self._hovered(*self.settling.popleft()[1:])
        values = fact.values[: MOTORS_OF.get(now.kind, MOTORS)]
        ended = self.second.add(now.t_s, values)
        if ended is not None and self.up_m > HIGH_M:
            self._second(*ended)
        if not self.slow or self.up_m < LOW_M:
            self.hover.rest()
            return
        ended = self.hover.add(now.t_s, values)
        if ended is not None:
            self.settling.append((now.t_s, *ended))

    def _second(self, t_s: float, means: list[float]) -> None:
        spread, names = _spread(means)
        if spread > TORN.value and self.torn is None:
            self.torn = t_s, names, spread

    def _hovered(self, t_s: float, means: list[float]) -> None:
        spread, names = _spread(means)
        self.most_uneven = max(self.most_uneven or 0.0, spread)
        if spread <= UNEVEN.value:
            self.suspect = None
        elif self.suspect is None:
            self.suspect = t_s, names
        elif self.uneven is None:
            self.uneven = self.suspect[0], names, spread
        used = [mean for mean in means if mean > _IN_USE]
        level = sum(used) / len(used) if used else 0.0
        while self.before and t_s - self.before[0][0] > MEMORY_S:
            self.before.popleft()
        for _, earlier in self.before:
            if abs(level - earlier) > MORE.value and self.more is None:
                self.more = t_s, earlier, level
        self.before.append((t_s, level))

    def result(self, now: Situation) -> Result:
        result = Result()
        if self.torn is not None:
            t_s, names, spread = self.torn
            detail = f"by {spread:.0f} % in a second's mean"
            title = f"{names} had to give far more than the rest"
            result.findings.append(
                Finding("motors", Level.CRITICAL, t_s, title, detail, source=TORN.source)
            )
        if self.uneven is not None:
            t_s, names, spread = self.uneven
            title = f"{names} had to give more than the rest"
            detail = f"by {spread:.0f} % where it hovered or flew slowly"
            result.findings.append(
                Finding(
                    "motors", Level.WARNING, t_s, title, detail, source=UNEVEN.source, mild=True
                )
            )
        if self.more is not None:
            t_s, earlier, level = self.more
            way = "more" if level > earlier else "less"
            title = f"hovering took {way} thrust at once"
            detail = f"the motors give {level:.0f} % after {earlier:.0f} %"
            result.findings.append(
                Finding("thrust", Level.WARNING, t_s, title, detail, source=MORE.source, mild=True)
            )
        level_ = None if self.most_uneven is None else Level.OK
        if self.torn is not None or self.uneven is not None:
            level_ = Level.CRITICAL if self.torn is not None else Level.WARNING
        measured = "" if self.most_uneven is None else f"at most {self.most_uneven:.0f} % apart"
        told = f"at most {UNEVEN.value:g} % in hover for {2 * WINDOW_S:g} s"
        result.checks.append(Check("motors", "Motors", measured, told, UNEVEN.source, level_))
        return result


def _spread(means: list[float]) -> tuple[float, str]:
    """How far they are apart, and which of them give more than the middle."""
    four = len(means) <= 4
    used = {number: mean for number, mean in enumerate(means, 1) if four or mean > _IN_USE}
    if len(used) < 2:
        return 0.0, ""
    low, high = min(used.values()), max(used.values())
    above = [str(number) for number, mean in used.items() if mean > (low + high) / 2]
    names = f"motor {above[0]}" if len(above) == 1 else f"motors {' and '.join(above)}"
    return high - low, names
