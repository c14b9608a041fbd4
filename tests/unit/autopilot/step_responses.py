"""Step responses of our vehicle, beside those that were recorded of the real autopilots.

    python -m tests.unit.autopilot.step_responses

prints the table: our airframe, for PX4 also one like that of SIH, the simulation in which it was
recorded.  The real figures (real_steps.json) are those of PX4 1.14.3 in SIH and ArduCopter 4.7-dev
in SITL, each with an airframe of its own: of the scenarios I1_step_response (the first of two runs)
and I2_takeoff_and_goto_profiles; of bare position setpoints, four legs each, and of AUTO.LOITER and
BRAKE from a steady velocity, up to four each, means by the simulators' truth.
"""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import dataclass
from math import acos, atan2, degrees, hypot, radians, remainder, tau
from pathlib import Path
from typing import Final

from tests.unit.autopilot.flight import Flight
from vehicle_sim.autopilot.interface import Result, Setpoint, Truth
from vehicle_sim.autopilot.modes import Personality
from vehicle_sim.numerics.vectors import Vec3

UP_M: Final = 10.0
NEAR_M: Final = 0.5
LEGS_M: Final = (10, 20, 40, 58, 100)
HOLDS_M_S: Final = (2, 4, 6, 8, 10)

REAL: Final[dict[Personality, dict[str, float]]] = json.loads(
    Path(__file__).with_name("real_steps.json").read_text()
)

OFTEN_S: Final = 0.02
SETPOINT_EVERY: Final = 3  # of them, about 20 Hz
STEPS: Final = 5  # of the vehicle in OFTEN_S


@dataclass(frozen=True, slots=True)
class Sample:
    """What the body did, seen from where and when the step was asked for."""

    t_s: float
    truth: Truth

    @property
    def up_m(self) -> float:
        return -self.truth.pos_ned[2]

    @property
    def speed_m_s(self) -> float:
        return hypot(self.truth.v_ned[0], self.truth.v_ned[1])

    @property
    def climb_m_s(self) -> float:
        return -self.truth.v_ned[2]

    @property
    def tilt_deg(self) -> float:
        _, x, y, _ = self.truth.q_ned_from_frd
        return degrees(acos(max(-1.0, min(1.0, 1.0 - 2.0 * (x * x + y * y)))))


class Track(list[Sample]):
    """The samples of one step."""

    def first(self, holds: Callable[[Sample], bool]) -> float:
        """When it was so first [s]."""
        return next(sample.t_s for sample in self if holds(sample))

    def stays(self, holds: Callable[[Sample], bool]) -> float:
        """From when on it was so until the end [s]."""
        return max((sample.t_s for sample in self if not holds(sample)), default=0.0)

    def most(self, look: Callable[[Sample], float]) -> float:
        return max(look(sample) for sample in self)

    def accelerations(self, of: Callable[[Sample], float]) -> list[float]:
        """Over tenths of a second, as a recorded track has them."""
        return [
            (of(later) - of(sample)) / (later.t_s - sample.t_s)
            for sample, later in zip(self, self[5:], strict=False)
        ]


class Stepper:
    """One flight through all steps."""

    def __init__(self, personality: Personality, airframe: str) -> None:
        self.personality: Personality = personality
        self.flight = Flight(personality, airframe=airframe).boot()
        self.vehicle = self.flight.vehicle

    def track(
        self, seconds: float, setpoint: Setpoint | None = None, until_disarmed: bool = False
    ) -> Track:
        track = Track()
        for tick in range(round(seconds / OFTEN_S)):
            if setpoint is not None and tick % SETPOINT_EVERY == 0:
                self.vehicle.set_setpoint(setpoint)
            for _ in range(STEPS):
                self.vehicle.step()
            track.append(Sample((tick + 1) * OFTEN_S, self.vehicle.truth))
            if until_disarmed and not self.vehicle.armed:
                break
        self.flight.seen += self.vehicle.events()
        return track

    def take_off(self) -> Track:
        if self.personality == "ardupilot":
            self.vehicle.set_mode_kind("guided")
        assert self.vehicle.arm(False) is Result.ACCEPTED
        assert self.vehicle.take_off(UP_M) is Result.ACCEPTED
        return self.track(17.0)


def step_responses(personality: Personality, airframe: str = "s500") -> dict[str, float]:
    """Every cell of `REAL`, flown by our vehicle."""
    return {
        **_steps(personality, airframe),
        **_profiles(personality, airframe),
        **_legs(personality, airframe),
        **_holds(personality, airframe),
    }


