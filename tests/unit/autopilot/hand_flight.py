"""A flight script with a pilot: sticks that are held, at 10 Hz."""

from __future__ import annotations

from copy import deepcopy
from functools import cache
from math import hypot

from tests.unit.autopilot.flight import Flight
from vehicle_sim.autopilot.interface import Result
from vehicle_sim.autopilot.modes import MODES, Personality


class HandFlight(Flight):
    """`hold(s, ...)` keeps a joystick where it is; all axes are -1000..1000, up 0..1000."""

    def hold(
        self, seconds: float, forward: int = 0, right: int = 0, up: int = 500, clockwise: int = 0
    ) -> None:
        for _ in range(round(seconds * 10)):
            self.vehicle.joystick(forward, right, up, clockwise, self.vehicle.time_ns)
            self.fly(0.1)

    def airborne(self, up_m: float = 5.0) -> HandFlight:
        super().airborne(up_m)
        return self

    def mode(self, name: str) -> Result:
        return self.vehicle.set_mode(1, MODES[self.personality][name].custom_mode)

    def up_by_hand(self, name: str) -> HandFlight:
        """Booted, armed in that mode and climbed with the stick; then centred."""
        self.fly(20.0)
        assert self.mode(name) is Result.ACCEPTED
        self.hold(0.5, up=0)
        assert self.vehicle.arm(False) is Result.ACCEPTED
        self.hold(4.0, up=900)
        self.hold(3.0)
        return self

    @classmethod
    def by_hand(cls, personality: Personality, name: str) -> HandFlight:
        """As `up_by_hand`, flown once, and a copy for each test."""
        return deepcopy(_up_by_hand(personality, name))

    @property
    def flat_m_s(self) -> float:
        return hypot(*self.vehicle.truth.v_ned[:2])


@cache
def _up_by_hand(personality: Personality, name: str) -> HandFlight:
    return HandFlight(personality).up_by_hand(name)
