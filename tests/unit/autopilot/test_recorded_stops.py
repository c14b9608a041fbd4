"""Stops told in flight, beside the recorded ones of the real autopilots.

    python -m tests.unit.autopilot.test_recorded_stops

prints the table.  The recorded figures are tests/real/facts (PX4 1.14.3 in SIH, ArduCopter 4.7.0
in SITL), means by the simulators' truth: "steady" from a velocity that the vehicle has had for a
while, "gaining" as it passes the speed on its way to a far position.  A way is compared by the
speed that it began with, since that is not the asked one to the last digit.
"""

from __future__ import annotations

import json
from copy import deepcopy
from functools import cache
from pathlib import Path
from statistics import mean
from typing import Any, Final, Literal, NamedTuple, TypeAlias

from tests.each import each
from tests.unit.autopilot.flight import Flight
from vehicle_sim.autopilot.interface import Result, Setpoint
from vehicle_sim.autopilot.modes import Personality
from vehicle_sim.numerics.vectors import Vec3

FACTS: Final = Path(__file__).parents[2] / "real" / "facts"
SHARE: Final = 0.2
STOPPED_M_S: Final = 0.1
"""No faster than this along its way for a second has stopped, as in tests/real/record.py."""
AIRFRAMES: Final[dict[Personality, str]] = {"px4": "sih", "ardupilot": "s500"}
UP_M: Final = 20.0
FAR_M: Final = {"N": (200.0, 0.0), "up": (0.0, -30.0), "down": (0.0, 30.0)}
"""North and down."""

Kind: TypeAlias = Literal["steady", "gaining"]
Direction: TypeAlias = Literal["N", "up", "down"]


class Stop(NamedTuple):
    personality: Personality
    kind: Kind
    direction: Direction
    speed_m_s: float

    def __str__(self) -> str:
        return f"{self.personality} {self.kind} {self.direction} {self.speed_m_s}"


STOPS: Final[list[Stop]] = [
    *(Stop("ardupilot", "steady", "N", speed) for speed in (1.0, 2.0, 4.0, 7.0, 10.0)),
    *(Stop("ardupilot", "gaining", "N", speed) for speed in (1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0)),
    *(Stop("ardupilot", "gaining", "N", speed) for speed in (8.0, 9.0, 10.0)),
    *(Stop("ardupilot", "gaining", "up", speed) for speed in (1.0, 2.0)),
    *(Stop("ardupilot", "gaining", "down", speed) for speed in (0.7, 1.0)),
    *(Stop("px4", "steady", "N", speed) for speed in (4.0, 7.0)),
    *(Stop("px4", "gaining", "N", speed) for speed in (4.0, 7.0)),
]


@cache
def facts(personality: Personality) -> list[dict[str, Any]]:
    path = FACTS / f"{personality}.jsonl"
    return [json.loads(line) for line in path.read_text().splitlines()]


def recorded_s(stop: Stop) -> float:
    """Way by speed; north stands for all horizontal directions."""
    rows = [
        row
        for row in facts(stop.personality)
        if row["kind"] == stop.kind
        and row["asked_m_s"] == stop.speed_m_s
        and (row["direction"] if row["direction"] in ("up", "down") else "N") == stop.direction
    ]
    return mean(float(row["stop_m"]) / float(row["speed_m_s"]) for row in rows)


@cache
def hovering(personality: Personality) -> Flight:
    """In the mode that takes setpoints; to be copied."""
    flight = Flight(personality, airframe=AIRFRAMES[personality]).airborne(UP_M)
    n, e, _ = flight.vehicle.estimate.pos_ned
    here = Setpoint(pos_ned=(n, e, -UP_M))
    flight.stream(here, 1.2)
    assert flight.vehicle.set_mode_kind("guided") is Result.ACCEPTED
    flight.stream(here, 6.0)
    return flight


def flown(stop: Stop) -> tuple[float, list[float]]:
    """The speed at the command, and the ways until it has stopped [m/s, m]."""
    flight = deepcopy(hovering(stop.personality))
    vehicle = flight.vehicle
    axis = 0 if stop.direction == "N" else 2
    sign = -1.0 if stop.direction == "up" else 1.0
    n, e, d = vehicle.estimate.pos_ned

    def speed_m_s() -> float:
        return sign * vehicle.truth.v_ned[axis]

    if stop.kind == "steady":
        ask = sign * stop.speed_m_s
        v_ned: Vec3 = (ask, 0.0, 0.0) if axis == 0 else (0.0, 0.0, ask)
        flight.stream(Setpoint(v_ned=v_ned), 5.0 + stop.speed_m_s)
    else:
        north_m, down_m = FAR_M[stop.direction]
        far = Setpoint(pos_ned=(n + north_m, e, d + down_m))
        while speed_m_s() < stop.speed_m_s:
            flight.stream(far, 0.05)
    from_m, from_m_s = vehicle.truth.pos_ned[axis], speed_m_s()
    assert vehicle.set_mode_kind("brake") is Result.ACCEPTED
    ways, slow_s = [0.0], 0.0
    while slow_s < 1.0:
        flight.fly(0.02)
        ways.append(sign * (vehicle.truth.pos_ned[axis] - from_m))
        slow_s = 0.0 if speed_m_s() > STOPPED_M_S else slow_s + 0.02
    return from_m_s, ways


def ours_s(stop: Stop) -> float:
    from_m_s, ways = flown(stop)
    return max(ways) / from_m_s


@each("stop", STOPS)
def test_a_stop_takes_the_way_that_was_recorded(stop: Stop) -> None:
    assert abs(ours_s(stop) / recorded_s(stop) - 1.0) <= SHARE


def table() -> str:
    lines = ["| stop | recorded way by speed, s | ours | |", "|---|---|---|---|"]
    for stop in STOPS:
        real, ours = recorded_s(stop), ours_s(stop)
        lines.append(f"| {stop} | {real:.2f} | {ours:.2f} | {100.0 * (ours / real - 1.0):+.0f} % |")
    return "\n".join(lines)


if __name__ == "__main__":
    print(table())