def _steps(personality: Personality, airframe: str) -> dict[str, float]:
    fly = Stepper(personality, airframe)
    fly.take_off()
    n, e, d = fly.vehicle.estimate.pos_ned
    d = -UP_M
    fly.track(2.0, Setpoint(pos_ned=(n, e, d)))
    fly.vehicle.set_mode_kind("guided")
    fly.track(6.0, Setpoint(pos_ned=(n, e, d)))
    cells: dict[str, float] = {}

    start = fly.vehicle.truth.pos_ned
    go = fly.track(15.0, Setpoint(pos_ned=(n + 10.0, e, d)))
    off: Callable[[Sample], float] = lambda s: abs(s.truth.pos_ned[0] - start[0] - 10.0)  # noqa: E731
    cells["10 m: first within 0.5 m, s"] = go.first(lambda s: off(s) < NEAR_M)
    cells["10 m: stays within 0.5 m, s"] = go.stays(lambda s: off(s) < NEAR_M)
    cells["10 m: highest speed, m/s"] = go.most(lambda s: s.speed_m_s)
    cells["10 m: steepest tilt, deg"] = go.most(lambda s: s.tilt_deg)
    cells["10 m: highest acceleration, m/s2"] = max(go.accelerations(lambda s: s.speed_m_s))
    n += 10.0

    for name, by_m in (("climb 5 m", 5.0), ("descend 5 m", -5.0)):
        begin_m = -fly.vehicle.truth.pos_ned[2]
        d -= by_m
        go = fly.track(12.0, Setpoint(pos_ned=(n, e, d)))
        near = _reached(begin_m + by_m)
        cells[f"{name}: within 0.5 m, s"] = go.first(near)
        sign = 1.0 if by_m > 0.0 else -1.0
        cells[f"{name}: highest speed, m/s"] = max(sign * s.climb_m_s for s in go)
        if by_m > 0.0:
            rates = go.accelerations(lambda s: s.climb_m_s)
            cells[f"{name}: highest acceleration, m/s2"] = max(rates)

    yaw_rad = fly.vehicle.estimate.heading_rad
    go = fly.track(8.0, Setpoint(pos_ned=(n, e, d), yaw_rad=yaw_rad + radians(90.0)))
    turned = [(s.t_s, _yaw_deg(s.truth, yaw_rad)) for s in go]
    cells["yaw 90 deg: to 85, s"] = next(t_s for t_s, deg in turned if deg > 85.0)
    cells["yaw 90 deg: fastest, deg/s"] = go.most(lambda s: degrees(s.truth.rates_frd[2]))
    cells["yaw 90 deg: overshoot, deg"] = max(deg for _, deg in turned) - 90.0

    yaw_rad += radians(90.0)
    go = fly.track(5.0, Setpoint(v_ned=(3.0, 0.0, 0.0), yaw_rad=yaw_rad))
    cells["velocity 3 m/s: to 2.7, s"] = next((s.t_s for s in go if s.speed_m_s > 2.7), 99.0)
    cells["velocity 3 m/s: highest, m/s"] = go.most(lambda s: s.speed_m_s)
    at = fly.vehicle.truth.pos_ned
    go = fly.track(9.0)
    slow_s = go.first(lambda s: s.speed_m_s < 0.3)
    cells["stream stops: to 0.3 m/s, s"] = slow_s
    there = next(s.truth.pos_ned for s in go if s.t_s >= slow_s)
    cells["stream stops: way, m"] = hypot(there[0] - at[0], there[1] - at[1])
    if personality == "px4":
        later = [s.climb_m_s for s in go if s.t_s > slow_s]
        cells["stream stops: then sinks, m/s"] = -sum(later) / len(later)
        fly.vehicle.set_mode_kind("hold")

    high: Vec3 = (*fly.vehicle.truth.pos_ned[:2], -UP_M)
    assert fly.vehicle.reposition(high, None, None) is Result.ACCEPTED
    fly.track(12.0)
    assert fly.vehicle.land() is Result.ACCEPTED
    go = fly.track(40.0, until_disarmed=True)
    cells["land from 10 m: to disarm, s"] = go[-1].t_s
    cells["land: touch-down to disarm, s"] = go[-1].t_s - go.first(lambda s: s.up_m < 0.02)
    for low, top in ((8, 9), (4, 5), (1, 2)):
        rates = [-s.climb_m_s for s in go if low <= s.up_m < top]
        cells[f"land: at {low} to {top} m, m/s"] = sum(rates) / len(rates)
    return cells


def _profiles(personality: Personality, airframe: str) -> dict[str, float]:
    fly = Stepper(personality, airframe)
    go = fly.take_off()
    cells = {
        "take-off 10 m: first 0.2 m, s": go.first(lambda s: s.up_m > 0.2),
        "take-off 10 m: to 9 m, s": go.first(lambda s: s.up_m > 9.0),
        "take-off 10 m: ends at, m": go[-1].up_m,
    }
    n, e, d = fly.vehicle.estimate.pos_ned
    assert fly.vehicle.reposition((n, e + 40.0, d), None, None) is Result.ACCEPTED
    go = fly.track(27.0 if personality == "px4" else 11.0)
    cells["goto 40 m: highest speed, m/s"] = go.most(lambda s: s.speed_m_s)
    cells["goto 40 m: within 1 m, s"] = go.first(
        lambda s: hypot(s.truth.pos_ned[0] - n, s.truth.pos_ned[1] - e - 40.0) < 1.0
    )
    fly.vehicle.set_mode_kind("return")
    go = fly.track(120.0, until_disarmed=True)
    cells["return from 40 m: to disarm, s"] = go[-1].t_s
    cells["return: fastest climb, m/s"] = go.most(lambda s: s.climb_m_s)
    cells["return: fastest descent, m/s"] = go.most(lambda s: -s.climb_m_s)
    return cells


