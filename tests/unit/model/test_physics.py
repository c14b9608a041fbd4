"""The body obeys the laws that it was not written from: invariants, limits, symmetry, order."""

from __future__ import annotations

from math import pi, sqrt

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from vehicle_sim.model.airframe import load
from vehicle_sim.model.quad import Quad
from vehicle_sim.model.rigid_body import GRAVITY_M_S2, RigidBody

DT_S = 0.004
UNIT = st.floats(0.0, 1.0)


def airborne(dt_s: float = DT_S) -> Quad:
    quad = Quad(load(), dt_s)
    quad.body.pos_d = -1000.0
    return quad


def hover_command(quad: Quad) -> float:
    each = quad.airframe.body.mass_kg * GRAVITY_M_S2 / 4.0
    return sqrt(each / quad.airframe.motors.thrust_max_n) / quad.battery.strength


def test_without_air_and_motors_it_falls_by_galilei() -> None:
    body = RigidBody(1.5, (0.03, 0.03, 0.05))
    for _ in range(500):
        body.advance(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, DT_S)
    assert body.pos_d == pytest.approx(0.5 * GRAVITY_M_S2 * 2.0 * 2.0, rel=1e-12)
    assert body.vel_d == pytest.approx(GRAVITY_M_S2 * 2.0, rel=1e-12)
    assert (body.pos_n, body.pos_e) == (0.0, 0.0)


def test_thrust_equal_to_weight_hovers() -> None:
    quad = airborne()
    for _ in range(100):
        u = hover_command(quad)
        quad.step(u, u, u, u)
    assert quad.motors.thrust == pytest.approx(quad.airframe.body.mass_kg * 9.80665, rel=2e-3)


def test_a_long_fall_ends_at_the_terminal_speed() -> None:
    quad = airborne()
    for _ in range(5000):
        quad.step(0.0, 0.0, 0.0, 0.0)
        quad.body.pos_d = -1000.0
    body = quad.airframe.body
    assert quad.body.vel_d == pytest.approx(
        sqrt(body.mass_kg * GRAVITY_M_S2 / body.drag_n_per_m2_s2), rel=1e-3
    )


def test_drag_is_against_the_air_not_the_ground() -> None:
    quad = airborne()
    quad.wind_e = 6.0
    for _ in range(15_000):
        u = hover_command(quad)
        quad.step(u, u, u, u)
        quad.body.pos_d = -1000.0
    # Quadratic drag: the difference to the air is 1 / (1 / w0 + k t / m).
    body = quad.airframe.body
    left = 1.0 / (1.0 / 6.0 + body.drag_n_per_m2_s2 / body.mass_kg * 60.0)
    assert quad.body.vel_e == pytest.approx(6.0 - left, abs=5e-3)
    assert quad.body.vel_n == 0.0


@settings(max_examples=25, deadline=None)
@given(UNIT, UNIT, UNIT, UNIT)
def test_the_quaternion_stays_a_rotation(u1: float, u2: float, u3: float, u4: float) -> None:
    quad = airborne()
    for _ in range(200):
        quad.step(u1, u2, u3, u4)
    b = quad.body
    norm = b.qw * b.qw + b.qx * b.qx + b.qy * b.qy + b.qz * b.qz
    assert norm == pytest.approx(1.0, abs=1e-12)


@settings(max_examples=25, deadline=None)
@given(UNIT, UNIT, UNIT, UNIT)
def test_left_and_right_are_mirror_images(u1: float, u2: float, u3: float, u4: float) -> None:
    """Mirrored in the plane north-down the motors swap sides: 1 with 3 and 2 with 4."""
    one, other = airborne(), airborne()
    for _ in range(100):
        one.step(u1, u2, u3, u4)
        other.step(u3, u4, u1, u2)
    a, b = one.body, other.body
    assert (a.pos_n, a.pos_e, a.pos_d) == pytest.approx((b.pos_n, -b.pos_e, b.pos_d), abs=1e-9)
    assert (a.rate_x, a.rate_y, a.rate_z) == pytest.approx(
        (-b.rate_x, b.rate_y, -b.rate_z), abs=1e-9
    )


