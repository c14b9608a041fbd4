"""The whole body in the air: hover, drag, motors, symmetry, and the order of the integrator."""

from __future__ import annotations

from dataclasses import replace
from math import ceil, exp, log2, sqrt, tanh

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.shares import examples
from tests.unit.model.bodies import (
    DT_S,
    OFF,
    PLANTS,
    Motors,
    airborne,
    airless,
    down_of,
    energy_of,
    hover_motors,
    hover_speed,
    hovering,
    run,
)
from vehicle_sim.numerics.gravity import GRAVITY_M_S2
from vehicle_sim.plant.airframe import load
from vehicle_sim.plant.body import Body
from vehicle_sim.plant.constants import Plant, plant_of
from vehicle_sim.plant.quad import advance

EVERY = pytest.mark.parametrize("plant", PLANTS.values(), ids=PLANTS)
UNIT = st.floats(0.0, 1.0)


@EVERY
def test_thrust_equal_to_weight_hovers(plant: Plant) -> None:
    body = hovering(plant)
    for k in range(1, 251):
        advance(body, *hover_motors(body, plant), plant, k)
    assert -body.sf_d * plant.mass_kg == pytest.approx(plant.mass_kg * GRAVITY_M_S2, rel=1e-3)
    assert abs(body.vel_d) < 0.01
    assert (body.pos_n, body.pos_e, body.rate_x, body.rate_z) == (0.0, 0.0, 0.0, 0.0)


@EVERY
def test_full_throttle_climbs_with_its_thrust_to_weight(plant: Plant) -> None:
    plant = airless(plant)
    body = airborne(plant)
    run(body, plant, 0.4, (1.0, 1.0, 1.0, 1.0))
    full = 4.0 * plant.thrust_max_n * body.strength**2
    assert body.sf_d == pytest.approx(-full / plant.mass_kg, rel=0.02)


@EVERY
def test_a_fall_through_air_is_the_textbooks_tanh(plant: Plant) -> None:
    """m v' = m g - k v^2 from rest: v = v_end tanh(g t / v_end), v_end = sqrt(m g / k).

    Rotors at rest have no drag.  It falls for 4 v_end / g, as tanh 4 = 0.9993.
    """
    body = airborne(plant, 10_000.0)
    end_m_s = sqrt(plant.mass_kg * GRAVITY_M_S2 / plant.drag_n_per_m2_s2)
    for k in range(1, ceil(4.0 * end_m_s / GRAVITY_M_S2 / DT_S) + 1):
        advance(body, *OFF, plant, k)
        expected = end_m_s * tanh(GRAVITY_M_S2 * k * DT_S / end_m_s)
        assert body.vel_d == pytest.approx(expected, rel=2e-3)
    assert body.vel_d == pytest.approx(end_m_s, rel=1e-3)


@EVERY
def test_level_flight_ends_at_the_speed_where_drag_is_the_thrusts_lean(
    plant: Plant,
) -> None:
    """Along the track: quadratic drag, the drag in the rotors' plane, and lost thrust."""
    cos_pitch = 0.8
    body = hovering(plant)
    qw, qy = sqrt(0.5 * (1.0 + cos_pitch)), -sqrt(0.5 * (1.0 - cos_pitch))
    s = hover_speed(plant) / sqrt(cos_pitch)
    for k in range(1, 10_001):
        body.qw, body.qx, body.qy, body.qz = qw, 0.0, qy, 0.0
        body.vel_d = body.rate_y = 0.0
        body.s1 = body.s2 = body.s3 = body.s4 = s
        u = s / body.strength
        advance(body, u, u, u, u, plant, k)
    v = body.vel_n
    plane = plant.rotor_drag_n_s_per_m * cos_pitch * cos_pitch
    across = plant.inflow_n_s_per_m * (1.0 - cos_pitch * cos_pitch)
    drag_n = 4.0 * s * (plane + across) * v + plant.drag_n_per_m2_s2 * v * v
    assert drag_n == pytest.approx(plant.mass_kg * GRAVITY_M_S2 * 0.75, rel=1e-3)


@EVERY
def test_wind_takes_a_hovering_vehicle_along(plant: Plant) -> None:
    """The airspeed u falls by m u' = -c u - k u^2, so c / u + k grows by exp(c t / m).

    All the way for two of its times m / c, within the first-order steps' error of c dt / m.
    """
    body = hovering(plant)
    body.wind_e = body.flow_e = body.air_e = 6.0
    c = 4.0 * hover_speed(plant) * plant.rotor_drag_n_s_per_m
    drag = plant.drag_n_per_m2_s2
    for k in range(1, ceil(2.0 * plant.mass_kg / c / DT_S) + 1):
        advance(body, *hover_motors(body, plant), plant, k)
        left = c / ((c / 6.0 + drag) * exp(c * k * DT_S / plant.mass_kg) - drag)
        assert 6.0 - body.vel_e == pytest.approx(left, rel=5e-3)
    assert left < 6.0 * exp(-2.0)
    assert body.vel_n == 0.0


