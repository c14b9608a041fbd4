"""How a real vehicle stops when it is told to hold, and how it flies a bare step: facts.

    python -m tests.real record px4 FILE --folder DIR

Flown without the gate.  A stop begins with the command of the mode: "steady" from a velocity that
it has had for a while, "gaining" on its way to a far position, when it passes the speed, "slowing"
when it has slowed down to it from a high speed, sent to where it was then.  Written:
speed and distance by truth, and by the vehicle's own estimate, which is all that a gate has.
"""

import itertools
import json
import math
from pathlib import Path
from typing import Any

from tests.real.truth import Sample, Vector
from tests.real.vehicle import Vehicle

HEIGHT_M = 60.0
HOME = (0.0, 0.0, HEIGHT_M)
REST_M_S = 0.25  # slower than this beside its goal has arrived
STOPPED_M_S = 0.1  # no faster than this along its way for a second has stopped
COMPASS = {
    "N": (0, 1), "S": (0, -1), "E": (1, 0), "W": (-1, 0),
    "NE": (1, 1), "SW": (-1, -1), "SE": (1, -1), "NW": (-1, 1),
}  # fmt: skip
UNITS: dict[str, Vector] = {
    name: (e / math.hypot(e, n), n / math.hypot(e, n), 0.0) for name, (e, n) in COMPASS.items()
} | {"up": (0.0, 0.0, 1.0), "down": (0.0, 0.0, -1.0)}
SPEEDS_H = tuple(range(1, 13))
SPEEDS_SLOWING = (0.5, 1.0, 1.5, 2.0, 3.0, 5.0)
SLOWING_FROM_M_S = 10.0
SPEEDS_UP = (1.0, 2.0, 3.0)
SPEEDS_DOWN = (0.7, 1.0, 1.5)
LEGS_M = (5, 10, 20, 40, 58, 100)

PARTS = ("steady", "gaining", "slowing", "vertical", "legs")

Fact = dict[str, Any]


def times(unit: Vector, factor: float) -> Vector:
    return (unit[0] * factor, unit[1] * factor, unit[2] * factor)


def along(unit: Vector, start: Vector, point: Vector) -> float:
    return sum(u * (b - a) for u, a, b in zip(unit, start, point, strict=True))


def beside(unit: Vector, start: Vector, point: Vector) -> float:
    return math.sqrt(max(0.0, math.dist(start, point) ** 2 - along(unit, start, point) ** 2))


def begin(vehicle: Vehicle, direction: str, speed_m_s: float, how: str) -> None:
    """Brings it to the speed."""
    unit = UNITS[direction]
    vertical = direction in ("up", "down")
    if how == "gaining":
        assert vehicle.estimate is not None
        far = times(unit, 30.0 if vertical else 200.0)
        here = vehicle.estimate.position_enu
        vehicle.to_position((here[0] + far[0], here[1] + far[1], here[2] + far[2]))
        vehicle.until(lambda: vehicle.now.speed_m_s >= speed_m_s, 12.0)
    elif how == "slowing":
        begin(vehicle, direction, SLOWING_FROM_M_S, "steady")
        assert vehicle.estimate is not None
        vehicle.to_position(vehicle.estimate.position_enu)
        vehicle.until(lambda: along(unit, (0, 0, 0), vehicle.now.velocity_enu) <= speed_m_s, 12.0)
    else:
        vehicle.to_velocity(times(unit, speed_m_s))
        vehicle.until(lambda: vehicle.now.speed_m_s >= 0.93 * speed_m_s, 3.0 + speed_m_s)
        vehicle.pass_time(2.0 if vertical else 3.0)


def stop(vehicle: Vehicle, direction: str, speed_m_s: float, how: str) -> Fact:
    begin(vehicle, direction, speed_m_s, how)
    assert vehicle.estimate is not None
    first, believed = vehicle.now, vehicle.estimate
    index = len(vehicle.truth.samples) - 1
    estimates: list[Sample] = []
    unit = UNITS[direction]
    vehicle.hold()
    slow_since_s = math.inf

    def at_rest() -> bool:
        nonlocal slow_since_s
        assert vehicle.estimate is not None
        estimates.append(vehicle.estimate)
        if along(unit, (0, 0, 0), vehicle.now.velocity_enu) > STOPPED_M_S:
            slow_since_s = math.inf
        slow_since_s = min(slow_since_s, vehicle.now.at_s)
        return vehicle.now.at_s - slow_since_s > 1.0

    vehicle.until(at_rest, 15.0)
    flown = vehicle.truth.samples[index:]
    start = first.position_enu
    ways = [along(unit, start, sample.position_enu) for sample in flown]
    farthest = max(range(len(ways)), key=ways.__getitem__)
    after = [s for s in flown if s.at_s - first.at_s >= 0.1]
    return {
        "kind": how,
        "direction": direction,
        "asked_m_s": speed_m_s,
        "speed_m_s": round(along(unit, (0, 0, 0), first.velocity_enu), 2),
        "estimated_m_s": round(along(unit, (0, 0, 0), believed.velocity_enu), 2),
        "tilt_deg": round(first.tilt_deg, 1),
        "stop_m": round(ways[farthest], 2),
        "stop_s": round(flown[farthest].at_s - first.at_s, 2),
        "estimated_stop_m": round(
            max(along(unit, believed.position_enu, s.position_enu) for s in estimates), 2
        ),
        "beside_m": round(max(beside(unit, start, s.position_enu) for s in flown), 2),
        "rest_m": round(ways[-1], 2),
        "top_m_s": round(max(along(unit, (0, 0, 0), s.velocity_enu) for s in flown), 2),
        "most_tilt_deg": round(max(s.tilt_deg for s in after or flown), 1),
        "track": track(first, flown[: farthest + 1], unit),
    }


