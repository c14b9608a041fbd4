"""Down without a position."""

from __future__ import annotations

from dataclasses import dataclass, replace

from vehicle_sim.autopilot.control.demands import Demand, FlyLevel, Situation, Turner
from vehicle_sim.autopilot.interface import Landed, Target
from vehicle_sim.autopilot.parameters.parameters import Parameters
from vehicle_sim.autopilot.tasks.descent_rate import descent_m_s

_BELOW_M = 1000.0


@dataclass(slots=True, eq=False, repr=False)
class Descend:
    """Level, the wind may carry it (PX4's Descend, ArduCopter's LAND without a position).

    Sinks as a landing does, slower near the ground; never asks where it is.
    """

    landed_word = Landed.LANDING
    done = False

    _parameters: Parameters

    @property
    def target(self) -> Target:
        return Target(None, None, None)

    def lifts_off(self, s: Situation) -> bool:
        return False

    def begin(self, s: Situation, turner: Turner) -> None:
        pass

    def update(self, s: Situation, turner: Turner) -> Demand:
        up_m = s.home_ned[2] - s.pos_ned[2]
        descend_m_s = descent_m_s(self._parameters, up_m, s.limits.descend_m_s)
        return FlyLevel(s.home_ned[2] + _BELOW_M, replace(s.limits, descend_m_s=descend_m_s))
