"""Step responses of every control loop, flown by the estimate, with noisy sensors, in wind.

Of both airframes, as the gains of the inner loops come from the motors.  Errors of the estimate
are another matter: what is judged here is how the vehicle moves, from where it was.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import fields
from math import asin, cos, isfinite, pi, sin, sqrt

import pytest

from vehicle_sim.autopilot.control.demands import (
    Demand,
    FlyAtHeight,
    FlyAttitude,
    FlyCircle,
    FlyTo,
    FlyVelocity,
    Situation,
)
from vehicle_sim.autopilot.control.flight_control import FlightControl
from vehicle_sim.autopilot.interface import AttitudeSetpoint
from vehicle_sim.control_loops.flight import Flight
from vehicle_sim.control_loops.trajectory import MotionLimits
from vehicle_sim.engine.scalar_engine import ScalarEngine
from vehicle_sim.engine.step import DT_S, VehicleSpec
from vehicle_sim.estimation.estimated import Estimated
from vehicle_sim.numerics.vectors import Vec3
from vehicle_sim.plant.airframe import load
from vehicle_sim.plant.body import Body

LIMITS = MotionLimits(5.0, 3.0, 1.5, 3.0, 3.0)
UP_M = 10.0

both = pytest.mark.parametrize("airframe", ["s500", "racer250"])


class Hand:
    """One engine of one vehicle, and a pilot without decisions."""

    def __init__(self, airframe: str, seed: int = 1) -> None:
        self.engine = ScalarEngine([VehicleSpec(seed, 0, 47.4)], load(airframe))
        blocks = self.engine.blocks(0)
        self.body, self.est, self.flight = blocks.body, blocks.est, blocks.flight
        self.pilot = FlightControl(self.flight, self.engine.believed.idle)

    def situation(self) -> Situation:
        s = Situation(LIMITS)
        s.time_ns = self.engine.steps.k * 4_000_000
        s.pos_ned = (self.est.pos_n, self.est.pos_e, self.est.pos_d)
        return s

    def fly(self, demand: Demand) -> None:
        self.pilot.fly(demand, self.situation())

    def run(self, seconds: float, look: Callable[[], None] | None = None) -> None:
        for _ in range(round(seconds / DT_S)):
            self.engine.step()
            if self.engine.steps.k % 25 == 0:
                self.flight.strength_inv = 1.0 / self.body.strength
            if look is not None:
                look()

    def record(self, seconds: float, what: Callable[[], float]) -> list[float]:
        values: list[float] = []
        self.run(seconds, lambda: values.append(what()))
        return values


def hovering(airframe: str, seed: int = 1) -> Hand:
    hand = Hand(airframe, seed)
    hand.run(1.5)
    hand.pilot.lift_off(hand.situation().pos_ned, 0.0)
    hand.fly(FlyTo((0.0, 0.0, -UP_M), LIMITS))
    hand.run(30.0)
    return hand


def rise_s(response: list[float]) -> float:
    """Until 63 % of 1."""
    return next(n for n, value in enumerate(response) if value > 0.632) * DT_S


@both
def test_body_rates(airframe: str) -> None:
    hand = hovering(airframe)
    hand.fly(FlyAttitude(AttitudeSetpoint(None, (0.0, 0.0, 0.0), 0.5), True, LIMITS))
    hand.run(0.5)
    hand.fly(FlyAttitude(AttitudeSetpoint(None, (2.0, 0.0, 0.0), 0.5), True, LIMITS))
    response = hand.record(0.3, lambda: 0.5 * hand.body.rate_x)
    assert rise_s(response) < 0.060
    assert max(response) < 1.20
    assert sum(response[-25:]) / 25 == pytest.approx(1.0, abs=0.05)


@both
def test_attitude(airframe: str) -> None:
    hand = hovering(airframe)
    half = 0.5 * 0.3
    hand.fly(FlyAttitude(AttitudeSetpoint((1.0, 0.0, 0.0, 0.0), None, 0.5), True, LIMITS))
    hand.run(0.5)
    leaned = AttitudeSetpoint((cos(half), sin(half), 0.0, 0.0), None, 0.5)
    hand.fly(FlyAttitude(leaned, True, LIMITS))
    response = hand.record(1.0, lambda: 2.0 * asin(hand.body.qx) / 0.3)
    assert rise_s(response) < 0.150
    assert max(response) < 1.10
    assert sum(response[-100:]) / 100 == pytest.approx(1.0, abs=0.05)


@both
def test_velocity(airframe: str) -> None:
    hand = hovering(airframe)
    hand.fly(FlyVelocity((3.0, 0.0, 0.0), LIMITS))
    response = hand.record(8.0, lambda: hand.body.vel_n / 3.0)
    assert rise_s(response) < 1.5
    assert max(response) < 1.10
    assert min(response[1000:]) > 0.93


@both
def test_ten_metres(airframe: str) -> None:
    hand = hovering(airframe)
    start = hand.body.pos_n
    hand.fly(FlyTo((10.0, 0.0, -UP_M), LIMITS))
    response = hand.record(12.0, lambda: hand.body.pos_n - start)
    assert max(response) < 10.5
    settled = max(n for n, value in enumerate(response) if abs(value - 10.0) > 0.2) * DT_S
    assert settled < 8.0
    assert hand.body.pos_d == pytest.approx(-UP_M, abs=0.5)


@both
def test_a_quarter_turn(airframe: str) -> None:
    hand = hovering(airframe)
    before = (hand.body.pos_n, hand.body.pos_e)
    hand.pilot.heading.max_rad_s = 1.0
    hand.pilot.heading.turn_to(0.5 * pi)
    response = hand.record(6.0, lambda: 2.0 * asin(hand.body.qz) / (0.5 * pi))
    assert rise_s(response) < 1.8
    assert max(response) < 1.05
    assert response[-1] == pytest.approx(1.0, abs=0.02)
    assert abs(hand.body.pos_n - before[0]) < 0.2
    assert abs(hand.body.pos_e - before[1]) < 0.2


@both
def test_a_hover_is_quiet(airframe: str) -> None:
    hand = hovering(airframe)
    b = hand.body
    ways = (lambda: b.vel_n, lambda: b.vel_e, lambda: b.vel_d)
    for what in ways:
        assert rms(hand.record(10.0, what)) < 0.10
    tilt = hand.record(10.0, lambda: 2.0 * sqrt(b.qx * b.qx + b.qy * b.qy))
    assert max(tilt) < 0.05
    motors = hand.record(5.0, lambda: hand.flight.u1)
    mean = sum(motors) / len(motors)
    assert rms([u - mean for u in motors]) < 0.03


def rms(values: list[float]) -> float:
    return sqrt(sum(value * value for value in values) / len(values))


@both
def test_wind_of_eight_metres_a_second_is_held(airframe: str) -> None:
    hand = hovering(airframe)
    start = (hand.body.pos_n, hand.body.pos_e)
    hand.body.wind_n, hand.body.wind_e, hand.body.gust_m_s = 6.0, -5.3, 0.5
    hand.run(20.0)
    n = hand.record(10.0, lambda: abs(hand.body.pos_n - start[0]))
    e = hand.record(10.0, lambda: abs(hand.body.pos_e - start[1]))
    assert max(n) < 0.5
    assert max(e) < 0.5


@both
def test_a_circle_is_round_and_even(airframe: str) -> None:
    hand = hovering(airframe)
    offset = (hand.body.pos_n - hand.est.pos_n, hand.body.pos_e - hand.est.pos_e)
    centre: Vec3 = (10.0, 0.0, -UP_M)
    hand.fly(FlyCircle(centre, 10.0, 0.3, LIMITS))
    hand.run(8.0)
    b = hand.body

    def radius() -> float:
        n, e = b.pos_n - offset[0] - centre[0], b.pos_e - offset[1] - centre[1]
        return sqrt(n * n + e * e)

    assert all(abs(r - 10.0) < 0.4 for r in hand.record(21.0, radius))
    speeds = hand.record(21.0, lambda: sqrt(b.vel_n * b.vel_n + b.vel_e * b.vel_e))
    assert min(speeds) > 2.7
    assert max(speeds) < 3.3


def test_a_circle_that_is_asked_for_again_goes_on_where_it_is() -> None:
    hand = hovering("s500")
    hand.fly(FlyCircle((10.0, 0.0, -UP_M), 10.0, 0.3, LIMITS))
    hand.run(10.0)
    before = (hand.flight.goal_n, hand.flight.goal_e)
    hand.fly(FlyCircle((10.0, 0.0, -UP_M), 10.0, 0.2, LIMITS))
    assert (hand.flight.goal_n, hand.flight.goal_e) == pytest.approx(before, abs=1e-9)


def test_a_goal_that_moves_is_kept_up_with_between_decisions() -> None:
    hand = hovering("s500")
    start = hand.est.pos_e
    hand.fly(FlyTo((0.0, 0.0, -UP_M), LIMITS, v_ned=(0.0, 2.0, 0.0)))
    hand.run(10.0)
    assert hand.body.vel_e == pytest.approx(2.0, abs=0.2)
    assert hand.est.pos_e - start == pytest.approx(20.0, abs=1.0)


def test_a_velocity_over_ground_at_a_height() -> None:
    hand = hovering("s500")
    hand.fly(FlyAtHeight(0.0, 2.0, -UP_M - 3.0, LIMITS))
    hand.run(8.0)
    assert hand.body.vel_e == pytest.approx(2.0, abs=0.2)
    assert hand.body.vel_n == pytest.approx(0.0, abs=0.2)
    assert hand.est.pos_d == pytest.approx(-UP_M - 3.0, abs=0.2)


@both
@pytest.mark.parametrize("motor", [1, 4])
def test_a_dead_motor_ends_the_flight_but_not_the_arithmetic(airframe: str, motor: int) -> None:
    hand = hovering(airframe)
    setattr(hand.body, f"health_{motor}", 0.0)
    hand.run(15.0)
    assert hand.body.touching
    for kind, block in ((Body, hand.body), (Estimated, hand.est), (Flight, hand.flight)):
        for field in fields(kind):
            assert isfinite(getattr(block, field.name)), field.name