@EVERY
def test_the_work_of_the_forces_is_the_energy_gained(plant: Plant) -> None:
    """Exact for the path: mean velocity times force is the change of m v^2 / 2."""
    body = hovering(plant)
    motors = hover_motors(body, plant)
    work, before = 0.0, energy_of(body, plant)
    for k in range(1, 1001):
        n, e, d = body.pos_n, body.pos_e, body.pos_d
        advance(body, *motors, plant, k)
        along = body.sf_n * (body.pos_n - n) + body.sf_e * (body.pos_e - e)
        work += plant.mass_kg * (along + body.sf_d * (body.pos_d - d))
    assert energy_of(body, plant) - before == pytest.approx(work, rel=1e-6, abs=1e-9)


@EVERY
def test_drag_takes_energy_and_never_gives_any(plant: Plant) -> None:
    body = airborne(plant)
    body.vel_n, body.vel_e, body.rate_x, body.rate_z = 15.0, -7.0, 5.0, -9.0
    energy = energy_of(body, plant)
    for k in range(1, 1001):
        advance(body, *OFF, plant, k)
        assert energy_of(body, plant) < energy
        energy = energy_of(body, plant)


@EVERY
def test_motors_follow_their_command_with_a_first_order_lag(plant: Plant) -> None:
    body = airborne(plant)
    full = body.strength
    for k in range(1, 25):
        advance(body, 0.6, 0.6, 0.6, 0.6, plant, k)
        expected = 0.6 * full * (1.0 - exp(-k * DT_S / plant.motor_time_constant_s))
        assert body.s1 == pytest.approx(expected, abs=1e-3)
        assert body.s1 == body.s2 == body.s3 == body.s4


@EVERY
def test_more_thrust_on_the_left_rolls_right_and_on_the_front_pitches_up(
    plant: Plant,
) -> None:
    rolling, pitching, yawing = airborne(plant), airborne(plant), airborne(plant)
    run(rolling, plant, 0.04, (0.5, 0.6, 0.6, 0.5))
    run(pitching, plant, 0.04, (0.6, 0.5, 0.6, 0.5))
    run(yawing, plant, 0.04, (0.6, 0.6, 0.5, 0.5))
    assert (rolling.rate_x > 0.0, rolling.rate_y) == (True, 0.0)
    assert (pitching.rate_y > 0.0, pitching.rate_x) == (True, 0.0)
    assert yawing.rate_z > 0.0  # propellers turning left push the body to the right


@EVERY
def test_climbing_costs_thrust_until_none_is_left(plant: Plant) -> None:
    body = hovering(plant)
    body.vel_d = -body.s1 * plant.thrust_max_n / plant.inflow_n_s_per_m
    advance(body, *hover_motors(body, plant), replace(plant, drag_n_per_m2_s2=0.0), 1)
    assert body.sf_d == pytest.approx(0.0, abs=0.01)


@EVERY
def test_rotors_damp_each_axis_of_turning(plant: Plant) -> None:
    """-4 s inflow arm^2 w about x and y, -4 s drag arm^2 w about z, whatever the height."""
    s, x, y = hover_speed(plant), plant.arm_forward_m, plant.arm_right_m
    for axis, inertia, per_rate in (
        ("rate_x", plant.inertia_xx_kg_m2, plant.inflow_n_s_per_m * y * y),
        ("rate_y", plant.inertia_yy_kg_m2, plant.inflow_n_s_per_m * x * x),
        ("rate_z", plant.inertia_zz_kg_m2, plant.rotor_drag_n_s_per_m * (x * x + y * y)),
    ):
        body = hovering(plant)
        setattr(body, axis, 1.0)
        advance(body, *hover_motors(body, plant), plant, 1)
        expected = 1.0 - 4.0 * s * per_rate / inertia * DT_S
        assert getattr(body, axis) == pytest.approx(expected, rel=1e-9)


@EVERY
def test_a_spin_out_of_control_stays_finite(plant: Plant) -> None:
    body = airborne(plant, 100_000.0)
    body.health_3 = 0.0
    fastest = 0.0
    for k in range(1, 5001):
        advance(body, 1.0, 1.0, 1.0, 0.2, plant, k)
        fastest = max(fastest, body.rate_x**2 + body.rate_y**2 + body.rate_z**2)
    assert sqrt(fastest) < 1.000001 * plant.rate_max_rad_s
    assert all(abs(x) < 1e6 for x in motion(body))


