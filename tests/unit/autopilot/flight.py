"""A flight script: a vehicle, and words to let time pass and to look at it."""

from __future__ import annotations

from collections.abc import Callable
from copy import deepcopy
from functools import cache
from math import nan, sqrt
from typing import Self

from vehicle_sim.autopilot.autopilot import Autopilot
from vehicle_sim.autopilot.boot import Boot
from vehicle_sim.autopilot.interface import (
    Geodetic,
    Landed,
    PlanItem,
    Result,
    Setpoint,
    StatusText,
    VehicleEvent,
)
from vehicle_sim.autopilot.modes import Personality
from vehicle_sim.engine.scalar_engine import ScalarEngine
from vehicle_sim.engine.step import Seat, VehicleSpec
from vehicle_sim.numerics.vectors import Vec3
from vehicle_sim.plant.airframe import load

HOMES: dict[Personality, Geodetic] = {
    "px4": Geodetic(47.397742, 8.545594, 488.0),
    "ardupilot": Geodetic(-35.363262, 149.165237, 584.0),
}


class Flight:
    """One vehicle and its past events.  `fly(s)` lets simulated seconds pass."""

    def __init__(
        self,
        personality: Personality,
        seed: int = 1,
        boot: Boot = "quick",
        airframe: str = "s500",
    ) -> None:
        home = HOMES[personality]
        seat = Seat(ScalarEngine([VehicleSpec(seed, 0, home.lat_deg)], load(airframe)), 0)
        self.vehicle = Autopilot(personality, home, seed, seat=seat, boot=boot)
        self.personality: Personality = personality
        self.seen: list[VehicleEvent] = []

    def fly(self, seconds: float, until: Callable[[], bool] | None = None) -> float:
        """Advance, at most `seconds`, or until something is so; returns the seconds flown."""
        steps = round(seconds * 250)
        for step in range(steps):
            self.vehicle.step()
            if until is not None and step % 5 == 0 and until():
                self.seen += self.vehicle.events()
                return (step + 1) / 250
        self.seen += self.vehicle.events()
        assert until is None, f"did not happen within {seconds} s: {self}"
        return seconds

    def stream(self, setpoint: Setpoint, seconds: float) -> None:
        """Advance with the setpoint coming at 20 Hz."""
        for tick in range(round(seconds * 20)):
            self.vehicle.set_setpoint(setpoint)
            for _ in range(12 + tick % 2):
                self.vehicle.step()
        self.seen += self.vehicle.events()

    def boot(self) -> Flight:
        self.fly(1.5)
        return self

    def airborne(self, up_m: float = 5.0) -> Flight:
        """Booted, armed, taken off and hovering; PX4 up to NAV_MC_ALT_RAD below `up_m`."""
        self.boot()
        if self.personality == "ardupilot":
            assert self.vehicle.set_mode_kind("guided") is Result.ACCEPTED
        assert self.vehicle.arm(False) is Result.ACCEPTED
        assert self.vehicle.take_off(up_m) is Result.ACCEPTED
        self.fly(20.0, lambda: self.vehicle.landed is Landed.IN_AIR)
        self.fly(3.0)
        return self

    @classmethod
    def hovering(cls, personality: Personality, up_m: float = 5.0, seed: int = 1) -> Self:
        """As `airborne`, for a vehicle as it is delivered: flown once, and a copy for each test."""
        made: Callable[[Personality, int], Flight] = cls
        flight = deepcopy(_airborne(made, personality, up_m, seed))
        assert isinstance(flight, cls)
        return flight

    def texts(self) -> list[str]:
        return [event.text for event in self.seen if isinstance(event, StatusText)]

    def landed(self) -> Landed:
        return self.vehicle.landed

    def armable(self) -> bool:
        return self.vehicle.armable

    def capturing(self) -> bool:
        return self.vehicle.capturing

    @property
    def pos(self) -> Vec3:
        """Where it believes to be: what a flight can be judged by.  See `astray_m`."""
        return self.vehicle.estimate.pos_ned

    @property
    def astray_m(self) -> float:
        """How far the truth is from there."""
        return self.off(self.vehicle.truth.pos_ned)

    @property
    def up_m(self) -> float:
        """In truth."""
        return -self.vehicle.truth.pos_ned[2]

    @property
    def speed_m_s(self) -> float:
        n, e, d = self.vehicle.truth.v_ned
        return sqrt(n * n + e * e + d * d)

    def off(self, goal: Vec3) -> float:
        n, e, d = (a - b for a, b in zip(self.pos, goal, strict=True))
        return sqrt(n * n + e * e + d * d)

    def __str__(self) -> str:
        v = self.vehicle
        return f"{v.mode_name} {v.landed.name} armed={v.armed} at {self.pos} {self.texts()[-3:]}"


@cache
def _airborne(
    made: Callable[[Personality, int], Flight], personality: Personality, up_m: float, seed: int
) -> Flight:
    return made(personality, seed).airborne(up_m)


def item(
    seq: int,
    command: int,
    north_m: float = 0.0,
    east_m: float = 0.0,
    up_m: float = 0.0,
    *,
    frame: int = 1,
    p1: float = 0.0,
    p2: float = 0.0,
    p3: float = 0.0,
    p4: float = nan,
) -> PlanItem:
    """A mission item in the local frame (1), or in `frame` with 1e-4 metres as they are."""
    x, y = round(north_m * 1e4), round(east_m * 1e4)
    return PlanItem(seq, frame, command, p1, p2, p3, p4, x, y, -up_m if frame == 1 else up_m, 1)
