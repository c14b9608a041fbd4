"""NAV_GUIDED_ENABLE: a mission that waits for somebody else to guide, within DO_GUIDED_LIMITS.

By ArduCopter's ModeGuided::limit_check, from memory.  Here nobody guides meanwhile: setpoints are
not taken in AUTO, so it holds its place until a limit strikes.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from math import hypot

from vehicle_sim.autopilot.control.demands import Demand, FlyTo, Situation, Turner
from vehicle_sim.autopilot.interface import Landed, Target
from vehicle_sim.numerics.vectors import Vec3


@dataclass(frozen=True, slots=True)
class GuidedLimits:
    """0 = no such limit; heights above home."""

    most_s: float = 0.0
    least_up_m: float = 0.0
    most_up_m: float = 0.0
    most_away_m: float = 0.0


@dataclass(slots=True, eq=False, repr=False)
class AwaitGuidance:
    """Over when a limit strikes; without one, never.  `limits` may come after its begin."""

    landed_word = Landed.IN_AIR

    _place_ned: Vec3
    _limits: Callable[[], GuidedLimits]
    _since_ns: int | None = field(default=None, init=False)

    @property
    def target(self) -> Target:
        return Target(self._place_ned, None, None)

    def done(self, s: Situation) -> bool:
        if self._since_ns is None:
            self._since_ns = s.time_ns
        limits = self._limits()
        up_m = s.home_ned[2] - s.pos_ned[2]
        north = s.pos_ned[0] - self._place_ned[0]
        east = s.pos_ned[1] - self._place_ned[1]
        return (
            (limits.most_s > 0.0 and s.time_ns - self._since_ns >= int(limits.most_s * 1e9))
            or (limits.least_up_m != 0.0 and up_m < limits.least_up_m)
            or (limits.most_up_m != 0.0 and up_m > limits.most_up_m)
            or (limits.most_away_m > 0.0 and hypot(north, east) > limits.most_away_m)
        )

    def update(self, s: Situation, turner: Turner) -> Demand:
        return FlyTo(self._place_ned, s.limits)
