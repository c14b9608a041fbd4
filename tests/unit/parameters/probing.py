"""What a parameter changes: the same script with different values, and what is measured.

A `Case` is one parameter: what the script measures for each of at least two values of it.  Scripts
get a `Setting`, and take from it a vehicle at home or in the air to which the values apply.
"""

from __future__ import annotations

from collections.abc import Callable
from copy import deepcopy
from dataclasses import dataclass, field
from functools import cache
from math import hypot
from typing import Any

import pytest

from tests.unit.autopilot.hand_flight import HandFlight
from vehicle_sim.autopilot.manual.sticks import Sticks
from vehicle_sim.autopilot.modes import Personality
from vehicle_sim.autopilot.parameters.parameters import Parameters
from vehicle_sim.numerics.vectors import Vec3

UP_M = 12.0
S = 1_000_000_000


@cache
def _booted(personality: Personality) -> HandFlight:
    flight = HandFlight(personality)
    flight.boot()
    return flight


@dataclass(frozen=True, slots=True)
class Setting:
    """Values of parameters, for whatever the script flies or asks."""

    personality: Personality
    values: dict[str, float]

    def parameters(self) -> Parameters:
        parameters = Parameters(self.personality)
        self._set(parameters)
        return parameters

    def fresh(self) -> HandFlight:
        """Not yet booted."""
        flight = HandFlight(self.personality)
        self._set(flight.vehicle.parameters)
        return flight

    def at_home(self) -> HandFlight:
        """Booted, on the ground."""
        return self._with_values(deepcopy(_booted(self.personality)))

    def aloft(self, hover_s: float = 0.0) -> HandFlight:
        """Hovering at `UP_M`: px4 in AUTO.LOITER, ardupilot in GUIDED.

        The values apply after `hover_s`, in which the rest of the climb dies away.
        """
        hovering = HandFlight.hovering(self.personality, UP_M)
        hovering.fly(hover_s)
        flight = self._with_values(hovering)
        flight.fly(0.2)
        return flight

    def _with_values(self, flight: HandFlight) -> HandFlight:
        flight.seen.clear()
        self._set(flight.vehicle.parameters)
        return flight

    def _set(self, parameters: Parameters) -> None:
        for name, value in self.values.items():
            parameters.set(name, value)


Script = Callable[[Setting], object]
Act = Callable[[HandFlight], object]


@dataclass(frozen=True, slots=True)
class Case:
    """`expected`: what `script` measures by value; `also`: other parameters, the same each time."""

    name: str
    expected: dict[float, object]
    script: Script
    also: dict[str, float] = field(default_factory=dict)

    def measure(self, personality: Personality) -> dict[float, object]:
        return {
            value: self.script(Setting(personality, {**self.also, self.name: value}))
            for value in self.expected
        }


def highest(flight: HandFlight, seconds: float, look: Callable[[HandFlight], float]) -> float:
    """The largest that is seen while it flies, every 20 ms."""
    most = look(flight)
    for _ in range(round(seconds * 50)):
        flight.fly(0.02)
        most = max(most, look(flight))
    return most


def flat_m_s(flight: HandFlight) -> float:
    return hypot(*flight.vehicle.truth.v_ned[:2])


def climb_m_s(flight: HandFlight) -> float:
    return -flight.vehicle.truth.v_ned[2]


def sink_m_s(flight: HandFlight) -> float:
    return flight.vehicle.truth.v_ned[2]


def where(flight: HandFlight) -> Vec3:
    return flight.vehicle.estimate.pos_ned


def hand(roll: float = 0.0, pitch: float = 0.0, yaw: float = 0.0, throttle: float = 0.5) -> Sticks:
    return Sticks(roll, pitch, yaw, throttle)


def near(value: float, by: float) -> Any:
    """That value, give or take."""
    return pytest.approx(value, abs=by)


def about(value: float) -> Any:
    """That value, give or take 12 %."""
    return pytest.approx(value, rel=0.12)


def itself(by: float, *values: float) -> dict[float, object]:
    """What is measured is the parameter's own value, give or take."""
    return {value: near(value, by) for value in values}