def test_more_thrust_on_the_left_rolls_right_and_on_the_front_pitches_up() -> None:
    rolling, pitching, yawing = airborne(), airborne(), airborne()
    for _ in range(10):
        rolling.step(0.5, 0.6, 0.6, 0.5)
        pitching.step(0.6, 0.5, 0.6, 0.5)
        yawing.step(0.6, 0.6, 0.5, 0.5)
    assert rolling.body.rate_x > 0.0
    assert pitching.body.rate_y > 0.0
    assert yawing.body.rate_z > 0.0  # propellers turning left push the body to the right


def test_a_free_body_keeps_its_angular_momentum_and_energy() -> None:
    """Torque-free and asymmetric: only the gyroscopic term can keep L constant in NED."""
    inertia = (0.02, 0.03, 0.05)
    body = RigidBody(1.0, inertia)
    body.rate_x, body.rate_y, body.rate_z = 1.0, 3.0, 0.5
    before, energy = angular_momentum_ned(body, inertia), rotation_energy(body, inertia)
    slowest = 3.0
    for _ in range(40_000):
        body.advance(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0001)
        slowest = min(slowest, body.rate_y)
    assert slowest < -2.0  # it tumbles: the test would be empty otherwise
    assert angular_momentum_ned(body, inertia) == pytest.approx(before, abs=2e-4)
    assert rotation_energy(body, inertia) == pytest.approx(energy, rel=2e-3)


def angular_momentum_ned(
    b: RigidBody, inertia: tuple[float, float, float]
) -> tuple[float, float, float]:
    x, y, z = inertia[0] * b.rate_x, inertia[1] * b.rate_y, inertia[2] * b.rate_z
    w, i, j, k = b.qw, b.qx, b.qy, b.qz
    # v + 2 w (q x v) + 2 q x (q x v)
    cx, cy, cz = j * z - k * y, k * x - i * z, i * y - j * x
    return (
        x + 2.0 * (w * cx + j * cz - k * cy),
        y + 2.0 * (w * cy + k * cx - i * cz),
        z + 2.0 * (w * cz + i * cy - j * cx),
    )


def rotation_energy(b: RigidBody, inertia: tuple[float, float, float]) -> float:
    return inertia[0] * b.rate_x**2 + inertia[1] * b.rate_y**2 + inertia[2] * b.rate_z**2


def test_half_a_turn_takes_half_a_turn() -> None:
    body = RigidBody(1.0, (0.02, 0.02, 0.02))
    body.rate_z = pi
    for _ in range(250):
        body.advance(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, DT_S)
    assert abs(body.qz) == pytest.approx(1.0, abs=1e-6)


def test_halving_the_step_at_least_halves_the_error() -> None:
    def end(steps: int) -> float:
        quad = airborne(1.0 / steps)
        for _ in range(steps):
            quad.step(0.75, 0.70, 0.75, 0.70)
        return quad.body.pos_n

    exact = end(16_000)
    errors = [abs(end(n) - exact) for n in (250, 500, 1000)]
    assert errors[0] > 1.9 * errors[1] > 1.9 * 1.9 * errors[2] > 0.0
    assert errors[0] < 0.05


def test_dropped_on_the_ground_it_comes_to_rest_level() -> None:
    quad = Quad(load(), DT_S)
    quad.body.pos_d = -1.0
    quad.body.vel_n = 0.5
    quad.body.qw, quad.body.qx = 0.995, sqrt(1.0 - 0.995 * 0.995)
    for _ in range(2500):
        quad.step(0.0, 0.0, 0.0, 0.0)
    b = quad.body
    assert b.pos_d == pytest.approx(0.0, abs=2e-3)
    assert max(abs(b.vel_n), abs(b.vel_e), abs(b.vel_d)) < 1e-6
    assert abs(b.qx) + abs(b.qy) < 1e-4


def test_it_stands_where_it_stands() -> None:
    quad = Quad(load(), DT_S)
    for _ in range(2500):
        quad.step(0.08, 0.08, 0.08, 0.08)
    b = quad.body
    assert abs(b.pos_n) + abs(b.pos_e) < 1e-6
    assert b.pos_d == pytest.approx(0.0, abs=1e-3)


def test_wind_does_not_blow_a_standing_vehicle_away() -> None:
    quad = Quad(load(), DT_S)
    quad.wind_n = 5.0
    for _ in range(1000):
        quad.step(0.0, 0.0, 0.0, 0.0)
    assert abs(quad.body.vel_n) < 0.01