def _hovering(personality: Personality, airframe: str) -> tuple[Stepper, Vec3]:
    """In the mode that takes setpoints."""
    fly = Stepper(personality, airframe)
    fly.take_off()
    n, e, _ = fly.vehicle.estimate.pos_ned
    fly.track(2.0, Setpoint(pos_ned=(n, e, -UP_M)))
    fly.vehicle.set_mode_kind("guided")
    fly.track(6.0, Setpoint(pos_ned=(n, e, -UP_M)))
    return fly, (n, e, -UP_M)


def _legs(personality: Personality, airframe: str) -> dict[str, float]:
    """Bare position setpoints north and south."""
    fly, (_, e, d) = _hovering(personality, airframe)
    cells: dict[str, float] = {}
    sign = 1.0
    for length_m in LEGS_M:
        from_n = fly.vehicle.truth.pos_ned[0]
        goal_n = fly.vehicle.estimate.pos_ned[0] + sign * length_m
        go = fly.track(14.0 + length_m / 5.0, Setpoint(pos_ned=(goal_n, e, d)))
        ways = [sign * (s.truth.pos_ned[0] - from_n) for s in go]
        speeds = [sign * s.truth.v_ned[0] for s in go]
        name = f"leg {length_m} m"
        cells[f"{name}: highest speed, m/s"] = max(speeds)
        pairs = zip(speeds, speeds[25:], strict=False)
        cells[f"{name}: hardest braking, m/s2"] = max(first - last for first, last in pairs) / 0.5
        cells[f"{name}: overshoot, m"] = max(ways) - length_m
        cells[f"{name}: to rest, s"] = next(
            s.t_s
            for s, way in zip(go, ways, strict=True)
            if s.speed_m_s < 0.25 and way > length_m - 0.7
        )
        sign = -sign
    return cells


def _holds(personality: Personality, airframe: str) -> dict[str, float]:
    """AUTO.LOITER and BRAKE from a steady velocity, north and south."""
    fly, _ = _hovering(personality, airframe)
    cells: dict[str, float] = {}
    sign = 1.0
    for speed_m_s in HOLDS_M_S:
        n, e, _ = fly.vehicle.estimate.pos_ned
        fly.track(1.2, Setpoint(pos_ned=(n, e, -UP_M)))
        fly.vehicle.set_mode_kind("guided")
        fly.track(6.0, Setpoint(pos_ned=(n, e, -UP_M)))
        fly.track(speed_m_s + 5.0, Setpoint(v_ned=(sign * speed_m_s, 0.0, 0.0)))
        first = fly.vehicle.truth
        fly.vehicle.set_mode_kind("brake")
        go = fly.track(9.0)
        way_m = max(sign * (s.truth.pos_ned[0] - first.pos_ned[0]) for s in go)
        cells[f"hold from {speed_m_s} m/s: way by speed, s"] = way_m / (sign * first.v_ned[0])
        sign = -sign
    return cells


def _reached(up_m: float) -> Callable[[Sample], bool]:
    return lambda sample: abs(sample.up_m - up_m) < NEAR_M


def _yaw_deg(truth: Truth, from_rad: float) -> float:
    w, x, y, z = truth.q_ned_from_frd
    yaw_rad = atan2(2.0 * (w * z + x * y), 1.0 - 2.0 * (y * y + z * z))
    return degrees(remainder(yaw_rad - from_rad, tau))


def table() -> str:
    """Ours beside the real figures, a line for each cell."""
    lines = [
        "| cell | PX4 | ours | | like SIH | | ArduCopter | ours | |",
        "|---|---|---|---|---|---|---|---|---|",
    ]
    ours: list[tuple[Personality, dict[str, float]]] = [
        ("px4", step_responses("px4")),
        ("px4", step_responses("px4", "sih")),
        ("ardupilot", step_responses("ardupilot")),
    ]
    names = list(REAL["px4"]) + [name for name in REAL["ardupilot"] if name not in REAL["px4"]]
    for name in names:
        line, said = f"| {name} |", None
        for personality, figures in ours:
            real, is_so = REAL[personality].get(name), figures.get(name)
            if personality != said:
                line += " |" if real is None else f" {real:.2f} |"
            said = personality
            if real is None or is_so is None:
                line += " | |"
                continue
            line += f" {is_so:.2f} | {100.0 * (is_so / real - 1.0):+.0f} % |"
        lines.append(line)
    return "\n".join(lines)


if __name__ == "__main__":
    print(table())
