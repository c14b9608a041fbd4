"""A flight of a vehicle whose body is not what its autopilot believes, and its figures.

    python -m tests.unit.autopilot.mismatch

prints the table of all cases.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import degrees, hypot, remainder, tau
from typing import Final

from tests.unit.autopilot.flight import Flight
from vehicle_sim.autopilot.interface import Result
from vehicle_sim.autopilot.modes import Personality
from vehicle_sim.numerics.vectors import Vec3
from vehicle_sim.plant.faults import (
    CentreOfMass,
    InertiaScale,
    ModelFault,
    MotorFault,
    Payload,
    ThrustScale,
    WeakBattery,
    WindChange,
)

S500_KG: Final = 1.5
UP_M: Final = 10.0
SIDE_M: Final = 10.0
CORNERS: Final[tuple[Vec3, ...]] = (
    (SIDE_M, 0.0, -UP_M),
    (SIDE_M, SIDE_M, -UP_M),
    (0.0, SIDE_M, -UP_M),
    (0.0, 0.0, -UP_M),
)
ARRIVED_M: Final = 0.5

CASES: Final[dict[str, tuple[ModelFault, ...]]] = {
    "as believed": (),
    "mass -40 %": (Payload(-0.4 * S500_KG),),
    "mass +40 %": (Payload(0.4 * S500_KG),),
    "mass +60 %": (Payload(0.6 * S500_KG),),
    "inertia x 0.5": (InertiaScale(0.5),),
    "inertia x 2": (InertiaScale(2.0),),
    "thrust -30 %": (ThrustScale(0.7),),
    "motor 2 at 0.7": (MotorFault(2, 0.7),),
    "wind 10 m/s": (WindChange((7.1, -7.1, 0.0), 0.5),),
    "centre of mass 2 cm": (CentreOfMass(0.02, -0.02),),
    "resistance x 3": (WeakBattery(3.0, 1.0),),
}


@dataclass(frozen=True, slots=True)
class Figures:
    """What a flight was like, by the estimate: metres and seconds.

    `hover_m` and `hover_up_m` are the largest distance from where it should hover, horizontally
    and vertically, over ten seconds that begin 20 s after it was sent off; `climb_over_m` is how
    far it rose beyond its height, `over_m` how far it flew beyond the corners of the square, along
    the side; `square_s` is the time for the square, `land_s` from the order to land until it
    disarms.
    """

    hover_m: float
    hover_up_m: float
    climb_over_m: float
    over_m: float
    square_s: float
    land_s: float
    load: float
    yaw_deg: float


def flown(personality: Personality, faults: tuple[ModelFault, ...], seed: int = 1) -> Figures:
    """Take-off to `UP_M`, a hover, the square, landing and disarming.

    Raises AssertionError where it does not come so far.
    """
    flight = Flight(personality, seed)
    vehicle = flight.vehicle
    for fault in faults:
        vehicle.inject(fault)
    flight.boot()
    if personality == "ardupilot":
        assert vehicle.set_mode_kind("guided") is Result.ACCEPTED
    assert vehicle.arm(False) is Result.ACCEPTED
    start = flight.pos
    assert vehicle.take_off(UP_M) is Result.ACCEPTED
    climb_over_m = 0.0

    for tenth in range(200):
        if tenth == 120:  # PX4 ends its climb up to 0.8 m lower
            assert vehicle.reposition((start[0], start[1], -UP_M), None, None) is Result.ACCEPTED
        flight.fly(0.1)
        climb_over_m = max(climb_over_m, -flight.pos[2] - UP_M)
    heading_rad = vehicle.estimate.heading_rad
    hover_m = hover_up_m = 0.0
    for _ in range(100):
        flight.fly(0.1)
        n, e, d = flight.pos
        hover_m = max(hover_m, hypot(n - start[0], e - start[1]))
        hover_up_m = max(hover_up_m, abs(-d - UP_M))

    over_m, square_s = 0.0, 0.0
    last = (start[0], start[1], -UP_M)
    for corner in CORNERS:
        assert vehicle.reposition(corner, None, None) is Result.ACCEPTED
        along = (corner[0] - last[0], corner[1] - last[1])
        side = hypot(*along)

        def beyond_m(
            corner: Vec3 = corner, along: tuple[float, float] = along, side: float = side
        ) -> float:
            n, e, _ = flight.pos
            return ((n - corner[0]) * along[0] + (e - corner[1]) * along[1]) / side

        square_s += flight.fly(40.0, lambda corner=corner: flight.off(corner) < ARRIVED_M)  # type: ignore[misc]
        for _ in range(50):
            flight.fly(0.1)
            over_m = max(over_m, beyond_m())
        last = corner
    assert vehicle.land() is Result.ACCEPTED
    land_s = flight.fly(60.0, lambda: not vehicle.armed)
    assert vehicle.truth.landed
    return Figures(
        hover_m, hover_up_m, climb_over_m, over_m, square_s, land_s,
        vehicle.blocks.flight.load, abs(degrees(remainder(heading_rad, tau))),
    )  # fmt: skip


def table() -> str:
    """Every case flown by both personalities, a line each."""
    lines = [
        "| case | autopilot | hover, m | height, m | climb over, m | overshoot, m | square, s "
        "| land, s | load |",
        "|---|---|---|---|---|---|---|---|---|",
    ]
    personalities: tuple[Personality, ...] = ("px4", "ardupilot")
    for name, faults in CASES.items():
        for personality in personalities:
            try:
                f = flown(personality, faults)
            except AssertionError as error:
                lines.append(f"| {name} | {personality} | {str(error)[:90]} |||||||")
                continue
            lines.append(
                f"| {name} | {personality} | {f.hover_m:.2f} | {f.hover_up_m:.2f} "
                f"| {f.climb_over_m:.2f} | {f.over_m:.2f} | {f.square_s:.1f} | {f.land_s:.1f} "
                f"| {f.load:.2f} |"
            )
    return "\n".join(lines)


if __name__ == "__main__":
    print(table())
