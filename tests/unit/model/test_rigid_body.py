"""A rigid body obeys Newton and Euler, to the order that its integrator promises."""

from __future__ import annotations

from dataclasses import replace
from math import log2, pi, sqrt

import pytest

from tests.unit.model.bodies import DT_S, PLANTS, energy_of, turned, turning_energy_of
from vehicle_sim.numerics.gravity import GRAVITY_M_S2
from vehicle_sim.plant.body import Body
from vehicle_sim.plant.constants import Plant
from vehicle_sim.plant.rigid_body import move

S500 = PLANTS["s500"]
ASYMMETRIC = replace(
    S500,
    inertia_xx_kg_m2=0.02,
    inertia_yy_kg_m2=0.03,
    inertia_zz_kg_m2=0.04,
    couple_x=(0.03 - 0.04) / 0.02,
    couple_y=(0.04 - 0.02) / 0.03,
    couple_z=(0.02 - 0.03) / 0.04,
)


def coast(body: Body, plant: Plant, steps: int) -> None:
    for _ in range(steps):
        move(body, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, plant)


def angular_momentum_ned(body: Body, plant: Plant) -> tuple[float, float, float]:
    return turned(
        body,
        (
            plant.inertia_xx_kg_m2 * body.rate_x,
            plant.inertia_yy_kg_m2 * body.rate_y,
            plant.inertia_zz_kg_m2 * body.rate_z,
        ),
    )


def test_without_air_it_falls_by_galilei() -> None:
    body = Body(vel_n=2.0, vel_d=-3.0)
    coast(body, S500, 500)
    assert body.pos_d == pytest.approx(0.5 * GRAVITY_M_S2 * 2.0**2 - 3.0 * 2.0, rel=1e-12)
    assert body.vel_d == pytest.approx(GRAVITY_M_S2 * 2.0 - 3.0, rel=1e-12)
    assert body.pos_n == pytest.approx(4.0, rel=1e-12)
    assert (body.pos_e, body.vel_n) == (0.0, 2.0)
    assert (body.sf_n, body.sf_e, body.sf_d) == (0.0, 0.0, 0.0)


def test_a_thrown_stone_keeps_its_energy() -> None:
    body = Body(vel_n=12.0, vel_e=-5.0, vel_d=-20.0)
    before = energy_of(body, S500)
    for _ in range(1000):
        coast(body, S500, 1)
        assert energy_of(body, S500) == pytest.approx(before, rel=1e-12)


def test_a_constant_torque_about_one_axis_gives_a_constant_acceleration() -> None:
    body = Body()
    for _ in range(250):
        move(body, 0.0, 0.0, 0.0, 0.0, 0.0, 0.011, S500)
    rate = 0.011 / S500.inertia_zz_kg_m2
    assert body.rate_z == pytest.approx(rate, rel=1e-12)
    assert body.qz / body.qw == pytest.approx(rate / 2.0 / 2.0, rel=0.01)  # tan of a small angle


def test_half_a_turn_takes_half_a_turn() -> None:
    body = Body(rate_z=pi)
    coast(body, S500, 250)
    # A Cayley map lags by theta^3 / 12 a step.
    lag = 250 * (pi * DT_S) ** 3 / 12.0
    assert 2.0 * body.qw == pytest.approx(lag, rel=0.01)


def test_a_top_precesses_at_the_rate_that_euler_gives() -> None:
    """Ixx = Iyy: the rate's part across z turns at (Izz - Ixx) / Ixx times the spin."""
    body = Body(rate_x=0.5, rate_z=20.0)
    turn = (S500.inertia_zz_kg_m2 - S500.inertia_xx_kg_m2) / S500.inertia_xx_kg_m2 * 20.0
    coast(body, S500, round(2.0 * pi / turn / DT_S))
    assert (body.rate_x, body.rate_y) == pytest.approx((0.5, 0.0), abs=0.02)
    assert body.rate_z == 20.0


def test_the_tumbling_of_an_asymmetric_body_keeps_momentum_and_energy() -> None:
    """Dzhanibekov's flip: only the gyroscopic term can keep the angular momentum in NED."""
    body = Body(rate_x=0.01, rate_y=6.0, rate_z=0.01)
    before, energy = angular_momentum_ned(body, ASYMMETRIC), turning_energy_of(body, ASYMMETRIC)
    slowest = 6.0
    for _ in range(2500):
        coast(body, ASYMMETRIC, 1)
        slowest = min(slowest, body.rate_y)
    assert slowest < -5.9  # it flips: the test would be empty otherwise
    size = sqrt(sum(part * part for part in before))
    assert angular_momentum_ned(body, ASYMMETRIC) == pytest.approx(before, abs=0.02 * size)
    assert turning_energy_of(body, ASYMMETRIC) == pytest.approx(energy, rel=5e-3)


def test_tumbling_is_integrated_to_the_second_order() -> None:
    def drift(steps: int) -> tuple[float, float]:
        plant = replace(ASYMMETRIC, dt_s=2.0 / steps)
        body = Body(rate_x=2.0, rate_y=6.0, rate_z=1.0)
        before, energy = angular_momentum_ned(body, plant), turning_energy_of(body, plant)
        coast(body, plant, steps)
        after = angular_momentum_ned(body, plant)
        off = sqrt(sum((a - b) ** 2 for a, b in zip(after, before, strict=True)))
        return off, abs(turning_energy_of(body, plant) - energy)

    (coarse, coarse_j), (fine, fine_j) = drift(500), drift(1000)
    assert log2(coarse / fine) == pytest.approx(2.0, abs=0.1)
    assert log2(coarse_j / fine_j) > 1.9


@pytest.mark.parametrize("axis", ["x", "y", "z"])
def test_the_quaternion_stays_a_rotation(axis: str) -> None:
    body = Body()
    setattr(body, f"rate_{axis}", 30.0)
    coast(body, S500, 1000)
    assert body.qw**2 + body.qx**2 + body.qy**2 + body.qz**2 == pytest.approx(1.0, abs=1e-14)
