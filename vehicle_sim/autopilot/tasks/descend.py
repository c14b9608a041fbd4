"""Down where there is nobody to land it: without a position, or without sticks."""

from __future__ import annotations

from dataclasses import replace

from vehicle_sim.autopilot.control.demands import Demand, FlyLevel, FlyTo, Situation, Turner
from vehicle_sim.autopilot.interface import Landed, Target
from vehicle_sim.autopilot.parameters.parameters import Parameters
from vehicle_sim.autopilot.tasks.descent_rate import descent_m_s
from vehicle_sim.numerics.vectors import Vec3

_BELOW_M = 1000.0


class Descend:
    """Level, the wind may carry it (PX4's Descend, ArduCopter's LAND without a position).

    Sinks as a landing does, slower near the ground; never asks where it is.
    """

    landed_word = Landed.LANDING
    done = False

    __slots__ = ("_parameters",)

    def __init__(self, parameters: Parameters) -> None:
        self._parameters = parameters

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


class SinkInPlace:
    """PX4's position mode without sticks: it keeps its place and comes down to the ground.

    Recorded with 0.70 to 0.85 m/s after OFFBOARD was lost (behaviour.json): half of
    MPC_Z_VEL_MAX_DN.
    """

    landed_word = Landed.IN_AIR
    done = False

    __slots__ = ("_parameters", "_where_ned")

    def __init__(self, parameters: Parameters) -> None:
        self._parameters = parameters
        self._where_ned: Vec3 | None = None

    @property
    def target(self) -> Target:
        return Target(self._where_ned, None, None)

    def lifts_off(self, s: Situation) -> bool:
        return False

    def begin(self, s: Situation, turner: Turner) -> None:
        self._where_ned = s.stop_ned

    def update(self, s: Situation, turner: Turner) -> Demand:
        north, east, _ = self._where_ned or s.stop_ned
        limits = replace(s.limits, descend_m_s=0.5 * self._parameters.get("MPC_Z_VEL_MAX_DN"))
        return FlyTo((north, east, s.pos_ned[2] + _BELOW_M), limits, straight=False)
