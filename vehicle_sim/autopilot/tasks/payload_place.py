"""NAV_PAYLOAD_PLACE: over the place, down until the ground is felt, and up again.

By ArduCopter's ModeAuto::payload_place, from memory.  There is no gripper: nothing is let go.
"""

from __future__ import annotations

from dataclasses import replace
from enum import Enum, auto
from math import inf
from typing import Final

from vehicle_sim.autopilot.control.demands import Demand, FlyTo, Situation, Turner
from vehicle_sim.autopilot.interface import Landed, Target
from vehicle_sim.autopilot.parameters.parameters import Parameters, Quantity
from vehicle_sim.autopilot.tasks.tasks import distance
from vehicle_sim.numerics.vectors import Vec3

_OVER_M: Final = 1.0
_THERE_M: Final = 0.3
_BELOW_M: Final = 5.0
"""The goal of the descent lies so far below the vehicle."""
_SINKING_NS: Final = 2_000_000_000
"""After so long it sinks; who then sinks no more has felt the ground."""
_STILL_M_S: Final = 0.1


class _Stage(Enum):
    GO = auto()
    DOWN = auto()
    UP = auto()


class PlacePayload:
    """`most_m`: how far it descends if it feels no ground; 0 = as far as it takes."""

    landed_word = Landed.IN_AIR

    __slots__ = ("_lowest_d", "_parameters", "_place_ned", "_since_ns", "_stage")

    def __init__(self, parameters: Parameters, place_ned: Vec3, most_m: float) -> None:
        self._parameters = parameters
        self._place_ned = place_ned
        self._lowest_d = place_ned[2] + most_m if most_m > 0.0 else inf
        self._stage = _Stage.GO
        self._since_ns = 0

    @property
    def target(self) -> Target:
        return Target(self._place_ned, None, None)

    def done(self, s: Situation) -> bool:
        match self._stage:
            case _Stage.GO:
                if distance(s.pos_ned, self._place_ned) < _OVER_M:
                    self._stage, self._since_ns = _Stage.DOWN, s.time_ns
            case _Stage.DOWN:
                sunk = s.time_ns - self._since_ns >= _SINKING_NS and s.v_ned[2] < _STILL_M_S
                if sunk or s.pos_ned[2] >= self._lowest_d - _THERE_M:
                    self._stage = _Stage.UP
            case _Stage.UP:
                return distance(s.pos_ned, self._place_ned) < _THERE_M
        return False

    def update(self, s: Situation, turner: Turner) -> Demand:
        if self._stage is not _Stage.DOWN:
            return FlyTo(self._place_ned, s.limits)
        north, east, _ = self._place_ned
        below_d = min(s.pos_ned[2] + _BELOW_M, self._lowest_d)
        sink_m_s = self._parameters.si(Quantity.LAND_M_S)
        return FlyTo((north, east, below_d), replace(s.limits, descend_m_s=sink_m_s))