def track(first: Sample, flown: list[Sample], unit: Vector) -> list[list[float]]:
    """Seconds, metres along the way, m/s along it: about four a second."""
    rows: list[list[float]] = []
    for sample in [*flown[:-1:12], flown[-1]]:
        way = along(unit, first.position_enu, sample.position_enu)
        speed = along(unit, (0, 0, 0), sample.velocity_enu)
        rows.append([round(sample.at_s - first.at_s, 2), round(way, 2), round(speed, 2)])
    return rows


def leg(vehicle: Vehicle, direction: str, length_m: float) -> Fact:
    """A position setpoint, unsmoothed, until it is at rest."""
    vehicle.pass_time(2.0)
    assert vehicle.estimate is not None
    unit, first, believed = UNITS[direction], vehicle.now, vehicle.estimate
    index = len(vehicle.truth.samples) - 1
    goal = tuple(a + b for a, b in zip(believed.position_enu, times(unit, length_m), strict=True))
    vehicle.to_position((goal[0], goal[1], goal[2]))
    seen: list[float] = []

    def arrived() -> bool:
        assert vehicle.estimate is not None
        seen.append(along(unit, believed.position_enu, vehicle.estimate.position_enu))
        return vehicle.now.speed_m_s < REST_M_S and seen[-1] > length_m - 0.7

    arrival = vehicle.until(arrived, 20.0 + length_m)
    arrival_s = vehicle.now.at_s - first.at_s
    vehicle.until(lambda: arrived() and False, 3.0)
    flown = vehicle.truth.samples[index:]
    ways = [along(unit, first.position_enu, s.position_enu) for s in flown]
    speeds = [along(unit, (0, 0, 0), s.velocity_enu) for s in flown]
    slowest = min(
        (
            (speeds[i] - speeds[i - 25]) / max(0.1, flown[i].at_s - flown[i - 25].at_s)
            for i in range(25, len(flown))
        ),
        default=0.0,
    )
    return {
        "kind": "leg",
        "direction": direction,
        "length_m": length_m,
        "arrived": arrival,
        "arrival_s": round(arrival_s, 2),
        "overshoot_m": round(max(ways) - length_m, 2),
        "estimated_overshoot_m": round(max(seen) - length_m, 2),
        "top_m_s": round(max(speeds), 2),
        "decel_m_s2": round(-slowest, 2),
        "most_tilt_deg": round(max(s.tilt_deg for s in flown), 1),
        "beside_m": round(max(beside(unit, first.position_enu, s.position_enu) for s in flown), 2),
    }


def programme(part: str, repeats: int) -> list[tuple[str, str, float]]:
    """What is flown: kind, direction, speed or length.  Opposite ways follow each other."""
    compass = list(COMPASS)
    rows: list[tuple[str, str, float]] = []
    if part in ("steady", "gaining", "slowing"):
        speeds = SPEEDS_SLOWING if part == "slowing" else SPEEDS_H
        for round_number in range(repeats // 2):
            for index, speed in enumerate(speeds):
                start = 2 * ((index + round_number) % 4)
                rows += [(part, name, float(speed)) for name in compass[start : start + 2]]
    elif part == "vertical":
        for how, _ in itertools.product(("steady", "gaining"), range(repeats)):
            for up, down in zip(SPEEDS_UP, SPEEDS_DOWN, strict=True):
                rows += [(how, "up", up), (how, "down", down)]
    else:
        for round_number, length in itertools.product(range(repeats // 2), LEGS_M):
            start = 2 * (round_number % 4)
            rows += [("leg", name, float(length)) for name in compass[start : start + 2]]
    return rows


def record(vehicle: Vehicle, part: str, repeats: int, target: Path) -> None:
    vehicle.take_off(HEIGHT_M)
    guided = vehicle.kind.guided_custom_mode
    with target.open("w") as out:
        for kind, direction, figure in programme(part, repeats):
            if vehicle.custom_mode != guided:
                vehicle.guide()
            assert vehicle.estimate is not None
            east, north, up = vehicle.estimate.position_enu
            if abs(up - HEIGHT_M) > 15.0 or math.hypot(east, north) > 250.0:
                vehicle.to_position(HOME)
                vehicle.until(lambda: math.dist(vehicle.now.position_enu, HOME) < 3.0, 120.0)
            vehicle.pass_time(1.5)
            fact = (
                leg(vehicle, direction, figure)
                if kind == "leg"
                else stop(vehicle, direction, figure, kind)
            )
            print(json.dumps({k: v for k, v in fact.items() if k != "track"}), flush=True)
            out.write(json.dumps({"version": vehicle.version, **fact}) + "\n")
            out.flush()