@EVERY
def test_a_roll_torque_is_the_lever_times_the_difference(plant: Plant) -> None:
    plant = airless(plant)
    body = hovering(plant)
    body.s2 = body.s3 = 1.1 * body.s1
    u, more = body.s1 / body.strength, body.s2 / body.strength
    advance(body, u, more, more, u, plant, 1)
    torque = 2.0 * plant.thrust_max_n * (body.s2**2 - body.s1**2) * plant.arm_right_m
    assert body.rate_x == pytest.approx(torque / plant.inertia_xx_kg_m2 * DT_S, rel=1e-9)


@EVERY
def test_a_dead_motor_stops_and_lifts_no_more(plant: Plant) -> None:
    body = hovering(plant)
    body.health_3 = 0.0
    run(body, plant, 0.1, hover_motors(body, plant))
    left = exp(-0.1 / plant.motor_time_constant_s)
    assert body.s3 == pytest.approx(left * hover_speed(plant), rel=0.02)
    assert body.s1 == pytest.approx(hover_speed(plant), rel=1e-3)
    assert body.rate_x < 0.0  # front left is gone: it rolls to the left
    assert body.rate_y < 0.0  # and its nose goes down


@EVERY
def test_a_weak_motor_turns_as_it_is_told_and_lifts_its_share(plant: Plant) -> None:
    plant = airless(plant)
    body = hovering(plant)
    body.health_1 = body.health_2 = body.health_3 = body.health_4 = 0.7
    run(body, plant, 0.1, hover_motors(body, plant))
    assert body.s1 == pytest.approx(hover_speed(plant), rel=1e-3)
    assert body.sf_d == pytest.approx(-0.7 * GRAVITY_M_S2, rel=2e-3)


@EVERY
@settings(max_examples=examples(15), deadline=None)
@given(u=st.tuples(UNIT, UNIT, UNIT, UNIT), up_m=st.sampled_from([0.0, 0.2, 500.0]))
def test_mirror_images_fly_mirrored_to_the_bit(plant: Plant, u: Motors, up_m: float) -> None:
    """Left and right swap motors 1 with 3 and 2 with 4; front and back 1 with 4 and 2 with 3."""
    one, swapped, reverse = (airborne(plant, up_m) for _ in range(3))
    for k in range(1, 301):
        u1, u2, u3, u4 = u if k < 200 else OFF
        advance(one, u1, u2, u3, u4, plant, k)
        advance(swapped, u3, u4, u1, u2, plant, k)
        advance(reverse, u4, u3, u2, u1, plant, k)
    assert one.qw**2 + one.qx**2 + one.qy**2 + one.qz**2 == pytest.approx(1.0, abs=1e-14)
    assert motion(swapped, left_right=-1.0) == motion(one)
    assert motion(reverse, front_back=-1.0) == motion(one)


def motion(body: Body, left_right: float = 1.0, front_back: float = 1.0) -> tuple[float, ...]:
    """Position, velocity, attitude and rate, of the body or of its mirror image."""
    y, x = left_right, front_back
    return (
        *(x * body.pos_n, y * body.pos_e, body.pos_d),
        *(x * body.vel_n, y * body.vel_e, body.vel_d),
        *(body.qw, y * body.qx, x * body.qy, x * y * body.qz),
        *(y * body.rate_x, x * body.rate_y, x * y * body.rate_z),
    )


@pytest.mark.parametrize("name", PLANTS)
def test_the_whole_is_integrated_to_the_first_order_at_least(name: str) -> None:
    """An explicit step of y' = f - r y is that of f (1 + r dt / 2): so much for each damping."""

    def end(steps: int) -> float:
        plant = plant_of(load(name), 1.0 / steps)
        body = hovering(plant)
        u = body.s1
        body.strength = 1.0
        for _ in range(steps):
            advance(body, 1.02 * u, u, 1.02 * u, u, plant, 1)
        return body.pos_n

    exact = end(16_000)
    coarse, fine = abs(end(250) - exact), abs(end(500) - exact)
    assert log2(coarse / fine) == pytest.approx(1.0, abs=0.05)
    plant = plant_of(load(name), DT_S)  # the steps that the vehicle flies with
    rotors = 4.0 * hover_speed(plant)
    drag = rotors * plant.rotor_drag_n_s_per_m / plant.mass_kg
    pitch = rotors * plant.inflow_n_s_per_m * plant.arm_forward_m**2 / plant.inertia_yy_kg_m2
    assert coarse < 0.5 * DT_S * (drag + pitch) * abs(exact)


@EVERY
def test_free_of_air_a_tumbling_vehicle_keeps_its_energy(plant: Plant) -> None:
    """Bounded by the integrator's order, as the falling is exact and the tumbling of second."""
    plant = airless(plant)
    body = replace(airborne(plant, 10_000.0), rate_x=5.0, rate_y=3.0, rate_z=7.0)
    before = energy_of(body, plant)
    run(body, plant, 20.0)
    assert down_of(body) != (0.0, 0.0, 1.0)
    assert energy_of(body, plant) == pytest.approx(before, rel=1e-4)
